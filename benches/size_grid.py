"""How near `size` comes to the best of a grid, and with how much of its work: a row a network.

From the root of the project, after `cargo build --release -p vertifleet-cli`:

    python3 benches/size_grid.py > size_grid.md

The networks are the one of the guide "Plan a city in an hour" and three shipped ones, all with costs of aircraft and stands.
The grid has every fleet of the search and two numbers of stands: one for the half of the vertiports that most passengers leave,
and one for the others. `size` searches each vertiport's stands apart. Work is the number of days that are simulated, which is
the same on every machine; the bounds of `size` come on top and are counted in seconds only. The grid meets the days of the
search, and its ten best designs meet the further days too, on which the answer of `size` is judged. The best of the grid is the
one that is best on the further days, so the comparison favours the grid.

The aim is an answer within 1 % of the best of the grid on the further days, for a tenth of the days of the grid.
`--days` and `--designs` are those of `size`, and `--networks` names some of the cases.
"""

import argparse
import itertools
import json
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

PROGRAM = Path("target/release/vertifleet").absolute()
POLICY = "prices"

# For each network: the cost of an aircraft and of a stand, dollars a day; numbers of aircraft of each type; numbers of stands.
CASES = {
    "bay": (2000, 150, range(0, 25, 4), range(3, 10, 2)),
    "paper": (300, 40, range(20, 61, 4), range(4, 11, 1)),
    "new-york": (1500, 150, range(0, 25, 4), range(2, 9, 2)),
    "san-francisco": (1500, 150, range(0, 25, 4), range(2, 9, 2)),
}


def run(*arguments: str, folder: Path) -> str:
    done = subprocess.run([PROGRAM, *arguments], cwd=folder, check=True, capture_output=True, text=True)
    return done.stdout


def bay(folder: Path) -> str:
    """The network of the guide."""
    tables = Path("docs/src/guide/bay").absolute()
    run("network", "import", "--vertiports", str(tables / "vertiports.csv"), "--demand", str(tables / "demand.csv"),
        "--name", "bay", "--output", "bay.toml", folder=folder)
    file = folder / "bay.toml"
    file.write_text(file.read_text().replace("\ncount = 16", "\ncount = 8"))
    return "bay.toml"


def steps(numbers: range) -> str:
    return f"{numbers[0]}..{numbers[-1]}/{numbers.step}"


def grid(network: str, case: tuple, days: int, folder: Path) -> tuple[list[tuple[float, list[str]]], int]:
    """Profit and settings of every design of the grid, and the number of designs."""
    aircraft_usd, stand_usd, fleets, stands = case
    overview = json.loads(run("network", "show", network, "--json", folder=folder))
    types = [one["id"] for one in overview["aircraft_types"] if one["aircraft"]]
    by_demand = sorted(overview["vertiports"], key=lambda one: -one["departing"])
    half = len(by_demand) // 2
    costs = [f"tariffs.aircraft_cost_usd_per_day={aircraft_usd}", f"tariffs.stand_cost_usd_per_day={stand_usd}"]
    varied = [f"fleet.{kind}.count={steps(fleets)}" for kind in types]
    found = []
    for large, small in itertools.product(stands, stands):
        numbers = [(one["id"], large if at < half else small) for at, one in enumerate(by_demand)]
        settings = costs + [f"vertiports.{place}.stands={number}" for place, number in numbers]
        room = sum(number for _, number in numbers)
        for cell in cells(network, settings + varied, days, 1, folder):
            counts = cell["settings"][-len(types):]
            if cell["left_out"] is None and sum(counts) < room:
                fleet = [f"fleet.{kind}.count={count}" for kind, count in zip(types, counts)]
                found.append((cell["results"][0]["profit_usd"]["mean"], settings + fleet))
    return sorted(found, key=lambda one: -one[0]), len(found)


def cells(network: str, settings: list[str], days: int, seed: int, folder: Path) -> list[dict]:
    """The designs of a sweep on some days."""
    vary = [word for one in settings for word in ("--vary", one)]
    shutil.rmtree(folder / "cells", ignore_errors=True)
    run("sweep", network, *vary, "--policies", POLICY, "--days", str(days), "--seed", str(seed), "--out", "cells",
        folder=folder)
    return json.loads((folder / "cells" / "summary.json").read_text())["cells"]


def profit(network: str, settings: list[str], days: int, seed: int, folder: Path) -> float:
    """Mean profit of a design on some days."""
    return cells(network, settings, days, seed, folder)[0]["results"][0]["profit_usd"]["mean"]


def row(name: str, days: int, designs: int, folder: Path) -> str:
    network = bay(folder) if name == "bay" else name
    aircraft_usd, stand_usd, fleets, stands = CASES[name]
    begun = time.monotonic()
    text = run("size", network, "--vary", f"tariffs.aircraft_cost_usd_per_day={aircraft_usd}", "--vary",
               f"tariffs.stand_cost_usd_per_day={stand_usd}", "--vary", f"fleet.*.count={steps(fleets)}", "--vary",
               f"vertiports.*.stands={steps(stands)}", "--policy", POLICY, "--days", str(days), "--designs", str(designs),
               "--out", "best", "--json", folder=folder)
    size_s = time.monotonic() - begun
    size = json.loads(text)
    begun = time.monotonic()
    designs_of_grid, count = grid(network, CASES[name], days, folder)
    grid_s = time.monotonic() - begun
    further = [profit(network, settings, days, 1 + days, folder) for _, settings in designs_of_grid[:10]]
    best_usd, found_usd = max(further), size["best_on_holdout"]["profit_usd"]["mean"]
    searched_usd = size["designs"][size["best"]]["profit_usd"]["mean"]
    return (
        f"| `{name}` | {count:,} | {designs_of_grid[0][0]:,.0f} | {searched_usd:,.0f} | {best_usd:,.0f} | {found_usd:,.0f} "
        f"| {100 * (found_usd / best_usd - 1):+.2f} % | {count * days:,} | {size['simulated_days']:,} "
        f"| {100 * size['simulated_days'] / (count * days):.1f} % | {size_s:.0f} of {grid_s:.0f} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--days", type=int, default=20)
    parser.add_argument("--designs", type=int, default=16)
    parser.add_argument("--networks", default=",".join(CASES))
    given = parser.parse_args()
    print("| network | designs of the grid | its best, $ | `size`, $ | its best on further days, $ | `size`, $ | difference "
          "| days of the grid | of `size` | share | seconds |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for name in given.networks.split(","):
        with tempfile.TemporaryDirectory() as folder:
            print(row(name, given.days, given.designs, Path(folder)), flush=True)


if __name__ == "__main__":
    main()

"""How the policies do on networks of every kind: a table of the policies' profit, and whether each promise is kept.

The promises: `rolling` earns at least what `prices` and what `greedy` earn, `gcaps-x` at least what `prices` earns, in the mean
over the days, but for what chance may make of it; and no policy loses money where holding is possible. From the root of the
project, after `cargo build --release -p vertifleet-cli`:

    python3 benches/suite.py --days 20 > suite.md

Days are those of comparison, from --seed on. Networks of 60 and 120 vertiports are played for a tenth of the days. The
program ends with 1 if a promise is broken.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM = "target/release/vertifleet"
BAY = "networks/suite/bay.toml"
POLICIES = ["greedy", "prices", "gcaps-x", "rolling"]
# Pairs of which the first is to earn at least as much as the second.
PROMISES = [("rolling", "prices"), ("rolling", "greedy"), ("gcaps-x", "prices")]
PASSENGERS = [0, 400, 1_000, 2_000, 4_000]


def with_passengers(text: str, passengers: int) -> str:
    """The network with another number of passengers a day."""
    name = re.search(r'^name = "(.*)"', text, re.M).group(1)
    text = text.replace(f'name = "{name}"', f'name = "{name}-{passengers}"', 1)
    gravity = r"(\[daily_demand\.gravity\]\npassengers = )\d+"
    text, found = re.subn(gravity, rf"\g<1>{passengers}", text)
    assert found == 1, name
    return text


def with_vertiports(text: str, vertiports: int, aircraft: int, passengers: int) -> str:
    """A network like `new-york` with this number of vertiports, spread evenly over the same area, and no disturbances."""
    head, rest = text.split("[[vertiports]]", 1)
    _, tail = rest.split("[[aircraft_types]]", 1)
    head = head.replace('name = "new-york"', f'name = "even-{vertiports}-{passengers}"')
    sites, weights = [], []
    for at in range(1, vertiports + 1):
        # A low-discrepancy sequence: powers of the plastic number.
        x, y = (ratio * at % 1 for ratio in (0.754877666, 0.569840291))
        sites.append(
            f'[[vertiports]]\nid = "V{at}"\nlatitude = {40.6 + 0.5 * y:.5f}\nlongitude = {-74.2 + 0.8 * x:.5f}\n'
            f"stands = {2 * aircraft // vertiports}\nbusy = false\n\n"
        )
        weights.append(f"{1 + 9 * (0.618 * at % 1) ** 2:.1f}")
    tail = re.sub(r"^count = \d+", f"count = {aircraft // 2}", tail, flags=re.M)
    tail = re.sub(r"^passengers = 8000", f"passengers = {passengers}", tail, flags=re.M)
    tail = re.sub(r"^weights = \[.*?\]", f"weights = [{', '.join(weights)}]", tail, flags=re.M | re.S)
    tail = re.sub(r"^\[disturbances.*?(?=^\[feature)", "", tail, flags=re.M | re.S)
    return head + "".join(sites) + "[[aircraft_types]]" + tail


def cases(folder: Path, days: int) -> list[tuple[str, int]]:
    """Names or paths of all networks, with how many days are played on each."""
    all_cases = [(name, days) for name in ("paper", "disrupted", "new-york", "as-coded", BAY)]
    texts = []
    for network in ("networks/new-york.toml", BAY):
        text = Path(network).read_text()
        texts += [(with_passengers(text, passengers), days) for passengers in PASSENGERS]
    new_york = Path("networks/new-york.toml").read_text()
    for vertiports, aircraft, passengers in [(60, 200, 30_000), (120, 300, 60_000), (120, 300, 20_000)]:
        text = with_vertiports(new_york, vertiports, aircraft, passengers)
        texts.append((text, max(2, days // 10)))
    for at, (text, count) in enumerate(texts):
        path = folder / f"{at}.toml"
        path.write_text(text)
        all_cases.append((str(path), count))
    return all_cases


def run(*arguments: str) -> dict:
    """What a command prints as JSON."""
    return json.loads(subprocess.run([PROGRAM, *arguments, "--json"], check=True, capture_output=True).stdout)


def verdict(mean: float, half_width: float) -> str:
    """A difference as it stands in the table, and whether it breaks a promise."""
    rounded = "0" if abs(mean) < 0.5 else f"{mean:+,.0f}"
    return f"{rounded} ± {half_width:,.0f}" + (" **broken**" if mean + half_width < 0 else "")


def row(network: str, days: int, seed: int) -> str:
    """A network's row of the table."""
    policies = ",".join(POLICIES)
    found = run("compare", "--network", network, "--policies", policies, "--days", str(days), "--seed", str(seed))
    profit = {policy["name"]: policy["profit_usd"]["mean"] for policy in found["policies"]}
    pairs = {}
    for pair in found["comparisons"]:
        difference = pair["profit_usd"]["difference"]
        pairs[pair["first"], pair["second"]] = (difference["mean"], difference["half_width_95"])
        pairs[pair["second"], pair["first"]] = (-difference["mean"], difference["half_width_95"])
    cells = [f"{profit[name]:,.0f}" + (" **loss**" if profit[name] < 0 else "") for name in POLICIES]
    cells += [verdict(*pairs[promise]) for promise in PROMISES]
    return f"| `{found['network']}` | {days} | " + " | ".join(cells) + " |"


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--days", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="a part of the names or paths of the networks that are wanted")
    arguments = parser.parse_args()
    header = ["network", "days", *POLICIES, *(f"{one} - {other}" for one, other in PROMISES)]
    print("| " + " | ".join(header) + " |\n|" + "---|" * len(header), flush=True)
    kept = True
    with tempfile.TemporaryDirectory() as folder:
        for network, days in cases(Path(folder), arguments.days):
            if arguments.only in network:
                text = row(network, days, arguments.seed)
                kept = kept and "**" not in text
                print(text, flush=True)
    sys.exit(0 if kept else 1)


if __name__ == "__main__":
    main()

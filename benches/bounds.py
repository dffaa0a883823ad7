"""The certified bound on networks of every kind: a row a network with the bound at each step, and how long each took.

From the root of the project, after `cargo build --release -p vertifleet-cli`:

    python3 benches/bounds.py > bounds.md

The networks are those of benches/suite.py and random:0 to random:49. Networks of 60 and 120 vertiports are bounded down to steps of 15
minutes only. Seconds are of CPU time. The program ends with 1 if a shorter step gave a looser bound anywhere.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from suite import PROGRAM, cases

STEPS = [60, 15, 5, 3, 1]


def bound(day: Path, step: int) -> tuple[float, float]:
    """The bound of a day in dollars, and the CPU seconds that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [PROGRAM, "bound", str(day), "--step", str(step), "--json"]
    found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return found["upper_bound"], after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def row(network: str, seed: int, folder: Path) -> tuple[str, bool]:
    """A network's row of the table, and whether no shorter step gave a looser bound."""
    day = folder / "day.json"
    drawn = [PROGRAM, "scenario", network, "--seed", str(seed), "-o", str(day), "--force"]
    subprocess.run(drawn, check=True, capture_output=True)
    scenario = json.loads(day.read_text())
    steps = [step for step in STEPS if len(scenario["vertiports"]) < 60 or step >= 15]
    found = [bound(day, step) for step in steps]
    bounds = [usd for usd, _ in found]
    kept = all(shorter <= longer for longer, shorter in zip(bounds, bounds[1:]))
    cells = [f"{usd:,.0f} ({seconds:.1f} s)" for usd, seconds in found] + ["-"] * (len(STEPS) - len(steps))
    return f"| `{scenario['name']}` | " + " | ".join(cells) + " |" + ("" if kept else " **looser**"), kept


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--only", default="", help="a part of the names or paths of the networks that are wanted")
    arguments = parser.parse_args()
    print("| day | " + " | ".join(f"{step} min" for step in STEPS) + " |")
    print("|" + "---|" * (len(STEPS) + 1))
    all_kept = True
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        networks = [network for network, _ in cases(folder, 1)] + [f"random:{number}" for number in range(50)]
        for network in networks:
            if arguments.only in network:
                text, kept = row(network, arguments.seed, folder)
                all_kept &= kept
                print(text, flush=True)
    sys.exit(0 if all_kept else 1)


if __name__ == "__main__":
    main()

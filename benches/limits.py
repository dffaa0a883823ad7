"""Whether a plan keeps its time limit, and is no worse than the shipped policies, on networks of every kind: a row a network and limit.

From the root of the project, after `cargo build --release -p vertifleet-cli`, on a machine that has nothing else to do:

    python3 benches/limits.py > limits.md

The networks are those of benches/suite.py, or those that are named with --networks. Seconds are of the whole command, start and
proof included. A limit is kept if no more than 10 % or 1 s goes by after it. With limits of 0 and 2 seconds not every policy's day
can be played in time, so only at 10 seconds the plan is held against the policies; with 60 and 120 vertiports a day of `rolling`
takes minutes, and is left out. The program ends with 1 if a limit is not kept, or a plan earns less than a policy.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from suite import POLICIES, PROGRAM, cases, run

LIMITS_S = [0, 2, 10]


def planned(day: Path, limit_s: int) -> tuple[dict, float]:
    """What a plan says of itself, and the seconds that the command took."""
    begun = time.monotonic()
    trace = day.with_suffix(".csv")
    limit = ["--time-limit", str(limit_s)]
    command = [PROGRAM, "plan", str(day), "--output", str(trace), *limit, "--force", "--json"]
    output = subprocess.run(command, check=True, capture_output=True).stdout
    seconds = time.monotonic() - begun
    return json.loads(output), seconds


def rows(network: str, seed: int, folder: Path) -> tuple[list[str], bool]:
    """A network's rows of the table, and whether all promises are kept."""
    day = folder / "day.json"
    drawn = [PROGRAM, "scenario", network, "--seed", str(seed), "-o", str(day), "--force"]
    subprocess.run(drawn, check=True, capture_output=True)
    scenario = json.loads(day.read_text())
    name = scenario["name"]
    policies = [policy for policy in POLICIES if policy != "rolling" or len(scenario["vertiports"]) < 60]
    best_usd = max(run("simulate", str(day), "--policy", policy)["profit_usd"] for policy in policies)
    found, all_kept = [], True
    for limit_s in LIMITS_S:
        plan, seconds = planned(day, limit_s)
        kept = seconds <= max(1.1 * limit_s, limit_s + 1)
        no_worse = limit_s < max(LIMITS_S) or plan["profit_usd"] >= best_usd
        all_kept &= kept and no_worse
        gap = "-" if plan["gap"] is None else f"{100 * plan['gap']:.1f} %"
        found.append(
            f"| `{name}` | {limit_s} | {seconds:.1f}{'' if kept else ' **late**'} "
            f"| {plan['profit_usd']:,.0f}{'' if no_worse else ' **worse**'} | {best_usd:,.0f} | {gap} |"
        )
    return found, all_kept


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--networks", nargs="+", help="these networks in place of those of benches/suite.py")
    arguments = parser.parse_args()
    print("| day | limit, s | took, s | profit, $ | best policy, $ | gap |\n|---|---|---|---|---|---|", flush=True)
    all_kept = True
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for network in arguments.networks or [network for network, _ in cases(folder, 1)]:
            found, kept = rows(network, arguments.seed, folder)
            all_kept &= kept
            print("\n".join(found), flush=True)
    sys.exit(0 if all_kept else 1)


if __name__ == "__main__":
    main()

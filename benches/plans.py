"""How near plans are to the certified bound: a row for each network, with the mean gap over days and the lowest and highest.

From the root of the project, after `cargo build --release -p vertifleet-cli`, on a machine that has nothing else to do:

    python3 benches/plans.py --days 10 > plans.md

Days are those of comparison, from --seed on, as they are and calm: without delays, closures and outages, and with demand as
forecast. Days of `random` are those of the suite `random-50`, from `random:0` on. A gap is a share of the bound's operating profit,
as `vertifleet plan` says it. `policy` is the gap of the best shipped policy that was played in time.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

from suite import BAY, PROGRAM, run

NETWORKS = ["new-york", "paris", "san-francisco", "dallas", "los-angeles", BAY, "paper", "random", "large"]
DISTURBANCES = ["forecast", "takeoff_delays", "closures", "outages"]


def gaps(network: str, seed: int, calm: bool, limit_s: int, folder: Path) -> tuple[float, float]:
    """The gap of the plan of a day, and that of the best policy."""
    day = folder / "day.json"
    if network == "random":
        network, seed = f"random:{seed - 1}", seed - 1
    drawn = [PROGRAM, "scenario", network, "--seed", str(seed), "-o", str(day), "--force"]
    subprocess.run(drawn, check=True, capture_output=True)
    if calm:
        scenario = json.loads(day.read_text())
        for member in DISTURBANCES:
            scenario.pop(member, None)
        day.write_text(json.dumps(scenario))
    trace = str(folder / "plan.csv")
    plan = run("plan", str(day), "--output", trace, "--time-limit", str(limit_s), "--force")
    operating_usd = plan["operating_profit_usd"]
    bound_usd = operating_usd / (1 - plan["gap"])
    policy_usd = operating_usd - plan["profit_usd"] + plan["best_policy_usd"]
    return plan["gap"], 1 - policy_usd / bound_usd


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--days", type=int, default=10)
    parser.add_argument("--limit", type=int, default=60, help="seconds of each plan")
    parser.add_argument("--networks", nargs="+", default=NETWORKS)
    parser.add_argument("--only", choices=["calm", "shipped"], help="one kind of days")
    arguments = parser.parse_args()
    print("| days | gap | from | to | policy |\n|---|---|---|---|---|", flush=True)
    kinds = [arguments.only] if arguments.only else ["calm", "shipped"]
    with tempfile.TemporaryDirectory() as name:
        for network in arguments.networks:
            for kind in kinds:
                seeds = range(arguments.seed, arguments.seed + arguments.days)
                found = [gaps(network, seed, kind == "calm", arguments.limit, Path(name)) for seed in seeds]
                plans, policies = zip(*found, strict=True)
                mean, policy = (100 * sum(all_gaps) / len(found) for all_gaps in (plans, policies))
                least, most = 100 * min(plans), 100 * max(plans)
                label = f"`{Path(network).stem}`, {len(found)} {kind}"
                print(f"| {label} | {mean:.2f} % | {least:.2f} | {most:.2f} | {policy:.2f} % |", flush=True)


if __name__ == "__main__":
    main()

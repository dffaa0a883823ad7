"""What each kind of disturbance costs: the bound and two rules on a network without disturbances, with each kind alone, and with all.

From the root of the project, after `cargo build --release -p vertifleet-cli`:

    python3 benches/foresight.py disrupted new-york > foresight.md

What the rules lose in shares of the bound is what they cannot know and do not expect; what the bound loses cannot be avoided. The
days of all rows have the same seeds. `disrupted` takes about 2 minutes on 2 cores, and
`new-york` about 10.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from suite import PROGRAM

KINDS = ["forecast_error", "takeoff_delays", "closures", "outages"]
DAYS = 24


def with_only(toml: str, kinds: list[str]) -> str:
    """A network file with only these kinds of disturbances."""
    kept, skips = [], False
    for line in toml.splitlines():
        if table := re.match(r"\[+([^\]\[]+)\]+\s*(#.*)?$", line):
            kind = table[1].removeprefix("disturbances.")
            skips = kind in KINDS and kind not in kinds
        if not skips:
            kept.append(line)
    return "\n".join(kept) + "\n"


def measured(network: Path) -> str:
    """The mean bound in dollars, and the mean shares of it that `prices` and `greedy` earn."""
    command = [PROGRAM, "compare", "--network", str(network), "--policies", "greedy,prices"]
    command += ["--days", str(DAYS), "--seed", "1", "--bound", "--step", "5", "--json"]
    found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    shares = {
        policy["name"]: f"{100 * policy['bound_share']['mean']:.2f} ± {100 * policy['bound_share']['half_width_95']:.2f}"
        for policy in found["policies"]
    }
    return f"{found['bound']['upper_bound_usd']['mean']:,.0f} | {shares['prices']} | {shares['greedy']}"


def main() -> None:
    """Prints a table for each network that is named."""
    for name in sys.argv[1:]:
        toml = Path(f"networks/{name}.toml").read_text()
        print(f"\n| `{name}` | mean bound, $ | `prices`, % of it | `greedy` |\n|---|---|---|---|")
        rows = {"no disturbances": [], **{f"only {kind}": [kind] for kind in KINDS}, "all": KINDS}
        with tempfile.TemporaryDirectory() as folder:
            for words, kinds in rows.items():
                network = Path(folder) / f"{name}.toml"
                network.write_text(with_only(toml, kinds))
                print(f"| {words} | {measured(network)} |", flush=True)


if __name__ == "__main__":
    main()

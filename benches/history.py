#!/usr/bin/env python3
"""Adds what `cargo bench` measured to benches/history/criterion.csv, a row a benchmark.

    cargo bench --workspace --locked && python3 benches/history.py --machine "2 cores of an Intel Xeon with AVX-512"

Needs no package.
"""

from __future__ import annotations

import argparse
import csv
import datetime
import json
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HISTORY = ROOT / "benches/history/criterion.csv"
COLUMNS = ["bench", "date", "commit", "machine", "median_ns", "low_ns", "high_ns", "elements"]


def measured(machine: str) -> list[dict[str, str]]:
    """The latest run of every benchmark: the median time and its 95 % confidence interval."""
    said = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True)
    common = {
        "date": datetime.date.today().isoformat(),
        "commit": said.stdout.strip(),
        "machine": machine,
    }
    rows = []
    for path in sorted(ROOT.glob("target/criterion/**/new/estimates.json")):
        median = json.loads(path.read_text())["median"]
        about = json.loads(path.with_name("benchmark.json").read_text())
        interval = median["confidence_interval"]
        throughput = about["throughput"] or {}
        rows.append(
            common
            | {
                "bench": about["full_id"],
                "median_ns": str(round(median["point_estimate"])),
                "low_ns": str(round(interval["lower_bound"])),
                "high_ns": str(round(interval["upper_bound"])),
                "elements": str(throughput.get("Elements", 1)),
            }
        )
    return rows


def append(rows: list[dict[str, str]]) -> None:
    """Adds the rows to the history, which begins with the names of its columns."""
    is_new = not HISTORY.exists()
    with HISTORY.open("a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        if is_new:
            writer.writeheader()
        writer.writerows(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--machine", required=True, help="what it was measured on")
    append(measured(parser.parse_args().machine))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Keeps what `cargo bench` measured: a row a benchmark in benches/history/criterion.csv, and the latest rows in the book.

    cargo bench --workspace --locked && python3 benches/history.py --machine "2 cores of an Intel Xeon with AVX-512"

Needs no package. The table of docs/src/benchmarks.md is written between its two markers; a test holds it against the file.
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
PAGE = ROOT / "docs/src/benchmarks.md"
COLUMNS = ["bench", "date", "commit", "machine", "median_ns", "low_ns", "high_ns", "elements"]
BEGIN, END = "<!-- begin of criterion.csv -->", "<!-- end of criterion.csv -->"


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


def table() -> str:
    """The latest row of every benchmark, as Markdown."""
    with HISTORY.open(newline="", encoding="utf-8") as file:
        latest = {row["bench"]: row for row in csv.DictReader(file)}
    lines = [
        "| benchmark | median, ns | 95 % interval, ns | a second | commit | date |",
        "|---|---|---|---|---|---|",
    ]
    for bench, row in sorted(latest.items()):
        median, low, high = (int(row[name]) for name in ("median_ns", "low_ns", "high_ns"))
        rate = int(row["elements"]) / median * 1e9
        a_second = f"{float(f'{rate:.3g}'):,.0f}" if rate >= 100 else f"{rate:.3g}"
        lines.append(
            f"| {bench} | {median:,} | {low:,} to {high:,} | {a_second} | `{row['commit']}` | {row['date']} |"
        )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--machine", required=True, help="what it was measured on")
    append(measured(parser.parse_args().machine))
    page = PAGE.read_text(encoding="utf-8")
    before, rest = page.split(BEGIN, 1)
    _, after = rest.split(END, 1)
    PAGE.write_text(f"{before}{BEGIN}\n\n{table()}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()

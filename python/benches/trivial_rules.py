"""Evaluates two rules of one line on the suites: shares of the bound and load factors, for the protocol.

    python/.venv/bin/python python/benches/trivial_rules.py

`furthest` takes the longest flight that earns anything, `most-profit` the flight that earns most. Both hold
if no flight earns anything.
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

import vertifleet


class Furthest:
    """Takes the longest flight that earns anything."""

    def choose(self, decision: vertifleet.Decision, view: vertifleet.View) -> int:
        """The furthest vertiport, or hold."""
        earns = (view.choice_profit_usd > 0) & (view.action_mask > 0)
        lengths_mi = np.where(earns, view.distance_mi[decision.place], -1.0)
        return int(lengths_mi.argmax()) if earns.any() else decision.place


class MostProfit:
    """Takes the flight that earns most."""

    def choose(self, decision: vertifleet.Decision, view: vertifleet.View) -> int:
        """The vertiport to which the flight earns most, or hold."""
        earns = np.where(view.action_mask > 0, view.choice_profit_usd, 0.0)
        return int(earns.argmax()) if earns.max() > 0 else decision.place


RULES: dict[str, Any] = {"furthest": Furthest, "most-profit": MostProfit}


def main() -> None:
    """Prints shares and load factors."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--suites", nargs="+", default=list(vertifleet.SUITES))
    arguments = parser.parse_args()
    print("| suite | policy | share of the bound, % | load factor |\n|---|---|---|---|", flush=True)
    for suite in arguments.suites:
        names = ["greedy", *RULES, "prices"]
        evaluation = vertifleet.evaluate(names, suite, models=RULES)
        frame = evaluation.to_pandas()
        for name in names:
            days = frame[frame["policy"] == name]
            shares = 100 * days["bound_share"]
            share = f"{shares.mean():.2f} ± {1.96 * shares.sem():.2f}"
            print(f"| `{suite}` | `{name}` | {share} | {days['load_factor'].mean():.3f} |", flush=True)


if __name__ == "__main__":
    main()

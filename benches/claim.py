"""Does the graph help? Tables and the figure of the book, from what scripts/claim has measured.

From the root of the project, with the packages of python/constraints.txt (`python/.venv` after `scripts/python dev`):

    scripts/claim out/claim                            trains and evaluates
    python/.venv/bin/python benches/claim.py out/claim writes benches/claim/results.csv, the raw results
    python/.venv/bin/python benches/claim.py           prints the tables, and draws docs/src/images/claim.svg, from that file

A difference of two models is tested over training runs and days at once. Its variance is

    2 s^2 / seeds  +  (variance of its daily means over seeds) / days,

with Satterthwaite's degrees of freedom. s^2 is the variance of a run's mean that neither its model nor its seed explains, pooled over
all models of a table, because three runs alone do not tell it; only the table of states, whose runs vary by different amounts, pools
nothing. p-values are corrected by Holm's method over all differences of a table in one world; intervals are not corrected.
"""

import csv
import json
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TypeVar

import numpy
from scipy import stats

DATA = Path("benches/claim/results.csv")
FIGURE = Path("docs/src/images/claim.svg")
WORLDS = {"paper": "one network", "random-places:8": "a new network each day"}
# A world of networks of 5 to 30 vertiports, which models of one size cannot be for.
ANY_SIZE = {"random": "networks of any size"}
ALL_WORLDS = WORLDS | ANY_SIZE
# The folders of scripts/claim, in the order of the tables.
NETWORKS = {
    "capsules": "graph capsules, complete graph",
    "profit": "the same, neighbours by profit",
    "aircraft": "graph capsules, and a graph of the aircraft",
    "no-graph": "no graph (K = 0)",
    "no-second-moment": "no second moment (P = 1)",
    "no-attention": "no attention in the decoder",
    "deep-sets": "deep sets (P = 1, K = 1)",
    "transformer": "self-attention",
    "mlp": "plain layers (mlp-full)",
    "shared-plain": "plain layers for each vertiport, and their mean",
}
# Changes of Table 3 and of the graph, one at a time.
SWEEP = {
    "no-second-moment": "P = 1",
    "moments=3": "P = 3",
    "no-graph": "K = 0",
    "hops=1": "K = 1",
    "hops=3": "K = 3",
    "layers=2": "L_e = 2",
    "layers=3": "L_e = 3",
    "similarity": "neighbours by similarity of features",
    "distance": "neighbours by distance",
    "reachable": "neighbours by what may be flown now",
    "profit": "neighbours by profit",
}
# The same two readers with all that is seen, and with the state of the paper.
STATES = {"capsules": "paper-state-capsules", "mlp": "paper-state-mlp"}
# The policies of the paper: its state, its sizes, and PPO with our preset `default`.
BY_PPO = {"ppo-capsules": "graph capsules (gcaps)", "ppo-mlp": "plain layers (mlp)"}
# What the others are compared with, the first of the plain models that a world has; and what was compared after the results were seen.
REFERENCES = ["capsules", "mlp", "shared-plain"]
AFTERWARDS = [("profit", "no-graph"), ("profit", "transformer")]
Shares = dict[tuple[str, str], numpy.ndarray]
Pair = tuple[str, str]
Test = tuple[float, float, float]
Name = TypeVar("Name", str, tuple[str, str])


def collect(folder: Path) -> None:
    """Writes the share of the bound of each run and day into one file, in which runs that the folder has not stay as they are."""
    runs: dict[tuple[str, str, str], list[list[str]]] = {}
    if DATA.exists():
        with DATA.open(newline="") as file:
            for row in list(csv.reader(file))[1:]:
                runs.setdefault((row[0], row[1], row[2]), []).append(row)
    for run in sorted(folder.glob("*/*")):
        world, (name, seed) = run.parent.name, run.name.rsplit("-", 1)
        for file in sorted(run.glob("results/*.json")):
            result = json.loads(file.read_text())
            is_greedy = result["policy"]["name"] == "greedy"
            if is_greedy and (name, seed) != (REFERENCES[0], "1"):
                continue
            run_of = (world, "greedy" if is_greedy else name, seed)
            # Aircraft and sites cost nothing on these days, so their profit is operating profit.
            shares = ((day["day"], 100 * day["profit_usd"] / day["upper_bound_usd"]) for day in result["days"])
            runs[run_of] = [[*run_of, day, f"{share:.4f}"] for day, share in shares]
    DATA.parent.mkdir(exist_ok=True)
    with DATA.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["world", "network", "seed", "day", "bound_share_percent"])
        writer.writerows(row for run_of in sorted(runs) for row in runs[run_of])


def read() -> Shares:
    """The shares of the bound in percent, by seed and day, for each world and network."""
    found: dict[tuple[str, str], dict[str, list[float]]] = {}
    with DATA.open(newline="") as file:
        for row in csv.DictReader(file):
            seeds = found.setdefault((row["world"], row["network"]), {})
            seeds.setdefault(row["seed"], []).append(float(row["bound_share_percent"]))
    return {key: numpy.array([seeds[seed] for seed in sorted(seeds)]) for key, seeds in found.items()}


class Differences:
    """Differences between models in one world, whose runs are alike in how much they vary."""

    def __init__(self, shares: Shares, world: str, models: Iterable[str]) -> None:
        self.shares = {name: shares[world, name] for name in models if (world, name) in shares}
        means = numpy.array([runs.mean(axis=1) for runs in self.shares.values()])
        rest = means - means.mean(axis=1, keepdims=True) - means.mean(axis=0) + means.mean()
        self.run_freedom = (means.shape[0] - 1) * (means.shape[1] - 1)
        self.run_variance = (rest**2).sum() / self.run_freedom

    def of(self, one: str, other: str) -> Test:
        """The mean over seeds and days, half its 95 % interval, and the p-value of its being 0."""
        differences = self.shares[one] - self.shares[other]
        seeds, days = differences.shape
        mean, of_days = differences.mean(), differences.mean(axis=0)
        parts = [(2 * self.run_variance / seeds, self.run_freedom), (of_days.var(ddof=1) / days, days - 1)]
        variance = sum(part for part, _ in parts)
        freedom = variance**2 / sum(part**2 / count for part, count in parts)
        error = variance**0.5
        return mean, stats.t.ppf(0.975, freedom) * error, 2 * stats.t.sf(abs(mean) / error, freedom)


def holm(p_values: dict[Name, float]) -> dict[Name, float]:
    """The p-values, corrected for their number."""
    corrected, highest = {}, 0.0
    for rank, pair in enumerate(sorted(p_values, key=p_values.__getitem__)):
        highest = max(highest, min(1.0, (len(p_values) - rank) * p_values[pair]))
        corrected[pair] = highest
    return corrected


def words_of(test: Test, corrected: float) -> str:
    """A difference, half its 95 % interval, and its corrected p-value."""
    mean, half, _ = test
    return f"{mean:+.2f} ± {half:.2f}, p " + ("< 0.001" if corrected < 0.001 else f"= {corrected:.3f}")


def means_of(runs: numpy.ndarray) -> str:
    """The mean of each seed's run, and of all of them, as two cells."""
    seeds = ", ".join(f"{mean:.2f}" for mean in runs.mean(axis=1))
    return f"{seeds} | {runs.mean():.2f}"


def table(shares: Shares, world: str) -> str:
    """The table of a world, as Markdown."""
    known = Differences(shares, world, NETWORKS)
    graph, plain = [name for name in REFERENCES if name in known.shares][:2]
    pairs = [(name, graph) for name in known.shares if name != graph]
    pairs += [(name, plain) for name in known.shares if name not in (graph, plain)]
    differences = {pair: known.of(*pair) for pair in [*pairs, *AFTERWARDS]}
    corrected = holm({pair: p_value for pair, (_, _, p_value) in differences.items()})

    def against(name: str, reference: str) -> str:
        if (name, reference) not in differences:
            return ""
        return words_of(differences[name, reference], corrected[name, reference])

    lines = [
        f"`{world}`, {ALL_WORLDS[world]}:",
        "",
        "| model | seeds 1, 2, 3 | mean | against the first row | against plain layers |",
        "|---|---|---|---|---|",
    ]
    for name in known.shares:
        others = " | ".join(against(name, reference) for reference in (graph, plain))
        lines.append(f"| {NETWORKS[name]} | {means_of(shares[world, name])} | {others} |")
    lines.append(f"| `greedy` | | {shares[world, 'greedy'].mean():.2f} | | |")
    if (plain, graph) in differences:
        _, _, p_value = differences[plain, graph]
        lines += ["", f"{NETWORKS[plain]}, against {NETWORKS[graph]}, uncorrected: p = {p_value:.3f}"]
    lines += ["", "Added when the results were known:", ""]
    lines.extend(f"- {NETWORKS[one]}, against {NETWORKS[other]}: {against(one, other)}" for one, other in AFTERWARDS)
    return "\n".join(lines)


def states(shares: Shares) -> str:
    """The same two models with all that is seen, and with the state of the paper, as a table in Markdown."""
    lines = ["| world | model | the paper's state | all of it | all of it is ahead by |", "|---|---|---|---|---|"]
    graph, plain = STATES
    for world in WORLDS:
        pairs = {**{full: (full, paper) for full, paper in STATES.items()}, "paper": (STATES[graph], STATES[plain])}
        # Runs on the paper's state vary more than the others, so nothing is pooled.
        tests = {name: Differences(shares, world, pair).of(*pair) for name, pair in pairs.items()}
        corrected = holm({name: p_value for name, (_, _, p_value) in tests.items()})
        for full, paper in STATES.items():
            means = f"{shares[world, paper].mean():.2f} | {shares[world, full].mean():.2f}"
            lines.append(f"| `{world}` | {NETWORKS[full]} | {means} | {words_of(tests[full], corrected[full])} |")
        lines.append(f"| | graph capsules are ahead by | {words_of(tests['paper'], corrected['paper'])} | see above | |")
    return "\n".join(lines)


def by_ppo(shares: Shares) -> str:
    """The policies of the paper, trained by PPO where networks change, as a table in Markdown."""
    world = "random-places:8"
    lines = ["| by PPO, on the paper's state | seeds 1, 2, 3 | mean |", "|---|---|---|"]
    lines.extend(f"| {words} | {means_of(shares[world, name])} |" for name, words in BY_PPO.items())
    # They vary more than the models of the tables, so only their own runs tell how much.
    graph, plain = BY_PPO
    test = Differences(shares, world, BY_PPO).of(graph, plain)
    lines.append(f"| graph capsules are ahead by | | {words_of(test, test[2])} |")
    lines.append(f"| `greedy` | | {shares[world, 'greedy'].mean():.2f} |")
    return "\n".join(lines)


def sweep(shares: Shares) -> str:
    """Changes of the settings of Table 3, as a table in Markdown."""
    lines = ["| changed | " + " | ".join(f"`{world}`" for world in WORLDS) + " |", "|---|" + "---|" * len(WORLDS)]
    means = {world: shares[world, REFERENCES[0]].mean() for world in WORLDS}
    lines.append("| nothing (P = 2, K = 2, L_e = 1, complete graph) | " + " | ".join(f"{mean:.2f}" for mean in means.values()) + " |")
    differences, corrected = {}, {}
    for world in WORLDS:
        known = Differences(shares, world, [REFERENCES[0], *SWEEP])
        tests = {(world, name): known.of(name, REFERENCES[0]) for name in SWEEP if name in known.shares}
        differences |= tests
        corrected |= holm({pair: p_value for pair, (_, _, p_value) in tests.items()})

    def cell(world: str, name: str) -> str:
        if (world, name) not in differences:
            return "-"
        mean, half, _ = differences[world, name]
        sure = " *" if corrected[world, name] < 0.05 else ""
        return f"{mean:+.2f} ± {half:.2f}{sure}"

    lines.extend(f"| {words} | " + " | ".join(cell(world, name) for world in WORLDS) + " |" for name, words in SWEEP.items())
    return "\n".join(lines)


def figure(shares: Shares) -> str:
    """Every training run as a dot, and the mean of each network as a line, for all worlds."""
    left, width, row, top = 340, 230, 26, 76
    full_width = left + len(ALL_WORLDS) * (width + 30)
    means = {key: shares[key].mean(axis=1) for key in shares if key[1] in NETWORKS}
    ranges = {world: [mean for (of, _), means in means.items() if of == world for mean in means] for world in ALL_WORLDS}
    # All panels have the same scale.
    span = max(max(of_world) - min(of_world) for of_world in ranges.values()) + 0.3
    height = top + row * len(NETWORKS) + 50
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {full_width} {height}" '
        'font-family="sans-serif" font-size="13" fill="#222">',
        "<title>Shares of the certified bound by network and world</title>",
        f'<rect width="{full_width}" height="{height}" fill="white"/>',
        '<text x="10" y="24" font-size="15">Share of the certified bound on unseen days, %: a dot is a training run, a bar the mean'
        "</text>",
    ]
    for at, words in enumerate(NETWORKS.values()):
        parts.append(f'<text x="{left - 10}" y="{top + row * at + 22}" text-anchor="end">{words}</text>')
    for panel, (world, words) in enumerate(ALL_WORLDS.items()):
        high = max(ranges[world]) + 0.15
        low = high - span
        begin = left + panel * (width + 30)

        def across(share: float, begin: int = begin, low: float = low) -> float:
            return begin + width * (share - low) / span

        parts.append(f'<text x="{begin}" y="{top - 26}" font-weight="bold">{world}</text>')
        parts.append(f'<text x="{begin}" y="{top - 8}">{words}</text>')
        bottom = top + row * len(NETWORKS) + 8
        tick = numpy.ceil(low / 0.5) * 0.5
        while tick <= high:
            x = across(tick)
            parts.append(f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{bottom}" stroke="#ddd"/>')
            parts.append(f'<text x="{x:.1f}" y="{bottom + 18}" text-anchor="middle">{tick:.1f}</text>')
            tick += 0.5
        for at, name in enumerate(NETWORKS):
            if (world, name) not in means:
                continue
            y = top + row * at + 18
            x = across(means[world, name].mean())
            parts.append(f'<line x1="{x:.1f}" y1="{y - 9}" x2="{x:.1f}" y2="{y + 9}" stroke="#222" stroke-width="3"/>')
            parts.extend(f'<circle cx="{across(mean):.1f}" cy="{y}" r="4" fill="#1b6ca8"/>' for mean in means[world, name])
    return "\n".join([*parts, "</svg>", ""])


def main() -> None:
    """Collects what a folder holds, or prints and draws what was collected."""
    if len(sys.argv) > 1:
        collect(Path(sys.argv[1]))
        return
    shares = read()
    print("\n\n".join([*(table(shares, world) for world in ALL_WORLDS), states(shares), by_ppo(shares), sweep(shares)]))
    FIGURE.write_text(figure(shares))


if __name__ == "__main__":
    main()

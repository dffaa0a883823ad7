"""Does the graph help? Tables and the figure of the book, from what scripts/claim has measured.

From the root of the project, with the packages of python/constraints.txt (`python/.venv` after `scripts/python dev`):

    scripts/claim out/claim                            trains and evaluates
    python/.venv/bin/python benches/claim.py out/claim writes benches/claim/results.csv, the raw results
    python/.venv/bin/python benches/claim.py           prints the tables, and draws docs/src/images/claim.svg, from that file

A difference is tested over training seeds and days at once. Seeds and days are crossed random effects,

    difference(seed, day) = mean + a(seed) + b(day) + rest(seed, day),

so the mean's variance is (MS_seed + MS_day - MS_rest) / (seeds x days), with Satterthwaite's degrees of freedom. p-values are corrected by
Holm's method over all differences of a world.
"""

import csv
import json
import sys
from pathlib import Path

import numpy
from scipy import stats

DATA = Path("benches/claim/results.csv")
FIGURE = Path("docs/src/images/claim.svg")
WORLDS = {"paper": "one network", "random-places:8": "a new network each day"}
# The folders of scripts/claim, in the order of the tables.
NETWORKS = {
    "capsules": "graph capsules of Table 3",
    "profit": "the same, neighbours by profit",
    "no-graph": "no graph (K = 0)",
    "no-second-moment": "no second moment (P = 1)",
    "no-attention": "no attention in the decoder",
    "deep-sets": "deep sets (P = 1, K = 1)",
    "transformer": "self-attention",
    "mlp": "plain layers (mlp-full)",
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
# What the others are compared with.
REFERENCES = ["capsules", "mlp"]
Shares = dict[tuple[str, str], numpy.ndarray]
Pair = tuple[str, str]


def collect(folder: Path) -> None:
    """Writes the share of the bound of each run and day into one file."""
    rows = []
    for run in sorted(folder.glob("*/*")):
        world, (name, seed) = run.parent.name, run.name.rsplit("-", 1)
        for file in sorted(run.glob("results/*.json")):
            result = json.loads(file.read_text())
            policy = result["policy"]["name"]
            for day in result["days"]:
                share = day["profit_usd"] / day["upper_bound_usd"]
                row = [
                    world,
                    "greedy" if policy == "greedy" else name,
                    seed,
                    day["day"],
                    f"{100 * share:.4f}",
                ]
                if policy != "greedy" or (name, seed) == (REFERENCES[0], "1"):
                    rows.append(row)
    DATA.parent.mkdir(exist_ok=True)
    with DATA.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["world", "network", "seed", "day", "bound_share_percent"])
        writer.writerows(rows)


def read() -> Shares:
    """The shares of the bound in percent, by seed and day, for each world and network."""
    found: dict[tuple[str, str], dict[str, list[float]]] = {}
    with DATA.open(newline="") as file:
        for row in csv.DictReader(file):
            seeds = found.setdefault((row["world"], row["network"]), {})
            seeds.setdefault(row["seed"], []).append(float(row["bound_share_percent"]))
    return {key: numpy.array([seeds[seed] for seed in sorted(seeds)]) for key, seeds in found.items()}


def mean_of(shares: numpy.ndarray) -> tuple[float, float, float]:
    """The mean over seeds and days, half its 95 % interval, and the p-value of its being 0."""
    seeds, days = shares.shape
    mean = shares.mean()
    of_seeds, of_days = shares.mean(axis=1), shares.mean(axis=0)
    rest = shares - of_seeds[:, None] - of_days[None, :] + mean
    squares = [
        days * of_seeds.var(ddof=1),
        seeds * of_days.var(ddof=1),
        (rest**2).sum() / ((seeds - 1) * (days - 1)),
    ]
    # The rest is no larger than either of the others but for chance.
    whole = max(squares[0] + squares[1] - squares[2], squares[0], squares[1])
    freedom = whole**2 / sum(
        square**2 / count for square, count in zip(squares, [seeds - 1, days - 1, (seeds - 1) * (days - 1)], strict=True)
    )
    error = (whole / (seeds * days)) ** 0.5
    return (
        mean,
        stats.t.ppf(0.975, freedom) * error,
        2 * stats.t.sf(abs(mean) / error, freedom),
    )


def holm(p_values: dict[Pair, float]) -> dict[Pair, float]:
    """The p-values, corrected for their number."""
    corrected, highest = {}, 0.0
    for rank, pair in enumerate(sorted(p_values, key=p_values.__getitem__)):
        highest = max(highest, min(1.0, (len(p_values) - rank) * p_values[pair]))
        corrected[pair] = highest
    return corrected


def words_of(test: tuple[float, float, float], corrected: float) -> str:
    """A difference, half its 95 % interval, and its corrected p-value."""
    mean, half, _ = test
    return f"{mean:+.2f} ± {half:.2f}, p " + ("< 0.001" if corrected < 0.001 else f"= {corrected:.3f}")


def table(shares: Shares, world: str) -> str:
    """The table of a world, as Markdown."""
    differences = {
        (name, reference): mean_of(shares[world, name] - shares[world, reference])
        for reference in REFERENCES
        for name in NETWORKS
        if name not in REFERENCES[: REFERENCES.index(reference) + 1]
    }
    corrected = holm({pair: p_value for pair, (_, _, p_value) in differences.items()})

    def against(name: str, reference: str) -> str:
        if (name, reference) not in differences:
            return ""
        return words_of(differences[name, reference], corrected[name, reference])

    lines = [
        f"`{world}`, {WORLDS[world]}:",
        "",
        "| network | seeds 1, 2, 3 | mean | against the first row | against plain layers |",
        "|---|---|---|---|---|",
    ]
    for name, words in NETWORKS.items():
        seeds = ", ".join(f"{seed:.2f}" for seed in shares[world, name].mean(axis=1))
        others = " | ".join(against(name, reference) for reference in REFERENCES)
        lines.append(f"| {words} | {seeds} | {shares[world, name].mean():.2f} | {others} |")
    lines.append(f"| `greedy` | | {shares[world, 'greedy'].mean():.2f} | | |")
    return "\n".join(lines)


def states(shares: Shares) -> str:
    """The same two readers with all that is seen, and with the state of the paper, as a table in Markdown."""
    graph, plain = REFERENCES
    tests = {}
    for world in WORLDS:
        for full, paper in STATES.items():
            tests[world, full] = mean_of(shares[world, full] - shares[world, paper])
        tests[world, "paper"] = mean_of(shares[world, STATES[graph]] - shares[world, STATES[plain]])
        tests[world, "full"] = mean_of(shares[world, graph] - shares[world, plain])
    corrected = holm({pair: p_value for pair, (_, _, p_value) in tests.items()})

    def words(pair: Pair) -> str:
        return words_of(tests[pair], corrected[pair])

    lines = ["| world | network | the paper's state | all of it | all of it is ahead by |", "|---|---|---|---|---|"]
    for world in WORLDS:
        for full, paper in STATES.items():
            means = f"{shares[world, paper].mean():.2f} | {shares[world, full].mean():.2f}"
            lines.append(f"| `{world}` | {NETWORKS[full]} | {means} | {words((world, full))} |")
        lines.append(f"| | graph capsules are ahead by | {words((world, 'paper'))} | {words((world, 'full'))} | |")
    return "\n".join(lines)


def sweep(shares: Shares) -> str:
    """Changes of the settings of Table 3, as a table in Markdown."""
    lines = ["| changed | " + " | ".join(f"`{world}`" for world in WORLDS) + " |", "|---|" + "---|" * len(WORLDS)]
    means = {world: shares[world, REFERENCES[0]].mean() for world in WORLDS}
    lines.append("| nothing (P = 2, K = 2, L_e = 1, complete graph) | " + " | ".join(f"{mean:.2f}" for mean in means.values()) + " |")
    differences = {
        (world, name): mean_of(shares[world, name] - shares[world, REFERENCES[0]])
        for world in WORLDS
        for name in SWEEP
        if (world, name) in shares
    }
    corrected = holm({pair: p_value for pair, (_, _, p_value) in differences.items()})

    def cell(world: str, name: str) -> str:
        if (world, name) not in differences:
            return "-"
        mean, half, _ = differences[world, name]
        sure = " *" if corrected[world, name] < 0.05 else ""
        return f"{mean:+.2f} ± {half:.2f}{sure}"

    lines.extend(f"| {words} | " + " | ".join(cell(world, name) for world in WORLDS) + " |" for name, words in SWEEP.items())
    return "\n".join(lines)


def figure(shares: Shares) -> str:
    """Every training run as a dot, and the mean of each network as a line, for both worlds."""
    left, width, row, top = 250, 300, 26, 60
    means = {key: shares[key].mean(axis=1) for key in shares if key[1] in NETWORKS}
    ranges = {world: [mean for (of, _), means in means.items() if of == world for mean in means] for world in WORLDS}
    # Both panels have the same scale.
    span = max(max(of_world) - min(of_world) for of_world in ranges.values()) + 0.3
    height = top + row * len(NETWORKS) + 50
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {left + 2 * width + 60} {height}" '
        'font-family="sans-serif" font-size="13" fill="#222">',
        "<title>Shares of the certified bound by network and world</title>",
        f'<rect width="{left + 2 * width + 60}" height="{height}" fill="white"/>',
        '<text x="10" y="24" font-size="15">Share of the certified bound on 100 unseen days, %: a dot is a training run, a bar the mean'
        "</text>",
    ]
    for at, words in enumerate(NETWORKS.values()):
        parts.append(f'<text x="{left - 10}" y="{top + row * at + 22}" text-anchor="end">{words}</text>')
    for panel, (world, words) in enumerate(WORLDS.items()):
        high = max(ranges[world]) + 0.15
        low = high - span
        begin = left + panel * (width + 30)

        def across(share: float, begin: int = begin, low: float = low) -> float:
            return begin + width * (share - low) / span

        parts.append(f'<text x="{begin}" y="{top - 10}">{world}, {words}</text>')
        bottom = top + row * len(NETWORKS) + 8
        tick = numpy.ceil(low / 0.5) * 0.5
        while tick <= high:
            x = across(tick)
            parts.append(f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{bottom}" stroke="#ddd"/>')
            parts.append(f'<text x="{x:.1f}" y="{bottom + 18}" text-anchor="middle">{tick:.1f}</text>')
            tick += 0.5
        for at, name in enumerate(NETWORKS):
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
    print("\n\n".join([*(table(shares, world) for world in WORLDS), states(shares), sweep(shares)]))
    FIGURE.write_text(figure(shares))


if __name__ == "__main__":
    main()

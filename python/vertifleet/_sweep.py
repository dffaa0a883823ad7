"""Sweeps: the same comparison on variations of a network, for questions like "and with 12 more aircraft?"."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, SupportsIndex

import numpy as np

from vertifleet._compare import Asked, network_of
from vertifleet._errors import Error

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Iterator, Sequence

    import pandas
    import polars
    from numpy.typing import NDArray

    from vertifleet._compare import Given
    from vertifleet._native import Comparison, Network

MEANS = ("profit_usd", "profit_low_usd", "profit_high_usd", "reward", "flights", "load_factor", "bound_share")
"""The columns that are means over the days; the last is there where bounds were asked for."""


@dataclass(frozen=True, eq=False, repr=False)
class Sweep:
    """Variations of a network, and how every policy does on each."""

    network: str
    """Name of the network."""
    policies: tuple[str, ...]
    """The policies, in the order they were asked for."""
    points: tuple[tuple[dict[str, Any], Comparison], ...]
    """The variations in their order: what was changed, and the comparison there."""

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """A row for each point and policy, as numpy arrays by column.

        First what was changed, a column for each path of the network file, then ``policy``, then means over
        the days: ``profit_usd`` with its 95 % confidence interval from ``profit_low_usd`` to
        ``profit_high_usd`` (not a number for a single day), ``reward``, ``flights``, ``load_factor``, and
        ``bound_share`` where bounds were asked for.
        """
        rows = list(self._rows())
        return {name: _column([row[name] for row in rows]) for name in rows[0]}

    def _rows(self) -> Iterator[dict[str, Any]]:
        for changes, comparison in self.points:
            of_policy = {policy["name"]: policy for policy in comparison.summary["policies"]}
            for name in self.policies:
                yield changes | {"policy": name} | _means(of_policy[name])

    def to_pandas(self) -> pandas.DataFrame:
        """Its columns as a pandas frame."""
        from pandas import DataFrame

        frame: pandas.DataFrame = DataFrame(self.columns)
        return frame

    def to_polars(self) -> polars.DataFrame:
        """Its columns as a polars frame."""
        from polars import DataFrame

        return DataFrame(self.columns)

    def __str__(self) -> str:
        summary = self.points[0][1].summary
        days = "1 day" if summary["days"] == 1 else f"{summary['days']:,} days"
        points = "1 point" if len(self.points) == 1 else f"{len(self.points)} points"
        head = f"network {self.network}, {points}, each on {days}, seed {summary['seed']}"
        note = "means a day; ± is the 95 % interval of the mean"
        return "\n".join([head, "", *_table([_shown(row) for row in self._rows()]), note])

    def __repr__(self) -> str:
        return f"<Sweep of {self.network}: {len(self.points)} points, {len(self.policies)} policies>"


def sweep(
    network: str | os.PathLike[str] | Network,
    changes: Mapping[str, Iterable[Any]],
    policies: Iterable[str],
    *,
    days: SupportsIndex = 100,
    seed: SupportsIndex = 1,
    models: Mapping[str, Given] | None = None,
    bound: bool = False,
    step: SupportsIndex = 5,
    policy_seed: SupportsIndex | None = None,
    threads: int | None = None,
) -> Sweep:
    """Compares policies on variations of a network, all on days of the same seeds.

    On six variations, for example::

        sweep(network, {"fleet.0.count": [36, 40, 44], "vertiports.*.stands": [6, 8]}, ["greedy", "prices"])

    Args:
        network: what is varied: the network, its name, or the path of its file.
        changes: values by paths of the network file, as :meth:`Network.changed` takes them. Every combination
            is a point; the values of the last path change fastest. Where two paths lead to one member, the
            later one wins.
        policies: as for :func:`compare`, and so is all that follows.
        days: number of days.
        seed: seed of the first day.
        models: what names stand for: weight files, models, or functions from an observation to an action.
        bound: whether every day's upper bound is proven.
        step: minutes for which the bound's prices stay the same.
        policy_seed: seed of the random policy and of the planner's search.
        threads: number of threads; all cores without.

    Raises:
        Error: V123 if a path leads nowhere, V451 if `changes` are no lists of values; else as a network file
            with the change would be refused, before any day is played, or as :func:`compare` refuses.
    """
    network = network_of(network)
    points = variations(network, changes)
    asked = Asked.of("vertifleet.compare", policies, days, seed, models, bound, step, policy_seed)
    asked.check(variation for _, variation in points)
    comparisons = [asked.compare(variation, asked.days, asked.seed, threads) for _, variation in points]
    return Sweep(network.name, asked.policies, together(points, comparisons))


def variations(
    network: Network, changes: Mapping[str, Iterable[Any]]
) -> list[tuple[dict[str, Any], Network]]:
    """Every combination of the values: what is changed, and the network with the change."""
    values = [_values(path, values) for path, values in changes.items()]
    grid = [dict(zip(changes, point, strict=True)) for point in itertools.product(*values)]
    return [(point, network.changed(point)) for point in grid]


def together(
    points: Sequence[tuple[dict[str, Any], Network]], comparisons: Sequence[Comparison]
) -> tuple[tuple[dict[str, Any], Comparison], ...]:
    """What was changed, with the comparison there."""
    return tuple((changes, found) for (changes, _), found in zip(points, comparisons, strict=True))


def _values(path: str, values: Iterable[Any]) -> list[Any]:
    """The values as network files take them; numpy's numbers are made Python's."""
    if isinstance(values, (str, bytes, Mapping)) or not hasattr(values, "__iter__"):
        raise Error("V451", f"changes: {path} must have a list of values, found {values!r}")
    listed = [value.item() if isinstance(value, np.generic) else value for value in values]
    if not listed:
        raise Error("V451", f"changes: {path} must have at least one value, found none")
    return listed


def _means(policy: Mapping[str, Any]) -> dict[str, float]:
    """What a comparison's summary says of a policy, by column."""
    profit, share = policy["profit_usd"], policy["bound_share"]
    half_width = math.nan if profit["half_width_95"] is None else profit["half_width_95"]
    means = {
        "profit_usd": profit["mean"],
        "profit_low_usd": profit["mean"] - half_width,
        "profit_high_usd": profit["mean"] + half_width,
        "reward": policy["reward"]["mean"],
        "flights": policy["flights"],
        "load_factor": policy["load_factor"],
    }
    return means if share is None else means | {"bound_share": share["mean"]}


def _column(values: list[Any]) -> NDArray[Any]:
    """An array of numbers, texts or truths; of objects where they are none of these, or mixed."""
    kinds = {type(value) for value in values}
    if kinds <= {int, float} or kinds in ({str}, {bool}):
        return np.array(values)
    column = np.empty(len(values), object)
    column[:] = values
    return column


def _shown(row: Mapping[str, Any]) -> dict[str, str]:
    """A row's cells as people read them, by heading."""
    cells = {name: str(value) for name, value in row.items() if name not in MEANS}
    half_width = (row["profit_high_usd"] - row["profit_low_usd"]) / 2
    cells["profit, $ a day"] = f"{row['profit_usd']:,.0f}" + (
        "" if math.isnan(half_width) else f" ± {half_width:,.0f}"
    )
    cells["reward"] = f"{row['reward']:.4f}"
    cells["flights"] = f"{row['flights']:,.1f}"
    cells["load factor"] = f"{row['load_factor']:.3f}"
    if "bound_share" in row:
        cells["share of bound"] = f"{100 * row['bound_share']:.2f} %"
    return cells


def _table(rows: Sequence[Mapping[str, str]]) -> Iterator[str]:
    """The lines of a table; the policies' names are set left, all else right."""
    widths = {name: max(len(name), *(len(row[name]) for row in rows)) for name in rows[0]}

    def line(cells: Mapping[str, str]) -> str:
        set_ = (
            cells[name].ljust(width) if name == "policy" else cells[name].rjust(width)
            for name, width in widths.items()
        )
        return "  ".join(set_).rstrip()

    yield line({name: name for name in widths})
    yield "-" * (sum(widths.values()) + 2 * (len(widths) - 1))
    yield from map(line, rows)

"""Sweeps: the same comparison on variations of a network, for questions like "and with 12 more aircraft?"."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any, SupportsIndex

import numpy as np

from vertifleet import _native
from vertifleet._compare import ComparisonRequest, DrawnDays, Split, network_of
from vertifleet._errors import Error

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    import pandas
    import polars
    from numpy.typing import NDArray

    from vertifleet._compare import PolicySource
    from vertifleet._native import Comparison, Network

MEANS = ("profit_usd", "profit_low_usd", "profit_high_usd", "reward", "flights", "load_factor", "bound_share")
"""The columns that are means over the days; the last exists only if bounds were asked for."""


@dataclass(frozen=True, eq=False, repr=False)
class Sweep:
    """Variations of a network, with the results of every policy on each."""

    network: str
    """Name of the network."""
    policies: tuple[str, ...]
    """The policies, in the order they were asked for."""
    cells: tuple[tuple[dict[str, Any], Comparison | str], ...]
    """The variations in their order: what was changed, and the comparison with that change, or the reason why
    there is none."""
    varied: Network = field(kw_only=True)
    """The network that was varied."""
    command: str = field(kw_only=True)
    """The call, for the report."""
    _native: _native.Sweep = field(kw_only=True)

    @property
    def points(self) -> tuple[tuple[dict[str, Any], Comparison], ...]:
        """The variations that were played, in their order: what was changed, and the comparison with it."""
        return tuple((changes, found) for changes, found in self.cells if not isinstance(found, str))

    @property
    def left_out(self) -> tuple[tuple[dict[str, Any], str], ...]:
        """The variations whose fleet has no aircraft or no place: what was changed, and the reason."""
        return tuple((changes, found) for changes, found in self.cells if isinstance(found, str))

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """A row for each point and policy, as numpy arrays by column.

        The first columns are what was changed, one for each path of the network file. Then come ``policy``
        and the means over the days: ``profit_usd`` with its 95 % confidence interval from ``profit_low_usd``
        to ``profit_high_usd`` (NaN for a single day), ``reward``, ``flights``, ``load_factor``, and
        ``bound_share`` if bounds were asked for.
        """
        rows = list(self._rows())
        return {name: _column([row[name] for row in rows]) for name in rows[0]}

    def _rows(self) -> Iterator[dict[str, Any]]:
        for changes, comparison in self.points:
            of_policy = {policy["name"]: policy for policy in comparison.summary["policies"]}
            for name in self.policies:
                yield changes | {"policy": name} | _means(of_policy[name])

    def to_pandas(self) -> pandas.DataFrame:
        """The columns as a pandas frame."""
        from pandas import DataFrame

        frame: pandas.DataFrame = DataFrame(self.columns)
        return frame

    def to_polars(self) -> polars.DataFrame:
        """The columns as a polars frame."""
        from polars import DataFrame

        return DataFrame(self.columns)

    def report(self, folder: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Writes the folder that ``vertifleet sweep --out`` writes, and returns the path of its page.

        The folder has tables as CSV and Parquet, ``summary.json``, figures as SVG and PNG, and a page with
        response curves, a heat map, what matters most, and the cheapest point within 1 % of the best. Points
        are judged by the first policy. An earlier sweep in the folder is replaced.

        Args:
            folder: a folder that is empty, is not there yet, or holds a sweep.
            force: whether to write into a folder that holds anything else.

        Raises:
            Error: V143 if the folder holds something else.
        """
        return self._native.report(folder, force=force, command=self.command)

    def __str__(self) -> str:
        summary = self.points[0][1].summary
        days = "1 day" if summary["days"] == 1 else f"{summary['days']:,} days"
        points = "1 point" if len(self.points) == 1 else f"{len(self.points)} points"
        head = f"network {self.network}, {points}, each on {days}, seed {summary['seed']}"
        notes = ["means a day; ± is the 95 % interval of the mean"]
        if self.left_out:
            notes.append(f"{len(self.left_out)} left out, whose fleet has no aircraft or no place")
        return "\n".join([head, "", *_table([_shown(row) for row in self._rows()]), *notes])

    def _repr_html_(self) -> str:
        rows = [_shown(row) for row in self._rows()]
        heading = "".join(f"<th>{escape(name)}</th>" for name in rows[0])
        cells = ("".join(f"<td>{escape(cell)}</td>" for cell in row.values()) for row in rows)
        return f"<table><tr>{heading}</tr>" + "".join(f"<tr>{row}</tr>" for row in cells) + "</table>"

    def __repr__(self) -> str:
        return f"<Sweep of {self.network}: {len(self.points)} points, {len(self.policies)} policies>"


def sweep(
    network: str | os.PathLike[str] | Network,
    changes: Mapping[str, Iterable[Any] | str],
    policies: Iterable[str],
    *,
    latin: SupportsIndex | None = None,
    days: SupportsIndex = 100,
    seed: SupportsIndex = 1,
    split: Split | None = None,
    models: Mapping[str, PolicySource] | None = None,
    bound: bool = False,
    step: SupportsIndex = 5,
    policy_seed: SupportsIndex | None = None,
    threads: int | None = None,
    journal: str | os.PathLike[str] | None = None,
) -> Sweep:
    """Compares policies on variations of a network, all on days of the same seeds.

    For example, this compares on six variations, and then on twenty of a Latin hypercube::

        sweep(network, {"fleet.0.count": [36, 40, 44], "vertiports.*.stands": [6, 8]}, ["greedy", "prices"])
        sweep(network, {"fleet.0.count": "30..50", "tariffs.fare_level": "0.8..1.6"}, ["prices"], latin=20)

    A variation whose fleet has more aircraft than there are stands is left out.

    Args:
        network: the network to vary, its name, or the path of its file.
        changes: values by paths of the network file, as in :meth:`Network.changed`: a list, or a text as
            ``vertifleet sweep --vary`` takes it, such as ``"30..50/5"``, a range with a step. Every
            combination is a point; the values of the last path change fastest. If two paths lead to the same
            member, the later one wins; one that changes nothing then is refused.
        latin: number of variations of a Latin hypercube, drawn with `seed`, in place of all combinations.
            Ranges then need no step (``"0.8..1.6"``), and are of whole numbers if both ends are.
        policies: as in :func:`compare`, like all arguments that follow.
        days: number of days.
        seed: seed of the first day.
        split: whose days, as in :func:`compare`.
        models: weight files, models, or functions from an observation to an action, by policy name.
        bound: whether to prove an upper bound of every day.
        step: length of the bound's slices in minutes.
        policy_seed: seed of the random policy and of the planner's search.
        threads: most threads to use; all cores by default.
        journal: a file in which every finished point is kept. The same call with the same file goes on where
            an earlier one ended, even if that was killed. A function of `models` is known to it by its name
            alone.

    Raises:
        Error: V123 if a path leads nowhere; V407 if a text is no range, if there are more than 10,000
            points, or if none of them can be played; V451 if values are neither a list nor a text; V414 if
            the journal is of another sweep; the error of a network file with the change, before any day is
            played; and those of :func:`compare`.
    """
    network, drawn = network_of(network), DrawnDays.of(days, seed, split)
    request = ComparisonRequest.of("vertifleet.compare", policies, drawn, models, bound, step, policy_seed)
    native = begin(network, changes, latin, request, journal)
    native.run(threads=threads)
    return end(native, network, request, call_of("vertifleet.sweep", network, changes, latin, request))


def begin(
    network: Network,
    changes: Mapping[str, Iterable[Any] | str],
    latin: SupportsIndex | None,
    request: ComparisonRequest,
    journal: str | os.PathLike[str] | None,
) -> _native.Sweep:
    """The sweep, of which the cells in the journal are finished."""
    given = {path: _values(path, values) for path, values in changes.items()}
    native = _native.Sweep(network, given, request.for_native(), latin, journal)
    for text in native.warnings:
        warnings.warn(text, stacklevel=3)
    return native


def end(native: _native.Sweep, network: Network, request: ComparisonRequest, command: str) -> Sweep:
    """The results of a sweep whose cells are finished."""
    cells = native.cells()
    sources = [f"{network.source}.changed({changes})" if changes else network.source for changes, _ in cells]
    commands = list(map(request.call_text, sources))
    found = zip(cells, native.comparisons(commands), strict=True)
    results = tuple((changes, comparison or str(reason)) for (changes, reason), comparison in found)
    return Sweep(network.name, request.policies, results, varied=network, command=command, _native=native)


def call_of(
    function: str,
    network: Network,
    changes: Mapping[str, Iterable[Any] | str],
    latin: SupportsIndex | None,
    request: ComparisonRequest,
) -> str:
    """The call of a sweep, for people to read; `function` is what was called."""
    varied = ", ".join(
        f"{path!r}: {values!r}" if isinstance(values, str) else f"{path!r}: [...]"
        for path, values in changes.items()
    )
    drawn = "" if latin is None else f"latin={latin}, "
    return (
        f"{function}({network.name!r}, {{{varied}}}, {list(request.policies)!r}, {drawn}{request.days.text})"
    )


def _values(path: str, values: Iterable[Any] | str) -> list[Any] | str:
    """The values as a list, or the text that stands for them."""
    if isinstance(values, str):
        return values
    if isinstance(values, (bytes, Mapping)) or not hasattr(values, "__iter__"):
        raise Error("V451", f"changes: {path} must have a list of values, found {values!r}")
    listed = list(values)
    if not listed:
        raise Error("V451", f"changes: {path} must have at least one value, found none")
    return listed


def _means(policy: Mapping[str, Any]) -> dict[str, float]:
    """The means of a policy from a comparison's summary, by column."""
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
    """An array of numbers, texts or bools; an array of objects if the values are of other or mixed types."""
    kinds = {type(value) for value in values}
    if kinds <= {int, float} or kinds in ({str}, {bool}):
        return np.array(values)
    column = np.empty(len(values), object)
    column[:] = values
    return column


def _shown(row: Mapping[str, Any]) -> dict[str, str]:
    """The cells of a row as text, by heading."""
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
    """The lines of a table; the policies' names are aligned left, all other cells right."""
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

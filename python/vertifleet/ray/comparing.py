"""`compare` and `sweep`, as tasks of a Ray cluster."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, SupportsIndex

from vertifleet._compare import ComparisonRequest, DrawnDays, network_of
from vertifleet._sweep import Sweep, begin, call_of, end
from vertifleet.ray.tasks import played

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Mapping

    from vertifleet._compare import PolicySource, Split
    from vertifleet._native import Comparison, Network


def compare(
    network: str | os.PathLike[str] | Network,
    policies: Iterable[str],
    *,
    days: SupportsIndex = 100,
    seed: SupportsIndex = 1,
    split: Split | None = None,
    models: Mapping[str, PolicySource] | None = None,
    bound: bool = False,
    step: SupportsIndex = 5,
    policy_seed: SupportsIndex | None = None,
    days_per_task: int | None = None,
) -> Comparison:
    """Does the same as :func:`vertifleet.compare`, on all CPUs of a Ray cluster.

    The result is the same, bit for bit, for any number of nodes and any size of the tasks (for learned
    policies, if all nodes have the same kind of CPU). Times per decision are measured on the nodes. If a
    worker or a node dies, the days that it was playing are played again.

    Network, weights and functions are sent with the tasks, so the files need to be on this machine only. If
    `ray.init` was not called before, the cluster is the one that the environment variable RAY_ADDRESS names,
    or one that runs on this machine, or otherwise a new one on this machine.

    Args:
        network: as in :func:`vertifleet.compare`, like all arguments that follow except the last.
        policies: names of the policies.
        days: number of days.
        seed: seed of the first day.
        split: whose days.
        models: weights or functions, by policy name.
        bound: whether to prove an upper bound of every day.
        step: length of the bound's slices in minutes.
        policy_seed: seed of the random policy and of the planner's search.
        days_per_task: number of consecutive days that one task plays, on one CPU; by default each CPU gets
            about sixteen tasks.

    Raises:
        Error: as :func:`vertifleet.compare`; V409 if a node has another version of the package.
    """
    network, drawn = network_of(network), DrawnDays.of(days, seed, split)
    request = ComparisonRequest.of(
        "vertifleet.ray.compare", policies, drawn, models, bound, step, policy_seed
    )
    request.check([network])
    ((_, comparison),) = played({0: network}, request, drawn, days_per_task)
    return comparison


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
    days_per_task: int | None = None,
    journal: str | os.PathLike[str] | None = None,
) -> Sweep:
    """Does the same as :func:`vertifleet.sweep`, with the days of all points on all CPUs of a Ray cluster.

    The description of :func:`compare` applies here too.

    Args:
        network: as in :func:`vertifleet.sweep`, like all arguments that follow except the last.
        changes: values by paths of the network file.
        latin: number of variations of a Latin hypercube.
        policies: names of the policies.
        days: number of days.
        seed: seed of the first day.
        split: whose days.
        models: weights or functions, by policy name.
        bound: whether to prove an upper bound of every day.
        step: length of the bound's slices in minutes.
        policy_seed: seed of the random policy and of the planner's search.
        days_per_task: number of consecutive days of a point that one task plays.
        journal: a file on this machine in which every finished point is kept, as in
            :func:`vertifleet.sweep`. It may be a file that a sweep without Ray has begun.

    Raises:
        Error: as :func:`vertifleet.sweep`; V409 if a node has another version of the package.
    """
    network, drawn = network_of(network), DrawnDays.of(days, seed, split)
    request = ComparisonRequest.of(
        "vertifleet.ray.compare", policies, drawn, models, bound, step, policy_seed
    )
    native = begin(network, changes, latin, request, journal)
    missing = {cell: native.network(cell) for cell in native.missing()}
    said: dict[str, None] = {}
    for cell, comparison in played(missing, request, drawn, days_per_task):
        native.add(cell, comparison)
        said.update(dict.fromkeys(comparison.warnings))
    for text in said.keys() - native.warnings:
        warnings.warn(text, stacklevel=2)
    return end(native, network, request, call_of("vertifleet.ray.sweep", network, changes, latin, request))

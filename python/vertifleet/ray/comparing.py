"""`compare` and `sweep`, as tasks of a Ray cluster."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, SupportsIndex

from vertifleet._compare import ComparisonRequest, DrawnDays, network_of
from vertifleet._kept import Parts
from vertifleet._sweep import Sweep, call_of, played, together, variations
from vertifleet.ray.tasks import play_missing

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
    parts = Parts(drawn)
    play_missing([network], request, parts, days_per_task)
    return parts.joined(0)


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
        journal: a file on this machine in which the days of every finished task are kept, as in
            :func:`vertifleet.sweep`. It may be a file that a sweep without Ray has begun.

    Raises:
        Error: as :func:`vertifleet.sweep`; V409 if a node has another version of the package.
    """
    network, drawn = network_of(network), DrawnDays.of(days, seed, split)
    cells = variations(network, changes, latin, drawn)
    points = played(cells)
    request = ComparisonRequest.of(
        "vertifleet.ray.compare", policies, drawn, models, bound, step, policy_seed
    )
    parts = Parts.open(journal, network, [changes for changes, _ in points], request, drawn)
    play_missing([variation for _, variation in points], request, parts, days_per_task)
    call = call_of("vertifleet.ray.sweep", network, changes, latin, request)
    return Sweep(network.name, request.policies, together(cells, parts), varied=network, command=call)

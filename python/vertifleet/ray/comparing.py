"""`compare` and `sweep`, as tasks of a Ray cluster."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, SupportsIndex

from vertifleet._compare import Asked, network_of
from vertifleet._sweep import Sweep, together, variations
from vertifleet.ray.tasks import comparisons

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Mapping

    from vertifleet._compare import Given
    from vertifleet._native import Comparison, Network


def compare(
    network: str | os.PathLike[str] | Network,
    policies: Iterable[str],
    *,
    days: SupportsIndex = 100,
    seed: SupportsIndex = 1,
    models: Mapping[str, Given] | None = None,
    bound: bool = False,
    step: SupportsIndex = 5,
    policy_seed: SupportsIndex | None = None,
    days_per_task: int | None = None,
) -> Comparison:
    """:func:`vertifleet.compare`, its days on all CPUs of a Ray cluster.

    The result is the same, bit for bit, whatever the number of nodes and the size of the tasks (learned
    policies: on one kind of CPU); times per decision are measurements of the nodes. What a worker or a node
    that dies was playing is played again.

    Network, weights and functions travel with the tasks: files need to be on this machine alone. Without
    `ray.init` before, the cluster is the one that the environment variable RAY_ADDRESS names, or one that
    runs here, or else this machine.

    Args:
        network: as for :func:`vertifleet.compare`, and so is all that follows but the last.
        policies: names of the policies.
        days: number of days.
        seed: seed of the first day.
        models: what names stand for.
        bound: whether every day's upper bound is proven.
        step: minutes for which the bound's prices stay the same.
        policy_seed: seed of the random policy and of the planner's search.
        days_per_task: consecutive days that one task plays, on one CPU; without, so many that each CPU gets
            about sixteen tasks.

    Raises:
        Error: as :func:`vertifleet.compare`; V409 if a node has another version of the package.
    """
    network = network_of(network)
    asked = Asked.of("vertifleet.ray.compare", policies, days, seed, models, bound, step, policy_seed)
    return comparisons([network], asked, days_per_task)[0]


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
    days_per_task: int | None = None,
) -> Sweep:
    """:func:`vertifleet.sweep`, the days of all its points on all CPUs of a Ray cluster.

    What is said of :func:`compare` holds here too.

    Args:
        network: as for :func:`vertifleet.sweep`, and so is all that follows but the last.
        changes: values by paths of the network file.
        policies: names of the policies.
        days: number of days.
        seed: seed of the first day.
        models: what names stand for.
        bound: whether every day's upper bound is proven.
        step: minutes for which the bound's prices stay the same.
        policy_seed: seed of the random policy and of the planner's search.
        days_per_task: consecutive days of a point that one task plays.

    Raises:
        Error: as :func:`vertifleet.sweep`; V409 if a node has another version.
    """
    network = network_of(network)
    points = variations(network, changes)
    asked = Asked.of("vertifleet.ray.compare", policies, days, seed, models, bound, step, policy_seed)
    found = comparisons([variation for _, variation in points], asked, days_per_task)
    return Sweep(network.name, asked.policies, together(points, found))

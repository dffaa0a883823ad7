"""Days as Ray tasks: each plays some consecutive days of a network, and the results are joined in order.

If the worker or node of a task dies, the task is run again, as often as necessary; it is a function of its
arguments, so its result is the same. An error of the task itself ends the whole call.
"""

from __future__ import annotations

import math
import os
from dataclasses import replace
from importlib.metadata import version
from typing import TYPE_CHECKING

import ray
from ray.exceptions import RayTaskError

from vertifleet import Comparison, Error, Model
from vertifleet._compare import DrawnDays
from vertifleet.ray.progress import Progress

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import TypeAlias

    from ray import ObjectRef

    from vertifleet import Network
    from vertifleet._compare import ComparisonRequest, PolicySource

    Task: TypeAlias = ObjectRef[Comparison]
    Part: TypeAlias = tuple[ObjectRef[Network], int, int]
    """A network, a number of days, and the seed of the first."""

TASKS_PER_CPU = 16
"""Many tasks per CPU keep the wait for the last one short, and lose little when a node dies."""
AHEAD = 2
"""Tasks in flight for each CPU: no CPU waits for its next task, and an error or Ctrl-C leaves few behind."""
GLANCE_S = 0.5
"""Seconds between two checks of which tasks are done and how many CPUs there are."""


def without_files(request: ComparisonRequest) -> ComparisonRequest:
    """The request with weight files replaced by their models, so that nodes need no files."""
    models = {name: _read(given) for name, given in request.models.items()}
    return replace(request, models=models)


def _read(given: PolicySource) -> PolicySource:
    return Model.read(given) if isinstance(given, (str, os.PathLike)) else given


@ray.remote(num_cpus=1, max_retries=-1)
def play(request: ComparisonRequest, here: str, network: Network, days: int, seed: int) -> Comparison:
    """Plays some days, the first with seed `seed`; `here` is the package version of the calling process."""
    found = version("vertifleet")
    if found != here:
        rule = f"the parts do not go together: vertifleet {found} on a node, {here} here"
        raise Error("V409", rule, "install the same version on all nodes")
    return request.compare(network, 1, DrawnDays(days, seed))


def comparisons(
    networks: Sequence[Network], request: ComparisonRequest, drawn: DrawnDays, days_per_task: int | None
) -> list[Comparison]:
    """Runs a comparison on `drawn` days of each of the networks."""
    if days_per_task is not None and days_per_task < 1:
        raise Error("V451", f"days_per_task must be at least 1, found {days_per_task}")
    request = without_files(request)
    request.check(networks, stacklevel=4)
    if not ray.is_initialized():
        ray.init()
    most = days_per_task or _days_per_task(drawn.days * len(networks))
    parts = [
        (here, number, drawn.seed + first)
        for here in map(ray.put, networks)
        for first, number in _parts(drawn.days, most)
    ]
    found = _play(ray.put(request), parts)
    each = len(found) // len(networks)
    return [Comparison.join(found[at : at + each]) for at in range(0, len(found), each)]


def _days_per_task(days: int) -> int:
    return max(math.ceil(days / (TASKS_PER_CPU * _cpus())), 1)


def _parts(days: int, most: int) -> Iterator[tuple[int, int]]:
    """The first day and the number of days of each part."""
    return ((first, min(most, days - first)) for first in range(0, days, most))


def _play(request: ObjectRef[ComparisonRequest], parts: Sequence[Part]) -> list[Comparison]:
    """Plays the parts and returns their comparisons in order. After an error or Ctrl-C, no part is begun.

    Tasks in flight then run to their end in the background: `ray.cancel` of a task that ends at the same time
    can crash this whole process (seen with Ray 2.60, "Tried to complete task that was not pending").
    """
    found: dict[int, Comparison] = {}
    playing: dict[Task, int] = {}
    days_played = 0
    with Progress(sum(days for _, days, _ in parts)) as progress:
        while len(found) < len(parts):
            begun = len(found) + len(playing)
            for part in range(begun, min(begun + _room(len(playing)), len(parts))):
                playing[play.remote(request, version("vertifleet"), *parts[part])] = part
            done, _ = ray.wait(list(playing), timeout=GLANCE_S)
            for task in done:
                part = playing.pop(task)
                found[part] = _result(task)
                days_played += parts[part][1]
            progress.show(days_played)
    return [found[part] for part in range(len(parts))]


def _room(playing: int) -> int:
    """Number of tasks that can be begun now."""
    return max(AHEAD * _cpus() - playing, 0)


def _cpus() -> int:
    resources: dict[str, float] = ray.cluster_resources()  # type: ignore[no-untyped-call]
    return max(int(resources.get("CPU", 1)), 1)


def _result(task: Task) -> Comparison:
    try:
        return ray.get(task)
    except RayTaskError as failed:
        if isinstance(failed.cause, Error):
            raise failed.cause from None
        raise

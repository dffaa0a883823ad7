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
from vertifleet.ray.progress import Progress

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import TypeAlias

    from ray import ObjectRef

    from vertifleet import Network
    from vertifleet._compare import ComparisonRequest, DrawnDays, PolicySource
    from vertifleet._kept import Parts

    Flying: TypeAlias = ObjectRef[Comparison]
    """A task that has been sent off."""
    Task: TypeAlias = tuple[int, DrawnDays]
    """The number of a network, and days of it."""

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
def play(request: ComparisonRequest, here: str, network: Network, days: DrawnDays) -> Comparison:
    """Plays some days; `here` is the package version of the calling process."""
    found = version("vertifleet")
    if found != here:
        rule = f"the parts do not go together: vertifleet {found} on a node, {here} here"
        raise Error("V409", rule, "install the same version on all nodes")
    return request.compare(network, 1, days)


def play_missing(
    networks: Sequence[Network], request: ComparisonRequest, parts: Parts, days_per_task: int | None
) -> None:
    """Plays the days of each of the networks that `parts` does not have yet, and adds them to it.

    After an error or Ctrl-C, no task is begun. Tasks in flight then run to their end in the background:
    `ray.cancel` of a task that ends at the same time can crash this whole process (seen with Ray 2.60, "Tried
    to complete task that was not pending").
    """
    if days_per_task is not None and days_per_task < 1:
        raise Error("V451", f"days_per_task must be at least 1, found {days_per_task}")
    request = without_files(request)
    request.check(networks, stacklevel=4)
    if not ray.is_initialized():
        ray.init()
    tasks = _tasks(networks, parts, days_per_task)
    here, shared, sent = version("vertifleet"), list(map(ray.put, networks)), ray.put(request)
    playing: dict[Flying, Task] = {}
    begun = days_played = 0
    with Progress(sum(days.days for _, days in tasks)) as progress:
        while begun < len(tasks) or playing:
            for point, days in tasks[begun : begun + _room(len(playing))]:
                flying = play.remote(sent, here, shared[point], days)
                playing[flying] = point, days
                begun += 1
            done, _ = ray.wait(list(playing), timeout=GLANCE_S)
            for flying in done:
                point, days = playing.pop(flying)
                parts.add(point, days, _result(flying))
                days_played += days.days
            progress.show(days_played)


def _tasks(networks: Sequence[Network], parts: Parts, days_per_task: int | None) -> list[Task]:
    """What is missing, in tasks; by default there are so many of them that every CPU gets TASKS_PER_CPU."""

    def tasks(most: int) -> list[Task]:
        return [(point, days) for point in range(len(networks)) for days in parts.missing(point, most)]

    if days_per_task is None:
        missing = sum(days.days for _, days in tasks(parts.days_each))
        days_per_task = max(math.ceil(missing / (TASKS_PER_CPU * _cpus())), 1)
    return tasks(days_per_task)


def _room(playing: int) -> int:
    """Number of tasks that can be begun now."""
    return max(AHEAD * _cpus() - playing, 0)


def _cpus() -> int:
    resources: dict[str, float] = ray.cluster_resources()  # type: ignore[no-untyped-call]
    return max(int(resources.get("CPU", 1)), 1)


def _result(flying: Flying) -> Comparison:
    try:
        return ray.get(flying)
    except RayTaskError as failed:
        if isinstance(failed.cause, Error):
            raise failed.cause from None
        raise

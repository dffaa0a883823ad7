"""Days as Ray tasks: each plays some consecutive days of a network, and the results are joined in order.

If the worker or node of a task dies, the task is run again, as often as necessary; it is a function of its
arguments, so its result is the same. An error of the task itself ends the whole call.
"""

from __future__ import annotations

import math
import os
from collections import Counter, defaultdict
from dataclasses import replace
from importlib.metadata import version
from typing import TYPE_CHECKING

import ray
from ray.exceptions import RayTaskError

from vertifleet import Comparison, Error, Model
from vertifleet._compare import DrawnDays
from vertifleet.ray.progress import Progress

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping
    from typing import TypeAlias

    from ray import ObjectRef

    from vertifleet import Network
    from vertifleet._compare import ComparisonRequest, PolicySource

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


def played(
    networks: Mapping[int, Network],
    request: ComparisonRequest,
    drawn: DrawnDays,
    days_per_task: int | None,
) -> Iterator[tuple[int, Comparison]]:
    """Plays the days of each of the networks, and yields its number and its comparison when they are over.

    After an error or Ctrl-C, no task is begun. Tasks in flight then run to their end in the background:
    `ray.cancel` of a task that ends at the same time can crash this whole process (seen with Ray 2.60, "Tried
    to complete task that was not pending").
    """
    if days_per_task is not None and days_per_task < 1:
        raise Error("V451", f"days_per_task must be at least 1, found {days_per_task}")
    if not ray.is_initialized():
        ray.init()
    tasks = _tasks(networks, drawn, days_per_task)
    shared = {number: ray.put(network) for number, network in networks.items()}
    here, sent = version("vertifleet"), ray.put(without_files(request))
    playing: dict[Flying, Task] = {}
    parts: defaultdict[int, dict[int, Comparison]] = defaultdict(dict)
    missing = Counter(network for network, _ in tasks)
    begun = days_played = 0
    with Progress(sum(days.days for _, days in tasks)) as progress:
        while begun < len(tasks) or playing:
            for network, days in tasks[begun : begun + _room(len(playing))]:
                flying = play.remote(sent, here, shared[network], days)
                playing[flying] = network, days
                begun += 1
            done, _ = ray.wait(list(playing), timeout=GLANCE_S)
            for flying in done:
                network, days = playing.pop(flying)
                parts[network][days.seed] = _result(flying)
                days_played += days.days
                missing[network] -= 1
                if not missing[network]:
                    yield network, Comparison.join([part for _, part in sorted(parts.pop(network).items())])
            progress.show(days_played)


def _tasks(networks: Collection[int], drawn: DrawnDays, days_per_task: int | None) -> list[Task]:
    """The days of these networks, in tasks; by default enough of them for TASKS_PER_CPU on every
    CPU.
    """
    each = days_per_task or max(math.ceil(len(networks) * drawn.days / (TASKS_PER_CPU * _cpus())), 1)
    end = drawn.seed + drawn.days
    days = [DrawnDays(min(each, end - first), first, drawn.split) for first in range(drawn.seed, end, each)]
    return [(network, part) for network in networks for part in days]


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

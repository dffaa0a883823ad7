"""Environments that are used in several places: copies in the middle of a day, and threads."""

from __future__ import annotations

import copy
import threading
from typing import Any, ClassVar, TypeVar

import numpy as np

from vertifleet._errors import Error

Playing = TypeVar("Playing", bound="Copied")


class Copied:
    """An environment whose copies, deep or shallow, play on independently.

    They share immutable members: copying the source of the days means parsing the text of its network file
    again, which takes longer than many decisions.
    """

    _never_changes: ClassVar[tuple[str, ...]]
    """Names of the members that copies share."""

    def __copy__(self: Playing) -> Playing:
        return copy.deepcopy(self)

    def __deepcopy__(self: Playing, memo: dict[int, Any]) -> Playing:
        other = object.__new__(type(self))
        memo[id(self)] = other
        for name, member in vars(self).items():
            if name in self._never_changes:
                # `deepcopy` does not copy objects that are in the memo.
                memo[id(member)] = member
        for name, member in vars(self).items():
            kept = name in self._never_changes
            vars(other)[name] = member if kept else _copied(member, memo)
        return other


def _copied(member: Any, memo: dict[int, Any]) -> Any:
    """A deep copy. `deepcopy` takes longer for a generator than for the rest of an environment, since it
    seeds the new one from the operating system before it sets its state.
    """
    if type(member) is not np.random.Generator:
        return copy.deepcopy(member, memo)
    bits = member.bit_generator
    seeds = bits.seed_seq
    if type(seeds) is not np.random.SeedSequence:
        return copy.deepcopy(member, memo)
    same = np.random.SeedSequence(
        seeds.entropy,
        spawn_key=seeds.spawn_key,
        pool_size=seeds.pool_size,
        n_children_spawned=seeds.n_children_spawned,
    )
    others = type(bits)(same)
    others.state = bits.state
    memo[id(member)] = generator = np.random.Generator(others)
    return generator


class Alone:
    """Refuses a second thread that uses a batch while a first one does."""

    def __init__(self) -> None:
        self._lock = threading.Lock()

    def __enter__(self) -> None:
        if not self._lock.acquire(blocking=False):
            rule = "the environments are used by two threads at once"
            raise Error("V451", rule, "give each thread environments, or let the threads take turns")

    def __exit__(self, *_: object) -> None:
        self._lock.release()

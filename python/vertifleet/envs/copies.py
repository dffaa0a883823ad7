"""Environments that are used in several places: copies in the middle of a day, and threads."""

from __future__ import annotations

import copy
import threading
from typing import Any, ClassVar, TypeVar

from vertifleet._errors import Error

Playing = TypeVar("Playing", bound="Copied")


class Copied:
    """An environment whose copies, deep or shallow, play on independently.

    They share immutable members: copying a network means parsing its file's text again, which takes longer
        than many decisions.
    """

    _never_changes: ClassVar[tuple[str, ...]]
    """Names of the members that copies share."""

    def __copy__(self: Playing) -> Playing:
        return copy.deepcopy(self)

    def __deepcopy__(self: Playing, memo: dict[int, Any]) -> Playing:
        members = vars(self)
        other = object.__new__(type(self))
        # `deepcopy` does not copy objects that are in the memo.
        memo |= {id(members[name]): members[name] for name in self._never_changes if name in members}
        memo[id(self)] = other
        vars(other).update(copy.deepcopy(members, memo))
        return other


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

"""Copies of environments in the middle of a day, as tree search makes them at every node."""

from __future__ import annotations

import copy
from typing import Any, ClassVar, TypeVar

Playing = TypeVar("Playing", bound="Copied")


class Copied:
    """An environment whose copies, deep or not, play on by themselves.

    They share what never changes: copying a network means reading its file's text again, which takes longer
    than many decisions.
    """

    _never_changes: ClassVar[tuple[str, ...]]
    """Names of the members that copies share."""

    def __copy__(self: Playing) -> Playing:
        return copy.deepcopy(self)

    def __deepcopy__(self: Playing, memo: dict[int, Any]) -> Playing:
        members = vars(self)
        other = object.__new__(type(self))
        # What the memo has counts as copied.
        memo |= {id(members[name]): members[name] for name in self._never_changes if name in members}
        memo[id(self)] = other
        vars(other).update(copy.deepcopy(members, memo))
        return other

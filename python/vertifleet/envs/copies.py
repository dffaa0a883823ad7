"""Copies of environments in the middle of a day, which tree search makes at every node."""

from __future__ import annotations

import copy
from typing import Any, ClassVar, TypeVar

Playing = TypeVar("Playing", bound="Copied")


class Copied:
    """An environment whose copies, deep or shallow, play on independently.

    They share what never changes: copying a network means parsing its file's text again, which takes longer
    than many decisions.
    """

    _never_changes: ClassVar[tuple[str, ...]]
    """Names of the members that copies share."""

    def __copy__(self: Playing) -> Playing:
        return copy.deepcopy(self)

    def __deepcopy__(self: Playing, memo: dict[int, Any]) -> Playing:
        members = vars(self)
        other = object.__new__(type(self))
        # `deepcopy` takes what is in the memo for copied already.
        memo |= {id(members[name]): members[name] for name in self._never_changes if name in members}
        memo[id(self)] = other
        vars(other).update(copy.deepcopy(members, memo))
        return other

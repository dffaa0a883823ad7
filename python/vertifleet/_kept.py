"""The finished parts of a sweep, in memory or also in a file from which the same sweep can go on."""

from __future__ import annotations

import json
import os
from collections import defaultdict
from typing import TYPE_CHECKING, Any

from vertifleet._compare import DrawnDays, name_of
from vertifleet._native import Comparison, KeptParts, Model

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from vertifleet._compare import ComparisonRequest, PolicySource
    from vertifleet._native import Network


class Parts:
    """Comparisons on some days of some networks, which together make one comparison for each network."""

    def __init__(self, drawn: DrawnDays, file: KeptParts | None = None) -> None:
        self._drawn = drawn
        self._file = file
        self._found: defaultdict[int, dict[int, tuple[int, Comparison]]] = defaultdict(dict)

    @classmethod
    def open(
        cls,
        path: str | os.PathLike[str] | None,
        network: Network,
        changes: Sequence[Mapping[str, Any]],
        request: ComparisonRequest,
        drawn: DrawnDays,
    ) -> Parts:
        """The parts that a file holds, which is begun if it is not there; without a file, none.

        Raises:
            Error: V414 if the file belongs to another sweep.
        """
        if path is None:
            return cls(drawn)
        depends_on = {
            "network": network.toml,
            "changes": list(changes),
            "policies": request.policies,
            "models": {name: _known(given) for name, given in request.models.items()},
            "days": [drawn.split, drawn.seed, drawn.days],
            "bound": request.step if request.bound else None,
            "policy_seed": request.policy_seed,
        }
        file, found = KeptParts.open(path, json.dumps(depends_on, default=repr))
        parts = cls(drawn, file)
        for point, first, days, comparison in found:
            parts._remember(point, first, days, comparison)
        return parts

    @property
    def days_each(self) -> int:
        """Number of days of each of the networks."""
        return self._drawn.days

    def missing(self, point: int, most: int) -> Iterator[DrawnDays]:
        """The days of a network that are not there yet, at most so many at a time."""
        first, end = self._drawn.seed, self._drawn.seed + self._drawn.days
        found = self._found[point]
        while first < end:
            if first in found:
                first += found[first][0]
                continue
            until = min([first + most, end, *(known for known in found if known > first)])
            yield DrawnDays(until - first, first, self._drawn.split)
            first = until

    def add(self, point: int, days: DrawnDays, comparison: Comparison) -> None:
        """Adds a part, which is on the disk when this returns, if there is a file."""
        if self._file is not None:
            self._file.add(point, comparison)
        self._remember(point, days.seed, days.days, comparison)

    def joined(self, point: int) -> Comparison:
        """The comparison on all days of a network, of which none may be missing."""
        found = self._found[point]
        first, end = self._drawn.seed, self._drawn.seed + self._drawn.days
        parts = []
        while first < end:
            days, comparison = found[first]
            parts.append(comparison)
            first += days
        return parts[0] if len(parts) == 1 else Comparison.join(parts)

    def _remember(self, point: int, first: int, days: int, comparison: Comparison) -> None:
        self._found[point][first] = (days, comparison)


def _known(given: PolicySource) -> str:
    """What tells a policy from others: the hash of its weights, or the name of a function."""
    if isinstance(given, (str, os.PathLike)):
        given = Model.read(given)
    return given.sha256 if isinstance(given, Model) else name_of(given)

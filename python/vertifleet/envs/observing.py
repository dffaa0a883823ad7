"""The observations of an environment: their parts, and their spaces."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from vertifleet._errors import Error
from vertifleet._native import Days, Layout
from vertifleet._view import View

Observation: TypeAlias = dict[str, NDArray[np.float32]]
"""Arrays by the names of their parts."""

Info: TypeAlias = dict[str, Any]

PRESETS = ("paper", "full", "full-v1", "gcaps-x", "gcaps-full")


@dataclass(frozen=True)
class OwnObservation:
    """An observation of the caller: a function from a `View` to an element of a space."""

    function: Callable[[View], Any]
    space: spaces.Space[Any]


ObservationChoice: TypeAlias = str | Iterable[str] | OwnObservation
"""The name of an observation, the names of parts, or an observation of the caller."""


class Observing:
    """The parts of an observation within the rows of numbers that the native side fills."""

    def __init__(self, observation: ObservationChoice, days: Days) -> None:
        self.own: OwnObservation | None = None
        chosen: list[str] = []
        if isinstance(observation, OwnObservation):
            self.own = observation
        else:
            chosen = _parts(observation)
        self.layout = Layout(chosen, days.sizes)
        if not days.are_of_one_size and {"nodes", "aircraft"} & set(chosen):
            rule = "the paper's observation has the shape of one network, but these networks differ in size"
            raise Error("V451", rule, 'use observation="full"')
        # The paper's arrays are one-dimensional, as in the first version.
        flat = observation == "paper"
        self._places: list[tuple[str, slice, tuple[int, ...] | None]] = []
        boxes: dict[str, spaces.Space[Any]] = {}
        for name, first, sizes, low, high in self.layout.parts:
            entries = math.prod(sizes)
            shape = None if flat or len(sizes) == 1 else tuple(sizes)
            self._places.append((name, slice(first, first + entries), shape))
            boxes[name] = spaces.Box(low, high, shape or (entries,), np.float32)
        self.space: spaces.Space[Any] = self.own.space if self.own else spaces.Dict(boxes)

    def of_row(self, row: NDArray[np.float32]) -> Observation:
        """The parts of one observation; they share the row's memory."""
        return {
            name: row[place] if shape is None else row[place].reshape(shape)
            for name, place, shape in self._places
        }

    def of_rows(self, rows: NDArray[np.float32]) -> Observation:
        """The parts of many observations, one in each row; they share the rows' memory."""
        many = len(rows)
        return {
            name: rows[:, place] if shape is None else rows[:, place].reshape(many, *shape)
            for name, place, shape in self._places
        }


def _parts(observation: str | Iterable[str]) -> list[str]:
    """The names of the parts, which always have the mask."""
    if isinstance(observation, str):
        parts = Layout.preset(observation)
        if parts is None:
            known = ", ".join(f'"{name}"' for name in PRESETS)
            raise Error(
                "V451", f"there is no observation {observation!r}", f"there are {known}, and lists of parts"
            )
        return parts
    parts = list(observation)
    if len(set(parts)) < len(parts):
        raise Error("V451", f"the parts of an observation must differ, found {parts!r}")
    return parts if "action_mask" in parts else [*parts, "action_mask"]


def paper_space(vertiports: int) -> spaces.Dict:
    """The space of the paper's observation, for libraries that need it without an environment.

    `nodes` [N * F], `aircraft` [G], `clock` [1], `adjacency` [N * N], `action_mask` [N]; F = 2N + 4,
    G = 2N + 2.
    """
    parts = Layout(_parts("paper"), (vertiports, 1, 1, 1)).parts
    return spaces.Dict(
        {name: spaces.Box(low, high, (math.prod(sizes),), np.float32) for name, _, sizes, low, high in parts}
    )

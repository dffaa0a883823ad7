"""The observations and infos of every environment, for a network of N vertiports."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

Observation: TypeAlias = dict[str, NDArray[np.float32]]
"""`nodes` [N * F], `aircraft` [G], `clock` [1], `adjacency` [N * N], `action_mask` [N]; F = 2N + 4,
G = 2N + 2."""

Info: TypeAlias = dict[str, Any]

KEYS = ("nodes", "aircraft", "clock", "adjacency", "action_mask")


def observation_space(vertiports: int) -> spaces.Dict:
    """The space of observations: one-dimensional boxes, with tables laid out row by row."""
    most = float(np.finfo(np.float32).max)

    def box(size: int, high: float) -> spaces.Box:
        return spaces.Box(0.0, high, (size,), np.float32)

    return spaces.Dict(
        {
            "nodes": box(vertiports * (2 * vertiports + 4), most),
            "aircraft": box(2 * vertiports + 2, most),
            "clock": box(1, 1.0),
            "adjacency": box(vertiports * vertiports, 1.0),
            "action_mask": box(vertiports, 1.0),
        }
    )

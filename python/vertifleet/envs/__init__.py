"""The Gymnasium environments: one day at a time, and many days side by side."""

from __future__ import annotations

import gymnasium

from vertifleet.envs.fleet import FleetEnv
from vertifleet.envs.fleet_vector import FleetVectorEnv

__all__ = ["FleetEnv", "FleetVectorEnv", "register"]

ID = "vertifleet/Fleet-v0"


def register() -> None:
    """Makes the environment known to `gymnasium.make` and `gymnasium.make_vec`."""
    if ID not in gymnasium.registry:
        gymnasium.register(
            id=ID,
            entry_point="vertifleet.envs.fleet:FleetEnv",
            vector_entry_point="vertifleet.envs.fleet_vector:FleetVectorEnv",
        )

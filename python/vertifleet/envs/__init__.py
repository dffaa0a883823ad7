"""The Gymnasium environments: one day at a time, and many days in parallel."""

from __future__ import annotations

import gymnasium

from vertifleet.envs.fleet import FleetEnv
from vertifleet.envs.fleet_vector import FleetVectorEnv
from vertifleet.envs.observing import OwnObservation

__all__ = ["FleetEnv", "FleetVectorEnv", "OwnObservation", "register"]

VARIANTS = {
    "vertifleet/Fleet-v0": "paper",
    "vertifleet/Fleet-paper-v0": "paper",
    "vertifleet/Fleet-full-v0": "full",
    "vertifleet/Fleet-full-v1": "full-v1",
    "vertifleet/Fleet-gcaps-x-v0": "gcaps-x",
    "vertifleet/Fleet-gcaps-full-v0": "gcaps-full",
}
"""The registered environments, with the observation of each."""


def register() -> None:
    """Registers the environments for `gymnasium.make` and `gymnasium.make_vec`."""
    _keep_texts()
    for variant, observation in VARIANTS.items():
        if variant not in gymnasium.registry:
            gymnasium.register(
                id=variant,
                entry_point="vertifleet.envs.fleet:FleetEnv",
                vector_entry_point="vertifleet.envs.fleet_vector:FleetVectorEnv",
                kwargs={"observation": observation},
            )


def _keep_texts() -> None:
    """Makes Gymnasium's wrappers for PyTorch and other arrays leave texts in infos unchanged.

    They convert every iterable, element by element, and the elements of a text are texts. The wrappers of
    Gymnasium 1.1 have no option for this.
    """
    try:
        from gymnasium.wrappers.array_conversion import array_conversion
    except (ImportError, gymnasium.error.DependencyNotInstalled):
        return  # Without their dependencies, these wrappers cannot be used.
    array_conversion.register(str, _kept)


def _kept(text: str, xp: object, device: object = None) -> str:  # noqa: ARG001
    return text

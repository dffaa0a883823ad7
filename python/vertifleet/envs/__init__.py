"""The Gymnasium environments: one day at a time, and many days side by side."""

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
    "vertifleet/Fleet-gcaps-x-v0": "gcaps-x",
    "vertifleet/Fleet-gcaps-full-v0": "gcaps-full",
}
"""The registered environments, with what each shows."""


def register() -> None:
    """Makes the environments known to `gymnasium.make` and `gymnasium.make_vec`."""
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
    """Lets Gymnasium's wrappers for PyTorch and other arrays leave texts in infos as they are.

    They convert whatever can be iterated over, element by element, and the elements of a text are texts. The
    wrappers of Gymnasium 1.1 have no function that could be told so.
    """
    try:
        from gymnasium.wrappers.array_conversion import array_conversion
    except (ImportError, gymnasium.error.DependencyNotInstalled):
        return  # Without what they need, these wrappers cannot be used.
    array_conversion.register(str, _kept)


def _kept(text: str, xp: object, device: object = None) -> str:  # noqa: ARG001
    return text

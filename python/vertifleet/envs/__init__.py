"""The Gymnasium environments: one day at a time, and many days in parallel."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

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

    They convert every iterable, element by element, and the elements of a text are texts. They hand every
    array to the other library, which refuses arrays of texts and of other objects. The wrappers have no
    option for either.
    """
    try:
        from gymnasium.wrappers.array_conversion import array_conversion
    except (ImportError, gymnasium.error.DependencyNotInstalled):
        return  # Without their dependencies, these wrappers cannot be used.
    of_numbers = array_conversion.dispatch(np.ndarray)

    def converted(array: NDArray[Any], xp: Any, device: Any = None) -> Any:
        if array.dtype.kind in "US":
            return array
        if array.dtype != object:
            return of_numbers(array, xp, device)
        others = np.empty(array.shape, object)
        for place in np.ndindex(array.shape):
            others[place] = array_conversion(array[place], xp, device)
        return others

    array_conversion.register(str, _kept)
    array_conversion.register(np.ndarray, converted)


def _kept(text: str, xp: object, device: object = None) -> str:  # noqa: ARG001
    return text

"""Checks the arguments of environments before anything changes: V451 names the one that is refused."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, TypeAlias

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import ArrayLike, NDArray

from vertifleet._errors import Error
from vertifleet._native import Scenario
from vertifleet._view import Outcome, View
from vertifleet.envs.days import warn_of_comparison

Reward: TypeAlias = Literal["terminal", "dense"] | Callable[[View, Outcome], float]
"""The reward of a decision: a name, or a function of the decision and its outcome."""


def reward_of(reward: object) -> tuple[str, Callable[[View, Outcome], float] | None]:
    """The name of a reward for the native side, and the function that replaces it, if there is one."""
    if callable(reward):
        return "dense", reward
    if not isinstance(reward, str) or reward not in ("terminal", "dense"):
        hint = "or give a function of a View and an Outcome"
        raise Error("V451", f'reward must be "terminal" or "dense", found {reward!r}', hint)
    return reward, None


def number_of(options: Mapping[str, Any]) -> int | None:
    """The number of a day in the options of a reset."""
    if "number" not in options:
        return None
    return _number(options["number"])


def numbers_of(options: Mapping[str, Any], days: int) -> NDArray[np.uint64] | None:
    """The number of the day of each of many environments, if the options have one for all or one for each."""
    if "number" not in options:
        return None
    given = options["number"]
    if isinstance(given, np.ndarray):
        given = given.tolist()
    listed = given if isinstance(given, (list, tuple)) else [given] * days
    if len(listed) != days:
        raise Error("V451", f"option number must be one or {days} whole numbers, found {len(listed)}")
    return np.array([_number(number) for number in listed], np.uint64)


def _number(given: Any) -> int:
    number = whole("option number", given)
    if not 0 <= number < 2**64:
        raise Error("V451", f"option number must be a whole number from 0, found {number}")
    return number


def whole(name: str, number: Any) -> int:
    """A whole number of Python or NumPy; fractions, bools and texts are refused."""
    try:
        # True is a whole number for Python, but is probably not intended as one here.
        if not isinstance(number, (bool, np.bool_)):
            return operator.index(number)
    except TypeError:
        pass
    raise Error("V451", f"{name} must be a whole number, found {number!r}")


def count_of(name: str, number: Any) -> int:
    """A whole number from 1 to 2**20."""
    count = whole(name, number)
    if not 1 <= count <= 2**20:
        raise Error("V451", f"{name} must be from 1 to {2**20}, found {count}")
    return count


def autoreset_of(mode: Any) -> AutoresetMode:
    """The autoreset mode: how the day after a finished day begins."""
    try:
        return AutoresetMode(mode)
    except ValueError:
        known = ", ".join(f'"{one.value}"' for one in AutoresetMode)
        raise Error("V451", f"there is no autoreset_mode {mode!r}", f"there are {known}") from None


def action_of(action: Any) -> int:
    """An action of a single environment. A number that is no vertiport's position is an infeasible action."""
    number = whole("action", action)
    if not -(2**63) <= number < 2**63:
        raise Error("V451", f"action must be a whole number of 64 bits, found {number}")
    return number


def actions_of(actions: ArrayLike, days: int) -> NDArray[np.int64]:
    """An action for each of many days."""
    actions = np.asarray(actions)
    if actions.dtype.kind not in "iu":
        raise Error("V451", f"actions must be whole numbers, found {actions.dtype}")
    if actions.shape != (days,):
        raise Error("V451", f"actions must have shape ({days},), found {actions.shape}")
    return np.ascontiguousarray(actions, np.int64)


def seeds_of(seed: Any, days: int) -> list[int | None]:
    """A seed for each of many days: those that are given, or consecutive numbers from a single one on."""
    if isinstance(seed, np.ndarray):
        seed = seed.tolist()
    if seed is None:
        return [None] * days
    if not isinstance(seed, Sequence):
        first = whole("seed", seed)
        return [first + day for day in range(days)]
    if len(seed) != days:
        raise Error("V451", f"seed must be one or {days} numbers, found {len(seed)}")
    return [None if each is None else whole("seed", each) for each in seed]


def options_of(options: Any, *taken: str, many: bool = False) -> Mapping[str, Any]:
    """The options of a reset: "scenario", a list of them if `many`, and the names in `taken`."""
    taken = ("scenario", *taken)
    if options is None:
        return {}
    if not isinstance(options, Mapping):
        raise Error("V451", f"options of a reset must be a dict, found {options!r}")
    for name in options:
        if name not in taken:
            raise Error("V451", f"a reset has no option {name!r}", f"it takes {', '.join(taken)}")
    if "number" in options and options.get("scenario") is not None:
        raise Error("V451", "a reset takes the option scenario or the option number, not both")
    scenario = options.get("scenario")
    listed = (
        many and isinstance(scenario, (list, tuple)) and all(isinstance(day, Scenario) for day in scenario)
    )
    if not listed and not isinstance(scenario, Scenario | None):
        hint = "Scenario.read reads one, Network.draw draws one"
        raise Error("V451", f"option scenario must be a vertifleet.Scenario, found {scenario!r}", hint)
    for day in scenario if isinstance(scenario, (list, tuple)) else [scenario]:
        if day is not None:
            warn_of_comparison(day.split)
    return options


def mask_of(options: Mapping[str, Any], days: int) -> NDArray[np.bool_]:
    """The environments that a reset applies to: those of the option "reset_mask", or all without it."""
    if "reset_mask" not in options:
        return np.ones(days, np.bool_)
    mask = options["reset_mask"]
    if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_ or mask.shape != (days,):
        found = f"{mask.dtype} {mask.shape}" if isinstance(mask, np.ndarray) else repr(mask)
        raise Error("V451", f"option reset_mask must be a NumPy array of bool ({days},), found {found}")
    if not mask.any():
        raise Error("V451", "option reset_mask names no environment: one at least must be True")
    return np.array(mask, np.bool_, order="C")


def scenarios_of(options: Mapping[str, Any], days: int) -> list[Scenario] | None:
    """The scenario of each of many days, if the options have any."""
    given = options.get("scenario")
    if given is None:
        return None
    return [given] * days if isinstance(given, Scenario) else list(given)

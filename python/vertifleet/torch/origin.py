"""The origin of weights for the header of a weight file: network, settings, seed and steps.

Weights can be saved even if their origin is unknown: the header leaves such members empty.
"""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Real
from typing import TYPE_CHECKING, Any

import vertifleet
from vertifleet import Error, Network
from vertifleet._compare import network_of

if TYPE_CHECKING:
    import os

MOST_SEED = 2**32 - 1
MOST_STEPS = 2**64 - 1
NEVER = 1_000_000_000
"""Value of "eval_every" if validation days are not played, and the last weights are kept."""


def checked_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Settings in Python's types; the default is the paper's value.

    Raises:
        Error: V451 if they are not a dict, V302 and V303 if a member is unknown or out of its bounds.
    """
    if not isinstance(settings, Mapping):
        hint = f"vertifleet.settings({settings!r}) gives one" if isinstance(settings, str) else None
        raise Error("V451", f"settings must be a dict of settings by name, found {settings!r}", hint)
    return vertifleet.settings("paper", **settings)


def settings_in_words(found: Mapping[str, Any]) -> dict[str, Any] | None:
    """The settings of a library's run under the program's names; None if these cannot express them.

    Args:
        found: all settings except those of validation days, which libraries do not play.
    """
    try:
        return vertifleet.settings("paper", **found, eval_every=NEVER, eval_days=1)
    except (Error, AttributeError, TypeError, ValueError):  # schedules and other objects are not numbers
        return None


def seed_in_words(seed: Any) -> int | None:
    """The seed of a library's run; None if there was none, or if it is not a valid seed of the program."""
    try:
        return whole("seed", seed, MOST_SEED)
    except Error:
        return None


def whole(name: str, number: Any, most: int) -> int:
    """A whole number converted to Python's type."""
    counts = isinstance(number, Real) and not isinstance(number, bool)
    if counts and 0 <= number <= most and int(number) == number:
        return int(number)
    raise Error("V451", f"{name} must be a whole number from 0 to {most}, found {number!r}")


def network_trained_on(
    given: str | os.PathLike[str] | Network | None, trained_on: str | os.PathLike[str] | Network
) -> Network:
    """The network that weights were trained on; if a network is given, it must be the same.

    Raises:
        Error: V451 if another network is given; others if it cannot be read.
    """
    trained_on = network_of(trained_on)
    if given is None:
        return trained_on
    given = network_of(given)
    if given.toml == trained_on.toml:
        return given
    rule = f"the model was trained on network {trained_on.name!r}, not on the {given.name!r} given"
    if given.name == trained_on.name:
        rule = f"the network {given.name!r} given is not the one of that name that the model was trained on"
        rule += ": the texts of their files differ"
    raise Error("V451", rule, "without network=, export takes the one that it was trained on")

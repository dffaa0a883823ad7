"""Comparisons: many policies on the same days."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from vertifleet import _native
from vertifleet._errors import Error
from vertifleet._native import Comparison, Model, Network

Own: TypeAlias = Callable[[dict[str, NDArray[np.float32]]], int]
"""A policy of the caller's own: from what ``vertifleet/Fleet-v0`` shows to the position of a vertiport."""

Given: TypeAlias = str | os.PathLike[str] | Model | Own
"""What a policy's name may stand for: a weight file, a model, or a function."""


def compare(
    network: str | os.PathLike[str] | Network,
    policies: Sequence[str],
    *,
    days: int = 100,
    seed: int = 1,
    models: Mapping[str, Given] | None = None,
    bound: bool = False,
    step: int = 5,
    policy_seed: int | None = None,
    threads: int | None = None,
) -> Comparison:
    """Plays days of a network with every policy; all meet the same days.

    Args:
        network: the network, its name, or the path of its file.
        policies: as ``vertifleet compare`` names them; "plan" is the planner, which knows the days.
        days: how many.
        seed: of the first day; the others follow.
        models: what names stand for, weights or functions, where not for the rules and the shipped weights.
        bound: whether every day gets a certified upper bound. Bounds are kept in the user's cache folder.
        step: minutes for which the bounds' prices stay the same, 1 to 60; fewer give tighter bounds, later.
        policy_seed: of the random policy and of the planner's search; `seed` by default.
        threads: how many at most; all cores by default.

    Raises:
        Error: with the code that the program has for it; what a function of `models` raises is raised as is.
    """
    network = network_of(network)
    asked = Asked.of("vertifleet.compare", network, policies, days, seed, models, bound, step, policy_seed)
    comparison = asked.compare(network, days, seed, threads)
    say([comparison])
    return comparison


@dataclass(frozen=True)
class Asked:
    """What every day of a comparison is played with; parts of its days can be played apart."""

    policies: tuple[str, ...]
    models: dict[str, Given]
    bound: bool
    step: int
    policy_seed: int
    command: str
    """The call as it would be typed, for the report."""

    @classmethod
    def of(
        cls,
        function: str,
        network: Network,
        policies: Sequence[str],
        days: int,
        seed: int,
        models: Mapping[str, Given] | None,
        bound: bool,
        step: int,
        policy_seed: int | None,
    ) -> Asked:
        """What a function of the package was asked for; a single name is a list of letters nobody means."""
        if isinstance(policies, str):
            raise Error("V451", f"policies must be a list of names, found {policies!r}", f"[{policies!r}]")
        said: dict[str, object] = {"days": days, "seed": seed}
        said |= {"models": dict(models)} if models else {}
        said |= {"bound": bound, "step": step} if bound else {}
        said |= {"policy_seed": policy_seed} if policy_seed is not None else {}
        named = ", ".join(f"{name}={value!r}" for name, value in said.items())
        command = f"{function}({network.name!r}, {list(policies)!r}, {named})"
        policy_seed = seed if policy_seed is None else policy_seed
        return cls(tuple(policies), dict(models or {}), bound, step, policy_seed, command)

    def compare(self, network: Network, days: int, seed: int, threads: int | None) -> Comparison:
        """Plays some days; what is to be said of them is left in the comparison's warnings."""
        return _native.compare(
            network,
            list(self.policies),
            days=days,
            seed=seed,
            models=self.models,
            bound=self.bound,
            step=self.step,
            policy_seed=self.policy_seed,
            threads=threads,
            command=self.command,
        )


def say(comparisons: Sequence[Comparison], stacklevel: int = 3) -> None:
    """Says the warnings of comparisons, each once, as of the call that the user made, so many levels up."""
    texts = dict.fromkeys(text for comparison in comparisons for text in comparison.warnings)
    for text in texts:
        warnings.warn(text, stacklevel=stacklevel)


def network_of(network: str | os.PathLike[str] | Network) -> Network:
    """The network itself, or the one of that name or path."""
    return network if isinstance(network, Network) else Network(network)

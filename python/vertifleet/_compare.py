"""Comparisons: many policies on the same days."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from operator import index
from typing import Any, SupportsIndex, TypeAlias

import numpy as np
from numpy.typing import NDArray

from vertifleet import _native
from vertifleet._errors import Error
from vertifleet._native import Comparison, Model, Network, Scenario

PolicyFunction: TypeAlias = Callable[[dict[str, NDArray[np.float32]]], SupportsIndex]
"""A policy of the caller's own: maps an observation of ``vertifleet/Fleet-v0`` to a vertiport's position."""

PolicySource: TypeAlias = str | os.PathLike[str] | Model | PolicyFunction
"""What a policy's name may refer to: a weight file, a model, or a function."""


def compare(
    network: str | os.PathLike[str] | Network | None,
    policies: Iterable[str],
    *,
    days: SupportsIndex | None = None,
    seed: SupportsIndex | None = None,
    days_from: str | os.PathLike[str] | Iterable[str | os.PathLike[str] | Scenario] | None = None,
    models: Mapping[str, PolicySource] | None = None,
    bound: bool = False,
    step: SupportsIndex = 5,
    policy_seed: SupportsIndex | None = None,
    threads: int | None = None,
) -> Comparison:
    """Plays days of a network, or days of your own, with every policy; all policies play the same days.

    Args:
        network: the network, its name, or the path of its file. With `days_from` it may be ``None``; if it
            is given, it is the network that the functions of `models` see the days as days of.
        policies: names of policies as in ``vertifleet compare``; "plan" is the planner, which knows the days.
        days: number of days; 100 by default.
        seed: seed of the first day; the following days take the following seeds; 1 by default.
        days_from: days of your own instead of drawn ones: a folder of scenario files (all ``*.json``, in the
            order of their names), files, or scenarios. They must have the same vertiports, and each must have
            a name of its own.
        models: weights or functions, by policy name, for names other than the rules and the shipped weights.
            A function decides one decision at a time, but the days may take turns: a function that remembers
            anything between calls needs ``threads=1``, which plays one day after the other.
        bound: whether to prove an upper bound of every day. Bounds are kept in the user's cache folder.
        step: length of the bounds' slices in minutes, 1 to 60; shorter slices give tighter bounds and take
            longer.
        policy_seed: seed of the random policy and of the planner's search; `seed` by default, 0 with
            `days_from`.
        threads: most threads to use; all cores by default.

    Raises:
        Error: with the program's code for the error; an exception of a function of `models` passes through.
    """
    function = "vertifleet.compare"
    if days_from is not None:
        if days is not None or seed is not None:
            raise Error("V451", "days_from takes neither days nor seed: its days are all there already", None)
        request = ComparisonRequest.of(function, policies, 0, 0, models, bound, step, policy_seed)
        return request.compare_own(None if network is None else network_of(network), days_from, threads)
    if network is None:
        raise Error("V451", "a network to draw days from is missing", "give a network, or days_from")
    network = network_of(network)
    drawn = (100 if days is None else days, 1 if seed is None else seed)
    request = ComparisonRequest.of(function, policies, *drawn, models, bound, step, policy_seed)
    request.check([network])
    return request.compare(network, request.days, request.seed, threads)


@dataclass(frozen=True)
class ComparisonRequest:
    """The request for a comparison; parts of its days can be played separately."""

    function: str
    """The function of the package that was called."""
    policies: tuple[str, ...]
    days: int
    seed: int
    models: dict[str, PolicySource]
    bound: bool
    step: int
    policy_seed: int | None

    @classmethod
    def of(
        cls,
        function: str,
        policies: Iterable[str],
        days: SupportsIndex,
        seed: SupportsIndex,
        models: Mapping[str, PolicySource] | None,
        bound: bool,
        step: SupportsIndex,
        policy_seed: SupportsIndex | None,
    ) -> ComparisonRequest:
        """Makes the request from a call. A single policy name is refused: it would be a list of letters."""
        if isinstance(policies, str):
            raise Error(
                "V451",
                f"policies must be a list of names, found {policies!r}",
                f"{[name.strip() for name in policies.split(',')]}",
            )
        seed_of_policies = None if policy_seed is None else index(policy_seed)
        names, given = tuple(name.strip() for name in policies), dict(models or {})
        return cls(function, names, index(days), index(seed), given, bound, index(step), seed_of_policies)

    def check(self, networks: Iterable[Network], stacklevel: int = 3) -> None:
        """Refuses what cannot be played and warns of what is probably not intended, before any day is played.

        Args:
            networks: the networks that the days are drawn from.
            stacklevel: number of levels from here up to the user's call.
        """
        request = self._for_native(self.days, self.seed)
        texts = [text for network in networks for text in _native.check_comparison(network, request)]
        for text in dict.fromkeys(texts):
            warnings.warn(text, stacklevel=stacklevel)

    def compare(self, network: Network, days: int, seed: int, threads: int | None) -> Comparison:
        """Plays some of the days."""
        return _native.compare(
            network, self._for_native(days, seed), threads=threads, command=self._call_text(network)
        )

    def compare_own(
        self,
        network: Network | None,
        days_from: str | os.PathLike[str] | Iterable[str | os.PathLike[str] | Scenario],
        threads: int | None,
    ) -> Comparison:
        """Plays days of the caller's own, and warns of what is probably not intended."""
        given = [days_from] if isinstance(days_from, (str, os.PathLike)) else list(days_from)
        scenarios = [day for day in given if isinstance(day, Scenario)]
        paths = [day for day in given if not isinstance(day, Scenario)]
        if scenarios and paths:
            raise Error("V451", "days_from takes scenarios or files, not both", None)
        origin = "scenarios of the caller's"
        if paths:
            scenarios, origin = _native.read_days(paths)
        typed = self._arguments_text(f"days_from={given!r}" if paths else "days_from=...")
        found = _native.compare_own(
            scenarios,
            origin,
            network,
            self._for_native(0, 0),
            threads=threads,
            command=f"{self.function}({None if network is None else network.source}, {typed})",
        )
        for text in dict.fromkeys(found.warnings):
            warnings.warn(text, stacklevel=3)
        return found

    def _for_native(self, days: int, seed: int) -> dict[str, Any]:
        return {
            "policies": list(self.policies),
            "days": days,
            "seed": seed,
            "models": self.models,
            "bound": self.bound,
            "step": self.step,
            "policy_seed": self.seed if self.policy_seed is None else self.policy_seed,
        }

    def _call_text(self, network: Network) -> str:
        """The call as it would be typed, for the report."""
        arguments = self._arguments_text(f"days={self.days}", f"seed={self.seed}")
        return f"{self.function}({network.source}, {arguments})"

    def _arguments_text(self, *days: str) -> str:
        """The arguments after the network in the call, with `days` as the arguments about the days."""
        said = list(days)
        if self.models:
            models = ", ".join(f"{name!r}: {_name(given)}" for name, given in self.models.items())
            said.append(f"models={{{models}}}")
        if self.bound:
            said += ["bound=True", f"step={self.step}"]
        if self.policy_seed is not None:
            said.append(f"policy_seed={self.policy_seed}")
        return f"{list(self.policies)!r}, {', '.join(said)}"


def _name(given: PolicySource) -> str:
    """The name of a function, or the text of another source. A function's `repr` changes with every run."""
    return getattr(given, "__qualname__", None) or repr(given)


def network_of(network: str | os.PathLike[str] | Network) -> Network:
    """The network itself, or the network with that name or path."""
    return network if isinstance(network, Network) else Network(network)

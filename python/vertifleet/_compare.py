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

Own: TypeAlias = Callable[[dict[str, NDArray[np.float32]]], SupportsIndex]
"""A policy of the caller's own: from what ``vertifleet/Fleet-v0`` shows to the position of a vertiport."""

Given: TypeAlias = str | os.PathLike[str] | Model | Own
"""What a policy's name may stand for: a weight file, a model, or a function."""


def compare(
    network: str | os.PathLike[str] | Network | None,
    policies: Iterable[str],
    *,
    days: SupportsIndex | None = None,
    seed: SupportsIndex | None = None,
    days_from: str | os.PathLike[str] | Iterable[str | os.PathLike[str] | Scenario] | None = None,
    models: Mapping[str, Given] | None = None,
    bound: bool = False,
    step: SupportsIndex = 5,
    policy_seed: SupportsIndex | None = None,
    threads: int | None = None,
) -> Comparison:
    """Plays days of a network, or days of one's own, with every policy; all meet the same days.

    Args:
        network: the network, its name, or the path of its file. With `days_from` it may be ``None``, and only
            says as days of which network a function of `models` sees them.
        policies: as ``vertifleet compare`` names them; "plan" is the planner, which knows the days.
        days: how many; 100 by default.
        seed: of the first day; the others follow; 1 by default.
        days_from: days of one's own in place of drawn ones: a folder of scenario files (all ``*.json``, in
            the order of their names), files, or scenarios. They have the same vertiports, and each a name of
            its own.
        models: what names stand for, weights or functions, where not for the rules and the shipped weights. A
            function is asked about one decision at a time, but about several days in turn: one that remembers
            anything between calls needs ``threads=1``, which plays day after day.
        bound: whether every day gets a certified upper bound. Bounds are kept in the user's cache folder.
        step: minutes for which the bounds' prices stay the same, 1 to 60; fewer give tighter bounds, later.
        policy_seed: of the random policy and of the planner's search; `seed` by default, 0 with `days_from`.
        threads: how many at most; all cores by default.

    Raises:
        Error: with the code that the program has for it; what a function of `models` raises is raised as is.
    """
    function = "vertifleet.compare"
    if days_from is not None:
        if days is not None or seed is not None:
            raise Error("V451", "days_from takes neither days nor seed: its days are all there already", None)
        asked = Asked.of(function, policies, 0, 0, models, bound, step, policy_seed)
        return asked.compare_own(None if network is None else network_of(network), days_from, threads)
    if network is None:
        raise Error("V451", "a network to draw days from is missing", "give a network, or days_from")
    network = network_of(network)
    drawn = (100 if days is None else days, 1 if seed is None else seed)
    asked = Asked.of(function, policies, *drawn, models, bound, step, policy_seed)
    asked.check([network])
    return asked.compare(network, asked.days, asked.seed, threads)


@dataclass(frozen=True)
class Asked:
    """What a comparison is asked for; parts of its days can be played apart."""

    function: str
    """The function of the package that was called."""
    policies: tuple[str, ...]
    days: int
    seed: int
    models: dict[str, Given]
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
        models: Mapping[str, Given] | None,
        bound: bool,
        step: SupportsIndex,
        policy_seed: SupportsIndex | None,
    ) -> Asked:
        """What a function of the package was asked for; a single name would be a list of letters."""
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
        """Refuses what cannot be played, and says what is hardly meant, each thing once, before any day is.

        Args:
            networks: those that are compared on.
            stacklevel: how many levels up the user's call is.
        """
        asked = self._on(self.days, self.seed)
        texts = [text for network in networks for text in _native.check_comparison(network, asked)]
        for text in dict.fromkeys(texts):
            warnings.warn(text, stacklevel=stacklevel)

    def compare(self, network: Network, days: int, seed: int, threads: int | None) -> Comparison:
        """Plays some of the days."""
        return _native.compare(network, self._on(days, seed), threads=threads, command=self._typed(network))

    def compare_own(
        self,
        network: Network | None,
        days_from: str | os.PathLike[str] | Iterable[str | os.PathLike[str] | Scenario],
        threads: int | None,
    ) -> Comparison:
        """Plays days of the caller's own, and says what is hardly meant."""
        given = [days_from] if isinstance(days_from, (str, os.PathLike)) else list(days_from)
        scenarios = [day for day in given if isinstance(day, Scenario)]
        paths = [day for day in given if not isinstance(day, Scenario)]
        if scenarios and paths:
            raise Error("V451", "days_from takes scenarios or files, not both", None)
        origin = "scenarios of the caller's"
        if paths:
            scenarios, origin = _native.read_days(paths)
        typed = self._said(f"days_from={given!r}" if paths else "days_from=...")
        found = _native.compare_own(
            scenarios,
            origin,
            network,
            self._on(0, 0),
            threads=threads,
            command=f"{self.function}({None if network is None else network.source}, {typed})",
        )
        for text in dict.fromkeys(found.warnings):
            warnings.warn(text, stacklevel=3)
        return found

    def _on(self, days: int, seed: int) -> dict[str, Any]:
        return {
            "policies": list(self.policies),
            "days": days,
            "seed": seed,
            "models": self.models,
            "bound": self.bound,
            "step": self.step,
            "policy_seed": self.seed if self.policy_seed is None else self.policy_seed,
        }

    def _typed(self, network: Network) -> str:
        """The call as it would be typed, for the report."""
        return f"{self.function}({network.source}, {self._said(f'days={self.days}', f'seed={self.seed}')})"

    def _said(self, *days: str) -> str:
        """What stands behind the network in the call, `days` being what is said of the days."""
        said = list(days)
        if self.models:
            models = ", ".join(f"{name!r}: {_name(given)}" for name, given in self.models.items())
            said.append(f"models={{{models}}}")
        if self.bound:
            said += ["bound=True", f"step={self.step}"]
        if self.policy_seed is not None:
            said.append(f"policy_seed={self.policy_seed}")
        return f"{list(self.policies)!r}, {', '.join(said)}"


def _name(given: Given) -> str:
    """A function's name is the same every day; what Python prints of it is not."""
    return getattr(given, "__qualname__", None) or repr(given)


def network_of(network: str | os.PathLike[str] | Network) -> Network:
    """The network itself, or the one of that name or path."""
    return network if isinstance(network, Network) else Network(network)

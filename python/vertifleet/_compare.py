"""Comparisons: many policies on the same days."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from operator import index
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, TypeAlias

from vertifleet import _native
from vertifleet._errors import Error
from vertifleet._native import Comparison, Model, Network, Scenario

if TYPE_CHECKING:
    from vertifleet._own_policy import BatchPolicy, FunctionPolicy, OwnPolicy, PolicyFunction

Split: TypeAlias = Literal["training", "validation", "comparison"]
"""Days that are never days of another split."""

PolicySource: TypeAlias = (
    "str | os.PathLike[str] | Model | PolicyFunction | FunctionPolicy | OwnPolicy | type[OwnPolicy]"
    " | BatchPolicy | type[BatchPolicy]"
)
"""What a policy's name may refer to: a weight file, a model, or a policy of the caller's own."""


def compare(
    network: str | os.PathLike[str] | Network | None,
    policies: Iterable[str],
    *,
    days: SupportsIndex | None = None,
    seed: SupportsIndex | None = None,
    split: Split | None = None,
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
        split: "comparison", the default, for results; "validation", to choose settings and weights by; or
            "training". With the latter two, `seed` is the number of the first day, 1 by default.
        days_from: days of your own instead of drawn ones: a folder of scenario files (all ``*.json``, in the
            order of their names), files, or scenarios. They must have the same vertiports, and each must have
            a different name.
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
    if days_from is None:
        chosen: DrawnDays | OwnDays = DrawnDays.of(days, seed, split)
    elif days is None and seed is None and split is None:
        chosen = OwnDays.of(days_from)
    else:
        raise Error(
            "V451", "days_from takes neither days, seed nor split: its days are all there already", None
        )
    request = ComparisonRequest.of("vertifleet.compare", policies, chosen, models, bound, step, policy_seed)
    if network is not None:
        network = network_of(network)
    elif days_from is None:
        raise Error("V451", "a network to draw days from is missing", "give a network, or days_from")
    request.check([network])
    return request.compare(network, threads)


@dataclass(frozen=True)
class DrawnDays:
    """Days drawn from a network, the first from this seed and the others from the seeds that follow."""

    days: int
    seed: int
    split: Split = "comparison"

    @classmethod
    def of(
        cls, days: SupportsIndex | None, seed: SupportsIndex | None, split: Split | None = None
    ) -> DrawnDays:
        """The days of a call; by default 100 from seed 1 on."""
        number = 100 if days is None else index(days)
        return cls(number, 1 if seed is None else index(seed), split or "comparison")

    @property
    def text(self) -> str:
        """These arguments as they would be typed."""
        split = "" if self.split == "comparison" else f", split={self.split!r}"
        return f"days={self.days}, seed={self.seed}{split}"


@dataclass(frozen=True)
class OwnDays:
    """Days of the caller's own."""

    scenarios: list[Scenario]
    origin: str
    """Where the days came from, for the report."""
    text: str
    """This argument as it would be typed."""
    seed: int = 0
    """The seed of the random policy and of the planner's search, if the call gives none."""

    @classmethod
    def of(cls, days_from: str | os.PathLike[str] | Iterable[str | os.PathLike[str] | Scenario]) -> OwnDays:
        """The days that a call names, or has."""
        given = [days_from] if isinstance(days_from, (str, os.PathLike)) else list(days_from)
        scenarios = [day for day in given if isinstance(day, Scenario)]
        paths = [day for day in given if not isinstance(day, Scenario)]
        if scenarios and paths:
            raise Error("V451", "days_from takes scenarios or files, not both", None)
        if not paths:
            return cls(scenarios, "scenarios of the caller's", "days_from=...")
        return cls(*_native.read_days(paths), f"days_from={given!r}")


@dataclass(frozen=True)
class ComparisonRequest:
    """The request for a comparison; parts of its days can be played separately."""

    function: str
    """The function of the package that was called."""
    policies: tuple[str, ...]
    days: DrawnDays | OwnDays
    models: dict[str, PolicySource]
    bound: bool
    step: int
    policy_seed: int | None

    @classmethod
    def of(
        cls,
        function: str,
        policies: Iterable[str],
        days: DrawnDays | OwnDays,
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
        policies = list(policies)
        if unnamed := [policy for policy in policies if not isinstance(policy, str)]:
            rule = f"policies are named by texts, found {unnamed[0]!r}"
            raise Error("V451", rule, 'name it in both: policies=["mine"], models={"mine": ...}')
        seed_of_policies = None if policy_seed is None else index(policy_seed)
        names, given = tuple(name.strip() for name in policies), dict(models or {})
        return cls(function, names, days, given, bound, index(step), seed_of_policies)

    def check(self, networks: Iterable[Network | None], stacklevel: int = 3) -> None:
        """Refuses what cannot be played and warns of what is probably not intended, before any day is played.

        Args:
            networks: the networks that the days are drawn from, or that own days are seen as days of.
            stacklevel: number of levels from here up to the user's call.
        """
        request = self.for_native()
        texts = [text for network in networks for text in _native.check_comparison(network, request)]
        for text in dict.fromkeys(texts):
            warnings.warn(text, stacklevel=stacklevel)

    def compare(
        self, network: Network | None, threads: int | None, part: DrawnDays | None = None
    ) -> Comparison:
        """Plays the days, or a part of them."""
        request = self.for_native(part)
        source = None if network is None else network.source
        return _native.compare(network, request, threads=threads, command=self.call_text(source))

    def for_native(self, part: DrawnDays | None = None) -> dict[str, Any]:
        """The request for the days, or a part of them, as the native side takes it."""
        return {
            "policies": list(self.policies),
            "days": part or self.days,
            "models": self.models,
            "bound": self.bound,
            "step": self.step,
            "policy_seed": self.days.seed if self.policy_seed is None else self.policy_seed,
        }

    def call_text(self, source: str | None) -> str:
        """The call as it would be typed, for the report; `source` is its network."""
        said = [f"{list(self.policies)!r}", self.days.text]
        if self.models:
            models = ", ".join(f"{name!r}: {name_of(given)}" for name, given in self.models.items())
            said.append(f"models={{{models}}}")
        if self.bound:
            said += ["bound=True", f"step={self.step}"]
        if self.policy_seed is not None:
            said.append(f"policy_seed={self.policy_seed}")
        return f"{self.function}({source}, {', '.join(said)})"


def name_of(given: PolicySource) -> str:
    """The name of a function, or the text of another source. A function's `repr` changes with every run."""
    return getattr(given, "__qualname__", None) or repr(given)


def network_of(network: str | os.PathLike[str] | Network) -> Network:
    """The network itself, or the network with that name or path."""
    return network if isinstance(network, Network) else Network(network)

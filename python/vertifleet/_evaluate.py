"""Evaluations: policies on frozen suites of days, measured as shares of the suites' certified bounds."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vertifleet import _native
from vertifleet._compare import PolicySource
from vertifleet._errors import Error
from vertifleet._native import Board, Evaluation, Network, Scenario
from vertifleet._own_policy import FunctionPolicy

RULES = ("random", "greedy", "prices", "rolling", "plan")
"""Names that stand for nothing but the program's own policies."""

SUITES: tuple[str, ...] = tuple(_native.suite_names())
"""The names of all suites."""


def evaluate(
    policy: PolicySource | Iterable[str] | Mapping[str, PolicySource],
    suite: str | Iterable[str] = "paper-100",
    *,
    models: Mapping[str, PolicySource] | None = None,
    threads: int | None = None,
) -> Evaluation:
    """Plays frozen suites of days, and measures the share of their certified upper bounds.

    The bounds are shipped, so this takes as long as the policy takes to decide. Everyone who names a suite
    plays the same days, which no training and no validation ever draws.

    Args:
        policy: the policy: a name as in ``vertifleet compare``, a model, a function from an observation to an
            action, a `FunctionPolicy` or an `OwnPolicy`; or several: their names, or a mapping from names to
            policies. The others are measured against the first.
        suite: the name of a suite of `SUITES`, several names, or "all"; "random:80" is a day of each of the
            first 80 random networks, whose bounds are proven first.
        models: weights or policies of your own, for those of the names that need one.
        threads: most threads to use; all cores by default. A policy that remembers something between calls
            needs ``threads=1``, unless it is a class.

    Raises:
        Error: V411 for an unknown suite; otherwise with the program's code for the error.
    """
    names, given = _named(policy)
    given.update(models or {})
    suites = [suite] if isinstance(suite, str) else list(suite)
    suites = list(SUITES) if suites == ["all"] else suites
    if not suites or len(set(suites)) < len(suites):
        raise Error(
            "V451", f"suites must be one or more different names, found {suites!r}", "see vertifleet.SUITES"
        )
    command = f"vertifleet.evaluate({list(names)!r}, {suites!r})"
    return _native.evaluate(suites, list(names), given, threads=threads, command=command)


def _named(policy: Any) -> tuple[list[str], dict[str, PolicySource]]:
    """The names of the policies, and what those names stand for that are not the program's."""
    if isinstance(policy, str):
        return [policy], {}
    if isinstance(policy, Mapping):
        return list(policy), dict(_source(name, given) for name, given in policy.items() if name != given)
    is_one = callable(policy) or hasattr(policy, "choose") or hasattr(policy, "choose_batch")
    if isinstance(policy, os.PathLike):
        name = Path(policy).stem
    elif isinstance(policy, _native.Model):
        name = policy.kind
    elif not is_one and not isinstance(policy, FunctionPolicy) and isinstance(policy, Iterable):
        return list(policy), {}
    else:
        named = policy.function if isinstance(policy, FunctionPolicy) else policy
        # A function without a name of its own is called "<lambda>".
        name = (getattr(named, "__name__", None) or type(named).__name__).strip("<>")
    return [name], dict([_source(name, policy)])


def _source(name: Any, given: Any) -> tuple[str, PolicySource]:
    """A policy of the caller's under its name."""
    if not isinstance(name, str):
        raise Error("V451", f"policies are named by texts, found {name!r}", 'as {"mine": policy}')
    if isinstance(given, str):
        rule = f"{name!r} is a name for {given!r}, but a policy of the program has only its own name"
        raise Error("V451", rule, f'{{"{given}": "{given}"}}, or pathlib.Path(...) for a file with weights')
    if name in RULES:
        rule = f"{name!r} is the name of a policy of the program"
        raise Error("V451", rule, 'give yours another name: {"mine": policy}')
    return name, given


@dataclass(frozen=True)
class Verification:
    """What the verification of a result file found."""

    suite: str
    policy: str
    valid: bool
    """Whether every claim holds that can be verified."""
    bound_share: float | None
    """The mean share of the bounds as computed again; ``None`` if a day cannot be played."""
    profit_usd: float | None
    """The mean profit of a day as computed again, dollars; ``None`` if a day cannot be played."""
    findings: tuple[str, ...]
    """What does not hold."""


def verify(result: str | os.PathLike[str]) -> Verification:
    """Verifies a result file that `Evaluation.save` or ``vertifleet evaluate --results`` wrote.

    The days are drawn again, the choices in the file are played, the schedules are judged by the independent
    checker, and every profit, bound and share is computed again. Not verified is who the policy is, what it
    saw, how long it took, and what the file says about it.

    Raises:
        Error: V413 if the file is not a result, V411 if its suite is unknown.
    """
    found = _native.verify(result)

    def mean(member: str) -> float | None:
        return None if found[member] is None else float(found[member]["mean"])

    return Verification(
        found["suite"],
        found["policy"],
        found["valid"],
        mean("bound_share"),
        mean("profit_usd"),
        tuple(found["findings"]),
    )


def board(results: str | os.PathLike[str] | Iterable[str | os.PathLike[str]]) -> Board:
    """The methods behind result files, with their training runs as the unit.

    Each file is one run of a method on a suite. All files are verified first. For each suite, the methods
    are sorted by what they see, then by the mean share of the certified bound over runs and days. Intervals
    are of samples of runs and days with replacement, so they include what another training seed would
    change. The interquartile mean, the optimality gap and the performance profiles are those of rliable
    (R. Agarwal and others, 2021).

    Args:
        results: a result file of `Evaluation.save` or ``vertifleet evaluate --results``, a folder with
            them, or several.

    Raises:
        Error: V413 if a file is not a result, V415 if one does not verify, V416 if two are of the same
            run, or if runs of one method see different things.
    """
    paths = [results] if isinstance(results, (str, os.PathLike)) else list(results)
    shown = str(os.fspath(paths[0])) if len(paths) == 1 else f"{len(paths)} files"
    return _native.board(paths, f"vertifleet.board({shown!r})")


@dataclass(frozen=True, eq=False, repr=False)
class Suite:
    """A frozen set of days with certified upper bounds."""

    name: str
    description: str
    network: Network | None
    """The network that all days are drawn from; ``None`` if each day has a different network."""
    days: tuple[Scenario, ...]
    upper_bound_usd: NDArray[np.float64]
    """The certified upper bound of the profit of each day, dollars [days]."""
    step: int
    """Length of the slices of the bounds, minutes."""

    def __repr__(self) -> str:
        return f"<Suite {self.name}: {len(self.days)} days; {self.description}>"


def suite(name: str) -> Suite:
    """The suite with this name, with its days.

    Raises:
        Error: V411 if there is none.
    """
    description, network, days, bounds, step = _native.find_suite(name)
    bounds_usd = np.array(bounds)
    bounds_usd.setflags(write=False)
    found = None if network is None else Network(network)
    return Suite(name, description, found, tuple(days), bounds_usd, step)

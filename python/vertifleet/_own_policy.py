"""Policies of the caller: functions of an observation, and objects that choose."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import index
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, SupportsIndex, TypeAlias, runtime_checkable

import numpy as np

from vertifleet._errors import Error
from vertifleet._native import Days
from vertifleet._view import Decision, View
from vertifleet.envs.days import NetworksChoice, days_of
from vertifleet.envs.observing import ObservationChoice, Observing

if TYPE_CHECKING:
    from vertifleet import _native
    from vertifleet._native import Network

Chooser: TypeAlias = "Callable[[_native.View], int]"
BatchChooser: TypeAlias = "Callable[[Sequence[_native.View]], list[int]]"
PolicyFunction: TypeAlias = Callable[[Any], Any]
"""A function from an observation to an action, the position of a vertiport."""


@runtime_checkable
class OwnPolicy(Protocol):
    """A policy with a memory: a class, which is instantiated for each day, or one object for all days.

    It may also have a method ``reset(view)``, which is called at the first decision of each day. Days are
    played in parallel, so an object that keeps state between calls needs ``threads=1``; a class does not.
    """

    def choose(self, decision: Decision, view: View) -> SupportsIndex:
        """The position of the vertiport to fly to, where the aircraft's own means hold.

        A choice outside ``view.action_mask`` holds, as it does in an environment.
        """


@runtime_checkable
class BatchPolicy(Protocol):
    """A policy that decides for many days at once, one decision of each, which is fast for networks.

    Finished days are left out, so the rows of two calls may belong to different days. A policy that keeps
    state of a day should be an `OwnPolicy`.
    """

    def choose_batch(self, decisions: Sequence[Decision], views: Sequence[View]) -> Sequence[SupportsIndex]:
        """The choice for each decision, as `OwnPolicy.choose` returns it."""


@dataclass(frozen=True)
class FunctionPolicy:
    """A function of an observation, such as a network trained on an environment with that observation."""

    function: PolicyFunction
    observation: ObservationChoice = "paper"
    batch: bool = False
    """Whether the function takes many observations at once, each array with one more axis in front, and
    returns as many actions. It is then called for all days of a comparison together, which is much faster for
    a network."""
    network: NetworksChoice | None = None
    """The source of the environment's days, if it was not the network of the days to play. A function for
    networks of different sizes needs it for the shapes of its arrays: ``network="random"``."""


class Adapted(NamedTuple):
    """A policy of the caller, in the form that the native side calls."""

    make: Callable[[], Chooser | BatchChooser]
    """Makes the function from a view to an action for a day, or from many views to as many actions."""
    shows_present_only: bool
    """Whether it observes the present only."""
    days: Days | None
    """The source of days whose shapes its observations have."""
    in_batches: bool


def adapted(policy: Any, network: Network | None) -> Adapted:
    """The object that the native side calls in place of the policy.

    Raises:
        Error: V451 for a function without a network.
        TypeError: if the object is not a policy.
    """
    if hasattr(policy, "choose_batch"):
        return Adapted(
            lambda: _batch_chooser(policy() if isinstance(policy, type) else policy), False, None, True
        )
    if hasattr(policy, "choose"):
        return Adapted(lambda: _chooser(policy() if isinstance(policy, type) else policy), False, None, False)
    if callable(policy):
        policy = FunctionPolicy(policy)
    if not isinstance(policy, FunctionPolicy):
        rule = f"a policy is a name, weights, a function from an observation to an action, or an object that \
chooses, found {policy!r}"
        raise TypeError(rule)
    return _of_function(policy, network)


def _chooser(policy: OwnPolicy) -> Chooser:
    begins = True

    def choose(native: _native.View) -> int:
        nonlocal begins
        view = View(native)
        if begins and hasattr(policy, "reset"):
            policy.reset(view)
        begins = False
        return _choice(policy.choose(view.decision, view), policy)

    return choose


def _batch_chooser(policy: BatchPolicy) -> BatchChooser:
    def choose(natives: Sequence[_native.View]) -> list[int]:
        views = [View(native) for native in natives]
        chosen = policy.choose_batch([view.decision for view in views], views)
        return _actions(chosen, len(natives), policy)

    return choose


def _choice(returned: Any, policy: Any) -> int:
    """The position of a vertiport that a policy returned."""
    try:
        return index(returned)
    except TypeError:
        raise _wrong(policy, f"a choice is the position of a vertiport, found {returned!r}") from None


def _actions(returned: Any, asked: int, policy: Any) -> list[int]:
    """The positions of vertiports that a policy returned, one for each decision."""
    try:
        found = list(returned)
    except TypeError:
        raise _wrong(policy, f"{asked} actions were asked for, found {returned!r}") from None
    if len(found) != asked:
        raise _wrong(policy, f"{asked} actions were asked for, {len(found)} were returned")
    return [_choice(action, policy) for action in found]


def _wrong(policy: Any, rule: str) -> Error:
    name = getattr(policy, "__qualname__", None) or type(policy).__qualname__
    return Error("V451", f"cannot use the choice of policy {name}: {rule}")


def _of_function(policy: FunctionPolicy, network: Network | None) -> Adapted:
    networks = policy.network if network is None or policy.network is not None else network
    if networks is None:
        rule = "a function takes a network, as which it sees the days"
        raise Error(
            "V451",
            rule,
            'say what its environment had: FunctionPolicy(f, "full", network="random"), or "random-places:8"',
        )
    # Only the sizes of the days matter here, which no split changes.
    days, _ = days_of(networks, "training")
    observing = Observing(policy.observation, days)

    def shown(native: _native.View) -> Any:
        if observing.own is not None:
            return observing.own.function(View(native))
        return observing.of_row(native.observe(observing.layout)[0])

    def choose(native: _native.View) -> int:
        return _choice(policy.function(shown(native)), policy.function)

    def choose_batch(natives: Sequence[_native.View]) -> list[int]:
        if observing.own is None:
            seen: Any = observing.of_rows(
                np.stack([native.observe(observing.layout)[0] for native in natives])
            )
        else:
            seen = [shown(native) for native in natives]
        return _actions(policy.function(seen), len(natives), policy.function)

    present_only = observing.own is None and observing.layout.shows_present_only
    return Adapted(lambda: choose_batch if policy.batch else choose, present_only, days, policy.batch)

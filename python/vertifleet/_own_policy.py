"""Policies of the caller's own: functions of an observation, and objects that choose."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import index
from typing import TYPE_CHECKING, Any, Protocol, SupportsIndex, TypeAlias, runtime_checkable

from vertifleet._errors import Error
from vertifleet._native import Days
from vertifleet._view import Decision, View
from vertifleet.envs.days import NetworksChoice, days_of
from vertifleet.envs.observing import ObservationChoice, Observing

if TYPE_CHECKING:
    from vertifleet import _native
    from vertifleet._native import Network

Chooser: TypeAlias = "Callable[[_native.View], int]"
PolicyFunction: TypeAlias = Callable[[Any], SupportsIndex]
"""A function from an observation to an action, the position of a vertiport."""


@runtime_checkable
class OwnPolicy(Protocol):
    """A policy with a memory: a class, of which each day gets an object of its own, or one object for all
    days.

    It may also have a method ``reset(view)``, which is called at the first decision of each day. Days are
    played side by side, so an object that remembers something between calls needs ``threads=1``; a class does
    not.
    """

    def choose(self, decision: Decision, view: View) -> SupportsIndex:
        """The position of the vertiport to fly to, where the aircraft's own means hold.

        A choice outside ``view.action_mask`` holds, as it does in an environment.
        """


@dataclass(frozen=True)
class FunctionPolicy:
    """A function of an observation, such as a network trained on an environment with that observation."""

    function: PolicyFunction
    observation: ObservationChoice = "paper"
    network: NetworksChoice | None = None
    """What the environment drew its days from, where it was not the network of the days to be played. On
    networks of different sizes a function needs it, for the shapes of its arrays: ``network="random"``."""


def adapted(policy: Any, network: Network | None) -> tuple[Callable[[], Chooser], bool, Days | None]:
    """What makes the function from a view to an action for a day, whether it sees the present only, and the
    days as days of which it sees them.

    Raises:
        Error: V451 for a function without a network.
        TypeError: for what is no policy.
    """
    if hasattr(policy, "choose"):
        return lambda: _chooser(policy() if isinstance(policy, type) else policy), False, None
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
        return index(policy.choose(view.decision, view))

    return choose


def _of_function(policy: FunctionPolicy, network: Network | None) -> tuple[Callable[[], Chooser], bool, Days]:
    networks = policy.network if network is None or policy.network is not None else network
    if networks is None:
        rule = "a function takes a network, as which it sees the days"
        raise Error("V451", rule, 'say what its environment had: FunctionPolicy(f, "full", network="random")')
    days, _ = days_of(networks, "comparison")
    observing = Observing(policy.observation, days)

    def choose(native: _native.View) -> int:
        if observing.own is not None:
            return index(policy.function(observing.own.function(View(native))))
        row, _ = native.observe(observing.layout)
        return index(policy.function(observing.of_row(row)))

    return lambda: choose, observing.own is None and observing.layout.shows_present_only, days

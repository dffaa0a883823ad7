"""The program's policies, which can be called for any decision."""

from __future__ import annotations

import os
from typing import SupportsIndex

import numpy as np
from numpy.typing import NDArray

from vertifleet import _native
from vertifleet._errors import Error
from vertifleet._native import Model
from vertifleet._view import Decision, View


class Policy:
    """One of the program's policies.

    Called for the decisions of a day in order, it plays as the program does. It has the form of an
    `OwnPolicy`, so one can wrap it, and it can be the teacher of a learned policy.
    """

    def __init__(self, native: _native.Policy) -> None:
        self._native = native

    @property
    def name(self) -> str:
        """Its name."""
        return self._native.name

    @property
    def sees(self) -> str:
        """The information that it uses: "present", "forecast" or "whole day"."""
        return self._native.sees

    def choose(self, decision: Decision, view: View) -> int:
        """The position of the vertiport that it chooses.

        Raises:
            Error: V451 if `decision` is not that of the view.
        """
        if decision != view.decision:
            raise Error("V451", f"the view is of another decision, {view.decision}, than {decision}")
        return self._native.choose(view._native)

    def values(self, view: View) -> NDArray[np.float64]:
        """The values by which it compares choices [N], the higher the better; NaN for a choice that it does
        not consider.

        Dollars an hour for "greedy"; dollars for "prices", "rolling" and "gcaps-x"; logits
        for "gcaps" and "mlp"; NaN for all of "random".
        """
        return self._native.values(view._native)

    def __repr__(self) -> str:
        return repr(self._native)


def policy(
    name: str,
    *,
    network: str = "paper",
    seed: SupportsIndex = 0,
    model: str | os.PathLike[str] | Model | None = None,
) -> Policy:
    """One of the program's policies, by its name as in ``vertifleet simulate``.

    Args:
        name: the name, such as "rolling" or "gcaps-x:rollouts=3".
        network: name of the network whose shipped weights "gcaps" and "mlp" have.
        seed: seed of "random".
        model: weights to use instead of the shipped ones.

    Raises:
        Error: with the program's code if there is no such policy; V451 for "plan", which knows the whole day
            in advance.
    """
    return Policy(_native.find_policy(name, network, seed, model))

"""Fleets of electric air taxis: decides where every aircraft flies next, for the highest profit of the day.

The package runs the code of the Rust program. `Network` draws days, `simulate` plays one day, `compare` plays
many days with many policies, `evaluate` plays frozen suites whose certified bounds are shipped, `sweep`
compares on variations of a network, `bound` proves an upper bound on a day's profit, `plan` searches for the
best schedule, `check` checks a schedule against the rules, and `train` trains the learned policies. `dataset`
records decisions to learn from. Importing the package registers Gymnasium environments,
``vertifleet/Fleet-v0`` first. `vertifleet.torch` has the learned policies as PyTorch modules;
`vertifleet.sb3` and `vertifleet.ray` train them with those libraries.
"""

from __future__ import annotations

from importlib.metadata import version

from vertifleet._compare import compare
from vertifleet._dataset import Dataset, dataset
from vertifleet._errors import Error
from vertifleet._evaluate import SUITES, Suite, Verification, board, evaluate, suite, verify
from vertifleet._native import (
    Board,
    Bound,
    Comparison,
    Evaluation,
    Model,
    Network,
    Picture,
    Plan,
    Played,
    Scenario,
    Trace,
    Training,
    bound,
    check,
    plan,
    settings,
    simulate,
)
from vertifleet._own_policy import BatchPolicy, FunctionPolicy, OwnPolicy
from vertifleet._policy import Policy, policy
from vertifleet._sweep import Sweep, sweep
from vertifleet._train import train
from vertifleet._view import AircraftType, Decision, KnownClosure, Outcome, View
from vertifleet.envs import OwnObservation
from vertifleet.envs import register as _register

__all__ = [
    "SUITES",
    "AircraftType",
    "BatchPolicy",
    "Board",
    "Bound",
    "Comparison",
    "Dataset",
    "Decision",
    "Error",
    "Evaluation",
    "FunctionPolicy",
    "KnownClosure",
    "Model",
    "Network",
    "Outcome",
    "OwnObservation",
    "OwnPolicy",
    "Picture",
    "Plan",
    "Played",
    "Policy",
    "Scenario",
    "Suite",
    "Sweep",
    "Trace",
    "Training",
    "Verification",
    "View",
    "__version__",
    "board",
    "bound",
    "check",
    "compare",
    "dataset",
    "evaluate",
    "plan",
    "policy",
    "settings",
    "simulate",
    "suite",
    "sweep",
    "train",
    "verify",
]

__version__ = version("vertifleet")

_register()

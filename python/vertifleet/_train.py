"""`train`, which also takes a network by its name or path."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from vertifleet import _native
from vertifleet._compare import network_of
from vertifleet._native import Days, Network
from vertifleet.envs.days import warn_of_network

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vertifleet._native import Model, Training


def train(
    network: str | os.PathLike[str] | Network,
    policy: str = "gcaps",
    *,
    out: str | os.PathLike[str],
    preset: str = "default",
    settings: Mapping[str, Any] | None = None,
    seed: int = 1,
    begin_with: Model | str | os.PathLike[str] | None = None,
    resume: bool = False,
    force: bool = False,
    threads: int | None = None,
    watch: Callable[[dict[str, Any]], object] | None = None,
) -> Training:
    """Trains a policy with the program's trainer, as ``vertifleet train`` does, at the same speed.

    Ctrl-C ends it soon. It then writes a checkpoint of the state after the last row of the curve; the same
    call with ``resume=True`` continues from there, bit for bit as if the run had never stopped.

    Args:
        network: the network, its name, or the path of its file; or a new network for each day, "random" or
            "random-places:8".
        policy: "gcaps", "mlp", "gcaps-x", "gcaps-full" or "mlp-full".
        out: folder for weights, learning curve, checkpoint and TensorBoard's events; it may hold runs of
            several policies.
        preset: settings to start from: "default" or "evolution"; for "gcaps" and "mlp" also "paper" or
            "imitation".
        settings: settings and sizes of the policy to change, by name, as with ``--set``.
        seed: seed of the run; initial weights, training days and choices follow from it.
        begin_with: initial weights, from the same kind of policy, in place of random ones: a ``Model`` or the
            path of a weight file.
        resume: whether to resume the run in the folder, which must have the same network, policy, settings,
            seed and initial weights.
        force: whether to replace files that the program did not write or that are read-only.
        threads: largest number of threads; all cores by default. Results do not depend on it.
        watch: called with every new row of the learning curve, a dict; if it raises, a checkpoint is written
            and the run ends.

    Raises:
        Error: with the program's code for the error, such as V311 for a folder with an earlier run.
    """
    if not isinstance(network, Network) and not Days.are_drawn(os.fspath(network)):
        network = network_of(network)
    if isinstance(network, Network):
        warn_of_network(network, "training")
    return _native.train(
        network if isinstance(network, Network) else os.fspath(network),
        policy,
        out=out,
        preset=preset,
        settings=settings,
        seed=seed,
        begin_with=begin_with,
        resume=resume,
        force=force,
        threads=threads,
        watch=watch,
    )

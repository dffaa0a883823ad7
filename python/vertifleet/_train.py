"""`train`, with a network by its name or path."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vertifleet import _native
from vertifleet._compare import network_of

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping

    from vertifleet._native import Network, Training


def train(
    network: str | os.PathLike[str] | Network,
    policy: str = "gcaps",
    *,
    out: str | os.PathLike[str],
    preset: str = "default",
    settings: Mapping[str, Any] | None = None,
    seed: int = 1,
    resume: bool = False,
    force: bool = False,
    threads: int | None = None,
    watch: Callable[[dict[str, Any]], object] | None = None,
) -> Training:
    """Trains a policy by the program's own trainer, as ``vertifleet train`` does, and at its speed.

    Ctrl-C ends it soon: the run is set aside as it stood after the last row of its curve, and the same call
    with ``resume=True`` goes on, bit for bit as if it had never stopped.

    Args:
        network: the network, its name, or the path of its file.
        policy: "gcaps", "mlp" or "gcaps-x".
        out: folder for weights, learning curve, checkpoint and TensorBoard's events; it may hold runs of
            several policies.
        preset: settings to start from: "default", or "paper" for "gcaps" and "mlp".
        settings: settings to change by their names, as ``--set`` does.
        seed: first weights, training days and choices follow from it.
        resume: whether to go on with the run in the folder, which has the same network, policy, settings and
            seed.
        force: whether files may be replaced that the program did not write, or that are read-only.
        threads: how many at most; all cores by default. Results are the same with any number.
        watch: is called with every new row of the learning curve, a dict; where it raises, the run is set
            aside.

    Raises:
        Error: with the code that the program has for it, such as V311 for a folder with an earlier run.
    """
    return _native.train(
        network_of(network),
        policy,
        out=out,
        preset=preset,
        settings=settings,
        seed=seed,
        resume=resume,
        force=force,
        threads=threads,
        watch=watch,
    )

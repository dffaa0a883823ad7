"""Many random networks, a day of each: how policies do on networks that they never saw."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import SupportsIndex

from vertifleet import _native
from vertifleet._compare import PolicySource
from vertifleet._native import Generalisation


def generalise(
    policies: Iterable[str],
    *,
    networks: SupportsIndex = 50,
    models: Mapping[str, PolicySource] | None = None,
    step: SupportsIndex = 3,
    threads: int | None = None,
) -> Generalisation:
    """Plays a day of each of many random networks, and measures shares of the days' upper bounds.

    Args:
        policies: names of policies as in `compare`; the others are measured against the first.
        networks: number of networks, from ``random:0`` on. The suite "random-50" has the first 50 of them,
            with bounds that need not be proven.
        models: weights or policies of your own, by policy name. A function says what its environment drew its
            days from: ``FunctionPolicy(f, "full", network="random")``.
        step: length of the bounds' slices in minutes.
        threads: most threads to use; all cores by default.

    Raises:
        Error: with the program's code for the error.
    """
    names = [policies] if isinstance(policies, str) else list(policies)
    command = f"vertifleet.generalise({names!r}, networks={networks}, step={step})"
    return _native.generalise(
        names, dict(models or {}), networks=networks, step=step, threads=threads, command=command
    )

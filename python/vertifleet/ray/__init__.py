"""Comparisons and sweeps as tasks of a Ray cluster, with the same results as on one machine.

::

    import ray
    import vertifleet
    import vertifleet.ray

    ray.init()
    network = vertifleet.Network("paper")
    comparison = vertifleet.ray.compare(network, ["greedy", "rolling"], days=1000)

`vertifleet.ray.rllib` trains the networks with RLlib.
"""

from __future__ import annotations

from vertifleet.ray.comparing import compare, sweep

__all__ = ["compare", "sweep"]

"""Where the days of an environment come from."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Literal, TypeAlias

from vertifleet._compare import network_of
from vertifleet._native import Days, Network

NetworkChoice: TypeAlias = str | os.PathLike[str] | Network
"""A network, its name, or the path of its file."""

NetworksChoice: TypeAlias = NetworkChoice | Iterable[NetworkChoice]
"""A network, several of them, or the name of networks that are drawn anew for each day: "random", or
"random-places:N" for the paper's network with N vertiports at random places."""

Split: TypeAlias = Literal["training", "validation", "comparison"]
"""Days that are never days of another split."""


def days_of(networks: NetworksChoice, split: Split) -> tuple[Days, Network | None]:
    """The days of the networks, and the network if there is only one."""
    if isinstance(networks, str) and Days.are_drawn(networks):
        return Days(networks, split), None
    if isinstance(networks, (str, os.PathLike, Network)):
        network = network_of(networks)
        return Days([network], split), network
    listed = [network_of(network) for network in networks]
    return Days(listed, split), listed[0] if len(listed) == 1 else None

"""The sources of an environment's days."""

from __future__ import annotations

import functools
import os
import warnings
from collections.abc import Iterable, Mapping
from typing import Any, TypeAlias

from vertifleet._compare import Split, network_of
from vertifleet._native import Days, Network

NetworkChoice: TypeAlias = str | os.PathLike[str] | Network | Mapping[str, str]
"""A network, its name, the path of its file, or ``{"toml": text}`` with the text of its file."""

NetworksChoice: TypeAlias = NetworkChoice | Iterable[NetworkChoice]
"""A network, several of them, or the name of a source that draws a new network for each day: "random", or
"random-places:N" for the paper's network with N vertiports at random places."""


def warn_of_comparison(split: str | None) -> None:
    """Warns once, if these are comparison days, that nothing should be learned from them."""
    if split == "comparison":
        _warn_once()


def warn_of_network(network: Network, split: Split) -> None:
    """Warns once, if a network that was drawn for one purpose is the source of days for another."""
    if network.split is not None and network.split != split:
        _warn_once_of_networks(network.split, split)


@functools.cache
def _warn_once() -> None:
    warnings.warn(
        "these are comparison days, by which policies are judged: learn from those of "
        'split="training", and choose settings by "validation"',
        stacklevel=5,
    )


@functools.cache
def _warn_once_of_networks(drawn_for: Split, split: Split) -> None:
    stricter = max(drawn_for, split, key=["training", "validation", "comparison"].index)
    warnings.warn(
        f"this is a {drawn_for} network, and its {split} days are asked for: treat them as {stricter} days. "
        'Learn from "random" or "random-training:7", choose settings by "random-validation:7", '
        'and compare policies by "random:7"',
        stacklevel=5,
    )


def days_of(networks: NetworksChoice, split: Split) -> tuple[Days, Network | None]:
    """The days of the networks, and the network if there is only one."""
    warn_of_comparison(split)
    if isinstance(networks, str) and Days.are_drawn(networks):
        return Days(networks, split), None
    if isinstance(networks, (str, os.PathLike, Network, Mapping)):
        network = _network(networks)
        warn_of_network(network, split)
        return Days([network], split), network
    listed = [_network(network) for network in networks]
    for network in listed:
        warn_of_network(network, split)
    return Days(listed, split), listed[0] if len(listed) == 1 else None


def _network(given: NetworkChoice) -> Network:
    return Network.from_toml(given["toml"]) if isinstance(given, Mapping) else network_of(given)


def plain(networks: Any) -> Any:
    """The same networks with plain data in place of each `Network`."""
    if isinstance(networks, Network):
        return {"toml": networks.toml}
    return [plain(network) for network in networks] if isinstance(networks, (list, tuple)) else networks

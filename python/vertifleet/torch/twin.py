"""The common part of the networks: inputs, outputs, and their description in a weight file's header."""

from __future__ import annotations

import math
import operator
from abc import ABC, abstractmethod
from inspect import signature
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from torch import Tensor, nn

from vertifleet import Error

if TYPE_CHECKING:
    from collections.abc import Mapping

MOST = 4096
"""Larger sizes can only come from a damaged file, and could request more memory than there is."""


class Twin(nn.Module, ABC):
    """A network of the program in PyTorch, with the same layers and tensors.

    The keys of ``state_dict()`` are the names of the tensors in weight files.

    Attributes:
        vertiports: N, the number of vertiports that the weights fit; None if they fit any number.
        node_features: F, number of features of a node.
        aircraft_features: G, number of features of the aircraft.
        header: header of the weight file that the weights come from; None for initial weights.
    """

    kind: ClassVar[str]
    """The policy's name: "gcaps", "mlp", "gcaps-x", "gcaps-full" or "mlp-full"."""
    features: str = ""
    """The prefix of the names of the features that it reads in observations."""
    edges: str | None = None
    """The part of an observation with the weights of the edges; None if the network reads none."""

    def __init__(self, vertiports: int | None, node_features: int, aircraft_features: int) -> None:
        super().__init__()
        self.vertiports = vertiports
        self.node_features = node_features
        self.aircraft_features = aircraft_features
        self.header: dict[str, Any] | None = None

    def forward(
        self,
        nodes: Tensor,
        aircraft: Tensor,
        clock: Tensor,
        edges: Tensor | None = None,
    ) -> tuple[Tensor, Tensor]:
        """Logits [B, N], not masked, and values [B].

        Args:
            nodes: node features, [B, N, F] or flat [B, N * F].
            aircraft: features of the aircraft that decides, [B, G].
            clock: share of the day that is left, [B] or [B, 1]; only the value depends on it.
            edges: weights of the edges between vertiports, [B, N, N] or flat [B, N * N], in the direction of
                flights, if the network reads any.

        Raises:
            Error: V451 if the network reads edges that are not given, or if some are given that it does not
                read, or if an argument has another shape.
        """
        nodes = self._by_node(nodes)
        batch, count, _ = nodes.shape
        return self._answers(nodes, aircraft, clock, self._by_pair(edges, batch, count))

    @abstractmethod
    def _answers(
        self, nodes: Tensor, aircraft: Tensor, clock: Tensor, edges: Tensor | None
    ) -> tuple[Tensor, Tensor]:
        """Logits and values from arguments that `forward` has checked, with nodes as [B, N, F]."""

    @property
    @abstractmethod
    def sizes(self) -> dict[str, Any]:
        """The sizes of the layers, by the names of the arguments."""

    @property
    def reads(self) -> tuple[str, ...]:
        """The parts of an observation that the network decides by, of an environment with
        ``observation=twin.reads``.
        """
        parts = (f"{self.features}nodes", f"{self.features}aircraft", "clock", "action_mask")
        return parts if self.edges is None else (*parts, self.edges)

    @property
    def policy(self) -> dict[str, Any]:
        """The policy's kind and sizes, as in the header of a weight file."""
        return {"kind": self.kind} | self.sizes

    @property
    def shape(self) -> dict[str, int | None]:
        """The sizes of the features, as in the header of a weight file."""
        return {
            "vertiports": self.vertiports,
            "node_features": self.node_features,
            "aircraft_features": self.aircraft_features,
        }

    def _by_node(self, nodes: Tensor) -> Tensor:
        """Node features as [B, N, F], from that shape or from a flat one."""
        batch, *shown = nodes.shape
        features = self.node_features
        vertiports = self.vertiports or math.prod(shown) // features
        if not vertiports or shown not in ([vertiports, features], [vertiports * features]):
            number = self.vertiports or "N"
            rule = f"nodes must be [B, {number}, {features}] or flat [B, {number} * {features}]"
            raise Error("V451", f"{rule}, found {list(nodes.shape)}")
        return nodes.reshape(batch, vertiports, features)

    def _by_pair(self, edges: Tensor | None, batch: int, count: int) -> Tensor | None:
        """Weights of edges as [B, N, N], from that shape or from a flat one; None if none are read."""
        if edges is None and self.edges is None:
            return None
        if edges is None:
            raise Error(
                "V451", f"these weights of {self.kind} need edges", f"observations show {self.edges!r}"
            )
        if self.edges is None:
            raise Error("V451", f"these weights of {self.kind} read no edges: leave them out")
        if list(edges.shape) not in ([batch, count, count], [batch, count * count]):
            rule = f"edges must be [{batch}, {count}, {count}] or flat [{batch}, {count} * {count}]"
            raise Error("V451", f"{rule}, found {list(edges.shape)}")
        return edges.reshape(batch, count, count)


def paper_features(vertiports: int) -> tuple[int, int]:
    """F and G of §IV.A on a network with this many vertiports."""
    return 2 * vertiports + 4, 2 * vertiports + 2


FULL_FEATURES = 37, 11
"""F and G of the full observation, on a network of any size."""


def check_size(name: str, size: int, most: int = MOST, least: int = 1) -> int:
    """A size of Python or NumPy, converted to Python's type; refuses sizes that no network has."""
    try:
        number = -1 if isinstance(size, bool) else operator.index(size)
    except TypeError:
        number = -1
    if not least <= number <= most:
        raise Error("V451", f"{name} must be a whole number from {least} to {most}, found {size!r}")
    return number


Kind = TypeVar("Kind", bound=Twin)


def of_sizes(kind: type[Kind], vertiports: int, sizes: Mapping[str, Any]) -> Kind:
    """The network for this many vertiports, with initial weights; `sizes` are its arguments by name.

    Raises:
        Error: V451 if it has no such size, or if a size is out of bounds.
    """
    known = [name for name in signature(kind).parameters if name != "vertiports"]
    for name in sizes:
        if name not in known:
            raise Error("V451", f"{kind.kind} has no size {name!r}: its sizes are {', '.join(known)}")
    return kind(vertiports, **sizes)

"""What the networks have in common: what they take and give, and what a weight file's header says of them."""

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
"""Sizes beyond this are a damaged file's, and would ask for more memory than there is."""


class Twin(nn.Module, ABC):
    """A network of the program in PyTorch: the same layers, the same tensors.

    The keys of ``state_dict()`` are the names of the tensors in weight files.

    Attributes:
        vertiports: N, for which the weights fit; None where they fit any number.
        node_features: F, numbers that a node shows.
        aircraft_features: G, numbers that the aircraft shows.
        header: header of the weight file that the weights come from; None for fresh weights.
    """

    kind: ClassVar[str]
    """The policy's name: "gcaps", "mlp" or "gcaps-x"."""

    def __init__(self, vertiports: int | None, node_features: int, aircraft_features: int) -> None:
        super().__init__()
        self.vertiports = vertiports
        self.node_features = node_features
        self.aircraft_features = aircraft_features
        self.header: dict[str, Any] | None = None

    @abstractmethod
    def forward(self, nodes: Tensor, aircraft: Tensor, clock: Tensor) -> tuple[Tensor, Tensor]:
        """Logits [B, N], not masked, and values [B].

        Args:
            nodes: node features, [B, N, F] or flat [B, N * F].
            aircraft: features of the aircraft that decides, [B, G].
            clock: share of the day left, [B] or [B, 1]; the value alone depends on it.
        """

    @property
    @abstractmethod
    def sizes(self) -> dict[str, int]:
        """The sizes of the layers, by the names of the arguments."""

    @property
    def policy(self) -> dict[str, Any]:
        """The policy's kind and sizes, as a weight file's header has them."""
        return {"kind": self.kind} | self.sizes

    @property
    def shape(self) -> dict[str, int | None]:
        """The sizes of the features, as a weight file's header has them."""
        return {
            "vertiports": self.vertiports,
            "node_features": self.node_features,
            "aircraft_features": self.aircraft_features,
        }

    def by_node(self, nodes: Tensor) -> Tensor:
        """Node features as [B, N, F], whether they come flat or not.

        Raises:
            Error: V451 if they are those of another number of vertiports, or of another policy.
        """
        batch, *shown = nodes.shape
        features = self.node_features
        vertiports = self.vertiports or math.prod(shown) // features
        if not vertiports or shown not in ([vertiports, features], [vertiports * features]):
            number = self.vertiports or "N"
            rule = f"nodes must be [B, {number}, {features}] or flat [B, {number} * {features}]"
            raise Error("V451", f"{rule}, found {list(nodes.shape)}")
        return nodes.reshape(batch, vertiports, features)


def paper_features(vertiports: int) -> tuple[int, int]:
    """F and G of §IV.A on a network with so many vertiports."""
    return 2 * vertiports + 4, 2 * vertiports + 2


def check_size(name: str, size: int, most: int = MOST) -> int:
    """The size in Python's own type, be it NumPy's; refuses one that no network has."""
    try:
        number = 0 if isinstance(size, bool) else operator.index(size)
    except TypeError:
        number = 0
    if not 1 <= number <= most:
        raise Error("V451", f"{name} must be a whole number from 1 to {most}, found {size!r}")
    return number


Kind = TypeVar("Kind", bound=Twin)


def of_sizes(kind: type[Kind], vertiports: int, sizes: Mapping[str, int]) -> Kind:
    """The network for so many vertiports, with first weights; `sizes` are by the names of its arguments.

    Raises:
        Error: V451 if it has no such size, or none so large.
    """
    known = [name for name in signature(kind).parameters if name != "vertiports"]
    for name in sizes:
        if name not in known:
            raise Error("V451", f"{kind.kind} has no size {name!r}: its sizes are {', '.join(known)}")
    return kind(vertiports, **sizes)

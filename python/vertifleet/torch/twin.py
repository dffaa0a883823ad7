"""What the networks have in common: what they take and give, and what a weight file's header says of them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from torch import Tensor, nn

from vertifleet import Error

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
    def shape(self) -> dict[str, int]:
        """The sizes of the features, as a weight file's header has them."""
        shape = {"node_features": self.node_features, "aircraft_features": self.aircraft_features}
        return shape if self.vertiports is None else {"vertiports": self.vertiports} | shape

    def by_node(self, nodes: Tensor) -> Tensor:
        """Node features as [B, N, F], whether they come flat or not."""
        return nodes.reshape(nodes.shape[0], -1, self.node_features)


def paper_features(vertiports: int) -> tuple[int, int]:
    """F and G of §IV.A on a network with so many vertiports."""
    check_size("vertiports", vertiports)
    return 2 * vertiports + 4, 2 * vertiports + 2


def check_size(name: str, size: int, most: int = MOST) -> None:
    """Refuses a size that no network has."""
    if type(size) is not int or not 1 <= size <= most:
        raise Error("V451", f"{name} must be a whole number from 1 to {most}, found {size!r}")

"""How a network relates the vertiports to each other (§IV.A.1): settings, and the Laplacian."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from inspect import signature
from typing import Any, Literal, get_args

import numpy as np
import torch
from torch import Tensor

from vertifleet import Error
from vertifleet.torch.twin import check_size

EncoderKind = Literal["capsules", "transformer"]
Adjacency = Literal["complete", "similarity", "distance", "reachable", "profit"]
LaplacianKind = Literal["plain", "normalised"]

OBSERVED = {"distance": "distance_edges", "reachable": "adjacency", "profit": "profit_edges"}
"""The parts of observations with the weights of edges, by the adjacency that uses them."""


@dataclass(frozen=True)
class Graph:
    """The graph between the vertiports of a network; by default the paper's complete graph (Table 3).

    Attributes:
        encoder: "capsules" (Eq. 18 and 19), or "transformer", self-attention of all vertiports, which uses no
            graph.
        moments: P, the highest moment of the capsules.
        hops: K, the highest power of the Laplacian.
        layers: L_e, the number of layers of the encoder.
        adjacency: the definition of neighbours: "complete", every pair; "similarity", 1 / (1 + the distance
            of their features); "distance", 1 / (1 + hours of flight); "reachable", what may be flown now;
            "profit", the profit per hour of a flight now. Only `GcapsFull` reads the last three.
        laplacian: "plain", (D - A) / N, or "normalised", I - D^-1 A.
        attention: whether the decoder attends to the vertiports (Eq. 20), or reads their mean.
    """

    encoder: EncoderKind = "capsules"
    moments: int = 2
    hops: int = 2
    layers: int = 1
    adjacency: Adjacency = "complete"
    laplacian: LaplacianKind = "plain"
    attention: bool = True

    def __post_init__(self) -> None:
        sizes = {
            "moments": check_size("moments", self.moments, 4),
            "hops": check_size("hops", self.hops, 4, least=0),
            "layers": check_size("layers", self.layers, 8),
        }
        for name, size in sizes.items():
            object.__setattr__(self, name, size)
        choices = {"encoder": EncoderKind, "adjacency": Adjacency, "laplacian": LaplacianKind}
        for name, known in choices.items():
            found = getattr(self, name)
            if found not in get_args(known):
                listed = ", ".join(f'"{one}"' for one in get_args(known))
                raise Error("V451", f"{name} must be one of {listed}, found {found!r}")
        if not isinstance(self.attention, (bool, np.bool_)):
            raise Error("V451", f"attention must be True or False, found {self.attention!r}")
        object.__setattr__(self, "attention", bool(self.attention))

    @property
    def is_of_the_paper(self) -> bool:
        """Whether these are the paper's settings, which headers of weight files leave out."""
        return self == Graph()

    @property
    def uses_paper_encoder(self) -> bool:
        """Whether the encoder is the paper's, regardless of the decoder."""
        return replace(self, attention=True).is_of_the_paper

    @property
    def edges(self) -> str | None:
        """The part of an observation with the weights of the edges; None if there is none."""
        return OBSERVED.get(self.adjacency) if self.encoder == "capsules" else None

    @property
    def members(self) -> dict[str, Any]:
        """The settings by their names, as in the header of a weight file."""
        return asdict(self)


def graph_of(given: Graph | Mapping[str, Any] | None) -> Graph:
    """A graph, from one, from its settings by their names, or the paper's.

    Raises:
        Error: V451 if there is no such setting, or no such value.
    """
    if given is None or isinstance(given, Graph):
        return given or Graph()
    if not isinstance(given, Mapping):
        raise Error("V451", f"graph must be a Graph or settings by name, found {given!r}")
    known = list(signature(Graph).parameters)
    for name in given:
        if name not in known:
            raise Error("V451", f"a graph has no setting {name!r}: its settings are {', '.join(known)}")
    return Graph(**given)


def similarities(nodes: Tensor) -> Tensor:
    """1 / (1 + |x_i - x_j|) of every pair of nodes, as in the authors' code: [B, N, F] -> [B, N, N]."""
    differences = nodes.unsqueeze(2) - nodes.unsqueeze(1)
    distances: Tensor = torch.linalg.vector_norm(differences, dim=-1)
    return 1 / (1 + distances)


def laplacian(weights: Tensor, kind: LaplacianKind) -> Tensor:
    """L of edges with these weights [B, N, N], whose diagonal does not count.

    With A the weights and D the sums of its rows on the diagonal, L is (D - A) / N, or I - D^-1 A if it is
    normalised. A vertiport without neighbours has a row of zeros.
    """
    count = weights.shape[-1]
    adjacency = weights * (1 - torch.eye(count, dtype=weights.dtype, device=weights.device))
    degrees = adjacency.sum(dim=-1, keepdim=True)
    if kind == "plain":
        scales = torch.full_like(degrees, 1 / count)
    else:
        scales = torch.where(degrees > 0, 1 / degrees, torch.zeros_like(degrees))
    return torch.diag_embed((degrees * scales).squeeze(-1)) - adjacency * scales

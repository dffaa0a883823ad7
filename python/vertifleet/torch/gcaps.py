"""GCAPS (§IV, Eq. 18-21, Table 3): graph-capsule encoder, attention decoder, and a value head.

h is the embedding length, h_e the number of heads, d = h / h_e. The encoder here is the paper's, with P = 2,
K = 2 and L_e = 1 on the complete graph; a `Graph` chooses among those of `encoders.py`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar

import torch
from torch import Tensor, nn
from torch.nn.functional import relu

from vertifleet import Error
from vertifleet.torch.encoders import AttentionEncoder, CapsuleEncoder
from vertifleet.torch.graph import graph_of
from vertifleet.torch.layers import BEFORE_RELU, LOGITS, LayerNorm, Linear, Matrix, ValueHead
from vertifleet.torch.twin import FULL_FEATURES, Twin, check_size, paper_features

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vertifleet.torch.graph import Graph


CHARGE_FEATURES = 3
"""Number of features of charge, of a node and of the aircraft."""


class Gcaps(Twin):
    """The paper's network, for one number of vertiports.

    Args:
        vertiports: N.
        width: h, the embedding length.
        heads: h_e, the number of attention heads; it divides the width.
        graph: the graph of the vertiports, a `Graph` or its settings by name; by default the paper's.
    """

    kind = "gcaps"
    charge: bool = False
    """Whether the network reads the features of charge."""
    sees_the_full: ClassVar[bool] = False
    """Whether the policy's observation may contain the weights of edges."""

    def __init__(
        self,
        vertiports: int,
        width: int = 256,
        heads: int = 8,
        graph: Graph | Mapping[str, Any] | None = None,
    ) -> None:
        vertiports = check_size("vertiports", vertiports)
        node_features, aircraft_features = paper_features(vertiports)
        super().__init__(vertiports, node_features, aircraft_features)
        self._add_layers(width, heads, graph)

    def _with_charge(self, nodes: int, aircraft: int, charge: bool) -> tuple[int, int]:
        """The numbers of features, with those of charge if the network reads them."""
        if not isinstance(charge, bool):
            raise Error("V451", f"charge must be True or False, found {charge!r}")
        self.charge = charge
        if not charge:
            return nodes, aircraft
        self.features = f"{self.features}charge_"
        return nodes + CHARGE_FEATURES, aircraft + CHARGE_FEATURES

    def _add_layers(self, width: int, heads: int, graph: Graph | Mapping[str, Any] | None) -> None:
        width, heads = check_size("width", width), check_size("heads", heads)
        if width % heads:
            raise Error("V451", f"width must be a multiple of heads ({heads}), found {width}")
        self.width, self.heads, self.graph = width, heads, graph_of(graph)
        self.edges = self.graph.edges
        if self.edges and not self.sees_the_full:
            raise Error(
                "V451", f"the observation of {self.kind} shows no flights between two other vertiports"
            )
        self.encoder = encoder_of(self.node_features, width, heads, self.graph)
        self.decoder = Decoder(self.aircraft_features, width, heads, attention=self.graph.attention)
        self.value = ValueHead(width, width, means_width=width)

    @property
    def sizes(self) -> dict[str, Any]:
        """The embedding length, the number of heads, the graph if it is not the paper's, and whether the
        network reads the features of charge if it does.
        """
        sizes: dict[str, Any] = {"width": self.width, "heads": self.heads}
        if not self.graph.is_of_the_paper:
            sizes["graph"] = self.graph.members
        return sizes | {"charge": True} if self.charge else sizes

    def _answers(
        self, nodes: Tensor, aircraft: Tensor, clock: Tensor, edges: Tensor | None
    ) -> tuple[Tensor, Tensor]:
        embeddings = self.encoder(nodes, edges)
        logits, y = self.decoder(embeddings, aircraft)
        return logits, self.value(y, clock, embeddings.mean(dim=1))


class GcapsX(Gcaps):
    """The layers of :class:`Gcaps` on features whose number does not grow with the network.

    So its weights fit any number of vertiports. The features are those of the observation "gcaps-x", and the
    program adds the logits to the worths of choices at the day's prices. With `charge`, the features of
    charge come after the others.
    """

    kind = "gcaps-x"
    features = "priced_"

    def __init__(
        self,
        width: int = 32,
        heads: int = 4,
        graph: Graph | Mapping[str, Any] | None = None,
        charge: bool = False,
    ) -> None:
        Twin.__init__(self, None, *self._with_charge(24, 10, charge))
        self._add_layers(width, heads, graph)

    @property
    def reads(self) -> tuple[str, ...]:
        """The parts of an observation that the network decides by."""
        return (f"{self.features}nodes", f"{self.features}aircraft", "priced_worth")


class GcapsFull(Gcaps):
    """The layers of :class:`Gcaps` on the observation "gcaps-full", which needs no bid prices.

    Its weights fit any number of vertiports, and it is the only network that reads the weights of edges. With
    `charge`, the features of charge come after the others.
    """

    kind = "gcaps-full"
    features = "full_"
    sees_the_full = True

    def __init__(
        self,
        width: int = 64,
        heads: int = 4,
        graph: Graph | Mapping[str, Any] | None = None,
        charge: bool = False,
    ) -> None:
        Twin.__init__(self, None, *self._with_charge(*FULL_FEATURES, charge))
        self._add_layers(width, heads, graph)


def encoder_of(features: int, width: int, heads: int, graph: Graph) -> nn.Module:
    """The encoder of a graph, from the features of nodes."""
    if graph.uses_paper_encoder:
        return Encoder(features, width)
    if graph.encoder == "transformer":
        return AttentionEncoder(features, width, heads, graph.layers)
    return CapsuleEncoder(features, width, graph)


class Encoder(nn.Module):
    """§IV.A.1: an embedding of every vertiport from the features of all."""

    def __init__(self, features: int, width: int) -> None:
        super().__init__()
        self.node = Linear(features, width)
        self.moment_1 = Hops(width)
        self.moment_2 = Hops(width)
        self.feed_forward = Linear(2 * width, width)

    def forward(self, nodes: Tensor, edges: Tensor | None) -> Tensor:  # noqa: ARG002
        """[B, N, F] -> [B, N, h]; the complete graph needs no edges."""
        f_0 = self.node(nodes)  # F_0i = δ_i W_0 + b_0
        f_1 = self.moment_1(f_0)  # Eq. 18 with p = 1
        f_2 = self.moment_2(f_0 * f_0)  # Eq. 18 with p = 2
        capsules = torch.cat([f_1, f_2], dim=-1)  # Eq. 19
        embeddings: Tensor = self.feed_forward(capsules)
        return embeddings


class Hops(nn.Module):
    """Eq. 18 for one p on the complete graph: ``f_p = ReLU(sum over a of (L/N)^a F V_pa)``.

    It uses powers of L / N instead of L = D - A, which give the same family of functions (W_pa = V_pa / N^a)
    with all terms on one scale. On the complete graph, L / N subtracts the mean over the nodes, and
    subtracting it twice is the same as once, so the sum is ``F (V_p0 + V_p1 + V_p2) - mean(F) (V_p1 +
    V_p2)``.
    """

    def __init__(self, width: int) -> None:
        super().__init__()
        # Three terms add up before the rectifier.
        self.hop_0 = Matrix(width, width, BEFORE_RELU, inputs_in_all=3 * width)
        self.hop_1 = Matrix(width, width, BEFORE_RELU, inputs_in_all=3 * width)
        self.hop_2 = Matrix(width, width, BEFORE_RELU, inputs_in_all=3 * width)

    def forward(self, f: Tensor) -> Tensor:
        """[B, N, h] -> [B, N, h]."""
        outer = self.hop_1.weight + self.hop_2.weight
        mean = f.mean(dim=1, keepdim=True)
        return relu(f @ (self.hop_0.weight + outer) - mean @ outer)


class Decoder(nn.Module):
    """§IV.B: logits of the vertiports, from their embeddings E and the aircraft's state ψ.

    ::

        q = ψ W_Q + b_Q
        z = LayerNorm(q + MHA(q, E))
        y = LayerNorm(z + ReLU(z W_1 + b_1))
        logit_i = (y W_L) · E_i / sqrt(h)

    Without attention, every head collects the mean of the embeddings in place of MHA(q, E).
    """

    def __init__(self, features: int, width: int, heads: int, *, attention: bool) -> None:
        super().__init__()
        self.heads, self.attention = heads, attention
        self.query = Linear(features, width)
        self.key = Matrix(width, width)
        self.value = Matrix(width, width)
        self.output = Matrix(width, width)
        self.norm_1 = LayerNorm(width)
        self.feed_forward = Linear(width, width, BEFORE_RELU)
        self.norm_2 = LayerNorm(width)
        self.pointer = Matrix(width, width, LOGITS)

    def forward(self, embeddings: Tensor, aircraft: Tensor) -> tuple[Tensor, Tensor]:
        """Logits [B, N] and y [B, h] from embeddings [B, N, h] and the aircraft's features [B, G]."""
        q = self.query(aircraft)
        z = self.norm_1(q + self.attend(q, embeddings))
        y = self.norm_2(z + relu(self.feed_forward(z)))
        pointer = self.pointer(y) / math.sqrt(y.shape[-1])
        logits = torch.bmm(embeddings, pointer.unsqueeze(-1)).squeeze(-1)
        return logits, y

    def attend(self, q: Tensor, embeddings: Tensor) -> Tensor:
        """MHA(q, E) of Eq. 20 and 21: [B, h] from a query [B, h] and embeddings [B, N, h].

        There is one query for all nodes, so keys and values of all nodes are not computed. Instead, a head's
        query is transformed to the embeddings' side, ``q · (E_i W_K) = (W_K q) · E_i``, and W_V is applied to
        the sum that its attention collects.
        """
        if not self.attention:
            mean: Tensor = self.output(self.value(embeddings.mean(dim=1)))
            return mean
        batch, width = q.shape
        of_heads = (width, self.heads, width // self.heads)  # h x h_e x d
        queries = torch.einsum("bed,hed->beh", q.view(batch, *of_heads[1:]), self.key.weight.view(of_heads))
        scores = torch.bmm(queries, embeddings.transpose(1, 2)) / math.sqrt(of_heads[2])
        attention = torch.softmax(scores, dim=-1)  # [B, h_e, N]
        collected = torch.bmm(attention, embeddings)  # [B, h_e, h]
        heads = torch.einsum("beh,hed->bed", collected, self.value.weight.view(of_heads))
        attended: Tensor = self.output(heads.reshape(batch, width))
        return attended

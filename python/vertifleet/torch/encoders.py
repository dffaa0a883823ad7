"""The encoders besides the paper's: graph capsules on any graph, and self-attention.

Self-attention uses no graph. They have the tensors of the program's `capsule_layers.rs`, `self_attention.rs`
and `fleet.rs`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import torch
from torch import Tensor, nn
from torch.nn.functional import relu, scaled_dot_product_attention

from vertifleet.torch.graph import laplacian, similarities
from vertifleet.torch.layers import BEFORE_RELU, LayerNorm, Linear, Matrix

if TYPE_CHECKING:
    from vertifleet.torch.graph import Graph


class Hops(nn.Module):
    """Eq. 18 for one p: ``f_p = ReLU(sum over a of L^a F^p W_pa)``.

    The sum is taken from the highest power down, ``H_0 + L (H_1 + L (H_2 + ...))`` with ``H_a = F^p W_pa``,
    so that L is applied K times.
    """

    def __init__(self, width: int, hops: int) -> None:
        super().__init__()
        # As many terms as there are hops add up before the rectifier.
        for a in range(hops + 1):
            self.add_module(f"hop_{a}", Matrix(width, width, BEFORE_RELU, inputs_in_all=(hops + 1) * width))

    def forward(self, f: Tensor, laplacians: Tensor) -> Tensor:
        """[B, N, h] and [B, N, N] -> [B, N, h]."""
        terms = [hop(f) for hop in self.children()]
        total: Tensor = terms.pop()
        while terms:
            total = terms.pop() + laplacians @ total
        return relu(total)


class CapsuleLayer(nn.Module):
    """The capsules of one layer (Eq. 19), and the map from those of the layer before to features."""

    def __init__(self, width: int, graph: Graph, *, is_first: bool) -> None:
        super().__init__()
        if not is_first:
            self.input = Linear(graph.moments * width, width)
        self._moments = range(1, graph.moments + 1)
        for p in self._moments:
            self.add_module(f"moment_{p}", Hops(width, graph.hops))

    def capsules(self, features: Tensor, laplacians: Tensor) -> Tensor:
        """[f_1, ..., f_P]: [B, N, h] and [B, N, N] -> [B, N, P * h]."""
        moments = [self.get_submodule(f"moment_{p}")(features**p, laplacians) for p in self._moments]
        return torch.cat(moments, dim=-1)


class CapsuleEncoder(CapsuleLayer):
    """Graph capsules on any graph, with any number of moments, hops and layers.

    The encoder holds the first layer's weights directly, as the paper's encoder does.
    """

    def __init__(self, features: int, width: int, graph: Graph) -> None:
        super().__init__(width, graph, is_first=True)
        self.graph = graph
        self.node = Linear(features, width)
        self._later = range(2, graph.layers + 1)
        for number in self._later:
            self.add_module(f"layer_{number}", CapsuleLayer(width, graph, is_first=False))
        self.feed_forward = Linear(graph.moments * width, width)

    def forward(self, nodes: Tensor, edges: Tensor | None) -> Tensor:
        """Embeddings [B, N, h] of nodes [B, N, F], with weights [B, N, N] of edges if they are observed."""
        laplacians = laplacian(self.weights(nodes, edges), self.graph.laplacian)
        capsules = self.capsules(self.node(nodes), laplacians)
        for number in self._later:
            layer = cast("CapsuleLayer", self.get_submodule(f"layer_{number}"))
            capsules = layer.capsules(layer.input(capsules), laplacians)
        embeddings: Tensor = self.feed_forward(capsules)
        return embeddings

    def weights(self, nodes: Tensor, edges: Tensor | None) -> Tensor:
        """The weights of the edges, [B, N, N]."""
        if edges is not None:
            return edges
        if self.graph.adjacency == "similarity":
            return similarities(nodes)
        batch, count, _ = nodes.shape
        return nodes.new_ones(batch, count, count)


class AttentionEncoder(nn.Module):
    """Layers of self-attention (Vaswani et al., 2017), in which every vertiport attends to all others."""

    def __init__(self, features: int, width: int, heads: int, layers: int) -> None:
        super().__init__()
        self.node = Linear(features, width)
        self._layers = range(1, layers + 1)
        for number in self._layers:
            self.add_module(f"layer_{number}", AttentionLayer(width, heads))
        self.feed_forward = Linear(width, width)

    def forward(self, nodes: Tensor, edges: Tensor | None) -> Tensor:  # noqa: ARG002
        """Embeddings [B, N, h] of nodes [B, N, F]; there are no edges."""
        features: Tensor = self.node(nodes)
        for number in self._layers:
            features = self.get_submodule(f"layer_{number}")(features)
        embeddings: Tensor = self.feed_forward(features)
        return embeddings


class AttentionLayer(nn.Module):
    """One layer of self-attention.

    ::

        A = softmax(Q K^T / sqrt(d)) of each head, with Q = F W_Q, K = F W_K, V = F W_V
        G = LayerNorm(F + [A V of all heads] W_O)
        F' = LayerNorm(G + ReLU(G W_1 + b_1) W_2 + b_2)
    """

    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.heads = heads
        self.query = Matrix(width, width)
        self.key = Matrix(width, width)
        self.value = Matrix(width, width)
        self.output = Matrix(width, width)
        self.norm_1 = LayerNorm(width)
        self.lift = Linear(width, 2 * width, BEFORE_RELU)
        self.lower = Linear(2 * width, width)
        self.norm_2 = LayerNorm(width)

    def forward(self, features: Tensor) -> Tensor:
        """[B, N, h] -> [B, N, h]."""
        batch, count, width = features.shape

        def of_heads(read: Matrix) -> Tensor:
            rows: Tensor = read(features)
            return rows.view(batch, count, self.heads, width // self.heads).transpose(1, 2)

        queries, keys, values = (of_heads(read) for read in (self.query, self.key, self.value))
        heads = scaled_dot_product_attention(queries, keys, values)
        collected = heads.transpose(1, 2).reshape(batch, count, width)
        middle = self.norm_1(features + self.output(collected))
        lifted = relu(self.lift(middle))
        made: Tensor = self.norm_2(middle + self.lower(lifted))
        return made

"""The layers of the networks, with the names and shapes of the weight files and the same initial weights.

A matrix is [inputs, outputs] and used as ``x W``. Initial weights are uniform with mean 0 and variance
``gain² / inputs`` (He et al. 2015, LeCun et al. 1998), drawn with torch's generator.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn
from torch.nn.functional import layer_norm, relu

BEFORE_RELU = math.sqrt(2.0)
"""Gain before a rectifier, which loses half of the signal's power."""
LOGITS = 0.01
"""Gain of the last matrix of the logits, as in stable-baselines3: the first policy is nearly uniform."""
VALUE = 0.1
"""Gain of the last weights of the value: the first values are near 0."""


def uniform(*shape: int, inputs: int, gain: float) -> nn.Parameter:
    """Weights with mean 0 and variance ``gain² / inputs``."""
    reach = gain * math.sqrt(3.0 / inputs)
    return nn.Parameter(torch.empty(shape).uniform_(-reach, reach))


class Matrix(nn.Module):
    """``x W``.

    Args:
        inputs: rows of W.
        outputs: columns of W.
        gain: gain of the first weights.
        inputs_in_all: total number of inputs if other matrices add to the same output; ``inputs`` by default.
    """

    def __init__(self, inputs: int, outputs: int, gain: float = 1.0, inputs_in_all: int = 0) -> None:
        super().__init__()
        self.weight = uniform(inputs, outputs, inputs=inputs_in_all or inputs, gain=gain)

    def forward(self, x: Tensor) -> Tensor:
        """[..., inputs] -> [..., outputs]."""
        return x @ self.weight


class Linear(Matrix):
    """``x W + b``."""

    def __init__(self, inputs: int, outputs: int, gain: float = 1.0, inputs_in_all: int = 0) -> None:
        super().__init__(inputs, outputs, gain, inputs_in_all)
        self.bias = nn.Parameter(torch.zeros(outputs))

    def forward(self, x: Tensor) -> Tensor:
        """[..., inputs] -> [..., outputs]."""
        return x @ self.weight + self.bias


class LayerNorm(nn.Module):
    """Brings every row to mean 0 and variance 1, then applies a scale and a shift (Ba et al. 2016)."""

    def __init__(self, width: int) -> None:
        super().__init__()
        self.scale = nn.Parameter(torch.ones(width))
        self.shift = nn.Parameter(torch.zeros(width))

    def forward(self, x: Tensor) -> Tensor:
        """[..., width] -> [..., width]."""
        return layer_norm(x, self.scale.shape, self.scale, self.shift, eps=1e-5)


class Sum(nn.Module):
    """``x · w + b``, a number for every row."""

    def __init__(self, inputs: int, gain: float) -> None:
        super().__init__()
        self.weight = uniform(inputs, inputs=inputs, gain=gain)
        self.bias = nn.Parameter(torch.zeros(1))

    def forward(self, x: Tensor) -> Tensor:
        """[..., inputs] -> [...]."""
        return x @ self.weight + self.bias


class ValueHead(nn.Module):
    """``v = w · ReLU([features, clock] W + b) + c``.

    The clock, the share of the day that is left, enters here only: no choice depends on it directly.
    ``means_width`` is the width of the means over the nodes if the head reads them too, and otherwise 0.
    """

    def __init__(self, features: int, width: int, means_width: int = 0) -> None:
        super().__init__()
        inputs_in_all = means_width + features + 1
        if means_width:
            self.means = Matrix(means_width, width, BEFORE_RELU, inputs_in_all)
        self.hidden = Linear(features + 1, width, BEFORE_RELU, inputs_in_all)
        self.output = Sum(width, VALUE)

    def forward(self, features: Tensor, clock: Tensor, means: Tensor | None = None) -> Tensor:
        """Values [B] from features [B, features], clock [B] and means [B, means_width]."""
        hidden = self.hidden(torch.cat([features, clock.reshape(-1, 1)], dim=-1))
        if means is not None:
            hidden = hidden + self.means(means)
        values: Tensor = self.output(relu(hidden))
        return values

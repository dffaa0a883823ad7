"""The paper's baseline (§V.B): plain layers on the flattened features, with the same mask and value head.

`MlpFull` has the same layers on the full observation.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn.functional import relu

from vertifleet.torch.layers import BEFORE_RELU, LOGITS, Linear, ValueHead
from vertifleet.torch.twin import FULL_FEATURES, Twin, check_size, paper_features

MOST_LAYERS = 16


class Mlp(Twin):
    """The baseline's network, for one number of vertiports.

    Args:
        vertiports: N.
        width: number of outputs of each layer.
        layers: number of layers before the logits.
        value_width: width of the value head's layer.
    """

    kind = "mlp"

    def __init__(self, vertiports: int, width: int = 800, layers: int = 2, value_width: int = 256) -> None:
        vertiports = check_size("vertiports", vertiports)
        super().__init__(vertiports, *self._features_of(vertiports))
        self.width = width = check_size("width", width)
        self.layers = layers = check_size("layers", layers, MOST_LAYERS)
        self.value_width = value_width = check_size("value_width", value_width)
        of_all = vertiports * self.node_features + self.aircraft_features
        inputs = [of_all] + (layers - 1) * [width]
        self.trunk = nn.ModuleDict(
            {str(layer): Linear(count, width, BEFORE_RELU) for layer, count in enumerate(inputs, start=1)}
        )
        self.logits = Linear(width, vertiports, LOGITS)
        self.value = ValueHead(width, value_width)

    @staticmethod
    def _features_of(vertiports: int) -> tuple[int, int]:
        return paper_features(vertiports)

    @property
    def sizes(self) -> dict[str, int]:
        """Width and number of the layers, and the width of the value head."""
        return {"width": self.width, "layers": self.layers, "value_width": self.value_width}

    def _answers(
        self,
        nodes: Tensor,
        aircraft: Tensor,
        clock: Tensor,
        edges: Tensor | None,  # noqa: ARG002 - it has no graph
    ) -> tuple[Tensor, Tensor]:
        x = torch.cat([nodes.flatten(start_dim=1), aircraft], dim=-1)
        for layer in self.trunk.values():
            x = relu(layer(x))
        return self.logits(x), self.value(x, clock)


class MlpFull(Mlp):
    """The layers of :class:`Mlp` on the observation "gcaps-full", flattened, for one number of vertiports."""

    kind = "mlp-full"
    features = "full_"

    def __init__(self, vertiports: int, width: int = 256, layers: int = 2, value_width: int = 64) -> None:
        super().__init__(vertiports, width, layers, value_width)

    @staticmethod
    def _features_of(vertiports: int) -> tuple[int, int]:  # noqa: ARG004
        return FULL_FEATURES

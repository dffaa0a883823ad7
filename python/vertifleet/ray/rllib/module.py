"""The networks of layers as modules of RLlib's new API stack."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import torch
from ray.rllib.core.columns import Columns
from ray.rllib.core.rl_module.apis import ValueFunctionAPI
from ray.rllib.core.rl_module.torch import TorchRLModule

from vertifleet import Error
from vertifleet.torch import Gcaps, Mlp
from vertifleet.torch.twin import of_sizes

if TYPE_CHECKING:
    from gymnasium import spaces
    from torch import Tensor

KINDS: dict[str, type[Gcaps] | type[Mlp]] = {"gcaps": Gcaps, "mlp": Mlp}


class FleetModule(TorchRLModule, ValueFunctionAPI):
    """A network of the program, which decides among the feasible vertiports.

    Its ``model_config`` has the ``policy``, "gcaps" or "mlp", and the ``sizes`` of its layers, which are
    those of the shipped weights by default.
    """

    def setup(self) -> None:
        """Creates the network with first weights."""
        (vertiports,) = cast("tuple[int]", cast("spaces.Dict", self.observation_space)["action_mask"].shape)
        config = cast("dict[str, Any]", self.model_config)
        self.twin = of_sizes(kind_of(config["policy"]), vertiports, config["sizes"])

    def _forward(self, batch: dict[str, Any], **_: Any) -> dict[str, Any]:
        logits, _values = self._pass(batch)
        return {Columns.ACTION_DIST_INPUTS: logits}

    def _forward_train(self, batch: dict[str, Any], **_: Any) -> dict[str, Any]:
        # The values are returned as embeddings: RLlib hands embeddings on to `compute_values`.
        logits, values = self._pass(batch)
        return {Columns.ACTION_DIST_INPUTS: logits, Columns.EMBEDDINGS: values}

    def compute_values(self, batch: dict[str, Any], embeddings: Tensor | None = None) -> Tensor:
        """Values [B] of a batch; `embeddings` are the values if the batch has passed the network already."""
        return self._pass(batch)[1] if embeddings is None else embeddings

    def _pass(self, batch: dict[str, Any]) -> tuple[Tensor, Tensor]:
        """Logits [B, N], the lowest finite number where the mask is 0, and values [B].

        The probability is 0 there. Minus infinity would give 0 too, but its product with 0 is NaN.
        """
        shown = batch[Columns.OBS]
        logits, values = self.twin(shown["nodes"], shown["aircraft"], shown["clock"])
        lowest = torch.finfo(logits.dtype).min
        return logits.masked_fill(shown["action_mask"] == 0, lowest), values


def kind_of(policy: str) -> type[Gcaps] | type[Mlp]:
    """The class of the network with this name."""
    if policy not in KINDS:
        raise Error("V451", f"policy must be one of {', '.join(KINDS)}, found {policy!r}")
    return KINDS[policy]

"""From logits to decisions: the mask, and the choice of the highest logit (§IV.B, greedy decoding)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from torch import Tensor

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from vertifleet.torch.twin import Twin


def masked(logits: Tensor, mask: Tensor) -> Tensor:
    """The logits [B, N], minus infinity where the mask [B, N] is 0; their softmax is the policy."""
    return logits.masked_fill(mask == 0, -torch.inf)


def act(twin: Twin, observation: Mapping[str, NDArray[Any]]) -> int | NDArray[np.int64]:
    """The feasible vertiport with the highest logit, the first among equals.

    Args:
        twin: the network.
        observation: what an environment shows; "nodes", "aircraft", "clock" and "action_mask" are read.

    Returns:
        A vertiport for one observation, vertiports [B] for a batch of them.
    """
    weight = next(twin.parameters())
    one = np.ndim(observation["aircraft"]) == 1

    def tensor(name: str) -> Tensor:
        entries = torch.as_tensor(observation[name], dtype=weight.dtype, device=weight.device)
        return entries.unsqueeze(0) if one else entries

    with torch.inference_mode():
        logits, _ = twin(tensor("nodes"), tensor("aircraft"), tensor("clock"))
        choices = masked(logits, tensor("action_mask")).cpu().numpy().argmax(axis=-1)
    return int(choices[0]) if one else choices

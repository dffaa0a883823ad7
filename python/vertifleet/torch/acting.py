"""From logits to choices: the mask, and the choice of the highest logit (§IV.B, greedy decoding)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from torch import Tensor

from vertifleet import Error

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from vertifleet.torch.twin import Twin

READ = ("nodes", "aircraft", "clock", "action_mask")
"""The entries of an observation that the networks read."""


def masked(logits: Tensor, mask: Tensor) -> Tensor:
    """The logits [B, N], minus infinity where the mask [B, N] is 0; their softmax is the policy."""
    return logits.masked_fill(mask == 0, -torch.inf)


def act(twin: Twin, observation: Mapping[str, NDArray[Any]]) -> int | NDArray[np.int64]:
    """The feasible vertiport with the highest logit, the first among equals.

    Args:
        twin: the network.
        observation: an observation; "nodes", "aircraft", "clock" and "action_mask" are read.

    Returns:
        A vertiport for one observation, vertiports [B] for a batch of them.

    Raises:
        Error: V451 if the observation lacks one of these, or has other shapes than the network reads.
    """
    missing = [name for name in READ if name not in observation]
    if missing:
        raise Error("V451", f"the observation lacks {', '.join(missing)}: {', '.join(READ)} are read")
    weight = next(twin.parameters())
    one = np.ndim(observation["aircraft"]) == 1

    def tensor(name: str) -> Tensor:
        entries = torch.as_tensor(observation[name], dtype=weight.dtype, device=weight.device)
        return entries.unsqueeze(0) if one else entries

    nodes, aircraft, clock, mask = (tensor(name) for name in READ)
    batch = len(nodes)
    _check("aircraft", aircraft, [batch, twin.aircraft_features])
    _check("clock", clock.reshape(-1), [batch])
    with torch.inference_mode():
        logits, _ = twin(nodes, aircraft, clock)
        _check("action_mask", mask, logits.shape)
        choices: NDArray[np.int64] = masked(logits, mask).argmax(dim=-1).cpu().numpy()
    return int(choices[0]) if one else choices


def _check(name: str, found: Tensor, expected: Sequence[int]) -> None:
    """Refuses an entry of another network's or another policy's observation."""
    if list(found.shape) != list(expected):
        raise Error("V451", f"{name} must be {list(expected)}, found {list(found.shape)}")

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

PRICED = "gcaps-x"
READ = ("nodes", "aircraft", "clock", "action_mask")
"""The entries of an observation that the networks of one size read."""
READ_PRICED = ("priced_nodes", "priced_aircraft", "priced_worth")
"""The entries that `GcapsX` reads."""


def masked(logits: Tensor, mask: Tensor) -> Tensor:
    """The logits [B, N], minus infinity where the mask [B, N] is 0; their softmax is the policy."""
    return logits.masked_fill(mask == 0, -torch.inf)


def scores(twin: Twin, observation: Mapping[str, Tensor]) -> Tensor:
    """What a network chooses by, [B, N]: minus infinity for what it does not choose. Its softmax is a policy.

    For `GcapsX` this is the logit and the worth at the day's bid prices, of the choices of the shortlist; for
    the others it is the masked logit. It has gradients, so it is also what to train by.

    Args:
        twin: the network.
        observation: a batch of observations: "gcaps-x" for `GcapsX`, "paper" for the others.
    """
    if twin.kind != PRICED:
        logits, _ = twin(observation["nodes"], observation["aircraft"], observation["clock"])
        _check("action_mask", observation["action_mask"], logits.shape)
        return masked(logits, observation["action_mask"])
    nodes = observation["priced_nodes"]
    logits, _ = twin(nodes, observation["priced_aircraft"], nodes.new_zeros(len(nodes)))
    _check("priced_worth", observation["priced_worth"], logits.shape)
    return masked(logits + observation["priced_worth"], nodes[..., 0])


def act(twin: Twin, observation: Mapping[str, NDArray[Any]]) -> int | NDArray[np.int64]:
    """The choice with the highest score, the first among equals.

    Args:
        twin: the network.
        observation: an observation: "gcaps-x" for `GcapsX`, "paper" for the others.

    Returns:
        A vertiport for one observation, vertiports [B] for a batch of them.

    Raises:
        Error: V451 if the observation lacks what the network reads, or has other shapes.
    """
    read = READ_PRICED if twin.kind == PRICED else READ
    missing = [name for name in read if name not in observation]
    if missing:
        raise Error("V451", f"the observation lacks {', '.join(missing)}: {', '.join(read)} are read")
    weight = next(twin.parameters())
    one = np.ndim(observation[read[1]]) == 1

    def tensor(name: str) -> Tensor:
        entries = torch.as_tensor(observation[name], dtype=weight.dtype, device=weight.device)
        return entries.unsqueeze(0) if one else entries

    tensors = {name: tensor(name) for name in read}
    aircraft = tensors[read[1]]
    _check(read[1], aircraft, [len(aircraft), twin.aircraft_features])
    if "clock" in tensors:
        _check("clock", tensors["clock"].reshape(-1), [len(aircraft)])
    with torch.inference_mode():
        choices: NDArray[np.int64] = scores(twin, tensors).argmax(dim=-1).cpu().numpy()
    return int(choices[0]) if one else choices


def _check(name: str, found: Tensor, expected: Sequence[int]) -> None:
    """Refuses an entry of another network's or another policy's observation."""
    if list(found.shape) != list(expected):
        raise Error("V451", f"{name} must be {list(expected)}, found {list(found.shape)}")

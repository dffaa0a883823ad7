"""From logits to choices: the mask, and the choice of the highest logit (§IV.B, greedy decoding)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from torch import Tensor
from torch.nn.functional import pad

from vertifleet import Error
from vertifleet.torch.graph import OBSERVED

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from vertifleet.torch.twin import Twin

READ = ("nodes", "aircraft", "clock", "action_mask")
"""The entries of the paper's observation that its networks read."""
WORTH = "priced_worth"
"""The entry that is added to the logits of `GcapsX`."""
VERTIPORTS = "vertiport_mask"
"""The entry that marks the vertiports of a day; the rest of the arrays is padding."""


def masked(logits: Tensor, mask: Tensor) -> Tensor:
    """The logits [B, N], minus infinity where the mask [B, N] is 0; their softmax is the policy."""
    return logits.masked_fill(mask == 0, -torch.inf)


def check_mask(mask: Tensor) -> None:
    """Refuses a mask with other numbers than 0 and 1, which a wrapper may produce: all would seem feasible.

    Raises:
        Error: V451.
    """
    if not bool(((mask == 0) | (mask == 1)).all()):
        raise Error(
            "V451",
            "action_mask must be 0 or 1, and a wrapper such as VecNormalize has changed it",
            "leave it out: VecNormalize takes norm_obs_keys with the other parts",
        )


def scores(twin: Twin, observation: Mapping[str, Tensor]) -> Tensor:
    """The scores that a network chooses by, [B, N]: minus infinity for excluded choices. Their softmax is a
    policy.

    For `GcapsX` this is the logit and the worth at the day's bid prices, of the choices of the shortlist; for
    the others it is the masked logit. It has gradients, so losses can use it.

    If an observation has "vertiport_mask", as "gcaps-full" does, a network that fits any number of vertiports
    ignores the padding of smaller days.

    Args:
        twin: the network.
        observation: a batch of observations, with the parts of `twin.reads`: "gcaps-x" has them for `GcapsX`,
            "gcaps-full" for `MlpFull` and for `GcapsFull` on the complete graph of vertiports alone, "paper"
            for the others.
    """
    if twin.vertiports is not None or VERTIPORTS not in observation:
        return _scores(twin, observation)
    counts = observation[VERTIPORTS].sum(dim=-1).long()
    most = observation[VERTIPORTS].shape[-1]
    known = sorted(set(counts.tolist()))
    if known in ([], [most]):
        return _scores(twin, observation)
    found = []
    for count in known:
        rows = (counts == count).nonzero().squeeze(-1)
        of_rows = {name: _cut(name, observation[name][rows], count) for name in twin.reads}
        of_count = _scores(twin, of_rows)
        found.append((rows, pad(of_count, (0, most - count), value=-torch.inf)))
    order = torch.cat([rows for rows, _ in found]).argsort()
    return torch.cat([part for _, part in found])[order]


def _cut(name: str, entries: Tensor, count: int) -> Tensor:
    """The entries of the first vertiports, which belong to the day; for edges, those of their pairs."""
    if name.endswith("aircraft") or name == "clock":
        return entries
    return entries[:, :count, :count] if name in OBSERVED.values() else entries[:, :count]


def _scores(twin: Twin, observation: Mapping[str, Tensor]) -> Tensor:
    """The scores of observations without padding."""
    nodes, aircraft = (observation[twin.features + part] for part in ("nodes", "aircraft"))
    clock = observation["clock"] if "clock" in twin.reads else nodes.new_zeros(len(nodes))
    edges = {} if twin.edges is None else {"edges": observation[twin.edges]}
    logits, _ = twin(nodes, aircraft, clock, **edges)
    if WORTH in twin.reads:
        _check(WORTH, observation[WORTH], logits.shape)
        return masked(logits + observation[WORTH], nodes[..., 0])
    _check("action_mask", observation["action_mask"], logits.shape)
    check_mask(observation["action_mask"])
    return masked(logits, observation["action_mask"])


def act(twin: Twin, observation: Mapping[str, NDArray[Any]]) -> int | NDArray[np.int64]:
    """The choice with the highest score, the first among equals.

    Args:
        twin: the network.
        observation: an observation, with the parts of `twin.reads`: "gcaps-x" has them for `GcapsX`,
            "gcaps-full" for `MlpFull` and for `GcapsFull` on the complete graph of vertiports alone, "paper"
            for the others.

    Returns:
        A vertiport for one observation, vertiports [B] for a batch of them.

    Raises:
        Error: V451 if the observation lacks what the network reads, or has other shapes.
    """
    read = twin.reads
    missing = [name for name in read if name not in observation]
    if missing:
        raise Error(
            "V451",
            f"the observation lacks {', '.join(missing)}: {', '.join(read)} are read",
            "an environment with observation=twin.reads shows them",
        )
    weight = next(twin.parameters())
    aircraft_name = f"{twin.features}aircraft"
    one = np.ndim(observation[aircraft_name]) == 1

    def tensor(name: str) -> Tensor:
        entries = torch.as_tensor(observation[name], dtype=weight.dtype, device=weight.device)
        return entries.unsqueeze(0) if one else entries

    shown = [*read, VERTIPORTS] if VERTIPORTS in observation else read
    tensors = {name: tensor(name) for name in shown}
    aircraft = tensors[aircraft_name]
    _check(aircraft_name, aircraft, [len(aircraft), twin.aircraft_features])
    if "clock" in tensors:
        _check("clock", tensors["clock"].reshape(-1), [len(aircraft)])
    with torch.inference_mode():
        choices: NDArray[np.int64] = scores(twin, tensors).argmax(dim=-1).cpu().numpy()
    return int(choices[0]) if one else choices


def _check(name: str, found: Tensor, expected: Sequence[int]) -> None:
    """Refuses an entry of another network's or another policy's observation."""
    if list(found.shape) != list(expected):
        raise Error("V451", f"{name} must be {list(expected)}, found {list(found.shape)}")

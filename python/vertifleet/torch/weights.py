"""Weight files both ways: the program reads what is saved here, and what the program writes is loaded here.

Files are read, checked and written by the program's own reader (:class:`vertifleet.Model`): a file that loads
here loads there, and a damaged one is refused with the same words.
"""

from __future__ import annotations

import json
import os
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import safetensors.torch
import torch

from vertifleet import Error, Model, Network
from vertifleet.torch.gcaps import Gcaps, GcapsX
from vertifleet.torch.mlp import Mlp

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vertifleet.torch.twin import Twin

FORMAT = "vertifleet-weights/1"
"""Of policies that fit one number of vertiports."""
FORMAT_ANY = "vertifleet-weights-any/1"
"""Of gcaps-x, which fits any."""
NEVER = 1_000_000_000
"""For "eval_every" where nobody looks at validation days, and the weights kept are the last."""


def load(source: str | os.PathLike[str] | bytes) -> Twin:
    """The network of a weight file; its ``header`` says where the weights come from.

    Args:
        source: the file's path, or its bytes.

    Raises:
        Error: V304 if it is no weight file or its tensors are not those of the policy that its header names,
            others if it cannot be read.
    """
    model = Model.from_bytes(source) if isinstance(source, bytes) else Model.read(source)
    header: dict[str, Any] = model.header
    twin = _of(header)
    tensors = {name: torch.from_numpy(entries) for name, entries in model.tensors.items()}
    twin.load_state_dict(tensors, assign=True)
    twin.header = header
    return twin


def save(
    twin: Twin,
    path: str | os.PathLike[str],
    *,
    network: Network | None = None,
    settings: Mapping[str, Any] | None = None,
    seed: int | None = None,
    steps: int | None = None,
) -> None:
    """Writes a weight file, whole or not at all.

    What is not given stays as in the file that the weights were loaded from; weights from no file need all.

    Args:
        twin: the network.
        path: the file.
        network: what the weights were trained on.
        settings: the settings of the training run, with the members of ``vertifleet.settings("paper")``; of a
            ``gcaps-x``, with those of ``course`` in its header.
        seed: seed of the training run.
        steps: decisions learned from.

    Raises:
        Error: V304 if a weight is not finite or the origin has a member of the wrong type, V303 if a setting
            is out of its bounds, V102 if the file cannot be written, V451 if the arguments do not fit.
    """
    header = _header(twin, network, settings, seed, steps)
    tensors = {name: tensor.detach().float().cpu().contiguous() for name, tensor in twin.state_dict().items()}
    file = safetensors.torch.save(tensors, metadata={"vertifleet": json.dumps(header)})
    Model.from_bytes(file, os.fspath(path)).write(path)


def _of(header: Mapping[str, Any]) -> Twin:
    """The network that a checked header describes, its weights without memory as yet."""
    sizes = {name: size for name, size in header["policy"].items() if name != "kind"}
    with torch.device("meta"):
        match header["policy"]["kind"]:
            case "gcaps-x":
                return GcapsX(**sizes)
            case "gcaps":
                return Gcaps(header["shape"]["vertiports"], **sizes)
            case _:
                return Mlp(header["shape"]["vertiports"], **sizes)


def _header(
    twin: Twin,
    network: Network | None,
    settings: Mapping[str, Any] | None,
    seed: int | None,
    steps: int | None,
) -> dict[str, Any]:
    """The header of the network's file: that of the file it comes from, but for what is said anew."""
    fits_any = twin.vertiports is None
    said: dict[str, Any] = {
        "network": None if network is None else network.name,
        "course" if fits_any else "settings": None if settings is None else dict(settings),
        "seed": seed,
        "decisions" if fits_any else "steps": steps,
    }
    new = {member: value for member, value in said.items() if value is not None}
    if twin.header is None and len(new) < len(said):
        raise Error("V451", "weights that come from no file are saved with network, settings, seed and steps")
    if network is not None and not fits_any:
        if len(network.vertiports) != twin.vertiports:
            found = len(network.vertiports)
            rule = (
                f"the weights are for {twin.vertiports} vertiports, but network {network.name!r} has {found}"
            )
            raise Error("V451", rule)
        new["feature_scales"] = network.feature_scales
    if new:
        new["commit"] = f"python {version('vertifleet')}"
    kind = {"format": FORMAT_ANY if fits_any else FORMAT, "policy": twin.policy, "shape": twin.shape}
    return kind | (twin.header or {}) | new

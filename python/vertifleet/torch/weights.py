"""Weight files in both directions: the program reads files saved here, and files of the program load here.

The program's reader (:class:`vertifleet.Model`) reads, checks and writes the files: a file that loads here
loads in the program, and a damaged file is refused with the same message.
"""

from __future__ import annotations

import json
import os
import re
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import safetensors.torch
import torch

from vertifleet import Error, Model, Network
from vertifleet._compare import network_of
from vertifleet.torch.gcaps import Gcaps, GcapsFull, GcapsX
from vertifleet.torch.mlp import Mlp, MlpFull
from vertifleet.torch.origin import MOST_SEED, MOST_STEPS, checked_settings, whole

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vertifleet.torch.twin import Twin

FORMAT = "vertifleet-weights/2"
OF_THE_PAPER = ("gcaps", "mlp")
"""The policies that learn by PPO, on features that have scales; the others learn by imitation."""

DRAWN = re.compile(r"random|random-places:\d+")
"""The names of sources that draw a new network for each day."""


def load(source: str | os.PathLike[str] | bytes) -> Twin:
    """The network of a weight file; its ``header`` contains the origin of the weights.

    Args:
        source: the file's path, or its bytes.

    Raises:
        Error: V304 if it is not a weight file, or if its tensors are not those of the policy that its header
            names; others if it cannot be read.
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
    network: str | os.PathLike[str] | Network | None = None,
    settings: Mapping[str, Any] | None = None,
    seed: int | None = None,
    steps: int | None = None,
) -> None:
    """Writes a weight file, completely or not at all.

    Arguments that are not given keep their values from the file that the weights were loaded from. Weights
    that come from no file need `network` and `steps`; without `settings` or `seed`, the new file marks these
    as unknown.

    Args:
        twin: the network of layers.
        path: path of the weight file.
        network: the network that the weights were trained on, its name or its path; for weights that fit any
            number of vertiports also "random" or "random-places:N", for a new network each day.
        settings: the settings of the training run, with the members of ``vertifleet.settings("paper")``; for
            policies that learn by imitation, with those in the header of the shipped weights of ``gcaps-x``.
        seed: seed of the training run.
        steps: number of decisions learned from.

    Raises:
        Error: V304 if a weight is not finite, V302 and V303 if there is no such setting or it is out of its
            bounds, V102 if the file cannot be written, V451 if the arguments do not fit.
    """
    said = _arguments_text(twin, _world(twin, network), settings, seed, steps)
    fresh = {member: value for member, value in said.items() if value is not None}
    header = _new_header(twin, said) if twin.header is None else twin.header | fresh
    _write(twin, path, header)


def save_trained(
    twin: Twin,
    path: str | os.PathLike[str],
    network: Network,
    settings: Mapping[str, Any] | None,
    seed: int | None,
    steps: int,
) -> None:
    """Like :func:`save`, for newly trained weights: the header of an earlier file is dropped."""
    _write(twin, path, _new_header(twin, _arguments_text(twin, network, settings, seed, steps)))


def _write(twin: Twin, path: str | os.PathLike[str], header: Mapping[str, Any]) -> None:
    tensors = {name: tensor.detach().float().cpu().contiguous() for name, tensor in twin.state_dict().items()}
    file = safetensors.torch.save(tensors, metadata={"vertifleet": json.dumps(header)})
    Model.from_bytes(file, os.fspath(path)).write(path)


def _of(header: Mapping[str, Any]) -> Twin:
    """The network that a checked header describes, without memory for its weights yet."""
    sizes = {name: size for name, size in header["policy"].items() if name != "kind"}
    vertiports = header["shape"]["vertiports"]
    with torch.device("meta"):
        match header["policy"]["kind"]:
            case "gcaps":
                return Gcaps(vertiports, **sizes)
            case "gcaps-x":
                return GcapsX(**sizes)
            case "gcaps-full":
                return GcapsFull(**sizes)
            case "mlp":
                return Mlp(vertiports, **sizes)
            case "mlp-full":
                return MlpFull(vertiports, **sizes)
            case kind:
                raise Error("V451", f"{kind} has no network in PyTorch; decide with vertifleet")


def _world(twin: Twin, network: str | os.PathLike[str] | Network | None) -> Network | str | None:
    """The network that weights were trained on, or the name of the source of random ones."""
    if isinstance(network, str) and DRAWN.fullmatch(network) and twin.vertiports is None:
        return network
    return None if network is None else network_of(network)


def _arguments_text(
    twin: Twin,
    network: Network | str | None,
    settings: Mapping[str, Any] | None,
    seed: int | None,
    steps: int | None,
) -> dict[str, Any]:
    """The members of a header that follow from the arguments of `save`; None for those not given."""
    said: dict[str, Any] = {
        "network": network.name if isinstance(network, Network) else network,
        "settings": None if settings is None else _all_settings(twin, settings),
        "seed": None if seed is None else whole("seed", seed, MOST_SEED),
        "steps": None if steps is None else whole("steps", steps, MOST_STEPS),
    }
    if any(value is not None for value in said.values()):
        said["commit"] = f"python {version('vertifleet')}"
    if network is not None:
        said["feature_scales"] = _scales(twin, network) if isinstance(network, Network) else None
    return said


def _all_settings(twin: Twin, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Checked settings without defaults; settings of imitation are checked when they are written."""
    if twin.kind not in OF_THE_PAPER:
        return dict(settings)
    checked = checked_settings(settings)
    missing = [name for name in checked if name not in settings]
    if missing:
        raise Error(
            "V451", f"settings lack {', '.join(missing)}: a weight file says all of them, or settings=None"
        )
    return checked


def _scales(twin: Twin, network: Network) -> dict[str, float] | None:
    """The scales of the network's features, if the weights fit it; None for features without scales."""
    if twin.vertiports is None:
        return None
    if len(network.vertiports) != twin.vertiports:
        found = len(network.vertiports)
        rule = f"the weights are for {twin.vertiports} vertiports, but network {network.name!r} has {found}"
        raise Error("V451", rule)
    return network.feature_scales if twin.kind in OF_THE_PAPER else None


def _new_header(twin: Twin, said: dict[str, Any]) -> dict[str, Any]:
    """The header of weights that come from no file."""
    if said["network"] is None or said["steps"] is None:
        raise Error("V451", f"weights of {twin.kind} that come from no file are saved with network and steps")
    return {"format": FORMAT, "policy": twin.policy, "shape": twin.shape} | said

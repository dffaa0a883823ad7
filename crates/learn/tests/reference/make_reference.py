"""Writes gcaps.json and mlp.json: outputs and gradients of the networks in PyTorch, in double precision.

This is an independent form of the networks: Eq. 18-21 to the letter, with the explicit Laplacian and its square, keys
and values for all nodes, PyTorch's own layer normalisation and derivatives. Weights and inputs come from a formula on
whole numbers that ../nn_reference.rs repeats, so only results are stored.

    python3 -m venv venv && venv/bin/pip install torch numpy
    venv/bin/python make_reference.py
"""

import json
import math
from pathlib import Path

import numpy as np
import torch
from torch.nn.functional import layer_norm, relu

WHOLE = np.uint64(0xFFFFFFFF)


def noise(name: str, shape: tuple[int, ...]) -> np.ndarray:
    """Numbers in [-1, 1), exact in single precision, that follow from a name and their index."""
    start = 2166136261
    for byte in name.encode():
        start = (start ^ byte) * 16777619 & 0xFFFFFFFF
    x = (np.arange(math.prod(shape), dtype=np.uint64) + np.uint64(start)) & WHOLE
    x = x * np.uint64(2654435761) & WHOLE
    x ^= x >> np.uint64(15)
    x = x * np.uint64(2246822519) & WHOLE
    x ^= x >> np.uint64(13)
    return ((x >> np.uint64(8)).astype(np.float32) / np.float32(2**23) - np.float32(1)).reshape(shape)


def weight(name: str, shape: tuple[int, ...]) -> torch.Tensor:
    if len(shape) == 2:
        reach = np.sqrt(np.float32(2) / np.float32(shape[0]))
        value = reach * noise(name, shape)
    elif name.endswith(".scale"):
        value = np.float32(1) + np.float32(0.25) * noise(name, shape)
    else:
        value = np.float32(0.25) * noise(name, shape)
    return torch.tensor(value.astype(np.float64), requires_grad=True)


def gcaps(sizes: dict, w: dict, nodes, aircraft, clock):
    n, h, heads = sizes["vertiports"], sizes["width"], sizes["heads"]
    adjacency = torch.ones(n, n, dtype=torch.float64) - torch.eye(n, dtype=torch.float64)
    laplacian = torch.diag(adjacency.sum(1)) - adjacency
    powers = [torch.eye(n, dtype=torch.float64), laplacian, laplacian @ laplacian]
    f0 = nodes @ w["encoder.node.weight"] + w["encoder.node.bias"]
    capsules = []
    for p in (1, 2):
        f = f0 if p == 1 else f0 * f0
        # The networks store V_pa, and W_pa = V_pa / N^a.
        terms = [powers[a] @ f @ (w[f"encoder.moment_{p}.hop_{a}.weight"] / n**a) for a in (0, 1, 2)]
        capsules.append(relu(terms[0] + terms[1] + terms[2]))
    f1 = torch.cat(capsules, dim=-1)
    e = f1 @ w["encoder.feed_forward.weight"] + w["encoder.feed_forward.bias"]

    q = aircraft @ w["decoder.query.weight"] + w["decoder.query.bias"]
    keys, values = e @ w["decoder.key.weight"], e @ w["decoder.value.weight"]
    d = h // heads
    concatenated = []
    for head in range(heads):
        part = slice(head * d, (head + 1) * d)
        scores = torch.einsum("bd,bnd->bn", q[:, part], keys[:, :, part]) / math.sqrt(d)
        concatenated.append(torch.einsum("bn,bnd->bd", torch.softmax(scores, -1), values[:, :, part]))
    attended = torch.cat(concatenated, dim=-1) @ w["decoder.output.weight"]
    z = layer_norm(q + attended, (h,), w["decoder.norm_1.scale"], w["decoder.norm_1.shift"], 1e-5)
    lifted = relu(z @ w["decoder.feed_forward.weight"] + w["decoder.feed_forward.bias"])
    y = layer_norm(z + lifted, (h,), w["decoder.norm_2.scale"], w["decoder.norm_2.shift"], 1e-5)
    logits = torch.einsum("bh,bnh->bn", y @ w["decoder.pointer.weight"], e) / math.sqrt(h)

    seen = torch.cat([e.mean(1), y, clock[:, None]], dim=-1)
    hidden = torch.cat([w["value.means.weight"], w["value.hidden.weight"]])
    hidden = relu(seen @ hidden + w["value.hidden.bias"])
    return logits, hidden @ w["value.output.weight"] + w["value.output.bias"][0]


def mlp(sizes: dict, w: dict, nodes, aircraft, clock):
    x = torch.cat([nodes.flatten(1), aircraft], dim=-1)
    for layer in range(1, sizes["layers"] + 1):
        x = relu(x @ w[f"trunk.{layer}.weight"] + w[f"trunk.{layer}.bias"])
    logits = x @ w["logits.weight"] + w["logits.bias"]
    seen = torch.cat([x, clock[:, None]], dim=-1)
    hidden = relu(seen @ w["value.hidden.weight"] + w["value.hidden.bias"])
    return logits, hidden @ w["value.output.weight"] + w["value.output.bias"][0]


def gcaps_shapes(sizes: dict) -> dict[str, tuple[int, ...]]:
    n, h = sizes["vertiports"], sizes["width"]
    shapes = {f"encoder.moment_{p}.hop_{a}.weight": (h, h) for p in (1, 2) for a in (0, 1, 2)}
    shapes |= {
        "encoder.node.weight": (2 * n + 4, h),
        "encoder.node.bias": (h,),
        "encoder.feed_forward.weight": (2 * h, h),
        "encoder.feed_forward.bias": (h,),
        "decoder.query.weight": (2 * n + 2, h),
        "decoder.query.bias": (h,),
        "decoder.key.weight": (h, h),
        "decoder.value.weight": (h, h),
        "decoder.output.weight": (h, h),
        "decoder.norm_1.scale": (h,),
        "decoder.norm_1.shift": (h,),
        "decoder.feed_forward.weight": (h, h),
        "decoder.feed_forward.bias": (h,),
        "decoder.norm_2.scale": (h,),
        "decoder.norm_2.shift": (h,),
        "decoder.pointer.weight": (h, h),
        "value.means.weight": (h, h),
        "value.hidden.weight": (h + 1, h),
        "value.hidden.bias": (h,),
        "value.output.weight": (h,),
        "value.output.bias": (1,),
    }
    return shapes


def mlp_shapes(sizes: dict) -> dict[str, tuple[int, ...]]:
    n, width, value_width = sizes["vertiports"], sizes["width"], sizes["value_width"]
    shapes, inputs = {}, n * (2 * n + 4) + 2 * n + 2
    for layer in range(1, sizes["layers"] + 1):
        shapes |= {f"trunk.{layer}.weight": (inputs, width), f"trunk.{layer}.bias": (width,)}
        inputs = width
    return shapes | {
        "logits.weight": (width, n),
        "logits.bias": (n,),
        "value.hidden.weight": (width + 1, value_width),
        "value.hidden.bias": (value_width,),
        "value.output.weight": (value_width,),
        "value.output.bias": (1,),
    }


def case(network, shapes: dict, sizes: dict, batch: int, every_slope: bool) -> dict:
    n = sizes["vertiports"]
    weights = {name: weight(name, shape) for name, shape in shapes.items()}

    def constant(name, *shape):
        return torch.tensor(noise(name, shape).astype(np.float64))

    nodes, aircraft = constant("nodes", batch, n, 2 * n + 4), constant("aircraft", batch, 2 * n + 2)
    open_ = (constant("mask", batch, n) > -0.4) | (torch.arange(n)[None] == torch.arange(batch)[:, None] % n)
    logits, values = network(sizes, weights, nodes, aircraft, constant("clock", batch))
    of_logits = (constant("logit_slopes", batch, n) * logits)[open_].sum()
    (of_logits + (constant("value_slopes", batch) * values).sum()).backward()

    def summary(name: str, slope: torch.Tensor) -> dict:
        if every_slope:
            return {"all": [digits(x) for x in slope.flatten().tolist()]}
        projection = torch.tensor(noise(f"{name} projection", tuple(slope.shape)).astype(np.float64))
        return {
            "norm": digits(slope.norm().item()),
            "projection": digits((slope * projection).sum().item()),
            "first": [digits(x) for x in slope.flatten()[:6].tolist()],
        }

    return {
        "sizes": sizes,
        "batch": batch,
        "logits": [digits(x) if o else None for x, o in zip(logits.flatten().tolist(), open_.flatten().tolist())],
        "values": [digits(x) for x in values.tolist()],
        "slopes": {name: summary(name, tensor.grad) for name, tensor in weights.items()},
    }


def digits(x: float) -> float:
    return float(f"{x:.8g}")


def main() -> None:
    here = Path(__file__).parent
    small, full = {"vertiports": 5, "width": 16, "heads": 4}, {"vertiports": 8, "width": 256, "heads": 8}
    cases = [case(gcaps, gcaps_shapes(small), small, 3, True), case(gcaps, gcaps_shapes(full), full, 7, False)]
    (here / "gcaps.json").write_text(json.dumps(cases) + "\n")
    small = {"vertiports": 5, "width": 16, "layers": 2, "value_width": 8}
    full = {"vertiports": 8, "width": 800, "layers": 2, "value_width": 256}
    cases = [case(mlp, mlp_shapes(small), small, 3, True), case(mlp, mlp_shapes(full), full, 7, False)]
    (here / "mlp.json").write_text(json.dumps(cases) + "\n")


main()

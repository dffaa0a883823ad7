"""Writes gcaps.json, mlp.json and graphs.json: outputs and gradients of the networks in PyTorch, in double precision.

This is an independent form of the networks: Eq. 18-21 to the letter, with the explicit Laplacian and its powers, keys
and values for all nodes, PyTorch's own layer normalisation and derivatives. Weights and inputs come from a formula on
whole numbers that ../nn_reference.rs repeats, so only results are stored. python/tests/frameworks/test_graphs.py
compares the modules of the Python package with the same results.

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
FULL_FEATURES = 37, 11
"""F and G of gcaps-full."""
PAPER = {"encoder": "capsules", "moments": 2, "hops": 2, "layers": 1}
PAPER |= {"adjacency": "complete", "laplacian": "plain", "attention": True}
GRAPHS = [
    {"moments": 1, "hops": 1, "laplacian": "normalised"},
    {"hops": 0},
    {"moments": 3, "hops": 3},
    {"adjacency": "similarity", "layers": 2},
    {"adjacency": "similarity", "laplacian": "normalised", "attention": False},
    {"adjacency": "distance", "laplacian": "normalised"},
    {"adjacency": "reachable", "layers": 3, "moments": 1},
    {"adjacency": "profit", "laplacian": "normalised", "moments": 4, "hops": 4},
    {"adjacency": "profit", "attention": False},
    {"encoder": "transformer", "layers": 2},
    {"encoder": "transformer", "attention": False},
    {"attention": False},
]
"""What is changed of the paper's graph in each case of graphs.json."""


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
    return decoded(sizes, w, e, query(w, aircraft), clock)


def query(w: dict, aircraft):
    return aircraft @ w["decoder.query.weight"] + w["decoder.query.bias"]


def decoded(sizes: dict, w: dict, e, q, clock, attention: bool = True):
    """Logits and values from embeddings; without attention, every head has the same weight for all of them."""
    n, h, heads = sizes["vertiports"], sizes["width"], sizes["heads"]
    keys, values = e @ w["decoder.key.weight"], e @ w["decoder.value.weight"]
    d = h // heads
    concatenated = []
    for head in range(heads):
        part = slice(head * d, (head + 1) * d)
        scores = torch.einsum("bd,bnd->bn", q[:, part], keys[:, :, part]) / math.sqrt(d)
        weights = torch.softmax(scores, -1) if attention else torch.full_like(scores, 1 / n)
        concatenated.append(torch.einsum("bn,bnd->bd", weights, values[:, :, part]))
    attended = torch.cat(concatenated, dim=-1) @ w["decoder.output.weight"]
    z = layer_norm(q + attended, (h,), w["decoder.norm_1.scale"], w["decoder.norm_1.shift"], 1e-5)
    lifted = relu(z @ w["decoder.feed_forward.weight"] + w["decoder.feed_forward.bias"])
    y = layer_norm(z + lifted, (h,), w["decoder.norm_2.scale"], w["decoder.norm_2.shift"], 1e-5)
    logits = torch.einsum("bh,bnh->bn", y @ w["decoder.pointer.weight"], e) / math.sqrt(h)

    seen = torch.cat([e.mean(1), y, clock[:, None]], dim=-1)
    hidden = torch.cat([w["value.means.weight"], w["value.hidden.weight"]])
    hidden = relu(seen @ hidden + w["value.hidden.bias"])
    return logits, hidden @ w["value.output.weight"] + w["value.output.bias"][0]


def graph_gcaps(sizes: dict, w: dict, nodes, aircraft, clock, edges):
    """GCAPS with any graph, or with self-attention in place of graph capsules."""
    graph = sizes["graph"]
    f = nodes @ w["encoder.node.weight"] + w["encoder.node.bias"]
    if graph["encoder"] == "transformer":
        for layer in range(1, graph["layers"] + 1):
            f = self_attention(sizes, w, f"encoder.layer_{layer}", f)
    else:
        powers = laplacian_powers(sizes, nodes, edges)
        for layer in range(1, graph["layers"] + 1):
            name = "encoder" if layer == 1 else f"encoder.layer_{layer}"
            if layer > 1:
                f = f @ w[f"{name}.input.weight"] + w[f"{name}.input.bias"]
            capsules = []
            for p in range(1, graph["moments"] + 1):
                hops = [w[f"{name}.moment_{p}.hop_{a}.weight"] for a in range(graph["hops"] + 1)]
                capsules.append(relu(sum(power @ f**p @ hop for power, hop in zip(powers, hops))))
            f = torch.cat(capsules, dim=-1)
    e = f @ w["encoder.feed_forward.weight"] + w["encoder.feed_forward.bias"]
    return decoded(sizes, w, e, query(w, aircraft), clock, graph["attention"])


def laplacian_powers(sizes: dict, nodes, edges) -> list:
    """L^0, ..., L^K of every decision, [B, N, N] each."""
    n, graph = sizes["vertiports"], sizes["graph"]
    identity = torch.eye(n, dtype=torch.float64)
    weights = {"complete": torch.ones(len(nodes), n, n, dtype=torch.float64)}
    weights["similarity"] = 1 / (1 + torch.cdist(nodes, nodes))
    adjacency = weights.get(graph["adjacency"], edges) * (1 - identity)
    degrees = adjacency.sum(-1)
    if graph["laplacian"] == "plain":
        laplacian = (torch.diag_embed(degrees) - adjacency) / n
    else:
        inverse = torch.where(degrees > 0, 1 / degrees, 0.0)
        # A vertiport without neighbours has a row of zeros.
        laplacian = identity * (degrees > 0).double()[:, :, None] - torch.diag_embed(inverse) @ adjacency
    powers = [identity.expand(len(nodes), n, n)]
    for _ in range(graph["hops"]):
        powers.append(powers[-1] @ laplacian)
    return powers


def self_attention(sizes: dict, w: dict, name: str, f):
    """One layer of self-attention (Vaswani et al., 2017)."""
    h, d = sizes["width"], sizes["width"] // sizes["heads"]
    queries, keys, values = (f @ w[f"{name}.{read}.weight"] for read in ("query", "key", "value"))
    collected = []
    for head in range(sizes["heads"]):
        part = slice(head * d, (head + 1) * d)
        scores = queries[:, :, part] @ keys[:, :, part].transpose(1, 2) / math.sqrt(d)
        collected.append(torch.softmax(scores, -1) @ values[:, :, part])
    added = f + torch.cat(collected, dim=-1) @ w[f"{name}.output.weight"]
    middle = layer_norm(added, (h,), w[f"{name}.norm_1.scale"], w[f"{name}.norm_1.shift"], 1e-5)
    lifted = relu(middle @ w[f"{name}.lift.weight"] + w[f"{name}.lift.bias"])
    added = middle + lifted @ w[f"{name}.lower.weight"] + w[f"{name}.lower.bias"]
    return layer_norm(added, (h,), w[f"{name}.norm_2.scale"], w[f"{name}.norm_2.shift"], 1e-5)


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
    return shapes | other_shapes(h, 2 * h, 2 * n + 4, 2 * n + 2)


def graph_shapes(sizes: dict) -> dict[str, tuple[int, ...]]:
    h, graph = sizes["width"], sizes["graph"]
    shapes: dict[str, tuple[int, ...]] = {}
    layers = range(1, graph["layers"] + 1)
    if graph["encoder"] == "transformer":
        for name in (f"encoder.layer_{layer}" for layer in layers):
            shapes |= {f"{name}.{read}.weight": (h, h) for read in ("query", "key", "value", "output")}
            shapes |= {f"{name}.norm_{which}.{part}": (h,) for which in (1, 2) for part in ("scale", "shift")}
            shapes |= {f"{name}.lift.weight": (h, 2 * h), f"{name}.lift.bias": (2 * h,)}
            shapes |= {f"{name}.lower.weight": (2 * h, h), f"{name}.lower.bias": (h,)}
        return shapes | other_shapes(h, h, *FULL_FEATURES)
    capsule = graph["moments"] * h
    for name in ("encoder" if layer == 1 else f"encoder.layer_{layer}" for layer in layers):
        if name != "encoder":
            shapes |= {f"{name}.input.weight": (capsule, h), f"{name}.input.bias": (h,)}
        for p in range(1, graph["moments"] + 1):
            shapes |= {f"{name}.moment_{p}.hop_{a}.weight": (h, h) for a in range(graph["hops"] + 1)}
    return shapes | other_shapes(h, capsule, *FULL_FEATURES)


def other_shapes(h: int, capsule: int, node_features: int, aircraft_features: int) -> dict[str, tuple[int, ...]]:
    """The shapes of what all encoders have, and of the decoder and the value head."""
    return {
        "encoder.node.weight": (node_features, h),
        "encoder.node.bias": (h,),
        "encoder.feed_forward.weight": (capsule, h),
        "encoder.feed_forward.bias": (h,),
        "decoder.query.weight": (aircraft_features, h),
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
    n, has_graph = sizes["vertiports"], "graph" in sizes
    node_features, aircraft_features = FULL_FEATURES if has_graph else (2 * n + 4, 2 * n + 2)
    weights = {name: weight(name, shape) for name, shape in shapes.items()}

    def constant(name, *shape):
        return torch.tensor(noise(name, shape).astype(np.float64))

    nodes, aircraft = constant("nodes", batch, n, node_features), constant("aircraft", batch, aircraft_features)
    seen = [nodes, aircraft, constant("clock", batch)]
    if has_graph:
        # Half of the edges have no weight, and one vertiport has no neighbours.
        edges = constant("edges", batch, n, n).clamp(min=0)
        edges[:, 0] = 0
        seen += [edges]
    open_ = (constant("mask", batch, n) > -0.4) | (torch.arange(n)[None] == torch.arange(batch)[:, None] % n)
    logits, values = network(sizes, weights, *seen)
    of_logits = (constant("logit_slopes", batch, n) * logits)[open_].sum()
    (of_logits + (constant("value_slopes", batch) * values).sum()).backward()

    def summary(name: str, slope: torch.Tensor | None) -> dict:
        if slope is None:
            return {"norm": 0.0}
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
    sizes = [{"vertiports": 5, "width": 8, "heads": 2, "graph": PAPER | change} for change in GRAPHS]
    cases = [case(graph_gcaps, graph_shapes(one), one, 3, False) for one in sizes]
    (here / "graphs.json").write_text(json.dumps(cases) + "\n")


if __name__ == "__main__":
    main()

"""The gcaps update against PyTorch: gradient steps per second on two threads, ours and PyTorch's in turn.

PyTorch runs eagerly and is given the same algebra (what follows from the complete graph, products of weights taken
once per step, keys and values on the query's side), its fused Adam, and micro-batches of 1,024 decisions.

    python3 -m venv venv && venv/bin/pip install torch numpy
    venv/bin/python benches/pytorch_update.py
"""

import argparse
import math
import os
import statistics
import subprocess
import time
from pathlib import Path

import torch
from torch.nn.functional import layer_norm, relu

N, H, HEADS = 8, 256, 8
MICRO = 1024
ROOT = Path(__file__).resolve().parent.parent


def first_weights() -> dict[str, torch.Tensor]:
    shapes = {f"hop_{p}{a}": (H, H) for p in (1, 2) for a in (0, 1, 2)} | {
        "node": (2 * N + 4, H),
        "node_bias": (H,),
        "embed": (2 * H, H),
        "embed_bias": (H,),
        "query": (2 * N + 2, H),
        "query_bias": (H,),
        "key": (H, H),
        "value": (H, H),
        "output": (H, H),
        "scale_1": (H,),
        "shift_1": (H,),
        "lift": (H, H),
        "lift_bias": (H,),
        "scale_2": (H,),
        "shift_2": (H,),
        "pointer": (H, H),
        "means": (H, H),
        "hidden": (H, H),
        "clock": (H,),
        "hidden_bias": (H,),
        "out": (H,),
        "out_bias": (1,),
    }
    generator = torch.Generator().manual_seed(1)
    return {
        name: (torch.randn(shape, generator=generator) / math.sqrt(shape[0])).requires_grad_()
        for name, shape in shapes.items()
    }


def take_products(w: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """Products of weights that the passes work with in the weights' place."""
    outer_1, outer_2 = w["hop_11"] + w["hop_12"], w["hop_21"] + w["hop_22"]
    return {
        "first_node": w["node"] @ (w["hop_10"] + outer_1),
        "first_mean": w["node"] @ outer_1,
        "first_shift": w["node_bias"] @ w["hop_10"],
        "second_node": w["hop_20"] + outer_2,
        "second_mean": outer_2,
        # One matrix per head, [heads x d x 2h] and [heads x 2h x d].
        "key": (w["embed"] @ w["key"]).T.reshape(HEADS, H // HEADS, 2 * H),
        "value": (w["embed"] @ w["value"]).T.reshape(HEADS, H // HEADS, 2 * H).transpose(1, 2),
        "value_shift": w["embed_bias"] @ w["value"],
        "pointer": w["pointer"] @ w["embed"].T,
        "pointer_shift": w["pointer"] @ w["embed_bias"],
        "means": w["embed"] @ w["means"],
        "hidden_shift": w["hidden_bias"] + w["embed_bias"] @ w["means"],
    }


def forward(w, m, nodes, aircraft, mask, clock):
    """Logits and values; `m` are the products."""
    batch = nodes.shape[0]
    flat = nodes.reshape(batch * N, -1)
    embeddings = torch.addmm(w["node_bias"], flat, w["node"])
    squares = embeddings * embeddings
    shift_1 = m["first_shift"] - nodes.mean(1) @ m["first_mean"]
    shift_2 = squares.view(batch, N, H).mean(1) @ m["second_mean"]
    f_1 = (flat @ m["first_node"]).view(batch, N, H) + shift_1[:, None]
    f_2 = (squares @ m["second_node"]).view(batch, N, H) - shift_2[:, None]
    capsules = relu(torch.cat([f_1, f_2], dim=-1))

    query = torch.addmm(w["query_bias"], aircraft, w["query"])
    of_heads = query.view(batch, HEADS, H // HEADS).transpose(0, 1)
    queries = torch.bmm(of_heads, m["key"]).transpose(0, 1)
    attention = torch.softmax(torch.bmm(queries, capsules.transpose(1, 2)) / math.sqrt(H // HEADS), -1)
    collected = torch.bmm(attention, capsules)
    heads = torch.bmm(collected.transpose(0, 1), m["value"]).transpose(0, 1).reshape(batch, H)
    attended = query + (heads + m["value_shift"]) @ w["output"]
    z = layer_norm(attended, (H,), w["scale_1"], w["shift_1"], 1e-5)
    lifted = relu(torch.addmm(w["lift_bias"], z, w["lift"]))
    y = layer_norm(z + lifted, (H,), w["scale_2"], w["shift_2"], 1e-5)
    logits = torch.bmm(capsules, (y @ m["pointer"])[:, :, None])[:, :, 0] + (y @ m["pointer_shift"])[:, None]
    logits = (logits / math.sqrt(H)).masked_fill(~mask, -math.inf)
    hidden = capsules.mean(1) @ m["means"] + y @ w["hidden"] + clock[:, None] * w["clock"] + m["hidden_shift"]
    return logits, relu(hidden) @ w["out"] + w["out_bias"]


def pytorch_rate(step: int, seconds: float) -> float:
    """Decisions learned from per second."""
    weights = first_weights()
    adam = torch.optim.Adam(weights.values(), lr=1e-6, eps=1e-5, fused=True)
    generator = torch.Generator().manual_seed(2)
    nodes = torch.rand(step, N, 2 * N + 4, generator=generator)
    aircraft = torch.rand(step, 2 * N + 2, generator=generator)
    clock = torch.rand(step, generator=generator)
    mask = (torch.arange(step * N) % 5 != 3).view(step, N)
    of_logits = (torch.rand(step, N, generator=generator) - 0.5) / step * mask
    of_values = (torch.rand(step, generator=generator) - 0.5) / step

    def one_step():
        adam.zero_grad(set_to_none=True)
        products = take_products(weights)
        leaves = {name: product.detach().requires_grad_() for name, product in products.items()}
        for first in range(0, step, MICRO):
            part = slice(first, first + MICRO)
            answers = forward(weights, leaves, nodes[part], aircraft[part], mask[part], clock[part])
            # The slopes that a loss would give, so that no loss is timed on either side.
            torch.autograd.backward(answers, (of_logits[part], of_values[part]))
        torch.autograd.backward(list(products.values()), [leaf.grad for leaf in leaves.values()])
        adam.step()

    one_step()
    start, steps = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        one_step()
        steps += 1
    return steps * step / (time.perf_counter() - start)


def our_rate(step: int, seconds: int, threads: int) -> float:
    program = ROOT / "target/release/examples/update_speed"
    environment = os.environ | {"RAYON_NUM_THREADS": str(threads)}
    arguments = [str(program), str(step), "128", str(seconds)]
    done = subprocess.run(arguments, env=environment, capture_output=True, text=True, check=True)
    return float(done.stdout)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--seconds", type=int, default=4, help="of each program in each round")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--steps", type=int, nargs="+", default=[1024, 10_000], help="decisions per gradient step")
    wanted = parser.parse_args()
    build = ["cargo", "build", "--release", "--locked", "-p", "vertifleet-learn", "--example", "update_speed"]
    subprocess.run(build, cwd=ROOT, check=True)
    torch.set_num_threads(wanted.threads)
    print(f"PyTorch {torch.__version__}, {wanted.threads} threads, micro-batches of {MICRO}")
    for step in wanted.steps:
        rounds = [
            (our_rate(step, wanted.seconds, wanted.threads), pytorch_rate(step, wanted.seconds))
            for _ in range(wanted.rounds)
        ]
        ours, theirs = (statistics.median(column) for column in zip(*rounds))
        ratios = sorted(our / their for our, their in rounds)
        print(
            f"step of {step}: ours {ours:.0f}/s, PyTorch {theirs:.0f}/s; "
            f"ratio median {statistics.median(ratios):.2f}, lowest {ratios[0]:.2f}, highest {ratios[-1]:.2f}"
        )


if __name__ == "__main__":
    main()

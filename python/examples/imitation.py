"""Learns `gcaps-full` in PyTorch, on a GPU if there is one, from the samples of a run by imitation.

`vertifleet train --policy gcaps-full --out runs` plays days, rolls their decisions out, and stores all
samples in its checkpoint. This script makes passes over them with a network of any size and graph, with the
loss and the steps of the program. It writes weights that the program decides by. It needs PyTorch:

    python imitation.py runs/gcaps-full-checkpoint.safetensors --set width=128 --out mine.safetensors
    vertifleet evaluate --policies gcaps-full --suite paper-100 --model gcaps-full=mine.safetensors

A graph whose edges are observed (`--set adjacency=profit`) needs samples of a run with the same adjacency.
After every pass it writes the weights, and next to them a checkpoint for the same call with `--resume`.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import torch
from safetensors import safe_open
from torch import Tensor, nn

from vertifleet import Error
from vertifleet.torch import GcapsFull, Graph, save, scores

LOGITS_A_UNIT = 20.0
"""The values of roll-outs are counted in typical full flights; one of these is worth this many logits."""
SEEING_THE_SAME = ("gcaps-full", "mlp-full")
"""The policies whose samples contain the observation of `gcaps-full`."""
MOST_NORM = 0.5
"""The gradient of a step is cut to this norm."""


class Samples:
    """The samples of days with one number of vertiports: observations, and values of choices."""

    def __init__(self, file: Any, vertiports: int, twin: GcapsFull, device: str) -> None:
        def part(name: str, *shape: int) -> Tensor:
            numbers: Tensor = file.get_tensor(f"lessons.{vertiports}.{name}")
            return numbers.view(-1, *shape).to(device)

        self.priced, self.values = part("priced", vertiports), part("values", vertiports)
        nodes, aircraft = (
            part("nodes", vertiports, twin.node_features),
            part("aircraft", twin.aircraft_features),
        )
        mask = (nodes[..., 0] == 1).float()
        self.seen = {"full_nodes": nodes, "full_aircraft": aircraft, "action_mask": mask}
        # Only the value reads the clock, and it is not learned.
        self.seen["clock"] = torch.zeros_like(aircraft[:, 0])
        if twin.edges:
            self.seen[twin.edges] = part("edges", vertiports, vertiports)

    def __len__(self) -> int:
        return len(self.values)


def loss_of(found: Tensor, values: Tensor, entropy_weight: float) -> Tensor:
    """-sum of p A - entropy_weight H(p) of every decision: [B] from scores and values by roll-outs [B, N].

    p is the softmax of the scores. Noise in the values A does not change the mean of this loss, and the loss
    weights a decision by the amount at stake in it.
    """
    log_p = found.log_softmax(-1)
    p = log_p.exp()
    entropy = -(p * log_p.masked_fill(found == -torch.inf, 0.0)).sum(-1)
    return -(p * LOGITS_A_UNIT * values).sum(-1) - entropy_weight * entropy


def steps_of(
    samples: dict[int, Samples], args: argparse.Namespace, number: int
) -> list[list[tuple[int, Tensor]]]:
    """The steps of a pass, with the chunks of each: rows of samples of one number of vertiports.

    The order follows from the seed and the number of the pass, so a pass after a stop has the same order.
    """
    random = torch.Generator().manual_seed(args.seed * 1_000_003 + number)
    chunks = []
    for vertiports, one in samples.items():
        rows = torch.randperm(len(one), generator=random)
        chunks += [(vertiports, part) for part in torch.split(rows, max(args.nodes // vertiports, 1))]
    order = torch.randperm(len(chunks), generator=random).tolist()
    shuffled = [chunks[at] for at in order]
    return [shuffled[at : at + args.chunks] for at in range(0, len(shuffled), args.chunks)]


def learn(
    twin: GcapsFull,
    optimizer: torch.optim.Optimizer,
    samples: dict[int, Samples],
    number: int,
    args: argparse.Namespace,
) -> tuple[float, float]:
    """Makes one pass.

    Returns agreement and lift as in the program's learning curve: the share of decisions for which the best
    choice is that of the roll-outs, and the advantage of the choices over those at the prices, in typical
    full flights. Each decision is measured before the step that learns from it.
    """
    steps, decisions = steps_of(samples, args, number), sum(len(one) for one in samples.values())
    device = next(twin.parameters()).device
    agreement, lift = torch.zeros((), device=device), torch.zeros((), device=device)
    for at, chunks in enumerate(steps):
        share = (number + at / len(steps)) / args.passes
        optimizer.param_groups[0]["lr"] = args.learning_rate * (1 - 0.9 * share)
        optimizer.zero_grad()
        in_step = sum(len(rows) for _, rows in chunks)
        for vertiports, rows in chunks:
            one, rows = samples[vertiports], rows.to(device)
            priced, values = one.priced[rows], one.values[rows]
            found = scores(twin, {name: entries[rows] for name, entries in one.seen.items()})
            torch.autograd.backward(loss_of(found, values, args.entropy_weight).sum() / in_step)
            shut = found == -torch.inf
            picks = (
                by.masked_fill(shut, -torch.inf).argmax(-1, keepdim=True) for by in (found, values, priced)
            )
            chosen, best, first = picks
            agreement += (chosen == best).sum()
            lift += (values.gather(1, chosen) - values.gather(1, first)).sum()
        nn.utils.clip_grad_norm_(twin.parameters(), MOST_NORM)
        optimizer.step()
    return agreement.item() / decisions, lift.item() / decisions


def network_of(changes: list[str]) -> GcapsFull:
    """The network with some of its settings changed, as with `vertifleet train --set`."""
    settings: dict[str, Any] = {}
    for change in changes:
        name, _, value = change.partition("=")
        settings[name] = int(value) if value.isdigit() else {"true": True, "false": False}.get(value, value)
    sizes = {name: settings.pop(name) for name in ("width", "heads") if name in settings}
    return GcapsFull(**sizes, graph=settings)


def write_whole(state: dict[str, Any], path: Path) -> None:
    """Writes a file completely or not at all."""
    unfinished = path.with_name(path.name + ".part")
    torch.save(state, unfinished)
    unfinished.replace(path)


def arguments() -> argparse.Namespace:
    """The arguments of the call."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("checkpoint", help="checkpoint of a run of gcaps-full or mlp-full")
    parser.add_argument("--out", type=Path, default=Path("gcaps-full.safetensors"), help="weight file")
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="width, heads, or of the graph"
    )
    parser.add_argument("--network", help="network that the weights are for; that of the run by default")
    parser.add_argument("--passes", type=int, default=48, help="passes over all samples")
    parser.add_argument("--until", type=int, help="stop after this many of them; --resume goes on")
    parser.add_argument(
        "--resume", action="store_true", help="go on where an earlier call stopped, if one did"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--learning-rate", type=float, default=1e-3, help="falls to a tenth over the passes")
    parser.add_argument("--entropy-weight", type=float, default=1.0)
    parser.add_argument("--nodes", type=int, default=1024, help="vertiports of all decisions of a chunk")
    parser.add_argument("--chunks", type=int, default=8, help="chunks of a step")
    parser.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    parser.add_argument("--threads", type=int, default=1, help="threads of PyTorch on a CPU")
    return parser.parse_args()


def main() -> None:
    """Learns, and writes weights after every pass."""
    args = arguments()
    torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    twin = network_of(args.set).to(args.device)
    with safe_open(args.checkpoint, framework="pt") as file:
        header = json.loads(file.metadata()["vertifleet"])
        run = header["run"]
        if run["policy"]["kind"] not in SEEING_THE_SAME:
            raise SystemExit(f"{args.checkpoint} is of {run['policy']['kind']}, not of {twin.kind}")
        of_run = Graph(**run["policy"].get("graph", {}))
        if twin.edges not in (None, of_run.edges):
            raise SystemExit(
                f"the samples show the edges of {of_run.adjacency}, not of {twin.graph.adjacency}"
            )
        samples = {
            count: Samples(file, count, twin, args.device) for count in header["progress"]["vertiports"]
        }
    decisions = sum(len(one) for one in samples.values())
    optimizer = torch.optim.Adam(twin.parameters(), lr=args.learning_rate, eps=1e-5)

    names = ("passes", "seed", "learning_rate", "entropy_weight", "nodes", "chunks")
    asked = {name: getattr(args, name) for name in names} | {"policy": twin.policy, "decisions": decisions}
    resumed_from, done = args.out.with_suffix(".state"), 0
    if args.resume and resumed_from.exists():
        state = torch.load(resumed_from, map_location=args.device, weights_only=True)
        if state["asked"] != asked:
            raise SystemExit(f"{resumed_from} is of another run, with {state['asked']}")
        twin.load_state_dict(state["twin"])
        optimizer.load_state_dict(state["optimizer"])
        done = state["done"]
    elif resumed_from.exists():
        raise SystemExit(f"{resumed_from} is of an earlier run: --resume goes on with it, or remove it")

    print(
        f"{decisions:,} samples on {args.device}, {sum(w.numel() for w in twin.parameters()):,} weights",
        flush=True,
    )
    for number in range(done, min(args.until or args.passes, args.passes)):
        begun = time.monotonic()
        agreement, lift = learn(twin, optimizer, samples, number, args)
        save(twin, args.out, network=args.network or run["network"], seed=args.seed, steps=decisions)
        state = {
            "asked": asked,
            "done": number + 1,
            "twin": twin.state_dict(),
            "optimizer": optimizer.state_dict(),
        }
        write_whole(state, resumed_from)
        seconds = time.monotonic() - begun
        print(
            f"pass {number + 1:>4}: agreement {agreement:.3f}, lift {lift:.4f}, {seconds:.1f} s", flush=True
        )


if __name__ == "__main__":
    try:
        main()
    except Error as error:
        raise SystemExit(f"{error}\n{error.hint or ''}".rstrip()) from error
    except KeyboardInterrupt:
        raise SystemExit("stopped: --resume goes on after the last pass that was finished") from None

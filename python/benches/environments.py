"""Environment steps per second: the native batch and single environments against plain Python, in turn.

A step is one decision of one aircraft: a random feasible action is drawn from the mask, the environment takes
it, and makes the next observation and mask. All of that is counted, and so is the start of a new day whenever
one ends; the native environments draw that day then, the plain one takes it from days drawn beforehand. A
call of a batch that begins the day after an ended one takes no decision there and does not count as a step.
The single native environment is the one that `gymnasium.make` returns, with its wrappers; the plain one has
none.

    python -m pip install ./python
    python python/benches/environments.py

With `--authors FOLDER`, a checkout of github.com/iamstevepaul/UAM_fleet_Scheduling, the environment of the
paper's authors too, played as their Feas_RND.py does; it needs torch, networkx and scipy.
"""

import argparse
import json
import os
import statistics
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from plain_python import PlainPythonEnv

import vertifleet

NETWORK = "paper"
SEED = 1
PLAIN = "plain Python"


class Player(Protocol):
    """Plays days with random feasible actions."""

    def step(self) -> int:
        """Takes the next decision, or one in each day of a batch; returns their number."""
        ...


class Batch:
    """Many days at once in one vector environment."""

    def __init__(self, environment: VectorEnv[Any, Any, Any]) -> None:
        self._environment = environment
        self._draws = np.random.default_rng(SEED)
        observation, _ = environment.reset(seed=SEED)
        self._mask = observation["action_mask"]
        self._starts_on_next_call = environment.metadata["autoreset_mode"] == AutoresetMode.NEXT_STEP
        self._to_start = 0

    def step(self) -> int:
        # Random numbers below 1, plus 1 for feasible choices: the largest is a feasible one, each
        # with the same probability.
        draws = self._draws.random(self._mask.shape, np.float32)
        observation, _, over, _, _ = self._environment.step((draws + self._mask).argmax(1))
        self._mask = observation["action_mask"]
        taken = len(over) - self._to_start
        self._to_start = int(over.sum()) if self._starts_on_next_call else 0
        return taken


class Single:
    """One day after the other."""

    def __init__(self, environment: gymnasium.Env[Any, Any]) -> None:
        self._environment = environment
        self._draws = np.random.default_rng(SEED)
        observation, _ = environment.reset(seed=SEED)
        self._mask = observation["action_mask"]

    def step(self) -> int:
        draws = self._draws.random(len(self._mask), np.float32)
        observation, _, over, _, _ = self._environment.step((draws + self._mask).argmax())
        if over:
            observation, _ = self._environment.reset()
        self._mask = observation["action_mask"]
        return 1


class Authors:
    """The environment of the paper's authors."""

    def __init__(self, folder: Path) -> None:
        from authors_environment import AuthorsEnvironment

        self._environment = AuthorsEnvironment(folder, SEED)

    def step(self) -> int:
        self._environment.step()
        return 1


def players(days: int, authors: Path | None) -> dict[str, Player]:
    """By name; the native ones on the paper's network."""
    network = vertifleet.Network(NETWORK)
    drawn = [json.loads(network.draw(seed).to_json()) for seed in range(1, 65)]

    def batch(observation: str, *, copy: bool) -> Batch:
        made = gymnasium.make_vec(
            f"vertifleet/Fleet-{observation}-v0",
            num_envs=days,
            vectorization_mode="vector_entry_point",
            network=NETWORK,
            copy=copy,
        )
        return Batch(made)

    found: dict[str, Player] = {
        f"native, {days} days, paper": batch("paper", copy=False),
        f"native, {days} days, paper, copied": batch("paper", copy=True),
        f"native, {days} days, full": batch("full", copy=False),
        f"native, {days} days, full, copied": batch("full", copy=True),
        "native, one day": Single(gymnasium.make("vertifleet/Fleet-v0", network=NETWORK)),
        PLAIN: Single(PlainPythonEnv(drawn)),
    }
    if authors:
        found["the authors' environment"] = Authors(authors)
    return found


def rate(player: Player, seconds: float) -> float:
    """Steps per second."""
    start, steps = time.perf_counter(), 0
    while (elapsed := time.perf_counter() - start) < seconds:
        steps += player.step()
    return steps / elapsed


def spread(figures: Sequence[float], form: str) -> str:
    """Median, lowest and highest."""
    middle = statistics.median(figures)
    return "".join(f"{figure:{form}}" for figure in (middle, min(figures), max(figures)))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--seconds", type=float, default=4, help="of each environment in each round")
    parser.add_argument("--days", type=int, default=256, help="days at once in the native batch")
    parser.add_argument("--threads", type=int, default=2, help="of the native batch")
    parser.add_argument("--authors", type=Path, metavar="FOLDER", help="checkout of the authors' repository")
    wanted = parser.parse_args()
    # Read when the batch first asks for threads.
    os.environ["RAYON_NUM_THREADS"] = str(wanted.threads)

    measured = players(wanted.days, wanted.authors)
    for player in measured.values():
        rate(player, 0.5)
    rates: dict[str, list[float]] = {name: [] for name in measured}
    for _ in range(wanted.rounds):
        for name, player in measured.items():
            rates[name].append(rate(player, wanted.seconds))

    print(f"{wanted.rounds} rounds of {wanted.seconds:g} s each, {wanted.threads} threads for the batch")
    print(f"{'':34}{'steps/s':>12}{'lowest':>12}{'highest':>12}{'x plain':>12}{'lowest':>12}{'highest':>12}")
    for name, found in rates.items():
        ratios = [ours / plain for ours, plain in zip(found, rates[PLAIN], strict=True)]
        print(f"{name:34}{spread(found, '12,.0f')}{spread(ratios, '#12.3g')}")


if __name__ == "__main__":
    main()

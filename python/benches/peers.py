"""Steps per second of this project's batch environment and of two routing libraries, measured in turn.

Their worlds differ (a vehicle that visits customers), so this compares a learner's waiting time, and not the
work done. Jumanji and RL4CO need other versions of their dependencies, so each has its own Python:

    python python/benches/peers.py --peer jumanji=JUMANJI/bin/python --peer rl4co=RL4CO/bin/python

A step is a decision of one of 256 parallel instances, with random feasible actions, in a loop in Python.
"jumanji CVRP in one call" has the loop compiled too, which a learner written in JAX can have.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

BATCH = 256
STEPS = 200


def ours() -> Callable[[], None]:
    import numpy as np

    from vertifleet.envs import FleetVectorEnv

    envs = FleetVectorEnv(BATCH, "paper", "dense", autoreset_mode="SameStep", observation="full", copy=False)
    choices = np.random.default_rng(1)
    _, info = envs.reset(seed=1)
    mask = info["action_mask"]

    def run() -> None:
        nonlocal mask
        for _ in range(STEPS):
            actions = (choices.random(mask.shape) * mask).argmax(1)
            mask = envs.step(actions)[4]["action_mask"]

    return run


def jumanji(in_one_call: bool = False) -> Callable[[], None]:
    import jax
    import jax.numpy as jnp
    import jumanji
    from jumanji.wrappers import AutoResetWrapper

    env = AutoResetWrapper(jumanji.make("CVRP-v1"))
    reset, step = jax.vmap(env.reset), jax.vmap(env.step)

    def one(state: Any, timestep: Any, key: Any) -> Any:
        scores = jax.random.uniform(key, timestep.observation.action_mask.shape)
        actions = jnp.where(timestep.observation.action_mask, scores, -1.0).argmax(-1)
        return step(state, actions)

    def many(state: Any, timestep: Any, keys: Any) -> Any:
        def body(carry: Any, key: Any) -> Any:
            state, timestep = carry
            return one(state, timestep, key), None

        return jax.lax.scan(body, (state, timestep), keys)[0]

    advance: Any = jax.jit(many) if in_one_call else jax.jit(one)
    state, timestep = jax.jit(reset)(jax.random.split(jax.random.PRNGKey(1), BATCH))
    keys = jax.random.split(jax.random.PRNGKey(2), STEPS)
    timestep = jax.block_until_ready(advance(state, timestep, keys if in_one_call else keys[0])[1])

    def run() -> None:
        nonlocal state, timestep
        if in_one_call:
            state, timestep = advance(state, timestep, keys)
        else:
            for key in keys:
                state, timestep = advance(state, timestep, key)
        jax.block_until_ready(timestep)

    return run


def rl4co() -> Callable[[], None]:
    import torch
    from rl4co.envs import CVRPEnv

    env = CVRPEnv(generator_params={"num_loc": 20})

    def run() -> None:
        state = env.reset(batch_size=[BATCH])
        for _ in range(STEPS):
            if bool(state["done"].all()):
                state = env.reset(batch_size=[BATCH])
            state["action"] = torch.multinomial(state["action_mask"].float(), 1).squeeze(1)
            state = env.step(state)["next"]

    return run


MEASURED: dict[str, tuple[str, Callable[[], Callable[[], None]]]] = {
    "vertifleet, full": ("vertifleet", ours),
    "jumanji CVRP": ("jumanji", jumanji),
    "jumanji CVRP in one call": ("jumanji", lambda: jumanji(in_one_call=True)),
    "rl4co CVRP": ("rl4co", rl4co),
}


def measure(name: str) -> float:
    """Steps a second of one library, in this process."""
    run = MEASURED[name][1]()
    run()
    begun = time.perf_counter()
    run()
    return BATCH * STEPS / (time.perf_counter() - begun)


def main() -> None:
    """Measures all by turns, each time in a new process."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--peer", action="append", default=[], help="NAME=PYTHON, jumanji or rl4co")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--measure", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.measure:
        print(measure(args.measure))
        return
    pythons = {"vertifleet": sys.executable} | dict(peer.split("=", 1) for peer in args.peer)
    rates: dict[str, list[float]] = {name: [] for name, (peer, _) in MEASURED.items() if peer in pythons}
    for _ in range(args.rounds):
        for name, found in rates.items():
            command = [pythons[MEASURED[name][0]], __file__, "--measure", name]
            found.append(float(subprocess.run(command, check=True, capture_output=True, text=True).stdout))
    for name, found in rates.items():
        spread = f"{min(found):,.0f} to {max(found):,.0f}"
        print(f"{name:28} {statistics.median(found):>12,.0f} steps/s  ({spread})")


if __name__ == "__main__":
    main()

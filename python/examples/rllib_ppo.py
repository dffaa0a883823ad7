"""Trains the paper's network with RLlib's PPO on all nodes of a Ray cluster, and saves a weight file.

Settings are the program's. A checkpoint is written beside the weight file after every iteration. The last
line says how to compare the result with other policies.

    python examples/rllib_ppo.py --preset default --steps 200000 --workers 2 --out mine.safetensors
"""

import argparse
import os
import time
from pathlib import Path

import ray

import vertifleet
from vertifleet.ray.rllib import export, ppo_config

NETWORK = "paper"


def file_to_write(given: str) -> Path:
    """The path of a file that will be written hours later, after a check that it can be written."""
    path = Path(given)
    if path.is_dir():
        raise argparse.ArgumentTypeError(f"{path}: cannot be written: it is a folder; name a file in it")
    if not path.absolute().parent.is_dir():
        raise argparse.ArgumentTypeError(f"{path}: cannot be written: make the folder {path.parent} first")
    if not os.access(path if path.exists() else path.absolute().parent, os.W_OK):
        raise argparse.ArgumentTypeError(f"{path}: cannot be written: it, or its folder, is not yours")
    return path


def main() -> None:
    """Trains, saves, and prints what to do next."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--preset", choices=["paper", "default"], default="paper", help="settings")
    parser.add_argument("--steps", type=int, help="decisions to learn from; those of the preset without")
    parser.add_argument(
        "--workers", type=int, default=0, help="processes that play days; 0 plays in this one"
    )
    parser.add_argument("--seed", type=int, default=1)
    out = "rllib-ppo.safetensors"
    parser.add_argument("--out", type=file_to_write, default=out, help="the weight file")
    wanted = parser.parse_args()

    settings = vertifleet.settings(wanted.preset)
    if wanted.steps is not None:
        settings["total_steps"] = wanted.steps
    ray.init()
    config = ppo_config(NETWORK, "gcaps", settings, env_runners=wanted.workers)
    algorithm = config.debugging(seed=wanted.seed).build_algo()
    checkpoint = wanted.out.absolute().with_suffix(".checkpoint")

    start, steps = time.perf_counter(), 0
    while steps < settings["total_steps"]:
        played = algorithm.train()["env_runners"]  # type: ignore[no-untyped-call]
        steps = int(played["num_env_steps_sampled_lifetime"])
        line = f"{steps:,} steps, {steps / (time.perf_counter() - start):,.0f} a second"
        if "episode_return_mean" in played:  # no day may have ended
            line += f", mean reward {played['episode_return_mean'] / settings['reward_scale']:.5f}"
        print(line, flush=True)
        algorithm.save_to_path(checkpoint)

    export(algorithm, wanted.out)
    algorithm.stop()  # type: ignore[no-untyped-call]
    model = f"--model mine={wanted.out}"
    print(f"vertifleet compare --network {NETWORK} --policies greedy,mine {model} --days 100 --seed 1")


if __name__ == "__main__":
    main()

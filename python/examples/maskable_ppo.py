"""Trains the paper's network with MaskablePPO and the paper's settings (Table 2), and saves a weight file.

The program can then compare it with other policies on unseen days; the last line of the output is the
command. Ctrl-C ends the training and saves the current weights. The learner, 12 MB, is saved after every
roll-out, in a folder next to the weight file: `MaskablePPO.load(path, env=days)` continues from there.

    python examples/maskable_ppo.py --steps 20000 --seed 1 --out mine.safetensors
"""

import argparse
import os
import time
from pathlib import Path

from sb3_contrib import MaskablePPO
from stable_baselines3.common.callbacks import CheckpointCallback

import vertifleet
from vertifleet.sb3 import FleetVecEnv, GcapsPolicy, export, ppo_settings

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
    """Trains, saves, and prints the next command."""
    settings = vertifleet.settings("paper")
    parser = argparse.ArgumentParser(description="Trains the paper's network with MaskablePPO.")
    parser.add_argument("--steps", type=int, default=settings["total_steps"], help="decisions to learn from")
    parser.add_argument("--seed", type=int, default=1)
    out = "maskable-ppo.safetensors"
    parser.add_argument("--out", type=file_to_write, default=out, help="the weight file")
    wanted = parser.parse_args()

    days = FleetVecEnv(NETWORK, settings["n_envs"], settings["reward"], settings["reward_scale"])
    model = MaskablePPO(GcapsPolicy, days, **ppo_settings(settings), seed=wanted.seed, verbose=1)
    often = CheckpointCallback(settings["n_steps"], str(wanted.out.with_suffix(".checkpoints")))
    start = time.perf_counter()
    try:
        model.learn(wanted.steps, callback=often)
    except KeyboardInterrupt:
        print("stopped")
    finally:
        export(model, wanted.out)
    seconds = time.perf_counter() - start
    print(f"{model.num_timesteps} steps in {seconds:.0f} s, {model.num_timesteps / seconds:.0f} steps/s")

    model_option = f"--model mine={wanted.out}"
    print(f"vertifleet compare --network {NETWORK} --policies greedy,mine {model_option} --days 100 --seed 1")


if __name__ == "__main__":
    main()

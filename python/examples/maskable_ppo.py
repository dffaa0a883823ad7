"""Trains the paper's network with MaskablePPO and the paper's settings (Table 2), and saves a weight file.

The program then compares it with the other policies on days that it has not seen; the last line says how.

    python examples/maskable_ppo.py --steps 20000 --seed 1 --out mine.safetensors
"""

import argparse
import time

from sb3_contrib import MaskablePPO

import vertifleet
from vertifleet.sb3 import FleetVecEnv, GcapsPolicy, export, ppo_settings

NETWORK = "paper"


def main() -> None:
    """Trains, saves, and says what to do next."""
    settings = vertifleet.settings("paper")
    parser = argparse.ArgumentParser(description="Trains the paper's network with MaskablePPO.")
    parser.add_argument("--steps", type=int, default=settings["total_steps"], help="decisions to learn from")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default="maskable-ppo.safetensors", help="the weight file")
    wanted = parser.parse_args()

    days = FleetVecEnv(NETWORK, settings["n_envs"], settings["reward"], settings["reward_scale"])
    model = MaskablePPO(GcapsPolicy, days, **ppo_settings(settings), seed=wanted.seed, verbose=1)
    start = time.perf_counter()
    model.learn(wanted.steps)
    seconds = time.perf_counter() - start
    print(f"{model.num_timesteps} steps in {seconds:.0f} s, {model.num_timesteps / seconds:.0f} steps/s")

    export(model, wanted.out, network=vertifleet.Network(NETWORK))
    model_option = f"--model mine={wanted.out}"
    print(f"vertifleet compare --network {NETWORK} --policies greedy,mine {model_option} --days 100 --seed 1")


if __name__ == "__main__":
    main()

"""Decisions learned from per second: the PyTorch twin under MaskablePPO against `vertifleet train`, in turn.

Both train `gcaps` on `paper` with the program's default settings and learn from as many decisions. Of the
program the whole process is timed, of MaskablePPO `learn` alone. Neither looks at validation days.

    python benches/training.py --program ../target/release/vertifleet
"""

import argparse
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import torch
from sb3_contrib import MaskablePPO

import vertifleet
from vertifleet.sb3 import FleetVecEnv, GcapsPolicy, ppo_settings

ROOT = Path(__file__).resolve().parents[2]


def of_the_program(program: Path, steps: int, threads: int) -> float:
    """Decisions per second of `vertifleet train`."""
    with tempfile.TemporaryDirectory() as folder:
        command = [
            program,
            "train",
            "--network",
            "paper",
            "--policy",
            "gcaps",
            "--steps",
            steps,
            "--out",
            folder,
        ]
        command += ["--set", "eval_every=1000000000", "--threads", threads]
        begun = time.perf_counter()
        subprocess.run([str(part) for part in command], check=True, capture_output=True)
        return steps / (time.perf_counter() - begun)


def of_maskable_ppo(steps: int) -> float:
    """Decisions per second of MaskablePPO."""
    settings = vertifleet.settings("default")
    days = FleetVecEnv("paper", settings["n_envs"], settings["reward"], settings["reward_scale"])
    model = MaskablePPO(GcapsPolicy, days, **ppo_settings(settings), seed=1)
    begun = time.perf_counter()
    model.learn(steps)
    return model.num_timesteps / (time.perf_counter() - begun)


def main() -> None:
    """Measures in turn and prints the medians and their spread."""
    parser = argparse.ArgumentParser(description="MaskablePPO with the twin against vertifleet train.")
    parser.add_argument("--program", type=Path, default=ROOT / "target/release/vertifleet")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--updates", type=int, default=2, help="updates of each in every round")
    parser.add_argument("--threads", type=int, default=2)
    wanted = parser.parse_args()
    torch.set_num_threads(wanted.threads)
    os.environ["RAYON_NUM_THREADS"] = str(wanted.threads)
    settings = vertifleet.settings("default")
    steps = wanted.updates * settings["n_envs"] * settings["n_steps"]
    rounds = []
    for number in range(1, wanted.rounds + 1):
        program, twin = of_the_program(wanted.program, steps, wanted.threads), of_maskable_ppo(steps)
        rounds.append((program, twin, program / twin))
        print(f"round {number}: program {program:,.0f}, MaskablePPO {twin:,.0f} decisions/s", flush=True)
    for name, seen in zip(
        ("vertifleet train", "MaskablePPO", "ratio"), zip(*rounds, strict=True), strict=True
    ):
        print(f"{name}: {statistics.median(seen):,.2f} ({min(seen):,.2f} to {max(seen):,.2f})")


if __name__ == "__main__":
    main()

"""The example of PPO in one file: it learns, saves, and is compared."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

torch = pytest.importorskip("torch")

EXAMPLE = Path(__file__).parents[2] / "examples" / "ppo.py"


@pytest.mark.parametrize("network", ["paper", "random:7"])
def test_the_example_learns_saves_and_compares(network: str, tmp_path: Path) -> None:
    command = [sys.executable, str(EXAMPLE), "--network", network, "--minutes", "0.02", "--days", "4"]
    command += ["--steps", "16", "--batch", "32", "--out", "agent.pt"]
    done = subprocess.run(command, cwd=tmp_path, env=os.environ, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "decisions, " in done.stdout
    assert "ppo     forecast" in done.stdout
    assert "outside the mask" not in done.stderr
    weights = torch.load(tmp_path / "agent.pt", weights_only=True)
    assert all(torch.isfinite(tensor).all() for tensor in weights.values())


def test_the_example_is_short_enough_to_read() -> None:
    assert len(EXAMPLE.read_text(encoding="utf-8").splitlines()) <= 250

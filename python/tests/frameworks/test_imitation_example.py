"""The example of imitation: it learns from a run's samples, goes on after a stop, and writes weights."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

import vertifleet

torch = pytest.importorskip("torch")

from vertifleet.torch import load  # noqa: E402

EXAMPLE = Path(__file__).parents[2] / "examples" / "imitation.py"
ROUND = {"rounds": 1, "days": 2, "samples": 40, "passes": 1, "rollouts": 1, "horizon_s": 600}
ROUND |= {"validation_days": 1, "random_share": 0.5, "width": 8, "heads": 2}


@pytest.fixture(scope="module")
def checkpoints(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The checkpoints of small runs, by their adjacency."""
    folders = {}
    for name in ("complete", "profit"):
        out = tmp_path_factory.mktemp(name)
        vertifleet.train("paper", "gcaps-full", out=out, settings=ROUND | {"adjacency": name}, threads=1)
        folders[name] = out / "gcaps-full-checkpoint.safetensors"
    return folders


ARGUMENTS = ["--device", "cpu", "--passes", "5", "--nodes", "64", "--chunks", "2"]
ARGUMENTS += ["--set", "width=8", "--set", "heads=2"]


def the_example() -> ModuleType:
    spec = importlib.util.spec_from_file_location("imitation", EXAMPLE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Calls:
    """Calls of the example in a separate folder."""

    def __init__(self, patch: pytest.MonkeyPatch, said: pytest.CaptureFixture[str], folder: Path) -> None:
        self._patch, self._said, self._main = patch, said, the_example().main
        patch.chdir(folder)

    def __call__(self, checkpoint: Path, *arguments: str) -> list[str]:
        """The output of each pass, without its duration."""
        self._patch.setattr(sys, "argv", ["imitation.py", str(checkpoint), *ARGUMENTS, *arguments])
        self._main()
        lines = self._said.readouterr().out.splitlines()
        return [line.rsplit(",", 1)[0] for line in lines if line.startswith("pass")]


@pytest.fixture
def calls(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> Iterator[Calls]:
    threads = torch.get_num_threads()
    yield Calls(monkeypatch, capsys, tmp_path)
    torch.set_num_threads(threads)


def test_a_run_that_stopped_goes_on_to_the_same_weights(
    checkpoints: dict[str, Path], calls: Calls, tmp_path: Path
) -> None:
    checkpoint, cut = checkpoints["complete"], ["--out", "cut.safetensors"]
    whole = calls(checkpoint, "--out", "whole.safetensors")
    first = calls(checkpoint, *cut, "--until", "2")
    with pytest.raises(SystemExit, match="--resume"):
        calls(checkpoint, *cut)
    with pytest.raises(SystemExit, match="another run"):
        calls(checkpoint, *cut, "--resume", "--seed", "2")
    assert len(first) == 2
    assert first + calls(checkpoint, *cut, "--resume") == whole
    weights = (tmp_path / "whole.safetensors").read_bytes()
    assert (tmp_path / "cut.safetensors").read_bytes() == weights
    header = load(weights).header
    assert header is not None
    assert (header["network"], header["settings"], header["seed"]) == ("paper", None, 1)


def test_it_learns_the_choices_of_the_roll_outs(checkpoints: dict[str, Path], calls: Calls) -> None:
    learned = calls(checkpoints["complete"], "--passes", "60", "--learning-rate", "0.01")
    lifts = [float(line.rsplit(" ", 1)[1]) for line in learned]
    assert lifts[-1] > max(lifts[0], 0.0)


def test_edges_are_learned_from_where_the_samples_have_them(
    checkpoints: dict[str, Path], calls: Calls, tmp_path: Path
) -> None:
    graph = ["--set", "adjacency=profit", "--set", "laplacian=normalised", "--set", "attention=false"]
    assert len(calls(checkpoints["profit"], "--out", "seen.safetensors", *graph)) == 5
    assert load(tmp_path / "seen.safetensors").edges == "profit_edges"
    with pytest.raises(SystemExit, match="edges of complete"):
        calls(checkpoints["complete"], *graph)
    assert len(calls(checkpoints["profit"], "--set", "encoder=transformer")) == 5
    other = tmp_path / "other.safetensors"
    other.write_bytes(
        checkpoints["complete"].read_bytes().replace(b'\\"kind\\":\\"gcaps-full', b'\\"kind\\":\\"gcaps-fall')
    )
    with pytest.raises(SystemExit, match="is of gcaps-fall"):
        calls(other)
    with pytest.raises(vertifleet.Error, match="hops"):
        calls(checkpoints["profit"], "--set", "hops=9")


def test_the_program_decides_with_the_weights_of_a_call(checkpoints: dict[str, Path], tmp_path: Path) -> None:
    command = [sys.executable, str(EXAMPLE), str(checkpoints["complete"]), *ARGUMENTS]
    done = subprocess.run(command, cwd=tmp_path, env=os.environ, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    model = vertifleet.Model.read(tmp_path / "gcaps-full.safetensors")
    evaluation = vertifleet.evaluate({"learned": model}, "paper-100")
    assert evaluation.bound_share["paper-100"]["learned"] > 0
    wrong = subprocess.run([*command, "--set", "hops=9"], cwd=tmp_path, capture_output=True, text=True)
    assert (wrong.returncode, "hops" in wrong.stderr, "Traceback" in wrong.stderr) == (1, True, False)


def test_the_loss_is_that_of_the_program() -> None:
    # The values of the Rust test of the same loss, of a policy that decides without prices.
    found = torch.tensor([[0.3, -0.2, -torch.inf, 1.1]], dtype=torch.float64, requires_grad=True)
    values = torch.tensor([[0.04, -0.03, 0.0, -0.01]], dtype=torch.float64)
    loss = the_example().loss_of(found, values, 0.7)
    loss.sum().backward()
    p = found.detach()[0, [0, 1, 3]].softmax(0)
    a = 20 * values[0, [0, 1, 3]]
    assert loss.item() == pytest.approx((-(p * a) + 0.7 * p * p.log()).sum().item())
    entropy = -(p * p.log()).sum()
    slopes = -p * (a - (p * a).sum() + 0.7 * (-p.log() - entropy))
    assert found.grad is not None
    assert found.grad[0, [0, 1, 3]].tolist() == pytest.approx(slopes.tolist())
    assert found.grad[0, 2] == 0


def test_the_example_is_short_enough_to_read() -> None:
    assert len(EXAMPLE.read_text(encoding="utf-8").splitlines()) <= 250

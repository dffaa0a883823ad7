"""The board of result files, against statistics written out with numpy, and the runs that files name."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from numpy.typing import NDArray

import vertifleet
from vertifleet import Decision, View

SCHEMA = Path(__file__).parents[2] / "docs/src/reference/result-1.schema.json"
RUNS = 4
DAYS = 100

Shares = NDArray[np.float64]


class Careless:
    """Decides as one training run of a method would: the seed sets how often it takes any feasible flight."""

    seed: int

    def reset(self, view: View) -> None:  # noqa: ARG002
        self.generator = np.random.default_rng(self.seed)

    def choose(self, decision: Decision, view: View) -> int:  # noqa: ARG002
        feasible = np.flatnonzero(view.action_mask)
        careless = self.generator.random() < 0.1 * self.seed
        return int(self.generator.choice(feasible) if careless else feasible[-1])


def run_of(number: int) -> type[Careless]:
    return type(f"Careless{number}", (Careless,), {"seed": number})


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four runs of a method and `greedy` on `paper-100`."""
    folder = tmp_path_factory.mktemp("results")
    policies: dict[str, Any] = {f"careless-{number}": run_of(number) for number in range(1, RUNS + 1)}
    evaluation = vertifleet.evaluate({"greedy": "greedy", **policies}, threads=1)
    runs = {f"careless-{number}": ("careless", number) for number in range(1, RUNS + 1)}
    evaluation.save(folder, runs=runs)
    return folder


@pytest.fixture(scope="module")
def shares(results: Path) -> Shares:
    """The share of the bound of each run on each day, from the files [runs, days]."""

    def of_run(number: int) -> list[float]:
        result = json.loads((results / f"paper-100-careless-{number}.json").read_text())
        # The network has no costs of aircraft and sites, so profit is operating profit.
        return [day["profit_usd"] / day["upper_bound_usd"] for day in result["days"]]

    return np.array([of_run(number) for number in range(1, RUNS + 1)])


def interquartile_mean(shares: Shares) -> float:
    """The 25 % trimmed mean of all runs and tasks, as rliable's `aggregate_iqm`."""
    ordered = np.sort(shares, axis=None)
    cut = int(0.25 * ordered.size)
    return float(ordered[cut : ordered.size - cut].mean())


def two_level(shares: Shares, measure: Any, samples: int = 4000) -> Shares:
    """Percentiles of a measure over samples of whole runs and whole days, both with replacement."""
    generator = np.random.default_rng(7)
    runs, days = shares.shape

    def one() -> Any:
        rows, columns = generator.integers(runs, size=runs), generator.integers(days, size=days)
        return measure(shares[np.ix_(rows, columns)])

    return np.percentile([one() for _ in range(samples)], [2.5, 97.5], axis=0)


def by_task(shares: Shares, samples: int = 4000) -> Shares:
    """rliable's stratified bootstrap: the runs of each task are drawn separately, the tasks stay."""
    generator = np.random.default_rng(8)
    tasks = np.arange(shares.shape[1])
    drawn = (shares[generator.integers(len(shares), size=shares.shape), tasks] for _ in range(samples))
    return np.percentile([interquartile_mean(one) for one in drawn], [2.5, 97.5])


def test_the_statistics_are_those_of_plain_numpy(results: Path, shares: Shares) -> None:
    suite = vertifleet.board(results).summary["suites"][0]
    methods = {method["method"]: method for method in suite["methods"]}
    ours = methods["careless"]
    assert shares.shape == (RUNS, DAYS)
    assert [run["training_seed"] for run in ours["runs"]] == [1, 2, 3, 4]
    assert [run["bound_share"] for run in ours["runs"]] == pytest.approx(shares.mean(axis=1))
    assert ours["bound_share"]["estimate"] == pytest.approx(shares.mean())
    assert ours["optimality_gap"]["estimate"] == pytest.approx(1 - shares.mean())
    assert ours["lowest_bound_share"] == pytest.approx(shares.min())
    assert ours["interquartile_mean"]["estimate"] == pytest.approx(interquartile_mean(shares))

    spread = shares.mean(axis=1).std()
    for member, measure in (("bound_share", np.mean), ("interquartile_mean", interquartile_mean)):
        found = ours[member]["interval_95"]
        assert found == pytest.approx(two_level(shares, measure), abs=0.12 * spread), member
    # Runs of each day that are drawn separately hide that one run is worse on every day.
    found = np.array(ours["interquartile_mean_by_day_95"])
    assert found == pytest.approx(by_task(shares), abs=0.02 * spread)
    assert np.ptp(found) < 0.4 * np.ptp(ours["interquartile_mean"]["interval_95"])
    assert methods["greedy"]["interquartile_mean_by_day_95"] is None


def test_profiles_are_the_share_of_runs_and_days_above_each_threshold(results: Path, shares: Shares) -> None:
    suite = vertifleet.board(results).summary["suites"][0]
    thresholds = np.array(suite["thresholds"])
    profile = next(one for one in suite["methods"] if one["method"] == "careless")["profile"]

    def above(shares: Shares) -> Shares:
        return (shares[..., None] > thresholds).mean(axis=(0, 1))

    assert [point["estimate"] for point in profile] == pytest.approx(above(shares))
    assert thresholds[0] <= shares.min() < thresholds[0] + 0.01
    assert thresholds[-1] == 1.0
    bands = np.array([point["interval_95"] for point in profile]).T
    # A quarter of all samples lack a given run, so bands move in steps of a run's share.
    assert np.abs(bands - two_level(shares, above, 1000)).mean() < 0.02


def test_files_name_the_run_and_match_their_schema(results: Path) -> None:
    result = json.loads((results / "paper-100-careless-3.json").read_text())
    jsonschema.validate(result, json.loads(SCHEMA.read_text()))
    assert result["run"] == {"method": "careless", "training_seed": 3}
    greedy = json.loads((results / "paper-100-greedy.json").read_text())
    assert "run" not in greedy
    assert vertifleet.verify(results / "paper-100-careless-3.json").valid


def test_a_run_counts_once(results: Path, tmp_path: Path) -> None:
    path = results / "paper-100-careless-3.json"
    (tmp_path / "again.json").write_bytes(path.read_bytes())
    with pytest.raises(vertifleet.Error) as refused:
        vertifleet.board([path, tmp_path / "again.json"])
    assert refused.value.code == "V416"


def test_a_result_that_does_not_verify_has_no_place(results: Path, tmp_path: Path) -> None:
    result = json.loads((results / "paper-100-greedy.json").read_text())
    result["days"][3]["profit_usd"] += 1.0
    (tmp_path / "better.json").write_text(json.dumps(result))
    with pytest.raises(vertifleet.Error, match="a profit of") as refused:
        vertifleet.board(tmp_path)
    assert refused.value.code == "V415"


def test_seeds_of_weights_are_those_of_their_runs(tmp_path: Path) -> None:
    evaluation = vertifleet.evaluate("mlp")
    with pytest.raises(vertifleet.Error, match="seed"):
        evaluation.save(tmp_path, runs={"mlp": ("mine", 77)})
    with pytest.raises(vertifleet.Error, match="not among"):
        evaluation.save(tmp_path, runs={"other": ("mine", 1)})
    (path,) = evaluation.save(tmp_path, runs={"mlp": ("mine", None)})
    run = json.loads(path.read_text())["run"]
    assert (run["method"], type(run["training_seed"])) == ("mine", int)


def test_a_board_prints_and_reports(results: Path, tmp_path: Path) -> None:
    board = vertifleet.board(results)
    assert "careless" in str(board)
    assert "<table>" in board._repr_html_()
    page = board.report(tmp_path / "report")
    assert page.name == "report.html"
    names = {path.name for path in page.parent.iterdir()}
    assert names >= {"board.md", "summary.json", "figure-board-paper-100.svg"}
    assert json.loads((page.parent / "summary.json").read_text()) == board.summary

"""Evaluations on frozen suites, their result files, and the verification of these."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import vertifleet
from vertifleet import Decision, FunctionPolicy, View

SCHEMA = Path(__file__).parents[2] / "docs/src/reference/result-1.schema.json"


class FirstFeasible:
    """Remembers whether it was reset, and flies to the first vertiport that it may fly to."""

    def reset(self, view: View) -> None:
        assert view.decision.step == 0
        self.steps = 0

    def choose(self, decision: Decision, view: View) -> int:
        assert decision.step == self.steps
        self.steps += 1
        return int(np.flatnonzero(view.action_mask)[0])


def first_feasible(observation: dict[str, Any]) -> int:
    return int(np.flatnonzero(observation["action_mask"])[0])


def test_a_policy_of_the_program_is_measured_by_the_certified_bounds() -> None:
    evaluation = vertifleet.evaluate("greedy")
    suite = vertifleet.suite("paper-100")
    rows = evaluation.columns
    assert list(rows["day"]) == [day.name for day in suite.days]
    shares = rows["profit_usd"] / suite.upper_bound_usd
    assert np.allclose(rows["bound_share"], shares)
    assert evaluation.bound_share == {"paper-100": {"greedy": pytest.approx(shares.mean())}}
    assert (shares < 1).all()
    compared = vertifleet.compare("paper", ["greedy"], days=100, seed=1)
    assert np.array_equal(compared.columns["profit_usd"], rows["profit_usd"])
    assert "of bound" in str(evaluation)
    assert evaluation.summary["suites"][0]["days"] == 100


def test_a_function_and_a_class_that_choose_alike_are_measured_alike() -> None:
    as_function = FunctionPolicy(first_feasible, "full", network="random-places:8")
    policies = {"class": FirstFeasible, "function": as_function}
    rows = vertifleet.evaluate(policies, "random-places-100", threads=2).to_pandas()
    by_policy = rows.pivot_table(index="day", columns="policy", values="profit_usd")
    assert (by_policy["class"] == by_policy["function"]).all()


def test_functions_for_networks_of_many_sizes_name_their_source_of_days() -> None:
    with pytest.raises(vertifleet.Error, match="takes a network"):
        vertifleet.evaluate(first_feasible, "random-50")


def test_suites_leave_out_policies_that_cannot_play_them() -> None:
    with pytest.warns(UserWarning, match="gcaps is left out of random-50"):
        evaluation = vertifleet.evaluate(["greedy", "gcaps"], ["paper-100", "random-50"])
    assert set(evaluation.bound_share["paper-100"]) == {"greedy", "gcaps"}
    assert set(evaluation.bound_share["random-50"]) == {"greedy"}


def test_results_match_their_schema_and_are_verified(tmp_path: Path) -> None:
    evaluation = vertifleet.evaluate({"mine": FirstFeasible, "greedy": "greedy"}, threads=1)
    paths = evaluation.save(tmp_path, about={"training": "none"})
    assert [path.name for path in paths] == ["paper-100-mine.json", "paper-100-greedy.json"]
    for path in paths:
        result = json.loads(path.read_text())
        jsonschema.validate(result, json.loads(SCHEMA.read_text()))
        assert result["about"] == {"training": "none"}
        found = vertifleet.verify(path)
        assert found.valid
        assert found.bound_share == result["bound_share"]["mean"]
    result["days"][0]["profit_usd"] += 1
    paths[1].write_text(json.dumps(result))
    found = vertifleet.verify(paths[1])
    assert not found.valid
    assert "is claimed" in found.findings[0]
    with pytest.raises(vertifleet.Error) as error:
        vertifleet.verify(SCHEMA)
    assert error.value.code == "V413"


def test_a_result_names_the_weights_that_played(tmp_path: Path) -> None:
    weights = tmp_path / "mine.safetensors"
    vertifleet.Model.shipped().write(weights)
    (result,) = vertifleet.evaluate({"mine": weights}).save(tmp_path)
    sha256 = hashlib.sha256(weights.read_bytes()).hexdigest()
    assert json.loads(result.read_text())["policy"]["weights_sha256"] == sha256
    assert vertifleet.Model.read(weights).sha256 == sha256


def test_a_name_with_a_control_character_is_refused() -> None:
    with pytest.raises(vertifleet.Error, match="control character") as error:
        vertifleet.evaluate({"mine\nyours": FirstFeasible})
    assert error.value.code == "V407"


def test_suites_are_named() -> None:
    assert vertifleet.SUITES[0] == "paper-100"
    for name in ("paper-100", "random-50"):
        suite = vertifleet.suite(name)
        assert len(suite.days) == len(suite.upper_bound_usd)
        assert (suite.network is None) == (name == "random-50")
    with pytest.raises(vertifleet.Error, match="paper-100") as error:
        vertifleet.evaluate("greedy", "paper-10")
    assert error.value.code == "V411"


def test_batch_policies_choose_as_they_do_one_by_one() -> None:
    def rates(observation: dict[str, Any]) -> Any:
        rate = observation["choice_profit"] / observation["choice_block_time"].clip(0.1)
        return np.where(observation["action_mask"] == 1, rate, -1.0)

    class Batch:
        def choose_batch(self, decisions: list[Decision], views: list[View]) -> list[int]:
            assert [view.decision for view in views] == decisions
            return [int(np.flatnonzero(view.action_mask)[0]) for view in views]

    one = FunctionPolicy(lambda seen: int(rates(seen).argmax()), "full")
    many = FunctionPolicy(lambda seen: rates(seen).argmax(1), "full", batch=True)
    policies = {"one": one, "many": many, "first": FirstFeasible, "batch": Batch}
    rows = vertifleet.evaluate(policies, "paper-100").to_pandas()
    profits = rows.pivot_table(index="day", columns="policy", values="profit_usd")
    assert (profits["one"] == profits["many"]).all()
    assert (profits["first"] == profits["batch"]).all()
    day = vertifleet.suite("paper-100").days[0]
    played = vertifleet.simulate(day, many, network=vertifleet.Network("paper"))
    assert played.profit_usd == profits["many"][day.name]
    worth = lambda seen: np.where(seen["priced_nodes"][..., 0] == 1, seen["priced_worth"], -np.inf)  # noqa: E731
    priced = FunctionPolicy(lambda seen: worth(seen).argmax(-1), "gcaps-x", batch=True)
    priced_one = FunctionPolicy(lambda seen: int(worth(seen).argmax(-1)), "gcaps-x")
    models = {"a": priced, "b": priced_one}
    compared = vertifleet.compare("paper", ["a", "b"], days=3, models=models).columns["profit_usd"]
    assert np.array_equal(compared[:3], compared[3:])


def test_too_few_actions_are_refused() -> None:
    few = FunctionPolicy(lambda seen: [0], "full", batch=True)
    with pytest.raises(vertifleet.Error, match="100 actions were asked for, 1"):
        vertifleet.evaluate(few)


def test_policies_are_measured_on_random_networks(tmp_path: Path) -> None:
    own = FunctionPolicy(first_feasible, "full", network="random")
    found = vertifleet.evaluate(["greedy", "mine"], suite="random:2", models={"mine": own})
    rows = found.to_pandas()
    assert list(rows["seed"][:2]) == [0, 1]
    assert (rows["profit_usd"] < rows["upper_bound_usd"]).all()
    assert found.summary["suites"][0]["policies"][1]["minus_first"]["difference"]["mean"] < 0
    [path, _] = found.save(tmp_path / "results")
    assert vertifleet.verify(path).valid
    with pytest.raises(vertifleet.Error, match="no suite"):
        vertifleet.evaluate(["greedy"], suite="random:0")

"""Recorded decisions are those of the policy, and come back from a file as they were."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vertifleet
from vertifleet import Dataset, FunctionPolicy, OwnObservation
from vertifleet.envs import FleetEnv


def test_decisions_are_those_of_the_policy_with_what_the_environment_shows() -> None:
    recorded = vertifleet.dataset("greedy", 2, observation="full", split="validation", first=5, values=True)
    assert [str(recorded.day[day][0]) for day in recorded.days()] == sorted(set(recorded.day))
    env = FleetEnv(reward="dense", observation="full", split="validation")
    asked = vertifleet.policy("greedy")
    for number, day in enumerate(recorded.days()):
        observation, info = env.reset(options={"number": 5 + number})
        assert info["day"] == recorded.day[day][0]
        for at in range(day.start, day.stop):
            assert not recorded.over[at - 1] or at == day.start
            for name, part in recorded.observation.items():
                assert np.array_equal(part[at], observation[name]), name
            assert recorded.values is not None
            assert np.array_equal(recorded.values[at], asked.values(env.view), equal_nan=True)
            assert recorded.action[at] == asked.choose(env.view.decision, env.view)
            observation, reward, over, _, _ = env.step(recorded.action[at])
            assert reward == recorded.reward[at]
        assert over
        assert recorded.over[day.stop - 1]


def first_feasible(observation: dict[str, Any]) -> int:
    return int(np.flatnonzero(observation["action_mask"])[0])


def test_any_policy_can_be_recorded_on_any_networks() -> None:
    own = FunctionPolicy(first_feasible, "full", network="random")
    recorded = vertifleet.dataset(own, 3, network="random", observation=["choice_profit"], threads=2)
    assert set(recorded.observation) == {"choice_profit", "action_mask"}
    assert recorded.observation["choice_profit"].shape == (len(recorded), 30)
    assert (recorded.observation["action_mask"][np.arange(len(recorded)), recorded.action] == 1).all()
    assert len(set(recorded.day)) == 3
    one = vertifleet.dataset("gcaps-x", 2, network="random", observation=["action_mask"], threads=1)
    two = vertifleet.dataset("gcaps-x", 2, network="random", observation=["action_mask"], threads=2)
    assert np.array_equal(one.action, two.action)


def test_a_file_has_what_was_written(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    import polars

    recorded = vertifleet.dataset("prices", 2, observation="full", values=True)
    recorded.write(tmp_path / "decisions.parquet")
    again = Dataset.read(tmp_path / "decisions.parquet")
    assert list(again.observation) == list(recorded.observation)
    for name, part in recorded.observation.items():
        assert np.array_equal(again.observation[name], part), name
        assert again.observation[name].shape == part.shape
    for name in ("action", "reward", "over", "day", "values"):
        one, other = getattr(again, name), getattr(recorded, name)
        assert np.array_equal(one, other, equal_nan=name == "values"), name
    frame = polars.read_parquet(tmp_path / "decisions.parquet")
    assert frame["action"].to_list() == recorded.action.tolist()
    frame.write_parquet(tmp_path / "other.parquet")
    with pytest.raises(vertifleet.Error, match="not a dataset"):
        Dataset.read(tmp_path / "other.parquet")


def test_what_cannot_be_recorded_is_refused() -> None:
    import gymnasium

    own = OwnObservation(lambda view: view.stands, gymnasium.spaces.Box(0, 1, (8,)))
    with pytest.raises(vertifleet.Error, match="own observations"):
        vertifleet.dataset("greedy", 1, observation=own)
    with pytest.raises(vertifleet.Error) as error:
        vertifleet.dataset("gcaps", 1, network="random")
    assert error.value.code == "V307"

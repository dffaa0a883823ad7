"""One agent an aircraft."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import vertifleet
from vertifleet.envs import FleetEnv

pytest.importorskip("pettingzoo")

from pettingzoo.test import api_test, seed_test

from vertifleet import pettingzoo

SMALL = vertifleet.Network("paper").changed({"fleet.0.count": 6, "operations.end": "09:00:00"})


def test_pettingzoo_finds_nothing_wrong() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # It would rather have one array than several and a mask.
        warnings.filterwarnings("ignore", message="Observation is not a NumPy array")
        warnings.filterwarnings("ignore", message="Observation space for each agent probably should be")
        api_test(pettingzoo.env(SMALL), num_cycles=300)


def test_the_same_seed_gives_the_same_day() -> None:
    seed_test(lambda: pettingzoo.env(SMALL), num_cycles=50)


@pytest.mark.parametrize("reward", ["terminal", "dense"])
def test_agents_are_paid_what_the_day_pays(reward: str) -> None:
    agents, single = pettingzoo.env("paper", reward), FleetEnv("paper", reward)
    agents.reset(seed=9)
    expected, _ = single.reset(seed=9)
    choices = np.random.default_rng(1)
    paid = dict.fromkeys(agents.possible_agents, 0.0)
    total = 0.0
    for agent in agents.agent_iter():
        observation, earned, over, _, _ = agents.last()
        paid[agent] += earned
        if over:
            agents.step(None)
            continue
        assert np.array_equal(observation["action_mask"], single.action_masks())
        for key, array in observation["observation"].items():
            assert np.array_equal(array, expected[key])
        action = choices.choice(np.flatnonzero(observation["action_mask"]))
        expected, one, *_ = single.step(action)
        total += one
        agents.step(int(action))
    assert sum(paid.values()) == pytest.approx(total, abs=1e-12)
    assert sum(value != 0 for value in paid.values()) > 35, "each is paid for its own flights"


def test_an_aircraft_that_does_not_decide_can_only_hold() -> None:
    env = pettingzoo.env("paper")
    env.reset(seed=2)
    others = [agent for agent in env.agents if agent != env.agent_selection]
    for agent in others:
        shown = env.observe(agent)
        place = shown["observation"]["aircraft"][1:9]
        assert np.array_equal(shown["action_mask"], place)


def test_masks_are_told_and_a_day_of_another_fleet_is_refused() -> None:
    env = pettingzoo.env("paper", render_mode=None)
    env.reset(seed=2)
    for _ in range(50):
        observation, _, _, _, info = env.last()
        assert info["action_mask"].dtype == np.int8
        assert np.array_equal(info["action_mask"], observation["action_mask"])
        env.step(int(observation["action_mask"].argmax()))
    with pytest.raises(vertifleet.Error, match="aircraft") as error:
        env.reset(options={"scenario": SMALL.draw(1)})
    assert error.value.code == "V451"

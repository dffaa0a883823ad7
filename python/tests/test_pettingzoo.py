"""The PettingZoo environment, with one agent per aircraft."""

from __future__ import annotations

import copy
import warnings
from typing import Any

import numpy as np
import pytest

import vertifleet
from vertifleet.envs import FleetEnv

pytest.importorskip("pettingzoo")

from pettingzoo.test import api_test, parallel_api_test, seed_test

from vertifleet import pettingzoo

SMALL = vertifleet.Network("paper").changed({"fleet.0.count": 6, "operations.end": "09:00:00"})


def test_pettingzoos_tests_pass() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # PettingZoo prefers one array to several arrays and a mask.
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
    assert sum(value != 0 for value in paid.values()) > 35, "every agent is paid for its own flights"


def first_feasible(env: Any) -> int:
    """The feasible choice with the lowest position."""
    return int(env.observe(env.agent_selection)["action_mask"].argmax())


def test_the_end_has_the_days_numbers() -> None:
    agents, single = pettingzoo.env(SMALL), FleetEnv(SMALL)
    agents.reset(seed=3)
    single.reset(seed=3)
    assert agents.scenario.name == single.scenario.name
    over = False
    while not over:
        assert all(list(info) == ["invalid_action"] for info in agents.infos.values()), "they stay alike"
        action = first_feasible(agents)
        agents.step(action)
        _, _, over, _, info = single.step(action)
    assert agents.unwrapped.summary == info["summary"]
    for agent in agents.possible_agents:
        assert agents.observe(agent)["action_mask"].sum() == 1, "only hold is feasible"


@pytest.mark.parametrize("how", [copy.copy, copy.deepcopy])
def test_copies_play_on_independently_and_share_immutable_members(how: Any) -> None:
    env = pettingzoo.FleetAEC(SMALL, "dense")
    env.reset(seed=3)
    for _ in range(20):
        env.step(first_feasible(env))
    other = how(env)
    assert other.network is env.network
    assert other.action_spaces is env.action_spaces
    before = copy.deepcopy((env.agent_selection, env.rewards, env.terminations, env._cumulative_rewards))
    actions = []
    while not other.terminations[other.agent_selection]:
        actions.append(first_feasible(other))
        other.step(actions[-1])
    after = (env.agent_selection, env.rewards, env.terminations, env._cumulative_rewards)
    assert after == before, "the copy plays a separate day"
    for action in actions:
        env.step(action)
    assert env._cumulative_rewards == other._cumulative_rewards
    assert env.summary == other.summary


def test_a_wrapped_environment_is_copied_deep() -> None:
    env = pettingzoo.env(SMALL)
    env.reset(seed=3)
    other = copy.deepcopy(env)
    other.step(0)
    assert (env.agent_selection, other.agent_selection) == ("aircraft_0", "aircraft_1")
    assert other.unwrapped.network is env.unwrapped.network


@pytest.mark.parametrize("reward", ["weekly", "Dense", None])
def test_rewards_are_those_of_the_single_environment(reward: Any) -> None:
    with pytest.raises(vertifleet.Error, match="reward must be") as error:
        pettingzoo.env(reward=reward)
    assert error.value.code == "V451"


@pytest.mark.parametrize("options", [{"scenerio": None}, ["scenario"], {"scenario": "paper"}])
def test_options_that_a_reset_does_not_have_are_refused(options: Any) -> None:
    with pytest.raises(vertifleet.Error, match="option") as error:
        pettingzoo.env(SMALL).reset(options=options)
    assert error.value.code == "V451"


@pytest.mark.parametrize("action", [0.7, "3", True, None, np.array([3]), 10**30])
def test_an_action_is_a_whole_number(action: Any) -> None:
    env = pettingzoo.env(SMALL)
    env.reset(seed=3)
    with pytest.raises(vertifleet.Error, match="action must be a whole number") as error:
        env.step(action)
    assert error.value.code == "V451"
    assert env.agent_selection == "aircraft_0", "the refused call changed nothing"


def test_an_aircraft_that_does_not_decide_can_only_hold() -> None:
    env = pettingzoo.env("paper")
    env.reset(seed=2)
    others = [agent for agent in env.agents if agent != env.agent_selection]
    for agent in others:
        shown = env.observe(agent)
        place = shown["observation"]["aircraft"][1:9]
        assert np.array_equal(shown["action_mask"], place)


def test_a_day_of_another_fleet_is_refused() -> None:
    env = pettingzoo.env("paper", render_mode=None)
    with pytest.raises(vertifleet.Error, match="aircraft") as error:
        env.reset(options={"scenario": SMALL.draw(1)})
    assert error.value.code == "V451"


def test_the_state_is_the_full_observation() -> None:
    agents, single = pettingzoo.env("paper"), FleetEnv("paper", observation="full")
    agents.reset(seed=3)
    full, _ = single.reset(seed=3)
    state = agents.state()
    assert agents.unwrapped.state_space.contains(state)
    assert np.array_equal(state, np.concatenate([array.ravel() for array in full.values()]))


def test_agents_have_the_members_of_single_agents() -> None:
    agents = pettingzoo.FleetAEC("paper", observation="full", split="validation")
    single = FleetEnv("paper", observation="full", split="validation")
    agents.reset(options={"number": 7})
    expected, info = single.reset(options={"number": 7})
    assert agents.scenario.name == info["day"]
    shown = agents.observe(agents.agent_selection)
    assert np.array_equal(shown["action_mask"], expected.pop("action_mask"))
    assert shown["observation"].keys() == expected.keys()
    for name, array in expected.items():
        assert np.array_equal(shown["observation"][name], array), name
    for agent in agents.agents:
        assert agents.observation_space(agent).contains(agents.observe(agent))


def test_days_of_drawn_networks_have_as_many_agents_as_aircraft() -> None:
    env = pettingzoo.FleetAEC("random", observation="full")
    found = set()
    for seed in range(4):
        env.reset(seed=seed)
        assert env.agents == env.possible_agents[: len(env.scenario.aircraft)]
        found.add(len(env.agents))
        assert env.observation_space(env.agent_selection).contains(env.observe(env.agent_selection))
        env.step(first_feasible(env))
    assert len(found) > 1
    own = vertifleet.OwnObservation(lambda view: view.decision.time_s, env.observation_space("aircraft_0"))
    with pytest.raises(vertifleet.Error, match="each aircraft observes"):
        pettingzoo.env(observation=own)


def test_the_api_holds_without_a_wrapper() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        api_test(pettingzoo.FleetAEC(SMALL), num_cycles=100)
        parallel_api_test(pettingzoo.parallel_env(SMALL), num_cycles=100)


def test_the_parallel_view_plays_the_same_day() -> None:
    turns, parallel = pettingzoo.FleetAEC(SMALL, "dense"), pettingzoo.parallel_env(SMALL, "dense")
    turns.reset(seed=5)
    observations, _ = parallel.reset(seed=5)
    while parallel.agents:
        assert parallel.deciding == turns.agent_selection
        mask = observations[parallel.deciding]["action_mask"]
        assert np.array_equal(mask, turns.observe(turns.agent_selection)["action_mask"])
        choice = first_feasible(turns)
        turns.step(choice)
        observations, rewards, *_ = parallel.step(dict.fromkeys(parallel.agents, choice))
        assert rewards == turns.rewards
    assert parallel.turns.summary == turns.summary
    with pytest.raises(vertifleet.Error, match="call reset first"):
        parallel.step({})
    parallel.reset(seed=5)
    with pytest.raises(vertifleet.Error, match="aircraft_0, which decides, is missing"):
        parallel.step({"aircraft_1": 0})

"""Days played at once as an environment of stable-baselines3."""

import numpy as np
import pytest

import vertifleet

torch = pytest.importorskip("torch")
pytest.importorskip("sb3_contrib")

from sb3_contrib import MaskablePPO  # noqa: E402
from sb3_contrib.common.maskable.utils import get_action_masks, is_masking_supported  # noqa: E402

from vertifleet.envs import FleetEnv  # noqa: E402
from vertifleet.sb3 import FleetVecEnv  # noqa: E402

# When other programs run, more threads make these small networks slower.
torch.set_num_threads(1)
NETWORK = vertifleet.Network("paper")


def test_parallel_days_are_an_environment_with_masks():
    days = FleetVecEnv(NETWORK, 3)
    days.seed(5)
    observations = days.reset()
    assert is_masking_supported(days)
    for _ in range(50):
        masks = get_action_masks(days)
        assert masks.dtype == bool
        np.testing.assert_array_equal(masks, observations["action_mask"] > 0)
        observations, rewards, over, infos = days.step(masks.argmax(axis=1))
        assert rewards.shape == over.shape == (3,)
        assert rewards.dtype == np.float32
        assert ["summary" in info for info in infos] == over.tolist()
        assert not any(info["invalid_action"] for info in infos)
        for name, column in observations.items():
            assert column.shape == (3, *days.observation_space[name].shape)


def test_parallel_days_have_the_requested_parts_and_split():
    days = FleetVecEnv(NETWORK, 2, observation=["time", "place"], split="validation")
    observations = days.reset()
    assert set(observations) == {"time", "place", "action_mask"}
    # Days of validation have seeds from 2^40 on, and days of training from 2^41 on.
    seeds = [int(day.name.removeprefix("paper-")) for day in days.days.scenarios()]
    assert all(2**40 <= seed < 2**41 for seed in seeds)
    agent = MaskablePPO("MultiInputPolicy", days, n_steps=8, batch_size=8, device="cpu")
    agent.learn(16)


def test_the_same_seed_gives_the_same_days():
    def first(seed):
        days = FleetVecEnv(NETWORK, 2)
        days.seed(seed)
        return days.reset()["nodes"]

    np.testing.assert_array_equal(first(1), first(1))
    assert not np.array_equal(first(1), first(2))
    assert not np.array_equal(first(1)[0], first(1)[1])


def play_until_one_is_over(days):
    """Takes the first feasible action; returns the rewards of each day up to the step in which a day ends."""
    days.seed(2)
    days.reset()
    rewards = []
    while True:
        observations, reward, over, infos = days.step(days.action_masks().argmax(axis=1))
        rewards.append(reward)
        if over.any():
            return observations, np.array(rewards), over, infos


def test_the_next_day_begins_when_one_ends_whose_infos_have_its_reward():
    days = FleetVecEnv(NETWORK, 2, "dense", reward_scale=100.0)
    observations, rewards, over, infos = play_until_one_is_over(days)
    ended = int(over.argmax())
    told = infos[ended]
    assert told["episode"]["l"] == len(rewards)
    assert told["episode"]["r"] == pytest.approx(rewards[:, ended].sum() / 100.0, rel=1e-4)
    assert told["TimeLimit.truncated"] is False
    assert told["terminal_observation"].keys() == observations.keys()
    # The day that ended had no time left; the observation belongs to the new day.
    assert told["terminal_observation"]["clock"] == 0.0
    assert observations["clock"][ended] == 1.0


def test_a_step_leaves_earlier_observations_as_they_were():
    days = FleetVecEnv(NETWORK, 2)
    before = days.reset()
    kept = {name: column.copy() for name, column in before.items()}
    days.step(days.action_masks().argmax(axis=1))
    for name, column in before.items():
        np.testing.assert_array_equal(column, kept[name])


def test_infos_report_infeasible_actions_and_ended_days():
    days = FleetVecEnv(NETWORK, 2, reward_scale=100.0)
    observations = days.reset()
    told = 0
    # In the longest possible day, each of 40 aircraft holds 49 times.
    for _ in range(2100):
        infeasible = observations["action_mask"].argmin(axis=1)
        expected = [not mask[action] for mask, action in zip(days.action_masks(), infeasible, strict=True)]
        observations, rewards, over, infos = days.step(infeasible)
        assert [info["invalid_action"] for info in infos] == expected
        for reward, info in zip(rewards[over], (info for info in infos if "summary" in info), strict=True):
            assert reward == pytest.approx(100.0 * info["summary"]["reward"])
            assert info["episode"]["r"] == info["summary"]["reward"]
            told += 1
    assert told >= 2


def test_given_days_are_played():
    day = NETWORK.draw(3)
    days = FleetVecEnv(NETWORK, 2)
    days.set_options({"scenario": day})
    shown = days.reset()
    single, _ = FleetEnv(NETWORK).reset(options={"scenario": day})
    for row in range(2):
        np.testing.assert_array_equal(shown["nodes"][row], single["nodes"])
    assert not np.array_equal(days.reset()["nodes"][0], single["nodes"]), "options apply to one reset only"


def test_infos_report_the_callers_own_reward():
    def decided(view, outcome):
        assert view.decision.time_s == outcome["time_s"]
        return 1.0

    days = FleetVecEnv(NETWORK, 2, decided, reward_scale=0.5)
    for _ in range(2):
        _, rewards, over, infos = play_until_one_is_over(days)
        for info in (infos[day] for day in np.flatnonzero(over)):
            assert info["episode"]["r"] == info["episode"]["l"] > 100
            assert info["summary"]["reward"] < 1.0
        assert (rewards == 0.5).all()

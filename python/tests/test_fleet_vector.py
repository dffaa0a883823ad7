"""Many days side by side: the same as as many single environments, in all modes of autoreset."""

from __future__ import annotations

import os
import select
import signal
from collections.abc import Iterator
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import vertifleet
from vertifleet.envs import FleetEnv, FleetVectorEnv

MODES = [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP, AutoresetMode.DISABLED]


def same(one: Any, other: Any) -> bool:
    """Whether two infos or observations, arrays of arrays and all, are equal."""
    if isinstance(one, dict):
        return set(one) == set(other) and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list) or (isinstance(one, np.ndarray) and one.dtype == object):
        return len(one) == len(other) and all(same(a, b) for a, b in zip(one, other, strict=True))
    return bool(np.array_equal(one, other))


def actions(masks: np.ndarray, choices: np.random.Generator) -> np.ndarray:
    """Random actions, half of them drawn without looking at the mask."""
    weights = np.where(choices.random((len(masks), 1)) < 0.5, 1.0, masks)
    return (choices.random(masks.shape) * weights).argmax(axis=1)


def lockstep(mode: AutoresetMode, reward: str, steps: int) -> Iterator[tuple[Any, Any]]:
    """What the native environment and Gymnasium's own loop over single ones give, step by step."""
    native = FleetVectorEnv(5, reward=reward, autoreset_mode=mode, threads=2)
    loop = SyncVectorEnv([lambda: FleetEnv(reward=reward)] * 5, autoreset_mode=mode)
    choices = np.random.default_rng(4)
    yield native.reset(seed=11), loop.reset(seed=11)
    masks = loop.reset(seed=11)[1]["action_mask"]
    native.reset(seed=11)
    for _ in range(steps):
        taken = actions(masks, choices)
        one, other = native.step(taken), loop.step(taken)
        yield one, other
        masks = other[4]["action_mask"]
        over = other[2]
        if mode is AutoresetMode.DISABLED and over.any():
            one = native.reset(options={"reset_mask": over.copy()})
            other = loop.reset(options={"reset_mask": over.copy()})
            assert same(one[0], other[0])
            masks = np.where(over[:, None], other[1]["action_mask"], masks)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("reward", ["terminal", "dense"])
def test_the_native_batch_is_a_loop_over_single_environments(mode: AutoresetMode, reward: str) -> None:
    ends = 0
    for (observation, *one), (expected, *other) in lockstep(mode, reward, 1300):
        assert same(observation, expected)
        for mine, theirs in zip(one, other, strict=True):
            assert same(mine, theirs)
        ends += int(one[1].any()) if len(one) == 4 else 0
    assert ends >= 5, "days came to their end meanwhile"


def test_the_number_of_threads_changes_nothing() -> None:
    def played(threads: int) -> list[Any]:
        env = FleetVectorEnv(100, network="disrupted", threads=threads)
        choices = np.random.default_rng(1)
        _, info = env.reset(seed=5)
        outcomes = []
        for _ in range(50):
            observation, rewards, over, _, info = env.step(actions(info["action_mask"], choices))
            outcomes.append([array.copy() for array in (*observation.values(), rewards, over)])
        return outcomes

    assert same(played(1), played(3))


def test_make_vec_gives_the_native_environment() -> None:
    env = gymnasium.make_vec(
        "vertifleet/Fleet-v0", num_envs=3, vectorization_mode="vector_entry_point", network="new-york"
    )
    assert isinstance(env.unwrapped, FleetVectorEnv)
    observation, info = env.reset(seed=1)
    assert env.observation_space.contains(observation)
    assert env.action_space.contains(np.zeros(3, np.int64))
    assert info["action_mask"].shape == (3, env.single_action_space.n)
    assert env.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP


def test_observations_are_not_copied_and_last_for_a_step() -> None:
    env = FleetVectorEnv(4)
    first, info = env.reset(seed=1)
    kept = {key: array.copy() for key, array in first.items()}
    second, *_ = env.step(info["action_mask"].argmax(axis=1))
    assert same(first, kept), "those before a step are there after it"
    third, *_ = env.step(second["action_mask"].argmax(axis=1))
    assert third["nodes"] is first["nodes"], "two sets of arrays take turns"


def test_what_is_handed_out_may_be_changed() -> None:
    env, other = FleetVectorEnv(3), FleetVectorEnv(3)
    for one in (env, other):
        one.reset(seed=1)
    for _ in range(700):
        taken = env.action_masks().argmax(axis=1)
        observation, rewards, over, truncated, info = env.step(taken)
        expected = other.step(taken)
        assert same(over, expected[2])
        assert not truncated.any()
        assert same(rewards, expected[1])
        observation.clear()
        rewards[:], over[:], truncated[:] = 7, True, True
        info["_action_mask"][:] = False
        info["invalid_action"][:] = True


def test_arrays_that_cannot_be_written_to_are_an_error_and_no_panic() -> None:
    env = FleetVectorEnv(2)
    observation, _ = env.reset(seed=1)
    observation["nodes"].setflags(write=False)
    env.step([0, 0])
    with pytest.raises(Exception, match="writeable"):
        env.step([0, 0])


def test_a_given_day_may_be_played_by_all() -> None:
    day = vertifleet.Network("paper").draw(9)
    env = FleetVectorEnv(2)
    expected, _ = FleetEnv().reset(options={"scenario": day})
    observation, _ = env.reset(seed=1, options={"scenario": day})
    for row in range(2):
        assert np.array_equal(observation["nodes"][row], expected["nodes"])
    with pytest.raises(vertifleet.Error, match="vertiports"):
        env.reset(options={"scenario": vertifleet.Network("new-york").draw(1)})


def test_a_process_that_was_forked_plays_on() -> None:
    env = FleetVectorEnv(100, threads=2)
    _, info = env.reset(seed=1)
    taken = info["action_mask"].argmax(axis=1)
    env.step(taken)
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        rewards = env.step(taken)[1]
        os.write(writer, bytes([len(rewards)]))
        os._exit(0)
    ready, _, _ = select.select([reader], [], [], 30)
    if not ready:
        os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    assert ready
    assert os.read(reader, 1) == bytes([100])


def test_masks_agree_in_every_form() -> None:
    env = FleetVectorEnv(4)
    observation, info = env.reset(seed=1)
    assert env.action_masks().dtype == np.bool_
    assert np.array_equal(env.action_masks(), info["action_mask"])
    assert np.array_equal(observation["action_mask"], info["action_mask"])


def test_seeds_may_be_given_one_by_one() -> None:
    env, single = FleetVectorEnv(3), FleetEnv()
    observation, _ = env.reset(seed=[8, 3, 8])
    assert np.array_equal(observation["nodes"][0], observation["nodes"][2])
    assert np.array_equal(observation["nodes"][1], single.reset(seed=3)[0]["nodes"])


def test_what_is_wrong_is_named() -> None:
    env = FleetVectorEnv(2, autoreset_mode=AutoresetMode.DISABLED)
    with pytest.raises(vertifleet.Error, match="call reset"):
        env.step([0, 0])
    with pytest.raises(vertifleet.Error, match="first reset must be of all"):
        env.reset(options={"reset_mask": np.array([True, False])})
    env.reset(seed=1)
    with pytest.raises(vertifleet.Error, match="actions must have 2 entries"):
        env.step([0, 0, 0])
    with pytest.raises(vertifleet.Error, match="whole numbers"):
        env.step([0.5, 0.5])
    for seeds in ([1], [1, 2, 3]):
        with pytest.raises(vertifleet.Error, match="seed must be"):
            env.reset(seed=seeds)
    with pytest.raises(vertifleet.Error, match="threads"):
        FleetVectorEnv(2, threads=0)
    over = np.zeros(2, bool)
    while not over.any():
        _, _, over, _, _ = env.step(env.action_masks().argmax(axis=1))
    with pytest.raises(vertifleet.Error, match="reset_mask"):
        env.step([0, 0])
    with pytest.raises(vertifleet.Error, match="num_envs"):
        FleetVectorEnv(0)

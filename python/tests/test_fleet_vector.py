"""Many days in parallel behave like single environments, in all modes of autoreset."""

from __future__ import annotations

import copy
import os
import select
import signal
import threading
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
    """Whether two infos or observations are equal, including arrays of arrays."""
    if isinstance(one, dict):
        return set(one) == set(other) and all(same(one[key], other[key]) for key in one)
    if isinstance(one, (list, tuple)) or (isinstance(one, np.ndarray) and one.dtype == object):
        return len(one) == len(other) and all(same(a, b) for a, b in zip(one, other, strict=True))
    return bool(np.array_equal(one, other))


def told(info: dict[str, Any]) -> dict[str, Any]:
    """The parts of an info for its environments, and the positions of these environments."""
    said = {key: value[info[f"_{key}"]] for key, value in info.items() if key[0] != "_"}
    return said | {key: value for key, value in info.items() if key[0] == "_"}


def actions(masks: np.ndarray, choices: np.random.Generator) -> np.ndarray:
    """Random actions, half of them drawn regardless of the mask."""
    weights = np.where(choices.random((len(masks), 1)) < 0.5, 1.0, masks)
    return (choices.random(masks.shape) * weights).argmax(axis=1)


def lockstep(mode: AutoresetMode, reward: str, steps: int) -> Iterator[tuple[Any, Any]]:
    """The results, step by step, of the native environment and of Gymnasium's loop over single ones."""
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
            assert same(told(one[1]), told(other[1]))
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
    assert ends >= 5, "several days ended"


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


def test_observations_are_copies_by_default() -> None:
    env = FleetVectorEnv(4)
    handed_out = [env.reset(seed=1)]
    kept = copy.deepcopy(handed_out)
    for _ in range(5):
        handed_out.append(env.step(env.action_masks().argmax(axis=1)))
        kept.append(copy.deepcopy(handed_out[-1]))
    assert same(handed_out, kept)


def test_observations_that_are_not_copied_last_for_a_step() -> None:
    env = FleetVectorEnv(4, copy=False)
    first, info = env.reset(seed=1)
    kept = {key: array.copy() for key, array in first.items()}
    second, *_ = env.step(info["action_mask"].argmax(axis=1))
    assert same(first, kept), "arrays from before a step are unchanged after it"
    third, *_ = env.step(second["action_mask"].argmax(axis=1))
    assert np.shares_memory(third["nodes"], first["nodes"]), "two sets of arrays take turns"


def test_observations_of_steps_outlast_a_reset_of_some() -> None:
    env = FleetVectorEnv(4, autoreset_mode=AutoresetMode.DISABLED, copy=False)
    some = np.array([True, False, True, False])
    handed_out = [env.reset(seed=1), (env.step([1, 2, 3, 4])[0],), env.reset(options={"reset_mask": some})]
    kept = copy.deepcopy(handed_out)
    assert same([shown for shown, *_ in handed_out], [shown for shown, *_ in kept])
    for key, array in handed_out[2][0].items():
        assert np.array_equal(array[~some], handed_out[1][0][key][~some]), "the others are unchanged"
    assert np.array_equal(env.action_masks(), handed_out[2][1]["action_mask"])
    env.step(env.action_masks().argmax(axis=1))
    assert same(handed_out[1][0], kept[1][0]), "arrays from before the step are unchanged after it"
    assert same(handed_out[2], kept[2])
    env.step(env.action_masks().argmax(axis=1))
    assert same(handed_out[2], kept[2]), "arrays of a reset of some last until the next such reset"


def test_days_have_a_name_when_they_begin_and_a_scenario() -> None:
    env = FleetVectorEnv(3, autoreset_mode=AutoresetMode.SAME_STEP)
    assert env.scenarios() == [None] * 3
    _, info = env.reset(seed=1)
    assert [day.name for day in env.scenarios()] == info["day"].tolist()
    choices = np.random.default_rng(1)
    begun = 0
    for _ in range(1300):
        _, _, over, _, info = env.step(actions(info["action_mask"], choices))
        assert ("day" in info) == over.any(), "only the info of a new day has its name"
        if over.any():
            names = [day.name if ended else None for day, ended in zip(env.scenarios(), over, strict=True)]
            assert info["day"].tolist() == names
            assert same(info["_day"], over)
            begun += over.sum()
    assert begun >= 3


def test_returned_arrays_may_be_changed() -> None:
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
        info["_invalid_action"][:] = False
        info["invalid_action"][:] = True


def test_arrays_that_cannot_be_written_to_are_an_error_and_no_panic() -> None:
    env = FleetVectorEnv(2, copy=False)
    env.reset(seed=1)
    env._rows[env._latest].setflags(write=False)
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
    for seeds in ((8, 3, 8), np.array([8, 3, 8]), np.array([8, 3, 8], np.uint8), [8, np.int64(3), None]):
        assert np.array_equal(env.reset(seed=seeds)[0]["nodes"][:2], observation["nodes"][:2])
    assert same(env.reset(seed=np.int64(3))[0], FleetVectorEnv(3).reset(seed=3)[0])


@pytest.mark.parametrize(
    "seed", [1.5, True, "3", [1.5, 2, 3], [True, 2, 3], "123", np.array([1.0, 2, 3]), np.ones((3, 1), int)]
)
def test_a_seed_is_a_whole_number(seed: Any) -> None:
    env = FleetVectorEnv(3)
    with pytest.raises(vertifleet.Error, match="seed must be") as error:
        env.reset(seed=seed)
    assert error.value.code == "V451"


@pytest.mark.parametrize(
    ("mask", "said"),
    [
        (None, "found None"),
        ([True, False, True], "found \\[True"),
        (np.array([1, 0, 1]), "found int64"),
        (np.array([True]), "found bool \\(1,\\)"),
        (np.ones((3, 1), bool), "found bool \\(3, 1\\)"),
        (np.zeros(3, bool), "names no environment"),
    ],
)
def test_a_mask_of_resets_has_a_truth_value_for_each(mask: Any, said: str) -> None:
    env = FleetVectorEnv(3)
    _, info = env.reset(seed=1)
    with pytest.raises(vertifleet.Error, match=f"reset_mask.*{said}") as error:
        env.reset(seed=2, options={"reset_mask": mask})
    assert error.value.code == "V451"
    assert [day.name for day in env.scenarios()] == info["day"].tolist(), "the refused call changed nothing"


@pytest.mark.parametrize("options", [{"scenerio": None}, ["scenario"], {"scenario": "paper"}])
def test_options_that_a_reset_does_not_have_are_refused(options: Any) -> None:
    with pytest.raises(vertifleet.Error, match="option") as error:
        FleetVectorEnv(3).reset(options=options)
    assert error.value.code == "V451"


def test_a_reset_of_some_takes_any_array_of_truth_values_and_keeps_none() -> None:
    env = FleetVectorEnv(3)
    env.reset(seed=1)
    mask = np.array([True, False, False])[::-1]
    _, info = env.reset(options={"reset_mask": mask})
    for key in ("_action_mask", "_invalid_action", "_day"):
        assert np.array_equal(info[key], [False, False, True])
        info[key][:] = True
    assert np.array_equal(mask, [False, False, True])


def test_errors_name_the_argument() -> None:
    env = FleetVectorEnv(2, autoreset_mode=AutoresetMode.DISABLED)
    with pytest.raises(vertifleet.Error, match="call reset"):
        env.step([0, 0])
    with pytest.raises(vertifleet.Error, match="first reset must be of all"):
        env.reset(options={"reset_mask": np.array([True, False])})
    env.reset(seed=1)
    for shape in ((3,), (2, 1), (1, 2), ()):
        with pytest.raises(vertifleet.Error, match="actions must have shape") as error:
            env.step(np.zeros(shape, np.int64))
        assert f"(2,), found {shape}" in error.value.message
    with pytest.raises(vertifleet.Error, match="whole numbers"):
        env.step([0.5, 0.5])
    for seeds in ([1], [1, 2, 3]):
        with pytest.raises(vertifleet.Error, match="seed must be"):
            env.reset(seed=seeds)
    for reward in ("weekly", None):
        with pytest.raises(vertifleet.Error, match="reward must be"):
            FleetVectorEnv(2, reward=reward)
    with pytest.raises(vertifleet.Error, match="threads"):
        FleetVectorEnv(2, threads=0)
    over = np.zeros(2, bool)
    while not over.any():
        _, _, over, _, _ = env.step(env.action_masks().argmax(axis=1))
    with pytest.raises(vertifleet.Error, match="reset_mask"):
        env.step([0, 0])
    with pytest.raises(vertifleet.Error, match="num_envs"):
        FleetVectorEnv(0)


@pytest.mark.parametrize(
    ("arguments", "rule"),
    [
        ({"num_envs": 0}, "num_envs must be from 1 to"),
        ({"num_envs": "four"}, "num_envs must be a whole number"),
        ({"autoreset_mode": "Sometimes"}, "there is no autoreset_mode 'Sometimes'"),
        ({"render_mode": "rgb_array"}, "a batch has no render_mode"),
    ],
)
def test_arguments_that_a_batch_does_not_take_are_named(arguments: dict[str, Any], rule: str) -> None:
    with pytest.raises(vertifleet.Error, match=rule) as error:
        FleetVectorEnv(**{"num_envs": 2, **arguments})
    assert error.value.code == "V451"


def test_a_batch_names_the_environment_that_renders() -> None:
    with pytest.raises(vertifleet.Error, match=r"gymnasium\.make"):
        FleetVectorEnv(2).render()


def test_a_batch_is_used_by_one_thread_at_a_time() -> None:
    envs = FleetVectorEnv(2)
    envs.reset(seed=1)
    found: list[BaseException] = []

    def play() -> None:
        try:
            envs.step(np.zeros(2, np.int64))
        except BaseException as error:
            found.append(error)

    with envs._alone:
        other = threading.Thread(target=play)
        other.start()
        other.join()
    assert ["two threads at once" in str(error) for error in found] == [True]
    play()
    assert len(found) == 1


def test_a_reset_plays_the_days_with_the_numbers_that_are_given() -> None:
    batch, paper = FleetVectorEnv(3, copy=False), vertifleet.Network("paper")

    def names(options: dict[str, Any] | None = None, seed: int | None = None) -> list[str]:
        return list(batch.reset(seed=seed, options=options)[1]["day"])

    def day(number: int) -> str:
        return paper.draw(number, "training").name

    first, second = names(seed=5), names()
    assert names(seed=5) == first
    assert names({"number": 7}) == [day(7)] * 3
    assert names() == second, "a given number draws none"
    assert names({"number": [1, 2, 3]}) == names({"number": np.array([1, 2, 3])}) == [day(1), day(2), day(3)]
    mask = np.array([False, True, False])
    names({"number": 4, "reset_mask": mask})
    assert [one.name for one in batch.scenarios()] == [day(1), day(4), day(3)]
    observation, _ = batch.reset(options={"number": 7})
    expected, _ = FleetEnv().reset(options={"number": 7})
    assert all(np.array_equal(observation[name][2], part) for name, part in expected.items())


@pytest.mark.parametrize("number", [-1, 2**64, 1.5, True, "7", [1, 2], [1, 2, -3], None])
def test_numbers_of_days_are_whole_numbers_one_or_one_for_each(number: Any) -> None:
    batch = FleetVectorEnv(3)
    with pytest.raises(vertifleet.Error, match="option number"):
        batch.reset(options={"number": number})
    with pytest.raises(vertifleet.Error, match="V118"):
        batch.reset(options={"number": 2**63})

"""One day at a time: `vertifleet/Fleet-v0`."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import vertifleet
from vertifleet.envs import FleetEnv, FleetVectorEnv
from vertifleet.envs.days import _warn_once, _warn_once_of_networks

Step = tuple[dict[str, np.ndarray], float, bool, dict[str, object]]


def play(
    env: FleetEnv, seed: int | None, choices: np.random.Generator, infeasible: float = 0.0
) -> list[Step]:
    """Plays a whole day with random actions, a share of them drawn regardless of the mask."""
    _, info = env.reset(seed=seed)
    steps = []
    over = False
    while not over:
        mask = info["action_mask"] if choices.random() >= infeasible else None
        action = env.action_space.start + choices.choice(
            np.flatnonzero(mask if mask is not None else np.ones(8))
        )
        observation, reward, over, truncated, info = env.step(action)
        assert not truncated
        steps.append((observation, reward, over, info))
    return steps


def test_gymnasium_finds_nothing_to_warn_of() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make("vertifleet/Fleet-v0", network="paper", reward="dense").unwrapped)


def test_stable_baselines3_finds_nothing_to_warn_of() -> None:
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        checker.check_env(gymnasium.make("vertifleet/Fleet-v0", reward="terminal").unwrapped)


def test_the_same_seed_gives_the_same_day_and_another_seed_another() -> None:
    env = FleetEnv()

    def first(seed: int | None) -> np.ndarray:
        observation, _ = env.reset(seed=seed)
        return observation["nodes"]

    assert np.array_equal(first(3), first(3))
    later = first(None)
    assert not np.array_equal(later, first(3)), "a reset without a seed continues the random numbers"
    assert np.array_equal(later, first(None)), "the same state leads to the same day"
    assert not np.array_equal(first(3), first(4))


def test_all_randomness_is_from_np_random() -> None:
    env = FleetEnv()
    env.reset(seed=1)
    env.np_random = np.random.default_rng(5)
    expected = int(np.random.default_rng(5).integers(2**52))
    env.reset()
    seed = vertifleet.Network("paper").draw(expected, "training").seed
    assert env.scenario.name == f"paper-{seed}"


def test_the_day_has_a_name_and_a_scenario(day: vertifleet.Scenario) -> None:
    env = FleetEnv()
    assert (env.scenario, env.aircraft, env.time_s) == (None, None, None)
    _, info = env.reset(seed=1)
    assert info["day"] == env.scenario.name
    assert info["day"] == f"paper-{env.scenario.seed}"
    assert (env.aircraft, env.time_s) == (0, int(env.scenario.periods_s[0]))
    assert "day" not in env.step(0)[4], "only the info of a reset has the day"
    _, info = env.reset(options={"scenario": day})
    assert info["day"] == day.name
    assert env.scenario.to_json() == day.to_json()


def test_a_process_that_has_not_imported_the_package_can_name_its_module() -> None:
    code = "import gymnasium; gymnasium.make('vertifleet:vertifleet/Fleet-v0', network='paper').reset(seed=1)"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_mask_is_the_same_in_every_form() -> None:
    env = FleetEnv()
    choices = np.random.default_rng(1)
    _, info = env.reset(seed=1)
    for _ in range(300):
        observation, _, _, _, info = env.step(choices.choice(np.flatnonzero(info["action_mask"])))
        masks = env.action_masks()
        assert masks.dtype == np.bool_
        assert info["action_mask"].dtype == np.int8
        assert np.array_equal(masks, info["action_mask"])
        assert np.array_equal(masks, observation["action_mask"])
        assert masks.any()


def test_an_infeasible_action_holds_and_sets_invalid_action(day: vertifleet.Scenario) -> None:
    infeasible, holding = FleetEnv(), FleetEnv()
    _, info = infeasible.reset(options={"scenario": day})
    holding.reset(options={"scenario": day})
    held = 0
    for step in range(400):
        closed = np.flatnonzero(info["action_mask"] == 0)
        at = int(np.flatnonzero(infeasible.action_masks())[step % infeasible.action_masks().sum()])
        action = int(closed[0]) if closed.size else at
        own = holding.view.decision.place
        one = infeasible.step(action)
        other = holding.step(own if closed.size else at)
        info = one[4]
        assert info["invalid_action"] is bool(closed.size)
        assert other[4]["invalid_action"] is False
        for key, array in one[0].items():
            assert np.array_equal(array, other[0][key])
        held += bool(closed.size)
        if one[2]:
            break
    assert held > 20
    for action in (-1, 8, 10**6, -(2**63), np.array(8)):
        infeasible.reset(options={"scenario": day})
        assert infeasible.step(action)[4]["invalid_action"]


def test_dense_rewards_add_up_to_the_terminal_one() -> None:
    dense = play(FleetEnv(reward="dense"), 7, np.random.default_rng(2))
    terminal = play(FleetEnv(reward="terminal"), 7, np.random.default_rng(2))
    assert all(reward == 0 for _, reward, over, _ in terminal if not over)
    assert len(dense) == len(terminal)
    assert sum(reward for _, reward, _, _ in dense) == pytest.approx(terminal[-1][1], abs=1e-12)
    summary = terminal[-1][3]["summary"]
    assert terminal[-1][1] == summary["reward"] == summary["profit_usd"] / summary["potential_usd"]


@pytest.mark.parametrize("network", ["paper", "disrupted", "new-york"])
def test_the_decisions_of_a_policy_earn_what_simulate_returns(network: str) -> None:
    day = vertifleet.Network(network).draw(5)
    played = vertifleet.simulate(day, "greedy")
    env = FleetEnv(network)
    env.reset(options={"scenario": day})
    trace = played.trace.columns
    over = False
    for step in range(len(played.trace)):
        assert not over
        assert env.aircraft == trace["aircraft"][step]
        assert env.time_s == trace["time"][step]
        _, _, over, _, info = env.step(trace["to"][step])
        assert not info["invalid_action"]
    assert over
    assert info["summary"] == played.summary


def test_observations_are_within_their_space_for_any_actions() -> None:
    env = FleetEnv("disrupted")
    size = len(env.network.vertiports)
    choices = np.random.default_rng(3)
    _, info = env.reset(seed=2)
    for _ in range(3000):
        observation, _, over, _, info = env.step(choices.integers(size))
        assert env.observation_space.contains(observation)
        if over:
            assert observation["clock"] == 0
            assert info["action_mask"].sum() == 1
            env.reset()


def test_adjacency_has_the_pairs_that_can_be_flown(day: vertifleet.Scenario) -> None:
    env = FleetEnv()
    observation, _ = env.reset(options={"scenario": day})
    assert np.array_equal(observation["adjacency"].reshape(8, 8), 1 - np.eye(8))
    near = vertifleet.Network("paper").changed({"aircraft_types.0.battery_kwh": 50.0})
    env = FleetEnv(near)
    observation, _ = env.reset(seed=1)
    distances = near.draw(1).distance_mi
    expected = (distances * 2.2 <= 50.0) & ~np.eye(8, dtype=bool)
    assert 0 < expected.sum() < 56
    assert np.array_equal(observation["adjacency"].reshape(8, 8), expected)


def test_errors_name_the_argument() -> None:
    for reward in ("weekly", "Dense", None):
        with pytest.raises(vertifleet.Error, match="reward must be") as error:
            FleetEnv(reward=reward)
        assert error.value.code == "V451"
    with pytest.raises(vertifleet.Error, match="call reset"):
        FleetEnv().step(0)
    with pytest.raises(vertifleet.Error) as error:
        FleetEnv("nowhere")
    assert error.value.code == "V119"
    other = vertifleet.Network("new-york").draw(1)
    with pytest.raises(vertifleet.Error, match="vertiports"):
        FleetEnv("paper").reset(options={"scenario": other})


@pytest.mark.parametrize(
    "action", [0.7, np.float64(2), "3", True, np.True_, None, np.array([3]), 2**63, -(2**63) - 1, 10**30]
)
def test_an_action_is_a_whole_number(action: Any) -> None:
    env = FleetEnv()
    _, info = env.reset(seed=1)
    with pytest.raises(vertifleet.Error, match="action must be a whole number") as error:
        env.step(action)
    assert error.value.code == "V451"
    assert np.array_equal(env.action_masks(), info["action_mask"])
    assert env.aircraft == 0, "the refused call changed nothing"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"scenerio": None}, "no option 'scenerio'"),
        ({"reset_mask": np.ones(1, bool)}, "no option 'reset_mask'"),
        (["scenario"], "must be a dict"),
        ({"scenario": "paper"}, "must be a vertifleet.Scenario"),
    ],
)
def test_options_that_a_reset_does_not_have_are_refused(options: Any, said: str) -> None:
    env = FleetEnv()
    _, info = env.reset(seed=1)
    with pytest.raises(vertifleet.Error, match=said) as error:
        env.reset(seed=2, options=options)
    assert error.value.code == "V451"
    assert (env.scenario.name, env.np_random_seed) == (info["day"], 1), "the refused call changed nothing"


def test_a_day_that_is_over_must_be_followed_by_a_reset() -> None:
    env = FleetEnv()
    play(env, 1, np.random.default_rng(1))
    with pytest.raises(vertifleet.Error, match="call reset"):
        env.step(0)


def test_a_network_object_may_be_passed_and_travels() -> None:
    network = pickle.loads(pickle.dumps(vertifleet.Network("paper").changed({"fleet.0.count": 12})))
    env = gymnasium.make("vertifleet/Fleet-v0", network=network)
    assert env.unwrapped.network.fleet_size == 12


def test_copies_share_only_immutable_members() -> None:
    class Noted(FleetEnv):
        notes: list[str]

    env = Noted()
    env.notes = []
    env.reset(seed=4)
    for other in (copy.copy(env), copy.deepcopy(env)):
        assert isinstance(other, Noted)
        assert other.network is env.network
        assert other.observation_space is env.observation_space
        assert other.action_space is env.action_space
        assert other.notes is not env.notes
        while not other.step(0)[2]:
            pass
        other.reset()
        assert env.time_s == env.scenario.periods_s[0], "the copy plays a separate day"
    assert copy.copy(env).reset()[1]["day"] == env.reset()[1]["day"], "the copy draws the same next day"


def test_a_wrapped_environment_is_copied_deep() -> None:
    env = gymnasium.make("vertifleet/Fleet-v0", network=vertifleet.Network("paper"))
    env.reset(seed=1)
    other = copy.deepcopy(env)
    assert other.unwrapped.network is env.unwrapped.network
    other.step(0)
    assert (env.unwrapped.aircraft, other.unwrapped.aircraft) == (0, 1)


COPIES = {"copy": copy.copy, "deepcopy": copy.deepcopy, "pickle": lambda env: pickle.loads(pickle.dumps(env))}


@pytest.mark.parametrize("how", COPIES)
def test_a_copy_in_the_middle_of_a_day_goes_on_as_the_day_would(how: str) -> None:
    env = FleetEnv("disrupted", "dense")
    choices = np.random.default_rng(8)
    _, info = env.reset(seed=4)
    for _ in range(150):
        _, _, _, _, info = env.step(choices.choice(np.flatnonzero(info["action_mask"])))
    other = COPIES[how](env)
    over = False
    while not over:
        action = choices.choice(np.flatnonzero(info["action_mask"]))
        (observation, reward, over, _, info), expected = env.step(action), other.step(action)
        assert reward == expected[1]
        for key, array in observation.items():
            assert np.array_equal(array, expected[0][key])
    assert info["summary"] == expected[4]["summary"]
    assert np.array_equal(env.reset()[0]["nodes"], other.reset()[0]["nodes"]), "the same next day follows"


def test_infos_name_the_split_of_a_day() -> None:
    env = gymnasium.make("vertifleet/Fleet-v0", split="validation")
    assert env.reset(seed=1)[1]["split"] == "validation"
    day = vertifleet.Network("paper").draw(1)
    _warn_once.cache_clear()
    with pytest.warns(UserWarning, match="comparison days"):
        assert env.reset(options={"scenario": day})[1]["split"] == day.split == "comparison"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env.reset(options={"scenario": day})
    assert vertifleet.Network("paper").draw(1, "training").split == "training"


def test_the_days_of_a_comparison_network_are_comparison_days_whatever_their_split() -> None:
    _warn_once_of_networks.cache_clear()
    with pytest.warns(UserWarning, match="comparison network"):
        env = FleetEnv("random:7")
    assert env.reset(seed=1)[1]["split"] == "comparison"
    assert env.scenario is not None
    assert env.scenario.seed >= 2**41
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert FleetEnv("random-training:7").reset(seed=1)[1]["split"] == "training"
        assert FleetEnv("random-validation:7", split="validation").reset(seed=1)[1]["split"] == "validation"
        assert FleetEnv("random-places-training:8:7").reset(seed=1)[1]["split"] == "training"
        batch = FleetVectorEnv(2, ["random-training:1", "random-training:2"], observation="full")
        assert set(batch.reset(seed=1)[1]["split"]) == {"training"}
    with pytest.warns(UserWarning, match="validation network"):
        assert FleetEnv("random-validation:7").reset(seed=1)[1]["split"] == "validation"
    names = ["random:7", "random-places:8:7", "random-validation:7", "random-training:7", "paper"]
    splits = ["comparison", "comparison", "validation", "training", None]
    assert [vertifleet.Network(name).split for name in names] == splits
    written = vertifleet.Network.from_toml(vertifleet.Network("random:7").toml)
    assert written.split == written.draw(0, "training").split == "comparison"


def learn_by_dataset(_folder: Path) -> None:
    vertifleet.dataset("greedy", 1, network="random:7")


def learn_by_pettingzoo(_folder: Path) -> None:
    pytest.importorskip("pettingzoo")
    from vertifleet import pettingzoo

    pettingzoo.env("random:7")


def learn_by_train(folder: Path) -> None:
    settings = {"total_steps": 64, "n_envs": 1, "n_steps": 64, "batch_size": 64, "eval_days": 1}
    vertifleet.train("random-places:8:7", "mlp", out=folder, settings=settings)


@pytest.mark.parametrize("learn", [learn_by_dataset, learn_by_pettingzoo, learn_by_train])
def test_what_learns_on_a_comparison_network_warns(learn: Callable[[Path], None], tmp_path: Path) -> None:
    _warn_once_of_networks.cache_clear()
    with pytest.warns(UserWarning, match="comparison network"):
        learn(tmp_path)


def test_texts_in_infos_survive_a_conversion_to_tensors() -> None:
    pytest.importorskip("torch")
    pytest.importorskip("array_api_compat")
    from gymnasium.wrappers import NumpyToTorch

    env = NumpyToTorch(gymnasium.make("vertifleet/Fleet-v0"))
    _, info = env.reset(seed=1)
    assert info["day"] == env.unwrapped.scenario.name
    over = False
    while not over:
        _, _, over, _, info = env.step(int(np.asarray(info["action_mask"]).argmax()))
    profit_usd = env.unwrapped._environment.summary["profit_usd"]
    assert float(info["summary"]["profit_usd"]) == pytest.approx(profit_usd, rel=1e-6)


def test_texts_and_objects_in_infos_of_a_batch_survive_a_conversion_to_tensors() -> None:
    torch = pytest.importorskip("torch")
    pytest.importorskip("array_api_compat")
    from gymnasium.wrappers.vector import NumpyToTorch

    batch = FleetVectorEnv(2, autoreset_mode="SameStep")
    env = NumpyToTorch(batch)
    observation, info = env.reset(seed=1)
    assert isinstance(observation["nodes"], torch.Tensor)
    assert info["day"].tolist() == [day.name for day in batch.scenarios()]
    ended = 0
    while ended < 2:
        observation, reward, over, _, info = env.step(info["action_mask"].to(torch.int64).argmax(1))
        assert isinstance(reward, torch.Tensor)
        for day in over.nonzero().flatten().tolist():
            ended += 1
            assert isinstance(info["final_obs"][day]["nodes"], torch.Tensor)
            assert info["final_info"]["summary"]["profit_usd"][day] != 0
            assert info["day"][day] == batch.scenarios()[day].name


def test_a_reset_takes_a_scenario_or_a_number() -> None:
    day = vertifleet.Network("paper").draw(7, "training")
    options = {"scenario": day, "number": 7}
    for env in (FleetEnv(), FleetVectorEnv(2)):
        with pytest.raises(vertifleet.Error, match="not both"):
            env.reset(options=options)


def test_a_copy_shares_the_source_of_its_days() -> None:
    env = FleetEnv()
    env.reset(seed=3)
    for how in (copy.copy, copy.deepcopy):
        other = how(env)
        assert other._days is env._days
        assert other.np_random is not env.np_random
        assert other.np_random.bit_generator.state == env.np_random.bit_generator.state
        assert other.np_random.spawn(1)[0].integers(2**60) == how(env).np_random.spawn(1)[0].integers(2**60)
        assert other.reset()[1]["day"] == how(env).reset()[1]["day"]


def test_a_view_lists_its_members() -> None:
    env = FleetEnv("paper")
    env.reset(seed=1)
    assert {"action_mask", "choice_profit_usd", "decision"} <= set(dir(env.view))
    assert repr(env.view).startswith("<View of decision 0 at 06:00:00: aircraft 0 at vertiport ")


@pytest.mark.parametrize("returned", [None, "V1", 1.5, [1]])
def test_an_invalid_return_value_of_a_policy_is_named(returned: object) -> None:
    def mine(_observation: object) -> object:
        return returned

    with pytest.raises(vertifleet.Error, match=r"V451.*cannot use the choice of policy .*mine") as error:
        vertifleet.compare("paper", ["mine"], days=1, models={"mine": mine})
    assert repr(returned) in str(error.value)

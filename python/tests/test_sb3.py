"""Training with stable-baselines3: MaskablePPO trains the network, and the program decides with it."""

import math

import gymnasium
import numpy as np
import pytest

import vertifleet

torch = pytest.importorskip("torch")
pytest.importorskip("sb3_contrib")

from sb3_contrib import MaskablePPO  # noqa: E402
from sb3_contrib.common.maskable.utils import get_action_masks, is_masking_supported  # noqa: E402
from stable_baselines3.common.vec_env import DummyVecEnv, VecMonitor, VecNormalize  # noqa: E402

from vertifleet import Error, Network  # noqa: E402
from vertifleet.envs import FleetEnv  # noqa: E402
from vertifleet.sb3 import FleetVecEnv, GcapsPolicy, MlpPolicy, export, ppo_settings  # noqa: E402
from vertifleet.torch import Gcaps, Mlp, act, load, masked  # noqa: E402

NETWORK = vertifleet.Network("paper")
POLICIES = {
    "gcaps": (GcapsPolicy, Gcaps, {"width": 32, "heads": 2}),
    "mlp": (MlpPolicy, Mlp, {"width": 32, "layers": 1, "value_width": 16}),
}


def learner(kind, days, **changed):
    """A small learner; its settings are those of the program but for the sizes and what is changed."""
    policy, _, sizes = POLICIES[kind]
    settings = ppo_settings(vertifleet.settings("default")) | {"n_steps": 32, "batch_size": 64} | changed
    policy_kwargs = {"features_extractor_kwargs": sizes}
    return MaskablePPO(policy, days, **settings, seed=3, policy_kwargs=policy_kwargs, device="cpu")


def tensors(observations):
    return {name: torch.from_numpy(column) for name, column in observations.items()}


def test_days_side_by_side_are_an_environment_with_masks():
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


def test_the_same_seed_gives_the_same_days():
    def first(seed):
        days = FleetVecEnv(NETWORK, 2)
        days.seed(seed)
        return days.reset()["nodes"]

    np.testing.assert_array_equal(first(1), first(1))
    assert not np.array_equal(first(1), first(2))
    assert not np.array_equal(first(1)[0], first(1)[1])


def play_until_one_is_over(days):
    """Holds or flies, whatever is feasible first; rewards of each day up to the step in which a day ends."""
    days.seed(2)
    days.reset()
    rewards = []
    while True:
        observations, reward, over, infos = days.step(days.action_masks().argmax(axis=1))
        rewards.append(reward)
        if over.any():
            return observations, np.array(rewards), over, infos


def test_a_day_that_is_over_makes_room_for_the_next_and_tells_how_it_went():
    days = FleetVecEnv(NETWORK, 2, "dense", reward_scale=100.0)
    observations, rewards, over, infos = play_until_one_is_over(days)
    ended = int(over.argmax())
    told = infos[ended]
    assert told["episode"]["l"] == len(rewards)
    assert told["episode"]["r"] == pytest.approx(rewards[:, ended].sum() / 100.0, rel=1e-4)
    assert told["TimeLimit.truncated"] is False
    assert told["terminal_observation"].keys() == observations.keys()
    # The day that was over had no time left; the one that is shown is new.
    assert told["terminal_observation"]["clock"] == 0.0
    assert observations["clock"][ended] == 1.0


def test_a_step_leaves_earlier_observations_as_they_were():
    days = FleetVecEnv(NETWORK, 2)
    before = days.reset()
    kept = {name: column.copy() for name, column in before.items()}
    days.step(days.action_masks().argmax(axis=1))
    for name, column in before.items():
        np.testing.assert_array_equal(column, kept[name])


@pytest.mark.parametrize("kind", POLICIES)
def test_the_network_is_all_that_has_weights_and_starts_as_it_would_alone(kind):
    _, twin, sizes = POLICIES[kind]
    model = learner(kind, FleetVecEnv(NETWORK, 2))
    trained = model.policy.optimizer.param_groups[0]["params"]
    assert {id(weight) for weight in trained} == {id(weight) for weight in model.policy.twin.parameters()}
    torch.manual_seed(3)
    alone = twin(8, **sizes).state_dict()
    for name, tensor in model.policy.twin.state_dict().items():
        assert torch.equal(tensor, alone[name]), name


@pytest.mark.parametrize("kind", POLICIES)
def test_what_is_optimised_is_the_network(kind):
    days = FleetVecEnv(NETWORK, 4)
    model = learner(kind, days)
    seen = tensors(days.reset())
    masks = days.action_masks()
    actions = torch.from_numpy(masks.argmax(axis=1))
    logits, values = model.policy.twin(seen["nodes"], seen["aircraft"], seen["clock"])
    log_probabilities = masked(logits, torch.from_numpy(masks)).log_softmax(-1)
    probabilities = log_probabilities.exp()
    entropies = -(probabilities * log_probabilities.masked_fill(probabilities == 0, 0.0)).sum(-1)
    found = model.policy.evaluate_actions(seen, actions, action_masks=masks)
    torch.testing.assert_close(found[0].flatten(), values)
    torch.testing.assert_close(found[1], log_probabilities.gather(1, actions[:, None]).flatten())
    torch.testing.assert_close(found[2], entropies)
    torch.testing.assert_close(model.policy.predict_values(seen).flatten(), values)


@pytest.mark.parametrize("kind", POLICIES)
def test_what_was_trained_decides_in_the_program_as_it_does_here(kind, tmp_path):
    path = tmp_path / "trained.safetensors"
    days = FleetVecEnv(NETWORK, 4, "dense", reward_scale=100.0)
    model = learner(kind, days)
    first = {name: tensor.clone() for name, tensor in model.policy.twin.state_dict().items()}
    model.learn(300)
    assert all(
        not torch.equal(tensor, first[name]) for name, tensor in model.policy.twin.state_dict().items()
    )
    export(model, path, network=NETWORK)

    day, twin = NETWORK.draw(1), load(path)
    decided = vertifleet.simulate(day, policy=kind, model=path).trace.columns["to"]
    environment = gymnasium.make("vertifleet/Fleet-v0", network=NETWORK)
    seen, _ = environment.reset(options={"scenario": day})
    for decision in decided:
        masks = environment.unwrapped.action_masks()
        choice, _ = model.predict(seen, deterministic=True, action_masks=masks)
        assert choice == decision == act(twin, seen)
        seen, *_ = environment.step(int(choice))


def test_a_weight_file_says_what_it_was_trained_with(tmp_path):
    path = tmp_path / "trained.safetensors"
    days = FleetVecEnv(NETWORK, 4, "dense", reward_scale=100.0)
    model = learner("mlp", days)
    model.learn(200)
    export(model, path, network=NETWORK)
    header = load(path).header
    assert (header["network"], header["seed"], header["steps"]) == ("paper", 3, 256)
    like = vertifleet.settings("default") | {"total_steps": 200, "n_envs": 4, "n_steps": 32, "batch_size": 64}
    same = {name: value for name, value in header["settings"].items() if not name.startswith("eval_")}
    assert same == {name: like[name] for name in same}


def test_a_wrapped_batch_trains_as_well(tmp_path):
    model = learner("mlp", VecMonitor(FleetVecEnv("paper", 2, "dense")))
    model.learn(64)
    export(model, tmp_path / "trained.safetensors", network=NETWORK)
    settings = load(tmp_path / "trained.safetensors").header["settings"]
    assert (settings["reward"], settings["reward_scale"], settings["n_envs"]) == ("dense", 1.0, 2)


def test_single_environments_train_as_well():
    days = DummyVecEnv([lambda: gymnasium.make("vertifleet/Fleet-v0", network="paper", reward="dense")])
    model = learner("mlp", days)
    first = model.policy.twin.logits.weight.clone()
    model.learn(64)
    assert not torch.equal(model.policy.twin.logits.weight, first)


def test_a_learner_is_saved_and_loaded_whole(tmp_path):
    days = FleetVecEnv(NETWORK, 2)
    model = learner("gcaps", days)
    model.learn(64)
    model.save(tmp_path / "model.zip")
    again = MaskablePPO.load(tmp_path / "model.zip", env=days)
    for name, tensor in model.policy.twin.state_dict().items():
        assert torch.equal(again.policy.twin.state_dict()[name], tensor)


def test_a_policy_of_another_kind_and_one_without_days_have_no_weight_file(tmp_path):
    days = FleetVecEnv(NETWORK, 2)
    other = MaskablePPO("MultiInputPolicy", days, n_steps=8, batch_size=8)
    learner("gcaps", days).save(tmp_path / "model.zip")
    without_days = MaskablePPO.load(tmp_path / "model.zip")
    for model in (other, without_days):
        with pytest.raises(vertifleet.Error) as refused:
            export(model, tmp_path / "weights.safetensors", network=NETWORK)
        assert refused.value.code == "V451"


def test_the_paper_settings_are_table_2():
    settings = vertifleet.settings("paper")
    found = ppo_settings(settings)
    assert settings["n_envs"] * found["n_steps"] == 20_000
    assert (found["batch_size"], found["n_epochs"], found["learning_rate"]) == (10_000, 100, 1e-6)
    assert (found["ent_coef"], found["vf_coef"], found["gamma"]) == (0.01, 0.5, 1.0)


def test_a_falling_learning_rate_falls_to_nothing():
    rate = ppo_settings(vertifleet.settings("default"))["learning_rate"]
    assert [rate(left) for left in (1.0, 0.5, 0.0)] == pytest.approx([4e-4, 2e-4, 0.0])
    assert not math.isnan(rate(0.25))


def test_infeasible_actions_and_ended_days_are_told():
    days = FleetVecEnv(NETWORK, 2, reward_scale=100.0)
    observations = days.reset()
    told = 0
    # 49 holds of each of 40 aircraft are the longest day.
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
    assert not np.array_equal(days.reset()["nodes"][0], single["nodes"]), "options count once"


def test_what_the_program_would_not_do_is_not_exported(tmp_path):
    days = VecNormalize(FleetVecEnv("paper", 2), norm_obs_keys=["nodes"])
    model = MaskablePPO(GcapsPolicy, days, n_steps=8, batch_size=16)
    with pytest.raises(Error, match="VecNormalize") as error:
        export(model, tmp_path / "mine.safetensors", network=Network("paper"))
    assert error.value.code == "V451"
    model = MaskablePPO(GcapsPolicy, FleetVecEnv("random:7", 2), n_steps=8, batch_size=16)
    with pytest.raises(Error, match="trained on network"):
        export(model, tmp_path / "mine.safetensors", network=Network("paper"))

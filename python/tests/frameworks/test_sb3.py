"""Training with stable-baselines3: MaskablePPO trains the network, and the program decides with it."""

import math
import os
import subprocess
import sys
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import vertifleet

torch = pytest.importorskip("torch")
pytest.importorskip("sb3_contrib")

from gymnasium.wrappers import FlattenObservation  # noqa: E402
from sb3_contrib import MaskablePPO  # noqa: E402
from sb3_contrib.common.maskable.callbacks import MaskableEvalCallback  # noqa: E402
from sb3_contrib.common.maskable.evaluation import evaluate_policy  # noqa: E402
from stable_baselines3.common.evaluation import evaluate_policy as evaluate_without_masks  # noqa: E402
from stable_baselines3.common.utils import LinearSchedule  # noqa: E402
from stable_baselines3.common.vec_env import DummyVecEnv, VecMonitor, VecNormalize  # noqa: E402

from vertifleet import Error, Network  # noqa: E402
from vertifleet.envs import VARIANTS, FleetEnv  # noqa: E402
from vertifleet.sb3 import FleetVecEnv, GcapsPolicy, MlpPolicy, export, ppo_settings  # noqa: E402
from vertifleet.torch import Gcaps, Mlp, act, load, masked  # noqa: E402

# When other programs run, more threads make these small networks slower.
torch.set_num_threads(1)
NETWORK = vertifleet.Network("paper")
POLICIES = {
    "gcaps": (GcapsPolicy, Gcaps, {"width": 32, "heads": 2}),
    "mlp": (MlpPolicy, Mlp, {"width": 32, "layers": 1, "value_width": 16}),
}


def learner(kind, days, **changed):
    """A small learner with the settings of the program, except for the sizes and the given changes."""
    policy, _, sizes = POLICIES[kind]
    settings = ppo_settings(vertifleet.settings("default")) | {"n_steps": 32, "batch_size": 64} | changed
    policy_kwargs = {"features_extractor_kwargs": sizes}
    return MaskablePPO(policy, days, **settings, seed=3, policy_kwargs=policy_kwargs, device="cpu")


def tensors(observations):
    return {name: torch.from_numpy(column) for name, column in observations.items()}


@pytest.mark.parametrize("variant", VARIANTS)
def test_the_default_policy_learns_from_every_registered_observation(variant):
    days = gymnasium.make(variant)
    agent = MaskablePPO("MultiInputPolicy", days, n_steps=8, batch_size=8, device="cpu")
    agent.learn(8)
    observation, info = days.reset(seed=1)
    choice, _ = agent.predict(observation, action_masks=info["action_mask"].astype(bool))
    assert info["action_mask"][choice] == 1


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


def test_a_weight_file_contains_its_training_settings(tmp_path):
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


@pytest.mark.filterwarnings("ignore:The environment is already wrapped with a `Monitor`")
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
    assert (settings["n_envs"], found["n_steps"]) == (1, 20_000)
    assert (found["batch_size"], found["n_epochs"], found["learning_rate"]) == (10_000, 100, 1e-6)
    assert (found["ent_coef"], found["vf_coef"], found["gamma"]) == (0.01, 0.5, 1.0)


def test_a_falling_learning_rate_falls_to_nothing():
    rate = ppo_settings(vertifleet.settings("default"))["learning_rate"]
    assert [rate(left) for left in (1.0, 0.5, 0.0)] == pytest.approx([4e-4, 2e-4, 0.0])
    assert not math.isnan(rate(0.25))


def test_what_the_program_would_not_do_is_not_exported(tmp_path):
    days = VecNormalize(FleetVecEnv("paper", 2), norm_obs_keys=["nodes"])
    model = MaskablePPO(GcapsPolicy, days, n_steps=8, batch_size=16)
    with pytest.raises(Error, match="VecNormalize") as error:
        export(model, tmp_path / "mine.safetensors", network=Network("paper"))
    assert error.value.code == "V451"
    model = MaskablePPO(GcapsPolicy, FleetVecEnv("random-training:7", 2), n_steps=8, batch_size=16)
    with pytest.raises(Error, match="trained on network"):
        export(model, tmp_path / "mine.safetensors", network=Network("paper"))


def header_after(model, path, **arguments):
    export(model, path, **arguments)
    return vertifleet.Model.read(path).header


def learned(kind="mlp", steps=64, days=None, **changed):
    model = learner(kind, FleetVecEnv(NETWORK, 2) if days is None else days, **changed)
    return model.learn(steps)


def test_headers_have_plain_numbers_for_numbers_of_any_type(tmp_path):
    days = FleetVecEnv(NETWORK, 2, reward_scale=np.float32(3.0))
    numbers = {"n_steps": np.int64(32), "gamma": np.float32(0.9), "batch_size": np.int32(16)}
    model = learned(steps=1e2, days=days, **numbers)
    model.seed = np.int64(7)
    header = header_after(model, tmp_path / "mine.safetensors")
    said = {name: header["settings"][name] for name in ("total_steps", "n_steps", "gamma", "reward_scale")}
    assert said == {"total_steps": 100, "n_steps": 32, "gamma": pytest.approx(0.9), "reward_scale": 3.0}
    assert header["seed"] == 7


UNSAYABLE = {
    "no bound on gradients": {"max_grad_norm": math.inf},
    "a negative entropy bonus": {"ent_coef": -0.01},
    "a rate that falls to half": {"learning_rate": LinearSchedule(4e-4, end=2e-4, end_fraction=1.0)},
    "a rate that falls early": {"learning_rate": LinearSchedule(4e-4, end=0.0, end_fraction=0.5)},
    "a rate that falls in a curve": {"learning_rate": lambda left: 4e-4 * left * left},
    "a falling clip range": {"clip_range": LinearSchedule(0.2, end=0.1, end_fraction=1.0)},
    "values clipped": {"clip_range_vf": 0.2},
    "an end to steps": {"target_kl": 0.01},
    "advantages as they are": {"normalize_advantage": False},
}


@pytest.mark.parametrize("how", UNSAYABLE)
def test_a_run_that_no_setting_describes_has_no_settings(how, tmp_path):
    header = header_after(learned(**UNSAYABLE[how]), tmp_path / "mine.safetensors")
    assert header["settings"] is None
    assert (header["seed"], header["steps"]) == (3, 64)


def test_a_run_without_a_seed_has_none(tmp_path):
    model = learned()
    model.seed = None
    assert header_after(model, tmp_path / "mine.safetensors")["seed"] is None


def test_normalised_rewards_have_no_settings_and_rewards_as_they_are_have(tmp_path):
    for norm_reward in (True, False):
        days = VecNormalize(FleetVecEnv(NETWORK, 2), norm_obs=False, norm_reward=norm_reward)
        settings = header_after(learned(days=days), tmp_path / "mine.safetensors")["settings"]
        assert (settings is None) == norm_reward


def test_a_loaded_model_has_no_settings_until_it_learns(tmp_path):
    learned().save(tmp_path / "model.zip")
    days = FleetVecEnv(NETWORK, 2, "dense", reward_scale=50.0)
    again = MaskablePPO.load(tmp_path / "model.zip", env=days)
    assert header_after(again, tmp_path / "mine.safetensors")["settings"] is None
    again.learn(64)
    settings = header_after(again, tmp_path / "mine.safetensors")["settings"]
    assert (settings["reward"], settings["reward_scale"]) == ("dense", 50.0)


def test_a_rate_that_fell_twice_has_no_schedule(tmp_path):
    falling, constant = learned(), learned(learning_rate=1e-4)
    for model in (falling, constant):
        model.learn(64, reset_num_timesteps=False)
    assert header_after(falling, tmp_path / "falling.safetensors")["settings"] is None
    assert header_after(constant, tmp_path / "constant.safetensors")["settings"]["lr_schedule"] == "constant"


def test_the_network_is_the_one_trained_on_and_may_be_named(tmp_path):
    model, file = learned(), tmp_path / "paper.toml"
    file.write_text(NETWORK.toml)
    for arguments in ({}, {"network": "paper"}, {"network": file}, {"network": NETWORK}):
        assert header_after(model, tmp_path / "mine.safetensors", **arguments)["network"] == "paper"


def test_refusals_name_the_difference_and_the_remedy(tmp_path):
    model, path = learned(), tmp_path / "mine.safetensors"
    with pytest.raises(Error, match="texts of their files differ"):
        export(model, path, network=NETWORK.changed({"fleet.0.count": 30}))
    model.save(tmp_path / "model.zip")
    with pytest.raises(Error, match=r"MaskablePPO\.load\(path, env=FleetVecEnv"):
        export(MaskablePPO.load(tmp_path / "model.zip"), path)
    assert not path.exists()


def test_newly_trained_weights_drop_the_settings_of_their_file(tmp_path):
    model, path = learned(max_grad_norm=math.inf), tmp_path / "mine.safetensors"
    model.policy.twin.header = vertifleet.Model.shipped("mlp").header
    header = header_after(model, path)
    assert (header["settings"], header["seed"], header["steps"]) == (None, 3, 64)


@pytest.mark.parametrize("kind", POLICIES)
def test_what_is_not_feasible_is_not_chosen_without_masks_either(kind):
    days = FleetVecEnv(NETWORK, 8)
    model = learner(kind, days)
    days.seed(1)
    seen = days.reset()
    for step in range(60):
        feasible = days.action_masks()
        choices, _ = model.predict(seen, deterministic=step % 2 == 0)
        assert feasible[np.arange(8), choices].all()
        with_masks, _ = model.predict(seen, deterministic=True, action_masks=feasible)
        np.testing.assert_array_equal(with_masks, model.predict(seen, deterministic=True)[0])
        seen, *_ = days.step(choices)


def test_a_mask_that_a_wrapper_has_changed_is_refused():
    days = VecNormalize(FleetVecEnv(NETWORK, 2))
    agent = learner("mlp", days)
    with pytest.raises(Error, match="action_mask must be 0 or 1") as error:
        agent.learn(64)
    assert "norm_obs_keys" in str(error.value) or "norm_obs_keys" in (error.value.hint or "")
    twin = Mlp(8, width=16, layers=1, value_width=16)
    shown, _ = FleetEnv(NETWORK).reset(seed=1)
    with pytest.raises(Error, match="action_mask must be 0 or 1"):
        act(twin, shown | {"action_mask": shown["action_mask"] * 0.5})


def test_evaluations_report_the_reward_of_the_day_with_masks_or_without(tmp_path):
    day = NETWORK.draw(1, "validation")
    model = learned(days=FleetVecEnv(NETWORK, 2, "dense", reward_scale=100.0))
    export(model, tmp_path / "mine.safetensors")
    expected = vertifleet.simulate(day, "mlp", model=tmp_path / "mine.safetensors").summary["reward"]
    for evaluate in (evaluate_policy, evaluate_without_masks):
        days = FleetVecEnv(NETWORK, 1, "dense", reward_scale=100.0)
        days.set_options({"scenario": day})
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            mean, _ = evaluate(model, days, n_eval_episodes=1)
        assert mean == pytest.approx(expected, rel=1e-5)


def test_an_evaluation_callback_reports_the_reward_of_the_day():
    days = FleetVecEnv(NETWORK, 2, reward_scale=1e6)
    looking = MaskableEvalCallback(days, n_eval_episodes=2, eval_freq=32, verbose=0)
    learner("mlp", FleetVecEnv(NETWORK, 2)).learn(64, callback=looking)
    assert 0.0 < abs(looking.last_mean_reward) < 1.0


def test_an_evaluation_callback_reports_the_callers_own_reward(tmp_path):
    def decided(view, outcome):
        assert view.decision.time_s == outcome["time_s"]
        return 1.0

    looking = MaskableEvalCallback(
        FleetVecEnv(NETWORK, 2, decided), n_eval_episodes=2, eval_freq=32, verbose=0, deterministic=True
    )
    model = learner("mlp", FleetVecEnv(NETWORK, 2, decided))
    model.learn(64, callback=looking)
    assert looking.last_mean_reward > 100
    export(model, tmp_path / "own.safetensors")
    assert vertifleet.Model.read(tmp_path / "own.safetensors").header["settings"] is None


@pytest.mark.parametrize(
    "asked",
    [
        {"net_arch": [64]},
        {"activation_fn": torch.nn.ReLU},
        {"ortho_init": False},
        {"share_features_extractor": False},
        {"features_extractor_class": object},
        {"features_extractor_kwargs": {"widht": 64}},
    ],
)
def test_layers_that_the_network_does_not_have_are_refused(asked):
    name = next(iter(asked.get("features_extractor_kwargs", asked)))
    with pytest.raises(Error, match=name) as refused:
        MaskablePPO(GcapsPolicy, FleetVecEnv(NETWORK, 2), policy_kwargs=asked)
    assert refused.value.code == "V451"


def test_an_environment_with_other_observations_is_refused():
    flat = FlattenObservation(gymnasium.make("vertifleet/Fleet-v0"))
    for environment in (flat, gymnasium.make("CartPole-v1")):
        with pytest.raises(Error, match="nodes, aircraft, clock, action_mask") as refused:
            MaskablePPO(MlpPolicy, environment)
        assert refused.value.code == "V451"


def test_a_policy_is_saved_and_loaded_alone(tmp_path):
    policy = learner("gcaps", FleetVecEnv(NETWORK, 2)).policy
    policy.save(tmp_path / "policy.pt")
    again = GcapsPolicy.load(tmp_path / "policy.pt")
    assert again.twin.sizes == policy.twin.sizes
    for name, tensor in policy.twin.state_dict().items():
        assert torch.equal(again.twin.state_dict()[name], tensor)


def test_settings_are_checked_before_anything_is_learned():
    assert ppo_settings({"gamma": 0.5})["gamma"] == 0.5
    for settings, code in [({"gama": 1.0}, "V302"), ({"gamma": 2.0}, "V303"), ("default", "V451")]:
        with pytest.raises(Error) as refused:
            ppo_settings(settings)
        assert refused.value.code == code


EXAMPLE = Path(__file__).parents[2] / "examples" / "maskable_ppo.py"


def test_the_example_asks_first_whether_the_file_can_be_written(tmp_path):
    command = [
        sys.executable,
        str(EXAMPLE),
        "--steps",
        "1",
        "--out",
        str(tmp_path / "nowhere" / "x.safetensors"),
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2
    assert "make the folder" in done.stderr


def test_the_example_saves_what_was_learned_when_it_is_stopped(tmp_path):
    # Ctrl-C comes at the fourth decision; checkpoints come after every second one.
    stopped = f"""
import runpy, sys
from stable_baselines3.common.callbacks import CheckpointCallback
on_step = CheckpointCallback._on_step
def stop(self):
    on_step(self)
    if self.n_calls == 4:
        raise KeyboardInterrupt
    return True
CheckpointCallback._on_step = stop
made = CheckpointCallback.__init__
CheckpointCallback.__init__ = lambda self, often, folder: made(self, 2, folder)
sys.argv = [{str(EXAMPLE)!r}, "--out", "mine.safetensors"]
runpy.run_path(sys.argv[0], run_name="__main__")
"""
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-c", stopped]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert vertifleet.Model.read(tmp_path / "mine.safetensors").header["steps"] == 4
    assert len(list((tmp_path / "mine.checkpoints").iterdir())) == 2


def test_policies_use_one_thread_unless_omp_num_threads_is_set(monkeypatch):
    days = FleetVecEnv("paper", 2)
    torch.set_num_threads(2)
    monkeypatch.setenv("OMP_NUM_THREADS", "2")
    MaskablePPO(MlpPolicy, days, n_steps=4, batch_size=4)
    assert torch.get_num_threads() == 2
    monkeypatch.delenv("OMP_NUM_THREADS")
    MaskablePPO(MlpPolicy, days, n_steps=4, batch_size=4)
    assert torch.get_num_threads() == 1

"""Training with RLlib: what it plays, what it learns, and that the program decides as the trained network."""

import numpy as np
import pytest

import vertifleet

torch = pytest.importorskip("torch")
ray = pytest.importorskip("ray")
pytest.importorskip("ray.rllib")

from ray.rllib.algorithms.impala import IMPALAConfig  # noqa: E402
from ray.rllib.algorithms.ppo import PPOConfig  # noqa: E402
from ray.rllib.core.columns import Columns  # noqa: E402

from vertifleet.envs import FleetEnv, FleetVectorEnv  # noqa: E402
from vertifleet.envs.observing import paper_space  # noqa: E402
from vertifleet.ray.rllib import FleetDays, FleetModule, export, ppo_config  # noqa: E402
from vertifleet.ray.rllib import weights as rllib_weights  # noqa: E402
from vertifleet.torch import act, load  # noqa: E402

VERTIPORTS = 8
SMALL = {"width": 16, "heads": 4}
TINY = vertifleet.settings("paper") | {
    "n_envs": 4,
    "n_steps": 120,
    "batch_size": 160,
    "n_epochs": 2,
    "learning_rate": 1e-2,
    "reward": "dense",
    "reward_scale": 10.0,
}


@pytest.fixture(scope="module")
def cluster():
    torch.set_num_threads(1)
    ray.init(num_cpus=3, include_dashboard=False, object_store_memory=100 << 20, log_to_driver=False)
    yield
    ray.shutdown()


@pytest.fixture(scope="module")
def trained(cluster, tmp_path_factory):  # noqa: ARG001
    """Trains for two iterations; gives algorithm, earlier weights, infeasible choices and a checkpoint."""
    infeasible = []
    step = FleetVectorEnv.step

    def watched(self, actions):
        told = step(self, actions)
        infeasible.append(told[4]["invalid_action"].copy())
        return told

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(FleetVectorEnv, "step", watched)
        algorithm = ppo_config("paper", "gcaps", TINY, **SMALL).debugging(seed=3).build_algo()
        before = {name: weight.copy() for name, weight in algorithm.get_module().get_state().items()}
        results = [algorithm.train() for _ in range(2)]
    checkpoint = tmp_path_factory.mktemp("checkpoint")
    algorithm.save_to_path(str(checkpoint))
    yield algorithm, before, results, np.array(infeasible), checkpoint
    algorithm.stop()


def module(policy="gcaps", **sizes):
    torch.manual_seed(1)
    return FleetModule(
        observation_space=paper_space(VERTIPORTS),
        action_space=FleetEnv().action_space,
        model_config={"policy": policy, "sizes": sizes},
    )


def observed(network, number=6, seed=1):
    """A batch of observations after some steps, and the environments."""
    days = FleetDays({"network": network, "reward": "dense", "reward_scale": 1.0, "num_envs": number})
    shown, _ = days.reset(seed=seed)
    for _ in range(120):
        shown, *_ = days.step(shown["action_mask"].argmax(-1))
    return {Columns.OBS: {name: torch.from_numpy(array) for name, array in shown.items()}}


@pytest.mark.parametrize(("policy", "sizes"), [("gcaps", SMALL), ("mlp", {"width": 16, "layers": 1})])
def test_a_choice_that_is_not_feasible_has_no_probability(paper, policy, sizes):
    decides, batch = module(policy, **sizes), observed(paper)
    feasible = batch[Columns.OBS]["action_mask"] > 0
    assert not feasible.all()
    for forward in (decides.forward_exploration, decides.forward_inference, decides.forward_train):
        logits = forward(batch)[Columns.ACTION_DIST_INPUTS]
        probabilities = torch.softmax(logits, -1)
        assert (probabilities[~feasible] == 0).all()
        assert (probabilities[feasible] > 0).all()


def test_entropy_is_that_of_the_feasible_choices_and_can_be_learned_from(paper):
    decides, batch = module(**SMALL), observed(paper)
    feasible = batch[Columns.OBS]["action_mask"] > 0
    logits = decides.forward_train(batch)[Columns.ACTION_DIST_INPUTS]
    entropy = decides.get_train_action_dist_cls().from_logits(logits).entropy()
    for row in range(len(entropy)):
        shares = torch.softmax(logits[row][feasible[row]], -1)
        torch.testing.assert_close(entropy[row], -(shares * shares.log()).sum())
    entropy.sum().backward()
    gradients = [weight.grad for weight in decides.parameters() if weight.grad is not None]
    assert gradients
    assert all(gradient.isfinite().all() for gradient in gradients)


def test_values_are_those_of_the_network_with_the_logits_or_without(paper):
    decides, batch = module(**SMALL), observed(paper)
    shown = batch[Columns.OBS]
    _, expected = decides.twin(shown["nodes"], shown["aircraft"], shown["clock"])
    with_logits = decides.forward_train(batch)[Columns.EMBEDDINGS]
    torch.testing.assert_close(decides.compute_values(batch, with_logits), expected)
    torch.testing.assert_close(decides.compute_values(batch), expected)


def test_observations_stay_as_they_were_shown(paper):
    days = FleetDays({"network": paper, "reward": "dense", "reward_scale": 1.0, "num_envs": 2})
    shown, _ = days.reset(seed=1)
    first = {name: array.copy() for name, array in shown.items()}
    later = shown
    for _ in range(5):
        later, *_ = days.step(later["action_mask"].argmax(-1))
    for name, array in first.items():
        np.testing.assert_array_equal(shown[name], array)
    assert (later["nodes"] != shown["nodes"]).any()


def test_rewards_are_scaled(paper):
    def rewards(scale):
        days = FleetDays({"network": paper, "reward": "dense", "reward_scale": scale, "num_envs": 2})
        shown, _ = days.reset(seed=1)
        return days.step(shown["action_mask"].argmax(-1) * 0 + 3)[1]

    assert (rewards(1.0) != 0).any()
    np.testing.assert_array_equal(rewards(50.0), 50.0 * rewards(1.0))


def test_runners_with_seeds_that_follow_each_other_play_other_days(paper):
    def days(seed):
        runner = FleetDays({"network": paper, "reward": "dense", "reward_scale": 1.0, "num_envs": 6})
        return {array.tobytes() for array in runner.reset(seed=seed)[0]["nodes"]}

    assert days(5) == days(5)
    assert len(days(5) | days(6) | days(7)) == 18


def test_settings_become_those_of_rllib():
    paper = vertifleet.settings("paper", n_envs=40, n_steps=500)
    config = ppo_config("paper", "gcaps", paper, env_runners=8)
    assert (config.num_env_runners, config.num_envs_per_env_runner) == (8, 5)
    assert config.get_rollout_fragment_length() == 500
    assert (config.train_batch_size_per_learner, config.minibatch_size, config.num_epochs) == (
        20_000,
        10_000,
        100,
    )
    assert (config.lr, config.gamma, config.lambda_) == (pytest.approx(1e-6), 1.0, pytest.approx(0.95))
    assert (config.clip_param, config.entropy_coeff, config.vf_loss_coeff) == pytest.approx((0.2, 0.01, 0.5))
    assert (config.grad_clip, config.use_kl_loss, config.vf_clip_param) == (0.5, False, float("inf"))
    config.validate()

    default = vertifleet.settings("default")
    falling = ppo_config("paper", "mlp", default)
    assert falling.lr == [[0, default["learning_rate"]], [default["total_steps"], 0.0]]
    assert falling.env_config["reward"] == "dense"


@pytest.mark.parametrize(
    ("arguments", "code", "named"),
    [
        ({"policy": "gcaps-x"}, "V451", "gcaps-x"),
        ({"env_runners": 7}, "V451", "env_runners"),
        ({"env_runners": -2}, "V451", "env_runners"),
        ({"env_runners": 1.5}, "V451", "env_runners"),
        ({"settings": {"gama": 1.0}}, "V302", "gama"),
        ({"settings": {"gamma": 2.0}}, "V303", "gamma"),
        ({"settings": "default"}, "V451", "settings"),
        ({"widht": 64}, "V451", "widht"),
        ({"width": 10, "heads": 4}, "V451", "width"),
        ({"policy": "mlp", "heads": 4}, "V451", "heads"),
    ],
)
def test_what_does_not_fit_is_refused(arguments, code, named):
    with pytest.raises(vertifleet.Error, match=named) as refused:
        ppo_config("paper", **arguments)
    assert refused.value.code == code


def test_settings_that_are_not_given_are_those_of_the_paper():
    paper = ppo_config("paper", "mlp")
    for settings in ({}, {"gamma": np.float32(1.0), "total_steps": 2e6}):
        assert ppo_config("paper", "mlp", settings).to_dict().keys() == paper.to_dict().keys()
        assert ppo_config("paper", "mlp", settings).train_batch_size_per_learner == 20_000
    assert ppo_config("paper", "mlp", {"gamma": 0.5, "n_envs": 10}).gamma == 0.5


def test_training_chooses_what_is_feasible_and_changes_every_weight(trained):
    algorithm, before, results, infeasible, _ = trained
    decisions = results[-1]["env_runners"]["num_env_steps_sampled_lifetime"]
    assert decisions >= 2 * TINY["n_envs"] * TINY["n_steps"]
    assert infeasible.size >= decisions
    assert not infeasible.any()
    learned = results[-1]["learners"]["default_policy"]
    assert np.isfinite([learned["total_loss"], learned["entropy"], learned["vf_loss"]]).all()
    after = algorithm.get_module().get_state()
    assert all((after[name] != weight).any() for name, weight in before.items())


def test_the_program_decides_as_what_was_trained(trained, paper, day, tmp_path):
    algorithm, *_ = trained
    file = tmp_path / "mine.safetensors"
    export(algorithm, file)
    twin, weights = load(file), algorithm.get_module().get_state()
    for name, weight in twin.state_dict().items():
        np.testing.assert_array_equal(weight.numpy(), weights[f"twin.{name}"])

    played = vertifleet.simulate(day, "gcaps", model=file).trace.columns["to"]
    env = FleetEnv(paper)
    shown, _ = env.reset(options={"scenario": day})
    chosen, over = [], False
    while not over:
        chosen.append(act(twin, shown))
        shown, _, over, _, _ = env.step(chosen[-1])
    np.testing.assert_array_equal(chosen, played)
    assert len(set(chosen)) > 1


def test_a_checkpoint_is_exported_as_the_algorithm_is(trained, tmp_path, monkeypatch):
    algorithm, _, results, _, checkpoint = trained
    export(algorithm, tmp_path / "algorithm.safetensors")
    monkeypatch.chdir(checkpoint.parent)
    export(checkpoint.name, tmp_path / "checkpoint.safetensors")
    files = [(tmp_path / f"{name}.safetensors").read_bytes() for name in ("algorithm", "checkpoint")]
    assert files[0] == files[1]

    header = vertifleet.Model.from_bytes(files[0]).header
    assert (header["network"], header["seed"]) == ("paper", 3)
    assert header["policy"] == {"kind": "gcaps"} | SMALL
    assert header["steps"] == results[-1]["env_runners"]["num_env_steps_sampled_lifetime"]
    unlike = {"total_steps", "eval_every", "eval_days"}
    for name, value in TINY.items():
        assert name in unlike or header["settings"][name] == pytest.approx(value), name


@pytest.mark.usefixtures("cluster")
def test_runners_elsewhere_need_no_file_of_the_network(paper, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(paper.toml.replace('name = "paper"', 'name = "mine"'))
    network = vertifleet.Network(file)
    file.unlink()
    settings = TINY | {"lr_schedule": "linear", "total_steps": 960}
    algorithm = ppo_config(
        network, "mlp", settings, env_runners=2, width=16, layers=1, value_width=8
    ).build_algo()
    result = algorithm.train()
    export(algorithm, tmp_path / "mine.safetensors")
    algorithm.stop()
    assert result["env_runners"]["num_env_steps_sampled_lifetime"] >= 480
    header = vertifleet.Model.read(tmp_path / "mine.safetensors").header
    assert header["network"] == "mine"
    assert (header["settings"]["lr_schedule"], header["settings"]["total_steps"]) == ("linear", 960)
    comparison = vertifleet.compare(network, ["mine"], days=1, models={"mine": tmp_path / "mine.safetensors"})
    assert comparison.columns["decisions"][0] > 0


@pytest.mark.usefixtures("cluster")
def test_weights_of_another_module_are_refused(tmp_path):
    algorithm = PPOConfig().environment("CartPole-v1").env_runners(num_env_runners=0).build_algo()
    with pytest.raises(vertifleet.Error) as refused:
        export(algorithm, tmp_path / "other.safetensors")
    algorithm.stop()
    assert refused.value.code == "V451"


def header_of(config, path, **arguments):
    """The header of the weight file for this configuration, without spending the time to train."""
    trained = rllib_weights.Trained(module(**SMALL), config, 960)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rllib_weights, "_of_checkpoint", lambda _: trained)
        export("checkpoint", path, **arguments)
    return vertifleet.Model.read(path).header


def test_a_run_has_the_settings_of_the_program(tmp_path):
    config = ppo_config("paper", "gcaps", TINY | {"learning_rate": np.float32(0.01)}).debugging(
        seed=np.int64(5)
    )
    config.training(minibatch_size=None)
    header = header_of(config, tmp_path / "mine.safetensors")
    expected = TINY | {"total_steps": 960, "batch_size": 480, "eval_every": 10**9, "eval_days": 1}
    assert header["settings"] == expected
    assert (header["seed"], header["steps"]) == (5, 960)


UNSAYABLE = {
    "no bound on gradients": {"grad_clip": None},
    "gradients cut in another way": {"grad_clip_by": "value"},
    "a falling entropy bonus": {"entropy_coeff": [[0, 0.01], [960, 0.0]]},
    "a rate that falls to half": {"lr": [[0, 0.01], [960, 0.005]]},
    "a rate that falls in a curve": {"lr": [[0, 0.01], [100, 0.002], [960, 0.0]]},
    "a rate that rises first": {"lr": [[100, 0.01], [960, 0.0]]},
    "values clipped": {"vf_clip_param": 10.0},
    "another loss": {"use_kl_loss": True},
    "a roll-out that is not whole": {"train_batch_size_per_learner": 482},
}


@pytest.mark.parametrize("how", UNSAYABLE)
def test_a_run_that_no_setting_describes_has_no_settings(how, tmp_path):
    config = ppo_config("paper", "gcaps", TINY).training(**UNSAYABLE[how])
    header = header_of(config, tmp_path / "mine.safetensors")
    assert (header["network"], header["settings"], header["seed"], header["steps"]) == (
        "paper",
        None,
        None,
        960,
    )


def test_other_algorithms_and_environments_have_weight_files_without_settings(paper, tmp_path):
    path = tmp_path / "mine.safetensors"
    days = {"network": "paper", "reward": "dense", "reward_scale": 1.0}
    impala = IMPALAConfig().environment(FleetDays, env_config=days)
    for arguments in ({}, {"network": "paper"}):
        header = header_of(impala, path, **arguments)
        assert (header["network"], header["settings"]) == ("paper", None)
    elsewhere = PPOConfig().environment("CartPole-v1")
    assert header_of(elsewhere, path, network=paper)["settings"] is None


def test_a_network_that_is_not_known_or_not_the_one_trained_on_is_refused(paper, tmp_path):
    path = tmp_path / "mine.safetensors"
    changed = paper.changed({"fleet.0.count": 30})
    for config, network, rule in [
        (PPOConfig().environment("CartPole-v1"), None, "network="),
        (ppo_config("paper"), "random:7", "not on the 'random-comparison-7' given"),
        (ppo_config("paper"), changed, "texts of their files differ"),
    ]:
        with pytest.raises(vertifleet.Error, match=rule) as refused:
            header_of(config, path, network=network)
        assert refused.value.code == "V451"
    assert not path.exists()

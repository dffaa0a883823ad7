"""Weight files of networks that RLlib trained, for use in the program."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ray.rllib.algorithms import Algorithm, AlgorithmConfig
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core import (
    COMPONENT_LEARNER,
    COMPONENT_LEARNER_GROUP,
    COMPONENT_RL_MODULE,
    DEFAULT_MODULE_ID,
)
from ray.rllib.core.rl_module import RLModule
from ray.rllib.utils.metrics import ENV_RUNNER_RESULTS, NUM_ENV_STEPS_SAMPLED_LIFETIME
from ray.rllib.utils.metrics.metrics_logger import MetricsLogger

from vertifleet import Error, Network
from vertifleet._compare import network_of
from vertifleet.ray.rllib.config import TURNED_OFF
from vertifleet.ray.rllib.days import FleetDays
from vertifleet.ray.rllib.module import FleetModule
from vertifleet.torch.origin import network_trained_on, seed_in_words, settings_in_words
from vertifleet.torch.weights import save_trained

if TYPE_CHECKING:
    import os

MODULE = Path(COMPONENT_LEARNER_GROUP, COMPONENT_LEARNER, COMPONENT_RL_MODULE, DEFAULT_MODULE_ID)
"""The path of the module in a checkpoint."""
DECISIONS = (ENV_RUNNER_RESULTS, NUM_ENV_STEPS_SAMPLED_LIFETIME)
"""RLlib's name for the number of decisions learned from."""


def export(
    source: Algorithm | str | os.PathLike[str],
    path: str | os.PathLike[str],
    *,
    network: str | os.PathLike[str] | Network | None = None,
) -> None:
    """Writes trained weights as a weight file, with which the program can decide.

    ``vertifleet compare --policies greedy,mine --model mine=PATH`` compares it with other policies. The file
    records how the weights were trained if the program's settings can express it. They cannot if another
    algorithm than PPO trained them, for example, or if a rate fell in another way than linearly to 0.

    Args:
        source: the algorithm, built from :func:`~vertifleet.ray.rllib.ppo_config`, or the folder of one of
            its checkpoints, which needs no cluster.
        path: path of the weight file.
        network: the network that it was trained on, its name or its path; needed only if the environment is
            not :class:`~vertifleet.ray.rllib.FleetDays`.

    Raises:
        Error: V304 if a weight is not finite, V102 if the file cannot be written, V451 if the trained module
            is not a :class:`~vertifleet.ray.rllib.FleetModule`, or if the network that it was trained on is
            not known or is another one than `network`.
    """
    trained = _of_algorithm(source) if isinstance(source, Algorithm) else _of_checkpoint(Path(source))
    config, decisions = trained.config, trained.decisions
    settings, seed = _settings(config, decisions), seed_in_words(config.seed)
    save_trained(trained.module.twin, path, _network(config, network), settings, seed, decisions)


class Trained(NamedTuple):
    """A trained module and its training."""

    module: FleetModule
    config: Any
    """RLlib's configuration."""
    decisions: int


def _of_algorithm(algorithm: Algorithm) -> Trained:
    """Takes the latest weights; environment runners may have older ones until they play again."""
    module = _checked(algorithm.get_module())
    learners, metrics = algorithm.learner_group, algorithm.metrics
    assert learners is not None, "an algorithm with a module has learners"
    assert metrics is not None, "an algorithm with a module has metrics"
    module.set_state(learners.get_weights()[DEFAULT_MODULE_ID])
    return Trained(module, algorithm.config, int(metrics.peek(DECISIONS, default=0)))


def _of_checkpoint(folder: Path) -> Trained:
    """Reads them from the files, since building the algorithm takes as many CPUs as the training took."""
    module = _checked(RLModule.from_checkpoint(folder.absolute() / MODULE))
    made_from = pickle.loads((folder / Algorithm.CLASS_AND_CTOR_ARGS_FILE_NAME).read_bytes())
    (config,), _ = made_from["ctor_args_and_kwargs"]
    state = pickle.loads((folder / f"{Algorithm.STATE_FILE_NAME}.pkl").read_bytes())
    metrics = MetricsLogger(root=True)
    metrics.set_state(state["metrics_logger"])
    return Trained(module, AlgorithmConfig.from_state(config), int(metrics.peek(DECISIONS, default=0)))


def _checked(module: RLModule | None) -> FleetModule:
    if not isinstance(module, FleetModule):
        raise Error("V451", f"weight files are of FleetModule, not of {type(module).__name__}")
    return module


def _network(config: AlgorithmConfig, given: str | os.PathLike[str] | Network | None) -> Network:
    """The network that the module was trained on, from its environment or else from the caller."""
    if config.env is FleetDays:
        return network_trained_on(given, config.env_config["network"])
    if given is None:
        hint = 'say it: export(..., network="paper")'
        raise Error("V451", "the environment is not FleetDays: the network trained on is not known", hint)
    return network_of(given)


def _settings(config: Any, steps: int) -> dict[str, Any] | None:
    """The training settings under the program's names; None if these cannot express them."""
    if not isinstance(config, PPOConfig) or config.env is not FleetDays:
        return None
    if any(getattr(config, name) != value for name, value in TURNED_OFF.items()):
        return None
    days = config.num_envs_per_env_runner * max(config.num_env_runners, 1)
    rate, lr_schedule, falls_for = _falling(config.lr)
    return settings_in_words(
        {
            "total_steps": falls_for or max(steps, 1),
            "n_envs": days,
            # This is a fraction, which no setting may be, if the roll-out differs between days.
            "n_steps": config.total_train_batch_size / days,
            "batch_size": _batch_size(config),
            "n_epochs": config.num_epochs,
            "learning_rate": rate,
            "lr_schedule": lr_schedule,
            "gamma": config.gamma,
            "gae_lambda": config.lambda_,
            "clip_range": config.clip_param,
            "ent_coef": config.entropy_coeff,
            "vf_coef": config.vf_loss_coeff,
            "max_grad_norm": config.grad_clip,
            "reward": config.env_config["reward"],
            "reward_scale": config.env_config["reward_scale"],
        }
    )


def _falling(rate: Any) -> tuple[Any, str | None, int | None]:
    """The first learning rate, the program's name of its schedule, and after how many decisions it ends."""
    if not isinstance(rate, list):
        return rate, "constant", None
    match rate:
        case [[0, first], [end, 0]]:
            return first, "linear", end
        case _:
            return None, None, None


def _batch_size(config: PPOConfig) -> int:
    """Decisions per step of all learners together; without minibatches, all decisions of a roll-out."""
    size: int = config.minibatch_size or config.train_batch_size_per_learner
    return size * max(config.num_learners, 1)

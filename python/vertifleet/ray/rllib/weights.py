"""Weight files of what RLlib trained, with which the program decides."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ray.rllib.algorithms import Algorithm, AlgorithmConfig
from ray.rllib.core import (
    COMPONENT_LEARNER,
    COMPONENT_LEARNER_GROUP,
    COMPONENT_RL_MODULE,
    DEFAULT_MODULE_ID,
)
from ray.rllib.core.rl_module import RLModule
from ray.rllib.utils.metrics import ENV_RUNNER_RESULTS, NUM_ENV_STEPS_SAMPLED_LIFETIME
from ray.rllib.utils.metrics.metrics_logger import MetricsLogger

from vertifleet import Error
from vertifleet.ray.rllib.module import FleetModule
from vertifleet.torch import save
from vertifleet.torch.weights import NEVER

if TYPE_CHECKING:
    import os

    from vertifleet import Network

MODULE = Path(COMPONENT_LEARNER_GROUP, COMPONENT_LEARNER, COMPONENT_RL_MODULE, DEFAULT_MODULE_ID)
"""Where a checkpoint has the module."""
DECISIONS = (ENV_RUNNER_RESULTS, NUM_ENV_STEPS_SAMPLED_LIFETIME)
"""What RLlib calls the number of decisions learned from."""


def export(source: Algorithm | str | os.PathLike[str], path: str | os.PathLike[str]) -> None:
    """Writes trained weights as a weight file, with which the program decides.

    ``vertifleet compare --policies greedy,mine --model mine=PATH`` compares it with others.

    Args:
        source: the algorithm, built from :func:`~vertifleet.ray.rllib.ppo_config`, or the folder of a
            checkpoint of it, for which no cluster is needed.
        path: the file.

    Raises:
        Error: V304 if a weight is not finite, V102 if the file cannot be written, V451 if what was trained is
            no :class:`~vertifleet.ray.rllib.FleetModule`.
    """
    trained = _of_algorithm(source) if isinstance(source, Algorithm) else _of_checkpoint(Path(source))
    settings, seed = _settings(trained.config, trained.decisions), trained.config.seed or 0
    network: Network = trained.config.env_config["network"]
    save(trained.module.twin, path, network=network, settings=settings, seed=seed, steps=trained.decisions)


class Trained(NamedTuple):
    """What was trained."""

    module: FleetModule
    config: Any
    """RLlib's configuration."""
    decisions: int


def _of_algorithm(algorithm: Algorithm) -> Trained:
    """The latest weights; environment runners may have older ones, until they play again."""
    module = _checked(algorithm.get_module())
    learners, metrics = algorithm.learner_group, algorithm.metrics
    assert learners is not None, "modules have learners"
    assert metrics is not None, "and numbers about them"
    module.set_state(learners.get_weights()[DEFAULT_MODULE_ID])
    return Trained(module, algorithm.config, int(metrics.peek(DECISIONS, default=0)))


def _of_checkpoint(folder: Path) -> Trained:
    """The same, read from the files: to build the algorithm takes as many CPUs as the training took."""
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


def _settings(config: Any, steps: int) -> dict[str, Any]:
    """What the module was trained with, under the program's names."""
    days = config.num_envs_per_env_runner * max(config.num_env_runners, 1)
    falls = isinstance(config.lr, list)
    return {
        "total_steps": config.lr[-1][0] if falls else max(steps, 1),
        "n_envs": days,
        "n_steps": config.total_train_batch_size // days,
        "batch_size": config.minibatch_size,
        "n_epochs": config.num_epochs,
        "learning_rate": config.lr[0][1] if falls else config.lr,
        "lr_schedule": "linear" if falls else "constant",
        "gamma": config.gamma,
        "gae_lambda": config.lambda_,
        "clip_range": config.clip_param,
        "ent_coef": config.entropy_coeff,
        "vf_coef": config.vf_loss_coeff,
        "max_grad_norm": config.grad_clip,
        "reward": config.env_config["reward"],
        "reward_scale": config.env_config["reward_scale"],
        "eval_every": NEVER,
        "eval_days": 1,
    }

"""The program's settings of a training run (Table 2) as RLlib's configuration of PPO."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import torch
from gymnasium import VectorizeMode
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.rl_module.rl_module import RLModuleSpec

from vertifleet import Error, Network
from vertifleet._compare import network_of
from vertifleet.ray.rllib.days import FleetDays
from vertifleet.ray.rllib.module import FleetModule, kind_of
from vertifleet.torch.origin import checked_settings, whole
from vertifleet.torch.twin import of_sizes

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

TURNED_OFF: dict[str, Any] = {
    "vf_clip_param": float("inf"),
    "grad_clip_by": "global_norm",
    "use_kl_loss": False,
    "use_gae": True,
    "use_critic": True,
}
"""Settings that only RLlib has, with the values that the program's settings imply."""


def ppo_config(
    network: str | os.PathLike[str] | Network = "paper",
    policy: str = "gcaps",
    settings: Mapping[str, Any] | None = None,
    *,
    env_runners: int = 0,
    **sizes: Any,
) -> PPOConfig:
    """The configuration of PPO on training days of a network.

    It is an object of RLlib and can be changed further: ``.learners(num_gpus_per_learner=1)`` learns on a
    GPU, ``.debugging(seed=1)`` sets the seed. It contains the network, so nodes need the package but no file.

    RLlib differs from stable-baselines3, and from the program, in these points:

    - advantages are normalised over the roll-out, not over each minibatch;
    - Adam has an epsilon of 1e-8, not 1e-5;
    - a roll-out may be a few decisions longer than ``n_envs * n_steps``, the last minibatch of a pass is
      filled up with decisions of the next pass, and a few decisions of a minibatch do not count;
    - there is no ``total_steps``: the caller decides when to stop, and a falling learning rate reaches 0 at
      that many decisions;
    - validation days are not played (``eval_every``, ``eval_days``): the weights are always the last;
    - the logged return of an episode is the day's reward times ``reward_scale``.

    Args:
        network: the network, its name or its path.
        policy: "gcaps" or "mlp".
        settings: settings with the names of ``vertifleet.settings("paper")``, whose values are the defaults.
        env_runners: number of processes that play days, on any node; they divide ``n_envs`` among them. With
            0, the process that learns plays too.
        sizes: sizes of the network's layers; by default those of the shipped weights.

    Raises:
        Error: V302 and V303 if a setting is unknown or out of its bounds, V451 if there is no such policy, if
            it has no such size, or if ``n_envs`` is not a multiple of `env_runners`; others if the network
            cannot be read.
    """
    network = network_of(network)
    settings = checked_settings({} if settings is None else settings)
    env_runners = whole("env_runners", env_runners, settings["n_envs"])
    days, playing = settings["n_envs"], max(env_runners, 1)
    if days % playing:
        raise Error("V451", f"n_envs ({days}) must be a multiple of env_runners ({env_runners})")
    with torch.device("meta"):  # the network checks its sizes, without memory
        of_sizes(kind_of(policy), len(network.vertiports), sizes)
    config: PPOConfig = PPOConfig()  # type: ignore[no-untyped-call]
    return (
        config.environment(FleetDays, env_config=_days(network, settings))
        .env_runners(
            num_env_runners=env_runners,
            num_envs_per_env_runner=days // playing,
            gym_env_vectorize_mode=VectorizeMode.VECTOR_ENTRY_POINT,
        )
        .rl_module(rl_module_spec=RLModuleSpec(FleetModule, model_config={"policy": policy, "sizes": sizes}))
        .training(**_training(settings))
    )


def _days(network: Network, settings: Mapping[str, Any]) -> dict[str, Any]:
    return {"network": network, "reward": settings["reward"], "reward_scale": settings["reward_scale"]}


def _training(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings under RLlib's names."""
    rate = settings["learning_rate"]
    falling = [[0, rate], [settings["total_steps"], 0.0]]
    return TURNED_OFF | {
        "train_batch_size_per_learner": settings["n_envs"] * settings["n_steps"],
        "minibatch_size": settings["batch_size"],
        "num_epochs": settings["n_epochs"],
        "lr": falling if settings["lr_schedule"] == "linear" else rate,
        "gamma": settings["gamma"],
        "lambda_": settings["gae_lambda"],
        "clip_param": settings["clip_range"],
        "entropy_coeff": settings["ent_coef"],
        "vf_loss_coeff": settings["vf_coef"],
        "grad_clip": settings["max_grad_norm"],
    }

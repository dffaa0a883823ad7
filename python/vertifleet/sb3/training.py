"""Between MaskablePPO and the program: the program's settings there, and weight files of what was trained."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from stable_baselines3.common.utils import FloatSchedule, LinearSchedule
from stable_baselines3.common.vec_env import unwrap_vec_normalize

from vertifleet import Error, Network
from vertifleet.sb3.policies import TwinPolicy
from vertifleet.torch import save
from vertifleet.torch.weights import NEVER

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from sb3_contrib import MaskablePPO

SHARED = ("n_steps", "batch_size", "n_epochs", "gamma", "gae_lambda", "ent_coef", "vf_coef", "max_grad_norm")
"""Settings that MaskablePPO has under the same names and keeps as they are given."""


def ppo_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The program's settings as MaskablePPO's arguments.

    Where days are played and for how long is not among them: ``n_envs``, ``reward`` and ``reward_scale`` are
    :class:`~vertifleet.sb3.FleetVecEnv`'s, ``total_steps`` is what ``learn`` takes.

    Args:
        settings: as ``vertifleet.settings("paper")`` gives them.
    """
    rate = settings["learning_rate"]
    if settings["lr_schedule"] == "linear":
        rate = LinearSchedule(rate, end=0.0, end_fraction=1.0)
    same = {name: settings[name] for name in SHARED}
    return same | {"clip_range": settings["clip_range"], "learning_rate": rate}


def export(model: MaskablePPO, path: str | os.PathLike[str], *, network: Network) -> None:
    """Writes the weights as a weight file, with which the program decides.

    ``vertifleet compare --policies greedy,mine --model mine=PATH`` compares it with others.

    Args:
        model: the learner, with a policy of this package.
        path: the file.
        network: what it was trained on.

    Raises:
        Error: V304 if a weight is not finite, V102 if the file cannot be written, V451 if the model has a
            policy of another kind, was not trained on a :class:`~vertifleet.sb3.FleetVecEnv` of this network,
            or was shown observations that VecNormalize changed, which the program does not do.
    """
    policy = model.policy
    if not isinstance(policy, TwinPolicy):
        raise Error("V451", f"weight files are of GcapsPolicy and MlpPolicy, not of {type(policy).__name__}")
    settings, seed = _settings_of(model, network), model.seed or 0
    save(policy.twin, path, network=network, settings=settings, seed=seed, steps=model.num_timesteps)


def _settings_of(model: MaskablePPO, network: Network) -> dict[str, Any]:
    """What the model was trained with, under the program's names."""
    days = model.get_env()
    if days is None or not days.has_attr("reward_scale"):
        hint = "train on a FleetVecEnv, or use vertifleet.torch.save(model.policy.twin, ...)"
        raise Error("V451", "the model's environment does not say how it pays", hint)
    trained_on = days.get_attr("days")[0].network
    if trained_on.toml != network.toml:
        rule = (
            f"the model was trained on network {trained_on.name!r}, which is not the {network.name!r} given"
        )
        raise Error("V451", rule)
    normalised = unwrap_vec_normalize(days)
    if normalised is not None and normalised.norm_obs:
        hint = "features are scaled by the network's own scales; train with norm_obs=False"
        raise Error("V451", "the model was shown observations that VecNormalize changed", hint)
    first, last = model.lr_schedule(1.0), model.lr_schedule(0.0)
    return {name: getattr(model, name) for name in SHARED} | {
        "total_steps": max(model._total_timesteps, 1),
        "n_envs": model.n_envs,
        "learning_rate": first,
        "lr_schedule": "constant" if first == last else "linear",
        "clip_range": FloatSchedule(model.clip_range)(1.0),
        "reward": days.get_attr("reward")[0],
        "reward_scale": days.get_attr("reward_scale")[0],
        "eval_every": NEVER,
        "eval_days": 1,
    }

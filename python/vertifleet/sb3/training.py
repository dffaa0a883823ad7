"""The program's settings for MaskablePPO, and weight files of the networks that it trained."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from stable_baselines3.common.utils import FloatSchedule, LinearSchedule
from stable_baselines3.common.vec_env import unwrap_vec_normalize

from vertifleet import Error
from vertifleet.sb3.policies import TwinPolicy
from vertifleet.torch.origin import checked_settings, network_trained_on, seed_in_words, settings_in_words
from vertifleet.torch.weights import save_trained

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from numpy.typing import NDArray
    from sb3_contrib import MaskablePPO
    from stable_baselines3.common.type_aliases import Schedule
    from stable_baselines3.common.vec_env import VecEnv

    from vertifleet import Network

SHARED = ("n_steps", "batch_size", "n_epochs", "gamma", "gae_lambda", "ent_coef", "vf_coef", "max_grad_norm")
"""Settings that have the same name in MaskablePPO and keep the value that is given."""
LEFT = np.linspace(1.0, 0.0, 101)
"""The remaining shares of the run at which schedules are sampled."""


def ppo_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The program's settings as MaskablePPO's arguments.

    Some settings are not among them: ``n_envs``, ``reward`` and ``reward_scale`` are arguments of
    :class:`~vertifleet.sb3.FleetVecEnv`, and ``total_steps`` is the argument of ``learn``.

    Args:
        settings: settings with the names of ``vertifleet.settings("paper")``, whose values are the defaults.

    Raises:
        Error: V451 if they are not a dict, V302 and V303 if a member is unknown or out of its bounds.
    """
    settings = checked_settings(settings)
    rate = settings["learning_rate"]
    if settings["lr_schedule"] == "linear":
        rate = LinearSchedule(rate, end=0.0, end_fraction=1.0)
    same = {name: settings[name] for name in SHARED}
    return same | {"clip_range": settings["clip_range"], "learning_rate": rate}


def export(
    model: MaskablePPO,
    path: str | os.PathLike[str],
    *,
    network: str | os.PathLike[str] | Network | None = None,
) -> None:
    """Writes the weights as a weight file, which the program can decide by.

    ``vertifleet compare --policies greedy,mine --model mine=PATH`` compares it with other policies. The file
    records how the weights were trained if the program's settings can express it. They cannot if rewards were
    normalised, for example, if a rate did not fall linearly to 0, or if the model was loaded and has not
    learned since.

    Args:
        model: the learner, with a policy of this package.
        path: path of the weight file.
        network: the network that it was trained on, its name or its path, to check it against the
            environment's network.

    Raises:
        Error: V304 if a weight is not finite, V102 if the file cannot be written, V451 if the model has a
            policy of another kind, was not trained on a :class:`~vertifleet.sb3.FleetVecEnv` of this network,
            or was trained on observations that VecNormalize changed, which the program does not do.
    """
    policy = model.policy
    if not isinstance(policy, TwinPolicy):
        raise Error("V451", f"weight files are of GcapsPolicy and MlpPolicy, not of {type(policy).__name__}")
    days = _days_of(model)
    network = network_trained_on(network, days.get_attr("days")[0].network)
    settings, seed = _settings_of(model, days), seed_in_words(model.seed)
    save_trained(policy.twin, path, network, settings, seed, model.num_timesteps)


def _days_of(model: MaskablePPO) -> VecEnv:
    """The environment that the model learns from, which must be a FleetVecEnv with unchanged observations."""
    days = model.get_env()
    if days is None:
        hint = "load it with MaskablePPO.load(path, env=FleetVecEnv(...))"
        raise Error("V451", "the model has no environment, as after a load without one", hint)
    if not days.has_attr("reward_scale"):
        hint = "train on a FleetVecEnv, or use vertifleet.torch.save(model.policy.twin, ...)"
        raise Error("V451", "the model's environment is no FleetVecEnv", hint)
    normalised = unwrap_vec_normalize(days)
    if normalised is not None and normalised.norm_obs:
        hint = "features are scaled by the network's own scales; train with norm_obs=False"
        raise Error("V451", "the model was shown observations that VecNormalize changed", hint)
    return days


def _settings_of(model: MaskablePPO, days: VecEnv) -> dict[str, Any] | None:
    """The training settings under the program's names; None if these cannot express them."""
    if _learned_otherwise(model, days):
        return None
    rate, lr_schedule = _falling(model)
    return settings_in_words(
        {name: getattr(model, name) for name in SHARED}
        | {
            "batch_size": model.batch_size or model.n_steps * model.n_envs,
            "total_steps": model._total_timesteps,
            "n_envs": model.n_envs,
            "learning_rate": rate,
            "lr_schedule": lr_schedule,
            "clip_range": _constant(FloatSchedule(model.clip_range)),
            "reward": days.get_attr("reward")[0],
            "reward_scale": days.get_attr("reward_scale")[0],
        }
    )


def _learned_otherwise(model: MaskablePPO, days: VecEnv) -> bool:
    """Whether the model learned from other days, or in a way that no setting expresses."""
    # stable-baselines3 drops the last observation when a model, loaded or not, gets another
    # environment.
    other_days = model._last_obs is None
    normalised = unwrap_vec_normalize(days)
    other_rewards = normalised is not None and normalised.norm_reward
    other_loss = model.clip_range_vf is not None or not model.normalize_advantage
    return other_days or other_rewards or other_loss or model.target_kl is not None


def _falling(model: MaskablePPO) -> tuple[float, str | None]:
    """The first learning rate, and the program's name of its schedule; None for any other schedule."""
    rates = _sampled(model.lr_schedule)
    if np.allclose(rates, rates[0], rtol=1e-6, atol=0.0):
        return rates[0], "constant"
    # In a run that was continued, the rate fell twice.
    once = model._num_timesteps_at_start == 0
    linear = once and np.allclose(rates, rates[0] * LEFT, rtol=1e-6, atol=1e-6 * abs(rates[0]))
    return rates[0], "linear" if linear else None


def _constant(schedule: Schedule) -> float | None:
    """The value of a constant schedule; None for a schedule that is not constant."""
    values = _sampled(schedule)
    return values[0] if np.allclose(values, values[0], rtol=1e-6, atol=0.0) else None


def _sampled(schedule: Schedule) -> NDArray[np.float64]:
    return np.array([schedule(left) for left in LEFT.tolist()], np.float64)

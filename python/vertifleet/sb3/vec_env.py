"""Many days in parallel as an environment of stable-baselines3, on the native batch of days."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.vector import AutoresetMode
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import VecEnv

from vertifleet import Error
from vertifleet.envs import FleetVectorEnv

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices, VecEnvObs, VecEnvStepReturn

    from vertifleet import Network
    from vertifleet._compare import Split
    from vertifleet.envs.arguments import Reward
    from vertifleet.envs.observing import ObservationChoice


class FleetVecEnv(VecEnv):
    """Training days of a network, with action masks for MaskablePPO.

    When a day is over, the next one begins in the same step. The step's infos have the final observation, and
    the day's reward ("episode") for the logs.

    Args:
        network: the network or its name.
        num_envs: number of days in parallel.
        reward: "terminal", all of it at the end of the day, "dense", each flight's share at its decision, or
            a function, as in `FleetEnv`. The logs, and an evaluation such as that of `EvalCallback`, take the
            sum of these rewards over the day.
        reward_scale: factor of the rewards that are learned from; logs show the reward itself.
        threads: number of threads that advance the days; all cores by default.
        observation: the observation, as in `FleetEnv`. `GcapsPolicy` and `MlpPolicy` read "paper".
        split: the purpose of the days.
    """

    def __init__(
        self,
        network: Network | str,
        num_envs: int,
        reward: Reward = "terminal",
        reward_scale: float = 1.0,
        threads: int | None = None,
        observation: ObservationChoice = "paper",
        split: Split = "training",
    ) -> None:
        self.days = FleetVectorEnv(
            num_envs,
            network,
            reward,
            AutoresetMode.SAME_STEP,
            threads,
            observation=observation,
            split=split,
            copy=False,
        )
        self.reward = reward
        self.reward_scale = reward_scale
        self.render_mode = None
        self._actions = np.zeros(num_envs, dtype=np.int64)
        self._masks = np.ones((num_envs, 1), dtype=np.bool_)
        self._decisions = np.zeros(num_envs, dtype=np.int64)
        self._returns = np.zeros(num_envs)
        super().__init__(num_envs, self.days.single_observation_space, self.days.single_action_space)

    def reset(self) -> VecEnvObs:
        """Begins new days, with the seeds and options that were set before, if any."""
        if any(options != self._options[0] for options in self._options):
            raise Error("V451", "the days are reset together: set_options takes one dict for all of them")
        observations, _ = self.days.reset(seed=self._seeds, options=self._options[0])
        self._reset_seeds()
        self._reset_options()
        self._decisions[:] = 0
        self._returns[:] = 0.0
        return self._show(observations)

    def step_async(self, actions: NDArray[np.int64]) -> None:
        """Stores the decisions of all days [days] for `step_wait`."""
        self._actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        """Carries the decisions out; observations stay valid until the step after next."""
        observations, rewards, over, _, told = self.days.step(self._actions)
        self._decisions += 1
        self._returns += rewards
        infos: list[dict[str, Any]] = [{"invalid_action": held} for held in told["invalid_action"].tolist()]
        for day in np.flatnonzero(over).tolist():
            end = told["final_info"]
            summary = {name: column[day].item() for name, column in end["summary"].items() if name[0] != "_"}
            # The summary's reward is the paper's, which an own reward is not.
            earned = float(self._returns[day]) if callable(self.reward) else summary["reward"]
            infos[day] = {
                "invalid_action": bool(end["invalid_action"][day]),
                "summary": summary,
                "terminal_observation": told["final_obs"][day],
                "TimeLimit.truncated": False,
                "episode": {"r": earned, "l": int(self._decisions[day])},
            }
        self._decisions[over] = 0
        self._returns[over] = 0.0
        return self._show(observations), (self.reward_scale * rewards).astype(np.float32), over, infos

    def _show(self, observations: VecEnvObs) -> VecEnvObs:
        self._masks = self.days.action_masks()
        return observations

    def close(self) -> None:
        """Ends the days."""
        self.days.close()

    def action_masks(self) -> NDArray[np.bool_]:
        """Which vertiports may be chosen next [days, N]."""
        return self._masks

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """An attribute that all days share, repeated for each of them."""
        value = getattr(self, attr_name)
        return [value for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Sets an attribute that all days share; a single day cannot be changed."""
        if indices is not None:
            raise AttributeError(f"{attr_name} is the same for all days: set it without indices")
        setattr(self, attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: VecEnvIndices = None, **method_kwargs: Any
    ) -> list[Any]:
        """The results of a method for single days: only "action_masks", which MaskablePPO calls."""
        if method_name != "action_masks" or method_args or method_kwargs:
            raise AttributeError(f"single days have a method action_masks(), no {method_name}")
        return [self._masks[day] for day in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: Any, indices: VecEnvIndices = None) -> list[bool]:
        """Claims that days are wrapped in a Monitor, since their infos report a day's end as a Monitor does.

        So evaluations take the day's reward from the infos, not the scaled rewards that are learned from.
        """
        return [wrapper_class is Monitor for _ in self._get_indices(indices)]

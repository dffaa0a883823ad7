"""`vertifleet/Fleet-v0`: one operating day an episode, one decision a step."""

from __future__ import annotations

import os
from typing import Any, Literal

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from vertifleet._compare import network_of
from vertifleet._native import TRAINING_DAYS, Environment, Network, Scenario
from vertifleet.envs.spaces import Info, Observation, observation_space


class FleetEnv(gymnasium.Env[Observation, np.int64]):
    """Decides, for one aircraft after the other, to which vertiport it flies next.

    The action is the position of a vertiport; the aircraft's own means hold. An action that is not feasible
    holds, and sets ``info["invalid_action"]``. The mask of feasible actions is there as ``action_masks()``
    (bool), ``info["action_mask"]`` (int8) and ``observation["action_mask"]`` (float32). The reward of an
    episode is the day's profit over its potential revenue: paid at the end (``reward="terminal"``), or
    each flight's share when it is decided (``"dense"``).

    `reset` draws a training day from ``np_random``, or plays ``options={"scenario": scenario}``. The last
    step's info has the day's numbers as ``summary``. An environment can be copied and pickled in the middle
    of a day.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - declared so by Gymnasium

    def __init__(
        self,
        network: str | os.PathLike[str] | Network = "paper",
        reward: Literal["terminal", "dense"] = "terminal",
        render_mode: None = None,
    ) -> None:
        self.network = network_of(network)
        vertiports = len(self.network.vertiports)
        self.observation_space = observation_space(vertiports)
        self.action_space = spaces.Discrete(vertiports)
        self.render_mode = render_mode
        self._environment = Environment(self.network, reward)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Begins a day."""
        super().reset(seed=seed)
        scenario: Scenario | None = (options or {}).get("scenario")
        if scenario is None:
            observation, mask = self._environment.reset(int(self.np_random.integers(TRAINING_DAYS)))
        else:
            observation, mask = self._environment.begin(scenario)
        return observation, {"action_mask": mask, "invalid_action": False}

    def step(self, action: np.int64 | int) -> tuple[Observation, float, bool, bool, Info]:
        """Carries the decision out and goes on to the next."""
        (observation, mask), reward, over, invalid = self._environment.step(int(action))
        info: Info = {"action_mask": mask, "invalid_action": invalid}
        if over:
            info["summary"] = self._environment.summary
        return observation, reward, over, False, info

    def action_masks(self) -> NDArray[np.bool_]:
        """Which actions are feasible [N]."""
        return self._environment.mask()

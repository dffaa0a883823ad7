"""`vertifleet/Fleet-v0`: an episode is one operating day, a step is one decision."""

from __future__ import annotations

import os
from typing import Any, Literal

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from vertifleet._compare import network_of
from vertifleet._native import TRAINING_DAYS, Environment, Network, Scenario
from vertifleet.envs.arguments import action_of, check_reward, options_of
from vertifleet.envs.copies import Copied
from vertifleet.envs.spaces import Info, Observation, observation_space


class FleetEnv(Copied, gymnasium.Env[Observation, np.int64]):
    """An environment in which one aircraft after the other needs a choice of where it flies next.

    The action is the position of a vertiport; the aircraft's own vertiport means hold. An action that is not
    feasible holds, and sets ``info["invalid_action"]``. The mask of feasible actions is given as
    ``action_masks()`` (bool), ``info["action_mask"]`` (int8) and ``observation["action_mask"]`` (float32).
    The reward of an episode is the day's profit over its potential: paid at the end (``reward="terminal"``),
    or each flight's share when it is decided (``"dense"``).

    `reset` draws a training day from ``np_random``, or plays ``options={"scenario": scenario}``; the name of
    the day is ``info["day"]``. The last step's info has the day's numbers as ``summary``. An environment can
    be copied and pickled in the middle of a day; copies share its network and spaces.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - declared so by Gymnasium
    _never_changes = ("network", "observation_space", "action_space", "spec")

    def __init__(
        self,
        network: str | os.PathLike[str] | Network = "paper",
        reward: Literal["terminal", "dense"] = "terminal",
        render_mode: None = None,
    ) -> None:
        check_reward(reward)
        self.network = network_of(network)
        vertiports = len(self.network.vertiports)
        self.observation_space = observation_space(vertiports)
        self.action_space = spaces.Discrete(vertiports)
        self.render_mode = render_mode
        self._environment = Environment(self.network, reward)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Begins a day.

        Args:
            seed: seed of ``np_random``, from which training days are drawn.
            options: "scenario" is a day to play instead of a training day.

        Raises:
            Error: V451 for other options, or for a day with another number of vertiports than the network.
        """
        scenario: Scenario | None = options_of(options).get("scenario")
        super().reset(seed=seed)
        if scenario is None:
            observation, mask = self._environment.reset(int(self.np_random.integers(TRAINING_DAYS)))
        else:
            observation, mask = self._environment.begin(scenario)
        day = self._environment.scenario
        assert day is not None, "a day has begun"
        return observation, {"action_mask": mask, "invalid_action": False, "day": day.name}

    def step(self, action: np.int64 | int) -> tuple[Observation, float, bool, bool, Info]:
        """Carries the decision out and goes on to the next.

        Raises:
            Error: V451 for an action that is not a whole number, and if no day is in progress.
        """
        (observation, mask), reward, over, invalid = self._environment.step(action_of(action))
        info: Info = {"action_mask": mask, "invalid_action": invalid}
        if over:
            info["summary"] = self._environment.summary
        return observation, reward, over, False, info

    def action_masks(self) -> NDArray[np.bool_]:
        """Which actions are feasible [N]."""
        return self._environment.mask()

    @property
    def scenario(self) -> Scenario | None:
        """The day in progress, or the day that ended last; None before the first day."""
        return self._environment.scenario

    @property
    def aircraft(self) -> int | None:
        """Position of the aircraft that decides, or of the one that decided last once the day is over."""
        return self._environment.aircraft

    @property
    def time_s(self) -> int | None:
        """Time of the decision, seconds since midnight."""
        return self._environment.time_s

"""`vertifleet/Fleet-v0`: an episode is one operating day, a step is one decision."""

from __future__ import annotations

import dataclasses
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.envs.registration import EnvSpec
from numpy.typing import NDArray

from vertifleet._compare import Split
from vertifleet._errors import Error
from vertifleet._native import Environment, Scenario
from vertifleet._view import View
from vertifleet.envs.arguments import Reward, action_of, number_of, options_of, reward_of
from vertifleet.envs.copies import Copied
from vertifleet.envs.days import NetworksChoice, days_of, plain
from vertifleet.envs.observing import Info, ObservationChoice, Observing
from vertifleet.envs.rendering import METADATA, RenderMode, mode_of, rendered


class FleetEnv(Copied, gymnasium.Env[Any, np.int64]):
    """An environment in which one aircraft after the other needs a destination.

    The action is the position of a vertiport; that of the aircraft's current vertiport means hold. An
    infeasible action holds, and sets ``info["invalid_action"]``. The mask of feasible actions is available as
    ``action_masks()`` (bool), ``info["action_mask"]`` (int8) and ``observation["action_mask"]`` (float32).
    `observation` is "paper" (§IV.A of the paper), "full", "gcaps-x", "gcaps-full", a list of parts, or an
    `OwnObservation`. The reward of an episode is the day's profit over its potential: paid at the end
    (``reward="terminal"``), or each flight's share at its decision (``"dense"``). A function as `reward` is
    called with the `View` of the decision and its `Outcome`, and returns the reward.

    `network` may be several networks, whose days come in turn, or "random" or "random-places:N", which draw a
    network for each day. Days of smaller networks leave the last entries of the arrays 0; ``vertiport_mask``
    and ``fleet_mask`` mark the used ones.

    `reset` draws a day of the `split` from ``np_random``, or plays ``options={"scenario": scenario}`` or the
    day with the number ``options={"number": 7}``; the name of the day is ``info["day"]``, and its split is
    ``info["split"]``. The last step's info has the day's numbers as ``summary``. An environment can be copied
    and pickled in the middle of a day; copies share its network and spaces.
    """

    metadata: dict[str, Any] = METADATA
    _spec: EnvSpec | None = None
    _never_changes = ("network", "_days", "_observing", "observation_space", "action_space", "_spec")

    def __init__(
        self,
        network: NetworksChoice = "paper",
        reward: Reward = "terminal",
        render_mode: RenderMode | None = None,
        observation: ObservationChoice = "paper",
        split: Split = "training",
    ) -> None:
        self._days, self.network = days_of(network, split)
        self._observing = Observing(observation, self._days)
        self.observation_space = self._observing.space
        self.action_space = spaces.Discrete(self._days.sizes[0])
        self.render_mode = mode_of(render_mode)
        self._is_closed = False
        name, self._reward = reward_of(reward)
        self._environment = Environment(self._days, self._observing.layout, name)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        """Begins a day.

        Args:
            seed: seed of ``np_random``, from which training days are drawn.
            options: "scenario" is a day to play instead of a drawn one, "number" the number of a day.

        Raises:
            Error: V451 for other options, or for a day that the observation has no room for; V118 for
                a number that no day has.
        """
        self._check_open()
        asked = options_of(options, "number")
        scenario: Scenario | None = asked.get("scenario")
        super().reset(seed=seed)
        if scenario is None:
            number = number_of(asked)
            drawn = int(self.np_random.integers(self._days.count)) if number is None else number
            row, mask = self._environment.reset(drawn)
        else:
            row, mask = self._environment.begin(scenario)
        day = self._environment.scenario
        assert day is not None, "a day has begun"
        info = {"action_mask": mask, "invalid_action": False, "day": day.name, "split": day.split}
        return self._shown(row), info

    def step(self, action: np.int64 | int) -> tuple[Any, float, bool, bool, Info]:
        """Carries the decision out and advances to the next.

        Raises:
            Error: V451 for an action that is not a whole number, and if no day is in progress.
        """
        self._check_open()
        before = self.view if self._reward is not None else None
        (row, mask), reward, over, invalid = self._environment.step(action_of(action))
        if self._reward is not None:
            assert before is not None, "a day was in progress"
            reward = float(self._reward(before, self._environment.outcome))
        info: Info = {"action_mask": mask, "invalid_action": invalid}
        if over:
            info["summary"] = self._environment.summary
        return self._shown(row), reward, over, False, info

    def render(self) -> Any:
        """The fleet at the current decision, in the format `render_mode`: "rgb_array" is a map of 640 by 480
        pixels, an array of bytes [480, 640, 3], and "ansi" a text. None without a `render_mode`.

        Raises:
            Error: V451 before the first day.
        """
        return rendered(self._environment, self.render_mode)

    def action_masks(self) -> NDArray[np.bool_]:
        """Which actions are feasible [N]."""
        return self._environment.mask()

    def close(self) -> None:
        """Closes the environment: no day can be begun or played any more."""
        self._is_closed = True

    def _check_open(self) -> None:
        if self._is_closed:
            raise Error("V451", "the environment is closed", "make a new one")

    @property
    def spec(self) -> EnvSpec | None:
        """The arguments of the environment as plain data: a `Network` is the text of its file."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        if spec is not None and "network" in spec.kwargs:
            spec = dataclasses.replace(spec, kwargs={**spec.kwargs, "network": plain(spec.kwargs["network"])})
        self._spec = spec

    def _shown(self, row: NDArray[np.float32]) -> Any:
        """The observation of the current decision."""
        own = self._observing.own
        if own is None:
            return self._observing.of_row(row)
        return own.function(self.view)

    @property
    def view(self) -> View:
        """The view of the current decision.

        Raises:
            Error: V451 before the first day.
        """
        native = self._environment.view
        if native is None:
            raise Error("V451", "no day is being played: call reset first")
        return View(native)

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

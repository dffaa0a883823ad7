"""`vertifleet/Fleet-v0`, many days at once: advanced in Rust threads, observations filled in place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space, concatenate, create_empty_array
from numpy.typing import ArrayLike, NDArray

from vertifleet._compare import Split
from vertifleet._errors import Error
from vertifleet._native import Batch, Scenario
from vertifleet._view import View
from vertifleet.envs.arguments import (
    Reward,
    actions_of,
    autoreset_of,
    count_of,
    mask_of,
    numbers_of,
    options_of,
    reward_of,
    scenarios_of,
    seeds_of,
)
from vertifleet.envs.copies import Alone
from vertifleet.envs.days import NetworksChoice, days_of
from vertifleet.envs.observing import Info, ObservationChoice, Observing

RENDER_ONE = 'render a single environment: gymnasium.make("vertifleet/Fleet-v0", render_mode="rgb_array")'


class FleetVectorEnv(VectorEnv[Any, NDArray[np.int64], NDArray[Any]]):
    """Like `FleetEnv`, with `num_envs` days in parallel on `threads` threads (all cores by default).

    With ``copy=False`` observations and masks share the memory that is filled in place, which is faster.
    Those of a step, or of a reset of all environments, then stay valid until the step after next, so that
    those before and after a step can be used together. Those of a reset of some environments stay valid until
    the next such reset. Environment i behaves like a `FleetEnv` whose first reset had seed s + i.
    """

    def __init__(
        self,
        num_envs: int = 1,
        network: NetworksChoice = "paper",
        reward: Reward = "terminal",
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        render_mode: None = None,
        observation: ObservationChoice = "paper",
        split: Split = "training",
        copy: bool = True,
    ) -> None:
        super().__init__()
        if render_mode is not None:
            raise Error("V451", f"a batch has no render_mode, found {render_mode!r}", RENDER_ONE)
        num_envs = count_of("num_envs", num_envs)
        self._days, self.network = days_of(network, split)
        self._observing = Observing(observation, self._days)
        self.num_envs = num_envs
        self.autoreset_mode = autoreset_of(autoreset_mode)
        self.metadata = {"render_modes": [], "autoreset_mode": self.autoreset_mode}
        self.render_mode = render_mode
        self.copy = copy
        self.single_observation_space = self._observing.space
        self.single_action_space = spaces.Discrete(self._days.sizes[0])
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        name, self._reward = reward_of(reward)
        layout, mode = self._observing.layout, self.autoreset_mode.value
        self._batch = Batch(self._days, layout, name, num_envs, mode, threads)
        *sets, final, self._outcomes = self._batch.arrays()
        self._rows = [rows for rows, _ in sets]
        self._masks = [masks for _, masks in sets]
        self._parts = [self._observing.of_rows(rows) for rows in self._rows]
        self._final, self._final_mask = final
        self._alone = Alone()
        self._latest = 0
        self._generators: list[np.random.Generator] = []
        # Numbers of the next days, drawn early so that a day can begin in the step in which one
        # ends.
        self._numbers = np.zeros(num_envs, np.uint64)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Any, Info]:
        """Begins a day in every environment.

        Args:
            seed: environment i gets seed + i, or the i-th of a list or array.
            options: "reset_mask" (array of bool [num_envs]) selects the environments to reset; "scenario" is
                a day that they all play instead of drawn ones, or a list with a day for each environment;
                "number" is the number of a day that they all play, or a list with a number for each.

        Raises:
            Error: V451 for a seed that is not a whole number, other options, a mask that is not valid or
                selects no environment, or a day with another number of vertiports than the network; V118 for
                a number that no day has.
        """
        with self._alone:
            return self._reset(seed, options)

    def _reset(
        self, seed: int | Sequence[int | None] | None, options: dict[str, Any] | None
    ) -> tuple[Any, Info]:
        self._check_open()
        asked = options_of(options, "reset_mask", "number", many=True)
        scenarios = scenarios_of(asked, self.num_envs)
        given = numbers_of(asked, self.num_envs)
        which = mask_of(asked, self.num_envs)
        self._seed(seeds_of(seed, self.num_envs), which)
        numbers = self._numbers if given is None else given
        self._latest = self._batch.reset(which, numbers, scenarios)
        if scenarios is None and given is None:
            self._draw(which)
        info = self._info(np.zeros(self.num_envs, np.bool_), which)
        self._add_days(info, which)
        return self._observation(), info

    def step(
        self, actions: ArrayLike
    ) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Info]:
        """Carries a decision out in every environment; `actions` are whole numbers [num_envs].

        Raises:
            Error: V451 for actions of another type or shape, and if a day is not in progress.
        """
        with self._alone:
            return self._step(actions)

    def _step(
        self, actions: ArrayLike
    ) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Info]:
        self._check_open()
        actions = actions_of(actions, self.num_envs)
        before = [self.view(at) for at in range(self.num_envs)] if self._reward else []
        self._latest, eventful = self._batch.step(actions, self._numbers)
        rewards, over, invalid, begun = (array.copy() for array in self._outcomes)
        if self._reward:
            rewards = self._own_rewards(before)
        info = self._info(invalid, np.ones(self.num_envs, np.bool_))
        if eventful:
            self._add_ends(info, over, begun)
            self._add_days(info, begun)
            self._draw(begun)
        return self._observation(), rewards, over, np.zeros(self.num_envs, np.bool_), info

    def render(self) -> tuple[Any, ...] | None:
        """A batch renders nothing.

        Raises:
            Error: V451, with the single environment that does.
        """
        raise Error("V451", "a batch of environments renders nothing", RENDER_ONE)

    def action_masks(self) -> NDArray[np.bool_]:
        """Which actions are feasible [num_envs, N]."""
        return self._masks[self._latest].astype(np.bool_)

    def scenarios(self) -> list[Scenario | None]:
        """For every environment the day in progress, or the one that ended last; None before the first."""
        return [self._batch.scenario(at) for at in range(self.num_envs)]

    def view(self, at: int) -> View:
        """The view of the current decision of environment `at`.

        Raises:
            Error: V451 if there is no such environment, or before its first day.
        """
        native = self._batch.view(at)
        if native is None:
            raise Error("V451", f"environment {at} has no day: call reset first")
        return View(native)

    def _check_open(self) -> None:
        if self.closed:
            raise Error("V451", "the environments are closed", "make new ones")

    def _own_rewards(self, before: list[View]) -> NDArray[np.float64]:
        """The caller's reward for each decision; 0 for a step that begins a day."""
        assert self._reward is not None, "there is a function"
        rewards = np.zeros(self.num_envs)
        for at, view in enumerate(before):
            outcome = self._batch.outcome(at)
            if outcome is not None:
                rewards[at] = self._reward(view, outcome)
        return rewards

    def _observation(self) -> Any:
        own = self._observing.own
        if own is not None:
            seen = [own.function(self.view(at)) for at in range(self.num_envs)]
            room = create_empty_array(own.space, self.num_envs)
            return concatenate(own.space, seen, room)
        if self.copy:
            return self._observing.of_rows(self._rows[self._latest].copy())
        return dict(self._parts[self._latest])

    def _info(self, invalid: NDArray[np.bool_], which: NDArray[np.bool_]) -> Info:
        """The info of the environments in `which`; the array of masks has those of all others too."""
        mask = self._masks[self._latest]
        return {
            "action_mask": mask.copy() if self.copy else mask,
            "_action_mask": which,
            "invalid_action": invalid,
            "_invalid_action": which.copy(),
        }

    def _add_days(self, info: Info, begun: NDArray[np.bool_]) -> None:
        """Adds the names and splits of the days that have begun, if any have."""
        places = _where(begun)
        if not places:
            return
        # `np.empty` fills an array of objects with None.
        names, splits = np.empty(self.num_envs, np.object_), np.empty(self.num_envs, np.object_)
        for at in places:
            day = self._batch.scenario(at)
            assert day is not None, "a day has begun"
            names[at], splits[at] = day.name, day.split
        info |= {"day": names, "_day": begun.copy(), "split": splits, "_split": begun.copy()}

    def _add_ends(self, info: Info, over: NDArray[np.bool_], begun: NDArray[np.bool_]) -> None:
        """Adds the numbers of the days that this step ended, and their final infos if new days have begun."""
        for at in _where(over):
            ended: Info = {"summary": self._batch.summary(at)}
            if begun[at]:
                invalid = bool(info["invalid_action"][at])
                # The current info belongs to the new day, which has had no action yet.
                info["invalid_action"][at] = False
                final_info = {"action_mask": self._final_mask[at].copy(), "invalid_action": invalid, **ended}
                observation = self._observing.of_row(self._final[at].copy())
                ended = {"final_obs": observation, "final_info": final_info}
            self._add_info(info, ended, at)

    def _seed(self, seeds: list[int | None], which: NDArray[np.bool_]) -> None:
        """Gives every environment a generator at first, and a new one to those that are reset with a seed."""
        if not self._generators:
            self._generators = [seeding.np_random(None)[0] for _ in range(self.num_envs)]
            self._draw(np.ones(self.num_envs, np.bool_))
        for at in _where(which):
            if seeds[at] is not None:
                self._generators[at] = seeding.np_random(seeds[at])[0]
                self._numbers[at] = self._generators[at].integers(self._days.count)

    def _draw(self, which: NDArray[np.bool_]) -> None:
        """Draws the numbers of the next days."""
        for at in _where(which):
            self._numbers[at] = self._generators[at].integers(self._days.count)


def _where(which: NDArray[np.bool_]) -> list[int]:
    """Positions of the selected environments; faster than `np.flatnonzero`, which matters in every step."""
    places: list[int] = which.nonzero()[0].tolist()
    return places

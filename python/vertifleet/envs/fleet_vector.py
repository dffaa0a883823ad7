"""`vertifleet/Fleet-v0`, many days at once: advanced in Rust threads, observations filled in place."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from vertifleet._compare import network_of
from vertifleet._errors import Error
from vertifleet._native import TRAINING_DAYS, Batch, Network, Scenario
from vertifleet.envs.spaces import KEYS, Info, Observation, observation_space


class FleetVectorEnv(VectorEnv[Observation, NDArray[np.int64], NDArray[Any]]):
    """As `FleetEnv`, `num_envs` days side by side on `threads` threads (all cores without).

    Observations and masks are not copied: they stay as they are until the step after next, so that those
    before and after a step can be used together; who keeps them for longer copies them. Environment i behaves
    as a `FleetEnv` whose first reset had seed s + i.
    """

    def __init__(
        self,
        num_envs: int = 1,
        network: str | os.PathLike[str] | Network = "paper",
        reward: Literal["terminal", "dense"] = "terminal",
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        render_mode: None = None,
    ) -> None:
        super().__init__()
        self.network = network_of(network)
        self.num_envs = num_envs
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {"render_modes": [], "autoreset_mode": self.autoreset_mode}
        self.render_mode = render_mode
        vertiports = len(self.network.vertiports)
        self.single_observation_space = observation_space(vertiports)
        self.single_action_space = spaces.Discrete(vertiports)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._batch = Batch(self.network, reward, num_envs, self.autoreset_mode.value, threads)
        first, second, final, self._outcomes = self._batch.arrays()
        self._observations = tuple(dict(zip(KEYS, arrays, strict=False)) for arrays in (first, second))
        self._masks = (first[-1], second[-1])
        self._final = dict(zip(KEYS, final, strict=False))
        self._final_mask = final[-1]
        self._latest = 0
        self._generators: list[np.random.Generator] = []
        # Drawn before they are needed, so that a day that ends can be followed by another in the same step.
        self._numbers = np.zeros(num_envs, np.uint64)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observation, Info]:
        """Begins a day in every environment.

        Args:
            seed: environment i gets seed + i, or the i-th of a list.
            options: "reset_mask" (bool [num_envs]) names the environments that are reset; "scenario" is a day
                that they all play in place of a training day.
        """
        options = options or {}
        scenario: Scenario | None = options.get("scenario")
        which = np.ones(self.num_envs, np.bool_)
        which[:] = options.get("reset_mask", which)
        self._seed(seed, which)
        self._latest = self._batch.reset(which, self._numbers, scenario)
        if scenario is None:
            self._draw(which)
        return self._observation(), self._info(np.zeros(self.num_envs, np.bool_))

    def step(
        self, actions: ArrayLike
    ) -> tuple[Observation, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Info]:
        """Carries a decision out in every environment; `actions` are whole numbers [num_envs]."""
        actions = np.asarray(actions)
        if actions.dtype.kind not in "iu":
            raise Error("V451", f"actions must be whole numbers, found {actions.dtype}")
        self._latest, eventful = self._batch.step(np.ascontiguousarray(actions, np.int64), self._numbers)
        rewards, over, invalid, begun = (array.copy() for array in self._outcomes)
        info = self._info(invalid)
        if eventful:
            self._add_ends(info, over, begun)
            self._draw(begun)
        return self._observation(), rewards, over, np.zeros(self.num_envs, np.bool_), info

    def action_masks(self) -> NDArray[np.bool_]:
        """Which actions are feasible [num_envs, N]."""
        return self._masks[self._latest].astype(np.bool_)

    def _observation(self) -> Observation:
        return dict(self._observations[self._latest])

    def _info(self, invalid: NDArray[np.bool_]) -> Info:
        return {
            "action_mask": self._masks[self._latest],
            "_action_mask": np.ones(self.num_envs, np.bool_),
            "invalid_action": invalid,
            "_invalid_action": np.ones(self.num_envs, np.bool_),
        }

    def _add_ends(self, info: Info, over: NDArray[np.bool_], begun: NDArray[np.bool_]) -> None:
        """Adds the numbers of the days that this step ended, and how they ended where others have begun."""
        for at in np.flatnonzero(over).tolist():
            ended: Info = {"summary": self._batch.summary(at)}
            if begun[at]:
                invalid = bool(info["invalid_action"][at])
                # What the present info says is of the new day, in which nothing has been done yet.
                info["invalid_action"][at] = False
                final_info = {"action_mask": self._final_mask[at].copy(), "invalid_action": invalid, **ended}
                observation = {key: array[at].copy() for key, array in self._final.items()}
                ended = {"final_obs": observation, "final_info": final_info}
            self._add_info(info, ended, at)

    def _seed(self, seed: int | Sequence[int | None] | None, which: NDArray[np.bool_]) -> None:
        """Gives environments that are reset with a seed generators of their own, at first all of them."""
        if not self._generators:
            self._generators = [seeding.np_random(None)[0] for _ in range(self.num_envs)]
            self._draw(np.ones(self.num_envs, np.bool_))
        if seed is None:
            return
        counted = range(self.num_envs)
        seeds = list(seed) if isinstance(seed, Sequence) else [int(seed) + at for at in counted]
        if len(seeds) != self.num_envs:
            raise Error("V451", f"seed must be one or {self.num_envs} numbers, found {len(seeds)}")
        for at in np.flatnonzero(which).tolist():
            if seeds[at] is not None:
                self._generators[at] = seeding.np_random(seeds[at])[0]
                self._numbers[at] = self._generators[at].integers(TRAINING_DAYS)

    def _draw(self, which: NDArray[np.bool_]) -> None:
        """Draws the numbers of the days that come next."""
        for at in np.flatnonzero(which).tolist():
            self._numbers[at] = self._generators[at].integers(TRAINING_DAYS)

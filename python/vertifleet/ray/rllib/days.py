"""Training days as RLlib plays them: many side by side in every environment runner."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vertifleet.envs import FleetVectorEnv

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from vertifleet.envs.observing import Info, Observation


class FleetDays(FleetVectorEnv):
    """A native batch of days with observations that may be kept, as RLlib keeps them until it learns.

    Args:
        config: RLlib's ``env_config`` with ``network``, ``reward`` and ``reward_scale``, and ``num_envs``.
    """

    def __init__(self, config: Mapping[str, Any]) -> None:
        # Ray gives an environment runner one CPU.
        super().__init__(config["num_envs"], config["network"], config["reward"], threads=1)
        self.reward_scale: float = config["reward_scale"]

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Begins new days.

        RLlib gives consecutive seeds to runners, and a batch gives consecutive seeds to its days, so runners
        would play the same days. Here the seeds of a runner's days are spread far apart.
        """
        if isinstance(seed, int):
            seed = np.random.SeedSequence(seed).generate_state(self.num_envs).tolist()
        observations, _ = super().reset(seed=seed, options=options)
        return _kept(observations), {}

    def step(
        self, actions: ArrayLike
    ) -> tuple[Observation, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Info]:
        """Carries a decision out on every day; `actions` [num_envs]."""
        observations, rewards, over, cut, _ = super().step(actions)
        return _kept(observations), self.reward_scale * rewards, over.copy(), cut.copy(), {}


def _kept(observations: Observation) -> Observation:
    return {name: array.copy() for name, array in observations.items()}

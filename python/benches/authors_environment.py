"""The environment of the paper's authors, played as their Feas_RND.py plays it.

Their code (github.com/iamstevepaul/UAM_fleet_Scheduling: UAMEnv.py, eVTOL.py and Vertiport.py, as of commit
f7c516c) is read from a folder and is no part of this project. It differs from the paper's text: see the docs,
"Reproduction".
"""

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import gymnasium
import torch

VERTIPORTS, AIRCRAFT, SIDE_MI, END_H = 8, 19, 50, 18.0


class AuthorsEnvironment:
    """Their environment with 8 vertiports and 19 aircraft, as in their test_envt_generation.py."""

    def __init__(self, folder: Path, seed: int) -> None:
        torch.manual_seed(seed)
        # Tensors this small gain nothing from threads, and lose much where others compute.
        torch.set_num_threads(1)
        demand = torch.randint(0, 100, (VERTIPORTS, VERTIPORTS))
        self._environment = _environment_class(folder)(
            n_vertiports=VERTIPORTS,
            n_evtols=AIRCRAFT,
            vertiport_locations=torch.rand((VERTIPORTS, 2)) * SIDE_MI,
            evtols_initial_locations=torch.randint(0, VERTIPORTS, (AIRCRAFT, 1)),
            demand_model=demand.fill_diagonal_(0),
            time_horizon=END_H,
            max_x_y_axis=SIDE_MI,
        )
        self._observation: dict[str, Any] = {}
        self._start_day()

    def step(self) -> None:
        """One random feasible decision; after the day's last one, a new day."""
        feasible = self._observation["mask"].nonzero()[:, 0]
        choice = feasible[torch.randint(0, feasible.shape[0], (1, 1))]
        self._observation, _, over, _ = self._environment.step(choice[0].item())
        if over:
            self._start_day()

    def _start_day(self) -> None:
        self._observation = self._environment.reset()
        # The log of a day would mix numbers with this one list of one number, which numpy no longer
        # accepts.
        self._environment.current_time = self._environment.current_time[0]


def _environment_class(folder: Path) -> Any:
    # Gymnasium has what they use of gym. The other two are imported for a method that is never
    # called; the first of them is not in their repository.
    sys.modules["gym"] = gymnasium
    sys.modules["gym.spaces"] = gymnasium.spaces
    sys.modules["topology"] = ModuleType("topology")
    distances = ModuleType("persim")
    distances.__dict__.update(wasserstein=None, bottleneck=None)
    sys.modules["persim"] = distances
    sys.path.insert(0, str(folder))
    from UAMEnv import UAMEnv  # type: ignore[import-not-found]

    return UAMEnv

"""The fleet as a PettingZoo environment: every aircraft is an agent, and agents act in turn (AEC).

Needs PettingZoo: ``pip install vertifleet[pettingzoo]``.
"""

from __future__ import annotations

import os
from typing import Any, ClassVar, Literal

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from numpy.typing import NDArray
from pettingzoo import AECEnv
from pettingzoo.utils import wrappers

from vertifleet._compare import network_of
from vertifleet._errors import Error
from vertifleet._native import Environment, Network, Scenario
from vertifleet.envs.arguments import action_of, options_of, reward_of
from vertifleet.envs.copies import Copied
from vertifleet.envs.days import days_of
from vertifleet.envs.observing import Observing
from vertifleet.envs.rendering import METADATA, RenderMode, mode_of, rendered

__all__ = ["FleetAEC", "env"]


def env(
    network: str | os.PathLike[str] | Network = "paper",
    reward: Literal["terminal", "dense"] = "terminal",
    render_mode: RenderMode | None = None,
) -> AECEnv[str, dict[str, Any], int]:
    """The environment with PettingZoo's usual wrapper, which reports calls in a wrong order."""
    return wrappers.OrderEnforcingWrapper(FleetAEC(network, reward, render_mode))


class FleetAEC(Copied, AECEnv[str, dict[str, Any], int]):
    """Agent ``aircraft_k`` decides for aircraft k whenever that aircraft is ready for take-off.

    Actions, features and masks are those of ``vertifleet/Fleet-v0``; an observation is ``{"observation":
    {"nodes", "aircraft", "clock", "adjacency"}, "action_mask"}``, as the agent would see the network now. The
    reward of an agent is what its own flights earn, over the potential of the day: paid flight by flight
    (``reward="dense"``) or all at the end (``"terminal"``). The rewards of all agents add up to the reward of
    ``vertifleet/Fleet-v0``. All agents terminate with the day, and their infos have its numbers as
    ``summary``. The mask is in the info of the agent that decides, and in all infos at the end. An
    environment can be copied and pickled in the middle of a day; copies share its network and spaces.
    """

    metadata: ClassVar[dict[str, Any]] = METADATA | {"name": "fleet_v0", "is_parallelizable": False}
    _never_changes = (
        "network",
        "_observing",
        "_state",
        "possible_agents",
        "_positions",
        "observation_spaces",
        "action_spaces",
    )

    def __init__(
        self,
        network: str | os.PathLike[str] | Network = "paper",
        reward: Literal["terminal", "dense"] = "terminal",
        render_mode: RenderMode | None = None,
    ) -> None:
        super().__init__()
        name, own = reward_of(reward)
        if own is not None:
            raise Error("V451", 'reward must be "terminal" or "dense" where every aircraft is an agent')
        self.network = network_of(network)
        self._days, _ = days_of(self.network, "training")
        self._observing = Observing("paper", self._days)
        self._state = Observing("full", self._days)
        self.reward = name
        self.render_mode = mode_of(render_mode)
        # The native environment pays flight by flight, which shows which agent earned each dollar.
        self._environment = Environment(self._days, self._observing.layout, "dense")
        self.possible_agents = [f"aircraft_{position}" for position in range(self.network.fleet_size)]
        self._positions = {agent: position for position, agent in enumerate(self.possible_agents)}
        vertiports = len(self.network.vertiports)
        shown = self._observing.space
        assert isinstance(shown, spaces.Dict), "it has parts"
        box = spaces.Dict({key: space for key, space in shown.items() if key != "action_mask"})
        mask = spaces.Box(0, 1, (vertiports,), np.int8)
        space = spaces.Dict({"observation": box, "action_mask": mask})
        self.observation_spaces = dict.fromkeys(self.possible_agents, space)
        self.action_spaces: dict[str, spaces.Space[Any]] = {
            agent: spaces.Discrete(vertiports) for agent in self.possible_agents
        }
        self._np_random: np.random.Generator | None = None

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """The space of observations, which is the same for all agents."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """The positions of the vertiports; that of the agent's own vertiport means hold."""
        return self.action_spaces[agent]

    @property
    def state_space(self) -> spaces.Box:
        """The space of `state`."""
        return spaces.Box(-np.inf, np.inf, (self._state.layout.width,), np.float32)

    def state(self) -> NDArray[np.float32]:
        """All that may be seen of the day now: the parts of the observation "full", one after the other.

        Raises:
            Error: V451 before the first day.
        """
        view = self._environment.view
        if view is None:
            raise Error("V451", "no day is being played: call reset first")
        row, _ = view.observe(self._state.layout)
        return row

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> None:
        """Begins the day that ``vertifleet/Fleet-v0`` has for this seed, or ``options["scenario"]``.

        Raises:
            Error: V451 for other options, or for a day with another number of vertiports or aircraft.
        """
        # PettingZoo's own test passes an option of this name to check that options are accepted.
        scenario: Scenario | None = options_of(options, "options").get("scenario")
        if seed is not None or self._np_random is None:
            self._np_random = seeding.np_random(seed)[0]
        if scenario is None:
            self._environment.reset(int(self._np_random.integers(self._days.count)))
        elif len(scenario.aircraft) == len(self.possible_agents):
            self._environment.begin(scenario)
        else:
            found, agents = len(scenario.aircraft), len(self.possible_agents)
            raise Error(
                "V451", f"scenario {scenario.name!r} has {found} aircraft, but there are {agents} agents"
            )
        self.agents = list(self.possible_agents)
        self.rewards = dict.fromkeys(self.agents, 0.0)
        self._cumulative_rewards = dict.fromkeys(self.agents, 0.0)
        self._earned = dict.fromkeys(self.agents, 0.0)
        self.terminations = dict.fromkeys(self.agents, False)
        self.truncations = dict.fromkeys(self.agents, False)
        self.infos: dict[str, dict[str, Any]] = {agent: {"invalid_action": False} for agent in self.agents}
        self._select()

    @property
    def scenario(self) -> Scenario | None:
        """The day in progress, or the day that ended last; None before the first day."""
        return self._environment.scenario

    def observe(self, agent: str) -> dict[str, Any]:
        """The observation of an agent now; for an agent that does not decide, only hold is feasible."""
        row, mask = self._environment.observe(self._positions[agent])
        observation = self._observing.of_row(row)
        del observation["action_mask"]
        return {"observation": observation, "action_mask": mask}

    def render(self) -> Any:
        """The fleet at the current decision, as ``vertifleet/Fleet-v0`` renders it."""
        return rendered(self._environment, self.render_mode)

    def step(self, action: int | None) -> None:
        """Carries the decision of the selected agent out and goes on to the next.

        Args:
            action: the position of a vertiport; None for an agent that has terminated, as in PettingZoo.

        Raises:
            Error: V451 for an action that is not a whole number.
        """
        agent = self.agent_selection
        if self.terminations[agent]:
            self._was_dead_step(action)
            return
        _, earned, over, invalid = self._environment.step(action_of(action))
        self._cumulative_rewards[agent] = 0.0
        self._clear_rewards()
        self._earned[agent] += earned
        self.infos[agent] = {"invalid_action": invalid}
        if self.reward == "dense":
            self.rewards[agent] = earned
        elif over:
            self.rewards = dict(self._earned)
        if over:
            self._end()
        else:
            self._select()
        self._accumulate_rewards()

    def _select(self) -> None:
        """Selects the agent of the aircraft that decides."""
        position = self._environment.aircraft
        assert position is not None, "a day has begun"
        self.agent_selection = self.possible_agents[position]
        self.infos[self.agent_selection]["action_mask"] = self._environment.mask().astype(np.int8)

    def _end(self) -> None:
        """Ends the day for all agents: their infos get its numbers, and only hold is feasible."""
        self.terminations = dict.fromkeys(self.agents, True)
        summary = self._environment.summary
        for agent in self.agents:
            _, hold = self._environment.observe(self._positions[agent])
            self.infos[agent] |= {"action_mask": hold, "summary": summary}

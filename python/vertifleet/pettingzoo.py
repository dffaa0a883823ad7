"""The fleet as a PettingZoo environment: every aircraft is an agent, and agents act in turn (AEC).

For libraries in which all agents act at once there is a parallel view.

Needs PettingZoo: ``pip install vertifleet[pettingzoo]``.
"""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from numpy.typing import NDArray
from pettingzoo import AECEnv, ParallelEnv
from pettingzoo.utils import wrappers

from vertifleet._compare import Split
from vertifleet._errors import Error
from vertifleet._native import Environment, Scenario
from vertifleet.envs.arguments import action_of, number_of, options_of, reward_of
from vertifleet.envs.copies import Copied
from vertifleet.envs.days import NetworksChoice, days_of
from vertifleet.envs.observing import ObservationChoice, Observing, OwnObservation
from vertifleet.envs.rendering import METADATA, RenderMode, mode_of, rendered

__all__ = ["FleetAEC", "FleetParallel", "env", "parallel_env"]


def env(
    network: NetworksChoice = "paper",
    reward: Literal["terminal", "dense"] = "terminal",
    render_mode: RenderMode | None = None,
    observation: ObservationChoice = "paper",
    split: Split = "training",
) -> AECEnv[str, dict[str, Any], int]:
    """The environment with PettingZoo's usual wrapper, which reports calls in a wrong order."""
    return wrappers.OrderEnforcingWrapper(FleetAEC(network, reward, render_mode, observation, split))


def parallel_env(
    network: NetworksChoice = "paper",
    reward: Literal["terminal", "dense"] = "terminal",
    render_mode: RenderMode | None = None,
    observation: ObservationChoice = "paper",
    split: Split = "training",
) -> FleetParallel:
    """The environment for libraries in which all agents act at once."""
    return FleetParallel(FleetAEC(network, reward, render_mode, observation, split))


class FleetAEC(Copied, AECEnv[str, dict[str, Any], int]):
    """Agent ``aircraft_k`` decides for aircraft k whenever that aircraft is ready for take-off.

    Actions, features and masks are those of `FleetEnv`, with the same arguments; an observation is
    ``{"observation": parts, "action_mask": mask}`` from the agent's current vertiport. The reward of an agent
    is the profit of its flights over the potential of the day: paid flight by flight (``reward="dense"``) or
    all at the end (``"terminal"``). The rewards of all agents add up to the reward of `FleetEnv`. All agents
    terminate with the day; `summary` has its numbers. An info contains whether the agent's latest action was
    infeasible. On networks of different sizes the agents of a day are the first of `possible_agents`. An
    environment can be copied and pickled in the middle of a day; copies share its network and spaces.
    """

    metadata: ClassVar[dict[str, Any]] = METADATA | {"name": "fleet_v0", "is_parallelizable": False}
    _never_changes = (
        "network",
        "_days",
        "_observing",
        "_state",
        "possible_agents",
        "_positions",
        "observation_spaces",
        "action_spaces",
    )

    def __init__(
        self,
        network: NetworksChoice = "paper",
        reward: Literal["terminal", "dense"] = "terminal",
        render_mode: RenderMode | None = None,
        observation: ObservationChoice = "paper",
        split: Split = "training",
    ) -> None:
        super().__init__()
        name, own = reward_of(reward)
        if own is not None:
            raise Error("V451", 'reward must be "terminal" or "dense" where every aircraft is an agent')
        if isinstance(observation, OwnObservation):
            rule = "an observation of your own shows one aircraft's decision, and here each aircraft observes"
            raise Error("V451", rule, 'name an observation or parts, such as observation="full"')
        self._days, self.network = days_of(network, split)
        self._observing = Observing(observation, self._days)
        self._state = Observing("full", self._days)
        self.reward = name
        self.render_mode = mode_of(render_mode)
        # The native environment pays flight by flight, so each reward belongs to one agent.
        self._environment = Environment(self._days, self._observing.layout, "dense")
        vertiports, fleet, *_ = self._days.sizes
        self.possible_agents = [f"aircraft_{position}" for position in range(fleet)]
        self._positions = {agent: position for position, agent in enumerate(self.possible_agents)}
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
        """The complete view of the day now: the parts of the observation "full", one after the other.

        Raises:
            Error: V451 before the first day.
        """
        view = self._environment.view
        if view is None:
            raise Error("V451", "no day is being played: call reset first")
        row, _ = view.observe(self._state.layout)
        return row

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> None:
        """Begins the day of `FleetEnv` for this seed, ``options["scenario"]``, or the day with the number
        ``options["number"]``.

        Raises:
            Error: V451 for other options, or for a day with another number of vertiports or aircraft; V118
                for a number that no day has.
        """
        # PettingZoo's test passes an option of this name to check that options are accepted.
        asked = options_of(options, "number", "options")
        scenario: Scenario | None = asked.get("scenario")
        if seed is not None or self._np_random is None:
            self._np_random = seeding.np_random(seed)[0]
        if scenario is None:
            number = number_of(asked)
            drawn = int(self._np_random.integers(self._days.count)) if number is None else number
            self._environment.reset(drawn)
        elif self._days.are_of_one_size and len(scenario.aircraft) != len(self.possible_agents):
            found, agents = len(scenario.aircraft), len(self.possible_agents)
            raise Error(
                "V451", f"scenario {scenario.name!r} has {found} aircraft, but there are {agents} agents"
            )
        else:
            self._environment.begin(scenario)
        day = self._environment.scenario
        assert day is not None, "a day has begun"
        self.agents = self.possible_agents[: len(day.aircraft)]
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

    @property
    def summary(self) -> dict[str, Any] | None:
        """The numbers of the day so far, as ``vertifleet simulate --json`` prints them.

        None before the first day.
        """
        return self._environment.summary

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
        """Carries the decision of the selected agent out and advances to the next.

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
        self.infos[agent]["invalid_action"] = invalid
        if self.reward == "dense":
            self.rewards[agent] = earned
        elif over:
            self.rewards = dict(self._earned)
        if over:
            self.terminations = dict.fromkeys(self.agents, True)
        else:
            self._select()
        self._accumulate_rewards()

    def close(self) -> None:
        """Ends the use of the environment, which holds nothing that has to be given back."""

    def _select(self) -> None:
        """Selects the agent of the aircraft that decides."""
        position = self._environment.aircraft
        assert position is not None, "a day has begun"
        self.agent_selection = self.possible_agents[position]


class FleetParallel(Copied, ParallelEnv[str, dict[str, Any], int]):
    """`FleetAEC` for libraries in which all agents act at once.

    Aircraft decide one after the other, so only the action of the agent `deciding` counts in a step. The
    masks of all others permit only hold.
    """

    metadata: ClassVar[dict[str, Any]] = METADATA | {"name": "fleet_v0"}
    _never_changes = ("possible_agents", "observation_spaces", "action_spaces")

    def __init__(self, turns: FleetAEC) -> None:
        self.turns = turns
        self.render_mode = turns.render_mode
        self.possible_agents = turns.possible_agents
        self.observation_spaces = turns.observation_spaces
        self.action_spaces = turns.action_spaces
        self.agents: list[str] = []

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """The space of observations, which is the same for all agents."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """The positions of the vertiports; that of the agent's own vertiport means hold."""
        return self.action_spaces[agent]

    @property
    def state_space(self) -> spaces.Box:
        """The space of `state`."""
        return self.turns.state_space

    def state(self) -> NDArray[np.float32]:
        """The complete view of the day now."""
        return self.turns.state()

    @property
    def deciding(self) -> str:
        """The agent whose action counts in the next step.

        Raises:
            Error: V451 if no day is being played.
        """
        if not self.agents:
            raise Error("V451", "no day is being played: call reset first")
        return self.turns.agent_selection

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, dict[str, Any]], dict[str, dict[str, Any]]]:
        """Begins a day, as `FleetAEC.reset` does."""
        self.turns.reset(seed, options)
        self.agents = list(self.turns.agents)
        return self._observations(), self._infos()

    def step(
        self, actions: dict[str, int]
    ) -> tuple[
        dict[str, dict[str, Any]],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Carries the decision of the agent `deciding` out.

        Raises:
            Error: V451 if its action is missing or is not a whole number, and if no day is in progress.
        """
        deciding = self.deciding
        if deciding not in actions:
            raise Error("V451", f"the action of {deciding}, which decides, is missing")
        self.turns.step(actions[deciding])
        answer = (
            self._observations(),
            dict(self.turns.rewards),
            dict(self.turns.terminations),
            dict(self.turns.truncations),
            self._infos(),
        )
        self.agents = [agent for agent in self.agents if not self.turns.terminations[agent]]
        return answer

    def render(self) -> Any:
        """The fleet at the current decision, as `FleetEnv` renders it."""
        return self.turns.render()

    def close(self) -> None:
        """Ends the use of the environment, which holds nothing that has to be given back."""

    def _observations(self) -> dict[str, dict[str, Any]]:
        return {agent: self.turns.observe(agent) for agent in self.agents}

    def _infos(self) -> dict[str, dict[str, Any]]:
        return {agent: dict(self.turns.infos[agent]) for agent in self.agents}

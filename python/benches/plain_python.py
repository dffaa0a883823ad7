"""The fleet environment as one would write it by hand: the rules of a day in Python, observations in numpy.

A baseline to measure the native environments against, and no part of the package. It plays days given as
scenario files (format vertifleet-scenario/1), with the same decisions, observations, masks and terminal
reward as `vertifleet/Fleet-v0` on the paper's network. Left out: forecasts that differ from the demand,
take-off delays, closures, outages, corridors and chargers besides stands; a day that has them is refused.
"""

import heapq
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from gymnasium.spaces import Box, Dict, Discrete
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Observation = dict[str, Floats]

# What features are divided by: [feature_scales] of networks/paper.toml.
STANDS, PASSENGERS, BATTERY_KWH, POWER_KW = 6.0, 300.0, 110.0, 65.0
FARE_USD, PASSENGER_COST_USD, ENERGY_PRICE_USD = 40.0, 20.0, 0.2

LEFT_OUT = {"forecast", "takeoff_delays", "closures", "outages", "corridors"}


class Decision(NamedTuple):
    """An aircraft that is ready for take-off, where it stands, and when (seconds since midnight)."""

    time: int
    aircraft: int
    at: int


class Flight(NamedTuple):
    """What a decision came to: passengers, dollars, kWh, seconds since midnight."""

    passengers: int
    revenue: float
    passenger_cost: float
    energy_kwh: float
    energy_cost: float
    arrival: int
    ready: int


class Leg(NamedTuple):
    """What one aircraft type needs from one vertiport to another; `feasible` with every stand free."""

    energy_kwh: float
    flight_s: int
    charge_s: int
    feasible: bool


class Day:
    """One day in motion: `decision` is the one to be taken now, `decide` takes it."""

    def __init__(self, scenario: Mapping[str, Any]) -> None:
        self._refuse_what_is_left_out(scenario)
        operations = scenario["operations"]
        self.start, self.end = seconds(operations["start"]), seconds(operations["end"])
        self.takeoff_s, self.landing_s = operations["takeoff_s"], operations["landing_s"]
        self.hold_s = operations["hold_s"]

        names = [vertiport["id"] for vertiport in scenario["vertiports"]]
        self.vertiports = len(names)
        self.stands = np.array([vertiport["stands"] for vertiport in scenario["vertiports"]])
        types = [kind["id"] for kind in scenario["aircraft_types"]]
        self.kinds = [types.index(aircraft["type"]) for aircraft in scenario["aircraft"]]
        self.places = [names.index(aircraft["at"]) for aircraft in scenario["aircraft"]]
        self.taken = np.bincount(self.places, minlength=self.vertiports)
        self.types = scenario["aircraft_types"]
        self.legs = [self._legs(kind, scenario["distance_mi"]) for kind in self.types]

        self.periods = [seconds(start) for start in scenario["periods"]]
        self.period = 0
        # [periods x N x N]
        self.demand = np.array(scenario["demand"])
        fares = np.array(scenario["fare"])
        self.fares = np.broadcast_to(fares, self.demand.shape)
        self.passenger_cost = scenario["passenger_cost"]
        self.energy_price = scenario["energy_price"]
        self.potential = float((self.demand * self.fares).sum())

        self.revenue = self.passenger_costs = self.energy_costs = 0.0
        # Ready times with the aircraft's number, which breaks ties; in order, so a heap already.
        self.ready = [(self.start, aircraft) for aircraft in range(len(self.places))]
        self._next_decision()

    @staticmethod
    def _refuse_what_is_left_out(scenario: Mapping[str, Any]) -> None:
        found = sorted(LEFT_OUT & scenario.keys())
        if any("chargers" in vertiport for vertiport in scenario["vertiports"]):
            found.append("chargers")
        if found:
            raise ValueError(f"scenario {scenario['name']!r} has {', '.join(found)}; take a day without them")

    def _legs(self, kind: Mapping[str, Any], distance_mi: Sequence[Sequence[float]]) -> list[list[Leg]]:
        """[from x to]"""
        return [
            [self._leg(kind, mi, start == end) for end, mi in enumerate(row)]
            for start, row in enumerate(distance_mi)
        ]

    def _leg(self, kind: Mapping[str, Any], distance_mi: float, stays: bool) -> Leg:
        cruise_s = nearest_second(3600.0 * distance_mi / kind["speed_mph"])
        flight_s = self.takeoff_s + cruise_s + self.landing_s
        lost_kwh = kind["battery_kwh"] * kind["self_discharge_per_h"] * (flight_s / 3600.0)
        energy_kwh = kind["energy_kwh_per_mi"] * distance_mi + lost_kwh
        charge_s = nearest_second(3600.0 * energy_kwh / kind["charge_kw"])
        # Slack for the rounding of a pair exactly at the end of the range.
        in_range = energy_kwh <= kind["battery_kwh"] * (1.0 + 1e-9)
        return Leg(energy_kwh, flight_s, charge_s, in_range and not stays)

    @property
    def over(self) -> bool:
        """Whether no aircraft has a decision left."""
        return self.decision.time > self.end

    @property
    def profit(self) -> float:
        """Revenue less passenger cost less energy cost so far, dollars."""
        return self.revenue - self.passenger_costs - self.energy_costs

    def decide(self, to: int) -> Flight:
        """Sends the deciding aircraft to a vertiport that is feasible; its own means hold."""
        flight = self._hold() if to == self.decision.at else self._fly(to)
        heapq.heapreplace(self.ready, (flight.ready, self.decision.aircraft))
        self._next_decision()
        return flight

    def _next_decision(self) -> None:
        time, aircraft = self.ready[0]
        while self.period + 1 < len(self.periods) and self.periods[self.period + 1] <= time <= self.end:
            self.period += 1
        self.decision = Decision(time, aircraft, self.places[aircraft])

    def _hold(self) -> Flight:
        time = self.decision.time
        return Flight(0, 0.0, 0.0, 0.0, 0.0, time, time + self.hold_s)

    def _fly(self, to: int) -> Flight:
        time, aircraft, at = self.decision
        kind = self.kinds[aircraft]
        leg = self.legs[kind][at][to]
        passengers = min(self.types[kind]["seats"], int(self.demand[self.period, at, to]))
        arrival = time + leg.flight_s
        flight = Flight(
            passengers,
            passengers * float(self.fares[self.period, at, to]),
            passengers * self.passenger_cost[at][to],
            leg.energy_kwh,
            leg.energy_kwh * self._energy_price_at(arrival),
            arrival,
            arrival + leg.charge_s,
        )
        self.demand[self.period, at, to] -= passengers
        self.taken[at] -= 1
        self.taken[to] += 1
        self.places[aircraft] = to
        self.revenue += flight.revenue
        self.passenger_costs += flight.passenger_cost
        self.energy_costs += flight.energy_cost
        return flight

    def _energy_price_at(self, time: int) -> float:
        period = self.period
        while period + 1 < len(self.periods) and self.periods[period + 1] <= time:
            period += 1
        return float(self.energy_price[period])


class PlainPythonEnv(gymnasium.Env[Observation, np.int64]):
    """Decides for one aircraft after the other; the reward comes with the day's last decision.

    Each day is one of `scenarios`, drawn at random, or the one given as `reset(options={"scenario": ...})`.
    All must have the same number of vertiports.
    """

    def __init__(self, scenarios: Sequence[Mapping[str, Any]]) -> None:
        self.scenarios = scenarios
        n = len(scenarios[0]["vertiports"])
        self.action_space = Discrete(n)
        sizes = {
            "nodes": n * (2 * n + 4),
            "aircraft": 2 * n + 2,
            "clock": 1,
            "adjacency": n * n,
            "action_mask": n,
        }
        self.observation_space = Dict(
            [(name, Box(0, np.inf, (size,), np.float32)) for name, size in sizes.items()]
        )
        self._adjacency = (1 - np.eye(n, dtype=np.float32)).reshape(-1)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Starts a day."""
        super().reset(seed=seed)
        given = (options or {}).get("scenario")
        self.day = Day(given or self.scenarios[int(self.np_random.integers(len(self.scenarios)))])
        self._lay_out_features()
        self._mask = self.action_masks()
        return self._observation(), self._info()

    def step(self, action: int | np.int64) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Takes the decision; an infeasible one holds."""
        invalid = not self._mask[action]
        self.day.decide(self.day.decision.at if invalid else int(action))
        self._mask = self.action_masks()
        over = self.day.over
        reward = self.day.profit / self.day.potential if over and self.day.potential > 0 else 0.0
        return self._observation(), reward, over, False, self._info(invalid)

    def action_masks(self) -> NDArray[np.bool_]:
        """[N]: its own vertiport (hold), and those within range with a stand free."""
        day = self.day
        _, aircraft, at = day.decision
        mask: NDArray[np.bool_] = self._in_range[day.kinds[aircraft], at] & (day.taken < day.stands)
        mask[at] = True
        return mask

    def _info(self, invalid: bool = False) -> dict[str, Any]:
        return {"action_mask": self._mask.astype(np.int8), "invalid_action": bool(invalid)}

    def _lay_out_features(self) -> None:
        """What stays all day: node features but for U, d and r, and each type's state at each vertiport."""
        day = self.day
        n, periods, kinds = day.vertiports, len(day.periods), len(day.types)
        # [periods x N x (2N + 4)]
        self._nodes = np.zeros((periods, n, 2 * n + 4), np.float32)
        self._nodes[:, :, 1] = day.stands.astype(np.float32) * np.float32(1 / STANDS)
        self._nodes[:, :, 4 : 4 + n] = day.fares * (1 / FARE_USD)
        self._nodes[:, :, 4 + n :] = np.array(day.passenger_cost) * (1 / PASSENGER_COST_USD)
        # [types x N x (2N + 2)]
        self._aircraft = np.zeros((kinds, n, 2 * n + 2), np.float32)
        self._aircraft[:, range(n), range(1, n + 1)] = 1
        self._in_range = np.zeros((kinds, n, n), bool)
        for kind, legs in enumerate(day.legs):
            self._aircraft[kind, :, n + 1] = day.types[kind]["battery_kwh"] * (1 / BATTERY_KWH)
            for start, row in enumerate(legs):
                powers_kw = [leg.energy_kwh / (leg.flight_s / 3600.0) for leg in row]
                self._aircraft[kind, start, n + 2 :] = np.array(powers_kw) * (1 / POWER_KW)
                self._in_range[kind, start] = [leg.feasible for leg in row]

    def _observation(self) -> Observation:
        day = self.day
        time, aircraft, at = day.decision
        left = day.demand[day.period]
        nodes = self._nodes[day.period].copy()
        nodes[:, 0] = day.taken.astype(np.float32) * np.float32(1 / STANDS)
        nodes[:, 2] = left.sum(1).astype(np.float32) * np.float32(1 / PASSENGERS)
        nodes[:, 3] = left.sum(0).astype(np.float32) * np.float32(1 / PASSENGERS)
        state = self._aircraft[day.kinds[aircraft], at].copy()
        state[0] = day.energy_price[day.period] * (1 / ENERGY_PRICE_USD)
        left_s, day_s = max(day.end - time, 0), max(day.end - day.start, 1)
        return {
            "nodes": nodes.reshape(-1),
            "aircraft": state,
            "clock": np.array([left_s], np.float32) / np.float32(day_s),
            "adjacency": self._adjacency,
            "action_mask": self._mask.astype(np.float32),
        }


def seconds(clock: str) -> int:
    """Seconds since midnight of HH:MM:SS."""
    hours, minutes, rest = map(int, clock.split(":"))
    return hours * 3600 + minutes * 60 + rest


def nearest_second(duration: float) -> int:
    """Halves go up; `round` would take them to the even second."""
    return int(duration + 0.5)

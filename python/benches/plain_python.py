"""The fleet environment as one would write it by hand: the rules of a day in Python, observations in numpy.

A baseline to measure the native environments against, and no part of the package. It plays days given as
scenario files (format vertifleet-scenario/1), with the same decisions, observations, masks and terminal
reward as `vertifleet/Fleet-v0` on the paper's network. Left out: forecasts that differ from the demand,
take-off delays, closures, outages, corridors and chargers besides stands; a day that has them is refused.
"""

import heapq
import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from itertools import pairwise
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
    ground_s: int
    feasible: bool


class Charger:
    """How fast one aircraft type charges at one vertiport.

    Between two points of its curve the power is linear in the charge, so the charge is exponential in time.
    """

    def __init__(self, kind: Mapping[str, Any], vertiport: Mapping[str, Any]) -> None:
        self.most_kw = min(kind["charge_kw"], vertiport.get("charger_kw", math.inf))
        self.full_mwh = whole_mwh(kind["battery_kwh"])
        # Where each segment begins: charge (mWh), seconds from empty, power (mWh/s) with its slope.
        self.charges: list[float] = []
        self.seconds: list[float] = []
        self.powers: list[tuple[float, float]] = []
        self.full_s = 0.0
        points = kind.get("charge_curve", [[0.0, self.most_kw], [1.0, self.most_kw]])
        for (charge, kw), (next_charge, next_kw) in pairwise(self._limited(points)):
            start, end = charge * self.full_mwh, next_charge * self.full_mwh
            # Between closer points the power steps: a slope could exceed every number.
            if end - start >= 1e-200:
                self._push(start, end, kw, next_kw)

    def _limited(self, points: Sequence[Sequence[float]]) -> list[tuple[float, float]]:
        """The points with at most `most_kw`, and one more wherever the curve crosses it."""
        most, limited = self.most_kw, [(points[0][0], min(points[0][1], self.most_kw))]
        for (charge, kw), (next_charge, next_kw) in pairwise(points):
            if (kw < most) != (next_kw < most):
                share = (most - kw) / (next_kw - kw)
                limited.append((charge + share * (next_charge - charge), most))
            limited.append((next_charge, min(next_kw, most)))
        return limited

    def _push(self, start: float, end: float, kw: float, end_kw: float) -> None:
        power = kw * 1e6 / 3600.0
        self.charges.append(start)
        self.seconds.append(self.full_s)
        self.powers.append((power, (end_kw * 1e6 / 3600.0 - power) / (end - start)))
        self.full_s = self.seconds_to(end)

    def seconds_to(self, mwh: float) -> float:
        """Seconds from an empty battery to a charge."""
        at = max(bisect_right(self.charges, mwh) - 1, 0)
        power, slope = self.powers[at]
        more = mwh - self.charges[at]
        return self.seconds[at] + (math.log1p(slope * more / power) / slope if slope else more / power)

    def charged_mwh(self, mwh: int, seconds: int) -> int:
        """The charge after some seconds, at most a full battery."""
        if seconds == 0 or mwh >= self.full_mwh:
            return mwh
        then = self.seconds_to(mwh) + seconds
        if then >= self.full_s:
            return self.full_mwh
        at = bisect_right(self.seconds, then) - 1
        power, slope = self.powers[at]
        more_s = then - self.seconds[at]
        more = power * math.expm1(slope * more_s) / slope if slope else power * more_s
        return min(max(nearest(self.charges[at] + more), mwh), self.full_mwh)

    def needed_s(self, mwh: int, needed_mwh: int) -> int:
        """The fewest whole seconds to a charge."""
        seconds = max(math.ceil(self.seconds_to(needed_mwh - 0.5) - self.seconds_to(mwh)), 0)
        while self.charged_mwh(mwh, seconds) < needed_mwh:
            seconds += 1
        while seconds > 0 and self.charged_mwh(mwh, seconds - 1) >= needed_mwh:
            seconds -= 1
        return seconds

    def refill_s(self, kind: Mapping[str, Any], energy_kwh: float) -> int:
        """Seconds to charge the last `energy_kwh` of a full battery."""
        if "charge_curve" in kind:
            full_kwh = kind["battery_kwh"]
            return nearest(self.seconds_to(1e6 * full_kwh) - self.seconds_to(1e6 * (full_kwh - energy_kwh)))
        return nearest(3600.0 * energy_kwh / self.most_kw)


class Day:
    """One day in motion: `decision` is the one to be taken now, `decide` takes it."""

    def __init__(self, scenario: Mapping[str, Any]) -> None:
        self._refuse_what_is_left_out(scenario)
        operations = scenario["operations"]
        self.start, self.end = seconds(operations["start"]), seconds(operations["end"])
        self.takeoff_s, self.landing_s = operations["takeoff_s"], operations["landing_s"]
        self.hold_s = operations["hold_s"]
        self.as_needed = operations.get("charging") == "as_needed"

        names = [vertiport["id"] for vertiport in scenario["vertiports"]]
        self.vertiports = len(names)
        self.stands = np.array([vertiport["stands"] for vertiport in scenario["vertiports"]])
        types = [kind["id"] for kind in scenario["aircraft_types"]]
        self.kinds = [types.index(aircraft["type"]) for aircraft in scenario["aircraft"]]
        self.places = [names.index(aircraft["at"]) for aircraft in scenario["aircraft"]]
        self.taken = np.bincount(self.places, minlength=self.vertiports)
        self.types = scenario["aircraft_types"]
        # [types x N]
        self.chargers = [[Charger(kind, place) for place in scenario["vertiports"]] for kind in self.types]
        self.legs = [self._legs(kind, scenario["distance_mi"]) for kind in range(len(self.types))]

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
        # What each battery holds at its latest landing, and when that is.
        self.landed_mwh = [
            whole_mwh(one.get("start_charge_kwh", self.types[kind]["battery_kwh"]))
            for one, kind in zip(scenario["aircraft"], self.kinds, strict=True)
        ]
        self.landed = [self.start] * len(self.places)
        # Ready times with the aircraft's number, which breaks ties.
        self.ready = [(self._first(aircraft), aircraft) for aircraft in range(len(self.places))]
        heapq.heapify(self.ready)
        self._next_decision()

    def _first(self, aircraft: int) -> int:
        """The time of an aircraft's first decision: where days charge to full, when its battery is."""
        kind = self.types[self.kinds[aircraft]]
        missing_kwh = kind["battery_kwh"] - self.landed_mwh[aircraft] / 1e6
        if self.as_needed or missing_kwh == 0.0:
            return self.start
        return self.start + self._charger(aircraft).refill_s(kind, missing_kwh)

    def _charger(self, aircraft: int) -> Charger:
        return self.chargers[self.kinds[aircraft]][self.places[aircraft]]

    @staticmethod
    def _refuse_what_is_left_out(scenario: Mapping[str, Any]) -> None:
        found = sorted(LEFT_OUT & scenario.keys())
        if any("chargers" in vertiport for vertiport in scenario["vertiports"]):
            found.append("chargers")
        if found:
            raise ValueError(f"scenario {scenario['name']!r} has {', '.join(found)}; take a day without them")

    def _legs(self, kind: int, distance_mi: Sequence[Sequence[float]]) -> list[list[Leg]]:
        """[from x to]"""
        return [
            [self._leg(kind, mi, end, start == end) for end, mi in enumerate(row)]
            for start, row in enumerate(distance_mi)
        ]

    def _leg(self, kind_at: int, distance_mi: float, end: int, stays: bool) -> Leg:
        kind = self.types[kind_at]
        cruise_s = nearest(3600.0 * distance_mi / kind["speed_mph"])
        flight_s = self.takeoff_s + cruise_s + self.landing_s
        lost_kwh = kind["battery_kwh"] * kind["self_discharge_per_h"] * (flight_s / 3600.0)
        energy_kwh = kind["energy_kwh_per_mi"] * distance_mi + lost_kwh
        in_range = needed_mwh(kind, energy_kwh) <= whole_mwh(kind["battery_kwh"])
        ground_s = kind.get("turnaround_s", 0)
        if in_range and not self.as_needed:
            ground_s = max(ground_s, self.chargers[kind_at][end].refill_s(kind, energy_kwh))
        return Leg(energy_kwh, flight_s, ground_s, in_range and not stays)

    def charge_mwh(self, aircraft: int, time: int) -> int:
        """What a battery holds on a day that charges as needed, from its landing until it takes off."""
        return self._charger(aircraft).charged_mwh(self.landed_mwh[aircraft], time - self.landed[aircraft])

    def takeoff(self, to: int) -> int:
        """When the deciding aircraft has the charge for a flight within range."""
        time, aircraft, at = self.decision
        if not self.as_needed:
            return time
        kind = self.kinds[aircraft]
        needed = needed_mwh(self.types[kind], self.legs[kind][at][to].energy_kwh)
        wait_s = self._charger(aircraft).needed_s(self.landed_mwh[aircraft], needed)
        return max(time, self.landed[aircraft] + wait_s)

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
        _, aircraft, at = self.decision
        kind = self.kinds[aircraft]
        leg = self.legs[kind][at][to]
        passengers = min(self.types[kind]["seats"], int(self.demand[self.period, at, to]))
        takeoff = self.takeoff(to)
        arrival = takeoff + leg.flight_s
        flight = Flight(
            passengers,
            passengers * float(self.fares[self.period, at, to]),
            passengers * self.passenger_cost[at][to],
            leg.energy_kwh,
            leg.energy_kwh * self._energy_price_at(arrival),
            arrival,
            arrival + leg.ground_s,
        )
        if self.as_needed:
            self.landed_mwh[aircraft] = self.charge_mwh(aircraft, takeoff) - whole_mwh(leg.energy_kwh)
        self.landed[aircraft] = arrival
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
        if day.as_needed:
            for to in np.flatnonzero(mask):
                mask[to] = day.takeoff(int(to)) <= day.end
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
        if day.as_needed:
            charge_kwh = day.charge_mwh(aircraft, time) / 1e6
            state[day.vertiports + 1] = charge_kwh * (1 / BATTERY_KWH)
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


def nearest(number: float) -> int:
    """Halves go up; `round` would take them to the even number."""
    return int(number + 0.5)


def whole_mwh(kwh: float) -> int:
    """An energy in whole milliwatt-hours."""
    return nearest(1e6 * kwh)


def needed_mwh(kind: Mapping[str, Any], energy_kwh: float) -> int:
    """What a battery holds at least when a flight takes off."""
    return whole_mwh(energy_kwh) + whole_mwh(kind.get("reserve_kwh", 0.0))

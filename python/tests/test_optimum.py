"""Plans and bounds of small days against a mixed-integer programme, which shares no code with them.

All flights and holds of these days last a whole number of ticks, so that the programme can have one variable
for each choice at each tick. HiGHS solves it.
"""

from __future__ import annotations

import json
from typing import Any

import highspy
import numpy as np
import pytest

import vertifleet

TICK_S = 300
HOLD = 2
SEATS = 4
HOURS = 4
TICKS_AN_HOUR = 12
LAST = HOURS * TICKS_AN_HOUR


def grid_day(seed: int) -> dict[str, Any]:
    """A day of a few vertiports, which are 10, 15 or 20 miles apart.

    At 60 mph, a flight takes 2, 3 or 4 ticks in the air and as many on the charger, plus one tick for
    take-off and landing.
    """
    random = np.random.default_rng(seed)
    vertiports, fleet = int(random.integers(3, 5)), int(random.integers(3, 7))
    miles = random.choice([10.0, 15.0, 20.0], size=(vertiports, vertiports))
    miles = np.triu(miles, 1) + np.triu(miles, 1).T
    stands = random.integers(2, 4, size=vertiports)
    starts = random.permutation(np.repeat(np.arange(vertiports), stands))[:fleet]
    periods = HOURS + 1
    demand = random.poisson(5.0, size=(periods, vertiports, vertiports))
    for table in demand:
        np.fill_diagonal(table, 0)
    return {
        "format": "vertifleet-scenario/1",
        "name": f"grid-{seed}",
        "seed": seed,
        "operations": {
            "start": "06:00:00",
            "end": f"{6 + HOURS:02}:00:00",
            "takeoff_s": TICK_S // 2,
            "landing_s": TICK_S // 2,
            "hold_s": HOLD * TICK_S,
        },
        "vertiports": [
            {"id": f"V{at}", "x_mi": 7.0 * at, "y_mi": 0.0, "stands": int(stands[at]), "busy": False}
            for at in range(vertiports)
        ],
        "aircraft_types": [
            {
                "id": "taxi",
                "seats": SEATS,
                "speed_mph": 60.0,
                "battery_kwh": 100.0,
                "energy_kwh_per_mi": 1.0,
                "charge_kw": 60.0,
                "self_discharge_per_h": 0.0,
            }
        ],
        "aircraft": [
            {"id": f"A{number}", "type": "taxi", "at": f"V{at}"} for number, at in enumerate(starts)
        ],
        "distance_mi": miles.tolist(),
        "fare": (2.0 * miles + 5.0 * (miles > 0)).tolist(),
        "passenger_cost": (0.5 * miles).tolist(),
        "periods": [f"{6 + hour:02}:00:00" for hour in range(periods)],
        "demand": demand.tolist(),
        "energy_price": [0.2 + 0.05 * (hour % 3) for hour in range(periods)],
    }


def best_profit_usd(day: dict[str, Any], *, frees_first: bool) -> tuple[float, float]:
    """The optimum of a day, as the profit of a schedule and as a slightly higher upper bound.

    If aircraft leave a vertiport in the tick in which others fly to it, `frees_first` decides whether all of
    their stands are free before, or none of them. The optimum lies between, because aircraft decide in file
    order.
    """
    miles, fares = np.array(day["distance_mi"]), np.array(day["fare"])
    margins, demand = fares - np.array(day["passenger_cost"]), np.array(day["demand"])
    size = len(miles)
    pairs = [(i, j) for i in range(size) for j in range(size) if i != j]
    in_the_air = {pair: 1 + int(miles[pair]) // 5 for pair in pairs}
    block = {pair: in_the_air[pair] + int(miles[pair]) // 5 for pair in pairs}
    ticks = range(LAST + 1)
    period = [tick // TICKS_AN_HOUR for tick in range(2 * LAST)]

    model = highspy.Highs()
    model.silent()
    price = day["energy_price"]

    def cost_usd(pair: tuple[int, int], tick: int) -> float:
        return float(miles[pair]) * price[min(period[tick + in_the_air[pair]], len(price) - 1)]

    flights = {(p, t): model.addIntegral(obj=-cost_usd(p, t)) for p in pairs for t in ticks}
    holds = {(i, t): model.addIntegral() for i in range(size) for t in ticks}
    places = [vertiport["id"] for vertiport in day["vertiports"]]
    starts = np.bincount([places.index(one["at"]) for one in day["aircraft"]], minlength=size)
    stands = [vertiport["stands"] for vertiport in day["vertiports"]]

    for i in range(size):
        away = [pair for pair in pairs if pair[0] == i]
        towards = [pair for pair in pairs if pair[1] == i]
        taken = int(starts[i])
        for t in ticks:
            leave = sum(flights[p, t] for p in away)
            ready = [flights[p, t - block[p]] for p in towards if t >= block[p]]
            ready += [holds[i, t - HOLD]] if t >= HOLD else []
            model.addConstr(sum(ready) + (int(starts[i]) if t == 0 else 0) == leave + holds[i, t])
            come = sum(flights[p, t] for p in towards)
            model.addConstr(taken + come - (leave if frees_first else 0) <= stands[i])
            taken = taken + come - leave
    for p in pairs:
        for hour in range(HOURS + 1):
            flown = sum(flights[p, t] for t in ticks if period[t] == hour)
            carried = model.addVariable(0, float(demand[hour][p]), obj=float(margins[p]))
            model.addConstr(carried <= SEATS * flown)
    model.maximize()
    assert model.getModelStatus() == highspy.HighsModelStatus.kOptimal
    return model.getObjectiveValue(), model.getInfo().mip_dual_bound


# Days that HiGHS solves in a few seconds.
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_plan_is_as_good_as_the_optimum_and_the_bound_is_above_it(seed: int) -> None:
    day = grid_day(seed)
    scenario = vertifleet.Scenario.from_json(json.dumps(day))
    possible_usd, _ = best_profit_usd(day, frees_first=False)
    _, most_usd = best_profit_usd(day, frees_first=True)
    plan = vertifleet.plan(scenario, steps=20_000, seed=1)
    bound_usd = vertifleet.bound(scenario, step=1).upper_bound_usd
    assert 0.999 * possible_usd <= plan.profit_usd <= most_usd + 1e-6
    assert most_usd <= 1.0001 * bound_usd
    assert bound_usd <= 1.005 * most_usd

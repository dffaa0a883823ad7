"""The baseline keeps the rules: it plays whole days as the package does, each decision to the last digit."""

import csv
import io
import json
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from plain_python import LEFT_OUT, Day, PlainPythonEnv, seconds

import vertifleet

Scenario = dict[str, Any]
Row = dict[str, str]


def draw(network: str, seed: int) -> Scenario:
    """A day without what the baseline leaves out."""
    scenario: Scenario = json.loads(vertifleet.Network(network).draw(seed).to_json())
    return {member: value for member, value in scenario.items() if member not in LEFT_OUT}


def as_drawn(scenario: Scenario) -> Scenario:
    return scenario


def with_self_discharge(scenario: Scenario) -> Scenario:
    types = [kind | {"self_discharge_per_h": 0.1} for kind in scenario["aircraft_types"]]
    return scenario | {"aircraft_types": types}


def with_short_range(scenario: Scenario) -> Scenario:
    types = [kind | {"battery_kwh": 60.0} for kind in scenario["aircraft_types"]]
    return scenario | {"aircraft_types": types}


def with_few_stands(scenario: Scenario) -> Scenario:
    """One stand free at each vertiport when the day starts."""
    places = [aircraft["at"] for aircraft in scenario["aircraft"]]
    vertiports = scenario["vertiports"]
    changed = [vertiport | {"stands": places.count(vertiport["id"]) + 1} for vertiport in vertiports]
    return scenario | {"vertiports": changed}


def with_little_demand(scenario: Scenario) -> Scenario:
    demand = [[[min(cell, 3) for cell in row] for row in table] for table in scenario["demand"]]
    return scenario | {"demand": demand}


def with_a_curve(scenario: Scenario) -> Scenario:
    """Charging that tapers, weak chargers, a turnaround, and aircraft that start with any charge."""
    curve = [[0.0, 120.0], [0.3, 160.0], [0.8, 100.0], [1.0, 30.0]]
    of_type = {"charge_curve": curve, "turnaround_s": 400, "reserve_kwh": 10}
    types = [kind | of_type for kind in scenario["aircraft_types"]]
    vertiports = [
        place | ({"charger_kw": 60.0 + 20.0 * at} if at % 2 else {})
        for at, place in enumerate(scenario["vertiports"])
    ]
    fleet = [one | {"start_charge_kwh": 3.5 * (at % 31)} for at, one in enumerate(scenario["aircraft"])]
    return scenario | {"aircraft_types": types, "vertiports": vertiports, "aircraft": fleet}


# Days of the networks themselves, and days on which rules bind that they leave slack: network,
# seed, change.
DAYS: dict[str, tuple[str, int, Callable[[Scenario], Scenario]]] = {
    **{f"paper-{seed}": ("paper", seed, as_drawn) for seed in (1, 2, 3)},
    **{f"new-york-{seed}": ("new-york", seed, as_drawn) for seed in (1, 2)},
    "disrupted-7": ("disrupted", 7, as_drawn),
    "paper-quick-1": ("paper-quick", 1, as_drawn),
    "new-york-quick-1": ("new-york-quick", 1, as_drawn),
    "paper-8 with a curve": ("paper", 8, with_a_curve),
    "paper-quick-8 with a curve": ("paper-quick", 8, with_a_curve),
    "paper-4 with self-discharge": ("paper", 4, with_self_discharge),
    "paper-5 with short range": ("paper", 5, with_short_range),
    "paper-6 with few stands": ("paper", 6, with_few_stands),
    "paper-7 with little demand": ("paper", 7, with_little_demand),
}


@pytest.fixture(params=DAYS)
def scenario(request: pytest.FixtureRequest) -> Scenario:
    network, seed, change = DAYS[request.param]
    return change(draw(network, seed))


def simulate(scenario: Scenario) -> tuple[list[Row], dict[str, float]]:
    """Trace and summary of the random policy."""
    played = vertifleet.simulate(vertifleet.Scenario.from_json(json.dumps(scenario)), "random", seed=3)
    return list(csv.DictReader(io.StringIO(played.trace.to_csv()))), played.summary


def test_every_decision_comes_to_what_the_package_says(scenario: Scenario) -> None:
    rows, summary = simulate(scenario)
    vertiports = [vertiport["id"] for vertiport in scenario["vertiports"]]
    day = Day(scenario)
    for row in rows:
        time, aircraft, at = day.decision
        deciding = (time, scenario["aircraft"][aircraft]["id"], vertiports[at])
        assert deciding == (seconds(row["time"]), row["aircraft"], row["from"])
        if day.as_needed:
            assert day.charge_mwh(aircraft, time) / 1e6 == float(row["charge_kwh"])
        if day.as_needed and row["to"] != row["from"]:
            assert day.takeoff(vertiports.index(row["to"])) == seconds(row["takeoff"])
        assert day.decide(vertiports.index(row["to"])) == (
            int(row["passengers"]),
            *(float(row[name]) for name in ("revenue", "passenger_cost", "energy_kwh", "energy_cost")),
            seconds(row["arrival"]),
            seconds(row["ready"]),
        )
    assert day.over
    assert day.profit == summary["profit_usd"]
    assert day.potential == pytest.approx(summary["potential_usd"], rel=1e-12)


def test_the_masks_admit_all_that_the_package_chose_and_the_reward_is_its_own(scenario: Scenario) -> None:
    rows, summary = simulate(scenario)
    vertiports = [vertiport["id"] for vertiport in scenario["vertiports"]]
    environment = PlainPythonEnv([scenario])
    _, info = environment.reset(seed=1)
    rewards, ends = [], []
    for row in rows:
        action = vertiports.index(row["to"])
        assert info["action_mask"][action] == 1
        _, reward, over, _, info = environment.step(action)
        assert info["invalid_action"] is False
        rewards.append(reward)
        ends.append(over)
    assert ends == [False] * (len(rows) - 1) + [True]
    assert rewards[:-1] == [0.0] * (len(rows) - 1)
    assert rewards[-1] == pytest.approx(summary["reward"], rel=1e-12)


def test_no_aircraft_flies_where_every_stand_is_taken_or_the_battery_does_not_reach() -> None:
    scenario = with_short_range(with_few_stands(draw("paper", 8)))
    reach_mi = 60.0 / scenario["aircraft_types"][0]["energy_kwh_per_mi"]
    environment = PlainPythonEnv([scenario])
    draws = np.random.default_rng(5)
    environment.reset(seed=1)
    full, far, flights, over = 0, 0, 0, False
    while not over:
        day, mask = environment.day, environment.action_masks()
        at = day.decision.at
        promised = np.bincount(day.places, minlength=day.vertiports)
        for to in set(range(day.vertiports)) - {at}:
            too_far, no_stand = scenario["distance_mi"][at][to] > reach_mi, promised[to] == day.stands[to]
            assert mask[to] == (not too_far and not no_stand)
            full, far = full + bool(no_stand), far + bool(too_far)
        assert mask[at]
        action = draws.choice(np.flatnonzero(mask))
        flights += int(action != at)
        over = environment.step(action)[2]
    assert min(full, far, flights) > 100


def test_an_infeasible_action_holds() -> None:
    scenario = with_short_range(draw("paper", 9))
    environment = PlainPythonEnv([scenario])
    _, info = environment.reset(seed=1)
    before = environment.day.decision
    _, _, _, _, info = environment.step(int(np.argmin(info["action_mask"])))
    assert info["invalid_action"] is True
    assert (before.time + scenario["operations"]["hold_s"], before.aircraft) in environment.day.ready
    assert environment.day.places[before.aircraft] == before.at


def test_a_day_with_what_is_left_out_is_refused() -> None:
    with pytest.raises(ValueError, match="outages"):
        Day(json.loads(vertifleet.Network("disrupted").draw(1).to_json()))
    with pytest.raises(ValueError, match="chargers"):
        Day(json.loads(vertifleet.Network("as-coded").draw(1).to_json()))


@pytest.mark.filterwarnings("ignore:.*maximum value is infinity")
@pytest.mark.filterwarnings("ignore:.*alternative render modes")
def test_gymnasium_finds_nothing_wrong() -> None:
    check_env(PlainPythonEnv([draw("paper", seed) for seed in (1, 2)]))


@pytest.mark.parametrize("network", ["paper", "paper-quick"])
def test_observations_are_those_of_the_native_environment(network: str) -> None:
    for seed in (1, 2):
        scenario = draw(network, seed)
        ours = PlainPythonEnv([scenario])
        native = gymnasium.make("vertifleet/Fleet-v0", network=network)
        options = {"scenario": vertifleet.Scenario.from_json(json.dumps(scenario))}
        draws = np.random.default_rng(seed)
        one, info = ours.reset(seed=1)
        two, _ = native.reset(seed=1, options=options)
        over = False
        while not over:
            for name, values in two.items():
                np.testing.assert_array_equal(one[name], values, name)
            action = draws.choice(np.flatnonzero(info["action_mask"]))
            one, reward, over, _, info = ours.step(action)
            two, native_reward, native_over, _, _ = native.step(action)
            assert over == native_over
            assert reward == pytest.approx(native_reward, rel=1e-6)

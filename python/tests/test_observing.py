"""Observations, views, rewards and networks of the caller's choice."""

from __future__ import annotations

import copy
import json
import pickle
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env
from numpy.typing import NDArray

import vertifleet
from vertifleet import FunctionPolicy, Network, Outcome, OwnObservation, View
from vertifleet.envs import VARIANTS, FleetEnv, FleetVectorEnv


def greedy(view: View) -> int:
    """The flight with the highest profit an hour, as the built-in rule has it."""
    hours = np.where(view.choice_block_time_h > 0, view.choice_block_time_h, np.inf)
    rate = np.where(view.action_mask == 1, view.choice_profit_usd / hours, -np.inf)
    rate[view.decision.place] = 0.0
    return int(rate.argmax())


@pytest.mark.parametrize("variant", VARIANTS)
def test_every_variant_is_a_gymnasium_environment(variant: str) -> None:
    env = gymnasium.make(variant)
    check_env(env.unwrapped, skip_render_check=True)
    observation, info = env.reset(seed=3)
    while True:
        assert env.observation_space.contains(observation)
        assert np.array_equal(observation["action_mask"], info["action_mask"])
        observation, _, over, _, info = env.step(int(info["action_mask"].argmax()))
        if over:
            break
    assert env.observation_space.contains(observation)


@pytest.mark.parametrize(
    "observation", ["paper", "full", "full-v1", "gcaps-x", "gcaps-full", ["demand_left", "fleet_ready"]]
)
def test_a_batch_has_the_observations_of_single_environments(observation: Any) -> None:
    batch = FleetVectorEnv(3, "disrupted", observation=observation, threads=2)
    alone = [FleetEnv("disrupted", observation=observation) for _ in range(3)]
    shown, info = batch.reset(seed=7)
    ones = [env.reset(seed=7 + at)[0] for at, env in enumerate(alone)]
    for _ in range(40):
        assert set(shown) == set(ones[0])
        for at, one in enumerate(ones):
            for name, array in one.items():
                assert np.array_equal(shown[name][at], array), name
        actions = info["action_mask"].argmax(axis=1)
        shown, *_, info = batch.step(actions)
        ones = [env.step(int(action))[0] for env, action in zip(alone, actions, strict=True)]


def test_a_view_has_the_same_numbers_in_units_and_is_read_only() -> None:
    env = FleetEnv("disrupted", observation="full")
    observation, _ = env.reset(seed=2)
    for _ in range(30):
        view = env.view
        assert np.allclose(view.demand_left, 10 * observation["demand_left"])
        assert np.allclose(view.choice_profit_usd, 100 * observation["choice_profit"], atol=1e-3)
        assert np.allclose(view.fare_usd, 100 * observation["fare"], rtol=1e-5)
        assert np.array_equal(view.fleet_flying, observation["fleet_flying"])
        assert view.decision.place == observation["place"].argmax()
        assert view.demand_left is view.demand_left, "an array is made once"
        with pytest.raises(ValueError, match="read-only"):
            view.demand_left[0, 1] = 5
        observation, *_ = env.step(int(env.action_masks().argmax()))
    with pytest.raises(AttributeError, match="scenario"):
        _ = view.scenario


def table(day: vertifleet.Scenario, member: str) -> NDArray[np.float64]:
    """A table of a day's file."""
    return np.array(json.loads(day.to_json())[member], np.float64)


def test_a_view_shows_the_forecast_and_the_fares_of_every_period_and_no_demand_before_its_time() -> None:
    env = FleetEnv("disrupted", observation="full-v1")
    observation, _ = env.reset(seed=2)
    day = env.scenario
    assert day is not None
    forecast, actual = table(day, "forecast"), table(day, "demand")
    assert not np.array_equal(forecast, actual)
    periods, over = set(), False
    while not over:
        view = env.view
        now = view.period
        assert not view.forecast[:now].any()
        assert np.array_equal(view.forecast[now], view.demand_left)
        assert np.array_equal(view.forecast[now + 1 :], forecast[now + 1 :])
        if now not in periods:
            assert not np.array_equal(view.forecast[now + 1 :], actual[now + 1 :]) or now + 2 > len(actual)
            assert (view.demand_left <= actual[now]).all()
        periods.add(now)
        assert np.allclose(observation["forecast"], view.forecast / 10)
        assert np.allclose(observation["fares"], view.fares_usd / 100)
        assert np.array_equal(view.fares_usd[now], view.fare_usd)
        if now + 1 < len(forecast):
            assert np.array_equal(view.forecast[now + 1], view.demand_next)
            assert np.array_equal(view.fares_usd[now + 1], view.fare_next_usd)
        observation, _, over, _, _ = env.step(int(env.action_masks().argmax()))
    assert len(periods) == len(forecast)


def test_a_view_has_the_legs_of_every_type_and_the_day_s_times_and_closures() -> None:
    env = FleetEnv("new-york-quick")
    env.reset(seed=2)
    day, view = json.loads(env.scenario.to_json()), env.view
    assert len(view.types) == len(day["aircraft_types"]) == 2
    for kind, (found, written) in enumerate(zip(view.types, day["aircraft_types"], strict=True)):
        for name in ("id", "seats", "speed_mph", "battery_kwh", "reserve_kwh", "turnaround_s"):
            assert getattr(found, name) == written[name], name
        assert [list(point) for point in found.charge_curve or []] == written["charge_curve"]
        hours = np.array(day["distance_mi"]) / written["speed_mph"]
        flown = view.type_reachable[kind] == 1
        taxi_h = (day["operations"]["takeoff_s"] + day["operations"]["landing_s"]) / 3600
        assert np.allclose(view.type_flight_time_h[kind][flown], hours[flown] + taxi_h, atol=1e-3)
        assert (view.charger_power_kw[kind] <= written["charge_kw"]).all()
    own = view.aircraft_type
    for name in ("flight_time_h", "block_time_h", "energy_kwh", "reachable"):
        assert np.array_equal(getattr(view, f"type_{name}")[own], getattr(view, name)), name
    assert view.charges_as_needed
    assert view.hold_s == day["operations"]["hold_s"]
    assert len(view.period_starts_s) == len(view.forecast)


def test_a_view_shows_the_known_closures_of_the_whole_day_and_no_others() -> None:
    env = FleetEnv("disrupted")
    written = json.loads(Network("disrupted").draw(2, "training").to_json())
    at = {"from": "V2", "to": "V5", "both_ways": False}
    known = at | {"start": "14:00:00", "end": "16:30:00", "known": True}
    hidden = at | {"start": "10:00:00", "end": "11:00:00", "known": False}
    written["closures"] = [known, hidden]
    env.reset(options={"scenario": vertifleet.Scenario.from_json(json.dumps(written))})
    found, unexpected, over = {tuple(env.view.known_closures)}, set(), False
    while not over:
        found.add(tuple(env.view.known_closures))
        unexpected.add((env.view.decision.time_s // 3600, float(env.view.closed_unexpectedly[1, 4])))
        over = env.step(int(env.action_masks().argmax()))[2]
    assert found == {((1, 4, 14 * 3600, 16 * 3600 + 1800),)}
    assert {hour for hour, closed in unexpected if closed} == {10}


CHARGE = ["choice_wait", "choice_charge", "fleet_charge"]


class Recorder:
    """A policy that takes the feasible choices in turn, and records what views show of charge."""

    def __init__(self) -> None:
        self.seen: list[tuple[float, ...]] = []

    def reset(self, view: View) -> None:
        assert view.decision.step == 0

    def choose(self, decision: vertifleet.Decision, view: View) -> int:
        feasible = np.flatnonzero(view.action_mask)
        choice = int(feasible[decision.step % len(feasible)])
        of_fleet = view.fleet_charge_kwh[decision.aircraft]
        hours = (view.choice_wait_h[choice], view.choice_flight_time_h[choice])
        self.seen.append((view.charge_kwh, of_fleet, *hours, view.choice_charge_kwh[choice]))
        return choice


def test_a_view_shows_the_charge_and_the_times_that_the_trace_has() -> None:
    network, recorder = Network("paper-quick"), Recorder()
    trace = vertifleet.simulate(network.draw(3), recorder, network=network).trace.columns
    charge, of_fleet, wait_h, flight_h, after = np.array(recorder.seen).T
    assert np.array_equal(trace["charge_kwh"], charge)
    assert np.allclose(of_fleet, charge)
    assert np.allclose(trace["takeoff"] - trace["time"], 3600 * wait_h, atol=0.01)
    assert np.allclose(trace["arrival"] - trace["time"], 3600 * flight_h, atol=0.01)
    assert (wait_h > 0).sum() > 20
    assert charge.min() < 55
    for aircraft in range(40):
        own = trace["aircraft"] == aircraft
        assert np.allclose(charge[own][1:], after[own][:-1])


@pytest.mark.parametrize("network", ["new-york-quick", "disrupted"])
def test_observations_of_charge_are_those_of_views_and_full_where_days_charge_to_full(network: str) -> None:
    batch = FleetVectorEnv(2, network, observation=CHARGE, threads=2)
    env = FleetEnv(network, observation=CHARGE)
    shown, _ = batch.reset(seed=7)
    one, info = env.reset(seed=7)
    waits = 0
    for step in range(200):
        assert env.observation_space.contains(one)
        view, feasible = env.view, np.flatnonzero(info["action_mask"])
        for name, scale, in_view in [
            ("choice_wait", 1, view.choice_wait_h),
            ("choice_charge", 100, view.choice_charge_kwh),
            ("fleet_charge", 100, view.fleet_charge_kwh),
        ]:
            assert np.array_equal(shown[name][0], one[name]), name
            assert np.allclose(in_view, scale * one[name]), name
        waits += int((one["choice_wait"] > 0).sum())
        if network == "disrupted":
            assert np.allclose(one["fleet_charge"], 1.1)
            assert np.allclose(one["choice_charge"][feasible], 1.1)
            assert view.charge_kwh == 110
        action = int(feasible[step % len(feasible)])
        one, *_, info = env.step(action)
        shown, *_ = batch.step([action, action])
    assert (waits > 0) == (network == "new-york-quick")


def test_a_day_on_which_no_aircraft_is_full_in_time_is_refused() -> None:
    day = json.loads(Network("paper").draw(1).to_json())
    for aircraft in day["aircraft"]:
        aircraft["start_charge_kwh"] = 0
    for kind in day["aircraft_types"]:
        kind["charge_kw"] = 1
    scenario = vertifleet.Scenario.from_json(json.dumps(day))
    with pytest.raises(vertifleet.Error, match="has no decisions"):
        FleetEnv().reset(options={"scenario": scenario})
    with pytest.raises(vertifleet.Error, match="has no decisions"):
        FleetVectorEnv(2).reset(options={"scenario": [scenario, scenario]})


def test_a_network_that_may_draw_such_days_is_refused() -> None:
    text = Network("paper").toml.replace("charge_kw = 150", "charge_kw = 6", 1)

    def starting_with(share: float) -> Network:
        charge = f"start_charge = [{share}, 0.5]\n\n[operations]"
        return Network.from_toml(text.replace("[operations]", charge, 1))

    FleetVectorEnv(2, starting_with(0.35)).reset(seed=1)
    for environment in (FleetEnv, FleetVectorEnv):
        with pytest.raises(vertifleet.Error, match="may draw days that have no decisions"):
            environment(network=starting_with(0.34))


def test_views_have_the_members_of_their_class() -> None:
    env = FleetEnv("disrupted")
    env.reset(seed=1)
    arrays = [name for name, kind in View.__annotations__.items() if kind == "Numbers"]
    assert len(arrays) > 20
    for name in arrays:
        assert getattr(env.view, name).dtype == np.float32, name


def test_an_observation_of_the_caller() -> None:
    def seen(view: View) -> NDArray[np.float32]:
        return view.choice_profit_usd / 100

    own = OwnObservation(seen, spaces.Box(-np.inf, np.inf, (8,), np.float32))
    env = FleetEnv(observation=own)
    observation, _ = env.reset(seed=1)
    assert env.observation_space.contains(observation)
    batch = FleetVectorEnv(2, observation=own)
    shown, info = batch.reset(seed=1)
    assert shown.shape == (2, 8)
    assert np.array_equal(shown[0], observation)
    shown, *_ = batch.step(info["action_mask"].argmax(axis=1))
    assert batch.observation_space.contains(shown)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_reward_of_the_caller_gets_the_decision_and_its_outcome(mode: str) -> None:
    def dollars(view: View, outcome: Outcome) -> float:
        assert view.decision.aircraft == outcome["aircraft"]
        assert view.decision.place == outcome["origin"]
        return outcome["profit_usd"]

    env = FleetEnv(reward=dollars)
    env.reset(seed=5)
    total, over = 0.0, False
    while not over:
        _, reward, over, _, info = env.step(greedy(env.view))
        total += reward
    assert total == pytest.approx(info["summary"]["profit_usd"])
    batch = FleetVectorEnv(2, reward=dollars, autoreset_mode=mode)
    batch.reset(seed=5)
    first = 0.0
    while True:
        _, rewards, over, _, _ = batch.step([greedy(batch.view(at)) for at in range(2)])
        first += rewards[0]
        if over[0]:
            break
    assert first == pytest.approx(total)


def test_days_of_a_split_are_days_of_no_other() -> None:
    seeds = {}
    for split, purpose in [
        ("training", "training"),
        ("validation", "validation"),
        ("comparison", "comparison"),
    ]:
        env = FleetEnv(split=split)  # type: ignore[arg-type]
        env.reset(options={"number": 4})
        assert env.scenario is not None
        assert env.scenario == Network("paper").draw(4, purpose)  # type: ignore[arg-type]
        seeds[split] = env.scenario.seed
    assert len(set(seeds.values())) == 3
    with pytest.raises(vertifleet.Error) as error:
        FleetEnv(split="validation").reset(options={"number": 2**41})
    assert error.value.code == "V118"


def test_a_new_network_is_drawn_for_each_day() -> None:
    env = FleetEnv("random-places:6", observation="full")
    places = set()
    for seed in range(4):
        observation, _ = env.reset(seed=seed)
        assert env.observation_space.contains(observation)
        assert observation["vertiport_mask"].sum() == 6
        places.add(observation["distance"].tobytes())
    assert len(places) == 4
    batch = FleetVectorEnv(8, "random", observation="full")
    observation, info = batch.reset(seed=1)
    sizes = observation["vertiport_mask"].sum(axis=1)
    assert len(set(sizes.tolist())) > 2
    for _ in range(20):
        outside = info["action_mask"] > observation["vertiport_mask"]
        assert not outside.any()
        observation, *_, info = batch.step(info["action_mask"].argmax(axis=1))
    assert batch.observation_space.contains(observation)


def test_days_of_a_list_of_networks_come_in_turn() -> None:
    env = FleetEnv(["paper", "new-york"], observation="full")
    names = set()
    for number in range(4):
        env.reset(options={"number": number})
        assert env.scenario is not None
        names.add(env.scenario.name.rsplit("-", 1)[0])
    assert names == {"paper", "new-york"}
    with pytest.raises(vertifleet.Error, match="full"):
        FleetEnv(["paper", "new-york"])


@pytest.mark.parametrize("network", ["paper", "random", "random-places:5"])
def test_copies_and_pickles_continue_alike(network: str) -> None:
    env = FleetEnv(network, observation="full")
    env.reset(seed=3)
    for _ in range(25):
        env.step(int(env.action_masks().argmax()))
    others = [copy.deepcopy(env), pickle.loads(pickle.dumps(env))]
    for _ in range(25):
        action = int(env.action_masks().argmax())
        expected = env.step(action)[0]
        for other in others:
            found = other.step(action)[0]
            assert all(np.array_equal(found[name], expected[name]) for name in expected)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"observation": "everything"}, "there is no observation"),
        ({"observation": ["demand"]}, "no part 'demand'|no part \"demand\""),
        ({"observation": ["fare", "fare"]}, "must differ"),
        ({"split": "test"}, "split must be"),
        ({"network": "random-places:1"}, "from 2 to 60"),
        ({"network": []}, "must not be empty"),
        ({"reward": "sparse"}, "reward must be"),
    ],
)
def test_invalid_observations_are_refused(arguments: dict[str, Any], says: str) -> None:
    with pytest.raises(vertifleet.Error, match=says) as error:
        FleetEnv(**arguments)
    assert error.value.code == "V451"


class Greedy:
    """A policy as an object, which counts its calls of `reset`."""

    def __init__(self) -> None:
        self.days = 0

    def reset(self, view: View) -> None:
        assert view.decision.step == 0
        self.days += 1

    def choose(self, decision: vertifleet.Decision, view: View) -> int:
        assert decision == view.decision
        return greedy(view)


def test_policies_of_the_caller_in_every_form_play_as_the_built_in_rule() -> None:
    one = Greedy()

    def of_full(observation: dict[str, NDArray[np.float32]]) -> int:
        hours = np.where(observation["choice_block_time"] > 0, observation["choice_block_time"], np.inf)
        rate = observation["choice_profit"].astype(np.float64) / hours
        rate[observation["action_mask"] == 0] = -np.inf
        rate[observation["place"].argmax()] = 0.0
        return int(rate.argmax())

    models: dict[str, Any] = {"class": Greedy, "object": one, "full": FunctionPolicy(of_full, "full")}
    found = vertifleet.compare("paper", ["greedy", *models], days=4, models=models, threads=1)
    profits = found.columns["profit_usd"].reshape(4, 4)
    for row in profits[1:]:
        # Single precision breaks a few ties in another way.
        assert np.allclose(row, profits[0], rtol=2e-3)
    assert one.days == 4
    assert found.warnings == []


def test_a_choice_outside_the_mask_holds_is_counted_and_warned_of() -> None:
    network = Network("paper")
    with pytest.warns(UserWarning, match=r"policy \"stray\": \d+ choices outside the mask"):
        found = vertifleet.compare(network, ["stray"], days=1, models={"stray": lambda shown: 99})
    assert found.columns["flights"][0] == 0
    assert "outside the mask" in found.warnings[0]
    with pytest.warns(UserWarning, match="outside the mask"):
        played = vertifleet.simulate(network.draw(1), lambda shown: -1, network=network)
    assert played.summary["flights"] == 0


@pytest.mark.parametrize("name", ["random", "greedy", "prices", "rolling", "gcaps", "mlp", "gcaps-x"])
def test_a_called_policy_plays_as_the_program_does(name: str) -> None:
    day = Network("paper").draw(5)
    played = vertifleet.simulate(day, name)
    policy = vertifleet.policy(name)
    again = vertifleet.simulate(day, policy)
    assert again.summary == played.summary
    assert policy.sees in repr(policy)


def test_the_values_of_policies() -> None:
    env = FleetEnv()
    env.reset(seed=4)
    policies = {
        name: vertifleet.policy(name) for name in ("greedy", "prices", "rolling", "mlp", "gcaps-x", "random")
    }
    agree = dict.fromkeys(policies, 0)
    for _ in range(60):
        view = env.view
        for name, policy in policies.items():
            values = policy.values(view)
            assert values.shape == (8,)
            assert np.isnan(values[view.action_mask == 0]).all(), name
            choice = policy.choose(view.decision, view)
            assert view.action_mask[choice] == 1
            if not np.isnan(values).all():
                agree[name] += int(np.nanargmax(values)) == choice
        env.step(policies["prices"].choose(view.decision, view))
    assert agree["greedy"] == agree["mlp"] == agree["gcaps-x"] == 60
    assert agree["prices"] > 50
    assert 20 < agree["rolling"] <= 60
    assert agree["random"] == 0, "it has no values"


def test_an_object_that_is_no_policy_is_refused() -> None:
    for name, code in [("plan", "V451"), ("gredy", "V307"), ("replay:none.csv", "V102")]:
        with pytest.raises(vertifleet.Error) as error:
            vertifleet.policy(name)
        assert error.value.code == code or name.startswith("replay")


def test_a_closed_environment_raises_an_error() -> None:
    env, batch = FleetEnv(), FleetVectorEnv(2)
    env.reset(seed=1)
    batch.reset(seed=1)
    env.close()
    batch.close()
    for call in (lambda: env.step(0), env.reset, lambda: batch.step([0, 0]), batch.reset):
        with pytest.raises(vertifleet.Error, match="closed"):
            call()


def test_a_spec_is_plain_data_and_makes_the_same_environment() -> None:
    network = Network("paper").changed({"fleet.0.count": 30})
    env = gymnasium.make("vertifleet/Fleet-full-v1", network=network)
    assert env.spec is not None
    spec = gymnasium.envs.registration.EnvSpec.from_json(env.spec.to_json())
    again = gymnasium.make(spec)
    one, other = env.reset(seed=3)[0], again.reset(seed=3)[0]
    assert all(np.array_equal(one[name], other[name]) for name in one)


def test_each_environment_of_a_batch_may_get_its_own_day() -> None:
    days = [Network("paper").draw(seed) for seed in (4, 5, 6)]
    batch = FleetVectorEnv(3)
    _, info = batch.reset(options={"scenario": days})
    assert info["day"].tolist() == [day.name for day in days]
    with pytest.raises(vertifleet.Error, match="must have 3 entries"):
        batch.reset(options={"scenario": days[:2]})


def test_none_arguments_are_named_as_in_python() -> None:
    with pytest.raises(vertifleet.Error, match="named by texts"):
        vertifleet.compare("paper", ["greedy", greedy], days=1)  # type: ignore[list-item]
    with pytest.raises(vertifleet.Error) as error:
        vertifleet.simulate(Network("paper").draw(1), "gredy")
    assert "--" not in str(error.value)
    with pytest.warns(UserWarning, match="V136"):
        Network("paper").changed({"fleet.0.count": 48})

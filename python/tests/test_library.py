"""Networks, days, policies, bounds, plans, checks and comparisons."""

from __future__ import annotations

import json
import pickle
import warnings
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest

import vertifleet
from vertifleet import Comparison, Model, Network, Scenario, Trace

POLICIES = ["random", "greedy", "prices", "gcaps", "gcaps-x"]


def test_networks_are_found_by_name_number_and_path(paper: Network, tmp_path: Path) -> None:
    assert "paper" in Network.shipped()
    assert len(paper.vertiports) == 8
    assert paper.fleet_size == 40
    assert paper.mean_demand.shape == (13, 8, 8)
    path = tmp_path / "mine.toml"
    path.write_text(paper.toml, encoding="utf-8")
    assert Network(path).draw(4) == paper.draw(4)
    assert Network("random:3").draw(1) == Network.from_toml(Network("random:3").toml).draw(1)


def test_a_changed_network_differs_in_what_was_changed(paper: Network) -> None:
    changed = paper.changed({"fleet.0.count": 44, "vertiports.*.stands": 8, "tariffs.fare_base": 2.5})
    assert changed.fleet_size == 44
    assert (changed.draw(1).stands == 8).all()
    assert np.array_equal(changed.draw(1).demand, paper.draw(1).demand)
    assert (changed.draw(1).fare_usd > paper.draw(1).fare_usd)[:, ~np.eye(8, dtype=bool)].all()
    with pytest.raises(vertifleet.Error, match="leads nowhere") as error:
        paper.changed({"vertiports.V99.stands": 8})
    assert error.value.code == "V123"
    with pytest.raises(vertifleet.Error, match="changes"):
        paper.changed({"fleet.0.count": float("nan")})
    assert paper.changed(MappingProxyType({"fleet.0.count": np.int64(12)})).fleet_size == 12


def test_days_of_different_purposes_are_different_days(paper: Network) -> None:
    seeds = {paper.draw(5, purpose).seed for purpose in ("comparison", "validation", "training")}
    assert len(seeds) == 3
    with pytest.raises(vertifleet.Error, match="purpose"):
        paper.draw(1, "fun")  # type: ignore[arg-type]
    with pytest.raises(vertifleet.Error) as error:
        paper.draw(1 << 41)
    assert error.value.code == "V118"


def test_a_day_is_written_and_read(day: Scenario, tmp_path: Path) -> None:
    day.write(tmp_path / "day.json")
    assert Scenario.read(tmp_path / "day.json") == day == Scenario.from_json(day.to_json())
    with pytest.raises(vertifleet.Error) as error:
        Scenario.read(tmp_path / "night.json")
    assert (error.value.code, "night.json" in error.value.message) == ("V101", True)


def test_arrays_of_a_day_have_the_documented_shapes(day: Scenario) -> None:
    assert day.demand.shape == day.fare_usd.shape == (13, 8, 8)
    assert day.distance_mi.shape == day.passenger_cost_usd.shape == (8, 8)
    assert day.start_positions.shape == (40,)
    assert day.energy_price_usd.shape == day.periods_s.shape == (13,)
    expected = (day.demand * day.fare_usd).sum()
    assert day.potential_usd == pytest.approx(expected)
    positions = day.positions_mi
    distances = np.linalg.norm(positions[:, None] - positions, axis=2)
    assert np.allclose(distances, day.distance_mi)


def test_pickled_objects_are_restored_unchanged(paper: Network, day: Scenario) -> None:
    trace = vertifleet.simulate(day, "greedy").trace
    model = Model.shipped("mlp")
    comparison = vertifleet.compare(paper, ["greedy"], days=2)
    for one in (paper, paper.changed({"fleet.0.count": 41}), day, trace, model):
        again = pickle.loads(pickle.dumps(one))
        assert again == one
        assert hash(again) == hash(one)
    assert paper != paper.changed({"fleet.0.count": 41})
    played = vertifleet.simulate(day, "gcaps-x")
    assert pickle.loads(pickle.dumps(played)).summary == played.summary
    plan = vertifleet.plan(day, steps=100, threads=1)
    other = pickle.loads(pickle.dumps(plan))
    assert (other.trace, other.profit_usd, other.gap) == (plan.trace, plan.profit_usd, plan.gap)
    assert np.array_equal(other.bound.passenger_shadow_price_usd, plan.bound.passenger_shadow_price_usd)
    assert np.array_equal(other.bound.stand_shadow_price_usd, plan.bound.stand_shadow_price_usd)
    again = pickle.loads(pickle.dumps(comparison))
    assert again.summary == comparison.summary


def test_a_trace_can_be_written_replayed_and_checked(day: Scenario, tmp_path: Path) -> None:
    played = vertifleet.simulate(day, "gcaps-x")
    path = tmp_path / "trace.csv"
    played.trace.write(path)
    assert Trace.read(path, day) == played.trace
    assert vertifleet.simulate(day, f"replay:{path}").summary == played.summary
    assert vertifleet.simulate(day, played.trace).summary == played.summary
    assert played.trace.scenario == day
    report = vertifleet.check(day, played.trace)
    assert report["valid"]
    assert report["totals"]["profit_usd"] == pytest.approx(played.profit_usd)
    columns = played.trace.columns
    profit = (columns["revenue"] - columns["passenger_cost"] - columns["energy_cost"]).sum()
    assert profit == pytest.approx(played.profit_usd)
    lines = played.trace.to_csv().splitlines()
    broken = Trace.from_csv("\n".join([*lines[:40], *lines[41:]]), day)
    assert not vertifleet.check(day, broken)["valid"]


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_results_are_frames_where_the_libraries_are_installed(
    paper: Network, day: Scenario, library: str
) -> None:
    pytest.importorskip(library)
    trace = vertifleet.simulate(day).trace
    frame = getattr(trace, f"to_{library}")()
    assert frame.shape == (len(trace), 11)
    quick = vertifleet.simulate(Network("paper-quick").draw(1)).trace
    frame = getattr(quick, f"to_{library}")()
    assert list(frame.columns[-2:]) == ["charge_kwh", "takeoff"]
    assert (frame["takeoff"] >= frame["time"]).all()
    assert frame["charge_kwh"].max() == 110
    comparison = vertifleet.compare(paper, ["greedy", "prices"], days=3)
    frame = getattr(comparison, f"to_{library}")()
    assert list(frame["policy"]) == ["greedy"] * 3 + ["prices"] * 3


def test_a_comparison_is_the_days_one_by_one(paper: Network) -> None:
    comparison = vertifleet.compare(paper, POLICIES, days=4, seed=20, policy_seed=6)
    columns = comparison.columns
    assert columns["profit_usd"].shape == (20,)
    for row in range(20):
        day = paper.draw(int(columns["seed"][row]))
        alone = vertifleet.simulate(day, str(columns["policy"][row]), seed=6)
        assert alone.profit_usd == columns["profit_usd"][row]
        assert alone.summary["flights"] == columns["flights"][row]
    assert [policy["name"] for policy in comparison.summary["policies"]].count("gcaps") == 1
    assert "gcaps-x" in str(comparison)


def test_a_comparison_in_parts_is_the_whole(paper: Network) -> None:
    whole = vertifleet.compare(paper, ["random", "greedy"], days=5, seed=3)
    first = vertifleet.compare(paper, ["random", "greedy"], days=2, seed=3)
    second = vertifleet.compare(paper, ["random", "greedy"], days=3, seed=5, policy_seed=3)
    joined = Comparison.join([first, second])
    for name, column in whole.columns.items():
        assert np.array_equal(column, joined.columns[name]), name
    with pytest.raises(vertifleet.Error) as error:
        Comparison.join([second, first])
    assert error.value.code == "V409"


def test_given_days_earn_in_a_comparison_what_they_earn_alone(paper: Network, tmp_path: Path) -> None:
    days = [paper.draw(seed) for seed in (31, 32)]
    for at, day in enumerate(days):
        day.write(tmp_path / f"{at}.json")
    given: list[Any] = [tmp_path, [tmp_path / "0.json", str(tmp_path / "1.json")], days]
    alone = [vertifleet.simulate(day, "greedy").profit_usd for day in days]
    for days_from in given:
        comparison = vertifleet.compare(None, ["greedy"], days_from=days_from)
        assert list(comparison.columns["profit_usd"]) == alone
    with pytest.raises(vertifleet.Error) as error:
        vertifleet.compare(None, ["greedy"], days_from=[days[0], days[0]])
    assert error.value.code == "V410"


def test_what_another_program_wrote_is_replaced_by_force_alone(day: Scenario, tmp_path: Path) -> None:
    path = tmp_path / "notes.json"
    path.write_text("dear to its owner", encoding="utf-8")
    with pytest.raises(vertifleet.Error) as error:
        day.write(path)
    assert error.value.code == "V143"
    assert path.read_text(encoding="utf-8") == "dear to its owner"
    day.write(path, force=True)
    assert Scenario.read(path) == day
    # Replacing a file that the program wrote needs no force.
    day.write(path)


def test_bounds_hold_and_plans_come_close_to_them(day: Scenario) -> None:
    bound = vertifleet.bound(day, step=15)
    plan = vertifleet.plan(day, steps=2000, threads=2)
    assert (
        plan.best_policy_usd <= plan.profit_usd <= plan.bound.upper_bound_usd <= bound.upper_bound_usd + 0.01
    )
    assert plan.gap == pytest.approx(1 - plan.profit_usd / plan.bound.upper_bound_usd)
    assert bound.is_final
    assert plan.bound.is_final
    assert bound.gap(plan.profit_usd) >= plan.gap
    assert vertifleet.check(day, plan.trace)["valid"]
    assert bound.stand_shadow_price_usd.shape == (8,)
    assert bound.passenger_shadow_price_usd.shape == (13, 8, 8)
    again = vertifleet.plan(day, steps=2000, threads=2)
    assert again.trace == plan.trace


def test_a_comparison_with_bounds_has_shares_of_them(paper: Network) -> None:
    columns = vertifleet.compare(paper, ["greedy"], days=2, bound=True, step=30).columns
    assert np.allclose(columns["bound_share"], columns["profit_usd"] / columns["upper_bound_usd"])
    assert (columns["bound_share"] < 1).all()


def test_a_report_is_written(paper: Network, tmp_path: Path) -> None:
    page = Path(vertifleet.compare(paper, ["random", "greedy"], days=5).report(tmp_path / "report"))
    assert page.exists()
    assert "greedy" in page.read_text(encoding="utf-8")


def test_weights_may_be_given_as_paths_and_as_models(paper: Network, day: Scenario, tmp_path: Path) -> None:
    model = Model.shipped("gcaps")
    model.write(tmp_path / "mine.safetensors")
    expected = vertifleet.simulate(day, "gcaps").summary
    for given in (model, tmp_path / "mine.safetensors", str(tmp_path / "mine.safetensors")):
        assert vertifleet.simulate(day, "gcaps", model=given).summary == expected
    comparison = vertifleet.compare(
        paper, ["mine", "other"], days=2, models={"mine": model, "other": tmp_path / "mine.safetensors"}
    )
    profit = comparison.columns["profit_usd"]
    assert profit[0] == expected["profit_usd"]
    assert np.array_equal(profit[:2], profit[2:])


def test_a_function_may_take_part_in_a_comparison(paper: Network) -> None:
    seen = []

    def first_feasible(observation: dict[str, np.ndarray]) -> int:
        seen.append(set(observation))
        return int(observation["action_mask"].argmax())

    comparison = vertifleet.compare(
        paper, ["greedy", "first"], days=3, models={"first": first_feasible}, bound=True, step=60
    )
    env = vertifleet.envs.FleetEnv()
    for day in range(3):
        _, info = env.reset(options={"scenario": paper.draw(1 + day)})
        while "summary" not in info:
            *_, info = env.step(info["action_mask"].argmax())
        assert comparison.columns["profit_usd"][3 + day] == info["summary"]["profit_usd"]
    assert all(keys == set(env.observation_space) for keys in seen)


def test_a_function_plays_a_day(paper: Network, day: Scenario) -> None:
    def last_feasible(observation: dict[str, np.ndarray]) -> int:
        return int(np.flatnonzero(observation["action_mask"])[-1])

    played = vertifleet.simulate(day, last_feasible, network=paper)
    comparison = vertifleet.compare(paper, ["last"], days=1, seed=1, models={"last": last_feasible})
    assert played.profit_usd == comparison.columns["profit_usd"][0]
    assert vertifleet.check(day, played.trace)["valid"]


@pytest.mark.parametrize(
    "asked",
    [
        {"policy": lambda observation: 0},
        {"policy": lambda observation: 0, "network": Network("new-york")},
        {"policy": lambda observation: 0, "network": Network("paper"), "model": "x.safetensors"},
        {"policy": "greedy", "network": Network("paper")},
    ],
)
def test_a_function_needs_the_network_of_its_day(day: Scenario, asked: dict[str, Any]) -> None:
    with pytest.raises(vertifleet.Error, match="network") as error:
        vertifleet.simulate(day, **asked)
    assert error.value.code == "V451"


def test_what_a_function_raises_is_raised(paper: Network) -> None:
    def broken(observation: dict[str, np.ndarray]) -> int:
        raise ZeroDivisionError(f"by its author, on {len(observation)} arrays")

    with pytest.raises(ZeroDivisionError, match="its author"):
        vertifleet.compare(paper, ["mine"], days=20, models={"mine": broken})
    with pytest.raises(vertifleet.Error, match="V451"):
        vertifleet.compare(paper, ["mine"], days=1, models={"mine": lambda observation: "V1"})
    with pytest.raises(TypeError, match="a policy is"):
        vertifleet.compare(paper, ["mine"], days=1, models={"mine": 3})
    with pytest.raises(ZeroDivisionError, match="its author"):
        vertifleet.simulate(paper.draw(1), broken, network=paper)
    with pytest.raises(TypeError, match="a policy is"):
        vertifleet.simulate(paper.draw(1), 3, network=paper)


def test_the_shipped_models_say_what_they_are() -> None:
    for kind in ("gcaps", "mlp", "gcaps-x"):
        model = Model.shipped(kind)
        assert model.kind == kind
        assert model.header["policy"]["kind"] == kind
        assert all(np.isfinite(tensor).all() for tensor in model.tensors.values())
    assert vertifleet.settings("paper")["total_steps"] == 2_000_000


def test_more_levels_of_charge_lower_the_bound_of_a_day_that_charges_as_needed() -> None:
    day = Network("paper-quick").draw(1)
    few, many = (vertifleet.bound(day, step=15, levels=levels) for levels in (4, 16))
    assert many.upper_bound_usd < few.upper_bound_usd


@pytest.mark.parametrize(
    ("call", "code"),
    [
        (lambda day, paper: vertifleet.simulate(day, "fastest"), "V307"),
        (lambda day, paper: vertifleet.simulate(day, "greedy", model="x.safetensors"), "V407"),
        (lambda day, paper: vertifleet.simulate(day, "gcaps", model="x.safetensors"), "V101"),
        (lambda day, paper: vertifleet.simulate(day, "replay:none.csv"), "V101"),
        (lambda day, paper: vertifleet.bound(day, step=0), "V501"),
        (lambda day, paper: vertifleet.plan(day, time_limit=-1.0), "V451"),
        (lambda day, paper: vertifleet.plan(day, gap=float("nan")), "V451"),
        (lambda day, paper: vertifleet.plan(day, steps=5, time_limit=5.0), "V451"),
        (lambda day, paper: vertifleet.plan(day, seed=-1), "V451"),
        (lambda day, paper: vertifleet.bound(day, step=-1), "V451"),
        (lambda day, paper: vertifleet.bound(day, levels=65), "V505"),
        (lambda day, paper: vertifleet.simulate(day, "random", seed=2**200), "V451"),
        (lambda day, paper: paper.draw(-1), "V451"),
        (lambda day, paper: paper.draw(2**40), "V118"),
        (lambda day, paper: paper.changed({"fleet.0.count": object()}), "V451"),
        (lambda day, paper: paper.changed({"tariffs.fare_base": float("nan")}), "V451"),
        (lambda day, paper: vertifleet.compare(paper, [], days=1), "V402"),
        (lambda day, paper: vertifleet.compare(paper, ["greedy"], days=-1), "V451"),
        (lambda day, paper: vertifleet.compare(paper, ["greedy"], days=10**7), "V451"),
        (lambda day, paper: vertifleet.compare(paper, ["greedy"], days=2, seed=2**40 - 1), "V118"),
        (lambda day, paper: vertifleet.sweep(paper, {"demand.peak": {"mean": 1}}, ["greedy"]), "V451"),
        (lambda day, paper: vertifleet.settings("paper", gama=1), "V302"),
        (lambda day, paper: vertifleet.settings("paper", n_envs=2.5), "V303"),
        (lambda day, paper: vertifleet.simulate(day, lambda shown: 1), "V451"),
        (lambda day, paper: vertifleet.compare(paper, "greedy", days=1), "V451"),
        (lambda day, paper: vertifleet.compare(paper, ["greedy"], days=1, threads=0), "V451"),
        (lambda day, paper: vertifleet.compare(paper, ["greedy", "greedy"], days=1), "V404"),
        (lambda day, paper: vertifleet.compare(paper, ["greedy"], days=0), "V402"),
        (lambda day, paper: vertifleet.compare(paper, ["greedy"], days=1, models={"x": "y"}), "V407"),
        (lambda day, paper: vertifleet.settings("best"), "V301"),
        (lambda day, paper: Model.from_bytes(b"no weights"), "V304"),
        (lambda day, paper: Comparison.from_json("{}"), "V451"),
        (lambda day, paper: Network.from_toml("format = 1"), "V106"),
        (lambda day, paper: Trace.from_csv("nothing", day), "V205"),
    ],
)
def test_errors_are_exceptions_with_the_codes_of_the_program(
    day: Scenario, paper: Network, call: object, code: str
) -> None:
    with pytest.raises(vertifleet.Error) as error:
        call(day, paper)  # type: ignore[operator]
    assert error.value.code == code
    assert str(error.value).startswith(f"{code}: ")
    assert pickle.loads(pickle.dumps(error.value)).args == error.value.args


def test_weights_shipped_for_a_network_warn_on_a_copy_of_it(paper: Network) -> None:
    other = paper.changed({"fleet.0.count": 30})
    with pytest.warns(UserWarning, match="changed copy"):
        vertifleet.simulate(other.draw(1), "gcaps")
    with pytest.warns(UserWarning, match="changed copy"):
        comparison = vertifleet.compare(other, ["gcaps"], days=1)
    assert pickle.loads(pickle.dumps(comparison)).warnings == comparison.warnings


def test_a_warning_that_is_an_error_comes_before_the_days(paper: Network) -> None:
    other = paper.changed({"fleet.0.count": 30})
    asked: list[int] = []

    def hold(observation: dict[str, np.ndarray]) -> np.intp:
        asked.append(1)
        return observation["action_mask"].argmax()

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(UserWarning, match="changed copy"):
            vertifleet.compare(other, ["own", "gcaps"], days=1, models={"own": hold})
    assert not asked


def test_counts_can_be_subtracted_and_days_not_be_written_to(paper: Network, day: Scenario) -> None:
    comparison = vertifleet.compare(paper, ["greedy", "gcaps-x"], days=2)
    for arrays in (comparison.columns, vertifleet.simulate(day).trace.columns):
        assert not any(np.issubdtype(array.dtype, np.unsignedinteger) for array in arrays.values())
    for name in ("demand", "stands", "start_positions", "periods_s"):
        assert getattr(day, name).dtype == np.int64
    for name in ("demand", "fare_usd", "distance_mi", "positions_mi", "energy_price_usd", "stands"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(day, name)[...] = 0


def test_a_schedule_of_another_day_is_judged_by_its_ids(day: Scenario) -> None:
    reversed_day = json.loads(day.to_json())
    reversed_day["aircraft"].reverse()
    other = Scenario.from_json(json.dumps(reversed_day))
    trace = vertifleet.simulate(day).trace
    by_ids = vertifleet.check(other, Trace.from_csv(trace.to_csv(), other))
    assert vertifleet.check(other, trace) == by_ids
    with pytest.raises(vertifleet.Error) as error:
        vertifleet.check(day, vertifleet.simulate(Network("new-york").draw(1)).trace)
    assert error.value.code == "V207"


def test_the_gap_is_zero_if_nothing_can_be_earned(paper: Network) -> None:
    poor = paper.changed({"tariffs.fare_base": 0.5, "tariffs.fare_demand_weight": 0})
    plan = vertifleet.plan(poor.draw(1), steps=10, threads=1)
    assert (plan.profit_usd, plan.bound.upper_bound_usd, plan.gap) == (0.0, 0.0, 0.0)


def test_a_report_names_the_call_that_made_it(paper: Network) -> None:
    def hold(observation: dict[str, np.ndarray]) -> np.intp:
        return observation["action_mask"].argmax()

    changed = paper.changed({"fleet.0.count": 3})
    comparison = vertifleet.compare(changed, ["own"], days=np.int64(1), models={"own": hold})
    name = f"{hold.__qualname__}"
    assert comparison.summary["command"] == (
        "vertifleet.compare(vertifleet.Network(\"paper\").changed({'fleet.0.count': 3}), ['own'], "
        f"days=1, seed=1, models={{'own': {name}}})"
    )


def test_a_model_plays_as_a_policy_in_environments(day: Scenario) -> None:
    model = Model.shipped("gcaps")
    assert vertifleet.simulate(day, model).summary == vertifleet.simulate(day, "gcaps").summary
    shown, _ = vertifleet.envs.FleetVectorEnv(3).reset(seed=1)
    asked = [shown["nodes"], shown["aircraft"], shown["action_mask"], shown["clock"]]
    logits, values = model.forward(*asked)
    assert logits.shape == (3, 8)
    assert values.shape == (3,)
    assert (np.isneginf(logits) == (shown["action_mask"] == 0)).all()
    booleans, _ = model.forward(*asked[:2], shown["action_mask"] > 0, shown["clock"][:, 0])
    assert np.array_equal(booleans, logits)


def test_a_comparison_says_how_it_was_made() -> None:
    comparison = vertifleet.compare("paper", ["greedy", "random"], days=2, seed=5, policy_seed=3)
    again = eval(comparison.summary["command"], {"vertifleet": vertifleet})
    for name, column in comparison.columns.items():
        assert np.array_equal(column, again.columns[name])


def test_arrays_of_any_memory_layout_are_read() -> None:
    model = Model.shipped("gcaps")
    draws = np.random.default_rng(1)
    nodes, aircraft = draws.random((6, 8, 20), np.float32), draws.random((6, 18), np.float32)
    mask, clock = np.ones((6, 8), np.uint8), draws.random(6, np.float32)
    mask[:, 3] = 0
    logits, values = model.forward(nodes, aircraft, mask, clock)
    fortran = [np.asfortranarray(array) for array in (nodes, aircraft, mask)]
    assert np.array_equal(model.forward(*fortran, clock)[0], logits)
    halves = model.forward(nodes[::2], aircraft[::2], mask[::2], clock[::2])
    assert np.array_equal(halves[0], logits[::2])
    assert np.array_equal(halves[1], values[::2])
    with pytest.raises(vertifleet.Error, match="must have 6 rows of 18 entries"):
        model.forward(nodes, aircraft[:5], mask, clock)


def test_policies_are_compared_on_validation_days_too(paper: Network) -> None:
    compared = vertifleet.compare(paper, ["greedy"], days=3, seed=5, split="validation")
    names = [paper.draw(number, "validation").name for number in (5, 6, 7)]
    assert list(compared.columns["day"]) == names
    assert compared.summary["split"] == "validation"
    assert "validation days from number 5 on" in str(compared)
    swept = vertifleet.sweep(paper, {"fleet.0.count": [30]}, ["greedy"], days=1, seed=5, split="validation")
    assert swept.points[0][1].columns["day"][0].endswith(names[0].removeprefix("paper"))
    with pytest.raises(vertifleet.Error, match="split"):
        vertifleet.compare(paper, ["greedy"], days=1, split="test")  # type: ignore[arg-type]
    with pytest.raises(vertifleet.Error, match="split"):
        vertifleet.compare(None, ["greedy"], days_from=[paper.draw(1)], split="validation")

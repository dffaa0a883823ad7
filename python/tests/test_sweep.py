"""Sweeps: every combination is a separate comparison, and columns and table have its results."""

import json
import pickle
import subprocess
import sys
import time

import numpy as np
import pytest

import vertifleet

POLICIES = ["prices", "greedy"]
DAYS = {"days": 3, "seed": 4}
CHANGES = {"fleet.0.count": [36, 40], "vertiports.V2.stands": [5, 6, 8]}


@pytest.fixture(scope="module")
def swept(paper):
    return vertifleet.sweep(paper, CHANGES, POLICIES, **DAYS)


def test_every_combination_is_a_point_and_the_last_path_changes_fastest(swept):
    found = [tuple(changes.values()) for changes, _ in swept.points]
    assert found == [(36, 5), (36, 6), (36, 8), (40, 5), (40, 6), (40, 8)]
    assert all(list(changes) == list(CHANGES) for changes, _ in swept.points)


def test_a_point_is_the_comparison_on_the_changed_network(paper, swept):
    for changes, comparison in swept.points:
        expected = vertifleet.compare(paper.changed(changes), POLICIES, **DAYS)
        for name, column in expected.columns.items():
            np.testing.assert_array_equal(comparison.columns[name], column, name)


def test_all_points_meet_days_of_the_same_seeds(swept):
    for _, comparison in swept.points:
        assert set(comparison.columns["seed"]) == {4, 5, 6}


def test_columns_are_means_over_the_days(swept):
    columns = swept.columns
    assert columns["policy"].tolist() == POLICIES * 6
    assert columns["fleet.0.count"].tolist() == [36] * 6 + [40] * 6
    assert columns["vertiports.V2.stands"].tolist() == [5, 5, 6, 6, 8, 8] * 2
    assert "bound_share" not in columns
    for row in range(12):
        days = swept.points[row // 2][1].columns
        own = days["policy"] == columns["policy"][row]
        for name in ("profit_usd", "reward", "flights", "load_factor"):
            assert columns[name][row] == pytest.approx(days[name][own].mean()), name
        # Half of the interval is t(0.975, 2) = 4.3027 standard errors.
        half = 4.302653 * days["profit_usd"][own].std(ddof=1) / np.sqrt(3)
        assert columns["profit_low_usd"][row] == pytest.approx(columns["profit_usd"][row] - half)
        assert columns["profit_high_usd"][row] == pytest.approx(columns["profit_usd"][row] + half)


def test_a_single_day_has_no_interval_and_bounds_have_shares(paper):
    single = vertifleet.sweep(paper, {"fleet.0.count": [36, 40]}, ["greedy"], days=1, bound=True, step=15)
    assert np.isnan(single.columns["profit_low_usd"]).all()
    days = [comparison.columns["bound_share"][0] for _, comparison in single.points]
    assert single.columns["bound_share"].tolist() == days
    assert "share of bound" in str(single)
    assert "nan" not in str(single)


def test_frames_have_the_columns(swept):
    for library, frame in (("pandas", swept.to_pandas), ("polars", swept.to_polars)):
        pytest.importorskip(library)
        assert list(frame().columns) == list(swept.columns)
        assert frame()["profit_usd"].to_list() == swept.columns["profit_usd"].tolist()


def test_the_table_is_for_people(paper):
    table = str(vertifleet.sweep(paper, {"fleet.0.count": [36]}, ["greedy", "random"], days=2, seed=3))
    lines = table.splitlines()
    assert lines[0] == "network paper, 1 point, each on 2 days, seed 3"
    assert lines[2].split("  ")[0] == "fleet.0.count"
    assert [line.split()[:2] for line in lines[4:6]] == [["36", "greedy"], ["36", "random"]]
    assert len({len(line) for line in lines[2:6]}) == 1
    assert lines[6].startswith("means a day")


def test_no_change_is_the_network_itself(paper):
    (changes, comparison), *others = vertifleet.sweep(paper, {}, ["greedy"], days=2).points
    assert (changes, others) == ({}, [])
    expected = vertifleet.compare(paper, ["greedy"], days=2)
    np.testing.assert_array_equal(comparison.columns["profit_usd"], expected.columns["profit_usd"])


def test_numbers_of_numpy_are_values_like_others(paper):
    by_numpy = vertifleet.sweep(paper, {"fleet.0.count": np.arange(36, 41, 4)}, ["greedy"], days=1)
    assert [changes for changes, _ in by_numpy.points] == [{"fleet.0.count": 36}, {"fleet.0.count": 40}]


def test_texts_and_mixed_values_have_columns_too(paper):
    texts = vertifleet.sweep(paper, {"operations.end": ["17:00:00", "18:00:00"]}, ["greedy"], days=1)
    assert texts.columns["operations.end"].tolist() == ["17:00:00", "18:00:00"]
    truths = vertifleet.sweep(paper, {"vertiports.V2.busy": [True, False]}, ["greedy"], days=1)
    assert truths.columns["vertiports.V2.busy"].dtype == bool
    positions = [[6, 6], "random"]
    mixed = vertifleet._sweep._column(positions)
    assert mixed.dtype == object
    assert mixed.tolist() == positions


def test_a_text_is_a_range_with_a_step(paper):
    swept = vertifleet.sweep(paper, {"tariffs.fare_level": "0.8..1.1/0.1"}, ["greedy"], days=1)
    assert [changes["tariffs.fare_level"] for changes, _ in swept.points] == [0.8, 0.9, 1.0, 1.1]


def test_a_latin_hypercube_uses_every_part_of_every_range_once(paper):
    request = {
        "changes": {
            "fleet.0.count": "31..40",
            "tariffs.fare_level": "0.5..1.5",
            "operations.end": ["17:00:00"],
        },
        "policies": ["greedy"],
        "days": 1,
        "latin": 5,
    }
    swept = vertifleet.sweep(paper, **request)
    counts = sorted(changes["fleet.0.count"] for changes, _ in swept.points)
    levels = sorted(changes["tariffs.fare_level"] for changes, _ in swept.points)
    assert counts == [32, 34, 36, 38, 40], "one in each fifth"
    assert levels == [0.6, 0.8, 1.0, 1.2, 1.4]
    assert {changes["operations.end"] for changes, _ in swept.points} == {"17:00:00"}
    assert_same(vertifleet.sweep(paper, **request), swept)
    assert "'fleet.0.count': '31..40'" in swept.command
    assert "'operations.end': [...]}, ['greedy'], latin=5, " in swept.command
    others = vertifleet.sweep(paper, **request, seed=2)
    assert [changes for changes, _ in others.points] != [changes for changes, _ in swept.points]
    for cells in (1, -1, 10_001):
        with pytest.raises(vertifleet.Error) as refused:
            vertifleet.sweep(paper, **(request | {"latin": cells}))
        assert refused.value.code in ("V407", "V451")


def test_a_fleet_without_a_place_is_left_out(paper, tmp_path):
    request = {"changes": {"fleet.0.count": [40, 1000, 36]}, "policies": ["greedy"], "days": 2, "seed": 1}
    swept = vertifleet.sweep(paper, **request, journal=tmp_path / "sweep.jsonl")
    assert [changes["fleet.0.count"] for changes, _ in swept.points] == [40, 36]
    ((changes, reason),) = swept.left_out
    assert changes == {"fleet.0.count": 1000}
    assert "1000" in reason
    assert "1 left out" in str(swept)
    assert_same(vertifleet.sweep(paper, **request, journal=tmp_path / "sweep.jsonl"), swept)
    folder = tmp_path / "sweep"
    swept.report(folder)
    cells = json.loads((folder / "summary.json").read_text())["cells"]
    assert [cell["left_out"] is None for cell in cells] == [True, False, True]
    assert cells[1]["left_out"] == reason


def test_a_warning_is_said_once(paper):
    with pytest.warns(UserWarning, match="changed copy") as records:
        vertifleet.sweep(paper, {"fleet.0.count": [36, 38, 42]}, ["mlp"], days=1)
    assert len(records) == 1
    assert records[0].filename == __file__


def test_a_warning_of_many_networks_is_said_once(paper):
    with pytest.warns(UserWarning, match="V138") as records:
        vertifleet.sweep(
            paper, {"operations.end": ["17:00:00"], "fleet.0.count": [36, 40]}, ["greedy"], days=1
        )
    assert len(records) == 1


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"fleet.0.count": 36}, "V451"),
        ({"fleet.0.count": []}, "V451"),
        ({"fleet.0.count": {"from": 30, "to": 40}}, "V451"),
        ({"fleet.0.count": [float("nan")]}, "V451"),
        ({"fleet.0.count": "50..30/5"}, "V407"),
        ({"fleet.0.count": "30..50"}, "V407"),
        ({"fleet.0.count": "1..200", "tariffs.fare_level": "0.5..2.0/0.01"}, "V407"),
        ({"fleet.0.count": [1000, 2000]}, "V407"),
        ({"fleet.9.count": [36]}, "V123"),
        ({"fleet.0.count": [36, -1]}, "V104"),
    ],
)
def test_what_cannot_be_swept_is_refused(paper, changes, code):
    with pytest.raises(vertifleet.Error) as refused:
        vertifleet.sweep(paper, changes, ["greedy"], days=1)
    assert refused.value.code == code


def test_the_report_is_that_of_the_program(swept, tmp_path):
    folder = tmp_path / "sweep"
    page = swept.report(folder)
    assert page == folder / "report.html"
    assert "fleet.0.count" in page.read_text()
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["format"] == "vertifleet-sweep/1"
    assert summary["policies"] == POLICIES
    assert summary["factors"] == list(CHANGES)
    means = [result["profit_usd"]["mean"] for cell in summary["cells"] for result in cell["results"]]
    np.testing.assert_allclose(means, swept.columns["profit_usd"], rtol=1e-12)
    rows = (folder / "days.csv").read_text().splitlines()
    assert len(rows) == 1 + 6 * 2 * 3
    assert {"cells.parquet", "days.parquet", "figure-tornado.svg"} <= {file.name for file in folder.iterdir()}
    swept.report(folder)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "letter.txt").write_text("mine")
    with pytest.raises(vertifleet.Error, match="V143"):
        swept.report(tmp_path / "other")


def assert_same(found, expected):
    assert [changes for changes, _ in found.points] == [changes for changes, _ in expected.points]
    for (_, comparison), (_, same) in zip(found.points, expected.points, strict=True):
        for name, column in same.columns.items():
            np.testing.assert_array_equal(comparison.columns[name], column, name)
    assert str(found) == str(expected)


def test_a_sweep_goes_on_where_an_error_ended_it(paper, tmp_path):
    network, changes = paper, {"fleet.0.count": [36, 38, 40, 42]}
    decided, fails_at = [], 0

    def first(view):
        decided.append(None)
        if len(decided) == fails_at:
            raise RuntimeError("out of luck")
        return int(np.flatnonzero(view["action_mask"])[0])

    request = {"changes": changes, "policies": ["first"], "days": 1, "models": {"first": first}}
    expected = vertifleet.sweep(network, **request)
    each = len(decided) // 4
    decided, fails_at = [], 2 * each + 9
    journal = tmp_path / "sweep.jsonl"
    with pytest.raises(RuntimeError, match="out of luck"):
        vertifleet.sweep(network, **request, journal=journal, threads=1)
    decided, fails_at = [], 0
    found = vertifleet.sweep(network, **request, journal=journal)
    assert each < len(decided) < 3 * each, "only what was missing is played"
    assert_same(found, expected)
    decided = []
    assert_same(vertifleet.sweep(network, **request, journal=journal), expected)
    assert not decided


def test_a_point_of_the_journal_is_what_it_was(paper, tmp_path):
    request = {"changes": {"fleet.0.count": [36]}, "policies": ["greedy", "mlp"], "days": 2, "bound": True}
    swept = vertifleet.sweep(paper, **request, journal=tmp_path / "sweep.jsonl")
    again = vertifleet.sweep(paper, **request, journal=tmp_path / "sweep.jsonl")
    copied = pickle.loads(pickle.dumps(swept))
    for other in (again, copied):
        assert_same(other, swept)
        ((_, point),), ((_, expected),) = other.points, swept.points
        assert point.summary == expected.summary, "times per decision are kept too"
        assert point.warnings == expected.warnings != []
    assert copied.report(tmp_path / "copied").read_text() == swept.report(tmp_path / "swept").read_text()


def test_choices_outside_the_mask_are_counted_over_all_points(paper):
    changes, models = {"fleet.0.count": [36, 40]}, {"stray": lambda _: 99}
    with pytest.warns(UserWarning, match="outside the mask") as records:
        swept = vertifleet.sweep(paper, changes, ["stray"], days=1, models=models)
    decisions = sum(int(point.columns["decisions"].sum()) for _, point in swept.points)
    assert [str(record.message).split()[2] for record in records] == [str(decisions)]


def test_a_sweep_that_is_killed_again_and_again_comes_to_its_end(paper, tmp_path):
    journal = tmp_path / "sweep.jsonl"
    changes = {"fleet.0.count": list(range(31, 41))}
    program = (
        "import vertifleet\n"
        f"vertifleet.sweep('paper', {changes}, ['prices'], days=4, journal={str(journal)!r}, threads=1)\n"
    )
    lines = 0
    for _ in range(5):
        process = subprocess.Popen([sys.executable, "-c", program])
        while process.poll() is None and len(_lines(journal)) < lines + 2:
            time.sleep(0.002)
        process.kill()
        process.wait()
        lines = len(_lines(journal))
    assert lines > 1, "killed processes have kept something"
    # What a killed process was writing is cut off.
    with journal.open("a") as file:
        file.write('{"cell":3,"upper_bounds_usd":[],"tot')
    found = vertifleet.sweep(paper, changes, ["prices"], days=4, journal=journal)
    assert_same(found, vertifleet.sweep(paper, changes, ["prices"], days=4))
    assert len(_lines(journal)) == 11, "a head, and each point once"


def _lines(path):
    return path.read_text().splitlines() if path.exists() else []


def test_a_journal_belongs_to_one_sweep(paper, tmp_path):
    journal = tmp_path / "sweep.jsonl"
    request = {"changes": {"fleet.0.count": [40]}, "policies": ["greedy"], "days": 2, "seed": 1}
    vertifleet.sweep(paper, **request, journal=journal)
    others = [
        {"changes": {"fleet.0.count": [41]}},
        {"policies": ["prices"]},
        {"days": 3},
        {"seed": 2},
        {"split": "validation"},
        {"bound": True},
        {"policy_seed": 7},
    ]
    for other in others:
        with pytest.raises(vertifleet.Error) as refused:
            vertifleet.sweep(paper, **(request | other), journal=journal)
        assert refused.value.code == "V414", other
    assert "remove" in refused.value.hint
    with pytest.raises(vertifleet.Error) as refused:
        vertifleet.sweep(paper, **request, journal=tmp_path / "nowhere" / "sweep.jsonl")
    assert refused.value.code == "V102"

"""Comparisons on a cluster of three nodes, all on this machine, have the results of a single process.

Tasks report their state by files in a folder, the stage, and tests tell them there what to do.
"""

import io
import json
import os
import signal
import sys
import threading
import time

import numpy as np
import pytest

import vertifleet

ray = pytest.importorskip("ray")

from ray.cluster_utils import Cluster  # noqa: E402

import vertifleet.ray  # noqa: E402
from vertifleet._compare import ComparisonRequest, DrawnDays  # noqa: E402
from vertifleet.ray import progress, tasks  # noqa: E402

POLICIES = ["greedy", "random", "prices"]
NODE = {"num_cpus": 1, "object_store_memory": 80 << 20}
NODES = 3
LONG_S = 60


class Stage:
    """The folder by which tests and tasks communicate."""

    def __init__(self, folder):
        self.folder = folder

    def tell(self, what):
        (self.folder / what).touch()

    def forget(self, what):
        (self.folder / what).unlink()

    def begun(self):
        """Node and seed of every part that was begun."""
        names = [file.name.split("-") for file in self.folder.glob("begun-*")]
        return {(node, int(seed)) for _, node, seed in names}

    def wait_for(self, what):
        wait_until(lambda: (self.folder / what).exists())


def wait_until(true):
    end = time.monotonic() + LONG_S
    while not true():
        assert time.monotonic() < end, "the condition did not become true in time"
        time.sleep(0.05)


def on_stage(folder):
    """A `tasks.play` that follows the files on the stage before it plays."""
    play = tasks.play._function

    def acted(request, here, network, days):
        seed = days.seed

        def told(what):
            return (folder / what).exists()

        node = ray.get_runtime_context().get_node_id()
        parts = len(list(folder.glob(f"begun-{node}-*")))
        (folder / f"begun-{node}-{seed}").touch()
        if told(f"fail-{seed}"):
            raise vertifleet.Error("V999", "as it was told")
        if told(f"crash-{seed}"):
            (folder / f"crash-{seed}").unlink()
            os.kill(os.getpid(), signal.SIGKILL)
        # The doomed node plays one part to its end and hangs in the next; the others wait for that.
        if told(f"doomed-{node}") and parts > 0:
            (folder / "hanging").touch()
            time.sleep(LONG_S)
        doomed = any(folder.glob("doomed-*")) and not told(f"doomed-{node}")
        while (doomed and not told("hanging")) or told(f"hold-{seed}"):
            (folder / f"held-{seed}").touch()
            time.sleep(0.05)
        return play(request, here, network, days)

    return ray.remote(**tasks.play._default_options)(acted)


@pytest.fixture(scope="module")
def cluster():
    cluster = Cluster(initialize_head=True, head_node_args=NODE | {"include_dashboard": False})
    for _ in range(NODES - 1):
        cluster.add_node(**NODE)
    ray.init(address=cluster.address, log_to_driver=False)
    yield cluster
    ray.shutdown()
    cluster.shutdown()


@pytest.fixture
def stage(cluster, tmp_path, monkeypatch):  # noqa: ARG001
    folder = tmp_path / "stage"
    folder.mkdir()
    monkeypatch.setattr(tasks, "play", on_stage(folder))
    return Stage(folder)


def assert_same(found, expected):
    assert list(found.columns) == list(expected.columns)
    for name, column in expected.columns.items():
        np.testing.assert_array_equal(found.columns[name], column, name)


def all_cpus_free():
    return ray.available_resources().get("CPU", 0) == ray.cluster_resources()["CPU"]


@pytest.mark.parametrize("days_per_task", [1, 4, 100, None])
@pytest.mark.usefixtures("stage")
def test_the_days_are_those_of_one_machine_in_parts_of_any_size(paper, days_per_task):
    days = {"days": 11, "seed": 5}
    found = vertifleet.ray.compare(paper, POLICIES, **days, days_per_task=days_per_task)
    assert_same(found, vertifleet.compare(paper, POLICIES, **days))


@pytest.mark.usefixtures("stage")
def test_bounds_and_seeds_reach_the_tasks(paper):
    request = {"days": 3, "seed": 5, "policy_seed": 77, "bound": True, "step": 15}
    found = vertifleet.ray.compare(paper, ["random"], **request, days_per_task=2)
    assert_same(found, vertifleet.compare(paper, ["random"], **request))
    assert "bound_share" in found.columns


@pytest.mark.usefixtures("stage")
def test_weights_travel_with_the_tasks(paper, tmp_path, monkeypatch):
    vertifleet.Model.shipped("mlp").write(tmp_path / "weights.safetensors")
    monkeypatch.chdir(tmp_path)  # no worker has this working directory
    days = {"days": 2, "seed": 5, "models": {"mine": "weights.safetensors"}}
    found = vertifleet.ray.compare(paper, ["mine"], **days)
    assert_same(found, vertifleet.compare(paper, ["mine"], **days))


@pytest.mark.usefixtures("stage")
def test_a_function_travels_with_the_tasks(paper):
    def last(observation):
        return int(np.flatnonzero(observation["action_mask"])[-1])

    days = {"days": 3, "seed": 5, "models": {"last": last}}
    found = vertifleet.ray.compare(paper, ["last", "greedy"], **days, days_per_task=1)
    assert_same(found, vertifleet.compare(paper, ["last", "greedy"], **days))


@pytest.mark.usefixtures("stage")
def test_a_network_file_needs_to_be_here_alone(paper, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(paper.toml.replace("stands = 6", "stands = 7"))
    network = vertifleet.Network(file)
    file.unlink()
    found = vertifleet.ray.compare(network, ["greedy"], days=2)
    assert_same(found, vertifleet.compare(network, ["greedy"], days=2))


@pytest.mark.usefixtures("stage")
def test_a_sweep_is_that_of_one_machine(paper):
    request = {"changes": {"fleet.0.count": [36, 40], "vertiports.*.stands": [6, 8]}, "days": 3, "seed": 9}
    found = vertifleet.ray.sweep(paper, policies=POLICIES, **request, days_per_task=2)
    expected = vertifleet.sweep(paper, policies=POLICIES, **request)
    assert [changes for changes, _ in found.points] == [changes for changes, _ in expected.points]
    for (_, comparison), (_, same) in zip(found.points, expected.points, strict=True):
        assert_same(comparison, same)
    assert str(found) == str(expected)


def test_a_sweep_with_a_journal_plays_only_what_is_missing(paper, stage, tmp_path):
    journal = tmp_path / "sweep.jsonl"
    request = {"changes": {"fleet.0.count": [36, 40]}, "policies": ["greedy"], "days": 8, "seed": 1}
    vertifleet.ray.sweep(paper, **request, journal=journal, days_per_task=2)
    first = journal.read_text().splitlines()[:2]
    journal.write_text("\n".join(first) + "\n")
    stage.tell("fail-7")
    with pytest.raises(vertifleet.Error, match="as it was told"):
        vertifleet.ray.sweep(paper, **request, journal=journal, days_per_task=2)
    wait_until(all_cpus_free)
    stage.forget("fail-7")
    assert journal.read_text().splitlines() == first, "a point is kept when all of its days are there"
    # The tasks have other days than before.
    found = vertifleet.ray.sweep(paper, **request, journal=journal, days_per_task=3)
    expected = vertifleet.sweep(paper, **request)
    for (_, comparison), (_, same) in zip(found.points, expected.points, strict=True):
        assert_same(comparison, same)
    lines = journal.read_text().splitlines()
    assert lines[:2] == first, "a point is not played twice"
    assert sorted(json.loads(line)["cell"] for line in lines[1:]) == [0, 1]


def test_days_may_be_of_another_split_and_designs_a_latin_hypercube(paper):
    changes = {"fleet.0.count": "36..44", "tariffs.fare_level": "0.8..1.2"}
    request = {"changes": changes, "policies": ["greedy"], "latin": 3, "days": 2, "split": "validation"}
    found, expected = vertifleet.ray.sweep(paper, **request), vertifleet.sweep(paper, **request)
    assert [changes for changes, _ in found.points] == [changes for changes, _ in expected.points]
    for (_, comparison), (_, same) in zip(found.points, expected.points, strict=True):
        assert_same(comparison, same)
    one, other = (
        vertifleet.ray.compare(paper, ["greedy"], days=2, split=split) for split in (None, "training")
    )
    assert one.columns["profit_usd"].tolist() != other.columns["profit_usd"].tolist()


@pytest.mark.usefixtures("stage")
def test_a_warning_of_many_tasks_is_said_once(paper):
    with pytest.warns(UserWarning, match="changed copy") as records:
        vertifleet.ray.sweep(paper, {"fleet.0.count": [36, 38]}, ["mlp"], days=2, days_per_task=1)
    assert len(records) == 1
    assert records[0].filename == __file__


@pytest.mark.usefixtures("stage")
def test_an_error_of_a_task_is_an_error_of_the_call(paper):
    with pytest.raises(vertifleet.Error) as refused:
        vertifleet.ray.compare(paper, ["greedy", "unknown"], days=4)
    assert refused.value.code == "V307"
    assert refused.value.hint is not None


@pytest.mark.usefixtures("stage")
def test_what_cannot_be_split_is_refused(paper):
    for request, code in [({"days": 0}, "V402"), ({"days": 4, "days_per_task": 0}, "V451")]:
        with pytest.raises(vertifleet.Error) as refused:
            vertifleet.ray.compare(paper, ["greedy"], **request)
        assert refused.value.code == code


def test_a_node_with_another_version_is_refused(paper):
    request = ComparisonRequest.of("compare", ["greedy"], DrawnDays(1, 1), None, False, 5, None)
    with pytest.raises(vertifleet.Error) as refused:
        tasks.play._function(request, "0.0.0", paper, DrawnDays(1, 1))
    assert refused.value.code == "V409"
    assert "0.0.0" in refused.value.message


@pytest.fixture
def held(stage):
    """Makes the first parts, those in flight, wait. Afterwards they continue, and no other part is begun."""
    in_flight = set(range(1, tasks.AHEAD * NODES + 1))
    for seed in in_flight:
        stage.tell(f"hold-{seed}")
    yield {"days": 4 * len(in_flight), "seed": 1, "days_per_task": 1}
    for seed in in_flight:
        stage.forget(f"hold-{seed}")
    wait_until(lambda: {seed for _, seed in stage.begun()} >= in_flight and all_cpus_free())
    assert {seed for _, seed in stage.begun()} == in_flight


def test_after_a_task_that_fails_no_other_is_begun(paper, stage, held):
    stage.tell("fail-3")
    with pytest.raises(vertifleet.Error, match="as it was told"):
        vertifleet.ray.compare(paper, ["greedy"], **held)


def test_after_ctrl_c_no_other_is_begun(paper, stage, held):
    def interrupt():
        stage.wait_for("held-1")
        os.kill(os.getpid(), signal.SIGINT)

    hand = threading.Thread(target=interrupt)
    hand.start()
    with pytest.raises(KeyboardInterrupt):
        vertifleet.ray.compare(paper, ["greedy"], **held)
    hand.join()


def test_what_a_worker_that_dies_was_playing_is_played_again(paper, stage):
    for seed in (2, 5):
        stage.tell(f"crash-{seed}")
    found = vertifleet.ray.compare(paper, POLICIES, days=6, seed=1, days_per_task=1)
    assert not list(stage.folder.glob("crash-*"))
    assert_same(found, vertifleet.compare(paper, POLICIES, days=6, seed=1))


def test_what_a_node_that_dies_was_playing_is_played_again(paper, cluster, stage):
    doomed = next(iter(cluster.worker_nodes))
    stage.tell(f"doomed-{doomed.node_id}")

    def kill():
        stage.wait_for("hanging")
        cluster.remove_node(doomed, allow_graceful=False)

    hand = threading.Thread(target=kill)
    hand.start()
    days = {"days": 12, "seed": 50}
    found = vertifleet.ray.compare(paper, POLICIES, **days, days_per_task=1)
    hand.join()

    begun = stage.begun()
    there = {seed for node, seed in begun if node == doomed.node_id}
    elsewhere = {seed for node, seed in begun if node != doomed.node_id}
    assert len(there) == 2
    assert len(there & elsewhere) >= 1
    assert len(there | elsewhere) == 12
    assert_same(found, vertifleet.compare(paper, POLICIES, **days))


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_terminal_is_told_how_far_it_is(monkeypatch):
    monkeypatch.setattr(progress, "PATIENCE_S", 0.0)
    monkeypatch.setattr(sys, "stderr", Terminal())
    with progress.Progress(1200) as shown:
        shown.show(0)
        shown.show(300)
    lines = sys.stderr.getvalue().split(progress.CLEAR)
    assert lines == ["", "0 of 1,200 days", "300 of 1,200 days, 0 s left", ""]


def test_a_file_is_told_nothing(monkeypatch):
    monkeypatch.setattr(progress, "PATIENCE_S", 0.0)
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    with progress.Progress(10) as shown:
        shown.show(5)
    assert sys.stderr.getvalue() == ""


def test_time_left_is_said_in_few_words():
    assert [progress._duration(seconds) for seconds in (9.6, 100, 3599, 7500)] == [
        "10 s",
        "2 min",
        "1 h 00 min",
        "2 h 05 min",
    ]

"""`vertifleet.train`: the program's trainer, from Python."""

import signal
import threading

import numpy as np
import pytest

import vertifleet

SETTINGS = {"n_envs": 4, "n_steps": 25, "batch_size": 100, "n_epochs": 1, "eval_days": 1, "eval_every": 2}
ROUNDS = {"rounds": 2, "days": 1, "passes": 1, "rollouts": 1, "horizon_s": 600, "validation_days": 1}


def trained(out, total_steps=400, policy="mlp", **arguments):
    settings = {**SETTINGS, "total_steps": total_steps}
    return vertifleet.train("paper", policy, out=out, settings=settings, threads=1, **arguments)


def test_a_run_leaves_weights_that_play_and_a_curve(tmp_path):
    training = trained(tmp_path)
    assert training.is_done
    assert training.model.kind == "mlp"
    assert training.model == vertifleet.Model.read(tmp_path / "mlp.safetensors")
    assert training.model.header["settings"]["total_steps"] == 400
    columns = training.columns
    assert columns["steps"].tolist() == [100, 200, 300, 400]
    assert np.isnan(columns["validation_reward"]).tolist() == [True, False, True, False]
    frame = training.to_pandas()
    assert list(frame.columns) == list(columns) == training.to_polars().columns
    day = vertifleet.Network("paper").draw(1)
    assert vertifleet.simulate(day, policy=training.model).profit_usd > 0


def test_gcaps_x_learns_in_rounds(tmp_path):
    rows = []
    training = vertifleet.train("paper", "gcaps-x", out=tmp_path, settings=ROUNDS, watch=rows.append)
    assert [row["round"] for row in rows] == training.columns["round"].tolist() == [1, 2]
    assert training.model.header["steps"] == rows[-1]["decisions"]


def test_evolution_begins_with_given_weights(tmp_path):
    first = trained(tmp_path / "first")
    generations = {"generations": 2, "pairs": 1, "days": 1, "validation_days": 1, "eval_every": 1}
    begin_with = tmp_path / "first" / "mlp.safetensors"

    def evolved(out, policy="mlp", **arguments):
        return vertifleet.train(
            "paper", policy, out=tmp_path / out, preset="evolution", settings=generations, **arguments
        )

    still = {**generations, "learning_rate": 0}
    unmoved = vertifleet.train(
        "paper", "mlp", out=tmp_path / "still", preset="evolution", settings=still, begin_with=begin_with
    )
    weights = [model.tensors for model in (unmoved.model, first.model)]
    assert all(np.array_equal(weights[0][name], weights[1][name]) for name in weights[1])
    training = evolved("evolved", begin_with=first.model)
    assert training.model.header["begun_with"] == first.model.sha256
    assert "begun_with" not in first.model.header
    assert training.columns["generation"].tolist() == [1, 2]
    assert training.columns["difference"].min() > 0
    with pytest.raises(vertifleet.Error, match="same policy") as refused:
        evolved("other", policy="gcaps", begin_with=begin_with)
    assert refused.value.code == "V303"


def test_a_run_that_was_interrupted_goes_on_to_the_same_weights(tmp_path):
    whole = trained(tmp_path / "whole", total_steps=2_000)
    # This is what Jupyter's stop button does; it works even if the tests run with SIGINT ignored.
    heard = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            trained(
                tmp_path / "cut",
                total_steps=2_000,
                watch=lambda row: (
                    row["update"] == 3 and signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)
                ),
            )
    finally:
        signal.signal(signal.SIGINT, heard)
    with pytest.raises(vertifleet.Error) as refused:
        trained(tmp_path / "cut", total_steps=2_000)
    assert refused.value.code == "V311"
    resumed = trained(tmp_path / "cut", total_steps=2_000, resume=True)
    assert resumed.is_done
    assert resumed.model == whole.model
    assert resumed.columns["steps"].tolist() == whole.columns["steps"].tolist()


def test_what_a_watch_raises_is_raised_and_the_run_set_aside(tmp_path):
    def full(row):
        raise ValueError(row["steps"])

    with pytest.raises(ValueError, match="100"):
        trained(tmp_path, watch=full)
    assert trained(tmp_path, resume=True).is_done


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        ({"policy": "greedy"}, "V451"),
        ({"policy": "mlp", "preset": "big"}, "V301"),
        ({"policy": "gcaps-x", "preset": "paper"}, "V301"),
        ({"policy": "mlp", "settings": {"steps": 5}}, "V302"),
        ({"policy": "mlp", "settings": {"gamma": 5}}, "V303"),
        ({"policy": "mlp", "settings": {"n_envs": 1}, "resume": True}, "V101"),
    ],
)
def test_what_cannot_be_trained_is_refused(tmp_path, arguments, code):
    with pytest.raises(vertifleet.Error) as refused:
        vertifleet.train("paper", out=tmp_path / "out", **arguments)
    assert refused.value.code == code
    assert not (tmp_path / "out").exists()

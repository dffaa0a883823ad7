"""Weight files between PyTorch and the program: the same tensors, the same answers, the same decisions."""

import json
import struct
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import vertifleet

torch = pytest.importorskip("torch")
safetensors = pytest.importorskip("safetensors.torch")

from vertifleet.envs import FleetEnv  # noqa: E402
from vertifleet.torch import Gcaps, GcapsFull, GcapsX, Mlp, act, load, masked, save  # noqa: E402

MODELS = Path(__file__).parents[3] / "models"
SHIPPED = {
    "gcaps": MODELS / "paper" / "gcaps.safetensors",
    "mlp": MODELS / "paper" / "mlp.safetensors",
    "gcaps-x": MODELS / "any" / "gcaps-x.safetensors",
}
NETWORK = vertifleet.Network("paper")
SETTINGS = load(SHIPPED["gcaps-x"]).header["settings"]


def fresh(kind):
    torch.manual_seed(5)
    match kind:
        case "gcaps":
            return Gcaps(8, width=32, heads=2)
        case "mlp":
            return Mlp(8, width=24, layers=3, value_width=16)
        case _:
            return GcapsX(width=24, heads=3)


def save_fresh(twin, path):
    settings = SETTINGS if twin.kind == "gcaps-x" else vertifleet.settings("paper")
    save(twin, path, network=NETWORK, settings=settings, seed=3, steps=1234)


def played(day, decisions):
    """The observations before each of these decisions, [decisions, ...]."""
    environment = gymnasium.make("vertifleet/Fleet-v0", network=NETWORK, disable_env_checker=True)
    seen, _ = environment.reset(options={"scenario": day})
    shown = [seen]
    for decision in decisions[:-1]:
        seen, _, over, _, _ = environment.step(int(decision))
        assert not over
        shown.append(seen)
    return {name: np.stack([seen[name] for seen in shown]) for name in seen}


def made_up(twin, vertiports, batch=16):
    """Random observations, [B, ...]."""
    random = np.random.default_rng(2)
    mask = random.random((batch, vertiports)) < 0.7
    mask[:, random.integers(vertiports)] = True
    return {
        "nodes": random.random((batch, vertiports * twin.node_features), np.float32),
        "aircraft": random.random((batch, twin.aircraft_features), np.float32),
        "clock": random.random((batch, 1), np.float32),
        "action_mask": mask.astype(np.float32),
    }


def assert_answers_are_those_of_the_program(twin, path, seen):
    mask, batch = seen["action_mask"], len(seen["clock"])
    nodes = seen["nodes"].reshape(batch, mask.shape[1], -1)
    model = vertifleet.Model.read(path)
    expected = model.forward(nodes, seen["aircraft"], mask.astype(np.uint8), seen["clock"].reshape(batch))
    tensors = (torch.from_numpy(seen[name]) for name in ("nodes", "aircraft", "clock"))
    with torch.inference_mode():
        logits, values = twin(*tensors)
    found = masked(logits, torch.from_numpy(mask)).numpy(), values.numpy()
    for answers, expected_answers in zip(found, expected, strict=True):
        largest = np.abs(expected_answers[np.isfinite(expected_answers)]).max()
        np.testing.assert_allclose(answers, expected_answers, rtol=0, atol=1e-5 * max(largest, 1))


@pytest.mark.parametrize("kind", SHIPPED)
def test_the_keys_of_a_twin_are_the_tensors_of_the_shipped_file(kind):
    tensors = vertifleet.Model.read(SHIPPED[kind]).tensors
    twin = {"gcaps": Gcaps, "mlp": Mlp, "gcaps-x": lambda _: GcapsX()}[kind](8)
    assert {name: tuple(tensor.shape) for name, tensor in twin.state_dict().items()} == {
        name: tensor.shape for name, tensor in tensors.items()
    }
    assert list(twin.state_dict()) == [name for name, _ in twin.named_parameters()]


@pytest.mark.parametrize("kind", SHIPPED)
def test_a_file_that_is_loaded_and_saved_has_the_same_bytes(kind, tmp_path):
    twin = load(SHIPPED[kind])
    assert twin.header == vertifleet.Model.read(SHIPPED[kind]).header
    save(twin, tmp_path / "again.safetensors")
    # The shipped files may have an earlier format; new files have the current one.
    again = (tmp_path / "again.safetensors").read_bytes()
    assert again == vertifleet.Model.read(SHIPPED[kind]).to_bytes()
    save(load(again), tmp_path / "once-more.safetensors")
    assert (tmp_path / "once-more.safetensors").read_bytes() == again


def test_the_bytes_of_a_file_load_as_the_file_does():
    twin = load(SHIPPED["gcaps-x"].read_bytes())
    for name, tensor in load(SHIPPED["gcaps-x"]).state_dict().items():
        assert torch.equal(twin.state_dict()[name], tensor)


def test_loaded_weights_learn():
    twin = load(SHIPPED["gcaps"])
    assert all(weight.requires_grad for weight in twin.parameters())


@pytest.mark.parametrize("kind", ["gcaps", "mlp"])
def test_shipped_weights_answer_real_observations_as_the_program_does(kind):
    day = NETWORK.draw(11)
    decisions = vertifleet.simulate(day, policy="greedy").trace.columns["to"]
    twin = load(SHIPPED[kind])
    assert_answers_are_those_of_the_program(twin, SHIPPED[kind], played(day, decisions))


@pytest.mark.parametrize("vertiports", [2, 8, 31])
def test_gcaps_x_answers_as_the_program_does_on_networks_of_any_size(vertiports):
    twin = load(SHIPPED["gcaps-x"])
    assert_answers_are_those_of_the_program(twin, SHIPPED["gcaps-x"], made_up(twin, vertiports))


@pytest.mark.parametrize("kind", SHIPPED)
def test_fresh_weights_are_read_by_the_program_and_answer_alike(kind, tmp_path):
    twin, path = fresh(kind), tmp_path / "fresh.safetensors"
    save_fresh(twin, path)
    assert vertifleet.Model.read(path).kind == kind
    assert_answers_are_those_of_the_program(twin, path, made_up(twin, 8))
    header = load(path).header
    assert (header["network"], header["seed"]) == ("paper", 3)
    assert header["steps"] == 1234
    if kind == "gcaps-x":
        assert (header["settings"], header["feature_scales"]) == (SETTINGS, None)
    else:
        assert (header["settings"], header["feature_scales"]) == (
            vertifleet.settings("paper"),
            NETWORK.feature_scales,
        )


@pytest.mark.parametrize(("kind", "days"), [("gcaps", 100), ("mlp", 10)])
def test_a_twin_decides_as_the_program_does(kind, days):
    # Rounding cannot change a choice here: no two best logits are closer than 1e-4 on these days.
    twin = load(SHIPPED[kind])
    for seed in range(1, days + 1):
        day = NETWORK.draw(seed)
        decisions = vertifleet.simulate(day, policy=kind).trace.columns["to"]
        choices = act(twin, played(day, decisions))
        np.testing.assert_array_equal(choices, decisions, err_msg=f"day {seed}")


def test_a_single_observation_is_decided_as_in_a_batch():
    twin = load(SHIPPED["gcaps"])
    day = NETWORK.draw(4)
    decisions = vertifleet.simulate(day, policy="gcaps").trace.columns["to"][:20]
    seen = played(day, decisions)
    singly = [act(twin, {name: column[row] for name, column in seen.items()}) for row in range(20)]
    assert all(type(choice) is int for choice in singly)
    assert singly == decisions.tolist()


def test_only_given_arguments_change_a_header(tmp_path):
    twin = load(SHIPPED["gcaps"])
    save(twin, tmp_path / "trained-on.safetensors", steps=7)
    found = load(tmp_path / "trained-on.safetensors").header
    assert found["steps"] == 7
    assert found["commit"] != twin.header["commit"]
    assert {**found, "steps": 0, "commit": ""} == {**twin.header, "steps": 0, "commit": ""}


def parts(path):
    """The tensors of a file, and its header as a dict."""
    file = path.read_bytes()
    (length,) = struct.unpack_from("<Q", file)
    text = json.loads(file[8 : 8 + length])["__metadata__"]["vertifleet"]
    return safetensors.load(file), json.loads(text)


def damaged(change):
    """The bytes of a file after `change` was applied to its tensors and its header."""
    tensors, header = parts(SHIPPED["gcaps-x"])
    change(tensors, header)
    return safetensors.save(tensors, metadata={"vertifleet": json.dumps(header)})


def broken_tensor(tensors, value):
    tensors["encoder.node.bias"] = value(tensors["encoder.node.bias"])


DAMAGES = {
    "a missing tensor": lambda tensors, _: tensors.pop("value.output.bias"),
    "an extra tensor": lambda tensors, _: tensors.update(extra=torch.zeros(1)),
    "a wrong shape": lambda tensors, _: broken_tensor(tensors, lambda bias: bias[:-1].clone()),
    "half precision": lambda tensors, _: broken_tensor(tensors, lambda bias: bias.half()),
    "not a number": lambda tensors, _: broken_tensor(tensors, lambda bias: bias * float("nan")),
    "infinity": lambda tensors, _: broken_tensor(tensors, lambda bias: bias + float("inf")),
    "another format": lambda _, header: header.update(format="vertifleet-weights/9"),
    "no format": lambda _, header: header.pop("format"),
    "an unknown member": lambda _, header: header.update(colour="blue"),
    "a missing member": lambda _, header: header.pop("seed"),
    "another kind": lambda _, header: header["policy"].update(kind="mlp"),
    "another width": lambda _, header: header["policy"].update(width=64),
    "a width beyond all reason": lambda _, header: header["policy"].update(width=10**9),
    "heads that do not divide the width": lambda _, header: header["policy"].update(heads=5),
    "other features": lambda _, header: header["shape"].update(node_features=25),
    "a negative seed": lambda _, header: header.update(seed=-1),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_file_is_refused(damage):
    with pytest.raises(vertifleet.Error) as refused:
        load(damaged(DAMAGES[damage]))
    assert refused.value.code == "V304"
    assert refused.value.hint


def test_a_file_that_is_cut_or_no_weight_file_is_refused():
    file = SHIPPED["gcaps-x"].read_bytes()
    without_header = safetensors.save({"weight": torch.zeros(2)})
    for contents in (b"", b"no weights", file[:-1], file[:1000], file + b"x", without_header):
        with pytest.raises(vertifleet.Error) as refused:
            load(contents)
        assert refused.value.code == "V304"


def test_a_file_that_is_not_there_is_an_error_that_names_it(tmp_path):
    with pytest.raises(vertifleet.Error, match="nowhere") as refused:
        load(tmp_path / "nowhere.safetensors")
    assert refused.value.code == "V101"


def refused_code(twin, path, **origin):
    with pytest.raises(vertifleet.Error) as refused:
        save(twin, path, **origin)
    return refused.value.code


def test_what_is_refused_is_not_written(tmp_path):
    path = tmp_path / "weights.safetensors"
    path.write_bytes(b"what was there before")
    origin = {"network": NETWORK, "settings": vertifleet.settings("paper"), "seed": 1, "steps": 1}
    assert refused_code(fresh("gcaps"), path) == "V451"
    for needed in ("network", "steps"):
        assert refused_code(fresh("gcaps"), path, **{**origin, needed: None}) == "V451"
    assert refused_code(Gcaps(9, width=8, heads=2), path, **origin) == "V451"
    assert refused_code(fresh("gcaps"), path, **{**origin, "seed": -1}) == "V451"
    assert refused_code(fresh("gcaps"), path, **{**origin, "settings": {"gamma": 1.0}}) == "V451"
    assert (
        refused_code(fresh("mlp"), path, **{**origin, "settings": origin["settings"] | {"gamma": 2.0}})
        == "V303"
    )
    diverged = fresh("mlp")
    with torch.no_grad():
        diverged.logits.bias[0] = float("nan")
    assert refused_code(diverged, path, **origin) == "V304"
    assert path.read_bytes() == b"what was there before"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("kind", ["gcaps", "mlp"])
def test_unknown_origins_stay_empty_in_the_header(kind, tmp_path):
    path = tmp_path / "weights.safetensors"
    save(fresh(kind), path, network=NETWORK, steps=5)
    header = load(path).header
    assert (header["settings"], header["seed"], header["steps"]) == (None, None, 5)
    twin = load(path)
    save(twin, path, seed=4)
    assert (load(path).header["settings"], load(path).header["seed"]) == (None, 4)
    assert vertifleet.simulate(NETWORK.draw(1), kind, model=path).summary["flights"] >= 0


def test_numbers_and_networks_of_any_kind_are_taken(tmp_path):
    file, path = tmp_path / "paper.toml", tmp_path / "weights.safetensors"
    file.write_text(NETWORK.toml)
    settings = vertifleet.settings("paper") | {"gamma": np.float32(0.9), "total_steps": 1e6}
    for network in ("paper", file, NETWORK):
        save(fresh("mlp"), path, network=network, settings=settings, seed=np.int64(3), steps=1e3)
        header = load(path).header
        assert (header["network"], header["seed"], header["steps"]) == ("paper", 3, 1000)
        assert header["settings"] == settings | {"gamma": pytest.approx(0.9), "total_steps": 1_000_000}


@pytest.mark.parametrize(
    ("wrong", "code", "named"),
    [
        ({"seed": -1}, "V451", "seed"),
        ({"seed": 2**32}, "V451", "seed"),
        ({"seed": True}, "V451", "seed"),
        ({"steps": 1.5}, "V451", "steps"),
        ({"settings": "paper"}, "V451", "settings"),
        ({"settings": {"gamma": 1.0}}, "V451", "total_steps"),
        ({"settings": {"gama": 1.0}}, "V302", "gama"),
        ({"settings": vertifleet.settings("paper") | {"gamma": "1"}}, "V303", "gamma"),
    ],
)
def test_an_origin_that_is_refused_is_named(wrong, code, named, tmp_path):
    with pytest.raises(vertifleet.Error, match=named) as refused:
        save(fresh("mlp"), tmp_path / "weights.safetensors", **{"network": NETWORK, "steps": 1} | wrong)
    assert refused.value.code == code


@pytest.mark.parametrize("kind", SHIPPED)
def test_weights_from_no_file_need_network_and_steps(kind, tmp_path):
    origin = {"network": NETWORK, "steps": 1}
    for needed in origin:
        assert refused_code(fresh(kind), tmp_path / "x.safetensors", **origin | {needed: None}) == "V451"
    save(fresh(kind), tmp_path / "x.safetensors", **origin)
    header = load(tmp_path / "x.safetensors").header
    assert (header["settings"], header["seed"]) == (None, None)


@pytest.mark.parametrize("kind", [GcapsX, GcapsFull])
def test_weights_that_read_charge_decide_alike_on_days_that_charge_as_needed(kind, tmp_path):
    torch.manual_seed(1)
    twin = kind(width=16, heads=4, charge=True)
    with torch.no_grad():
        for weight in twin.parameters():
            weight.add_(0.3 * torch.randn_like(weight))
    path = tmp_path / "mine.safetensors"
    save(twin, path, network="paper-quick", steps=1)
    read = load(path)
    assert read.charge
    assert "charge" not in kind().sizes
    assert read.shape["node_features"] == kind().node_features + 3
    program = vertifleet.policy(kind.kind, model=path)
    env = FleetEnv("paper-quick", observation=read.reads)
    observation, _ = env.reset(seed=1)
    for _ in range(60):
        choice = act(read, observation)
        assert choice == program.choose(env.view.decision, env.view)
        observation, *_ = env.step(choice)
    for charge in (1.5, "yes", None):
        with pytest.raises(vertifleet.Error, match="charge must be True or False"):
            kind(charge=charge)

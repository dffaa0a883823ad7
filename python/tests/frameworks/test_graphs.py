"""Graphs between the vertiports in PyTorch: the program's answers, gradients, weight files and decisions."""

import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest

import vertifleet

torch = pytest.importorskip("torch")

from vertifleet.envs import FleetEnv, FleetVectorEnv  # noqa: E402
from vertifleet.torch import Gcaps, GcapsFull, GcapsX, Graph, MlpFull, act, load, masked, save, scores  # noqa: E402
from vertifleet.torch.twin import of_sizes  # noqa: E402

REFERENCE = Path(__file__).parents[3] / "crates" / "learn" / "tests" / "reference"
CASES = json.loads((REFERENCE / "graphs.json").read_text(encoding="utf-8"))
GRAPHS = [case["sizes"]["graph"] for case in CASES]
NAMES = ["-".join(str(setting) for setting in graph.values()) for graph in GRAPHS]
EACH_GRAPH = pytest.mark.parametrize("graph", GRAPHS, ids=NAMES)
FULL = ["full_nodes", "full_aircraft", "clock", "vertiport_mask", "action_mask"]


def the_script():
    """The script that made the stored results, which the Rust tests also use."""
    spec = importlib.util.spec_from_file_location("make_reference", REFERENCE / "make_reference.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    return script


def drawn(twin, seed=3):
    """The twin with every weight drawn: biases and scales too."""
    torch.manual_seed(seed)
    with torch.no_grad():
        for weight in twin.parameters():
            weight.add_(0.2 * torch.randn_like(weight))
    return twin


def saved(twin, path):
    save(twin, path, network="paper", steps=7)
    return vertifleet.Model.read(path)


@pytest.mark.parametrize("case", CASES, ids=NAMES)
def test_outputs_and_gradients_are_the_stored_ones_of_the_rust_tests(case):
    script = the_script()
    sizes, batch = dict(case["sizes"]), case["batch"]
    count = sizes.pop("vertiports")
    twin = GcapsFull(**sizes).double()
    shapes = {name: tuple(weight.shape) for name, weight in twin.state_dict().items()}
    assert set(shapes) == set(case["slopes"])
    twin.load_state_dict({name: script.weight(name, shape) for name, shape in shapes.items()})

    def noise(name, *shape):
        return torch.tensor(script.noise(name, shape).astype(np.float64))

    edges = noise("edges", batch, count, count).clamp(min=0)
    edges[:, 0] = 0
    nodes, aircraft = noise("nodes", batch, count, 37), noise("aircraft", batch, 11)
    logits, values = twin(nodes, aircraft, noise("clock", batch), edges if twin.edges else None)
    expected = torch.tensor([np.nan if one is None else one for one in case["logits"]], dtype=torch.float64)
    mask = ~expected.isnan().view(batch, count)
    close = {"rtol": 1e-6, "atol": 1e-7}
    torch.testing.assert_close(logits[mask], expected[mask.flatten()], **close)
    torch.testing.assert_close(values, torch.tensor(case["values"], dtype=torch.float64), **close)

    loss = (noise("logit_slopes", batch, count) * logits)[mask].sum()
    (loss + (noise("value_slopes", batch) * values).sum()).backward()
    for name, weight in twin.named_parameters():
        stored = case["slopes"][name]
        if stored["norm"] == 0:
            assert weight.grad is None, name
            continue
        projection = (weight.grad * noise(f"{name} projection", *weight.shape)).sum().item()
        assert weight.grad.norm().item() == pytest.approx(stored["norm"], rel=1e-6), name
        assert projection == pytest.approx(stored["projection"], rel=1e-6, abs=1e-6 * stored["norm"]), name
        first = weight.grad.flatten()[:6].tolist()
        assert first == pytest.approx(stored["first"], rel=1e-6, abs=1e-6 * stored["norm"]), name


@EACH_GRAPH
def test_weights_of_any_graph_go_to_the_program_and_come_back(graph, tmp_path):
    twin, path = drawn(GcapsFull(width=16, heads=2, graph=graph)), tmp_path / "full.safetensors"
    model = saved(twin, path)
    assert {name: tensor.shape for name, tensor in model.tensors.items()} == {
        name: tuple(weight.shape) for name, weight in twin.state_dict().items()
    }
    again = load(path)
    assert (again.graph, again.policy) == (Graph(**graph), twin.policy)
    assert all(torch.equal(again.state_dict()[name], weight) for name, weight in twin.state_dict().items())

    random = np.random.default_rng(1)
    for count in (1, 2, 9):
        nodes, aircraft = random.random((6, count, 37), np.float32), random.random((6, 11), np.float32)
        mask, clock = np.ones((6, count)), random.random(6, np.float32)
        weights = random.random((6, count, count), np.float32) * (random.random((6, count, count)) < 0.5)
        extra = {"edges": weights.astype(np.float32)} if twin.edges else {}
        expected = model.forward(nodes, aircraft, mask, clock, **extra)
        with torch.inference_mode():
            inputs = (torch.from_numpy(array) for array in (nodes, aircraft, clock))
            found = twin(*inputs, **{name: torch.from_numpy(array) for name, array in extra.items()})
        for answers, expected_answers in zip(found, expected, strict=True):
            largest = max(np.abs(expected_answers).max(), 1)
            np.testing.assert_allclose(answers.numpy(), expected_answers, rtol=0, atol=1e-5 * largest)


@pytest.mark.parametrize("make", [GcapsX, lambda **of: Gcaps(8, **of)], ids=["gcaps-x", "gcaps"])
@pytest.mark.parametrize("graph", [graph for graph in GRAPHS if not Graph(**graph).edges])
def test_graphs_that_need_nothing_else_are_of_all_networks(make, graph, tmp_path):
    twin = drawn(make(width=16, heads=2, graph=graph))
    model = saved(twin, tmp_path / "x.safetensors")
    assert load(tmp_path / "x.safetensors").policy == twin.policy
    nodes, aircraft = torch.rand(3, 8, twin.node_features), torch.rand(3, twin.aircraft_features)
    expected, values = model.forward(nodes.numpy(), aircraft.numpy(), np.ones((3, 8)), np.zeros(3))
    found = twin(nodes, aircraft, torch.zeros(3))
    np.testing.assert_allclose(found[0].detach().numpy(), expected, rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(found[1].detach().numpy(), values, rtol=1e-4, atol=1e-5)


def assert_a_day_is_decided_as_by_the_program(twin, model, network, day):
    env = FleetEnv(network, observation=twin.reads)
    program = vertifleet.policy(twin.kind, model=model)
    observation, _ = env.reset(options={"scenario": day})
    over, decisions, choices = False, 0, 0
    while not over:
        expected = program.choose(env.view.decision, env.view)
        assert act(twin, observation) == expected, f"decision {decisions}"
        decisions, choices = decisions + 1, choices + (observation["action_mask"].sum() > 1)
        observation, _, over, _, _ = env.step(expected)
    assert choices > 50, "there was something to choose"


@pytest.mark.parametrize(
    ("graph", "name"),
    [
        ({}, "paper"),
        ({"adjacency": "profit"}, "random:11"),
        ({"adjacency": "distance", "laplacian": "normalised"}, "disrupted"),
        ({"adjacency": "reachable", "layers": 2}, "disrupted"),
        ({"adjacency": "similarity", "hops": 1, "moments": 1}, "random:5"),
        ({"encoder": "transformer"}, "new-york"),
    ],
)
def test_a_day_is_decided_as_by_the_program(graph, name, tmp_path):
    network = vertifleet.Network(name)
    twin = drawn(GcapsFull(width=16, heads=2, graph=graph))
    model = saved(twin, tmp_path / "full.safetensors")
    assert_a_day_is_decided_as_by_the_program(twin, model, network, network.draw(3))


def test_plain_layers_decide_a_day_as_the_program_does(tmp_path):
    network = vertifleet.Network("paper")
    twin = drawn(MlpFull(8, width=24, layers=3, value_width=8))
    model = saved(twin, tmp_path / "full.safetensors")
    header = load(tmp_path / "full.safetensors").header
    assert (header["policy"]["kind"], header["shape"]["vertiports"]) == ("mlp-full", 8)
    assert header["feature_scales"] is None
    assert_a_day_is_decided_as_by_the_program(twin, model, network, network.draw(3))


@pytest.mark.parametrize("graph", [{}, {"adjacency": "profit"}])
def test_padding_changes_no_output(graph):
    twin = drawn(GcapsFull(width=16, heads=2, graph=graph))
    edges = [twin.edges] if twin.edges else []
    envs = FleetVectorEnv(6, "random", observation=[*FULL, *edges])
    observation, _ = envs.reset(seed=4)
    for _ in range(40):
        choices = act(twin, observation)
        counts = observation["vertiport_mask"].sum(axis=1).astype(int)
        assert len(set(counts)) > 1, "the days have different sizes"
        for row, count in enumerate(counts):
            own = {name: array[row] for name, array in observation.items() if name != "vertiport_mask"}
            cut = {name: own[name][:count] for name in ("full_nodes", "action_mask", *edges)}
            cut |= {name: cut[name][:, :count] for name in edges}
            assert act(twin, own | cut) == choices[row]
        observation, *_ = envs.step(choices)
    batch = {name: torch.as_tensor(array) for name, array in observation.items()}
    found = scores(twin, batch)
    assert torch.equal(found > -torch.inf, batch["action_mask"] == 1)
    assert torch.equal(found.argmax(-1), torch.as_tensor(act(twin, observation)))
    (-found.log_softmax(-1).amax(-1).sum()).backward()
    assert all(bool(weight.grad.isfinite().all()) for weight in twin.encoder.parameters())


def refused(call, *arguments, **named):
    with pytest.raises(vertifleet.Error) as error:
        call(*arguments, **named)
    assert error.value.code == "V451"
    return str(error.value)


@pytest.mark.parametrize(
    ("graph", "named"),
    [
        ({"hops": 5}, "hops"),
        ({"moments": 0}, "moments"),
        ({"layers": True}, "layers"),
        ({"adjacency": "near"}, "adjacency"),
        ({"encoder": "rnn"}, "encoder"),
        ({"laplacian": None}, "laplacian"),
        ({"attention": 1}, "attention"),
        ({"colour": "blue"}, "colour"),
        ("profit", "graph"),
    ],
)
def test_graphs_that_no_network_has_are_refused(graph, named):
    assert named in refused(GcapsFull, graph=graph)


def test_edges_are_required_if_and_only_if_they_are_read(tmp_path):
    reads, knows = GcapsFull(width=8, heads=2, graph=Graph(adjacency="profit")), GcapsFull(width=8, heads=2)
    nodes, aircraft, clock, edges = (
        torch.rand(2, 5, 37),
        torch.rand(2, 11),
        torch.rand(2),
        torch.rand(2, 5, 5),
    )
    assert "profit_edges" in refused(reads, nodes, aircraft, clock)
    assert "no edges" in refused(knows, nodes, aircraft, clock, edges)
    assert "[2, 5, 5]" in refused(reads, nodes, aircraft, clock, edges[:, :4])
    flat = reads(nodes, aircraft, clock, edges.flatten(1))
    torch.testing.assert_close(flat, reads(nodes, aircraft, clock, edges))
    for twin, given in ((reads, None), (knows, edges)):
        model = saved(twin, tmp_path / "full.safetensors")
        assert "edges" in refused(model.forward, nodes, aircraft, np.ones((2, 5)), clock, given)
    observation, _ = FleetEnv(observation="gcaps-full").reset(seed=1)
    assert "profit_edges" in refused(act, reads, observation)
    for make in (lambda **of: Gcaps(8, **of), GcapsX):
        assert "shows no flights" in refused(make, graph={"adjacency": "reachable"})


def test_weights_of_any_size_may_come_from_networks_that_are_drawn(tmp_path):
    path = tmp_path / "full.safetensors"
    for world in ("random", "random-places:8"):
        save(GcapsFull(width=8, heads=2), path, network=world, steps=1)
        assert load(path).header["network"] == world
    with pytest.raises(vertifleet.Error):
        save(Gcaps(8, width=8, heads=2), path, network="random", steps=1)


def test_a_graph_may_be_given_among_the_sizes():
    graph = {"adjacency": "similarity", "hops": 1}
    twin = of_sizes(Gcaps, 8, {"width": 8, "heads": 2, "graph": graph})
    assert twin.sizes == of_sizes(Gcaps, 8, twin.sizes).sizes
    assert twin.sizes["graph"] == Graph(**graph).members


@pytest.mark.skipif(not torch.cuda.is_available(), reason="needs a GPU")
@EACH_GRAPH
def test_a_gpu_computes_the_same(graph):
    twin = drawn(GcapsFull(width=8, heads=2, graph=graph)).double()
    inputs = [torch.rand(*shape, dtype=torch.float64) for shape in ((3, 5, 37), (3, 11), (3,))]
    inputs += [torch.rand(3, 5, 5, dtype=torch.float64) if twin.edges else None]
    expected = [answer.detach() for answer in twin(*inputs)]
    found = twin.cuda()(*(None if part is None else part.cuda() for part in inputs))
    torch.testing.assert_close([answer.detach().cpu() for answer in found], expected)


def test_self_attention_reads_no_edges():
    twin = GcapsFull(graph={"encoder": "transformer", "adjacency": "profit"})
    assert twin.edges is None
    assert "adjacency" not in twin.reads


def test_what_is_masked_is_not_chosen_and_a_batch_is_decided_as_each_alone():
    twin = drawn(GcapsFull(width=8, heads=2))
    observation, _ = FleetVectorEnv(8, "paper", observation="gcaps-full").reset(seed=1)
    choices = act(twin, observation)
    assert all(observation["action_mask"][row, choice] == 1 for row, choice in enumerate(choices))
    singly = [act(twin, {name: array[row] for name, array in observation.items()}) for row in range(8)]
    assert choices.tolist() == singly
    inputs = [torch.as_tensor(observation[name]) for name in ("full_nodes", "full_aircraft", "clock")]
    logits = masked(twin(*inputs)[0], torch.as_tensor(observation["action_mask"]))
    assert choices.tolist() == logits.argmax(-1).tolist()

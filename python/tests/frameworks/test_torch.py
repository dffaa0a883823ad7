"""The networks in PyTorch: their outputs, their initial weights and their decisions."""

import math
import warnings

import numpy as np
import pytest

import vertifleet

torch = pytest.importorskip("torch")

from torch.nn.functional import layer_norm, relu  # noqa: E402

from vertifleet.torch import (  # noqa: E402
    Decisions,
    Gcaps,
    GcapsFull,
    GcapsX,
    Mlp,
    MlpFull,
    act,
    load,
    masked,
    scores,
)

VERTIPORTS = 5
SMALL = {
    "gcaps": lambda: Gcaps(VERTIPORTS, width=16, heads=4),
    "gcaps-x": lambda: GcapsX(width=16, heads=4),
    "gcaps-full": lambda: GcapsFull(width=16, heads=4),
    "mlp": lambda: Mlp(VERTIPORTS, width=16, layers=2, value_width=8),
    "mlp-full": lambda: MlpFull(VERTIPORTS, width=16, layers=2, value_width=8),
}
OF_ANY_SIZE, PLAIN = ("gcaps-x", "gcaps-full"), ("mlp", "mlp-full")
GAIN_RELU, GAIN_LOGITS, GAIN_VALUE = math.sqrt(2), 0.01, 0.1


def small(kind, seed=1):
    """A small network in double precision, every weight drawn: biases and scales too."""
    torch.manual_seed(seed)
    twin = SMALL[kind]().double()
    with torch.no_grad():
        for weight in twin.parameters():
            weight.add_(0.3 * torch.randn_like(weight))
    return twin


def inputs(twin, batch=3, vertiports=VERTIPORTS):
    """Random nodes [B, N, F], aircraft [B, G] and clock [B]."""
    random = torch.Generator().manual_seed(7)

    def draw(*shape):
        return torch.rand(shape, generator=random, dtype=torch.float64) * 2 - 1

    return draw(batch, vertiports, twin.node_features), draw(batch, twin.aircraft_features), draw(batch).abs()


def gcaps_to_the_letter(w, heads, nodes, aircraft, clock):
    """Eq. 18-21 computed literally, with the Laplacian as a matrix and a key and a value for every node."""
    n, h = nodes.shape[1], w["encoder.node.bias"].shape[0]
    laplacian = n * torch.eye(n, dtype=nodes.dtype) - torch.ones(n, n, dtype=nodes.dtype)
    powers = [torch.eye(n, dtype=nodes.dtype), laplacian, laplacian @ laplacian]
    f_0 = nodes @ w["encoder.node.weight"] + w["encoder.node.bias"]
    # The files contain V_pa, and W_pa = V_pa / N^a.
    capsules = [
        relu(sum(powers[a] @ f_0**p @ w[f"encoder.moment_{p}.hop_{a}.weight"] / n**a for a in (0, 1, 2)))
        for p in (1, 2)
    ]
    embeddings = torch.cat(capsules, -1) @ w["encoder.feed_forward.weight"] + w["encoder.feed_forward.bias"]

    q = aircraft @ w["decoder.query.weight"] + w["decoder.query.bias"]
    keys, values = embeddings @ w["decoder.key.weight"], embeddings @ w["decoder.value.weight"]
    collected = []
    for part in torch.arange(h).chunk(heads):
        scores = torch.einsum("bd,bnd->bn", q[:, part], keys[:, :, part]) / math.sqrt(h // heads)
        collected.append(torch.einsum("bn,bnd->bd", scores.softmax(-1), values[:, :, part]))
    attended = torch.cat(collected, -1) @ w["decoder.output.weight"]
    z = layer_norm(q + attended, (h,), w["decoder.norm_1.scale"], w["decoder.norm_1.shift"])
    lifted = relu(z @ w["decoder.feed_forward.weight"] + w["decoder.feed_forward.bias"])
    y = layer_norm(z + lifted, (h,), w["decoder.norm_2.scale"], w["decoder.norm_2.shift"])
    logits = torch.einsum("bh,bnh->bn", y @ w["decoder.pointer.weight"], embeddings) / math.sqrt(h)

    rows = torch.cat([w["value.means.weight"], w["value.hidden.weight"]])
    seen = torch.cat([embeddings.mean(1), y, clock[:, None]], -1)
    hidden = relu(seen @ rows + w["value.hidden.bias"])
    return logits, hidden @ w["value.output.weight"] + w["value.output.bias"]


def mlp_to_the_letter(w, nodes, aircraft, clock):
    x = torch.cat([nodes.flatten(1), aircraft], -1)
    for layer in (1, 2):
        x = relu(x @ w[f"trunk.{layer}.weight"] + w[f"trunk.{layer}.bias"])
    seen = torch.cat([x, clock[:, None]], -1)
    hidden = relu(seen @ w["value.hidden.weight"] + w["value.hidden.bias"])
    values = hidden @ w["value.output.weight"] + w["value.output.bias"]
    return x @ w["logits.weight"] + w["logits.bias"], values


@pytest.mark.parametrize("kind", ["gcaps", *OF_ANY_SIZE])
def test_gcaps_equals_a_literal_reading_of_equations_18_to_21(kind):
    twin = small(kind)
    expected = gcaps_to_the_letter(twin.state_dict(), 4, *inputs(twin))
    torch.testing.assert_close(twin(*inputs(twin)), expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("kind", PLAIN)
def test_mlp_is_plain_layers_on_the_flattened_features(kind):
    twin = small(kind)
    expected = mlp_to_the_letter(twin.state_dict(), *inputs(twin))
    torch.testing.assert_close(twin(*inputs(twin)), expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("kind", SMALL)
def test_features_may_come_flat_and_the_clock_as_a_column(kind):
    twin = small(kind)
    nodes, aircraft, clock = inputs(twin)
    expected = twin(nodes, aircraft, clock)
    assert [tuple(answer.shape) for answer in expected] == [(3, VERTIPORTS), (3,)]
    torch.testing.assert_close(twin(nodes.flatten(1), aircraft, clock[:, None]), expected)


@pytest.mark.parametrize("kind", ["gcaps", *OF_ANY_SIZE])
def test_gcaps_does_not_depend_on_the_order_of_the_vertiports(kind):
    twin = small(kind)
    nodes, aircraft, clock = inputs(twin)
    order = torch.tensor([3, 0, 4, 1, 2])
    logits, values = twin(nodes, aircraft, clock)
    moved = twin(nodes[:, order], aircraft, clock)
    torch.testing.assert_close(moved, (logits[:, order], values))


@pytest.mark.parametrize("kind", OF_ANY_SIZE)
def test_these_networks_take_any_number_of_vertiports(kind):
    twin = small(kind)
    for vertiports in (1, 2, 30):
        logits, values = twin(*inputs(twin, vertiports=vertiports))
        assert logits.shape == (3, vertiports)
        assert values.shape == (3,)


@pytest.mark.parametrize("kind", SMALL)
def test_the_clock_moves_the_value_alone(kind):
    twin = small(kind)
    nodes, aircraft, clock = inputs(twin)
    (logits, values), (later_logits, later_values) = (twin(nodes, aircraft, at) for at in (clock, clock / 2))
    assert torch.equal(logits, later_logits)
    assert not torch.allclose(values, later_values)


@pytest.mark.parametrize("kind", SMALL)
def test_every_weight_learns(kind):
    twin = small(kind)
    logits, values = twin(*inputs(twin, batch=20))
    (logits.log_softmax(-1)[:, 1].sum() + values.sum()).backward()
    for name, weight in twin.named_parameters():
        assert weight.grad is not None, name
        assert weight.grad.abs().sum() > 0, name


@pytest.mark.parametrize("kind", SMALL)
def test_the_gradient_equals_that_of_the_literal_equations(kind):
    twin = small(kind)
    logits, values = twin(*inputs(twin))
    (logits.sin().sum() + values.sum()).backward()
    letter = {name: weight.detach().clone().requires_grad_() for name, weight in twin.named_parameters()}
    data = inputs(twin)
    logits, values = (
        mlp_to_the_letter(letter, *data) if kind in PLAIN else gcaps_to_the_letter(letter, 4, *data)
    )
    (logits.sin().sum() + values.sum()).backward()
    for name, weight in twin.named_parameters():
        torch.testing.assert_close(weight.grad, letter[name].grad, rtol=1e-8, atol=1e-8, msg=name)


def first_spread(kind):
    """The standard deviation of each tensor's first weights, for the default sizes on 8 vertiports."""
    if kind == "mlp":
        return {
            "trunk.1.weight": GAIN_RELU / math.sqrt(8 * 20 + 18),
            "trunk.2.weight": GAIN_RELU / math.sqrt(800),
            "logits.weight": GAIN_LOGITS / math.sqrt(800),
            "value.hidden.weight": GAIN_RELU / math.sqrt(801),
            "value.output.weight": GAIN_VALUE / math.sqrt(256),
        }
    hops = {
        f"encoder.moment_{p}.hop_{a}.weight": GAIN_RELU / math.sqrt(3 * 256)
        for p in (1, 2)
        for a in (0, 1, 2)
    }
    square = 1 / math.sqrt(256)
    return hops | {
        "encoder.node.weight": 1 / math.sqrt(20),
        "encoder.feed_forward.weight": 1 / math.sqrt(512),
        "decoder.query.weight": 1 / math.sqrt(18),
        "decoder.key.weight": square,
        "decoder.value.weight": square,
        "decoder.output.weight": square,
        "decoder.feed_forward.weight": GAIN_RELU * square,
        "decoder.pointer.weight": GAIN_LOGITS * square,
        "value.means.weight": GAIN_RELU / math.sqrt(2 * 256 + 1),
        "value.hidden.weight": GAIN_RELU / math.sqrt(2 * 256 + 1),
        "value.output.weight": GAIN_VALUE * square,
    }


@pytest.mark.parametrize("kind", ["gcaps", "mlp"])
def test_first_weights_are_spread_as_those_of_the_program(kind):
    torch.manual_seed(1)
    twin = {"gcaps": Gcaps, "mlp": Mlp}[kind](8)
    spread = first_spread(kind)
    for name, weight in twin.state_dict().items():
        if name in spread:
            # The largest entry shows the range of the distribution, the spread that it is uniform.
            reach = math.sqrt(3) * spread[name]
            assert 0.95 * reach < weight.abs().max() <= reach, name
            assert weight.std().item() == pytest.approx(spread[name], rel=0.15), name
        else:
            assert torch.equal(weight, torch.full_like(weight, 1.0 if name.endswith(".scale") else 0.0)), name


def test_first_weights_follow_from_the_seed():
    def weights(seed):
        torch.manual_seed(seed)
        return torch.cat([weight.flatten() for weight in SMALL["gcaps"]().parameters()])

    assert torch.equal(weights(3), weights(3))
    assert not torch.equal(weights(3), weights(4))


@pytest.mark.parametrize(
    "make",
    [
        lambda: Gcaps(0),
        lambda: Gcaps(5000),
        lambda: Gcaps(8, width=0),
        lambda: Gcaps(8, width=10, heads=4),
        lambda: Mlp(8, layers=17),
        lambda: Mlp(8, value_width=-1),
        lambda: GcapsX(heads=2.0),
    ],
)
def test_sizes_that_no_network_has_are_refused(make):
    with pytest.raises(vertifleet.Error) as refused:
        make()
    assert refused.value.code == "V451"


def test_what_is_masked_has_no_probability():
    logits, mask = torch.tensor([[5.0, 1.0, 2.0]]), torch.tensor([[0.0, 1.0, 1.0]])
    probabilities = masked(logits, mask).softmax(-1)
    assert probabilities[0, 0] == 0
    torch.testing.assert_close(probabilities[0, 1:], torch.tensor([1.0, 2.0]).softmax(-1))


class Fixed(Mlp):
    """A network that returns its first aircraft features as logits."""

    def forward(self, nodes, aircraft, clock):  # noqa: ARG002
        return aircraft[:, : self.vertiports], clock


def observation(logits, mask):
    *batch, vertiports = np.shape(logits)
    shown = {"nodes": vertiports * (2 * vertiports + 4), "aircraft": 2 * vertiports + 2, "clock": 1}
    arrays = {name: np.zeros((*batch, size), np.float32) for name, size in shown.items()}
    arrays["aircraft"][..., :vertiports] = logits
    return arrays | {"action_mask": np.array(mask, np.float32)}


def test_the_feasible_vertiport_with_the_highest_logit_is_chosen_the_first_among_equals():
    assert act(Fixed(4, width=1), observation([1.0, 9.0, 3.0, 3.0], [1, 0, 1, 1])) == 2
    assert act(Fixed(2, width=1), observation([-9.0, -1.0], [1, 0])) == 0
    batch = observation([[0.0, 0.0, 0.0], [0.0, 1.0, 2.0]], [[0, 1, 1], [1, 1, 1]])
    assert act(Fixed(3, width=1), batch).tolist() == [1, 2]


@pytest.mark.skipif(not torch.cuda.is_available(), reason="needs a GPU")
@pytest.mark.parametrize("kind", SMALL)
def test_a_gpu_computes_the_same(kind):
    twin = small(kind)
    data = inputs(twin)
    expected = [answer.detach() for answer in twin(*data)]
    found = twin.cuda()(*(part.cuda() for part in data))
    torch.testing.assert_close([answer.detach().cpu() for answer in found], expected)


@pytest.mark.parametrize("kind", SMALL)
def test_sizes_may_be_numbers_of_numpy(kind):
    make = {"gcaps": lambda size: Gcaps(size(5), width=size(8), heads=size(2))}
    make["mlp"] = lambda size: Mlp(size(5), width=size(8), layers=size(1), value_width=size(4))
    make["mlp-full"] = lambda size: MlpFull(size(5), width=size(8), layers=size(1), value_width=size(4))
    make["gcaps-x"] = lambda size: GcapsX(width=size(8), heads=size(2))
    make["gcaps-full"] = lambda size: GcapsFull(width=size(8), heads=size(2), graph={"hops": size(1)})
    twin = make[kind](np.int64)
    assert twin.policy == make[kind](int).policy
    sizes = [*twin.sizes.values(), *twin.shape.values()]
    assert all(type(size) is int for size in sizes if size is not None and not isinstance(size, dict))
    assert type(twin.sizes.get("graph", {"hops": 1})["hops"]) is int


@pytest.mark.parametrize("size", [True, np.True_, 2.0, "2", None])
def test_a_size_must_be_a_whole_number(size):
    with pytest.raises(vertifleet.Error) as refused:
        Gcaps(size, width=8, heads=2)
    assert refused.value.code == "V451"


def shown(twin, *batch, vertiports=VERTIPORTS):
    """A made-up observation or a batch of them, with all actions feasible."""
    if twin.kind == "gcaps-x":
        return {
            "priced_nodes": np.ones((*batch, vertiports, 24), np.float32),
            "priced_aircraft": np.ones((*batch, 10), np.float32),
            "priced_worth": np.zeros((*batch, vertiports), np.float32),
        }
    sizes = {f"{twin.features}nodes": vertiports * twin.node_features, "clock": 1}
    sizes[f"{twin.features}aircraft"] = twin.aircraft_features
    return {name: np.ones((*batch, size), np.float32) for name, size in sizes.items()} | {
        "action_mask": np.ones((*batch, vertiports), np.float32)
    }


@pytest.mark.parametrize("kind", SMALL)
def test_a_twin_of_half_precision_decides_and_an_empty_batch_is_decided(kind):
    twin = SMALL[kind]()
    assert act(twin, shown(twin, 0)).shape == (0,)
    assert act(twin.bfloat16(), shown(twin)) in range(VERTIPORTS)
    assert act(twin, shown(twin, 2)).dtype == np.int64


@pytest.mark.parametrize("kind", ["gcaps", *PLAIN])
def test_nodes_of_another_number_of_vertiports_are_refused(kind):
    twin = small(kind)
    nodes, aircraft, clock = inputs(twin, vertiports=2 * VERTIPORTS)
    for wrong in (nodes, nodes.flatten(1)):
        with pytest.raises(vertifleet.Error, match=r"nodes must be \[B, 5, \d+\]") as refused:
            twin(wrong, aircraft, clock)
        assert refused.value.code == "V451"


@pytest.mark.parametrize("kind", SMALL)
@pytest.mark.parametrize("batch", [(), (3,)])
def test_an_observation_that_does_not_fit_is_refused(kind, batch):
    twin = SMALL[kind]()
    fits = shown(twin, *batch)
    wrong = {
        "of another policy": (shown(Gcaps(VERTIPORTS) if kind == "gcaps-x" else GcapsX(), *batch), "lacks"),
    }
    if kind == "gcaps-x":
        wrong |= {
            "with worths of others": (fits | {"priced_worth": np.ones((*batch, 2))}, "priced_worth must be"),
            "with other aircraft": (fits | {"priced_aircraft": np.ones((*batch, 3))}, "aircraft must be"),
        }
    else:
        wrong |= {
            "without a mask": (
                {name: fits[name] for name in fits if "mask" not in name},
                "lacks action_mask",
            ),
            "with a mask of others": (fits | {"action_mask": np.ones((*batch, 2))}, "action_mask must be"),
            "with other aircraft": (fits | {f"{twin.features}aircraft": np.ones((*batch, 3))}, "must be"),
            "with more clocks": (fits | {"clock": np.ones((*batch, 2))}, "clock must be"),
        }
    if twin.vertiports:
        wrong["of another network"] = (shown(twin, *batch, vertiports=VERTIPORTS + 1), "must be")
    for what, (observation, rule) in wrong.items():
        with pytest.raises(vertifleet.Error, match=rule) as refused:
            act(twin, observation)
        assert refused.value.code == "V451", what


@pytest.mark.parametrize("network", ["paper", "new-york", "random:11"])
def test_the_twin_of_gcaps_x_chooses_as_the_program_does(network, tmp_path):
    vertifleet.Model.shipped("gcaps-x").write(tmp_path / "x.safetensors")
    twin = load(tmp_path / "x.safetensors")
    env = vertifleet.envs.FleetEnv(network, observation="gcaps-x")
    observation, _ = env.reset(seed=2)
    policy = vertifleet.policy("gcaps-x")
    choices = 0
    for _ in range(150):
        expected = policy.choose(env.view.decision, env.view)
        assert act(twin, observation) == expected
        if (observation["priced_nodes"][:, 0] == 1).sum() > 1:
            choices += 1
            batch = {name: torch.as_tensor(array)[None] for name, array in observation.items()}
        observation, *_ = env.step(expected)
    assert choices > 20, "there was something to choose"
    found = scores(twin, batch)
    (-found[found > -torch.inf].log_softmax(0)[0]).backward()
    assert any(parameter.grad is not None and parameter.grad.any() for parameter in twin.parameters())


def test_decisions_of_a_file_are_writable_tensors_with_its_numbers(tmp_path):
    pytest.importorskip("pyarrow")
    recorded = vertifleet.dataset("greedy", 1, observation="paper")
    recorded.write(tmp_path / "greedy.parquet")
    read = vertifleet.Dataset.read(tmp_path / "greedy.parquet")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        decisions = Decisions(read)
    every = decisions[torch.arange(len(decisions))]
    for name, array in (
        recorded.observation | {"action": recorded.action, "reward": recorded.reward}
    ).items():
        np.testing.assert_array_equal(every[name].numpy(), array)
    decisions[0]["action"] += 1

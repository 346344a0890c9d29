"""The PyTorch reference: keys, taps, and properties that follow from the thesis' equations."""

import os

import numpy as np
import pytest

from converters import goldens, networks, shapes, verify
from converters.random_weights import random_weights

torch = pytest.importorskip("torch")

from converters.reference import blocks  # noqa: E402  pylint: disable=wrong-import-position
from converters.reference.run import build, run  # noqa: E402  pylint: disable=wrong-import-position

GOLDENS = os.path.join(os.path.dirname(__file__), "..", "goldens")
# Two double-precision runs rounded to float32: one rounding apart.
ROUNDING = 2.0 ** -22


def make(changes, normalisations=(goldens.SPEECH, goldens.POSE)):
    config = {"config": {**goldens.SMALL, **changes}, "normalisations": list(normalisations)}
    network = networks.complete("zs_mstm1", config)
    return network, build(network, random_weights(network, 1)), networks.random_inputs(network, 2)


@pytest.mark.parametrize("case", list(goldens.cases()), ids=lambda case: case.name)
def test_shapes_are_the_keys_of_the_module(case):
    network = case.network()
    module = build(network, random_weights(network, 1)).weights()
    found = {key: tuple(x.shape) for key, x in module.state_dict().items()}
    assert found == shapes.network_shapes(network)


@pytest.mark.parametrize("case", list(goldens.cases()), ids=lambda case: case.name)
def test_goldens_are_up_to_date(case, tmp_path):
    goldens.make_case(str(tmp_path), case)
    with np.load(tmp_path / f"{case.name}.npz") as fresh, \
            np.load(os.path.join(GOLDENS, f"{case.name}.npz")) as kept:
        assert fresh.files == kept.files
        for key in fresh.files:
            assert verify.relative_error(fresh[key], kept[key]) <= ROUNDING, key


def test_goldens_are_deterministic(tmp_path):
    case = next(goldens.cases())
    for folder in ("a", "b"):
        os.mkdir(tmp_path / folder)
        goldens.make_case(str(tmp_path / folder), next(goldens.cases()))
    for suffix in (".fb", ".npz"):
        name = case.name + suffix
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


@pytest.mark.parametrize("mode", ["Autoregressive", "ShiftedParallel", "Parallel"])
@pytest.mark.parametrize("granularity", ["Frame", "Segment"])
def test_outputs_follow_every_input(mode, granularity):
    """Random weights carry the signal: no input drowns on its way to the poses."""
    network, module, inputs = make({"decoder_mode": mode, "granularity": granularity})
    other = networks.random_inputs(network, 3)
    base = run(module, inputs, taps=True)["tap/generator/head"]
    if not (granularity == "Segment" and mode != "Parallel"):
        assert np.abs(base).max() < 10
    for name in inputs:
        moved = run(module, {**inputs, name: other[name]}, taps=True)["tap/generator/head"]
        assert np.abs(moved - base).max() > 0.005, name


def test_style_vector_replaces_the_clip():
    _, module, inputs = make({})
    whole = run(module, inputs)
    style = {"speech": inputs["speech"], "text": inputs["text"], "style": whole["style"]}
    assert verify.relative_error(run(module, style)["pose"], whole["pose"]) < 1e-6


def test_style_of_a_long_clip_is_the_mean_of_its_segments():
    network, module, _ = make({})
    inputs = networks.random_inputs(network, 4, style_segments=3)
    clip = [inputs[name] for name in ("style_speech", "style_text", "style_pose")]
    parts = [module.style(*(torch.from_numpy(x[8 * i:8 * i + 8]).double() for x in clip))
             for i in range(3)]
    want = torch.stack(parts).mean(0).detach().numpy()
    assert verify.relative_error(run(module, inputs)["style"], want) < 1e-6


@pytest.mark.parametrize("stream", ["speech", "pose"])
def test_normalisation_is_a_change_of_units(stream):
    """x' = (x - mean) / (2 deviation): a stream in other units gives the same style."""
    _, module, inputs = make({})
    base = run(module, inputs)
    statistics = {"speech": goldens.SPEECH, "pose": goldens.POSE}[stream]
    plain = [s for s in (goldens.SPEECH, goldens.POSE) if s["stream"] != stream]
    _, other, _ = make({}, plain)
    by_hand = {name: (x - np.array(statistics["mean"])) / (2 * np.array(statistics["deviation"]))
               if name.endswith(stream) else x for name, x in inputs.items()}
    got = run(other, by_hand)
    assert verify.relative_error(got["style"], base["style"]) < 1e-6
    if stream == "pose":
        undone = got["pose"] * 2 * np.array(goldens.POSE["deviation"]) + goldens.POSE["mean"]
        assert verify.relative_error(undone, base["pose"]) < 1e-6


def test_autoregressive_rows_depend_on_the_rows_before():
    """The pose of row j is the head of the decoder run on poses 0 to j - 1 alone."""
    _, module, inputs = make({"decoder_layers": 2})
    taps = run(module, inputs, taps=True)
    z = torch.from_numpy(taps["tap/generator/z"]).double()
    poses = torch.from_numpy(taps["tap/generator/head"]).double()
    g = module.generator
    for j in (0, 1, 5):
        before = torch.cat([torch.zeros(1, 6, dtype=torch.float64), poses[:j]])
        with torch.no_grad():
            row = g.head(g.decode(g.embedding(before), z, blocks.no_tap))[-1]
        assert verify.relative_error(row.numpy(), poses[j].numpy()) < 1e-5


@pytest.mark.parametrize("mode, sees", [("ShiftedParallel", 3), ("Parallel", 2)])
def test_targets_are_causal(mode, sees):
    """Row i of the target reaches rows i and later; shifted, rows i + 1 and later."""
    _, module, _ = make({"decoder_mode": mode, "positions": "None"})
    z = torch.randn(8, 16, dtype=torch.float64)
    with torch.no_grad():
        target = torch.cat([torch.zeros_like(z[:1]), z[:-1]]) if mode != "Parallel" else z
        changed = target.clone()
        changed[sees:] += 1
        a, b = (module.generator.decode(x, z, blocks.no_tap) for x in (target, changed))
    assert torch.equal(a[:sees], b[:sees]) and not torch.allclose(a[sees:], b[sees:])


def test_positions():
    pe = blocks.sinusoidal_positions(5, 6).numpy()
    for p in range(5):
        for i in range(6):
            angle = p / 10000 ** ((i - i % 2) / 6)
            assert pe[p, i] == pytest.approx(np.cos(angle) if i % 2 else np.sin(angle), abs=1e-12)


def test_patches_are_numbered_frequency_first():
    """Only the patch that covers the touched pixel changes: bins 6 to 9, frames 3 to 6."""
    network = networks.complete("ast", {"config": goldens.AST})
    module = build(network, random_weights(network, 1))
    x = np.zeros((8, 16), np.float32)
    base = run(module, {"speech": x}, taps=True)["tap/ast/patches"]
    x[4, 8] = 1  # frame 4, bin 8: patches of rows f with 3f <= 8 <= 3f+3, columns t alike
    moved = run(module, {"speech": x}, taps=True)["tap/ast/patches"]
    assert np.flatnonzero(np.abs(moved - base).max(1)).tolist() == [2 * 2 + 1]


def test_compare_finds_a_difference():
    want = {"tap/a": np.ones((2, 2), np.float32), "pose": np.full(3, 2, np.float32)}
    got = {"pose": np.array([2, 2, 2.1], np.float32), "tap/a": np.ones((2, 2), np.float32)}
    assert [(n, round(e, 3)) for n, _, e in verify.compare(got, want)] == [("tap/a", 0.0),
                                                                         ("pose", 0.05)]
    missing = verify.compare({"pose": want["pose"]}, want)
    assert missing == [("tap/a", (2, 2), float("inf")), ("pose", (3,), 0.0)]
    assert verify.relative_error(np.ones(3), np.ones(4)) == float("inf")
    assert np.isnan(verify.relative_error(np.array([np.nan]), np.ones(1)))
    whole = np.array([1000, 2], np.int32)
    assert verify.relative_error(whole.copy(), whole) == 0
    assert verify.relative_error(whole + [0, 1], whole) == float("inf")
    assert verify.relative_error(whole.astype(np.float32), whole) == float("inf")

"""--map: tensors under names of anybody's."""

import json
import pathlib

import numpy as np
import pytest

torch = pytest.importorskip("torch")

from conftest import same, weights  # noqa: E402
from converters import mapping, weights_file  # noqa: E402
from converters.__main__ import main  # noqa: E402
from converters.checkpoint import Checkpoint  # noqa: E402
from converters.errors import ConvertError  # noqa: E402
from converters.random_weights import save_checkpoint  # noqa: E402

CLASSIFIER = {"frames": 3, "d_in": 4, "hidden": 5, "layers": 2}
AUTOENCODER = {"length": 5, "hidden": 3}


@pytest.fixture
def export(tmp_path, export):
    """conftest's, with the entries of a map after the configuration."""
    def with_map(path, kind, config, entries, *options):
        (tmp_path / "map.json").write_text(json.dumps(entries))
        return export(path, kind, config, "--map", tmp_path / "map.json", *options)
    return with_map


def test_placeholders_transpose_join_and_a_shared_source(tmp_path, export):
    """A checkpoint that splits gates, transposes, numbers from elsewhere and has one bias."""
    want = weights("classifier", CLASSIFIER)
    theirs = {"out/kernel": want["dense.weight"].T.copy(), "out/bias": want["dense.bias"]}
    zeros = np.zeros(20, np.float32)
    for k in range(2):
        for gate, rows in zip("ifgo", np.split(want[f"lstm.weight_ih_l{k}"], 4)):
            theirs[f"rnn/{k}/w_{gate}"] = rows.copy()
        theirs[f"rnn/{k}/u"] = want[f"lstm.weight_hh_l{k}"].T.copy()
        theirs[f"rnn/{k}/b"] = want[f"lstm.bias_ih_l{k}"]
        want[f"lstm.bias_hh_l{k}"] = zeros
    theirs["zeros"] = zeros
    save_checkpoint(tmp_path / "m.pt", theirs)
    code, tensors, said = export(tmp_path / "m.pt", "classifier", CLASSIFIER, {
        "dense.weight": {"from": "out/kernel", "transpose": True}, "dense.bias": "out/bias",
        "lstm.weight_ih_l{k}": {"from": [f"rnn/{{k}}/w_{g}" for g in "ifgo"], "join": 0},
        "lstm.weight_hh_l{k}": {"from": "rnn/{k}/u", "transpose": True},
        "lstm.bias_ih_l{k}": "rnn/{k}/b", "lstm.bias_hh_l{k}": "zeros"})
    assert code == 0, said
    same(tensors, want)


def map_of_the_docs():
    page = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "converters.md").read_text()
    return json.loads(page.partition("```json\n")[2].partition("```")[0])


def test_keras_autoencoder_with_the_map_of_the_docs(tmp_path, export):
    keras = pytest.importorskip("keras_file")
    want = weights("autoencoder", AUTOENCODER)
    for key in want:
        if "bias_hh" in key:
            want[key] = np.zeros_like(want[key])

    def lstm(key, name, end=""):
        return keras.lstm(name, *(want[f"{key}.{x}_l0{end}"].T
                                  for x in ("weight_ih", "weight_hh", "bias_ih")))

    def both(key, name):
        return keras.bidirectional(name, lstm(key, "lstm"), lstm(key, "lstm", "_reverse"))

    keras.write_model(tmp_path / "ae.h5", [
        keras.layer("InputLayer", "input_1"), both("encoder.lstm1", "bidirectional"),
        keras.layer("LeakyReLU", "leaky_re_lu", alpha=0.05), both("encoder.lstm2",
                                                                  "bidirectional_1"),
        keras.layer("RepeatVector", "repeat_vector", n=5), lstm("decoder.lstm1", "lstm_2"),
        lstm("decoder.lstm2", "lstm_3"), keras.time_distributed("time_distributed", keras.dense(
            "dense", want["decoder.dense.weight"].T, want["decoder.dense.bias"]))])
    code, tensors, said = export(tmp_path / "ae.h5", "autoencoder", AUTOENCODER,
                                 map_of_the_docs())
    assert code == 0, said
    same(tensors, want)
    assert f"tensors: {len(want)} used, 0 unused, 0 missing" in said
    assert main(["inspect", str(tmp_path / "ae.h5")]) == 0


def test_a_refused_layer_is_named_with_its_reason(tmp_path, export):
    keras = pytest.importorskip("keras_file")
    want = weights("classifier", CLASSIFIER)
    layer = keras.lstm("lstm", np.ones((4, 20), np.float32), np.ones((5, 20), np.float32), None,
                       activation="relu")
    keras.write_model(tmp_path / "m.h5", [layer, keras.dense("dense", want["dense.weight"].T,
                                                             want["dense.bias"])])
    code, _, said = export(tmp_path / "m.h5", "classifier", CLASSIFIER, {"lstm.*": "lstm.*"})
    assert code == 2 and "map.json: lstm.weight_ih_l0: lstm.weight_ih_l0: lstm is refused: LSTM " \
        "with activation relu, expected tanh" in said
    code, _, said = export(tmp_path / "m.h5", "classifier", CLASSIFIER,
                           {"dense.bias": "dense.bias"})
    assert code == 2 and "lstm.weight_ih_l0: missing, expected (20, 4), lstm is refused" in said


def test_an_epsilon_of_keras_is_held_against_the_configuration(tmp_path, export):
    keras = pytest.importorskip("keras_file")
    config = {"layers": 1, "d_model": 8, "heads": 2, "d_mlp": 8, "tokens": 20, "positions": 4}
    tensors = weights("bert", config)
    norm = {x: tensors["embeddings.LayerNorm." + y] for x, y in (("gamma", "weight"),
                                                                ("beta", "bias"))}
    rest = [keras.layer("Own", key.replace(".", "_"), {"value": x}) for key, x in tensors.items()
            if "embeddings.LayerNorm" not in key]
    entries = {key: key.replace(".", "_") + ".value" for key in tensors
               if "embeddings.LayerNorm" not in key}
    entries["embeddings.LayerNorm.*"] = "norm.*"
    for layer, expected in ((keras.layer("LayerNormalization", "norm", norm, epsilon=1e-6), 2),
                            (keras.layer("LayerNormalization", "norm", norm), 2),
                            (keras.layer("LayerNormalization", "norm", norm, epsilon=1e-12), 0)):
        # The layers of the author's own are unknown to model_config.
        keras.write_model(tmp_path / "m.h5", [layer, *rest])
        _forget(tmp_path / "m.h5", "Own")
        code, _, said = export(tmp_path / "m.h5", "bert", config, entries)
        assert code == expected, said
        if expected:
            value = "1e-06" if "epsilon" in layer[1] else "0.001"
            assert f"layer norm: LayerNorm epsilon {value}, expected 1e-12 as config.ln_eps" in said
            assert export(tmp_path / "m.h5", "bert", config, entries, "--keep-epsilon")[0] == 0


def _forget(path, kind):
    import h5py
    with h5py.File(path, "a") as file:
        config = json.loads(file.attrs["model_config"])
        layers = config["config"]["layers"]
        config["config"]["layers"] = [x for x in layers if x["class_name"] != kind]
        file.attrs["model_config"] = json.dumps(config)


def test_keys_that_the_map_leaves_out_keep_their_names(tmp_path, export):
    want = weights("classifier", CLASSIFIER)
    theirs = dict(want)
    theirs["other.weight"] = theirs.pop("dense.weight")
    save_checkpoint(tmp_path / "m.pt", theirs)
    code, tensors, said = export(tmp_path / "m.pt", "classifier", CLASSIFIER,
                                 {"dense.weight": "other.weight"})
    assert code == 0, said
    same(tensors, want)


def test_what_the_map_replaces_is_unused(tmp_path, export):
    want = weights("classifier", CLASSIFIER)
    save_checkpoint(tmp_path / "m.pt", {**want, "average.bias": np.ones(1, np.float32)})
    entries = {"dense.bias": "average.bias"}
    code, _, said = export(tmp_path / "m.pt", "classifier", CLASSIFIER, entries)
    assert code == 2 and "dense.bias: (1,), not part of this network" in said
    code, tensors, said = export(tmp_path / "m.pt", "classifier", CLASSIFIER, entries,
                                 "--allow-unused")
    assert code == 0 and tensors["dense.bias"] == 1 and "unused: dense.bias (1,)" in said


TENSORS = {key: np.ones(1) for key in ("a", "b", "x.0.w", "x.1.w", "c.w", "c.b")}
WANTED = ["A", "B", "L.0.w", "L.1.w", "M.0.1.w", "C.w", "C.b"]


def expand(entries):
    path = "map.json"
    rules = [mapping._rule(f"{path}: {key}: ", key, value)  # pylint: disable=protected-access
             for key, value in entries.items()]
    return mapping.expand(mapping.Map(path, rules), WANTED, Checkpoint("m.pt", TENSORS))


def test_the_particular_beats_the_general():
    found = expand({"L.{n}.w": "x.{n}.w", "L.1.w": "a", "C.*": "c.*", "C.b": "b"})
    assert {ours: source.keys for ours, source in found.items()} == {
        "L.0.w": ("x.0.w",), "L.1.w": ("a",), "C.w": ("c.w",), "C.b": ("b",)}


@pytest.mark.parametrize("entries, message", [
    ({"D": "a"}, "map.json: D: no tensor of this network"),
    ({"L.{n}.b": "a"}, "map.json: L.{n}.b: no tensor of this network"),
    ({"A": "z"}, "map.json: A: z: not in m.pt"),
    ({"M.{n}.{m}.w": "x.{m}.{n}.w"}, r"M.0.1.w: x.1.0.w: not in m.pt"),
    ({"M.{n}.{n}.w": "a"}, "no tensor of this network"),
    ({"A": "x.{n}.w"}, "map.json: A: placeholder {n} of x.{n}.w is not in our key"),
    ({"A": "x.*"}, r"A: the star of x.\* is not in our key"),
    ({"L.{n}.w": "x.{n}.w", "L.{m}.w": "x.{m}.w"}, r"L.0.w: named by L.{n}.w and by L.{m}.w"),
    ({"A": 1}, "A: expected a key, or an object"),
    ({"A": {}}, "A: expected a key, or an object"),
    ({"A": {"from": "a", "transposed": True}}, "A: expected a key, or an object"),
    ({"A": {"from": "a", "transpose": 1}}, "A: expected a key, or an object"),
    ({"A": {"from": []}}, "A: expected a key, or an object"),
    ({"A": {"from": ["a", 1], "join": 0}}, "A: expected a key, or an object"),
    ({"A": {"from": ["a", "b"]}}, "2 keys and join None, expected an axis"),
    ({"A": {"from": "a", "join": 0}}, "1 keys and join 0, expected an axis"),
    ({"A": {"from": ["a", "b"], "join": "0"}}, "join 0, expected an axis"),
    ({"A": {"from": ["a", "b"], "join": True}}, "join True, expected an axis"),
])
def test_bad_maps(entries, message):
    with pytest.raises(ConvertError, match=message.replace("{", r"\{")):
        expand(entries)


@pytest.mark.parametrize("text, message", [
    ("", "no JSON"), ("{", "no JSON"), ("[]", "expected an object"), ("{}", "expected an object"),
    ('{"a": "b", "a": "c"}', "'a' is there twice"), ("[" * 100_000, "nested too deeply"),
    (" " * (5 << 20), "expected a map")])
def test_files_that_are_no_maps(tmp_path, text, message):
    path = tmp_path / "map.json"
    path.write_text(text)
    with pytest.raises(ConvertError, match=message):
        mapping.read(str(path))


def test_joined_axis_that_is_not_there(tmp_path, export):
    want = weights("classifier", CLASSIFIER)
    save_checkpoint(tmp_path / "m.pt", want)
    code, _, said = export(tmp_path / "m.pt", "classifier", CLASSIFIER, {
        "dense.bias": {"from": ["dense.bias", "dense.bias"], "join": 7}})
    assert code == 2 and "dense.bias: dense.bias, dense.bias of shapes (1,), (1,) cannot" in said


def test_verify_takes_the_map_and_keeps_what_accompanies_the_weights(tmp_path, monkeypatch, capfd):
    """The engine's place is taken by PyTorch with the weights of the file."""
    from converters import verify
    from converters.reference.run import build, run
    tokens = ["[PAD]", "[UNK]", "[SEP]", "[CLS]", "a"]
    config = {"layers": 1, "d_model": 8, "heads": 2, "d_mlp": 8, "tokens": 5, "positions": 4}
    want = weights("bert", config)
    save_checkpoint(tmp_path / "m.pt", {"x." + key: x for key, x in want.items()})
    (tmp_path / "map.json").write_text('{"*": "x.*"}')
    (tmp_path / "config.json").write_text(json.dumps(config))
    (tmp_path / "vocab.txt").write_text("\n".join(tokens))
    file = str(tmp_path / "m.fb")
    given = ["--map", str(tmp_path / "map.json")]
    assert main(["export", str(tmp_path / "m.pt"), "--kind", "bert", "--config", str(
        tmp_path / "config.json"), "--vocabulary", str(tmp_path / "vocab.txt"), "-o", file,
        *given]) == 0

    ran_on = []

    def engine(_, path, inputs, isa):
        ran_on.append(isa)
        read = weights_file.read(path)
        tensors = {key: read.tensors[key] for key in [*want, "vocabulary"]}
        return run(build(read.networks[0], tensors), inputs, taps=True)

    monkeypatch.setattr(verify, "run_engine", engine)
    assert main(["verify", file, "--checkpoint", str(tmp_path / "m.pt"), *given]) == 0
    assert "hidden" in capfd.readouterr().out
    assert main(["verify", file, "--isas", "sse2,avx2"]) == 0
    assert ran_on == [None, "sse2", "avx2"]

    def poorer(*given):
        return {key: x for key, x in engine(*given).items() if key != "hidden"}

    monkeypatch.setattr(verify, "run_engine", poorer)
    assert main(["verify", file]) == 1
    assert "hidden: not among what infer-cli gave, expected (" in capfd.readouterr().out

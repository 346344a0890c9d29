"""Training from the command line: every kind learns, resumes bit by bit and is exported; what cannot
be is one line."""

import argparse
import csv
import json
import pathlib
import subprocess
import time

import numpy as np
import pytest
import training_data

from converters import weights_file
from converters.errors import ConvertError
from converters.training import tasks
from converters.training.__main__ import main

torch = pytest.importorskip("torch")

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONFIGS = ROOT / "converters" / "training" / "configs"
CLI = ROOT / "build" / "release" / "bin" / "infer-cli"


@pytest.fixture(name="data", scope="module")
def make_data(tmp_path_factory):
    return training_data.write(tmp_path_factory.mktemp("data"))


@pytest.fixture(name="texts", scope="module")
def make_texts(tmp_path_factory):
    return training_data.write_texts(tmp_path_factory.mktemp("texts"))


@pytest.fixture(name="train")
def make_train(tmp_path, data, texts, capfd):
    """Trains `configuration` in folder `name`; exit code, the folder, what was said."""
    def train(configuration, name, *options):
        path = tmp_path / f"{name}.json"
        path.write_text(json.dumps(configuration))
        where = texts if configuration.get("kind") in ("bert", "acts") else data
        code = main(["train", str(path), "--data", str(where), "-o", str(tmp_path / name),
                     *map(str, options)])
        return code, tmp_path / name, capfd.readouterr().err
    return train


def curves(folder):
    with open(folder / "curves.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("kind", tasks.TASKS)
def test_every_kind_is_trained_and_exported(train, kind):
    code, folder, said = train(training_data.configuration(kind, steps=40, dev_every=20), "run")
    assert code == 0, said
    rows = curves(folder)
    assert [row["step"] for row in rows] == ["20", "40"]
    assert float(rows[1]["train_loss"]) < float(rows[0]["train_loss"])
    file = weights_file.read(str(folder / "weights.fb"))
    assert file.provenance["trained"] and "self_test" in file.networks[0]
    state = torch.load(folder / "best.pt")
    for key, x in file.network_tensors(file.networks[0]).items():
        if key in state:
            np.testing.assert_array_equal(x, state[key].numpy())
    assert "<svg" in (folder / "curves.html").read_text()


@pytest.mark.parametrize("kind", ["zs_mstm1", "zs_mstm2", "model2", "bert"])
def test_a_resumed_run_is_the_uninterrupted_one(train, kind):
    configuration = training_data.configuration(kind)
    _, whole, _ = train(configuration, "whole")
    _, parts, said = train(configuration, "parts", "--minutes", 1e-9)
    assert len(curves(parts)) == 1 and "step 1/6" in said
    train(configuration, "parts", "--resume")
    a, b = (torch.load(folder / "checkpoint.pt")["task"] for folder in (whole, parts))
    for part in a:
        assert same(a[part], b[part]), part


def same(a, b):
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return torch.equal(a, b) if isinstance(a, torch.Tensor) else a == b


@pytest.mark.skipif(not CLI.is_file(), reason="infer-cli is not built")
@pytest.mark.parametrize("kind", ["zs_mstm1", "zs_mstm2", "model1", "model2", "acts"])
def test_the_engine_computes_what_was_trained(train, kind):
    """`infer-cli check` runs the self-test that the export wrote with PyTorch."""
    _, folder, _ = train(training_data.configuration(kind, steps=3), "run")
    done = subprocess.run([CLI, "check", folder / "weights.fb"], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("kind", ["zs_mstm1", "zs_mstm2"])
def test_the_probe_asks_a_run_for_its_style(train, data, kind):
    from converters.training.evidence import probe
    _, folder, _ = train(training_data.configuration(kind, steps=2, dev_every=2), "run")
    found = probe.evidence(folder, data, steps=40)
    assert 0 < found["error"] < 10 and found["segments"] == 18


def test_strange_voices_are_in_style_clips_while_training_and_nowhere_else(data):
    from converters.training import configuration
    task_class = tasks.of("zs_mstm1")
    opened = task_class.open_data(data)

    def batches(share, training=True):
        made = training_data.configuration("zs_mstm1", options={"style_segments": 2,
                                                                "strange_voices": share})
        task = task_class(configuration.check(made, "made"), opened, torch.device("cpu"))
        task.module.train(training)
        return task.batch(task.items[:8], np.random.default_rng(3))

    (segments, clips), (same, strange) = batches(0.0), batches(1.0)
    for name in segments:
        assert torch.equal(segments[name], same[name])
    assert torch.equal(clips["pose"], strange["pose"])
    for name in ("speech", "text"):  # the clips of the batch in another order
        rows, found = ({tuple(row) for row in x[name].flatten(0, 1).flatten(1).tolist()}
                       for x in (clips, strange))
        assert found == rows and not torch.equal(clips[name], strange[name])
    (_, clips), (_, strange) = batches(0.0, False), batches(1.0, False)
    assert all(torch.equal(clips[name], strange[name]) for name in clips)


def test_evidence_goes_through_a_sample_of_the_seen_styles(data):
    from converters.training.data.dataset import Dataset
    from converters.training.evidence import transfer

    class Speakers:
        """Eight seen speakers with an utterance each in split test."""
        def speakers(self, _split):
            return [f"s{n}" for n in range(8)]

        def select(self, _split):
            return [Dataset.open(data).utterances[0]] * 20

    found = list(transfer._pairs(Speakers(), "seen", 2, 3))
    assert [speaker for _, _, speaker in found] == ["s0", "s0", "s2", "s2", "s5", "s5"]
    assert len(list(transfer._pairs(Speakers(), "seen", 1, None))) == 8


@pytest.mark.parametrize("kind, streams", [("zs_mstm1", {"pose"}), ("zs_mstm2", {"pose", "face"})])
def test_a_style_of_the_evidence_is_made_of_what_the_network_takes(train, data, tmp_path, kind,
                                                                   streams):
    """The dialog acts are those of each segment of the clip, as `sampling` has them in training."""
    from converters.training.data import sampling
    from converters.training.evidence.material import Material
    _, folder, _ = train(training_data.configuration(kind, steps=1, dev_every=1), "run")
    found = Material(tmp_path, data, folder / "weights.fb", CLI, tmp_path / "work")
    record = weights_file.read(folder / "weights.fb").networks[0]
    network = record["name"]
    assert set(found.streams(network)) == streams
    with pytest.raises(ConvertError, match="no network other"):
        found.streams("other")
    utterance = found.data.select("train")[0]
    clip = found._clip(utterance, network)
    arrays = found.data.load(utterance)
    for stream in {"speech", "text"} | streams:
        np.testing.assert_array_equal(clip[f"style_{stream}"], arrays[stream])
    if "face" in streams:
        frames = record["config"]["core"]["frames"]
        segments = sampling.segments([utterance], frames)
        want = [arrays["tags"][first:first + frames].max(0) for _, first in segments]
        np.testing.assert_array_equal(clip["style_tags"], want)


def test_evidence_measures_motion_of_other_lengths(tmp_path):
    """The same style with other speech is compared while both speak; nothing else is cut."""
    from converters.training.evidence import transfer
    rng = np.random.default_rng(4)
    truth = rng.normal(size=(90, 22)).cumsum(0)
    poses = {"model": truth, "truth": truth, "shuffled audio": truth[:50]}
    assert transfer._timing(poses) == pytest.approx({"same speech": 1.0, "other speech": 1.0})
    joined = transfer._joined([{"pose": truth}, {"pose": truth[:7]}])["pose"]
    assert joined.shape == (97, 22)
    np.testing.assert_allclose(transfer._still(joined, 3), [joined.mean(0)] * 3, rtol=1e-6)


def test_expressions_are_told_from_turns_of_the_head():
    """A mouth that opens and brows that rise, by hand, in a face that nods: y of OpenPose's points."""
    from converters.kinds.zs_mstm2 import FACE_POINTS
    from converters.training.evidence import transfer
    points = [n for n, _ in FACE_POINTS]
    rest = np.array([place for _, place in FACE_POINTS], float)
    t = np.linspace(0, 6, 50)
    face = np.tile(rest.T.reshape(-1), (50, 1))
    y = face.reshape(50, 2, -1)[:, 1]
    y += 5 * np.sin(t)[:, None]
    y[:, points.index(8)] += np.cos(3 * t)
    y[:, [points.index(n) for n in (17, 19, 21, 22, 24, 26)]] -= 2 * np.cos(5 * t)[:, None]
    y[:, [points.index(n) for n in (41, 46)]] += np.cos(2 * t)[:, None]
    found = transfer._expressions(face)
    eyes = 0.5 * np.cos(2 * t)  # the lower lids take part in where the eyes are
    for name, want in (("jaw", np.cos(3 * t) - eyes), ("brows", 2 * np.cos(5 * t)),
                       ("lids", np.cos(2 * t)), ("nods", 5 * np.sin(t) + eyes)):
        np.testing.assert_allclose(found[name] - found[name][0], want - want[0], atol=1e-9)
    half = {name: x / 2 for name, x in found.items()}
    told = transfer._expressing({"model": half, "truth": found, "shuffled audio": {
        name: -x[:40] for name, x in found.items()}})
    for same, other, extent in told.values():
        assert (same, other, extent) == pytest.approx((1.0, -1.0, 0.5))


def test_the_demo_shows_a_calm_a_lively_and_an_expressive_speaker():
    from converters.training import recipe
    neutral = {"amplitude": 1.0, "velocity": 1.0, "frequency": 0.5, "arms": 0.0, "head": 1.0,
               "face": 1.0}
    styles = {f"s{n:02d}": {**neutral, "amplitude": 0.6 + 0.02 * n} for n in range(40)}
    styles["s10"] |= {"face": 1.4, "head": 1.4}
    styles["s11"] |= {"face": 1.5, "head": 1.5}
    styles["s39"] |= {"frequency": 1.0}
    found = recipe.shown_speakers(styles)
    assert found["calm"] == ("zs_mstm1", "s02") and found["lively"] == ("zs_mstm1", "s39")
    assert found["expressive"][0] == "zs_mstm2"


def test_the_recipe_trains_at_once_what_needs_nothing_of_each_other(tmp_path, monkeypatch):
    from converters.training import recipe
    log = []

    def step(_self, made, *arguments, **_):
        name = made.split("/")[0]
        log.append(f"{name} begins")
        time.sleep(0.05 if name in ("slow", "first") else 0)
        if name == "broken":
            raise ConvertError("broken")
        log.append(f"{name} ends")

    monkeypatch.setattr(recipe.Recipe, "_step", step)
    made = recipe.Recipe(argparse.Namespace(output=tmp_path, models=None, smoke=True, seed=1,
                                            resume=False, jobs=2))
    made.train([("slow", "c", 1, {}), ("first", "c", 1, {}), ("second", "c", 1, {"x": "first"})],
               tmp_path)
    assert log.index("first begins") < log.index("slow ends")
    assert log.index("first ends") < log.index("second begins")
    with pytest.raises(ConvertError, match="broken"):
        made.train([("broken", "c", 1, {}), ("after", "c", 1, {"x": "broken"})], tmp_path)
    assert "after begins" not in log


@pytest.mark.parametrize("changed", ["options.no_speech", "options.no_text", "options.no_attention",
                                     "network.config.conv_decoder"])
def test_parts_of_model2_are_taken_away(train, changed):
    """The ablations of 5.6.3, each by one field set otherwise: the loss is another one, the field is
    in the checkpoint, and weights that A would attend by stay zero."""
    value = "false" if "conv" in changed else "true"
    whole = train(training_data.configuration("model2"), "whole")[1]
    code, without, said = train(training_data.configuration("model2"), "without", "--set",
                                f"{changed}={value}")
    assert code == 0, said
    losses = [curves(folder)[-1]["dev_loss"] for folder in (whole, without)]
    assert losses[0] != losses[1]
    found = torch.load(without / "checkpoint.pt")["configuration"]
    for part in changed.split("."):
        found = found[part]
    assert found == json.loads(value)
    state = torch.load(without / "best.pt")
    asking = [bool(x.abs().max()) for key, x in state.items()
              if key.startswith("cross.layer.cross_attn.query")]
    assert asking == [changed != "options.no_attention"] * 2
    assert any("conv_decoder" in key for key in state) == ("conv" not in changed)


def test_statistics_travel_with_the_weights(train, data):
    from converters.training.data.dataset import Dataset
    _, folder, _ = train(training_data.configuration("zs_mstm1", steps=1), "run")
    network = weights_file.read(str(folder / "weights.fb")).networks[0]
    found = {n["stream"]: n for n in network["normalisations"]}
    opened = Dataset.open(data)
    pose = np.concatenate([opened.load(u)["pose"] for u in opened.select("train")])
    np.testing.assert_allclose(found["pose"]["mean"], pose.mean(0), rtol=1e-4)
    normalised = (pose - found["pose"]["mean"]) / (2 * np.array(found["pose"]["deviation"]))
    np.testing.assert_allclose(normalised.std(0), 0.5, rtol=1e-4)
    assert len(found["speech"]["mean"]) == 1 and found["speech"]["divisor"] == 2.0


def test_model1_begins_with_the_autoencoders(train):
    for name, values in (("ae_speech", "f0"), ("ae_face", "face")):
        train(training_data.configuration("autoencoder", options={"values": values}, steps=1), name)
    _, first, _ = train(training_data.configuration("model1", steps=1), "plain")
    runs = [f"--pretrained={name}={first.parent / name}" for name in ("ae_speech", "ae_face")]
    config = training_data.configuration("model1", steps=1, optimiser={"name": "rmsprop"},
                                         schedule={"name": "constant", "rate": 1e-12})
    config["network"] = {"config": {**config["network"]["config"], "hidden2": 2}}
    code, second, said = train(config, "pretrained", *runs)
    assert code == 0, said
    speech, face, both = (torch.load(folder / "best.pt") for folder in (
        first.parent / "ae_speech", first.parent / "ae_face", second))
    for theirs, ours in (("encoder.lstm2.weight_hh_l0", "e1_speech.lstm2.weight_hh_l0"),):
        torch.testing.assert_close(both[ours], speech[theirs])
    for n in range(2):  # D_face takes 4 * hidden2 columns, as many as AE_face's has
        torch.testing.assert_close(both[f"d_face.{n}.lstm1.weight_ih_l0"],
                                   face["decoder.lstm1.weight_ih_l0"])


def test_zs_mstm_begins_with_a_trained_one(train):
    """1.0 is continued as it is; in 2.0 whatever 1.0 has begins as there, in both decoders, and what
    only 2.0 has stays as PyTorch draws it."""
    def run(kind, name, *options, **changes):
        code, folder, said = train(training_data.configuration(
            kind, steps=1, schedule={"name": "constant", "rate": 1e-12}, **changes), name, *options)
        assert code == 0, said
        return torch.load(folder / "best.pt"), folder

    core = training_data.configuration("zs_mstm2")["network"]["config"]["core"]
    core = {**core, "ast_content": {**core["ast_content"], "head": "LayerNormLinear"}}
    first, folder = run("zs_mstm1", "first", network={"config": core}, seed=3)
    begin = f"--pretrained=zs_mstm1={folder}"
    again, _ = run("zs_mstm1", "again", begin, network={"config": core})
    for key, x in first.items():
        torch.testing.assert_close(again[key], x)
    plain, _ = run("zs_mstm2", "plain")
    second, _ = run("zs_mstm2", "second", begin)
    columns = first["dense.weight"].shape[1]
    assert second["pose_generator.dense.weight"].shape[1] > columns
    for stream in ("pose", "face"):
        for key, x in first.items():
            if key.startswith("decoder."):
                torch.testing.assert_close(second[f"{stream}_generator.{key}"], x)
        dense = second[f"{stream}_generator.dense.weight"]
        torch.testing.assert_close(dense[:, :columns], first["dense.weight"])
        torch.testing.assert_close(dense[:, columns:],
                                   plain[f"{stream}_generator.dense.weight"][:, columns:])
    for key in ("pose_lstm.weight_ih_l0", "style_attention.in_proj_weight"):
        torch.testing.assert_close(second[key], first[key])
    for key in ("face_lstm.weight_ih_l0", "face_generator.head.weight"):
        torch.testing.assert_close(second[key], plain[key])
    for name, fault in (("zs_mstm", "zs_mstm, kind zs_mstm2 takes zs_mstm1"),
                        ("zs_mstm1", "no tensor has the shape of one here")):
        torch.save({"dense.weight": torch.zeros(3, 5)}, folder / "best.pt")
        code, _, said = train(training_data.configuration("zs_mstm2"), "fault",
                              f"--pretrained={name}={folder}")
        assert code == 2 and fault in said and said.count("\n") == 1


@pytest.mark.parametrize("changes, message", [
    ({"kind": "zs"}, 'kind: "zs", expected one of acts, '),
    ({"batch": 0}, "batch: 0, expected a whole number of at least 1"),
    ({"epochs": 3}, "expected either epochs or steps"),
    ({"colour": 1}, '"colour" is no field'),
    ({"options": {"velocity": "much"}}, 'options: velocity: "much", expected a number'),
    ({"options": {"speed": 1}}, '"speed" is no field'),
    ({"optimiser": {"name": "sgd"}}, "optimiser: name 'sgd', expected one of adam"),
    ({"optimiser": {"name": "adam", "beta": 1}}, "optimiser: "),
    ({"schedule": {"name": "warmup", "rate": 1}}, "schedule: missing 1 required"),
    ({"schedule": {"name": "constant", "rate": 0}}, "a rate of 0 at the first step"),
    ({"provenance": {"author": "x"}}, "is no field"),
    ({"network": {"config": {"d_model": 7}}}, "decoder_heads: 2, expected a divisor"),
    ({"network": {"config": {"d_modle": 7}}}, "d_modle"),
    ({"seed": -1}, "seed: -1"),
    ({"clip": -1}, "clip: -1"),
])
def test_what_cannot_be_is_one_line(train, changes, message):
    code, folder, said = train({**training_data.configuration("zs_mstm1"), **changes}, "run")
    assert code == 2 and message in said and said.count("\n") == 1, said
    assert not (folder / "weights.fb").exists()


def test_faults_of_the_command_line(train, tmp_path, capfd):
    good = training_data.configuration("zs_mstm1")
    for options, message in ((["--device", "cuda:77"], "--device: cuda:77: "),
                             (["--minutes", "-1"], "--minutes: -1.0"),
                             (["--pretrained", "x"], "expected NAME=RUN"),
                             (["--pretrained", "zs_mstm1=/nowhere"], "/nowhere/best.pt: no such"),
                             (["--set", "steps"], "--set: steps, expected FIELD=JSON"),
                             (["--set", "steps.most=1"], "steps.most=1: steps is no object"),
                             (["--set", "steps=many"], "--set: steps: no JSON"),
                             (["--set", "steps=0"], "steps: 0, expected a whole number")):
        code, _, said = train(good, "run", *options)
        assert code == 2 and message in said and said.count("\n") == 1, said
    assert main(["train", str(CONFIGS / "zs_mstm1.json"), "--data", str(tmp_path), "-o",
                 str(tmp_path)]) == 2
    assert "dataset.json: missing" in capfd.readouterr().err
    train(good, "run")
    code, _, said = train({**good, "seed": 2}, "run", "--resume")
    assert code == 2 and "of another configuration" in said


@pytest.mark.parametrize("path", sorted(CONFIGS.glob("*.json")), ids=lambda path: path.stem)
def test_configurations_of_the_repository_are_read(path):
    from converters.training import configuration
    assert configuration.read(path)["about"]

"""Intervals laid out as PATS has them, and ones made to do harm."""

import random

import numpy as np
import pytest

h5py = pytest.importorskip("h5py")

from converters import __main__ as cli, pats  # noqa: E402
from converters.errors import ConvertError  # noqa: E402

FRAMES, ROWS = 150, 862  # 10 s of 44.1 kHz: 86.13 rows a second


def arrays(frames=FRAMES, rows=ROWS, seed=0):
    rng = np.random.default_rng(seed)
    confidence = np.repeat(rng.uniform(0.1, 1, (frames, 52))[:, None], 2, 1).reshape(frames, 104)
    return {"audio/log_mel_512": rng.normal(-5, 3, (rows, 128)),
            "audio/log_mel_400": rng.normal(-5, 3, (rows, 64)),
            "text/bert": rng.normal(0, 1, (frames, 768)),
            "text/tokens": rng.integers(0, 30522, frames),
            "pose/data": rng.normal(0, 100, (frames, 104)),
            "pose/normalize": rng.normal(0, 100, (frames, 104)),
            "pose/confidence": confidence}


def write(path, found):
    with h5py.File(path, "w") as file:
        for name, x in found.items():
            file.create_dataset(name, data=x)
        # As pandas writes text/meta: Python objects in pickles.
        words = file["text"].create_group("meta").create_dataset(
            "block0_values", (1,), dtype=h5py.vlen_dtype(np.uint8))
        words[0] = np.frombuffer(b"\x80\x04cos\nsystem\n(S'true'\ntR.", np.uint8)
    return str(path)


@pytest.fixture
def interval(tmp_path):
    return write(tmp_path / "interval.h5", arrays())


def test_arrays(interval):
    found = arrays()
    for source in ("normalize", "data"):
        got, notes = pats.convert([interval], (3, 0, 10), source)
        assert {name: x.shape for name, x in got.items()} == {
            "speech": (150, 128), "text": (150, 768), "pose": (150, 6)}
        assert all(x.dtype == np.float32 for x in got.values())
        want = found["pose/" + source].reshape(150, 2, 52)[:, :, [3, 0, 10]].reshape(150, 6)
        assert np.array_equal(got["pose"], want.astype(np.float32))
        assert np.array_equal(got["text"], found["text/bert"].astype(np.float32))
    assert notes == [f"{interval}: the stride of 6 rows runs past the speech: its last row stands "
                     "for the last 5 of 150 frames (--align time keeps time)"]


def loader_rows(rows, frames):
    """As PATS' loader cuts them: non-overlapping windows, then every sixth row."""
    picked = [np.arange(rows)[begin:begin + 382][::6] for begin in range(0, rows, 382)]
    assert all(len(x) == 64 for x in picked[:-1])
    return np.concatenate(picked)[:frames]


def test_speech_is_that_of_the_loader(interval):
    got, _ = pats.convert([interval])
    index = loader_rows(ROWS, FRAMES)
    want = arrays()["audio/log_mel_512"].astype(np.float32)
    assert len(index) == 145 and np.array_equal(got["speech"][:145], want[index])
    assert np.array_equal(got["speech"][145:], want[[ROWS - 1] * 5])
    got, notes = pats.convert([interval], align="time")
    assert not notes
    at = np.floor(np.arange(FRAMES) / FRAMES * ROWS + 1e-9).astype(int)
    assert np.array_equal(got["speech"], want[at])


def test_intervals_follow_each_other(tmp_path, interval):
    short = arrays(70, 440, 1)
    short["text/bert"] = short["text/bert"][:68]
    short["pose/confidence"][5, 2] = 0
    second = write(tmp_path / "second.h5", short)
    got, notes = pats.convert([interval, second])
    assert got["pose"].shape == (218, 22) and got["speech"].shape == (218, 128)
    assert np.array_equal(got["text"][150:], short["text/bert"].astype(np.float32))
    assert notes[1:] == [
        f"{second}: 70 frames of pose, 68 of text: the first 68 are taken",
        f"{second}: OpenPose missed a joint in 1 of 68 frames; what PATS put there is taken"]


def test_command(interval, tmp_path, capsys):
    output = str(tmp_path / "clip.npz")
    assert cli.main(["pats", interval, "-o", output, "--joints", "0-2,4"]) == 0
    assert "pose: (150, 8) float32" in capsys.readouterr().out
    with np.load(output) as clip:
        assert sorted(clip) == ["pose", "speech", "text"]
    assert cli.main(["pats", interval, "-o", output, "--joints", "0-60"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("converters: --joints: '0-60'") and error.count("\n") == 1


@pytest.mark.parametrize("text", ["", "1,", "a", "-1", "5-52", "1,1", "3-1", "\u0661", "1" * 90])
def test_joints_that_are_none(text):
    with pytest.raises(ConvertError, match="--joints"):
        pats.parse_joints(text)


def replaced(name, x):
    def change(file, _):
        del file[name]
        file.create_dataset(name, data=x)
    return change


def external_link(file, other):
    del file["pose/normalize"]
    file["pose"]["normalize"] = h5py.ExternalLink(str(other), "pose/normalize")


def soft_link(file, _):
    del file["text/bert"]
    file["text"]["bert"] = h5py.SoftLink("/pose/data")


def soft_group(file, _):
    del file["text"]
    file["text"] = h5py.SoftLink("/pose")


def virtual(file, other):
    del file["text/bert"]
    layout = h5py.VirtualLayout(shape=(FRAMES, 768), dtype="f8")
    layout[:] = h5py.VirtualSource(str(other), "text/bert", shape=(FRAMES, 768))
    file.create_virtual_dataset("text/bert", layout)


def huge(file, _):
    del file["text/bert"]
    file.create_dataset("text/bert", shape=(1 << 40, 768), dtype="f8", chunks=(64, 768))


def bomb(file, _):
    del file["text/bert"]
    file.create_dataset("text/bert", data=np.zeros((1 << 14, 768)), compression="gzip",
                        chunks=(256, 768))


def own_filter(file, _):
    del file["text/bert"]
    file.create_dataset("text/bert", data=np.zeros((FRAMES, 768)), compression="lzf",
                        chunks=(FRAMES, 768))


def objects(file, _):
    del file["text/bert"]
    file.create_dataset("text/bert", (FRAMES, 768), dtype=h5py.special_dtype(vlen=bytes))


def group_for_data(file, _):
    del file["text/bert"]
    file.create_group("text/bert")


def missing(file, _):
    del file["pose/normalize"]


def missing_group(file, _):
    del file["pose"]


def not_finite(value):
    x = np.zeros((FRAMES, 104))
    x[7, 9] = value
    return replaced("pose/normalize", x)


HOSTILE = [
    (external_link, "pose/normalize: an external link"), (soft_link, "text/bert: a soft link"),
    (soft_group, "text: a soft link"), (virtual, "text/bert: its numbers stand in other files"),
    (huge, "more than a file"), (bomb, "more than a file"), (own_filter, "filters other than"),
    (objects, "expected numbers"), (group_for_data, "a Group, expected a Dataset"),
    (missing, "pose/normalize: missing"), (missing_group, "pose: missing"),
    (replaced("text/bert", np.zeros((FRAMES, 767))), r"shape \(150, 767\), expected \(frames, 768\)"),
    (replaced("text/bert", np.zeros(768)), r"shape \(768,\), expected \(frames, 768\)"),
    (replaced("text/bert", np.zeros((0, 768))), "can hold|expected"),
    (replaced("text/bert", np.zeros((FRAMES, 768), "c8")), "expected numbers"),
    (replaced("audio/log_mel_512", np.zeros((300, 128))), "300 rows for 150 frames"),
    (replaced("audio/log_mel_512", np.zeros((1600, 128))), "1600 rows for 150 frames"),
    (not_finite(np.nan), "pose/normalize: no finite number at row 7, column 9"),
    (not_finite(1e300), "pose/normalize: no finite number at row 7, column 9"),
]


@pytest.mark.parametrize("change, message", HOSTILE)
def test_hostile(interval, tmp_path, change, message):
    other = write(tmp_path / "secret.h5", arrays(seed=3))
    with h5py.File(interval, "a") as file:
        change(file, other)
    with pytest.raises(ConvertError, match=message) as caught:
        pats.convert([interval])
    assert "\n" not in str(caught.value) and str(caught.value).startswith(interval)


def test_no_hdf5(tmp_path):
    path = tmp_path / "x.h5"
    for content in (b"", b"\x89HDF\r\n\x1a\n", b"PK\x03\x04", bytes(4096)):
        path.write_bytes(content)
        with pytest.raises(ConvertError, match="HDF5 is damaged"):
            pats.convert([str(path)])


def test_damaged_bytes(tmp_path):
    """Seeded damage to the structure: refused in a sentence, or arrays of the right widths."""
    path = tmp_path / "damaged.h5"
    write(path, arrays(2, 12))
    good, source = path.read_bytes(), random.Random(20232)
    accepted = 0
    for n in range(120):
        data = bytearray(good)
        for _ in range(1 if n % 2 else 8):
            data[source.randrange(8, 4096 if n % 3 else len(data))] = source.randrange(256)
        path.write_bytes(data if n % 5 else data[:source.randrange(8, len(data))])
        try:
            got, _ = pats.convert([str(path)])
        except ConvertError as error:
            assert "\n" not in str(error)
            continue
        accepted += 1
        assert got["pose"].shape[1] == 22 and np.isfinite(got["pose"]).all()
    assert 0 < accepted < 120

"""Checkpoints made to do harm: refused with a sentence, and the canary never sings."""

import os
import pickle
import struct
import zipfile
import zlib

import pytest

from converters.__main__ import main
from converters.checkpoint import read_checkpoint
from converters.errors import ConvertError


def archive(path, data, members=None, compression=zipfile.ZIP_STORED):
    with zipfile.ZipFile(path, "w", compression) as file:
        file.writestr("archive/data.pkl", data)
        for name, content in (members or {}).items():
            file.writestr(name, content)
    return str(path)


def text(value):
    data = value.encode()
    return b"X" + struct.pack("<I", len(data)) + data


def number(value):
    return b"\x8a\x08" + struct.pack("<q", value)


def storage(kind="FloatStorage", key="0", length=4):
    return (b"(" + text("storage") + b"ctorch\n" + kind.encode() + b"\n" + text(key)
            + text("cpu") + number(length) + b"tQ")


def tensor(source=None, offset=0, size=(4,), stride=(1,)):
    def numbers(values):
        return b"(" + b"".join(map(number, values)) + b"t"
    return (b"ctorch._utils\n_rebuild_tensor_v2\n(" + (storage() if source is None else source)
            + number(offset) + numbers(size) + numbers(stride) + b"\x89}tR")


def one_tensor(**options):
    return b"\x80\x02}" + text("x") + tensor(**options) + b"s."


FOUR = {"archive/data/0": struct.pack("<4f", 1, 2, 3, 4)}


def test_the_hand_made_checkpoint_is_read(tmp_path):
    """What the others spoil is in order."""
    path = archive(tmp_path / "x.pt", one_tensor(), FOUR)
    assert read_checkpoint(path).tensors["x"].tolist() == [1, 2, 3, 4]


class System:
    def __init__(self, command):
        self.command = command

    def __reduce__(self):
        return os.system, (self.command,)


def programs(canary):
    """Pickles that would create `canary` if they ran."""
    touch = f"touch {canary}"
    call = text("os") + text("system") + b"\x93" + text(touch) + b"\x85R."
    yield "reduce", pickle.dumps(System(touch), 2)
    yield "reduce_protocol_4", pickle.dumps(System(touch), 4)
    yield "reduce_protocol_5", pickle.dumps({"state_dict": System(touch)}, 5)
    yield "stack_global", b"\x80\x04" + call
    yield "global_posix", b"cposix\nsystem\n" + text(touch) + b"\x85R."
    yield "inst", b"(S'" + touch.encode() + b"'\nios\nsystem\n."
    yield "obj", b"(cos\nsystem\n" + text(touch) + b"o."
    yield "newobj", b"\x80\x02csubprocess\nPopen\n" + text(touch) + b"\x85\x81."
    yield "eval", b"cbuiltins\neval\n" + text(f"open({str(canary)!r},'w')") + b"\x85R."
    yield "getattr", (b"cbuiltins\ngetattr\n(" + b"ctorch\nFloatStorage\n" + text("__class__")
                      + b"tR.")
    yield "dotted", b"\x80\x04" + text("torch._utils") + text("_rebuild_tensor_v2.__globals__") \
        + b"\x93."
    yield "torch_load", b"ctorch.serialization\nload\n" + text("archive/inner.pt") + b"\x85R."
    yield "torch_jit", b"ctorch.jit\nload\n" + text("inner.pt") + b"\x85R."
    yield "numpy", b"cnumpy.core.multiarray\n_reconstruct\n)R."
    yield "build", (b"\x80\x02ccollections\nOrderedDict\n)R}" + text("items") + b"cos\nsystem\nsb.")
    yield "extension", b"\x80\x02\x82\x01."
    yield "after_tensor", one_tensor()[:-1] + b"0" + call
    yield "call_storage", b"ctorch\nFloatStorage\n" + text(touch) + b"\x85R."
    yield "newobj_constructor", (b"\x80\x02ctorch._utils\n_rebuild_parameter\n" + text(touch)
                                 + b"\x85\x81.")
    yield "persistent_global", b"(" + text("module") + text("os") + text("system") + b"tQ."


@pytest.mark.parametrize("name", [name for name, _ in programs("x")])
def test_programs_do_not_run(tmp_path, name):
    canary = tmp_path / "canary"
    path = archive(tmp_path / "x.pt", dict(programs(canary))[name], FOUR)
    with pytest.raises(ConvertError):
        read_checkpoint(path)
    assert not canary.exists()


HUGE = 1 << 40
MALFORMED = {
    "offset_outside": (one_tensor(offset=1), FOUR, "does not fit"),
    "offset_negative": (one_tensor(offset=-1), FOUR, "unknown way"),
    "stride_outside": (one_tensor(size=(2, 2), stride=(3, 1)), FOUR, "does not fit"),
    "stride_negative": (one_tensor(offset=3, stride=(-1,)), FOUR, "unknown way"),
    "stride_zero": (one_tensor(size=(HUGE,), stride=(0,)), FOUR, "does not fit"),
    "size_negative": (one_tensor(size=(-4,)), FOUR, "unknown way"),
    "size_wraps": (one_tensor(size=(1 << 32, 1 << 32), stride=(1 << 32, 1)), FOUR, "does not fit"),
    "rank": (one_tensor(size=(1,) * 40, stride=(1,) * 40), FOUR, "unknown way"),
    "rank_differs": (one_tensor(size=(2, 2), stride=(1,)), FOUR, "unknown way"),
    "storage_claims_more": (one_tensor(source=storage(length=5)), FOUR, "expected 5 elements"),
    "storage_huge": (one_tensor(source=storage(length=HUGE)), FOUR, "elements of Float"),
    "storage_missing": (one_tensor(source=storage(key="1")), FOUR, "is missing"),
    "storage_elsewhere": (one_tensor(source=storage(key="../../etc/passwd")), FOUR, "is missing"),
    "storage_is_text": (one_tensor(source=text("0")), FOUR, "unknown way"),
    "storage_type_text": (one_tensor(source=b"(" + text("storage") + text("f") + text("0")
                                     + text("cpu") + number(4) + b"tQ"), FOUR, "unknown way"),
    "no_stop": (one_tensor()[:-1], FOUR, "damaged"),
    "unknown_opcode": (b"\x80\x02\xff.", FOUR, "damaged"),
    "bad_protocol": (b"\x80\xf0.", FOUR, "damaged"),
    "memo_missing": (b"j\xff\xff\xff\x7f.", FOUR, "damaged"),
    "memo_huge": (b"Nr\xff\xff\xff\x7f.", FOUR, "NoneType"),
    "long_text": (b"\x8d" + struct.pack("<Q", HUGE) + b"x.", FOUR, "damaged"),
    "recursive": (b"\x80\x02}q\x00" + text("x") + b"h\x00s.", FOUR, "nested"),
    "laughs": (b"\x80\x02]q\x000" + b"".join(
        b"](h" + bytes([n]) + b"h" + bytes([n]) + b"eq" + bytes([n + 1]) + b"0"
        for n in range(12)) + b"}" + text("x") + b"h\x0cs" + text("y") + b"h\x0cs" + b"".join(
        text(str(i)) + b"h\x0cs" for i in range(300)) + b".", FOUR, "nested"),
    "big_endian": (one_tensor(), {**FOUR, "archive/byteorder": b"big"}, "big-endian"),
    "two_pickles": (one_tensor(), {**FOUR, "other/data.pkl": one_tensor()}, "2 members data.pkl"),
}


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed(tmp_path, name):
    data, members, message = MALFORMED[name]
    with pytest.raises(ConvertError, match=message):
        read_checkpoint(archive(tmp_path / "x.pt", data, members))


def test_compressed_members(tmp_path):
    path = archive(tmp_path / "x.pt", one_tensor(), {"archive/data/0": bytes(1 << 20)},
                   zipfile.ZIP_DEFLATED)
    with pytest.raises(ConvertError, match="compressed"):
        read_checkpoint(path)


def test_member_twice(tmp_path):
    with pytest.warns(UserWarning):
        path = archive(tmp_path / "x.pt", one_tensor(), FOUR)
        with zipfile.ZipFile(path, "a") as file:
            file.writestr("archive/data/0", bytes(16))
    with pytest.raises(ConvertError, match="is there twice"):
        read_checkpoint(path)


def test_archive_inside_archive(tmp_path):
    inner = archive(tmp_path / "inner.pt", one_tensor(), FOUR)
    with zipfile.ZipFile(tmp_path / "x.pt", "w") as file:
        file.write(inner, "archive/inner.pt")
    with pytest.raises(ConvertError, match="0 members data.pkl"):
        read_checkpoint(str(tmp_path / "x.pt"))


def test_sizes_that_lie(tmp_path):
    """The central directory claims more for a member than the file has."""
    path = tmp_path / "x.pt"
    archive(path, one_tensor(source=storage(length=1 << 20)), FOUR)
    data = bytearray(path.read_bytes())
    entry = data.rindex(b"PK\x01\x02")  # the storage is the last member
    data[entry + 20:entry + 28] = struct.pack("<II", 1 << 22, 1 << 22)
    path.write_bytes(data)
    with pytest.raises(ConvertError, match="more than the file has"):
        read_checkpoint(str(path))


def test_every_flipped_byte_is_refused_or_harmless(tmp_path):
    path = tmp_path / "x.pt"
    archive(path, one_tensor(), FOUR)
    good = path.read_bytes()
    for position in range(len(good)):
        path.write_bytes(good[:position] + bytes([good[position] ^ 0x55]) + good[position + 1:])
        try:
            got = read_checkpoint(str(path)).tensors
        except ConvertError:
            continue
        assert all(x.nbytes <= 64 for x in got.values())


def test_flipped_bytes_with_a_right_checksum(tmp_path):
    """The zip's CRC repaired: each byte of the pickle at two other values."""
    good = one_tensor()
    for position in range(len(good)):
        for flip in (0x01, 0x80):
            data = good[:position] + bytes([good[position] ^ flip]) + good[position + 1:]
            assert zlib.crc32(data) != zlib.crc32(good)
            try:
                got = read_checkpoint(archive(tmp_path / "x.pt", data, FOUR)).tensors
            except ConvertError:
                continue
            assert all(x.nbytes <= 64 for x in got.values())


def test_the_command_line_says_it_in_one_line(tmp_path, capfd):
    program = b"\x80\x04" + text("evil\x1b[31m\nline") + text("f") + b"\x93."
    path = archive(tmp_path / "x.pt", program, FOUR)
    assert main(["export", path, "-o", str(tmp_path / "x.fb")]) == 2
    error = capfd.readouterr().err
    assert error.count("\n") == 1 and "\x1b" not in error
    assert not (tmp_path / "x.fb").exists()

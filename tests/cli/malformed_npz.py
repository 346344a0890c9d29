"""The malformed .npz files of npz_test.py: (what is wrong, bytes, dtype to ask for)."""

import struct

from zip_maker import Entry, archive, npy, npz

GOOD = npy()


def headers():
    """Members whose .npy header is wrong."""
    for what, member in {
            "wrong magic": npy(magic=b"\x94NUMPY"),
            "lower-case magic": npy(magic=b"\x93numpy"),
            "empty member": b"",
            "member of 5 bytes": GOOD[:5],
            "ends before the length": GOOD[:9],
            "ends inside the header": GOOD[:40],
            "version 0": npy(version=(0, 0)),
            "version 4": npy(version=(4, 0)),
            "version 1.1": npy(version=(1, 1)),
            "header longer than the file": npy(length=9999),
            "header of length 0": npy(length=0),
            "header above the limit": npy(header="{'descr': '<f4', 'fortran_order': False, "
                                          "'shape': (3, 4), }" + " " * 10000),
            "4 GiB header": npy(version=(2, 0), length=0xFFFFFFFF),
            "header cut short": npy(length=20),
    }.items():
        yield what, npz(member)
    for what, header in {
            "no dictionary": "('<f4', False, (3, 4))",
            "empty dictionary": "{}",
            "unclosed": "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), ",
            "no descr": "{'fortran_order': False, 'shape': (3, 4), }",
            "no fortran_order": "{'descr': '<f4', 'shape': (3, 4), }",
            "no shape": "{'descr': '<f4', 'fortran_order': False, }",
            "extra key": "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), 'x': 1}",
            "key twice": "{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, "
                         "'shape': (3, 4), }",
            "bare keys": "{descr: '<f4', fortran_order: False, shape: (3, 4), }",
            "text after": "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), } + {}",
            "no commas": "{'descr': '<f4' 'fortran_order': False 'shape': (3, 4)}",
            "double comma": "{'descr': '<f4',, 'fortran_order': False, 'shape': (3, 4)}",
            "leading comma": "{, 'descr': '<f4', 'fortran_order': False, 'shape': (3, 4)}",
            "equals signs": "{'descr'= '<f4', 'fortran_order'= False, 'shape'= (3, 4)}",
            "code": "__import__('os').system('true')",
            "NUL bytes": b"{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4)}\0\0",
            "escaped quote": "{'descr': '<f4\\'', 'fortran_order': False, 'shape': (3, 4)}",
            "not UTF-8": b"{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4)}\xff",
    }.items():
        yield what, npz(npy(header=header))


def dtypes():
    for descr in ("'|O'", "'|S4'", "'<U1'", "'<c8'", "'<c16'", "'|V4'", "'<M8[s]'", "'<m8'",
                  "'<f16'", "'<f3'", "'<i3'", "'<f'", "'<'", "''", "'float32'", "'|f4'", "'!f4'",
                  "'>>f4'", "'<f4 '", "[('a', '<f4')]", "('<f4', (2,))", "4", "None"):
        yield f"dtype {descr}", npz(npy(descr))


def shapes():
    for shape in ("[3, 4]", "(12)", "12", "(-3, -4)", "(3.0, 4)", "(3, 4", "3, 4)", "(3 4)",
                  "(,)", "(3,, 4)", "(None,)", "((3, 4),)", "(03, 4)", "(1_2,)", "(0xc,)",
                  "(+3, 4)", "('3', 4)", "(True, 12)", "(18446744073709551628,)",
                  "(4611686018427387907, 4)", "(4294967296, 4294967296)",
                  "(0, 4611686018427387904, 4611686018427387904)",
                  "(" + "1, " * 33 + "12)", "(1e1,)", "(4, 4)", "(3, 3)", "(4294967296, 4)"):
        yield f"shape {shape}", npz(npy(shape=shape))
    yield "L suffix in version 3", npz(npy(shape="(3L, 4L)", version=(3, 0)))
    for flag in ("0", "'True'", "true", "Falsey", "None", "Fals"):
        yield f"fortran_order {flag}", npz(npy(fortran=flag))
    yield "one byte short", npz(npy(data=bytes(47)))
    yield "one byte long", npz(npy(data=bytes(49)))
    yield "no elements", npz(npy(data=b""))


def values():
    """Elements that do not fit what they are converted to."""
    for what, descr, packed, dtype in (
            ("NaN", "'<f4'", struct.pack("<3f", 1, float("nan"), 1), "float32"),
            ("infinity", "'<f4'", struct.pack("<3f", 1, float("inf"), 1), "float32"),
            ("big-endian -infinity", "'>f4'", struct.pack(">3f", 1, float("-inf"), 1), "float32"),
            ("float16 infinity", "'<f2'", struct.pack("<3H", 0, 0x7C00, 0), "float32"),
            ("float16 NaN", "'<f2'", struct.pack("<3H", 0, 0xFE00, 0), "float32"),
            ("float64 above float32", "'<f8'", struct.pack("<3d", 1, 1e39, 1), "float32"),
            ("float64 half a unit above", "'<f8'",
             struct.pack("<3d", 1, float.fromhex("0x1.ffffffp127"), 1), "float32"),
            ("int64 above int32", "'<i8'", struct.pack("<3q", 1, 2**31, 1), "int32"),
            ("int64 below int32", "'<i8'", struct.pack("<3q", 1, -2**31 - 1, 1), "int32"),
            ("uint32 above int32", "'<u4'", struct.pack("<3I", 1, 2**31, 1), "int32"),
            ("uint64 that looks negative", "'<u8'", struct.pack("<3Q", 1, 2**64 - 1, 1), "int32"),
            ("a bool of 2", "'|b1'", b"\1\2\0", "int32"),
            ("integers for floats", "'<i4'", bytes(12), "float32"),
            ("floats for integers", "'<f4'", bytes(12), "int32"),
            ("bool for floats", "'|b1'", bytes(3), "float32")):
        yield what, npz(npy(descr, "(3,)", data=packed)), dtype


def containers():
    """Archives that lie, or are none."""
    good = npz(GOOD)
    x = dict(name="x.npy", data=GOOD)
    zip64 = struct.pack("<HHQQ", 1, 16, 2**40, 2**40)
    yield "empty file", b""
    yield "one byte", b"P"
    yield "only a signature", b"PK\x03\x04"
    yield "text", b"these are not numbers\n" * 20
    yield "gzip", b"\x1f\x8b\x08\0\0\0\0\0\0\3" + bytes(40)
    yield "PNG", b"\x89PNG\r\n\x1a\n" + bytes(40)
    yield "archive without members", archive([])
    yield "junk before", b"junk" + good
    yield "junk after", good + b"junk"
    yield "no end record", good[:-22]
    yield "half", good[:len(good) // 2]
    yield "bare .npy cut short", GOOD[:-1]
    yield "bare .npy with a tail", GOOD + b"\0"
    yield "other array", archive([Entry("y.npy", GOOD)])
    for what, end in {
            "two members declared": dict(count=2, count_here=2),
            "no members declared": dict(count=0, count_here=0),
            "65535 members declared": dict(count=65535, count_here=65535),
            "directory behind the end": dict(cd_offset=1 << 30),
            "directory too early": dict(cd_offset=7),
            "directory too long": dict(cd_size=1 << 30),
            "directory too short": dict(cd_size=10),
            "second disk": dict(disk=1, cd_disk=1),
            "wrong end signature": dict(signature=0x06054b51),
            "comment that is not there": dict(comment_length=500)}.items():
        yield what, archive([Entry(**x)], **end)
    for what, fields in {
            "wrong CRC": dict(crc=1),
            "too large when inflated": dict(method=8, usize=len(GOOD) + 1),
            "too small when inflated": dict(method=8, usize=len(GOOD) - 1),
            "stored sizes differ": dict(usize=len(GOOD) + 4),
            "packed size too large": dict(method=8, csize=1 << 20),
            "packed size too small": dict(method=8, csize=20),
            "encrypted": dict(flags=1),
            "bzip2": dict(method=12, packed=b"BZh9" + bytes(30)),
            "lzma": dict(method=14, packed=bytes(30)),
            "method 99": dict(method=99, packed=GOOD),
            "deflate of garbage": dict(method=8, packed=b"\xff" * 60),
            "deflate cut short": dict(method=8, packed=b"\x4b"),
            "zip64 sizes beyond the file": dict(csize=0xFFFFFFFF, usize=0xFFFFFFFF, extra=zip64),
            "zip64 sizes without extra": dict(csize=0xFFFFFFFF, usize=0xFFFFFFFF),
            "offset behind the end": dict(offset=1 << 30),
            "offset into the data": dict(offset=3),
            "local name differs": dict(local=dict(name=b"z.npy")),
            "local name is longer": dict(local=dict(name=b"xx.npy")),
            "local method differs": dict(local=dict(method=8)),
            "local CRC differs": dict(local=dict(crc=7)),
            "local size differs": dict(local=dict(csize=7, usize=7))}.items():
        yield what, archive([Entry(**x, **fields)])
    for name in (b"../x.npy", b"/x.npy", b"a//x.npy", b"a/../x.npy", b"./x.npy", b"a\\x.npy",
                 b"C:x.npy", b"x", b"x.txt", b".npy", b"x.npy.exe", b"x\n.npy", b"\x1b[2Jx.npy",
                 b"dir/", b"n" * 300 + b".npy"):
        yield f"member {name[:12]!r}", archive([Entry(**x), Entry(name, GOOD)])
    yield "same name twice", archive([Entry(**x), Entry(**x)])
    yield "two members on the same bytes", archive(
        [Entry(**x), Entry("y.npy", GOOD, offset=0, packed=b"", csize=len(GOOD),
                           local=dict(name=b"x.npy"))])


def bombs():
    zeros = npy("'<f4'", "(50000000,)", data=bytes(200_000_000))
    yield "1028 to 1", npz(zeros, method=8)
    yield "16 GiB declared in the header", npz(npy(shape="(4294967296,)"), method=8)
    size = 1 << 34
    zip64 = struct.pack("<HHQQ", 1, 16, size, 60)
    yield "16 GiB declared everywhere", npz(
        npy(shape=f"({size // 4},)"), method=8, packed=b"\x4b" * 60, csize=0xFFFFFFFF,
        usize=0xFFFFFFFF, extra=zip64)


def corpus():
    for make in (headers, dtypes, shapes, containers, bombs):
        for what, data in make():
            yield what, data, "float32"
    yield from values()

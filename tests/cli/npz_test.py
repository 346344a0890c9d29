"""The .npz reader and writer of infer-cli against numpy.

npz_test.py PROBE [unittest arguments]; PROBE is the program npz_probe.
"""

import io
import os
import resource
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import malformed_npz
import zip_maker

PROBE = os.path.abspath(sys.argv.pop(1))
SANITIZED = os.environ.get("GESTUS_SANITIZED") == "1"
SEED = 20240611


class PipeLike(io.RawIOBase):
    """A file that cannot seek: numpy then writes data descriptors behind the members."""

    def __init__(self):
        super().__init__()
        self.data = bytearray()

    def writable(self):
        return True

    def write(self, data):
        self.data += bytes(data)
        return len(data)


def limit_memory():
    # The address sanitizer reserves terabytes of addresses.
    if not SANITIZED:
        resource.setrlimit(resource.RLIMIT_AS, (512 << 20, 512 << 20))


def random_array(rng):
    descr = rng.choice(["<f4", ">f4", "<f2", ">f2", "<f8", ">f8", "i1", "<i2", ">i2", "<i4", ">i4",
                        "<i8", ">i8", "u1", "<u2", "<u4", ">u8", "?"])
    shape = tuple(int(n) for n in rng.integers(0 if rng.random() < 0.1 else 1, 7,
                                               rng.integers(0, 5)))
    kind = np.dtype(descr).kind
    if kind == "f":
        values = rng.standard_normal(shape) * 10.0 ** rng.integers(-8, 4)
        if rng.random() < 0.2:
            values = values * 2.0**-24  # denormal in float16
    else:
        high = {"b": 2}.get(kind, min(2**31 - 1, np.iinfo(descr).max if kind != "b" else 1))
        low = 0 if kind in "ub" else max(-2**31, np.iinfo(descr).min)
        values = rng.integers(low, high, shape)
    array = np.asarray(values).astype(descr)
    if rng.random() < 0.5:
        array = np.asfortranarray(array)
    return array, "float32" if kind == "f" else "int32"


class NpzTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def probe(self, lines):
        """Asks the reader; lines are (file, array, dtype, out)."""
        text = "".join("\t".join(line) + "\n" for line in lines)
        done = subprocess.run([PROBE], input=text.encode(), stdout=subprocess.PIPE, check=False,
                              preexec_fn=limit_memory, timeout=300)
        self.assertEqual(done.returncode, 0)
        answers = done.stdout.decode("utf-8", "replace").split("\n")[:-1]
        self.assertEqual(len(answers), len(lines))
        return answers

    def test_random_arrays_equal_numpy(self):
        rng = np.random.default_rng(SEED)
        lines, expected = [], []
        for i in range(1000):
            array, dtype = random_array(rng)
            path = self.path(f"{i}.npz")
            save = np.savez if i % 2 else np.savez_compressed
            if i % 3 == 0:
                pipe = PipeLike()
                save(pipe, x=array, other=np.zeros(2))
                with open(path, "wb") as file:
                    file.write(pipe.data)
            elif i % 7 == 0:
                path = self.path(f"{i}.npy")
                np.save(path, array)
            else:
                save(path, x=array)
            lines.append((path, "x", dtype, self.path(f"{i}.out.npz")))
            expected.append(array.astype(dtype))
        for line, want, answer in zip(lines, expected, self.probe(lines)):
            self.assertEqual(answer, "ok", line)
            with np.load(line[3]) as result:
                got = result["x"]
            self.assertEqual(got.dtype, want.dtype)
            self.assertEqual(got.shape, want.shape)
            self.assertEqual(got.tobytes(), want.tobytes(), line)

    def test_every_float16(self):
        finite = np.arange(65536, dtype=np.uint16).view(np.float16)
        finite = finite[np.isfinite(finite)]
        np.savez(self.path("half.npz"), x=finite)
        out = self.path("out.npz")
        self.assertEqual(self.probe([(self.path("half.npz"), "x", "float32", out)]), ["ok"])
        with np.load(out) as result:
            self.assertEqual(result["x"].tobytes(), finite.astype(np.float32).tobytes())

    def test_format_versions_and_spellings(self):
        array = np.arange(12, dtype="<f4").reshape(3, 4)
        data = array.tobytes()
        spellings = [
            zip_maker.npy(data=data),
            zip_maker.npy(data=data, version=(2, 0)),
            zip_maker.npy(data=data, version=(3, 0)),
            zip_maker.npy("'=f4'", data=data),
            zip_maker.npy("'f4'", data=data),
            zip_maker.npy('"<f4"', data=data),
            zip_maker.npy(shape="(3L, 4L)", data=data),
            zip_maker.npy(shape="( 3 ,4, )", data=data),
            zip_maker.npy(header="{'shape':(3,4),'fortran_order':False,'descr':'<f4'}", data=data),
            zip_maker.npy(header="  { 'fortran_order' : False ,\n 'shape':\t(3, 4),"
                          " 'descr': '<f4' , }   ", data=data),
        ]
        lines = []
        for i, member in enumerate(spellings):
            for method in (0, 8):
                path = self.path(f"{i}.{method}.npz")
                with open(path, "wb") as file:
                    file.write(zip_maker.npz(member, method=method))
                lines.append((path, "x", "float32", path + ".out"))
        for line, answer in zip(lines, self.probe(lines)):
            self.assertEqual(answer, "ok", line)
            with np.load(line[3]) as result:
                np.testing.assert_array_equal(result["x"], array)

    def test_writer_is_deterministic(self):
        np.savez(self.path("in.npz"), x=np.arange(6, dtype="f4").reshape(2, 3))
        outs = [self.path("a.npz"), self.path("b.npz")]
        self.probe([(self.path("in.npz"), "x", "float32", out) for out in outs])
        copies = []
        for out in outs:
            with open(out, "rb") as file:
                copies.append(file.read())
        self.assertEqual(copies[0], copies[1])

    def test_malformed_files_are_refused(self):
        lines, kinds = [], []
        for what, data, dtype in malformed_npz.corpus():
            path = self.path(f"{len(lines)}.npz")
            with open(path, "wb") as file:
                file.write(data)
            lines.append((path, "x", dtype, "-"))
            kinds.append(what)
        self.assertGreaterEqual(len(kinds), 80)
        for line, what, answer in zip(lines, kinds, self.probe(lines)):
            with self.subTest(what):
                self.assertTrue(answer.startswith("error: " + line[0] + ": "), answer)
                self.assertIn("expected", answer)

    def test_every_truncation_is_refused(self):
        for name, save in (("stored", np.savez), ("deflated", np.savez_compressed)):
            buffer = io.BytesIO()
            save(buffer, x=np.arange(5, dtype="f4"), y=np.ones(3))
            lines = []
            for size in range(len(buffer.getvalue())):
                path = self.path(f"{name}{size}.npz")
                with open(path, "wb") as file:
                    file.write(buffer.getvalue()[:size])
                lines.append((path, "x", "float32", "-"))
            for line, answer in zip(lines, self.probe(lines)):
                self.assertTrue(answer.startswith("error: "), line)

    def test_flipped_bits_never_change_values(self):
        array = np.arange(5, dtype="f4") + 1
        want = array.tobytes()
        buffer = io.BytesIO()
        np.savez(buffer, x=array)
        data = bytearray(buffer.getvalue())
        lines = []
        for bit in range(8 * len(data)):
            data[bit // 8] ^= 1 << bit % 8
            path = self.path(f"{bit}.npz")
            with open(path, "wb") as file:
                file.write(data)
            data[bit // 8] ^= 1 << bit % 8
            lines.append((path, "x", "float32", path + ".out"))
        accepted = 0
        for line, answer in zip(lines, self.probe(lines)):
            if answer == "ok":
                accepted += 1
                with np.load(line[3]) as result:
                    self.assertEqual(result["x"].tobytes(), want, line)
            else:
                self.assertTrue(answer.startswith("error: "), answer)
        # Only what says nothing about the data may change unnoticed: times, versions and
        # attributes, 34 of the zip's bytes.
        self.assertLessEqual(accepted, 8 * 34)

    def test_accepts_nothing_that_numpy_refuses(self):
        """Random edits of the header text."""
        rng = np.random.default_rng(SEED + 1)
        header = b"{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }"
        alphabet = b"{}()':, <>=|fiub0123456789LTrueFalse\"\\\n\t\0\xff"
        data = np.arange(12, dtype="<f4").tobytes()
        lines, members = [], []
        for i in range(4000):
            text = bytearray(header)
            for _ in range(rng.integers(1, 4)):
                at = int(rng.integers(0, len(text)))
                edit = rng.integers(0, 3)
                if edit != 1:
                    text.insert(at, alphabet[rng.integers(0, len(alphabet))])
                if edit != 0:
                    del text[at + (edit == 2)]
            members.append(zip_maker.npy(header=bytes(text), data=data))
            path = self.path(f"{i}.npz")
            with open(path, "wb") as file:
                file.write(zip_maker.npz(members[-1]))
            lines.append((path, "x", "float32", path + ".out"))
        accepted = 0
        for line, member, answer in zip(lines, members, self.probe(lines)):
            if answer != "ok":
                continue
            accepted += 1
            want = np.load(io.BytesIO(member), allow_pickle=False)
            with np.load(line[3]) as result:
                np.testing.assert_array_equal(result["x"], want.astype(np.float32), str(line))
        self.assertGreater(accepted, 50)


if __name__ == "__main__":
    unittest.main()

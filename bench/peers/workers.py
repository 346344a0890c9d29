"""Processes that keep one model loaded in one engine and run it when asked, one line for one line:

  (after the first run)   -> ready
  run N                   -> N times in nanoseconds, of the worker's own monotonic clock
  output PATH             -> written: the outputs of the last run, raw float32 values
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np

HERE = pathlib.Path(__file__).parent
NARROW = ("bf16", "int8")
TYPES = ("fp32", *NARROW)


class WorkerError(Exception):
    """A worker that did not answer, with its last words."""


class Engine:
    """How the worker of one engine is started, and what of it is the engine."""

    def __init__(self, name, title, files, libraries, command):
        self.name = name
        self.title = title
        self.files = files          # of a type: "ort.{}.onnx"
        self.libraries = libraries  # files that it maps and would ship
        self.command = command      # (folder, model, threads) -> arguments

    def model(self, folder, kind):
        """The model file of that type of number, or None."""
        path = folder / self.files.format(kind)
        return path if path.exists() else None


def engines(programs, node_modules):
    """name -> Engine; those that cannot run here are left out by whoever asks."""
    gestus = str(programs / "gestus_worker")
    node = shutil.which("node") or "node"
    return {engine.name: engine for engine in (
        Engine("gestus", "gestus", "gestus.{}.fb", r"/gestus_worker$",
               lambda folder, model, threads: [gestus, folder, model, threads]),
        Engine("ort", "ONNX Runtime", "ort.{}.onnx", r"onnxruntime",
               lambda folder, model, threads: [node, HERE / "ort_worker.js", node_modules, folder,
                                               model, threads]),
        Engine("torch", "PyTorch", "torch.{}.pt", r"/lib(torch|c10|shm)|torch/_C|dnnl|blas|/libgomp",
               lambda folder, model, threads: [sys.executable, HERE / "torch_worker.py", folder,
                                               model, threads]))}


def cores(count):
    """CPUs of `count` different cores, as far as there are."""
    usable, chosen, seen = sorted(os.sched_getaffinity(0)), [], set()
    for cpu in usable:
        path = pathlib.Path(f"/sys/devices/system/cpu/cpu{cpu}/topology/thread_siblings_list")
        core = path.read_text() if path.exists() else cpu
        if core not in seen:
            seen.add(core)
            chosen.append(cpu)
    return (chosen + [cpu for cpu in usable if cpu not in chosen])[:count]


class Pipe:
    """A process that answers lines, pinned to as many cores as it has threads."""

    def __init__(self, command, threads):
        self.errors = tempfile.TemporaryFile()
        environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "UV_THREADPOOL_SIZE": "1",
                       "OPENBLAS_NUM_THREADS": str(threads), "PYTHONDONTWRITEBYTECODE": "1"}
        cpus = cores(threads)
        self.started = time.monotonic()
        self.process = subprocess.Popen(
            [str(x) for x in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=self.errors, env=environment, text=True,
            preexec_fn=lambda: os.sched_setaffinity(0, cpus))

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            self.process.wait()
            self.errors.seek(0)
            said = self.errors.read().decode(errors="replace").strip().split("\n")[-1]
            raise WorkerError(f"{said or 'no word'} (exit {self.process.returncode})".replace("|", "/"))
        return line.rstrip("\n")

    def ask(self, request):
        try:
            self.process.stdin.write(request + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # the answer says why
        return self.answer()

    def close(self, kill=False):
        """Waits for the process to end, or ends it whatever it does."""
        if kill:
            self.process.kill()
        try:
            self.process.stdin.close()
        except BrokenPipeError:
            pass
        try:
            self.process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()
        self.errors.close()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()


class Worker(Pipe):
    """One model in one engine; `load_seconds` is from the start of the process to its first output."""

    def __init__(self, engine, folder, kind, threads):
        super().__init__(engine.command(folder, engine.model(folder, kind), threads), threads)
        self.engine, self.kind, self.threads = engine, kind, threads
        try:
            ready = self.answer()
            self.load_seconds = time.monotonic() - self.started
            if ready != "ready":
                raise WorkerError(f"said {ready!r}, expected 'ready'")
        except BaseException:
            self.close()
            raise

    def run(self, count):
        """Seconds of each of `count` runs."""
        return [int(x) * 1e-9 for x in self.ask(f"run {count}").split()]

    def output(self):
        with tempfile.NamedTemporaryFile() as file:
            self.ask(f"output {file.name}")
            return np.fromfile(file.name, np.float32)

    def peak_resident_bytes(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return 1024 * int(re.search(r"VmHWM:\s*(\d+) kB", status)[1])

    def library_bytes(self):
        """Of the engine's own files that the process has mapped, each once."""
        maps = pathlib.Path(f"/proc/{self.process.pid}/maps").read_text()
        paths = {os.path.realpath(line.split(None, 5)[5]) for line in maps.splitlines()
                 if len(line.split(None, 5)) == 6}
        return sum(_stripped_bytes(path) for path in paths if re.search(self.engine.libraries, path))


def _stripped_bytes(path):
    """Size without symbols, as it would ship."""
    with tempfile.TemporaryDirectory() as folder:
        copy = os.path.join(folder, "stripped")
        done = subprocess.run(["strip", "-o", copy, path], capture_output=True, check=False)
        return os.path.getsize(copy if done.returncode == 0 else path)


class Peak(Pipe):
    """One core's peak for each type of number, measured whenever it is asked for."""

    def __init__(self, programs):
        super().__init__([programs / "gestus_peak"], 1)
        self.isa, *names = self.answer().split()
        # Of the types that have products of their own; the others' peak is that of fp32.
        self.instructions = {kind: name for kind, name in zip(NARROW, names) if name != "-"}
        self.seen = []

    def gops(self):
        """Type -> 10^9 operations a second."""
        fp32, *narrow = map(float, self.ask("").split())
        self.seen.append({"fp32": fp32} | {kind: x or fp32 for kind, x in zip(NARROW, narrow)})
        return self.seen[-1]

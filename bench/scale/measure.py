"""Runs the programs of bench/scale and gives their numbers."""

import contextlib
import json
import os
import statistics
import subprocess
import sys
import time

PERIOD = 64 / 15  # seconds of a segment of ZS-MSTM 1.0
FRAME = 1 / 15  # seconds


def cold_start(programs, weights, residence, threads, starts):
    """Medians of the program's figures and of the seconds from its start to its first output."""
    found = []
    for _ in range(starts):
        begin = time.monotonic()
        said = json.loads(_run(programs / "gestus_cold_start", weights, residence, threads))
        said["start_ms"] = 1e3 * (time.monotonic() - begin) - said["second_run_ms"]
        found.append(said)
    return {key: statistics.median(said[key] for said in found) for key in found[0]}


def service_times(programs, zs_mstm, bert, agents, segments, workers):
    """Seconds of each segment, worker by worker, run without a pause."""
    return _times(programs / "gestus_agents", "busy", zs_mstm, bert, agents, segments, workers, 1)


def paced(programs, zs_mstm, bert, agents, seconds, workers, seed):
    """Seconds from arrival to completion of each segment, in real time."""
    segments = max(agents, int(agents * seconds / PERIOD))
    return _times(programs / "gestus_agents", "paced", zs_mstm, bert, agents, segments, workers,
                  seed)


def due(programs, weights, hop, count):
    """Seconds from the moment that each run was due to its end."""
    return _times(programs / "gestus_deadline", weights, 1e3 * hop, count)


def batches(programs, weights, threads, rounds):
    """B -> milliseconds of a segment in a batch of B."""
    return json.loads(_run(programs / "gestus_batch", weights, threads, rounds))


def offline(infer_cli, weights, inputs, output):
    """Seconds of the processor and of the clock that a whole file takes."""
    before, begin = os.times(), time.monotonic()
    _run(infer_cli, weights, inputs, "-o", output)
    after = os.times()
    return {"clock": time.monotonic() - begin,
            "cpu": (after.children_user - before.children_user
                    + after.children_system - before.children_system)}


@contextlib.contextmanager
def hogs(count):
    """Busy loops of ordinary priority beside what runs inside."""
    running = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for process in running:
            process.kill()
            process.wait()


def _times(*command):
    return [1e-3 * float(ms) for ms in _run(*command).split()]


def _run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{command[0]}: {done.stderr.strip() or done.returncode}")
    return done.stdout

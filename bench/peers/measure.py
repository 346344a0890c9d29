"""Runs one case in all engines in turns and says how long each took, against the machine's peak."""

import json
import time

import numpy as np

from .workers import Worker, WorkerError

# Largest difference from PyTorch in double that still counts as the same output, as a share of the
# largest value.  What differs by more gets no time.
LIMITS = {"fp32": 1e-4, "bf16": 0.03, "int8": 0.1}

BURST_SECONDS = 0.02   # of runs one after the other, for short ones
BURST_RUNS = 100       # at most
WARM_SECONDS = 0.3     # shorter runs follow one that does not count, after others had the caches
SETTLE_SECONDS = 0.03  # for threads of the one before that still spin

# Networks whose runs are long get fewer rounds and starts, so that all of them end in time.
ROUNDS_SECONDS = 75
LEAST_ROUNDS = 5
STARTS_SECONDS = 30


def call_seconds(folder, engine):
    """What a run of a model that computes nothing takes: the price of asking."""
    with Worker(engine, folder, "fp32", 1) as worker:
        worker.run(BURST_RUNS)
        return float(np.median(worker.run(BURST_RUNS)))


def jobs(folder, engines, types):
    """(engine, type) of every model file that the case has."""
    return [(engine, kind) for kind in types for engine in engines
            if engine.model(folder, kind) is not None]


def measure_case(folder, engines, types, threads, peak, rounds, starts):
    """Results of every job, dictionaries that page.py and chart.py read, and how many rounds there
    were.  `peak` is a Peak."""
    description = json.loads((folder / "case.json").read_text())
    expected = np.fromfile(folder / "expected.bin", np.float32)
    results = {job: _empty(folder, *job) for job in jobs(folder, engines, types)}
    workers = _start_all(folder, results, threads, starts)
    try:
        rounds = _rounds(workers, results, description["flops"], peak, rounds)
        for (job, count), worker in workers.items():
            _finish(results[job], count, worker, expected)
    finally:
        for worker in workers.values():
            worker.close()
    return list(results.values()), rounds


def _empty(folder, engine, kind):
    return {"engine": engine.name, "type": kind, "threads": {}, "error": 0.0, "load_seconds": [],
            "file_bytes": engine.model(folder, kind).stat().st_size}


def _start_all(folder, results, threads, starts):
    """(job, threads) -> Worker.  One thread is started several times, in turns, for the load time."""
    workers, begin = {}, time.monotonic()
    for number in range(starts):
        if number == 0 or time.monotonic() - begin < STARTS_SECONDS:
            for job, result in results.items():
                if _start(workers, folder, results, job, threads[0]):
                    result["load_seconds"].append(workers[job, threads[0]].load_seconds)
    for count in threads[1:]:
        for job in results:
            _start(workers, folder, results, job, count)
    return workers


def _start(workers, folder, results, job, count):
    """Whether that worker, in place of the one before it, could be started."""
    if (job, count) in workers:
        workers.pop((job, count)).close(kill=True)
    if "failed" not in results[job]:
        try:
            workers[job, count] = Worker(job[0], folder, job[1], count)
            return True
        except WorkerError as error:
            results[job]["failed"] = str(error)
    return False


def _rounds(workers, results, flops, peak, rounds):
    """Every worker once a round, each round beginning with another one; how many rounds."""
    alone = {}  # seconds of a run
    for key, worker in workers.items():
        results[key[0]]["threads"][key[1]] = {"seconds": [], "gflops": [], "share": [],
                                              "share_fp32": []}
        alone[key] = min(_asked(results[key[0]], worker, 2))
    keys = list(workers)
    rounds = min(rounds, max(LEAST_ROUNDS, int(ROUNDS_SECONDS / max(1e-9, _round_seconds(alone)))))
    for number in range(rounds):
        top = peak.gops()
        first = number % max(1, len(keys))
        for key in keys[first:] + keys[:first]:
            result = results[key[0]]
            time.sleep(SETTLE_SECONDS)
            if alone[key] < WARM_SECONDS:
                _asked(result, workers[key], 1)
            times = _asked(result, workers[key], _burst(alone[key]))
            measured = result["threads"][key[1]]
            measured["seconds"] += times
            measured["gflops"].append(flops / float(np.median(times)) * 1e-9)
            for name, kind in (("share", key[0][1]), ("share_fp32", "fp32")):
                measured[name].append(measured["gflops"][-1] / (top[kind] * key[1]))
    return rounds


def _round_seconds(alone):
    """About what a round takes when a run takes what `alone` says (infinite: it failed)."""
    return sum((x if x >= WARM_SECONDS else 2 * max(x, BURST_SECONDS)) + SETTLE_SECONDS
               for x in alone.values() if np.isfinite(x))


def _burst(seconds):
    """How many runs follow one another."""
    return max(1, min(BURST_RUNS, int(BURST_SECONDS / seconds)))


def _asked(result, worker, count):
    """The times of `count` runs; infinite ones, and a reason, once a worker does not answer."""
    if "failed" not in result:
        try:
            return worker.run(count)
        except WorkerError as error:
            result["failed"] = str(error)
    return [float("inf")] * count


def _finish(result, count, worker, expected):
    """What is known only after the runs; times of wrong outputs are thrown away."""
    if "failed" in result:
        result["threads"] = {}
        return
    error = _difference(worker.output(), expected)
    result["error"] = max(result["error"], error)
    if count == 1 or "resident_bytes" not in result:
        result["resident_bytes"] = worker.peak_resident_bytes()
        result["library_bytes"] = worker.library_bytes()
    if not error <= LIMITS[result["type"]]:
        result["failed"] = f"output differs by {error:.1e}, more than {LIMITS[result['type']]:.0e}"
        result["threads"] = {}


def _difference(output, expected):
    """Largest difference over the largest value; infinity where something is missing."""
    if output.size != expected.size or not np.isfinite(output).all():
        return float("inf")
    return float(np.abs(output - expected).max() / np.abs(expected).max())


def summary(result, threads):
    """median and p99 seconds, GFLOP/s and shares of the type's peak and of fp32's with that many
    threads, or None."""
    measured = result["threads"].get(threads)
    if not measured or "failed" in result:
        return None
    return {"median": float(np.median(measured["seconds"])),
            "p99": float(np.quantile(measured["seconds"], 0.99, method="higher")),
            **{name: float(np.median(measured[name])) for name in ("gflops", "share", "share_fp32")}}

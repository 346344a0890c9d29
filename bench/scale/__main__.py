"""Memory and cold starts, agents in a process, deadlines beside other programs, batches, and long
files: python3 -m bench.scale, or ./run agents.  Writes docs/performance-scale.md."""

import argparse
import datetime
import json
import os
import pathlib

from bench.peers import machine

from . import line, measure, page, weights

ROOT = pathlib.Path(__file__).resolve().parents[2]
PARTS = ("start", "agents", "deadline", "batch", "offline")
GROWING = (10, 25, 50, 75, 100, 125, 150, 175, 200)


def main(arguments=None):
    options = _parser().parse_args(arguments)
    path = options.folder / "results.json"
    results = json.loads(path.read_text()) if path.exists() else {}
    options.folder.mkdir(parents=True, exist_ok=True)
    for part in options.parts:
        print(f"==> {part}", flush=True)
        before = machine.busy_share()
        found = globals()[f"_{part}"](options)
        results[part] = {"date": f"{datetime.date.today()}", "found": found,
                         "busy": max(before, machine.busy_share())}
        results["machine"] = machine.describe()
        path.write_text(json.dumps(results))
        options.page.write_text(page.render(results))
    print(f"==> wrote {options.page}")


def _parser():
    parser = argparse.ArgumentParser(prog="./run agents", description=__doc__)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS, metavar="PART",
                        help=", ".join(PARTS) + "; the page keeps what it knows of the others")
    parser.add_argument("--types", nargs="+", choices=weights.TYPES, default=weights.TYPES)
    parser.add_argument("--starts", type=int, default=7, help="of each kind (%(default)s)")
    parser.add_argument("--segments", type=int, default=1000,
                        help="whose service is timed (%(default)s)")
    parser.add_argument("--seconds", type=float, default=90,
                        help="of each run in real time (%(default)s)")
    parser.add_argument("--runs", type=int, default=10000,
                        help="of the network with a deadline (%(default)s)")
    parser.add_argument("--hop", type=float, default=measure.FRAME, metavar="SECONDS",
                        help="between those runs (%(default)s)")
    parser.add_argument("--minutes", nargs="+", type=int, default=(1, 10, 60))
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("out/scale"))
    parser.add_argument("--programs", type=pathlib.Path,
                        default=pathlib.Path("build/release/bench"))
    parser.add_argument("--infer-cli", type=pathlib.Path,
                        default=pathlib.Path("build/release/bin/infer-cli"))
    parser.add_argument("--page", type=pathlib.Path, metavar="FILE",
                        default=pathlib.Path("docs/performance-scale.md"))
    return parser


def _start(options):
    found = []
    for network in weights.NETWORKS:
        for kind in options.types:
            path = weights.make(options.folder, network, kind)
            path.read_bytes()  # into the page cache
            for residence in ("mapped", "copied"):
                for threads in (1, 2) if residence == "copied" else (1,):
                    said = measure.cold_start(options.programs, path, residence, threads,
                                              options.starts)
                    found.append({"network": network, "type": kind, "residence": residence,
                                  "threads": threads, **said})
    return found


def _agents(options):
    found = []
    for kind in ("fp32", "int8"):
        if kind not in options.types:
            continue
        files = [weights.make(options.folder, name, kind) for name in ("zs_mstm1", "bert")]
        for workers in (1, min(2, len(os.sched_getaffinity(0)))):
            found.append({"type": kind, "workers": workers,
                          **_agents_of(options, files, workers)})
    return found


def _agents_of(options, files, workers):
    service = measure.service_times(options.programs, *files, 100 * workers,
                                    options.segments * workers, workers)
    most = {name: line.most_agents(service, measure.PERIOD, frames * measure.FRAME, name == "even")
            for name, frames in (("random", 1), ("even", 1), ("late", page.LATE))}
    growing = {n: line.completions(service, n, measure.PERIOD, False) for n in GROWING
               if n * sum(service) / len(service) < measure.PERIOD}
    real = []
    # Beside two busy loops a worker has a good half of a processor at worst.
    for hogs, agents in ((0, most["late"]), (2, most["late"] // 2)):
        agents = workers * max(1, agents)
        with measure.hogs(hogs):
            times = measure.paced(options.programs, *files, agents, options.seconds, workers, 1)
        real.append({"hogs": hogs, "agents": agents, **_quantiles(times)})
    return {"service": _quantiles(service), "most": most, "real": real,
            "growing": {n: _quantiles(times) for n, times in growing.items()}}


def _deadline(options):
    path = weights.make(options.folder, "bert", "int8")
    idle = measure.due(options.programs, path, options.hop, min(options.runs, 2000))
    with measure.hogs(2):
        beside = measure.due(options.programs, path, options.hop, options.runs)
    return {"hop": options.hop, "idle": _quantiles(idle), "beside": _quantiles(beside),
            "missed": sum(time > options.hop for time in beside)}


def _batch(options):
    return [{"type": kind, "threads": threads,
             "ms": measure.batches(options.programs, weights.make(options.folder, "ast", kind),
                                   threads, 25)}
            for kind in options.types for threads in (1, 2)]


def _offline(options):
    return [{"type": kind, "minutes": minutes,
             **measure.offline(options.infer_cli, weights.make(options.folder, "zs_mstm1", kind),
                               weights.speech(options.folder, minutes),
                               options.folder / "motion.npz")}
            for kind in options.types for minutes in options.minutes]


def _quantiles(times):
    times = sorted(times)
    found = {name: times[min(len(times) - 1, int(share * len(times)))]
             for name, share in (("p50", 0.5), ("p99", 0.99), ("p99.9", 0.999))}
    return {"runs": len(times), "max": times[-1], **found}


if __name__ == "__main__":
    os.chdir(ROOT)
    main()

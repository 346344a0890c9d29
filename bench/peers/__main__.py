"""Compares gestus with ONNX Runtime and PyTorch: python3 -m bench.peers, or ./run peers.

All run the same weights on the same inputs, in turns, in processes that keep their model loaded
(workers.py); outputs are compared before a time is believed (measure.py).
"""

import argparse
import datetime
import json
import os
import pathlib
import subprocess
import sys

from . import chart, machine, page
from .cases import CASES
from .measure import call_seconds, measure_case
from .workers import TYPES, Peak, engines

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main(arguments=None):
    options = _parser().parse_args(arguments)
    known = {case.name: case for case in CASES}
    cases = [known[name] for name in options.cases]
    available, absent = _engines(options)
    _export(options, cases)
    results = _collect(options, cases, available, absent)
    options.folder.joinpath("results.json").write_text(json.dumps(results))
    for path, text in ((options.page, page.render(results)), (options.chart, chart.render(results))):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        say(f"wrote {path}")
    return 1 if any("failed" in r for case in results["cases"] for r in case["results"]) else 0


def _parser():
    parser = argparse.ArgumentParser(prog="./run peers", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    names = [case.name for case in CASES]
    parser.add_argument("--rounds", type=_count, default=15, help="default %(default)s, fewer where runs are long")
    parser.add_argument("--starts", type=_count, default=3,
                        help="processes started for each load time (default %(default)s)")
    parser.add_argument("--cases", nargs="+", choices=names, default=names, metavar="CASE",
                        help=", ".join(names))
    parser.add_argument("--engines", nargs="+", choices=("gestus", "ort", "torch"),
                        default=["gestus", "ort", "torch"], metavar="ENGINE",
                        help="gestus, ort, torch")
    parser.add_argument("--types", nargs="+", choices=TYPES, default=list(TYPES), metavar="TYPE",
                        help=", ".join(TYPES))
    parser.add_argument("--threads", type=_count, default=2, metavar="N",
                        help="run with 1 and with N threads (default %(default)s)")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("out/peers"),
                        help="of exported models and results (default %(default)s)")
    parser.add_argument("--programs", type=pathlib.Path, default=pathlib.Path("build/release/bench"),
                        help="folder of gestus_worker and gestus_peak (default %(default)s)")
    parser.add_argument("--page", type=pathlib.Path, metavar="FILE",
                        default=pathlib.Path("docs/performance-peers.md"))
    parser.add_argument("--chart", type=pathlib.Path, metavar="FILE",
                        default=pathlib.Path("docs/images/peers.svg"))
    return parser


def _count(text):
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text}, expected 1 or more")
    return value


def say(text):
    print(f"==> {text}", file=sys.stderr, flush=True)


def _engines(options):
    """The engines that are there, and name -> reason for the others."""
    modules = options.folder.resolve() / "node_modules"
    available, absent = [], {}
    for name, engine in engines(options.programs.resolve(), modules).items():
        if name not in options.engines:
            absent[name] = "not asked for"
        elif name == "ort" and not (modules / "onnxruntime-node").is_dir():
            absent[name] = "not installed"
        else:
            available.append(engine)
            continue
        say(f"{engine.title} is left out: {absent[name]}")
    return available, absent


def _export(options, cases):
    """In processes of their own: this one stays small, and without PyTorch."""
    folder, names = options.folder, [case.name for case in cases]
    missing = [name for name in names if not (folder / name / "case.json").exists()]
    if missing or not (folder / "nothing" / "case.json").exists():
        subprocess.run([sys.executable, "-m", "bench.peers.export", folder.resolve(), *missing],
                       cwd=ROOT, check=True)
    if options.types != ["fp32"]:
        subprocess.run([sys.executable, "-m", "bench.peers.narrow", folder.resolve(), *names],
                       cwd=ROOT, check=True)


def _collect(options, cases, available, absent):
    threads = sorted({1, min(options.threads, len(os.sched_getaffinity(0)))})
    modules = options.folder.resolve() / "node_modules"
    results = {"machine": machine.describe(), "date": datetime.date.today().isoformat(),
               "busy": 0.0, "rounds": options.rounds, "threads": threads,
               "versions": machine.versions(ROOT, modules), "absent": absent, "cases": [],
               "titles": {e.name: e.title for e in engines(options.programs, modules).values()},
               "chart": options.chart.name}
    with Peak(options.programs.resolve()) as peak:
        results["isa"], results["instructions"] = peak.isa, peak.instructions
        for case in cases:
            say(f"measuring {case.title}")
            results["busy"] = max(results["busy"], machine.busy_share())
            folder = (options.folder / case.name).resolve()
            flops = json.loads((folder / "case.json").read_text())["flops"]
            measured, rounds = measure_case(folder, available, options.types, threads, peak,
                                            options.rounds, options.starts)
            for result in measured:
                if "failed" in result:
                    say(f"{result['engine']} {result['type']}: {result['failed']}")
            results["cases"].append({"name": case.name, "title": case.title, "flops": flops,
                                     "rounds": rounds, "results": measured})
        results["peak"] = {kind: [min(seen[kind] for seen in peak.seen),
                                  max(seen[kind] for seen in peak.seen)] for kind in TYPES}
    if "ort" not in absent:
        ort = next(engine for engine in available if engine.name == "ort")
        results["call_seconds"] = call_seconds((options.folder / "nothing").resolve(), ort)
    return results


if __name__ == "__main__":
    sys.exit(main())

"""The results as a page of documentation."""

import numpy as np

from .measure import summary

BUSY = 0.05  # above this share of the machine for others, times mean little

_HEAD = """\
# gestus and its peers, side by side

`./run peers` wrote this page: do not edit it.  What it measures and how is in
[performance.md](performance.md); the programs are in `bench/peers/__main__.py` and beside it.

{machine}

{conditions}

![share of the measured peak, one thread](images/{chart})

"""

_NOTES = """
Times are milliseconds of one run at batch 1, medians of {runs}; p99 of few runs is the slowest of them.
GFLOP/s count the multiplications and additions of the products and convolutions of the whole network,
the same for every engine, whether an engine does them all or not; shares are of {isa}'s fp32
peak of one core, measured anew in every round, times the threads.  Resident is the highest resident
memory of a process that has run just that model; load is from the start of that process to its first
output, with everything in the page cache.  "differs" is the largest difference from PyTorch in
double, as a share of the largest value.
"""


def render(results):
    """`results` as __main__.py collects them -> Markdown."""
    count = max(results["threads"])
    lines = [_HEAD.format(machine=results["machine"] + ".", conditions=_conditions(results),
                          chart=results["chart"]), _table(results, count), ""]
    lines.append(_engines(results))
    lines.append(_NOTES.format(runs=_run_counts(results), isa=results["isa"]))
    if "call_seconds" in results:
        lines.append(f"A call of ONNX Runtime from Node that computes nothing takes "
                     f"{1e6 * results['call_seconds']:.0f} us, which its times hold.\n")
    return "\n".join(lines)


def _conditions(results):
    text = (f"{results['date']}, {results['rounds']} rounds, peak of one core "
            f"{results['peak'][0]:.0f} to {results['peak'][1]:.0f} GFLOP/s ({results['isa']}).")
    if results["busy"] > BUSY:
        text += (f"  **Others took up to {results['busy']:.0%} of the machine meanwhile: these "
                 "figures show only that the comparison works.**")
    return text


def _run_counts(results):
    counts = [len(measured["seconds"]) for case in results["cases"] for result in case["results"]
              for measured in result["threads"].values()]
    return f"{min(counts)} to {max(counts)} runs" if counts else "no runs"


def _table(results, count):
    head = ["network", "engine", "type", "median", "p99", "GFLOP/s", "of peak"]
    if count > 1:
        head += [f"{count} threads", "p99", "of peak", "speed-up"]
    head += ["resident", "load", "file", "differs"]
    rows = [head, ["---"] * 3 + ["---:"] * (len(head) - 3)]
    for case in results["cases"]:
        title = f"{case['title']} ({_work(case['flops'])})"
        for result in case["results"]:
            rows.append([title] + _row(result, results, count))
            title = ""
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def _work(flops):
    return f"{flops * 1e-9:.3g} GFLOP" if flops >= 1e8 else f"{flops * 1e-6:.3g} MFLOP"


def _row(result, results, count):
    name = [results["titles"][result["engine"]], result["type"]]
    one, many = summary(result, 1), summary(result, count)
    blanks = 4 if count > 1 else 0
    if one is None:
        return name + [result.get("failed", "not run")] + ["-"] * (7 + blanks)
    times = [_ms(one["median"]), _ms(one["p99"]), f"{one['gflops']:.3g}", f"{one['share']:.0%}"]
    if count > 1:
        times += ["-"] * 4 if many is None else [
            _ms(many["median"]), _ms(many["p99"]), f"{many['share']:.0%}",
            f"{one['median'] / many['median']:.2f}"]
    load = float(np.median(result["load_seconds"]))
    return name + times + [_mb(result["resident_bytes"]), f"{1e3 * load:.0f} ms",
                           _mb(result["file_bytes"]), f"{result['error']:.0e}"]


def _ms(seconds):
    return f"{1e3 * seconds:.3g}" if seconds < 1 else f"{1e3 * seconds:.0f}"


def _mb(size):
    return f"{size * 1e-6:.0f} MB" if size >= 1e8 else f"{size * 1e-6:.3g} MB"


def _engines(results):
    rows = ["| engine | version | libraries, stripped |", "| --- | --- | ---: |"]
    for name, title in results["titles"].items():
        sizes = [result["library_bytes"] for case in results["cases"] for result in case["results"]
                 if result["engine"] == name and "library_bytes" in result]
        rows.append(f"| {title} | {results['versions'].get(name, '-')} | "
                    f"{_mb(max(sizes)) if sizes else results['absent'].get(name, '-')} |")
    return "\n".join(rows)

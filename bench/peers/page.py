"""The results as a page of documentation."""

import numpy as np

from .measure import summary
from .workers import NARROW

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
the same for every engine, whether an engine does them all or not, and in every type.  Shares are of
one core's peak, measured anew in every round, times the threads: {peaks}.
"to gestus" is how many times as long as gestus it takes with one thread, in the same type.  Resident is
the highest resident memory of a process that has run just that model; load is from the start of that
process to its first output, with everything in the page cache.  "differs" is the largest difference
from PyTorch in double, as a share of the largest value; the weights are random.

What the types are:

- gestus, bf16 and int8: every matrix that a product reads and every embedding, int8 with a scale for
  each output channel; no module stays wider.
- ONNX Runtime, int8: products, LSTMs and embeddings, quantised dynamically as its own tool does
  (`bench/peers/ort_int8.py`), per output channel; convolutions stay fp32.  Its kernels for
  processors know no bf16.
- PyTorch, bf16: the whole module.  int8: `quantize_dynamic` of linear layers (per output channel) and
  LSTMs, with the engine that its package chooses (Debian's: oneDNN); the rest stays fp32.
"""


def render(results):
    """`results` as __main__.py collects them -> Markdown."""
    count = max(results["threads"])
    lines = [_HEAD.format(machine=results["machine"] + ".", conditions=_conditions(results),
                          chart=results["chart"]), _table(results, count), ""]
    lines.append(_engines(results))
    lines.append(_NOTES.format(runs=_run_counts(results), peaks=_peaks(results)))
    if "call_seconds" in results:
        lines.append(f"A call of ONNX Runtime from Node that computes nothing takes "
                     f"{1e6 * results['call_seconds']:.0f} us, which its times hold.\n")
    return "\n".join(lines)


def _conditions(results):
    text = f"{results['date']}, {results['rounds']} rounds{_fewer(results)}, {results['isa']}, peak of " \
           "one core " + ", ".join(
               f"{kind} {low:.0f} to {high:.0f}" for kind, (low, high) in results["peak"].items()
           ) + " GFLOP/s."
    if results["busy"] > BUSY:
        text += (f"  **Others took up to {results['busy']:.0%} of the machine meanwhile: these "
                 "figures show only that the comparison works.**")
    return text


def _fewer(results):
    said = [f"{case['title']}: {case['rounds']}" for case in results["cases"]
            if case["rounds"] < results["rounds"]]
    return f" ({'; '.join(said)})" if said else ""


def _peaks(results):
    """Which peak the shares of each type are of."""
    said = [f"fp32's of {results['isa']}"]
    for kind in NARROW:
        name = results["instructions"].get(kind)
        said.append(f"{kind}'s of {name}" if name else f"for {kind} fp32's too")
    return ", ".join(said)


def _run_counts(results):
    counts = [len(measured["seconds"]) for case in results["cases"] for result in case["results"]
              for measured in result["threads"].values()]
    return f"{min(counts)} to {max(counts)} runs" if counts else "no runs"


def _table(results, count):
    head = ["network", "engine", "type", "median", "p99", "to gestus", "GFLOP/s", "of peak"]
    if count > 1:
        head += [f"{count} threads", "p99", "of peak", "speed-up"]
    head += ["resident", "load", "file", "differs"]
    rows = [head, ["---"] * 3 + ["---:"] * (len(head) - 3)]
    for case in results["cases"]:
        title = f"{case['title']} ({_work(case['flops'])})"
        for result in case["results"]:
            rows.append([title] + _row(result, results, count, _of_gestus(case, result["type"])))
            title = ""
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def _work(flops):
    return f"{flops * 1e-9:.3g} GFLOP" if flops >= 1e8 else f"{flops * 1e-6:.3g} MFLOP"


def _of_gestus(case, kind):
    """gestus' median of one thread, or None."""
    found = [summary(result, 1) for result in case["results"]
             if result["engine"] == "gestus" and result["type"] == kind]
    return found[0]["median"] if found and found[0] else None


def _row(result, results, count, gestus):
    name = [results["titles"][result["engine"]], result["type"]]
    one, many = summary(result, 1), summary(result, count)
    blanks = 4 if count > 1 else 0
    if one is None:
        return name + [result.get("failed", "not run")] + ["-"] * (8 + blanks)
    times = [_ms(one["median"]), _ms(one["p99"]), f"{one['median'] / gestus:.2f}" if gestus else "-",
             f"{one['gflops']:.3g}", f"{one['share']:.0%}"]
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

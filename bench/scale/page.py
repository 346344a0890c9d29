"""The results as a page of documentation."""

from . import weights

LATE = 4  # frames that motion may be late where a host plays it a little later

BUSY = 0.05  # above this share of the machine for others, times mean little

_HEAD = """\
# Memory, starts, agents

`./run agents` wrote this page: do not edit it.  The programs are in `bench/scale/__main__.py` and beside
it; weights are random, of full size.

{machine}.
"""

_START = """
## Memory and cold start

From the start of a process to the first output, weights in the page cache.  A tensor's memory goes back
to the operating system once it is packed (`engine/weight_cache.h:WeightCache`), so a weight is held once;
what stays beside the packed weights is what is read where it lies: biases, norms, embeddings.
`bench/scale/cold_start.cc` is the program; medians.  CPU is the processor time of opening and planning.

| network | type | residence, threads | start | open | plan | first run | CPU of open + plan | file | resident | peak |
|---|---|---|---|---|---|---|---|---|---|---|
"""

_AGENTS = """
## Agents in one process

An agent is a session of ZS-MSTM 1.0 whose style is kept.  Every 64 / 15 s it has one more segment: BERT on
16 pieces (eleven words), then the generator with its content encoder, autoregressive.  Each worker is
one thread that serves its agents in the order in which segments arrive.  **The deadline is a frame, 1 / 15 s:**
a segment's motion is there at most one frame after its last sound.

Service is timed without pauses, one agent after the other, so that each finds its own memory out of the
caches; the line is computed from it (`bench/scale/line.py:completions`), which is exact for a worker that
nothing else disturbs.  "Most" is the largest number of agents for one worker whose p99.9 meets the deadline:
with agents that a host spreads evenly over time, with segments that arrive at random moments, and with
such and a deadline of {late} frames, for a host that plays motion a little later.

| type | workers | service p50, p99 | most, even | most, random | most, random, {late} frames |
|---|---|---|---|---|---|
{most}

From arrival to completion, random moments, as agents of one worker grow:

| type | workers | agents | p50 | p99 | p99.9 |
|---|---|---|---|---|---|
{growing}

The same in real time, with as many agents as the last column says, and with half of them beside two
busy loops:

| type | workers | agents | beside | segments | p50 | p99 | p99.9 | largest |
|---|---|---|---|---|---|---|---|---|
{real}
"""

_DEADLINE = """
## A deadline beside two busy loops

BERT base int8 on 32 tokens, one thread, default priority, one run every {hop}; a run that ends after the next is
due has missed. Goal: none, and p99.9 at most twice the p50 of an idle machine and 10 ms.

| beside | runs | missed | p50 | p99 | p99.9 | largest |
|---|---|---|---|---|---|---|
{rows}
"""

_BATCH = """
## Segments in batches

AST's blocks on B segments at once, 62 B rows in each product: milliseconds of a segment, medians, B in turns.

| type | threads | B = 1 | 2 | 4 | 8 | gain at best |
|---|---|---|---|---|---|---|
{rows}

{verdict}
"""

_OFFLINE = """
## Long recordings

`infer-cli` on the arrays of ZS-MSTM 1.0, one thread: reading, style, all segments, writing.

| type | minutes of speech | seconds | hours of speech per core-hour |
|---|---|---|---|
{rows}
"""


def render(results):
    """`results` as __main__.py collects them -> Markdown."""
    text = _HEAD.format(machine=results["machine"])
    for part, section in (("start", _start), ("agents", _agents), ("deadline", _deadline),
                          ("batch", _batch), ("offline", _offline)):
        if part in results:
            text += section(results[part]["found"]).rstrip() + "\n\n" + _when(results[part]) + "\n"
    return text


def _when(part):
    text = f"Measured on {part['date']}."
    if part["busy"] > BUSY:
        text += (f"  **Others took up to {part['busy']:.0%} of the machine just before or after: these"
                 " figures show only that the measurement works.**")
    return text


def _start(found):
    rows = ""
    for r in found:
        rows += (f"| {weights.NETWORKS[r['network']]} | {r['type']} | {r['residence']}, "
                 f"{r['threads']} | {r['start_ms']:.0f} ms | {r['open_ms']:.0f} | {r['plan_ms']:.0f} "
                 f"| {r['run_ms']:.0f} | {r['open_cpu_ms'] + r['plan_cpu_ms']:.0f} | "
                 f"{r['file_mb']:.0f} MB | {r['resident_mb']:.0f} | {r['peak_mb']:.0f} |\n")
    return _START + rows


def _agents(found):
    most, growing, real = [], [], []
    for r in found:
        s = r["service"]
        most.append(_row(r["type"], r["workers"], f"{_ms(s['p50'])}, {_ms(s['p99'])}",
                         *(r["most"][name] for name in ("even", "random", "late"))))
        for agents, q in r["growing"].items():
            growing.append(_row(r["type"], r["workers"], agents,
                                *(_ms(q[key]) for key in ("p50", "p99", "p99.9"))))
        for q in r["real"]:
            real.append(_row(r["type"], r["workers"], q["agents"],
                             f"{q['hogs']} busy loops" if q["hogs"] else "nothing", q["runs"],
                             *(_ms(q[key]) for key in ("p50", "p99", "p99.9", "max"))))
    return _AGENTS.format(late=LATE, most="\n".join(most), growing="\n".join(growing), real="\n".join(real))


def _deadline(found):
    rows = [_row(name, q["runs"], missed,
                 *(_ms(q[key]) for key in ("p50", "p99", "p99.9", "max")))
            for name, q, missed in (("nothing", found["idle"], "-"),
                                    ("two busy loops", found["beside"], found["missed"]))]
    return _DEADLINE.format(hop=_ms(found["hop"]), rows="\n".join(rows))


def _batch(found):
    rows, best = [], 0.0
    for r in found:
        gain = r["ms"]["1"] / min(r["ms"].values()) - 1
        best = max(best, gain)
        rows.append(_row(r["type"], r["threads"], *(f"{ms:.1f}" for ms in r["ms"].values()),
                         f"{gain:.0%}"))
    verdict = ("Batches would gain {:.0%} at most, and make every agent wait for the others of its "
               "batch: gestus has none.").format(best)
    return _BATCH.format(rows="\n".join(rows), verdict=verdict)


def _offline(found):
    return _OFFLINE.format(rows="\n".join(
        _row(r["type"], r["minutes"], f"{r['clock']:.1f}",
             f"{r['minutes'] * 60 / r['cpu']:.0f}") for r in found))


def _row(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def _ms(seconds):
    return f"{1e3 * seconds:.1f} ms"

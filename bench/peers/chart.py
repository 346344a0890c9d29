"""The results as a picture: for every network the share of one core's fp32 peak that each engine
and type of number reaches with one thread, its time beside the bar.  Follows the reader's light or
dark scheme."""

from html import escape

from .measure import summary
from .page import BUSY

WIDTH, LEFT, RIGHT = 940, 330, 130
TOP, BAR, GAP, BOTTOM = 78, 15, 16, 34
LINE = 16  # between a network's name and what follows it

_STYLE = """\
<style>
text { font-family: system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif; font-size: 12px; fill: #57606a }
.strong { fill: #1f2328; font-weight: 600 }
.title { fill: #1f2328; font-weight: 600; font-size: 16px }
.back { fill: #ffffff } .grid { stroke: #d0d7de } .limit { stroke: #57606a; stroke-dasharray: 4 3 }
.gestus { fill: #0a7d5a } .ort { fill: #6e7fa3 } .torch { fill: #d98841 }
.bf16 { opacity: 0.75 } .int8 { opacity: 0.5 }
@media (prefers-color-scheme: dark) {
text { fill: #9198a1 } .strong, .title { fill: #f0f6fc } .back { fill: #0d1117 }
.grid { stroke: #30363d } .limit { stroke: #9198a1 }
.gestus { fill: #3fb98f } .ort { fill: #8ea2cf } .torch { fill: #e0a06a }
}
</style>"""


def render(results):
    groups = [(case["title"], _bars(case)) for case in results["cases"]]
    most = max([1.0] + [bar[2] for _, bars in groups for bar in bars])
    height = TOP + BOTTOM + sum(max(2, len(bars)) * BAR + GAP for _, bars in groups)
    scale = (WIDTH - LEFT - RIGHT) / most
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" '
           f'height="{height}">',
           "<title>Share of one core's fp32 peak by network, engine and type, one thread</title>", _STYLE,
           f'<rect class="back" width="{WIDTH}" height="{height}"/>',
           _text(20, 28, "One thread: share of one core's measured fp32 peak, and the time of a run",
                 "title"), *_legend(results), *_axis(most, scale, height)]
    y = TOP
    for title, bars in groups:
        name, _, size = title.partition(", ")
        middle = y + len(bars) * BAR / 2 - LINE / 2 + 4
        out.append(_text(LEFT - 12, middle, name, "strong", "end"))
        out.append(_text(LEFT - 12, middle + LINE, size, anchor="end"))
        for engine, kind, share, median in bars:
            width = max(1.0, share * scale)
            out.append(f'<rect class="{engine} {kind}" x="{LEFT}" y="{y + 1}" width="{width:.1f}" '
                       f'height="{BAR - 2}" rx="2"/>')
            out.append(_text(LEFT + width + 6, y + BAR - 3.5, f"{kind}  {_time(median)}"))
            y += BAR
        y += GAP + BAR * max(0, 2 - len(bars))
    return "\n".join(out + ["</svg>", ""])


def _bars(case):
    bars = []
    for result in case["results"]:
        found = summary(result, 1)
        if found is not None:
            bars.append((result["engine"], result["type"], found["share_fp32"], found["median"]))
    return bars


def _legend(results):
    x = 20
    for name, title in results["titles"].items():
        if name in results["absent"]:
            continue
        yield f'<rect class="{name}" x="{x}" y="42" width="12" height="12" rx="2"/>'
        yield _text(x + 18, 52.5, title)
        x += 40 + 7 * len(title)
    if results["busy"] > BUSY:
        yield _text(WIDTH - 20, 52.5, "measured on a busy machine: only shows that it works", "strong",
                    "end")


def _axis(most, scale, height):
    step = 0.2 if most <= 1.2 else 0.5
    for n in range(int(most / step + 1e-9) + 1):
        x = LEFT + n * step * scale
        limit = abs(n * step - 1) < 1e-9
        yield (f'<line class="{"limit" if limit else "grid"}" x1="{x:.1f}" y1="{TOP - 8}" '
               f'x2="{x:.1f}" y2="{height - BOTTOM}"/>')
        yield _text(x, height - BOTTOM + 18, f"{n * step:.0%}", anchor="middle")


def _time(seconds):
    if seconds < 1e-3:
        return f"{1e6 * seconds:.0f} us"
    return f"{1e3 * seconds:.3g} ms" if seconds < 1 else f"{seconds:.2f} s"


def _text(x, y, text, style="", anchor="start"):
    style = f' class="{style}"' if style else ""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{style}>{escape(text)}</text>'

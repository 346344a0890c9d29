"""Curves of a training: curves.csv, and curves.html, one file that fetches nothing."""

import csv
import html
import math
import pathlib

_FIRST = ("step", "epoch", "seconds", "rate")
_WIDTH, _HEIGHT = 640, 220


class Curves:
    """A row for each look at the development split."""

    def __init__(self, folder, title, until=None):
        """`until`: rows of later steps, which a resumed run makes again, are dropped."""
        self.csv, self.html = (pathlib.Path(folder) / f"curves.{end}" for end in ("csv", "html"))
        self.title, self.rows = title, []
        if until is not None and self.csv.is_file():
            with open(self.csv, newline="", encoding="utf-8") as file:
                self.rows = [{key: float(x) for key, x in row.items() if x not in ("", None)}
                             for row in csv.DictReader(file)]
            self.rows = [row for row in self.rows if row["step"] <= until]

    def add(self, row):
        self.rows.append(row)
        names = [*_FIRST, *sorted({key for row in self.rows for key in row} - {*_FIRST})]
        with open(self.csv, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, names, lineterminator="\n")
            writer.writeheader()
            writer.writerows({key: f"{x:.6g}" for key, x in row.items()} for row in self.rows)
        self.html.write_text(page(self.title, self.rows), encoding="utf-8")


def page(title, rows):
    """A chart for each measure; of training and development in one where both have it."""
    names = sorted({key for row in rows for key in row} - {*_FIRST})
    bases = sorted({name.removeprefix("train_").removeprefix("dev_") for name in names})
    charts = [_chart(base, rows, [f"{split}_{base}" for split in ("train", "dev")
                                  if f"{split}_{base}" in names]) for base in bases]
    charts.append(_chart("rate", rows, ["rate"]))
    return _PAGE.format(title=html.escape(title), charts="\n".join(charts))


def _chart(title, rows, names):
    values = [row[name] for row in rows for name in names if math.isfinite(row.get(name, math.nan))]
    if not values:
        return ""
    low, high = min(values), max(values)
    low, high = (low, high) if high > low else (low - 0.5, high + 0.5)
    last = max(row["step"] for row in rows) or 1
    lines = []
    for n, name in enumerate(names):
        points = " ".join(
            f"{_WIDTH * row['step'] / last:.1f},{_HEIGHT * (high - row[name]) / (high - low):.1f}"
            for row in rows if math.isfinite(row.get(name, math.nan)))
        lines.append(f'<polyline class="c{n}" points="{points}"/>')
    legend = " ".join(f'<span class="c{n}">{html.escape(name)} {rows[-1].get(name, math.nan):.4g}'
                      "</span>" for n, name in enumerate(names))
    return (f"<h2>{html.escape(title)}</h2><p>{legend}</p>"
            f'<svg viewBox="-4 -4 {_WIDTH + 8} {_HEIGHT + 8}" role="img">{"".join(lines)}</svg>'
            f"<p class=range>{low:.4g} to {high:.4g}, {last:.0f} steps</p>")


_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
:root {{ color-scheme: light dark; --a: #0b6bcb; --b: #c2410c }}
@media (prefers-color-scheme: dark) {{ :root {{ --a: #6cb6ff; --b: #f0883e }} }}
body {{ font: 15px/1.4 system-ui, sans-serif; max-width: 44rem; margin: 2rem auto; padding: 0 1rem }}
svg {{ width: 100%; border: 1px solid #8886; fill: none; stroke-width: 1.5 }}
polyline.c0 {{ stroke: var(--a) }} polyline.c1 {{ stroke: var(--b) }}
span.c0 {{ color: var(--a) }} span.c1 {{ color: var(--b) }}
h2 {{ font-size: 1rem; margin: 1.5rem 0 0 }} p {{ margin: .2rem 0 }} .range {{ opacity: .7 }}
</style>
<h1>{title}</h1>
{charts}
</html>
"""

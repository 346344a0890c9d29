"""A contact sheet as SVG: staves of speech, each with the figures of its time below.

Colours are of middle brightness and the ground is transparent, so that the sheet reads on light
pages and on dark ones.
"""

import base64
import struct
import zlib
from xml.sax.saxutils import escape

import numpy as np

from . import figure

WIDTH, MARGIN = 1180, 20
STRIP, WORDS, FIGURE, GAP = 64, 30, 178, 26  # heights: spectrogram, words, figures, between staves
STEP = 0.4  # seconds between figures
INK, ACCENT = "#808893", (0x21, 0x96, 0x8f)
# Of each part of the figure: colour and width.
STROKES = {"body": (INK, 4), "right": ("#e0703a", 4), "left": ("#3f83e0", 4),
           "hand": ("#3f83e0", 2)}
FONT = "system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif"


def png(alpha, colour):
    """A PNG of one colour whose opacity is `alpha`, (rows, columns) of 0 to 255."""
    pixels = np.empty((*alpha.shape, 4), np.uint8)
    pixels[..., :3] = colour
    pixels[..., 3] = alpha
    lines = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    size = struct.pack(">IIBBBBB", alpha.shape[1], alpha.shape[0], 8, 6, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", zlib.compress(lines, 9))
            + chunk(b"IEND", b""))


class Sheet:
    """Speech and motion, cut into `staves` pieces of equal length.  `words` holds (word, start,
    end) in seconds, `mel` (T, bins) and `pose` (T, 22) have `rate` rows a second."""

    def __init__(self, mel, pose, words, rate, staves=2):
        self.mel, self.words, self.rate = mel, words, rate
        self.joints = figure.joints_of(pose)
        self.seconds = len(pose) / rate
        per_stave = int(np.ceil(self.seconds / staves / STEP))
        self.span = per_stave * STEP
        self.staves = staves
        self.scale_x = (WIDTH - 2 * MARGIN) / self.span
        self.parts = []

    def render(self, title, subtitle, footer):
        y = 32
        self._text(MARGIN, y, title, 16, weight=600)
        self._text(MARGIN, y + 24, subtitle, 14)
        y += 44
        for stave in range(self.staves):
            self._stave(stave * self.span, y)
            y += STRIP + WORDS + FIGURE + GAP
        self._text(MARGIN, y, footer, 13)
        height = y + 14
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
                f'width="{WIDTH}" height="{height}" font-family="{FONT}" fill="{INK}">\n'
                f"<title>{escape(title)}</title>\n" + "\n".join(self.parts) + "\n</svg>\n")

    def _stave(self, begin, y):
        end = min(begin + self.span, self.seconds)
        self._spectrogram(begin, end, y)
        self._words(begin, end, y + STRIP + 16)
        left, top, right, bottom = figure.extent(self.joints)
        scale = min(STEP * self.scale_x * 1.06 / (right - left), FIGURE / (bottom - top))
        base = y + STRIP + WORDS + FIGURE / 2 - scale * (top + bottom) / 2
        count = int(round(self.span / STEP))
        for i in range(count):
            at = begin + (i + 0.5) * STEP
            if at < self.seconds:
                x = self._x(at, begin) - scale * (left + right) / 2
                self._figure(at, np.array([x, base]), scale)

    def _x(self, seconds, begin):
        return MARGIN + (seconds - begin) * self.scale_x

    def _spectrogram(self, begin, end, y):
        rows = self.mel[int(begin * self.rate) : int(np.ceil(end * self.rate))]
        low, high = np.percentile(self.mel, (35, 99.5))
        loud = np.clip((rows - low) / (high - low), 0, 1)
        # Pairs of bins, low frequencies at the bottom.
        alpha = (235 * loud.reshape(len(rows), -1, 2).mean(axis=2).T[::-1]).astype(np.uint8)
        image = base64.b64encode(png(alpha, ACCENT)).decode()
        width = (end - begin) * self.scale_x
        self.parts.append(f'<image x="{MARGIN}" y="{y}" width="{width:.1f}" height="{STRIP}" '
                          f'preserveAspectRatio="none" href="data:image/png;base64,{image}"/>')

    def _words(self, begin, end, y):
        free = 0.0
        for word, start, stop in self.words:
            middle = (start + stop) / 2
            if not begin <= middle < end:
                continue
            # Short words in a row would overlap: each waits for the one before it.
            half = 3.9 * len(word) + 2
            x = max(self._x(middle, begin), free + half)
            free = x + half
            self._text(round(x, 1), y, word, 14, anchor="middle")

    def _figure(self, seconds, offset, scale):
        now = min(int(seconds * self.rate), len(self.joints) - 1)
        past = max(0, now - int(STEP * self.rate))
        points = self.joints[now] * scale + offset
        for side, wrist in figure.WRISTS.items():
            trail = self.joints[past : now + 1, wrist] * scale + offset
            self.parts.append(f'<polyline points="{_points(trail)}" fill="none" '
                              f'stroke="{STROKES[side][0]}" stroke-width="1.6" opacity="0.5"/>')
        neck = [end * scale + offset for end in figure.neck_of(self.joints[now])]
        for part, (colour, width) in STROKES.items():
            lines = [(points[a], points[b]) for a, b, of in figure.BONES if of == part]
            lines += [neck] if part == "body" else []
            path = "".join(f"M{_point(a)}L{_point(b)}" for a, b in lines)
            self.parts.append(f'<path d="{path}" stroke="{colour}" stroke-width="{width}" '
                              'stroke-linecap="round" stroke-linejoin="round" fill="none"/>')
        centre, radius = figure.head_of(self.joints[now])
        x, y = centre * scale + offset
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius * scale:.1f}" '
                          f'fill="none" stroke="{INK}" stroke-width="3"/>')
        x, y = points[figure.NOSE]
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5"/>')

    def _text(self, x, y, text, size, weight=400, anchor="start"):
        self.parts.append(f'<text x="{x}" y="{y}" font-size="{size}" font-weight="{weight}" '
                          f'text-anchor="{anchor}">{escape(text)}</text>')


def _point(xy):
    return f"{xy[0]:.1f} {xy[1]:.1f}"


def _points(line):
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in line)

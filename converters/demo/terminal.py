"""Figures and loudness in a terminal, with braille and block characters."""

import numpy as np

from . import figure

_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))  # by row and column of a cell
_BLOCKS = " ▁▂▃▄▅▆▇█"


class Canvas:
    """A grid of braille cells, two dots wide and four dots high."""

    def __init__(self, columns, rows):
        self.cells = np.zeros((rows, columns), np.uint8)

    def dot(self, x, y):
        row, column = int(y) // 4, int(x) // 2
        if 0 <= row < self.cells.shape[0] and 0 <= column < self.cells.shape[1]:
            self.cells[row, column] |= _DOTS[int(y) % 4][int(x) % 2]

    def line(self, a, b):
        steps = int(np.ceil(np.abs(np.subtract(b, a)).max() * 1.5)) + 1
        for x, y in np.linspace(a, b, steps):
            self.dot(x, y)

    def circle(self, centre, radius):
        for angle in np.linspace(0, 2 * np.pi, 40):
            self.dot(centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle))

    def lines(self):
        return ["".join(chr(0x2800 + cell) for cell in row) for row in self.cells]


def figures(pose, rate, columns=78, count=6):
    """`count` poses side by side, at even times, as lines of text with the times below."""
    joints = figure.joints_of(pose)
    width = columns // count
    left, top, right, bottom = figure.extent(joints)
    scale = (2 * width - 2) / (right - left)
    rows = int(np.ceil((bottom - top) * scale / 4))
    offset = np.array([width - scale * (left + right) / 2, 2 * rows - scale * (top + bottom) / 2])
    pictures, times = [], []
    for i in np.linspace(0, len(pose) - 1, 2 * count + 1)[1::2].astype(int):
        canvas = Canvas(width, rows)
        points = joints[i] * scale + offset
        for a, b, part in figure.BONES:
            if part != "hand":  # too fine for dots
                canvas.line(points[a], points[b])
        canvas.line(*(end * scale + offset for end in figure.neck_of(joints[i])))
        centre, radius = figure.head_of(joints[i])
        canvas.circle(centre * scale + offset, radius * scale)
        pictures.append(canvas.lines())
        times.append(f"{i / rate:.1f} s".center(width))
    return ["".join(line) for line in zip(*pictures)] + ["".join(times)]


def level(loudness, columns=78):
    """Loudness as one line of blocks."""
    parts = np.array_split(loudness / max(loudness.max(), 1e-9), columns)
    return "".join(_BLOCKS[int(np.ceil(part.max() ** 0.7 * 8))] for part in parts)

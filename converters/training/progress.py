"""How far a training is: a bar on a terminal, else a line now and then."""

import sys
import time

_WIDTH = 30


class Progress:
    def __init__(self, total, start=0, stream=None):
        self.total, self.start, self.stream = total, start, stream or sys.stderr
        self.begin, self.shown = time.monotonic(), 0.0

    def at(self, step, text):
        """Redraws the bar, at most ten times a second."""
        now = time.monotonic()
        if self.stream.isatty() and (now - self.shown > 0.1 or step == self.total):
            self.shown = now
            full = round(_WIDTH * step / self.total)
            left = (now - self.begin) / max(1, step - self.start) * (self.total - step)
            self.stream.write(f"\r\x1b[K[{'#' * full}{'.' * (_WIDTH - full)}] {step}/{self.total} "
                              f"{text}, {left:.0f} s left")
            self.stream.flush()

    def line(self, text):
        self.stream.write(("\r\x1b[K" if self.stream.isatty() else "") + text + "\n")
        self.stream.flush()

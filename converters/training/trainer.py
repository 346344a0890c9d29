"""The loop: batches by seed, looks at the development split, checkpoints, curves.

Everything that a step draws comes from the seed and the step's number, so a resumed run is, on a CPU,
bit by bit the run that was never interrupted.
"""

import math
import os
import pathlib
import time

import numpy as np
import torch

from ..errors import ConvertError
from .curves import Curves
from .progress import Progress

_ORDER, _STEP, _DEV = range(3)  # streams of random numbers of one seed
CHECKPOINT, BEST = "checkpoint.pt", "best.pt"


class Trainer:
    """Trains a task (tasks/) by a configuration; everything it writes is in `folder`."""

    def __init__(self, task, configuration, folder):
        self.task, self.c, self.folder = task, configuration, pathlib.Path(folder)
        self.batch = configuration["batch"]
        if not task.items:
            raise ConvertError("the data set has nothing in split train to learn this model from")
        self.per_epoch = math.ceil(len(task.items) / self.batch)
        self.total = configuration.get("steps") or configuration["epochs"] * self.per_epoch
        self.step, self.best, self.seconds = 0, math.inf, 0.0
        self.folder.mkdir(parents=True, exist_ok=True)

    def resume(self):
        """Goes on where the checkpoint in the folder ends, if there is one."""
        path = self.folder / CHECKPOINT
        if not path.is_file():
            return
        state = torch.load(path, map_location=self.task.device)
        if state["configuration"] != self.c:
            raise ConvertError(f"{path}: of another configuration, expected the one it was made by")
        self.step, self.best, self.seconds = (state[name] for name in ("step", "best", "seconds"))
        self.task.load(state["task"])

    def run(self, minutes=None):
        """To the end, or for so many minutes."""
        begin, before = time.monotonic(), self.seconds
        curves = Curves(self.folder, f"{self.c['kind']}: {self.c['about']}", until=self.step)
        progress, sums, count = Progress(self.total, self.step), {}, 0
        over = False
        while self.step < self.total and not over:
            losses = self._one_step()
            self.seconds = before + time.monotonic() - begin
            for name, value in losses.items():
                sums[name] = sums.get(name, 0.0) + value
            count += 1
            progress.at(self.step, f"loss {losses['loss']:.4f}")
            over = minutes is not None and self.seconds - before >= 60 * minutes
            if over or self.step == self.total or self.step % self.c["dev_every"] == 0:
                self._look(curves, progress, {k: x / count for k, x in sums.items()})
                sums, count = {}, 0
        return self.best

    def _one_step(self):
        epoch, at = divmod(self.step, self.per_epoch)
        order = self._rng(_ORDER, epoch).permutation(len(self.task.items))
        chosen = [self.task.items[i] for i in order[at * self.batch:(at + 1) * self.batch]]
        self.step += 1
        torch.manual_seed(self.c["seed"] * 1_000_003 + self.step)
        self.task.train()
        losses = self.task.step(chosen, self._rng(_STEP, self.step), self.step)
        if not math.isfinite(losses["loss"]):
            raise ConvertError(f"step {self.step}: the loss is {losses['loss']}, expected a number; "
                               "a lower learning rate may help")
        return losses

    def _look(self, curves, progress, train):
        self.task.eval()
        torch.manual_seed(self.c["seed"])
        with torch.no_grad():
            dev = self.task.dev(self._rng(_DEV, 0))
        row = {"step": self.step, "epoch": self.step / self.per_epoch, "seconds": self.seconds,
               "rate": train.pop("rate"), **{f"train_{k}": x for k, x in train.items()},
               **{f"dev_{k}": x for k, x in dev.items()}}
        curves.add(row)
        mark = ""
        if dev["loss"] < self.best:
            self.best, mark = dev["loss"], " *"
            save(self.task.weights(), self.folder / BEST)
        save({"configuration": self.c, "step": self.step, "best": self.best,
              "seconds": self.seconds, "task": self.task.state()}, self.folder / CHECKPOINT)
        progress.line(f"step {self.step}/{self.total} ({self.seconds:.0f} s): "
                      + ", ".join(f"{k} {x:.4g}" for k, x in row.items()
                                  if k.startswith(("train_", "dev_"))) + mark)

    def _rng(self, stream, number):
        return np.random.default_rng([self.c["seed"], stream, number])


def save(state, path):
    """torch.save, all or nothing."""
    temporary = f"{path}.{os.getpid()}.part"
    torch.save(state, temporary)
    os.replace(temporary, path)

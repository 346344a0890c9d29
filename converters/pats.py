"""Intervals of the PATS corpus (Ahuja et al. 2020) -> the arrays that infer-cli takes.

One HDF5 file an interval: audio/log_mel_512 (rows, 128), text/bert (frames, 768), pose/normalize and
pose/data (frames, 104), the latter three at 15 frames a second.  text/meta, a table of Python
objects, is never read.
"""

import functools

import numpy as np

from . import hdf5, isolate
from .errors import ConvertError

JOINTS = 52  # x of each, then y of each
DEFAULT_JOINTS = tuple(range(11))

# PATS' loader cuts windows of int(4.3 * 89) rows and takes every round(89 / 15)th of them for the
# int(4.3 * 15) frames of a segment.
SEGMENT = 64
# What PATS' loader takes log_mel_512 to have: int(45.6 * 1000 / 512) rows per second.
PATS_MEL_RATE = 89
FRAME_RATE = 15.0  # frames per second of text and pose
MEL_BINS = 128
D_TEXT = 768
WINDOW = int(4.3 * PATS_MEL_RATE)
STRIDE = round(PATS_MEL_RATE / FRAME_RATE)
# Rows a frame: 5.74 of 44.1 kHz, 6.25 of 48 kHz; other rates do not fit a stride of 6.
_LEAST_ROWS, _MOST_ROWS = 5.0, 7.0
_SPARE_ROWS = 2 * STRIDE


def convert(paths, joints=DEFAULT_JOINTS, source="normalize", align="stride"):
    """({array: float32 (frames, columns)} of all intervals one after the other, [note])."""
    notes, parts = [], []
    for path in paths:
        parts.append(_interval(path, list(joints), source, align, notes))
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}, notes


def parse_joints(text):
    """"0-6,10" -> (0, 1, 2, 3, 4, 5, 6, 10)"""
    joints = []
    for part in text.split(","):
        first, dash, last = part.strip().partition("-")
        limits = [first, last] if dash else [first]
        if not all(x.isascii() and x.isdigit() and len(x) < 4 and int(x) < JOINTS for x in limits):
            raise ConvertError(f"--joints: {part[:40]!r}, expected numbers or ranges from 0 to "
                               f"{JOINTS - 1}, such as 0-6,10")
        joints += range(int(limits[0]), int(limits[-1]) + 1)
    if len(set(joints)) != len(joints) or not joints:
        raise ConvertError(f"--joints: {text[:40]!r}, expected each joint once")
    return tuple(joints)


def speech_rows(frames, rows, align):
    """Which row of log_mel_512 belongs to each frame; the stride may run past the last one."""
    at = np.arange(frames)
    if align == "time":
        return (at * rows) // frames
    return WINDOW * (at // SEGMENT) + STRIDE * (at % SEGMENT)


def _interval(path, joints, source, align, notes):
    hdf5.need_h5py(path, "files of PATS")
    read = functools.partial(_extract, source)
    names, arrays = isolate.arrays_of(read, path, hdf5.memory_for(path), hdf5.SECONDS)
    found = dict(zip(names, arrays))
    mel, text, pose = (found[name] for name in names[:3])
    frames = min(len(text), len(pose))
    if len(text) != len(pose):
        notes.append(f"{path}: {len(pose)} frames of pose, {len(text)} of text: the first {frames} "
                     "are taken")
    _check_rate(path, frames, len(mel))
    index = speech_rows(frames, len(mel), align)
    repeated = np.count_nonzero(index >= len(mel))
    if repeated:
        notes.append(f"{path}: the stride of {STRIDE} rows runs past the speech: its last row stands "
                     f"for the last {repeated} of {frames} frames (--align time keeps time)")
    if len(names) > 3:
        _count_lost(path, found[names[3]][:frames], joints, notes)
    columns = joints + [JOINTS + j for j in joints]
    return {"speech": mel[np.minimum(index, len(mel) - 1)], "text": text[:frames],
            "pose": np.ascontiguousarray(pose[:frames, columns])}


def _check_rate(path, frames, rows):
    if not _LEAST_ROWS * frames - _SPARE_ROWS <= rows <= _MOST_ROWS * frames + _SPARE_ROWS:
        raise ConvertError(f"{path}: audio/log_mel_512: {rows} rows for {frames} frames, expected "
                           f"about {STRIDE} a frame (44.1 or 48 kHz)")


def _count_lost(path, confidence, joints, notes):
    lost = np.count_nonzero((confidence[:, joints] <= 0).any(1))
    if lost:
        notes.append(f"{path}: OpenPose missed a joint in {lost} of {len(confidence)} frames; what "
                     "PATS put there is taken")


def _extract(source, path):
    """([name], [float32 array]): log_mel_512, bert, the pose, and pose/confidence if there is one."""
    return hdf5.read(path, functools.partial(_File, source))


class _File(hdf5.SafeFile):
    def __init__(self, source, h5py, path, file):
        super().__init__(h5py, path, file)
        self.source = source

    def read(self):
        wanted = {"audio/log_mel_512": MEL_BINS, "text/bert": D_TEXT,
                  f"pose/{self.source}": 2 * JOINTS}
        pose = self.child(self.root, "pose", self.h5py.Group)
        if self.has(pose, "confidence"):
            wanted["pose/confidence"] = 2 * JOINTS
        return list(wanted), [self.array(name, columns) for name, columns in wanted.items()]

    def array(self, name, columns):
        found = self.inside(self.root, name, self.h5py.Dataset)
        where = f"{self.path}: {name}: "
        self.check(found, where)
        shape = found.shape
        if len(shape) != 2 or shape[0] < 1 or shape[1] != columns:
            raise ConvertError(where + f"shape {shape}, expected (frames, {columns})")
        with np.errstate(over="ignore"):
            x = found[()].astype(np.float32)
        bad = np.argwhere(~np.isfinite(x))
        if len(bad):
            row, column = bad[0]
            raise ConvertError(where + f"no finite number at row {row}, column {column}")
        return x

"""Models 1 and 2: faces of held-out utterances against the truth, as Table 5.8 has them."""

import numpy as np

from .. import engine
from ..data import sampling
from . import material

_EMPTY = 0.0


def evidence(found, name, weights, network, split="test", without=()):
    """Figures of one network: of each channel, and the means over action units and angles.
    `without`: "f0" or "text", which is zero for the ablations that were trained without it."""
    model1 = network == "model1"
    utterances = found.data.select(split)
    items = (sampling.words(found.data, utterances) if model1
             else sampling.windows(found.data, utterances))
    words = 1 if model1 else 10
    f0, text, faces = sampling.take_windows(found.data, items, words)
    made = _decode(found, weights, network, {"f0": f0, "text": text}, without)
    longest = max(made["face"].shape[1], *map(len, faces))
    truth = np.zeros((len(faces), longest, 9), np.float32)
    lengths = np.zeros((len(faces), 9), np.int32)
    for n, face in enumerate(faces):
        truth[n, :len(face)], lengths[n] = face, len(face)
    folder = found.work / f"face-{name}"
    material.save(folder / "made", "all", face=made["face"], lengths=made["lengths"])
    material.save(folder / "truth", "all", face=truth, lengths=lengths)
    report = found.evaluate(folder / "made" / "all.npz", folder / "truth" / "all.npz")["all"]
    covered = np.minimum(made["lengths"], lengths).sum() / lengths.sum()
    return {"windows": len(items), "covered": float(covered), "channels": [
        {key: channel.get(key) for key in ("name", "rmse", "pcc", "ahr_intensity", "nahr")}
        for channel in report["channels"]]}


def _decode(found, weights, network, arrays, without):
    arrays = {name: _EMPTY * x if name in without else x for name, x in arrays.items()}
    arrays = {name: x.reshape(-1, x.shape[2]) for name, x in arrays.items()}
    path = found.work / "face-input.npz"
    np.savez(path, **arrays)
    return engine.arrays_of(found.infer_cli, [weights, path, "--network", network])[0]

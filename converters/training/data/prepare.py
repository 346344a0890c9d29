"""Recordings to a prepared data set (layout.py)."""

import concurrent.futures
import tempfile

from ... import pats as pats_arrays
from ...errors import ConvertError
from . import layout, pats, recordings
from .dataset import Dataset
from .front_end import FEATURES, FrontEnd
from .writer import Writer


def prepare(options, say=lambda line: None):
    """Writes options.output of options.folder; `say` gets a line now and then.  Returns the
    Dataset."""
    index = pats.index_of(options.folder)
    return _pats(options, index, say) if index else _recordings(options, say)


def _recordings(options, say):
    if not options.front_end:
        raise ConvertError("--front-end: missing, expected the weights file that reads the words")
    found, speakers = recordings.find(options.folder, options.seed, options.unseen)
    with tempfile.TemporaryDirectory() as folder:
        front_end = FrontEnd(options.front_end, options.infer_cli, folder)
        writer = Writer(options.output, {
            "face_rate": layout.FACE_RATE, "front_end": front_end.digest,
            "d_text": front_end.d_text, "mel_bins": pats_arrays.MEL_BINS, "features": FEATURES,
            "speakers": speakers})
        with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
            work = [(front_end, recording, options.output) for recording in found]
            for n, entry in enumerate(pool.map(_one, work)):
                writer.note(*entry)
                if (n + 1) % 25 == 0 or n + 1 == len(found):
                    say(f"{n + 1} of {len(found)} recordings")
        writer.close()
    return Dataset.open(options.output)


def _one(work):
    """Runs in a process of its own: writes one recording's file, returns what the index needs."""
    front_end, recording, output = work
    arrays = front_end.features(recording)
    return Writer.save(output, recording.id, recording.speaker, recording.split, arrays)


def _pats(options, index, say):
    if options.front_end:
        raise ConvertError("--front-end: PATS brings features of its own, expected none")
    writer = Writer(options.output, {
        "face_rate": layout.FACE_RATE, "front_end": "PATS", "d_text": pats_arrays.D_TEXT,
        "mel_bins": pats_arrays.MEL_BINS, "features": {"rows": "Pats", "neck": "Position"},
        "speakers": {}})
    found = pats.intervals(index)
    for n, (name, speaker, split, path) in enumerate(found):
        writer.note(*Writer.save(options.output, name, speaker, split, pats.arrays(path)))
        if (n + 1) % 200 == 0 or n + 1 == len(found):
            say(f"{n + 1} of {len(found)} intervals")
    writer.close()
    return Dataset.open(options.output)

"""`python3 -m converters.training prepare FOLDER/ --front-end frontend.fb -o data/`"""

import collections
import sys

from ...errors import ConvertError
from .. import engine
from .prepare import prepare


def add(commands):
    parser = commands.add_parser("prepare", help="recordings, or PATS, to the features that "
                                                 "training reads")
    parser.add_argument("folder", metavar="FOLDER/", help="the corpus, your recordings, or PATS")
    parser.add_argument("-o", "--output", required=True, metavar="DATA/")
    parser.add_argument("--front-end", metavar="FRONTEND.fb",
                        help="weights file with the BERT, and the classifier of dialog acts")
    parser.add_argument("--seed", type=int, default=0,
                        help="of the splits of recordings without an index.json; default 0")
    parser.add_argument("--unseen", default="", metavar="NAMES",
                        help="speakers to hold out, with commas between them")
    parser.add_argument("--jobs", type=int, default=1, help="processes; default 1")
    parser.add_argument("--infer-cli", default=engine.DEFAULT, metavar="PROGRAM")
    parser.set_defaults(run=_run)


def _run(options):
    if not 1 <= options.jobs <= 256:
        raise ConvertError(f"--jobs: {options.jobs}, expected 1 to 256")
    options.unseen = tuple(name for name in options.unseen.split(",") if name)
    data = prepare(options, lambda line: print(line, file=sys.stderr))
    counts = collections.Counter(utterance.split for utterance in data.utterances)
    frames = sum(utterance.frames for utterance in data.utterances)
    print(f"{options.output}: {frames / data.rate / 60:.1f} minutes, "
          + ", ".join(f"{counts[split]} {split}" for split in counts)
          + f"; {', '.join(data.arrays)}")

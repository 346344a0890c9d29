"""`python3 -m converters.training corpus -o corpus/`"""

import sys

from ...errors import ConvertError
from .. import engine
from . import recordings


def add(commands):
    parser = commands.add_parser("corpus", help="make the synthetic corpus: speech by espeak-ng, "
                                                "motion by a parametric gesturer")
    parser.add_argument("-o", "--output", required=True, metavar="CORPUS/")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hours", type=float, default=2.4, help="of speech, about; default 2.4")
    parser.add_argument("--speakers", type=int, default=40, help="seen in training; default 40")
    parser.add_argument("--unseen", type=int, default=8, help="other speakers, voices and styles "
                                                              "for evaluations; default 8")
    parser.add_argument("--texts", type=int, default=12000,
                        help="sentences of texts.tsv, for BERT and the classifier; default 12000")
    parser.add_argument("--jobs", type=int, default=1, help="processes; default 1")
    parser.add_argument("--infer-cli", default=engine.DEFAULT, metavar="PROGRAM")
    parser.set_defaults(run=_run)


def _run(options):
    limits = {"hours": (0.001, 1000), "speakers": (1, 1000), "unseen": (0, 1000),
              "texts": (1, 200000), "jobs": (1, 256), "seed": (0, 2**31)}
    for name, (least, most) in limits.items():
        if not least <= getattr(options, name) <= most:
            raise ConvertError(f"--{name}: {getattr(options, name)}, expected {least} to {most}")
    plan = recordings.Plan(options.seed, options.hours, options.speakers, options.unseen,
                           options.texts)
    index = recordings.make(options.output, plan, options.infer_cli, options.jobs,
                            lambda line: print(line, file=sys.stderr))
    seconds = sum(entry["seconds"] for entry in index["utterances"])
    print(f"{options.output}: {len(index['utterances'])} utterances of "
          f"{len(index['speakers'])} speakers, {seconds / 60:.1f} minutes")

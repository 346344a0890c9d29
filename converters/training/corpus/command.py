"""`python3 -m converters.training corpus -o corpus/`"""

import sys

from ...errors import ConvertError
from .. import engine
from . import recordings


def add(commands):
    plan = recordings.Plan()
    parser = commands.add_parser("corpus", help="make the synthetic corpus: speech by espeak-ng, "
                                                "motion by a parametric gesturer")
    parser.add_argument("-o", "--output", required=True, metavar="CORPUS/")
    parser.add_argument("--seed", type=int, default=plan.seed)
    parser.add_argument("--hours", type=float, default=plan.hours,
                        help="of speech, about; default %(default)s")
    parser.add_argument("--speakers", type=int, default=plan.speakers,
                        help="seen in training; default %(default)s")
    parser.add_argument("--unseen", type=int, default=plan.unseen,
                        help="other speakers, voices and styles for evaluations; "
                             "default %(default)s")
    parser.add_argument("--texts", type=int, default=plan.texts,
                        help="sentences of texts.tsv, for BERT and the classifier; "
                             "default %(default)s")
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

"""`evidence`: figures of trained networks on held-out recordings of the synthetic corpus, whose truth
is known, to evidence.json and evidence.md."""

import json
import pathlib

from ...errors import ConvertError
from .. import engine


def add(commands):
    parser = commands.add_parser("evidence", help="what the trained networks are worth",
                                 description=__doc__)
    parser.add_argument("--corpus", required=True, metavar="CORPUS/")
    parser.add_argument("--data", required=True, metavar="DATA/", help="prepared from it")
    parser.add_argument("--weights", required=True, metavar="WEIGHTS.fb", help="the bundle")
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER")
    parser.add_argument("--infer-cli", default=engine.DEFAULT, metavar="PROGRAM")
    parser.add_argument("--transfer", action="append", default=[], metavar="NETWORK",
                        help="a ZS-MSTM of the bundle")
    parser.add_argument("--styles", type=int, default=0,
                        help="seen styles to transfer to, spread over the list of speakers; "
                             "0: all (default %(default)s)")
    parser.add_argument("--sources", type=int, default=2,
                        help="speakers who are heard for each seen style (default %(default)s)")
    parser.add_argument("--unseen", type=int, default=8,
                        help="and for each unseen one (default %(default)s)")
    parser.add_argument("--face", action="append", default=[], metavar="NAME=WEIGHTS.fb[:WITHOUT]",
                        help="a Model 1 or 2; WITHOUT: f0 or text, taken away in training")
    parser.add_argument("--probe", action="append", default=[], metavar="NAME=RUN",
                        help="a training run of ZS-MSTM, whose content is asked for the style")
    parser.set_defaults(run=_run)


def _run(options):
    from . import report
    from .material import Material
    folder = pathlib.Path(options.output)
    found = Material(options.corpus, options.data, options.weights, options.infer_cli,
                     folder / "work")
    figures = {"transfer": {}, "face": {}, "probe": {}}
    path = folder / "evidence.json"
    if path.is_file():  # parts may be measured one after another
        figures.update(json.loads(path.read_text()))
    for network in options.transfer:
        from . import transfer
        figures["transfer"][network] = {
            condition: transfer.evidence(found, network, condition, sources, most)
            for condition, sources, most in (("seen", options.sources, options.styles),
                                             ("unseen", options.unseen, None))}
    for text in options.face:
        from . import face
        name, weights = _named(text, "--face")
        weights, _, without = weights.partition(":")
        network = "model1" if name.startswith("model1") else "model2"
        figures["face"][name] = face.evidence(found, name, weights, network,
                                              without=tuple(without.split(",")))
    for text in options.probe:
        from . import probe
        name, run = _named(text, "--probe")
        figures["probe"][name] = probe.evidence(pathlib.Path(run), options.data)
    path.write_text(json.dumps(figures, indent=1) + "\n")
    (folder / "evidence.md").write_text(report.markdown(figures))
    print(report.markdown(figures))


def _named(text, option):
    name, equals, value = text.partition("=")
    if not equals or not name or not value:
        raise ConvertError(f"{option}: {text}, expected NAME=PATH")
    return name, value

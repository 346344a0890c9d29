"""`train`: a configuration and a data set to a weights file."""

import json
import pathlib
import sys

from .. import __main__ as converters
from ..errors import ConvertError


def add(commands):
    train = commands.add_parser("train", help="a prepared data set -> a trained network",
                                description=__doc__)
    train.add_argument("configuration", metavar="CONFIG.json",
                       help="how (converters/training/configs)")
    train.add_argument("--data", required=True, metavar="DATA",
                       help="what `prepare` made; for bert and acts the folder of texts.tsv")
    train.add_argument("-o", "--output", required=True, metavar="RUN",
                       help="folder for weights, checkpoint and curves")
    train.add_argument("--resume", action="store_true", help="go on from the checkpoint in RUN")
    train.add_argument("--minutes", type=float, help="stop after so many, with what is best then")
    train.add_argument("--device", default="auto", help="cpu, cuda, or auto (default)")
    train.add_argument("--seed", type=int, help="instead of the configuration's")
    train.add_argument("--set", action="append", default=[], metavar="FIELD=JSON", dest="changes",
                       help="instead of what the configuration says, as in options.dropout=0.2")
    train.add_argument("--threads", type=int, default=1, help="of a CPU (default %(default)s)")
    train.add_argument("--pretrained", action="append", default=[], metavar="NAME=RUN",
                       help="a run to begin with: Model 1 takes ae_speech and ae_face, ZS-MSTM "
                            "zs_mstm1")
    train.set_defaults(run=_train)


def _train(options):
    import torch
    from threadpoolctl import threadpool_limits
    from . import configuration, tasks
    from .trainer import Trainer
    torch.set_num_threads(options.threads)
    threadpool_limits(options.threads)  # OpenBLAS has threads of its own, of which PyTorch knows not
    found = configuration.read(options.configuration, options.changes)
    if options.seed is not None:
        found["seed"] = options.seed
    if options.minutes is not None and not options.minutes > 0:
        raise ConvertError(f"--minutes: {options.minutes}, expected more than 0")
    task_class = tasks.of(found["kind"])
    task = task_class(found, task_class.open_data(options.data), device(options.device))
    if options.pretrained:
        _begin_with(task, dict(_pretrained(text) for text in options.pretrained))
    trainer = Trainer(task, found, options.output)
    if options.resume:
        trainer.resume()
    trainer.run(options.minutes)
    export(task, found, pathlib.Path(options.output))


def device(name):
    import torch
    if name == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    try:
        found = torch.device(name)
        torch.zeros(1, device=found)
    except (RuntimeError, AssertionError) as error:
        raise ConvertError(f"--device: {name}: {str(error).splitlines()[0]}") from None
    return found


def _begin_with(task, states):
    for name in states:
        if name not in task.pretrained:
            raise ConvertError(f"--pretrained: {name}, kind {task.kind} takes "
                               + (" and ".join(task.pretrained) or "nothing"))
    taken = task.take_pretrained(states)
    if not taken:
        raise ConvertError("--pretrained: no tensor has the shape of one here, expected a network of "
                           "the same sizes")
    print(f"begins with {taken} tensors of {', '.join(states)}", file=sys.stderr)


def _pretrained(text):
    import torch
    from .trainer import BEST
    name, equals, folder = text.partition("=")
    if not equals:
        raise ConvertError(f"--pretrained: {text}, expected NAME=RUN")
    path = pathlib.Path(folder) / BEST
    if not path.is_file():
        raise ConvertError(f"--pretrained: {path}: no such file, expected a folder that `train` wrote")
    return name, torch.load(path, map_location="cpu")


def export(task, configuration, folder):
    """Writes the best weights as weights files, through the converter of checkpoints."""
    import torch
    from .trainer import BEST
    parts = [("weights", task.network, torch.load(folder / BEST, map_location="cpu"), task.files()),
             *((name, network, state, {}) for name, network, state in task.exports())]
    for name, network, state, files in parts:
        torch.save(state, folder / f"{name}.pt")
        (folder / f"{name}.json").write_text(json.dumps(fields_of(network), indent=1) + "\n")
        arguments = ["export", folder / f"{name}.pt", "--kind", kind_of(network), "--config",
                     folder / f"{name}.json", "-o", folder / f"{name}.fb", "--trained"]
        for option, lines in files.items():
            path = folder / f"{option}.txt"
            path.write_text("\n".join(lines) + "\n", encoding="utf-8")
            arguments += [f"--{option}", path]
        for option, text in configuration["provenance"].items():
            arguments += ["--" + option.replace("_", "-"), text]
        if converters.main([str(x) for x in arguments]):
            raise ConvertError(f"{folder / name}.pt: the export failed")


def kind_of(network):
    from .. import kinds
    return kinds.kind_of(network)


def fields_of(network):
    """A completed network as export's --config takes it."""
    from .. import networks
    return {**{name: network[name] for name in networks.NETWORK_FIELDS if name in network},
            **network["config"]}

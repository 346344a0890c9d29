#!/usr/bin/python3
"""The command line: export, random, example, bundle, quantise, pats, verify, inspect."""

import argparse
import io
import json
import os
import sys

from . import VERSION, kinds, networks
from .errors import ConvertError


def main(arguments=None):
    options = _parser().parse_args(arguments)
    try:
        if getattr(options, "seed", 0) < 0:
            raise ConvertError(f"--seed: {options.seed}, expected 0 or more")
        return options.run(options) or 0
    except ConvertError as error:
        message = str(error)
    except OSError as error:
        message = f"{error.filename}: {error.strerror}" if error.filename else str(error)
    # One line of printable characters, whatever a file's content put into it.
    print("converters: " + "".join(c if c.isprintable() else "?" for c in message),
          file=sys.stderr)
    return 2


def _parser():
    parser = argparse.ArgumentParser(prog="python3 -m converters", description=__doc__)
    parser.add_argument("--version", action="version", version=f"gestus converters {VERSION}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    export = commands.add_parser("export", help="checkpoint -> weights file")
    export.add_argument("checkpoint", help="file of torch.save (zip format), .safetensors, or "
                                           "Keras' .h5")
    _network_options(export)
    export.add_argument("-o", "--output", required=True, metavar="WEIGHTS.fb")
    export.add_argument("--ast", metavar="AST.pth",
                        help="published AST checkpoint for the encoders the checkpoint lacks")
    _map_option(export)
    export.add_argument("--allow-unused", action="store_true",
                        help="leave out tensors that are not part of the network")
    export.add_argument("--keep-epsilon", action="store_true",
                        help="take the configuration's LayerNorm epsilons although the "
                             "checkpoint's layers had others")
    _bert_options(export)
    export.add_argument("--report", metavar="FILE",
                        help="what became of every tensor, as text or (.json) as JSON")
    export.add_argument("--no-self-test", action="store_true")
    export.add_argument("--trained", action="store_true", help="say that the weights are trained")
    for name, text in (("trained-on", "corpus"), ("trained-at", "ISO 8601 date"),
                       ("recipe", "how the weights were made"), ("licence", "of the weights")):
        export.add_argument("--" + name, help=text)
    export.set_defaults(run=_export)

    random = commands.add_parser("random", help="weights file with random weights")
    _network_options(random)
    _bert_options(random)
    _seed_option(random)
    random.add_argument("-o", "--output", required=True, metavar="WEIGHTS.fb")
    random.add_argument("--checkpoint-out", metavar="MODEL.pt",
                        help="also save the weights with torch.save")
    random.add_argument("--no-self-test", action="store_true")
    random.set_defaults(run=_random)

    bundle = commands.add_parser("bundle", help="weights files -> one file with all networks")
    bundle.add_argument("weights", nargs="+", metavar="[NAME=]WEIGHTS.fb",
                        help="NAME is the network's new name, which must differ from the others'")
    bundle.add_argument("-o", "--output", required=True, metavar="BUNDLE.fb")
    bundle.set_defaults(run=_bundle)

    quantise = commands.add_parser("quantise", help="matrices in bf16 or int8: a smaller file")
    quantise.add_argument("weights", metavar="WEIGHTS.fb")
    quantise.add_argument("--to", choices=("bf16", "int8"), required=True)
    quantise.add_argument("-o", "--output", required=True, metavar="WEIGHTS.fb")
    quantise.add_argument("--input", action="append", metavar="[NAME=]INPUT.npz",
                          help="real features to compare the outputs on; without it, random ones")
    quantise.add_argument("--keep", metavar="REGEX",
                          help="names of tensors that stay as they are")
    quantise.add_argument("--infer-cli", default="infer-cli", metavar="PATH")
    quantise.add_argument("--unchecked", action="store_true",
                          help="without running it: for benchmarks of random weights")
    quantise.set_defaults(run=_quantise)

    verify = commands.add_parser("verify", help="compare the engine with PyTorch")
    verify.add_argument("weights", metavar="WEIGHTS.fb")
    verify.add_argument("--checkpoint", metavar="CHECKPOINT.pt",
                        help="take PyTorch's weights from here instead of the weights file")
    verify.add_argument("--ast", metavar="AST.pth", help="as for export")
    _map_option(verify)
    verify.add_argument("--infer-cli", default="infer-cli", metavar="PATH")
    _seed_option(verify)
    verify.add_argument("--tolerance", type=float,
                        help="largest relative error of any value (default 1e-4; with weights in "
                             "bf16 0.015, in int8 0.045)")
    verify.add_argument("--isas", metavar="LIST",
                        help="instruction sets to run on, such as sse2,avx2 (default: infer-cli's "
                             "choice)")
    verify.set_defaults(run=_verify)

    example = commands.add_parser("example", help="an input of plausible size for a weights file")
    example.add_argument("weights", metavar="WEIGHTS.fb")
    example.add_argument("-o", "--output", required=True, metavar="INPUT.npz")
    example.add_argument("--network", metavar="NAME", help="of a file that holds several")
    _seed_option(example)
    example.set_defaults(run=_example)

    pats = commands.add_parser("pats", help="intervals of PATS -> an input for infer-cli")
    pats.add_argument("intervals", nargs="+", metavar="INTERVAL.h5")
    pats.add_argument("-o", "--output", required=True, metavar="CLIP.npz")
    pats.add_argument("--joints", default="0-10", metavar="LIST",
                      help="PATS' joints of the network, such as 0-6,10 (default %(default)s)")
    pats.add_argument("--source", choices=("normalize", "data"), default="normalize",
                      help="PATS' array of poses (default %(default)s)")
    pats.add_argument("--align", choices=("stride", "time"), default="stride",
                      help="rows of speech by the stride of PATS' loader, or by time "
                           "(default %(default)s)")
    pats.set_defaults(run=_pats)

    inspect = commands.add_parser("inspect", help="what a checkpoint or a weights file holds")
    inspect.add_argument("file")
    inspect.set_defaults(run=_inspect)
    return parser


def _bert_options(parser):
    parser.add_argument("--vocabulary", metavar="VOCAB.txt",
                        help="tokens of a bert, one a line, to travel with the weights")
    parser.add_argument("--labels", metavar="LABELS.txt",
                        help="names of a bert's classes, one a line, or DialogTag's label_map.txt")


def _map_option(parser):
    parser.add_argument("--map", metavar="MAP.json",
                        help="which tensors of the checkpoint are ours (docs/converters.md)")


def _seed_option(parser):
    parser.add_argument("--seed", type=int, default=0, help="0 or more (default %(default)s)")


def _network_options(parser):
    parser.add_argument("--kind", choices=tuple(kinds.KINDS), default="zs_mstm1")
    parser.add_argument("--config", metavar="CONFIG.json",
                        help="fields of the configuration, and joints and normalisations, as the "
                             "schema names them; what is absent takes the schema's default")


def _network(options, **more):
    """The network of --kind and --config; `more` are further fields of the configuration."""
    fields = {} if options.config is None else _config(options.config)
    network = {key: fields.pop(key) for key in networks.NETWORK_FIELDS if key in fields}
    try:
        return networks.complete(options.kind, {**network, "config": {**fields, **more}})
    except ConvertError as error:
        raise ConvertError(f"{options.config or options.kind}: {error}") from None


def _bert_network(options):
    """The network, and the tensors that travel with it."""
    from . import vocabulary
    if options.kind != "bert" and (options.vocabulary or options.labels):
        raise ConvertError(f"--vocabulary and --labels: kind {options.kind}, expected bert")
    labels = {"labels": vocabulary.read_labels(options.labels)} if options.labels else {}
    network = _network(options, **labels)
    if not options.vocabulary:
        return network, {}
    tokens = network["config"]["tokens"]
    return network, {"vocabulary": vocabulary.read_vocabulary(options.vocabulary, tokens)}


def _config(path):
    with open(path, encoding="utf-8") as file:
        try:
            fields = json.load(file)
        except (ValueError, RecursionError) as error:
            raise ConvertError(f"{path}: {error}") from None
    if not isinstance(fields, dict):
        raise ConvertError(f"{path}: expected an object with the fields of a network")
    return fields


def _export(options):
    from . import mapping
    from .checkpoint import read_checkpoint
    from .export import export
    from .report import Report
    provenance = {"trained": options.trained, "trained_on": options.trained_on,
                  "trained_at": options.trained_at, "recipe": options.recipe,
                  "licence": options.licence}
    network, extra = _bert_network(options)
    checkpoint = read_checkpoint(options.checkpoint)
    report = Report(checkpoint, network)
    try:
        export(checkpoint, network, options.output, provenance, report, extra,
               ast=options.ast and read_checkpoint(options.ast),
               given=options.map and mapping.read(options.map), self_test=not options.no_self_test,
               allow_unused=options.allow_unused, keep_epsilon=options.keep_epsilon)
    finally:
        # What is refused needs the lists even more.
        if options.report:
            report.write(options.report)
        _print(report.lines())
    _done([], options.output)


def _random(options):
    from .export import write
    from .random_weights import random_weights, save_checkpoint
    if options.config or options.vocabulary or options.labels:
        network, extra = _bert_network(options)
    else:
        network, extra = networks.demo_network(options.kind), {}
    tensors = random_weights(network, options.seed) | extra
    provenance = {"trained": False, "licence": "as gestus",
                  "recipe": f"random, seed {options.seed}; untrained, the output is noise"}
    report = []
    write(options.output, network, tensors, provenance, not options.no_self_test, report)
    if options.checkpoint_out:
        save_checkpoint(options.checkpoint_out, tensors)
        report.append(f"{options.checkpoint_out}: {len(tensors)} tensors")
    _done(report, options.output)


def _bundle(options):
    from .bundle import bundle
    _done(bundle(options.weights, options.output), options.output)


def _quantise(options):
    from .quantise import quantise
    _done(quantise(options), options.output)


def _verify(options):
    from .verify import verify
    return verify(options)


def _example(options):
    import numpy as np
    from . import weights_file
    file = weights_file.read(options.weights)
    found = [n for n in file.networks if options.network in (None, n["name"])]
    if len(found) != 1:
        raise ConvertError(f"{options.weights}: expected --network with one of "
                           + ", ".join(n["name"] for n in file.networks))
    inputs = networks.random_inputs(found[0], options.seed)
    content = io.BytesIO()
    np.savez(content, **inputs)
    weights_file.replace_file(options.output, [content.getbuffer()])
    _done([f"{name}: {array.shape} {array.dtype}" for name, array in inputs.items()],
          options.output)


def _pats(options):
    import numpy as np
    from . import pats
    arrays, notes = pats.convert(options.intervals, pats.parse_joints(options.joints),
                                 options.source, options.align)
    with open(options.output, "wb") as output:
        np.savez(output, **arrays)
    _done([*("note: " + note for note in notes),
           *(f"{name}: {array.shape} {array.dtype}" for name, array in arrays.items())],
          options.output)


def _inspect(options):
    from .inspect import inspect
    inspect(options.file)


def _print(lines):
    """Keys are a file's content: nothing but printable characters reaches the terminal."""
    for line in lines:
        print("".join(c if c.isprintable() else "?" for c in line))


def _done(report, output):
    _print(report)
    print(f"{output}: {os.path.getsize(output):,} bytes")


if __name__ == "__main__":
    sys.exit(main())

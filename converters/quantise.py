"""Makes smaller weights files: matrices in bf16 or int8, as far as the outputs bear it.

Every network is run with its old and its new weights on the same inputs.  Where an output differs
by more than the guard of the type, the modules that hurt most stay in the next wider type.
"""

import os
import re
import subprocess
import tempfile

import numpy as np

from . import VERSION, networks, shapes, weights_file
from .errors import ConvertError
from .quantised import Quantised, to_bf16, to_int8
from .verify import relative_error

# Largest relative error of an output: of its largest difference to its largest value.
GUARDS = {"bf16": 0.01, "int8": 0.03}
# Self-tests run on other machines, whose bf16 products round otherwise.
SELF_TEST_MARGIN = 1.5
_WIDER = {"int8": "bf16", "bf16": "float32"}
# Tables of which rows are added as they are: no product reads them.
_VALUES = re.compile(r"(cls_token|dist_token|pos_embed|(position|token_type)_embeddings\.weight)$")
_SEED = 1


def quantise(options):
    """Writes `options.output`; returns lines to report."""
    file = weights_file.read(options.weights)
    target = _Target(file, options.to, options.keep, options.weights)
    if options.unchecked:
        return [f"{target.write(options.output, {}):,} bytes, outputs not compared"]
    trials = _Trials(options.infer_cli, file, _inputs(file, options.input or []), options.weights)
    lines, kept = [], {}
    for network in file.networks:
        modules = target.modules(network)
        errors, wider = _search(network, modules, target, trials, options.to)
        kept |= wider
        for output, error in errors.items():
            said = error if isinstance(error, str) else (
                f"relative error {error:.3%} of at most {GUARDS[options.to]:.0%}")
            lines.append(f"{network['name']}: {output}: {said}")
    for module, kind in kept.items():
        lines.append(f"{module}: stays {kind}, or an output would differ by more")
    old, new = os.path.getsize(options.weights), target.write(options.output, kept)
    lines.append(f"{old:,} bytes became {new:,}, {new / old:.1%}")
    return lines


def read_by_products(key, tensor):
    """Whether that tensor of a network may become bf16 or int8."""
    return not isinstance(tensor, Quantised) and tensor.ndim >= 2 and not _VALUES.search(key)


def narrowed(tensor, kind):
    """In bf16 or int8; int8 rows that would be too deep in bf16."""
    deep = tensor.size // len(tensor) > weights_file.MAX_I8_DEPTH
    return (to_int8 if kind == "int8" and not deep else to_bf16)(tensor)


class _Target:
    """The file to be made: which tensors may change, and how it is written."""

    def __init__(self, file, kind, keep, path):
        self._file, self._kind = file, kind
        self._keep = re.compile(keep) if keep else None
        self._path = path
        self._cache = {}

    def modules(self, network):
        """Module -> the names of its tensors that products read."""
        found = {}
        for key in shapes.network_shapes(network):
            name = network["prefix"] + key
            tensor = self._file.tensors[name]
            if not read_by_products(key, tensor):
                continue
            if self._keep and self._keep.search(name):
                continue
            module = re.sub(r"[._]?weight(_[ih]h_l\d+(_reverse)?)?$", "", name)
            found.setdefault(module, []).append(name)
        if not found:
            raise ConvertError(f"{self._path}: network {network['name']}: nothing to quantise")
        return found

    def write(self, path, kept, only=None, network=None):
        """Writes the file with the modules `kept` (module -> type) wider, or (for a trial) with the
        modules in `only` changed and no others; its size."""
        names = {name: kept.get(module, self._kind) for each in self._file.networks
                 for module, parts in self.modules(each).items() for name in parts
                 if only is None or module in only}
        if network is not None:
            names = {name: kind for name, kind in names.items()
                     if name.startswith(network["prefix"])}
        tensors = {name: self._converted(name, names.get(name, "float32"))
                   for name in self._file.tensors}
        wider = {module: kind for module, kind in kept.items() if kind != self._kind}
        weights_file.write(path, [self._with_tolerance(n) for n in self._file.networks], tensors,
                           self._provenance(wider))
        return os.path.getsize(path)

    def _converted(self, name, kind):
        tensor = self._file.tensors[name]
        if kind == "float32":
            return tensor
        if (name, kind) not in self._cache:
            self._cache[name, kind] = narrowed(tensor, kind)
        return self._cache[name, kind]

    def _with_tolerance(self, network):
        if "self_test" not in network:
            return network
        tolerance = max(network["self_test"]["relative_tolerance"],
                        GUARDS[self._kind] * SELF_TEST_MARGIN)
        return {**network, "self_test": {**network["self_test"], "relative_tolerance": tolerance}}

    def _provenance(self, wider):
        old = self._file.provenance
        said = f"weights in {self._kind}"
        for kind in sorted({*wider.values()}):
            said += f", {kind}: " + " ".join(m for m, k in wider.items() if k == kind)
        return {**old, "recipe": "; ".join(filter(None, (old.get("recipe"), said))),
                "converter": f"gestus converters {VERSION}",
                "source": f"{os.path.basename(self._path)} "
                          f"checksum:{self._file.header['checksum']:016x}"
                          + (f" ({old['source']})" if "source" in old else "")}


class _Trials:
    """Runs of infer-cli on the inputs of each network."""

    def __init__(self, infer_cli, file, inputs, path):
        self._infer_cli, self._inputs = infer_cli, inputs
        self._want = {network["name"]: [self._run(path, network, x)
                                        for x in inputs[network["name"]]]
                      for network in file.networks}

    def errors(self, path, network):
        """Output -> largest relative error over the inputs; of whole numbers, a text."""
        errors, changed = {}, {}
        for want, x in zip(self._want[network["name"]], self._inputs[network["name"]]):
            got = self._run(path, network, x)
            for name, array in want.items():
                if array.dtype.kind == "i":
                    same_shape = got[name].shape == array.shape
                    share = float(np.mean(got[name] != array)) if same_shape else 1
                    changed[name] = max(changed.get(name, 0), share)
                else:
                    errors[name] = max(errors.get(name, 0), relative_error(got[name], array))
        return errors | {name: f"{share:.2%} of the whole numbers changed"
                         for name, share in changed.items()}

    def _run(self, path, network, inputs):
        with tempfile.TemporaryDirectory() as folder:
            source, target = os.path.join(folder, "in.npz"), os.path.join(folder, "out.npz")
            np.savez(source, **inputs)
            command = [self._infer_cli, path, source, "-o", target, "--network", network["name"]]
            try:
                done = subprocess.run(command, capture_output=True, text=True, check=False)
            except OSError as error:
                raise ConvertError(f"{self._infer_cli}: {error.strerror}") from None
            if done.returncode != 0:
                raise ConvertError(f"{self._infer_cli}: exit code {done.returncode}: "
                                   + done.stderr.strip()[:300])
            with np.load(target, allow_pickle=False) as arrays:
                return {name: arrays[name] for name in arrays.files}


def _search(network, modules, target, trials, kind):
    """The errors of what is written at last, and the modules (module -> type) that stay wider."""
    guard = GUARDS[kind]

    def trial(kept, only=None):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "trial.fb")
            target.write(path, kept, only, network)
            return trials.errors(path, network)

    def worst(errors):
        return max((e for e in errors.values() if not isinstance(e, str)), default=0.0)

    def fewest(kept, order, wider):
        """How many of the first in `order` must be wider: errors fall with their number, roughly."""
        low, high = -1, len(order)
        while low + 1 < high:
            count = (low + high) // 2
            passed = worst(trial(kept | dict.fromkeys(order[:count], wider))) <= guard
            low, high = (low, count) if passed else (count, high)
        return high

    errors = trial({})
    if worst(errors) <= guard:
        return errors, {}
    order = sorted(modules, key=lambda m: worst(trial({}, {m})), reverse=True)
    kept, wider = {}, _WIDER[kind]
    if wider != "float32":
        all_wider = dict.fromkeys(order, wider)
        if worst(trial(all_wider)) > guard:
            # Some must be float32, whatever the rest is.
            count = fewest(all_wider, order, "float32")
            kept, order = dict.fromkeys(order[:count], "float32"), order[count:]
    kept |= dict.fromkeys(order[:fewest(kept, order, wider)], wider)
    errors = trial(kept)
    if worst(errors) > guard:
        raise ConvertError(f"network {network['name']}: outputs differ by {worst(errors):.2%} even "
                           f"with {len(kept)} of {len(modules)} modules wider")
    return errors, kept


def _inputs(file, given):
    """Network -> input arrays: those given, or random ones, and those of its self-test."""
    named = {}
    for source in given:
        name, equals, path = source.partition("=")
        if not equals:
            name, path = "", source
            if len(file.networks) != 1:
                raise ConvertError(f"--input {source}: {len(file.networks)} networks, expected "
                                   "NAME=INPUT.npz")
            name = file.networks[0]["name"]
        if name not in {n["name"] for n in file.networks}:
            raise ConvertError(f"--input {source}: no network {name}")
        with np.load(path, allow_pickle=False) as arrays:
            named.setdefault(name, []).append({key: arrays[key] for key in arrays.files})
    inputs = {}
    for network in file.networks:
        own = named.get(network["name"]) or [networks.random_inputs(network, _SEED + 1)]
        test = network.get("self_test")
        if test:
            own = [*own, {name: file.tensors[tensor] for name, tensor
                          in zip(test["input_names"], test["inputs"])}]
        inputs[network["name"]] = own
    return inputs

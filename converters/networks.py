"""Networks as the command line describes them: configuration, joints, normalisations, inputs."""

from . import kinds, schema, shapes
from .errors import ConvertError
from .inputs import Streams

# Fields of the schema's Network, beside its configuration, that whoever exports may choose.
NETWORK_FIELDS = ("name", "prefix", "joints", "normalisations", "features")


def default_network(kind):
    """The network at full size, as the schema's defaults have it."""
    return complete(kind, {})


def demo_network(kind):
    """The network at full size with statistics that let untrained weights show something, such as
    a figure that looks like one."""
    return complete(kind, kinds.KINDS[kind].demo())


def complete(name, network):
    """`network` of the kind `name` (fields of the schema's Network; `config` may leave out what is
    default) with every default filled in and checked."""
    kind = kinds.KINDS[name]
    # flatc wants the type of a union before its value.
    network = {"name": name, "prefix": "", "config_type": kind.config_type, **network,
               "config": kind.defaults(dict(network.get("config", {})))}
    network = schema.complete(network)
    shapes.network_shapes(network)
    joints = kind.joints(network["config"])
    if "joints" not in network and joints:
        network["joints"] = joints
    features = {**kind.features(network["config"]), **network.get("features", {})}
    if features:
        network["features"] = features
    _check_features(network, kind.features(network["config"]))
    _check_streams(network, kind.streams(network["config"]))
    return network


def random_inputs(network, seed, **sizes):
    """Inputs with the statistics of the network's normalisations; what `sizes` may say, and what it
    is otherwise, is the kind's business."""
    kind, config = kinds.of(network), network["config"]
    streams = Streams(kind.streams(config), network.get("normalisations", []), seed)
    return kind.inputs(config, streams, **sizes)


def _check_features(network, own):
    """What the front end is told must fit the widths of the network's inputs."""
    for name in ("landmarks", "tags"):
        given, wanted = network.get("features", {}).get(name), own.get(name)
        if given is not None and wanted is not None and len(given) != len(wanted):
            raise ConvertError(f"features.{name}: {len(given)}, expected {len(wanted)}")


def _check_streams(network, widths):
    seen = set()
    for n in network.get("normalisations", []):
        stream, sizes = n["stream"], {len(n["mean"]), len(n["deviation"])}
        where = f"normalisation of {stream}: "
        if stream not in widths or stream in seen:
            raise ConvertError(where + "expected " + (f"each of {', '.join(widths)} at most once"
                                                      if widths else "none"))
        seen.add(stream)
        if sizes not in ({1}, {widths[stream]}):
            raise ConvertError(where + f"{len(n['mean'])} means and {len(n['deviation'])} "
                               f"deviations, expected 1 or {widths[stream]} of both")
        if not min(n["deviation"]) > 0 or not n["divisor"] > 0:
            raise ConvertError(where + "expected deviations and divisor above zero")
    joints = network.get("joints", [])
    if joints and 2 * len(joints) != widths.get("pose"):
        raise ConvertError(f"joints: {len(joints)}, expected half of d_pose {widths.get('pose')}")

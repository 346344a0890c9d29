"""Networks as the command line describes them: configuration, joints, normalisations, inputs."""

import numpy as np

from . import schema, shapes
from .errors import ConvertError

# PATS' first eleven joints (features.md, section 6), their parents, and a figure at rest in units
# of pose/normalize (167 from neck to right shoulder, y down), relative to the neck.
PATS_JOINTS = (
    ("Neck", -1, (0, 0)), ("RShoulder", 0, (-166, 14)), ("RElbow", 1, (-205, 235)),
    ("RWrist", 2, (-95, 335)), ("LShoulder", 0, (166, 14)), ("LElbow", 4, (205, 235)),
    ("LWrist", 5, (95, 335)), ("Nose", 0, (0, -135)), ("REye", 7, (-26, -165)),
    ("LEye", 7, (26, -165)), ("LHandRoot", 6, (70, 350)),
)
# How far an untrained figure moves: deviations of the joints above, in the same units.
_MOTION = (4, 6, 28, 60, 6, 28, 60, 10, 10, 10, 66)
# Of log_mel_512 (converters/features.py) on read speech; PATS' own values are not published.
_SPEECH = {"stream": "speech", "mean": [-6.0], "deviation": [3.5]}


# Fields of the schema's Network, beside its configuration, that whoever exports may choose.
NETWORK_FIELDS = ("name", "prefix", "joints", "normalisations")


def default_network(kind):
    """The network at full size, as the schema's defaults have it."""
    return complete(kind, {})


def complete(kind, network):
    """`network` (fields of the schema's Network; `config` may leave out what is default) with every
    default filled in and checked."""
    config = dict(network.get("config", {}))
    if kind == "zs_mstm1":
        config.setdefault("ast_content", {})
        if not config.get("ast_shared", False):
            config.setdefault("ast_style", config["ast_content"])
    # flatc wants the type of a union before its value.
    network = {"name": kind, "prefix": "", "config_type": shapes.KINDS[kind],
               **network, "config": config}
    network = schema.complete(network)
    shapes.network_shapes(network)
    if kind == "zs_mstm1" and "joints" not in network and network["config"]["d_pose"] == 22:
        network["joints"] = [{"name": name, "parent": parent, "source": i}
                             for i, (name, parent, _) in enumerate(PATS_JOINTS)]
    _check_streams(network)
    return network


def demo_network(kind):
    """The network at full size with statistics that let untrained weights move a figure that looks
    like one."""
    statistics = [_SPEECH]
    if kind == "zs_mstm1":
        positions = np.array([at for _, _, at in PATS_JOINTS], np.float32)
        statistics.append({"stream": "pose", "mean": positions.T.ravel().tolist(),
                           "deviation": list(_MOTION) * 2})
    return complete(kind, {"normalisations": statistics})


def stream_widths(network):
    c = network["config"]
    if shapes.kind_of(network) == "ast":
        return {"speech": c["mel_bins"]}
    return {"speech": c["ast_content"]["mel_bins"], "text": c["d_text"], "pose": c["d_pose"]}


def _check_streams(network):
    widths, seen = stream_widths(network), set()
    for n in network.get("normalisations", []):
        stream, sizes = n["stream"], {len(n["mean"]), len(n["deviation"])}
        where = f"normalisation of {stream}: "
        if stream not in widths or stream in seen:
            raise ConvertError(where + f"expected each of {', '.join(widths)} at most once")
        seen.add(stream)
        if sizes not in ({1}, {widths[stream]}):
            raise ConvertError(where + f"{len(n['mean'])} means and {len(n['deviation'])} "
                               f"deviations, expected 1 or {widths[stream]} of both")
        if not min(n["deviation"]) > 0 or not n["divisor"] > 0:
            raise ConvertError(where + "expected deviations and divisor above zero")
    joints = network.get("joints", [])
    if joints and 2 * len(joints) != widths.get("pose"):
        raise ConvertError(f"joints: {len(joints)}, expected half of d_pose {widths.get('pose')}")


def random_inputs(network, seed, segments=1, style_segments=1):
    """Inputs of plausible size: smooth along time, with the statistics of the normalisations."""
    c = network["config"]
    rng = np.random.default_rng([seed, 1])
    statistics = {n["stream"]: n for n in network.get("normalisations", [])}

    def stream(name, rows):
        width = stream_widths(network)[name]
        # Half a slow movement, half noise: neither constant nor white along time.
        steps = rng.standard_normal((rows // 8 + 2, width)).repeat(8, 0)[:rows]
        x = np.sqrt(0.5) * (steps + rng.standard_normal((rows, width)))
        s = statistics.get(name)
        if s:
            x = x * np.array(s["deviation"]) + np.array(s["mean"])
        return x.astype(np.float32)

    frames = c["frames"]
    if shapes.kind_of(network) == "ast":
        return {"speech": stream("speech", frames)}
    rows = frames * c["context_segments"] * segments
    style = frames * style_segments
    return {"speech": stream("speech", rows), "text": stream("text", rows),
            "style_speech": stream("speech", style), "style_text": stream("text", style),
            "style_pose": stream("pose", style)}

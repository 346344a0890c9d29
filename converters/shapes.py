"""Which tensors a network of a given configuration has: key -> shape, in the order of the file.

The keys are those of the PyTorch modules in converters/reference; for AST they are the keys of the
published checkpoints without their "module." prefix.
"""

from .errors import ConvertError

KINDS = {"zs_mstm1": "ZsMstm1Config", "ast": "AstConfig"}


def kind_of(network):
    """The name that the command line gives to the kind of `network`."""
    for kind, config_type in KINDS.items():
        if network["config_type"] == config_type:
            return kind
    raise ConvertError(f"network {network['name']}: kind {network['config_type']}, expected one of "
                       + ", ".join(KINDS.values()))


def network_shapes(network):
    """Shapes of the tensors of a completed network, after its configuration has been checked."""
    config = network["config"]
    if kind_of(network) == "ast":
        check_ast(config, "config")
        return ast_shapes(config)
    check_zs_mstm1(config)
    return zs_mstm1_shapes(config)


def patch_grid(config):
    """(f, t): patches along frequency and along time."""
    return tuple((config[axis] - config["patch"]) // config["stride"] + 1
                 for axis in ("mel_bins", "frames"))


def ast_shapes(c, prefix=""):
    d, mlp, patch = c["d_model"], c["d_mlp"], c["patch"]
    f, t = patch_grid(c)
    shapes = {
        "v.cls_token": (1, 1, d),
        "v.dist_token": (1, 1, d),
        "v.pos_embed": (1, 2 + f * t, d),
        "v.patch_embed.proj.weight": (d, 1, patch, patch),
        "v.patch_embed.proj.bias": (d,),
    }
    for n in range(c["layers"]):
        block = f"v.blocks.{n}."
        shapes |= {
            **_norm(block + "norm1", d), **_linear(block + "attn.qkv", 3 * d, d),
            **_linear(block + "attn.proj", d, d), **_norm(block + "norm2", d),
            **_linear(block + "mlp.fc1", mlp, d), **_linear(block + "mlp.fc2", d, mlp),
        }
    shapes |= _norm("v.norm", d)
    if c["head"] == "LayerNormLinear":
        shapes |= _norm("mlp_head.0", d)
    if c["head"] != "None":
        shapes |= _linear("mlp_head.1", c["d_out"], d)
    return {prefix + key: shape for key, shape in shapes.items()}


def zs_mstm1_shapes(c):
    d, hidden, ff = c["d_model"], c["lstm_hidden"], c["decoder_ff"]
    d_content = c["ast_content"]["d_out"] + c["d_text"]
    d_style = style_ast(c)["d_out"] + c["d_text"]
    shapes = ast_shapes(c["ast_content"], "ast_content.")
    if not c["ast_shared"]:
        shapes |= ast_shapes(c["ast_style"], "ast_style.")
    shapes |= _attention("content_attention", d_content)
    shapes |= _attention("style_attention", d_style)
    for k in range(c["lstm_layers"]):
        shapes |= {
            f"pose_lstm.weight_ih_l{k}": (4 * hidden, hidden if k else c["d_pose"]),
            f"pose_lstm.weight_hh_l{k}": (4 * hidden, hidden),
            f"pose_lstm.bias_ih_l{k}": (4 * hidden,),
            f"pose_lstm.bias_hh_l{k}": (4 * hidden,),
        }
    shapes |= _linear("dense", d, d_content + d_style + hidden)
    if c["decoder_mode"] == "Autoregressive":
        shapes |= _linear("pose_embedding", d, pose_row(c))
    for n in range(c["decoder_layers"]):
        layer = f"decoder.layers.{n}."
        shapes |= {
            **_attention(layer + "self_attn", d), **_attention(layer + "multihead_attn", d),
            **_linear(layer + "linear1", ff, d), **_linear(layer + "linear2", d, ff),
            **_norm(layer + "norm1", d), **_norm(layer + "norm2", d), **_norm(layer + "norm3", d),
        }
    shapes |= _linear("head", pose_row(c), d)
    return shapes


def style_ast(c):
    return c["ast_content"] if c["ast_shared"] else c["ast_style"]


def pose_row(c):
    """Width of one row of output: a frame's pose, or a segment's."""
    return c["d_pose"] * (c["frames"] if c["granularity"] == "Segment" else 1)


def d_style(c):
    """Width of h_style."""
    return style_ast(c)["d_out"] + c["d_text"] + c["lstm_hidden"]


def _linear(key, rows, cols):
    return {key + ".weight": (rows, cols), key + ".bias": (rows,)}


def _norm(key, d):
    return {key + ".weight": (d,), key + ".bias": (d,)}


def _attention(key, d):
    return {key + ".in_proj_weight": (3 * d, d), key + ".in_proj_bias": (3 * d,),
            **_linear(key + ".out_proj", d, d)}


def check_ast(c, where):
    _positive(c, where, "frames", "mel_bins", "patch", "stride", "d_model", "layers", "heads",
              "d_mlp", "d_out")
    for axis in ("frames", "mel_bins"):
        _expect(c["patch"] <= c[axis], where, axis, c[axis], f"at least patch {c['patch']}")
    _expect(c["stride"] <= c["patch"], where, "stride", c["stride"], f"at most patch {c['patch']}")
    _divides(c, where, "heads", "d_model", c["d_model"])
    if c["head"] == "None":
        _expect(c["d_out"] == c["d_model"], where, "d_out", c["d_out"],
                f"d_model {c['d_model']} without a head")


def check_zs_mstm1(c):
    _positive(c, "config", "frames", "d_text", "d_pose", "d_model", "attention_heads",
              "lstm_layers", "lstm_hidden", "decoder_layers", "decoder_heads", "decoder_ff",
              "context_segments")
    _expect(c["ast_shared"] == ("ast_style" not in c), "config", "ast_style",
            "present" if "ast_style" in c else "absent",
            "the opposite: it is there exactly when ast_shared is false")
    for name in ("ast_content", "ast_style"):
        if name in c:
            ast = c[name]
            check_ast(ast, "config." + name)
            _expect(ast["frames"] == c["frames"], f"config.{name}", "frames", ast["frames"],
                    f"{c['frames']} as in config.frames")
            _divides(c, "config", "attention_heads", f"{name}.d_out + d_text",
                     ast["d_out"] + c["d_text"])
    if not c["ast_shared"]:
        bins = c["ast_content"]["mel_bins"]
        _expect(c["ast_style"]["mel_bins"] == bins, "config.ast_style", "mel_bins",
                c["ast_style"]["mel_bins"], f"{bins} as in ast_content")
    _divides(c, "config", "decoder_heads", "d_model", c["d_model"])
    if c["granularity"] == "Frame":
        _expect(c["context_segments"] == 1, "config", "context_segments", c["context_segments"],
                "1 with granularity Frame")


def _positive(c, where, *names):
    for name in names:
        _expect(c[name] >= 1, where, name, c[name], "at least 1")


def _divides(c, where, name, of, total):
    _expect(total % c[name] == 0, where, name, c[name], f"a divisor of {of} = {total}")


def _expect(holds, where, name, found, wanted):
    if not holds:
        raise ConvertError(f"{where}.{name}: {found}, expected {wanted}")

"""Audio Spectrogram Transformer: the keys of the published checkpoints, without "module."."""

from ..checks import divides, expect, positive
from ..kind import Kind
from ..layers import linear, norm

# Of log_mel_512 on read speech; PATS' own values are not published.
SPEECH = {"stream": "speech", "mean": [-6.0], "deviation": [3.5]}

PUBLISHED_FRAMES = 1024

# Queries and keys are large so that attention picks rows instead of averaging over all of them,
# which would leave the output constant along time.
GAINS = {"attn.qkv.weight": 1.3}
TABLES = {"token": 0.5, "pos_embed": 0.5}


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
            **norm(block + "norm1", d), **linear(block + "attn.qkv", 3 * d, d),
            **linear(block + "attn.proj", d, d), **norm(block + "norm2", d),
            **linear(block + "mlp.fc1", mlp, d), **linear(block + "mlp.fc2", d, mlp),
        }
    shapes |= norm("v.norm", d)
    if c["head"] == "LayerNormLinear":
        shapes |= norm("mlp_head.0", d)
    if c["head"] != "None":
        shapes |= linear("mlp_head.1", c["d_out"], d)
    return {prefix + key: shape for key, shape in shapes.items()}


def check_ast(c, where):
    positive(c, where, "frames", "mel_bins", "patch", "stride", "d_model", "layers", "heads",
             "d_mlp", "d_out")
    for axis in ("frames", "mel_bins"):
        expect(c["patch"] <= c[axis], where, axis, c[axis], f"at least patch {c['patch']}")
    expect(c["stride"] <= c["patch"], where, "stride", c["stride"], f"at most patch {c['patch']}")
    divides(c, where, "heads", "d_model", c["d_model"])
    if c["head"] == "None":
        expect(c["d_out"] == c["d_model"], where, "d_out", c["d_out"],
               f"d_model {c['d_model']} without a head")


class Ast(Kind):
    config_type = "AstConfig"
    gains = GAINS
    tables = TABLES

    def check(self, config):
        check_ast(config, "config")

    def shapes(self, config):
        return ast_shapes(config)

    def streams(self, config):
        return {"speech": config["mel_bins"]}

    def inputs(self, config, streams):
        return {"speech": streams.rows("speech", config["frames"])}

    def demo(self):
        return {"normalisations": [SPEECH]}

    def features(self, config):
        # The published AST hears ten seconds of Kaldi's filter bank; the thesis' hears 64 motion frames.
        return {"speech": "FilterBank"} if config["frames"] == PUBLISHED_FRAMES else {}

    def ast_parts(self, config):
        return [("", config)]


KIND = Ast()

"""ZS-MSTM 1.0: reconstruction against a discriminator of style (thesis 6.5.4 and 6.6)."""

import numpy as np
import torch

from ... import networks
from ...kinds import zs_mstm1
from ...reference import run as reference
from ...reference.ast import Ast
from .. import losses, schedules, starts, statistics
from ..batched import ast, small, zs_mstm
from ..data import sampling
from ..optimiser import Optimiser
from .task import BaseTask

_STREAMS = {"speech": False, "text": False, "pose": True, "face": True}  # statistics by column?
_WRISTS = (3, 6)  # of PATS' joints


class Task(BaseTask):
    kind = "zs_mstm1"
    streams = ("speech", "text", "pose")
    pretrained = ("zs_mstm1",)
    options = {
        # "other": the style clip is of other utterances of the speaker; "same": the segment itself.
        "style_clip": "other",
        "style_segments": 1,
        # Share of the style clips that are heard with the speech and words of any speaker, so that
        # a style is read from the motion and not looked up by the voice.
        "strange_voices": 0.0,
        "velocity": 0.0,        # weight of losses.velocity, beside the thesis' losses
        "behaviour": 0.0,       # of losses.behaviour
        "amount": 0.0,          # of losses.amount
        "fader_step": 0.01,     # lambda's growth a step, and its end; 0: no fader loss
        "fader_maximum": 1.0,
        "fader_moves_style": True,  # eq. 6.7 is of E_content and E_style
        "discriminator": {},    # fields of DiscriminatorConfig
        "dropout": 0.1,         # of the decoder, PyTorch's default
        "teacher_noise": 0.0,   # deviation of what is added to the poses that teach the decoder
        "looking_start": False,  # attention starts as starts.py has it, not as PyTorch draws it
    }

    def __init__(self, configuration, data, device):
        data.need(*self.streams)
        super().__init__(configuration, data, device)
        core = self.core = self.core_of(self.network["config"])
        self.window = core["frames"] * core["context_segments"]
        self.items = sampling.segments(data.select("train"), self.window)
        self._dev, self._speakers = sampling.segments(data.select("dev"), self.window), {}
        self.joints = [n for n, joint in enumerate(self.network.get("joints", []))
                       if joint["source"] in _WRISTS] or list(range(core["d_pose"] // 2))
        self.usual = self._usual_measures()
        self._add_discriminator()

    def core_of(self, config):
        return config

    def d_style(self, config):
        return zs_mstm1.d_style(config)

    def fields(self, given):
        arrays = [self.data.load(u) for u in self.data.select("train")]
        normalisations = [statistics.of(name, (a[name] for a in arrays), _STREAMS[name])
                          for name in self.streams if name in _STREAMS]
        return {"normalisations": normalisations, **given,
                "config": self.with_widths(dict(given.get("config", {})))}

    def with_widths(self, core):
        """The configuration of the core with the widths of the data set."""
        core = {"d_text": self.data.d_text, "ast_content": {}, **core}
        for name in ("ast_content", "ast_style"):
            if name in core:
                core[name] = {"mel_bins": self.data.mel_bins, **core[name]}
        return core

    def initialise(self):
        for module in self.module.modules():
            if isinstance(module, Ast):
                ast.initialise(module)
            elif isinstance(module, torch.nn.Dropout):
                module.p = self.o["dropout"]
            elif isinstance(module, torch.nn.TransformerDecoderLayer):
                module.self_attn.dropout = module.multihead_attn.dropout = self.o["dropout"]
        if self.o["looking_start"]:
            self._start_looking()

    def _start_looking(self):
        starts.attend_to_yourself(self.module.encoders.content_attention)
        for generator, _ in zs_mstm.generators(self.module).values():
            if generator.c["positions"] == "Sinusoidal":
                for n, layer in enumerate(generator.decoder.layers):
                    starts.look_back(layer.self_attn, starts.offsets(n, layer.self_attn.num_heads))

    def take_pretrained(self, states):
        """Begins with the weights of a ZS-MSTM 1.0."""
        own = self.module.weights().state_dict()
        return sum(_copy_beginning(x, own.get(ours)) for key, x in states["zs_mstm1"].items()
                   for ours in self.places_of(key))

    def places_of(self, key):
        """Where a tensor of ZS-MSTM 1.0 is found in this network."""
        return [key]

    def _add_discriminator(self):
        core = self.core
        rows = 1 if core["granularity"] == "Segment" else core["frames"]
        self.dis_network = networks.complete("discriminator", {"config": {
            "rows": rows * core["context_segments"], **self.o["discriminator"],
            "d_content": zs_mstm1.d_content(core),
            "d_style": self.d_style(self.network["config"])}})
        self.dis = reference.new(self.dis_network).float().to(self.device)
        self.dis_optimiser = self.optimiser_of(self.dis.parameters())

    def _usual_measures(self):
        """The mean of losses.measures over the training utterances, (4, 1)."""
        poses = [self.data.load(u)["pose"] for u in {u.id: u for u, _ in self.items}.values()]
        if not poses:
            return torch.ones(4, 1)
        found = [losses.measures(self.tensor(pose)[None], self.joints) for pose in poses]
        return torch.stack(found).mean(0).clamp_min(1.0)

    # ------------------------------------------------------------------------------------- batches

    def batch(self, items, rng):
        """Segments, begun up to half a window earlier or later while training, and style clips:
        (segments {stream: (B, window, columns)}, clips {stream: (B, S, frames, columns)})."""
        if self.module.training:
            items = [(u, self._moved(u, first, rng)) for u, first in items]
        clips = [clip for item in items for clip in self._clips(*item, rng)]
        found = self._take(clips, self.core["frames"])
        if self.module.training and self.o["strange_voices"]:
            found |= self._strangers(found, rng)
        return self._take(items, self.window), {
            name: x.reshape(len(items), -1, *x.shape[1:]) for name, x in found.items()}

    def _strangers(self, clips, rng):
        """Speech and text of `clips`, a share of which are those of other clips of the batch."""
        count = len(clips["pose"])
        own = rng.random(count) >= self.o["strange_voices"]
        source = torch.from_numpy(np.where(own, np.arange(count), rng.permutation(count)))
        return {name: clips[name][source.to(self.device)] for name in ("speech", "text")}

    def _moved(self, utterance, first, rng):
        half = self.window // 2
        return int(rng.integers(max(0, first - half),
                                min(utterance.frames - self.window, first + half) + 1))

    def _clips(self, utterance, first, rng):
        frames = self.core["frames"]
        if self.o["style_clip"] == "same":
            return [(utterance, first)]
        others = [u for u in self._of_speaker(utterance) if u.frames >= frames]
        others = [u for u in others if u.id != utterance.id] or others
        chosen = rng.integers(len(others), size=self.o["style_segments"])
        return [(others[i], int(rng.integers(others[i].frames - frames + 1))) for i in chosen]

    def _of_speaker(self, utterance):
        key = utterance.split, utterance.speaker
        if key not in self._speakers:
            self._speakers[key] = self.data.select(*key)
        return self._speakers[key]

    def _take(self, items, frames):
        taken = sampling.take_segments(self.data, items, frames, self.streams)
        return {name: self.tensor(x) for name, x in taken.items()}

    # -------------------------------------------------------------------------------------- losses

    def run(self, segments, clips):
        """h_content, h_style and the normalised motion {stream: (B, window, columns)}."""
        content = zs_mstm.content(self.module.encoders, segments["speech"], segments["text"])
        style = zs_mstm.style_of_clips(self.module, clips)
        made = {}
        for stream, (generator, dense) in zs_mstm.generators(self.module).items():
            before = getattr(self.module, stream).apply(segments[stream])
            if self.module.training and self.o["teacher_noise"]:
                before = before + self.o["teacher_noise"] * torch.randn_like(before)
            made[stream] = zs_mstm.generate(generator, dense, content, style, before)
        return content, style, made

    def motion_losses(self, made, segments):
        """Eq. 6.4 of every stream, and what the configuration adds; "loss" is their weighted sum."""
        found = {"reconstruction": 0.0, "velocity": 0.0}
        for stream, x in made.items():
            truth = getattr(self.module, stream).apply(segments[stream])
            found["reconstruction"] += losses.squares(x, truth)
            found["velocity"] += losses.velocity(x, truth)
        x, truth = self.module.pose.undo(made["pose"]), segments["pose"]
        found["behaviour"] = losses.behaviour(x, truth, self.joints)
        found["amount"] = losses.amount(x, truth, self.joints, self.usual)
        weighted = (self.o[name] * found[name] for name in ("velocity", "behaviour", "amount"))
        return {"loss": found["reconstruction"] + sum(weighted), **found}

    def step(self, chosen, rng, step):
        """Dis, then the generator: alternately, as Lample et al. 2017."""
        segments, clips = self.batch(chosen, rng)
        content, style, made = self.run(segments, clips)
        target = style.detach()
        error = losses.squares(small.discriminate(self.dis, content.detach()), target)  # eq. 6.6
        self.dis_optimiser.step(error, step)
        found = self.motion_losses(made, segments)
        weight = schedules.fader_weight(step, self.o["fader_step"], self.o["fader_maximum"])
        known = style if self.o["fader_moves_style"] else target
        found["fader"] = losses.fader(known, small.discriminate(self.dis, content),
                                      losses.span_of(target))
        rate = self.optimiser.step(found["loss"] + weight * found["fader"], step)  # eq. 6.8
        return {**{name: float(x) for name, x in found.items()}, "discriminator": float(error),
                "rate": rate}

    def dev_items(self):
        return self._dev

    def losses(self, chosen, rng, _step):
        segments, clips = self.batch(chosen, rng)
        content, style, made = self.run(segments, clips)
        told = small.discriminate(self.dis, content)
        return {**self.motion_losses(made, segments),
                "fader": losses.fader(style, told, losses.span_of(style)),
                "discriminator": losses.squares(told, style)}

    # --------------------------------------------------------------------------------------- state

    def train(self):
        self.module.train()
        self.dis.train()

    def eval(self):
        self.module.eval()
        self.dis.eval()

    def state(self):
        return {**super().state(), "dis": self.dis.weights().state_dict(),
                "dis_optimiser": self.dis_optimiser.state()}

    def load(self, state):
        super().load(state)
        self.dis.weights().load_state_dict(state["dis"])
        self.dis_optimiser.load(state["dis_optimiser"])

    def exports(self):
        state = self.dis.weights().state_dict()
        return [("discriminator", self.dis_network, {k: x.cpu() for k, x in state.items()})]


def _copy_beginning(x, ours):
    """As much of x as `ours` has the place for: a layer that takes more keeps what it began with for
    that.  Nothing, and False, where they differ otherwise."""
    fits = ours is not None and ours.shape[:-1] == x.shape[:-1] and ours.shape[-1] >= x.shape[-1]
    if fits:
        ours[..., :x.shape[-1]].copy_(x)
    return fits

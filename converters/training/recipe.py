"""`demo`: from nothing to the demo's weights file, by the commands that anyone would type.

corpus -> front end (BERT and dialog acts) -> features by the engine -> every model -> one bundle.
"""

import concurrent.futures
import json
import pathlib
import shlex
import shutil
import subprocess
import sys

import numpy as np

from ..errors import ConvertError
from . import engine
from .evidence.material import Material

CONFIGS = pathlib.Path(__file__).resolve().parent / "configs"
ROOT = pathlib.Path(__file__).resolve().parents[2]

# Name in the bundle, its configuration, minutes on one core at most, runs that it begins with.
# The minutes are for slow machines: what is faster ends by its configuration's steps.
MODELS = (
    ("zs_mstm1_start", "demo_zs_mstm1", 70, {}),
    ("model2", "demo_model2", 60, {}),
    ("ae_speech", "demo_ae_speech", 4, {}),
    ("ae_face", "demo_ae_face", 4, {}),
    ("model1", "demo_model1", 12, {"ae_speech": "ae_speech", "ae_face": "ae_face"}),
    ("classifier", "demo_classifier", 4, {}),
    ("zs_mstm2", "demo_zs_mstm2", 35, {"zs_mstm1": "zs_mstm1_start"}),
    ("zs_mstm1", "demo_zs_mstm1_amount", 15, {"zs_mstm1": "zs_mstm1_start"}),
)
_STEPS = ("ae_speech", "ae_face", "zs_mstm1_start")  # others begin with them; not in the bundle
# The bundle is to stay below 12 MB.  Not int8: its rounding from frame to frame shows as jerk.
_NARROW = {"zs_mstm1": "bf16", "zs_mstm2": "bf16"}
_FRONT_END = (("bert", "demo_bert", 12), ("acts", "demo_acts", 3))
# Does it all fit together?  Nobody learns to gesture in three seconds.
_SMOKE_CORPUS = ("--hours", 0.01, "--speakers", 2, "--unseen", 1, "--texts", 400)
_SMOKE_MINUTES = 0.05
_SMOKE_MODELS = ("zs_mstm1_start", "model2", "zs_mstm2", "zs_mstm1")


def add(commands):
    demo = commands.add_parser("demo", help="corpus, front end, features, all demo models, a bundle",
                               description=__doc__)
    demo.add_argument("--infer-cli", required=True, metavar="PATH")
    demo.add_argument("-o", "--output", default="out/train", metavar="FOLDER")
    demo.add_argument("--seed", type=int, default=1)
    demo.add_argument("--hours", type=float, help="of speech, if not as `corpus` has it")
    demo.add_argument("--models", help="names, separated by commas (default: all)")
    demo.add_argument("--jobs", type=int, default=2,
                      help="processes, of one thread each; trainings that need nothing of each "
                           "other go on at once (default %(default)s)")
    demo.add_argument("--smoke", action="store_true",
                      help="minutes of speech and seconds of training, then motion of a held-out "
                           "recording: does it all fit together?")
    demo.add_argument("--resume", action="store_true",
                      help="keep what is there: corpus, features, finished trainings")
    demo.set_defaults(run=_demo)


def _demo(options):
    recipe = Recipe(options)
    recipe.corpus()
    recipe.front_end()
    recipe.features()
    recipe.train(recipe.models, recipe.folder / "data")
    recipe.bundle()
    recipe.styles()
    if options.smoke:
        recipe.held_out()


class Recipe:
    def __init__(self, options):
        self.options, self.folder = options, pathlib.Path(options.output)
        wanted = options.models.split(",") if options.models else (
            _SMOKE_MODELS if options.smoke else [name for name, *_ in MODELS])
        known = {name for name, *_ in MODELS}
        for name in wanted:
            if name not in known:
                raise ConvertError(f"--models: {name}, expected some of {', '.join(sorted(known))}")
        self.models = [model for model in MODELS if model[0] in wanted]
        self.folder.mkdir(parents=True, exist_ok=True)

    def corpus(self):
        size = (_SMOKE_CORPUS if self.options.smoke
                else ("--hours", self.options.hours) if self.options.hours else ())
        self._step("corpus/index.json", "corpus", "-o", self.folder / "corpus", "--seed",
                   self.options.seed, *size, "--jobs", self.options.jobs, "--infer-cli",
                   self.options.infer_cli)

    def front_end(self):
        self.train([(*front_end, {}) for front_end in _FRONT_END], self.folder / "corpus")
        self._step("front_end.fb", "bundle", *(f"{name}={self.folder / name / 'weights.fb'}"
                                               for name, *_ in _FRONT_END),
                   "-o", self.folder / "front_end.fb", module="converters")

    def features(self):
        self._step("data/dataset.json", "prepare", self.folder / "corpus", "--front-end",
                   self.folder / "front_end.fb", "--infer-cli", self.options.infer_cli,
                   "--jobs", self.options.jobs, "-o", self.folder / "data")

    def train(self, models, data):
        """Some at once, in the order of the list, of which a model needs none that comes later."""
        started = {}
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
            for model in models:
                needed = [started[run] for run in model[3].values() if run in started]
                started[model[0]] = pool.submit(self._train, model, data, needed)
            try:
                for future in started.values():
                    future.result()
            except ConvertError:
                pool.shutdown(cancel_futures=True)
                raise

    def _train(self, model, data, needed):
        name, configuration, minutes, pretrained = model
        for future in needed:
            future.result()
        limit = _SMOKE_MINUTES if self.options.smoke else minutes
        self._step(f"{name}/weights.fb", "train", CONFIGS / f"{configuration}.json", "--data", data,
                   "-o", self.folder / name, "--minutes", limit, "--seed", self.options.seed,
                   *(["--resume"] if self.options.resume else []),
                   *(f"--pretrained={key}={self.folder / run}" for key, run in pretrained.items()),
                   prefix=f"{name}: ")

    def bundle(self):
        """Everything in one file, with ZS-MSTM 1.0's discriminator."""
        names = [name for name, *_ in self.models if name not in _STEPS]
        parts = [f"{name}={self._bundled(name)}" for name in names]
        if "zs_mstm1" in names:
            parts.append(f"discriminator={self.folder / 'zs_mstm1' / 'discriminator.fb'}")
        parts += [f"{name}={self.folder / name / 'weights.fb'}" for name, *_ in _FRONT_END]
        self._step(None, "bundle", *parts, "-o", self.folder / "demo.fb", module="converters")

    def _bundled(self, name):
        """The weights file of a network as the bundle takes it."""
        weights = self.folder / name / "weights.fb"
        if name not in _NARROW:
            return weights
        narrow = self.folder / name / f"weights-{_NARROW[name]}.fb"
        self._step(None, "quantise", weights, "--to", _NARROW[name], "--infer-cli",
                   self.options.infer_cli, "-o", narrow, module="converters")
        return narrow

    def styles(self):
        """Those that the demo shows, each for the network that it is shown with."""
        found = Material(self.folder / "corpus", self.folder / "data", self.folder / "demo.fb",
                         self.options.infer_cli, self.folder / "work")
        known = json.loads((self.folder / "corpus" / "index.json").read_text())["speakers"]
        trained = {name for name, *_ in self.models}
        for name, (network, speaker) in shown_speakers(
                {speaker: known[speaker]["style"] for speaker in found.data.speakers("train")}).items():
            if network in trained:
                shutil.copyfile(found.style(speaker, network), self.folder / f"{name}.style")
                print(f"{self.folder / name}.style: of {speaker}")

    def held_out(self):
        """Motion of a recording that no training saw."""
        recording = sorted((self.folder / "corpus").glob("unseen*/*"))[0]
        arrays, _ = engine.arrays_of(self.options.infer_cli, [
            self.folder / "demo.fb", recording / "speech.wav", recording / "words.json",
            "--style", self.folder / "lively.style", "--network", "zs_mstm1"])
        pose = arrays["pose"]
        if not (np.isfinite(pose).all() and pose.std(0).max() > 0):
            raise ConvertError(f"{recording}: {pose.shape} poses that do not move")
        print(f"{recording}: {len(pose)} frames of motion")

    def _step(self, made, *arguments, module="converters.training", prefix=None):
        """Runs a command, unless what it makes is there and may be kept.  With a `prefix` its lines
        begin so, to be told from those of others that run at the same time."""
        if made and self.options.resume and (self.folder / made).exists():
            return
        command = [sys.executable, "-m", module, *map(str, arguments)]
        print("==> " + shlex.join(["python3", *command[1:]]), file=sys.stderr, flush=True)
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT} if prefix else {}
        with subprocess.Popen(command, cwd=ROOT, text=True, **pipes) as running:
            for line in running.stdout or ():
                print(prefix + line, end="", file=sys.stderr, flush=True)
        if running.returncode != 0:
            raise ConvertError(f"python3 -m {module} {arguments[0]}: failed, see above")


def shown_speakers(styles):
    """{style file: (network, speaker)} for the demo, of {speaker: style}: a calm one (the very calmest
    hardly move), the liveliest, and of those that the face shows most the liveliest."""
    order = sorted(styles, key=lambda speaker: liveliness(styles[speaker]))
    faces = sorted(order, key=lambda speaker: styles[speaker]["face"] * styles[speaker]["head"])
    expressive = max(faces[-max(1, len(faces) // 10):], key=order.index)
    return {"calm": ("zs_mstm1", order[len(order) // 20]), "lively": ("zs_mstm1", order[-1]),
            "expressive": ("zs_mstm2", expressive)}


def liveliness(style):
    """How much a speaker of the corpus moves: size and speed of strokes times how often there is
    one."""
    return (style["amplitude"] ** 2 * style["velocity"] * (0.3 + style["frequency"])
            * (2 - abs(style["arms"])))

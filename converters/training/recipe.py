"""`demo`: from nothing to the demo's weights file, by the commands that anyone would type.

corpus -> front end (BERT and dialog acts) -> features by the engine -> every model -> one bundle.
"""

import pathlib
import shlex
import subprocess
import sys

from ..errors import ConvertError

CONFIGS = pathlib.Path(__file__).resolve().parent / "configs"
ROOT = pathlib.Path(__file__).resolve().parents[2]

# Name in the bundle, its configuration, minutes on one core at most, runs that it begins with.
MODELS = (
    ("zs_mstm1", "demo_zs_mstm1", 45, {}),
    ("model2", "demo_model2", 20, {}),
    ("ae_speech", "demo_ae_speech", 2, {}),
    ("ae_face", "demo_ae_face", 2, {}),
    ("model1", "demo_model1", 5, {"ae_speech": "ae_speech", "ae_face": "ae_face"}),
    ("zs_mstm2", "demo_zs_mstm2", 15, {}),
    ("classifier", "demo_classifier", 3, {}),
)
_FRONT_END = (("bert", "demo_bert", 6), ("acts", "demo_acts", 2))
_HOURS, _SMOKE_HOURS = 2.0, 0.03
_SMOKE_MINUTES = 0.05
_SMOKE_MODELS = ("zs_mstm1",)


def add(commands):
    demo = commands.add_parser("demo", help="corpus, front end, features, all demo models, a bundle",
                               description=__doc__)
    demo.add_argument("--infer-cli", required=True, metavar="PATH")
    demo.add_argument("-o", "--output", default="out/train", metavar="FOLDER")
    demo.add_argument("--seed", type=int, default=1)
    demo.add_argument("--hours", type=float, help=f"of speech (default {_HOURS})")
    demo.add_argument("--models", help="names, separated by commas (default: all)")
    demo.add_argument("--smoke", action="store_true",
                      help="a minute of speech and seconds of training: does it all fit together?")
    demo.add_argument("--resume", action="store_true",
                      help="keep what is there: corpus, features, finished trainings")
    demo.set_defaults(run=_demo)


def _demo(options):
    recipe = Recipe(options)
    recipe.corpus()
    recipe.front_end()
    recipe.features()
    for name, configuration, minutes, pretrained in recipe.models:
        recipe.train(name, configuration, minutes, recipe.folder / "data", pretrained)
    recipe.bundle()


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
        hours = self.options.hours or (_SMOKE_HOURS if self.options.smoke else _HOURS)
        self._step("corpus/index.json", "corpus", "-o", self.folder / "corpus", "--seed",
                   self.options.seed, "--hours", hours)

    def front_end(self):
        for name, configuration, minutes in _FRONT_END:
            self.train(name, configuration, minutes, self.folder / "corpus", {})
        self._step("front_end.fb", "bundle", *(f"{name}={self.folder / name / 'weights.fb'}"
                                               for name, *_ in _FRONT_END),
                   "-o", self.folder / "front_end.fb", module="converters")

    def features(self):
        self._step("data/dataset.json", "prepare", self.folder / "corpus", "--front-end",
                   self.folder / "front_end.fb", "--infer-cli", self.options.infer_cli,
                   "-o", self.folder / "data")

    def train(self, name, configuration, minutes, data, pretrained):
        limit = _SMOKE_MINUTES if self.options.smoke else minutes
        self._step(f"{name}/weights.fb", "train", CONFIGS / f"{configuration}.json", "--data", data,
                   "-o", self.folder / name, "--minutes", limit, "--seed", self.options.seed,
                   *(["--resume"] if self.options.resume else []),
                   *(f"--pretrained={key}={self.folder / run}" for key, run in pretrained.items()))

    def bundle(self):
        """Everything in one file, with ZS-MSTM 1.0's discriminator; autoencoders are parts of
        Model 1."""
        names = [name for name, *_ in self.models if not name.startswith("ae_")]
        parts = [f"{name}={self.folder / name / 'weights.fb'}" for name in names]
        if "zs_mstm1" in names:
            parts.append(f"discriminator={self.folder / 'zs_mstm1' / 'discriminator.fb'}")
        self._step(None, "bundle", *parts, self.folder / "front_end.fb", "-o",
                   self.folder / "demo.fb", module="converters")

    def _step(self, made, *arguments, module="converters.training"):
        """Runs a command, unless what it makes is there and may be kept."""
        if made and self.options.resume and (self.folder / made).exists():
            return
        command = [sys.executable, "-m", module, *map(str, arguments)]
        print("==> " + shlex.join(["python3", *command[1:]]), file=sys.stderr, flush=True)
        if subprocess.run(command, cwd=ROOT, check=False).returncode != 0:
            raise ConvertError(f"python3 -m {module} {arguments[0]}: failed, see above")

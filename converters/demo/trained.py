"""The demo: real speech through small trained weights, in the styles of two speakers of the synthetic
corpus (docs/demo-model.md)."""

import numpy as np

from ..errors import ConvertError
from . import recordings, terminal
from .steps import RATE, ROOT, SENTENCE, SPEECH, infer_cli, shown, write_words

WEIGHTS = ROOT / "converters" / "demo" / "weights"
BUNDLE = WEIGHTS / "demo.fb"
# Files beside the bundle, which they belong to: name -> network, what one should see.
STYLES = {"lively": ("zs_mstm1", "large and quick strokes"),
          "calm": ("zs_mstm1", "few, small and slow ones"),
          "expressive": ("zs_mstm2", "the face too, by ZS-MSTM 2.0")}
_DRAWN = ("lively", "calm")  # in the terminal, where a face would be a dot


def demo(options, out):
    if not BUNDLE.is_file():
        raise ConvertError(f"{shown(BUNDLE)}: missing, expected the weights that "
                           "`./run train-demo` makes; --full-size needs none")
    speech = recordings.load(SPEECH)
    words = write_words(speech, out / "speech.json")
    reports = {}
    for name, (network, _) in STYLES.items():
        reports[name] = infer_cli(
            options.infer_cli, BUNDLE, speech.path, "--words", words, "--style",
            WEIGHTS / f"{name}.style", "--network", network, "-o", out / f"{name}.npz", "--fps", 30,
            "--html", out / f"{name}.html", "--svg", out / f"{name}.svg", "--title",
            f"{SENTENCE} ({name})", "--threads", options.threads)
    print()
    for name in _DRAWN:
        print(f"{name}: {STYLES[name][1]}\n")
        print("\n".join(terminal.figures(np.load(out / f"{name}.npz")["pose"], 2 * RATE)))
    print(terminal.level(recordings.loudness(speech.samples, speech.rate)))
    print(SENTENCE + "\n")
    print("The weights are small and were trained on speech of espeak-ng and motion of a parametric\n"
          "gesturer: docs/demo-model.md says what they can and cannot do.  Word times are estimated.\n")
    for name, (_, what) in STYLES.items():
        print(f"watch    {shown(out / name)}.html (open it in a browser): {what}")
    report = reports[_DRAWN[0]]
    print(f"speed    {1000 * report['segment_seconds_median']:.1f} ms a segment of 64 frames "
          f"(4.27 s of speech), {report['threads']} thread, {report['isa']}")

"""The demo: real speech through small trained weights, in the styles of two speakers of the synthetic
corpus (docs/demo-model.md)."""

import numpy as np

from ..errors import ConvertError
from . import recordings, terminal
from .steps import RATE, ROOT, SENTENCE, SPEECH, infer_cli, shown, write_words

WEIGHTS = ROOT / "converters" / "demo" / "weights"
BUNDLE = WEIGHTS / "demo.fb"
# Files beside the bundle, which they belong to: name -> what one should see.
STYLES = {"lively": "large strokes of both arms", "calm": "few and small strokes"}


def demo(options, out):
    if not BUNDLE.is_file():
        raise ConvertError(f"{shown(BUNDLE)}: missing, expected the weights that "
                           "`./run train-demo` makes; --full-size needs none")
    speech = recordings.load(SPEECH)
    words = write_words(speech, out / "speech.json")
    for name in STYLES:
        motion = out / f"{name}.npz"
        report = infer_cli(options.infer_cli, BUNDLE, speech.path, "--words", words, "--style",
                           WEIGHTS / f"{name}.style", "--network", "zs_mstm1", "-o", motion,
                           "--fps", 30, "--html", out / f"{name}.html", "--svg",
                           out / f"{name}.svg", "--title", f"{SENTENCE} ({name})", "--threads",
                           options.threads)
    print()
    poses = {name: np.load(out / f"{name}.npz")["pose"] for name in STYLES}
    for name, what in STYLES.items():
        print(f"{name}: {what}\n")
        print("\n".join(terminal.figures(poses[name], 2 * RATE)))
    print(terminal.level(recordings.loudness(speech.samples, speech.rate)))
    print(SENTENCE + "\n")
    print("The weights are small and were trained on speech of espeak-ng and motion of a parametric\n"
          "gesturer: docs/demo-model.md says what they can and cannot do.  Word times are estimated.\n")
    for name in STYLES:
        print(f"watch    {shown(out / name)}.html (open it in a browser)")
    print(f"speed    {1000 * report['segment_seconds_median']:.1f} ms a segment of 64 frames "
          f"(4.27 s of speech), {report['threads']} thread, {report['isa']}")

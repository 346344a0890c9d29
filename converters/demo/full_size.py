"""`./run demo --full-size`: ZS-MSTM 1.0 with all of its 212 million parameters, which are random, so
the motion is noise; what it shows is the speed."""

import hashlib
import json
import shutil
import string

import numpy as np

from . import recordings, style_clip, terminal
from .steps import CLIP, RATE, ROOT, SENTENCE, SPEECH, converters, infer_cli, say, shown, write_words

UNTRAINED = ("No trained weights of this size are public: these are random, so the motion is noise around "
             "a figure at rest.")


def demo(options, out):
    speech, clip = recordings.load(SPEECH), recordings.load(CLIP)
    words = write_words(speech, out / "speech.json")
    speaker = out / "speaker"
    speaker.mkdir(exist_ok=True)
    shutil.copyfile(clip.path, speaker / "clip.wav")
    write_words(clip, speaker / "clip.json")
    pose = style_clip.synthetic_pose(clip, int(clip.seconds * RATE), RATE)
    style_clip.write_openpose(pose, speaker / "poses")

    weights = random_weights(out)
    motion = out / "motion.npz"
    report = infer_cli(options.infer_cli, weights, speech.path, "--words", words, "--style", speaker,
                       "-o", motion, "--html", out / "motion.html", "--svg", out / "motion.svg",
                       "--title", SENTENCE, "--threads", options.threads)
    report_to_terminal(speech, np.load(motion)["pose"], report, out)


# A BERT of two layers is as good as one of twelve when its weights are random; letters are its pieces.
TOKENS = ["[PAD]", "[UNK]", "[CLS]", "[SEP]", *string.ascii_lowercase, *string.punctuation,
          *("##" + letter for letter in string.ascii_lowercase)]


def random_weights(out):
    """The weights file, made once for each version of what makes it."""
    makers = [ROOT / "engine" / "schema" / "weights.fbs", ROOT / "converters" / "demo" / "full_size.py",
              *(ROOT / "converters" / "kinds").glob("*.py"),
              *(ROOT / "converters" / f"{name}.py" for name in
                ("bundle", "networks", "random_weights", "schema", "shapes", "weights_file"))]
    version = hashlib.sha256(b"".join(path.read_bytes() for path in makers)).hexdigest()[:12]
    path = out / f"untrained-{version}.fb"
    if not path.exists():
        for old in out.glob("untrained-*.fb"):
            old.unlink()
        say("random weights of the full-size network, 212 million, and of a small BERT (once)")
        (out / "vocabulary.txt").write_text("\n".join(TOKENS) + "\n")
        (out / "bert.json").write_text(json.dumps({"layers": 2, "tokens": len(TOKENS)}))
        converters("random", "--no-self-test", "-o", out / "zs_mstm1.fb")
        converters("random", "--no-self-test", "--kind", "bert", "--config", out / "bert.json",
                   "--vocabulary", out / "vocabulary.txt", "-o", out / "bert.fb")
        converters("bundle", out / "zs_mstm1.fb", out / "bert.fb", "-o", path)
        for part in ("zs_mstm1.fb", "bert.fb"):
            (out / part).unlink()
    return path


def report_to_terminal(speech, pose, report, out):
    print()
    print("\n".join(terminal.figures(pose, RATE)))
    print(terminal.level(recordings.loudness(speech.samples, speech.rate)))
    print(SENTENCE + "\n")
    print(UNTRAINED)
    print("BERT is random too, word times are estimated, and the style clip's video is a procedural "
          "wave of the\narms: see converters/demo.\n")
    print(f"watch    {shown(out / 'motion.html')} (open it in a browser)")
    print(f"speed    {1000 * report['segment_seconds_median']:.0f} ms a segment of 64 frames "
          f"(4.27 s of speech), {report['threads']} thread, {report['isa']}")
    print(f"picture  {shown(out / 'motion.svg')}\nmotion   {shown(out / 'motion.npz')}")


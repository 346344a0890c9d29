"""Runs the demo; `./run demo` builds infer-cli and calls this."""

import argparse
import hashlib
import json
import pathlib
import subprocess
import sys

import numpy as np

from .. import features
from ..errors import ConvertError
from . import recordings, sheet, style_clip, terminal

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPEECH, CLIP = "0870", "0890"
SENTENCE = ("“And Mr John Dashwood had then leisure to consider how much there might be prudently in "
            "his power to do for them.”")
RATE = features.FRAME_RATE
UNTRAINED = ("No trained weights are public: these are random, so the motion is noise around a figure "
             "at rest.")


def main():
    parser = argparse.ArgumentParser(prog="./run demo", description=__doc__)
    parser.add_argument("--infer-cli", required=True)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--output", default=str(ROOT / "out" / "demo"), metavar="FOLDER")
    options = parser.parse_args()
    out = pathlib.Path(options.output)
    out.mkdir(parents=True, exist_ok=True)
    try:
        demo(options, out)
    except ConvertError as error:
        sys.exit(f"demo: {error}")
    except subprocess.CalledProcessError as error:
        sys.exit(f"demo: {shown(error.cmd[0])} failed")


def demo(options, out):
    say("features of real speech, and of another recording as the style clip")
    speech, clip = recordings.load(SPEECH), recordings.load(CLIP)
    arrays = stream_arrays(speech)
    np.savez(out / "speech.npz", **arrays)
    clip_arrays = stream_arrays(clip)
    clip_arrays["pose"] = style_clip.synthetic_pose(clip, len(clip_arrays["speech"]), RATE)
    np.savez(out / "clip.npz", **clip_arrays)

    weights = random_weights(out)
    command = [options.infer_cli, weights, out / "speech.npz", "--style", out / "clip.npz",
               "-o", out / "motion.npz", "--threads", options.threads, "--json"]
    say(" ".join(map(shown, command)))
    done = subprocess.run([str(c) for c in command], check=True, stdout=subprocess.PIPE, text=True)
    report = json.loads(done.stdout)
    pose = np.load(out / "motion.npz")["pose"]

    svg = sheet.Sheet(arrays["speech"], pose, speech.words, RATE).render(
        SENTENCE,
        f"ZS-MSTM 1.0 at full size, {len(pose)} frames at {RATE:g} a second. " + UNTRAINED,
        "Speech: LibriVox, public domain; its log-mel spectrogram and words (times estimated). "
        "Below, the pose every 0.4 s and the path of the wrists since the last one.")
    (out / "motion.svg").write_text(svg, encoding="utf-8")
    report_to_terminal(speech, pose, report, out)


def say(text):
    print(f"==> {text}", flush=True)


def shown(path):
    """A path as one would type it here."""
    path = pathlib.Path(str(path))
    return str(path.relative_to(ROOT)) if path.is_absolute() and ROOT in path.parents else str(path)


def stream_arrays(recording):
    """What the network takes of a recording: log-mel and word vectors, a row a frame."""
    mel = features.speech_frames(recording.samples, recording.rate)
    words, starts, _ = zip(*recording.words)
    return {"speech": mel, "text": features.text_frames(words, starts, len(mel))}


def random_weights(out):
    """The weights file, made once for each version of what makes it."""
    makers = [ROOT / "engine" / "schema" / "weights.fbs",
              *(ROOT / "converters" / f"{name}.py" for name in
                ("networks", "random_weights", "schema", "shapes", "weights_file"))]
    version = hashlib.sha256(b"".join(path.read_bytes() for path in makers)).hexdigest()[:12]
    path = out / f"untrained-{version}.fb"
    if not path.exists():
        for old in out.glob("untrained-*.fb"):
            old.unlink()
        say("random weights of the full-size network, 212 million (once)")
        subprocess.run([sys.executable, "-m", "converters", "random", "--no-self-test", "-o",
                        str(path)], check=True, cwd=ROOT)
    return path


def report_to_terminal(speech, pose, report, out):
    print()
    print("\n".join(terminal.figures(pose, RATE)))
    print(terminal.level(recordings.loudness(speech.samples, speech.rate)))
    print(SENTENCE + "\n")
    print(UNTRAINED)
    print("Word vectors are hashes of the words (no BERT here), word times are estimated, and the "
          "style clip's\npose is a procedural wave of the arms: see converters/demo.\n")
    print(f"speed    {1000 * report['segment_seconds_median']:.0f} ms a segment of 64 frames "
          f"(4.27 s of speech), {report['threads']} thread, {report['isa']}")
    print(f"picture  {shown(out / 'motion.svg')}\nmotion   {shown(out / 'motion.npz')}")


if __name__ == "__main__":
    main()

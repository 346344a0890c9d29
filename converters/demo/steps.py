"""What both demos are made of: recordings with words, calls of infer-cli and of the converters."""

import json
import pathlib
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPEECH, CLIP = "0870", "0890"
SENTENCE = ("“And Mr John Dashwood had then leisure to consider how much there might be prudently in "
            "his power to do for them.”")
RATE = 15.0  # motion frames per second


def infer_cli(*command):
    """Shows and runs a command; returns its report."""
    say(" ".join(shlex.quote(shown(part)) for part in command))
    done = subprocess.run([*map(str, command), "--json"], check=True, stdout=subprocess.PIPE,
                          text=True)
    return json.loads(done.stdout)


def converters(*arguments):
    subprocess.run([sys.executable, "-m", "converters", *map(str, arguments)], check=True, cwd=ROOT)


def write_words(recording, path):
    """The transcript as a list of words with their times, one of the forms that infer-cli reads."""
    words = [{"word": word, "start": round(start, 3), "end": round(end, 3)}
             for word, start, end in recording.words]
    path.write_text(json.dumps({"words": words}, indent=1))
    return path


def say(text):
    print(f"==> {text}", flush=True)


def shown(path):
    """A path as one would type it here."""
    path = pathlib.Path(str(path))
    return str(path.relative_to(ROOT)) if path.is_absolute() and ROOT in path.parents else str(path)

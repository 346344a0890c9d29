"""Makes what the tests of the player show: tiny untrained networks with the joints, landmarks and
channels of the real ones, a spoken sentence with its words, and a filmed speaker.

usage: player_data.py INFER_CLI FOLDER    writes FOLDER/body.html, compare.html, silent.html
                                        and head.html
"""
import json
import pathlib
import subprocess
import sys
import wave

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from converters.demo import style_clip  # noqa: E402
from converters.kinds import zs_mstm2  # noqa: E402
from converters.kinds.zs_mstm2 import FACE  # noqa: E402

AST = {"d_model": 16, "heads": 2, "layers": 1, "d_mlp": 16, "d_out": 8, "frames": 16}
ZS_MSTM2 = {"core": {"frames": 16, "d_text": 8, "d_model": 16, "lstm_hidden": 8, "lstm_layers": 1,
                     "attention_heads": 2, "decoder_ff": 16, "ast_content": AST, "ast_style": AST}}
MODEL2_WORDS = "And Mr John Dashwood had then <b>leisure</b> to “consider” שלום how much 🙂".split()
RATE = 16000


class Sentence:
    """Syllables of a synthetic voice, a word each; what converters.demo.style_clip takes."""

    def __init__(self, words, seconds):
        at = np.arange(int(seconds * RATE)) / RATE
        each = seconds / (len(words) + 1)
        self.words = [(word, (i + 0.5) * each, (i + 1.4) * each) for i, word in enumerate(words)]
        f0 = 140 + 40 * np.sin(2 * np.pi * 0.7 * at)
        phase = 2 * np.pi * np.cumsum(f0) / RATE
        voice = sum(np.sin(k * phase) / k for k in range(1, 12))
        level = np.zeros_like(at)
        for _, start, end in self.words:
            inside = (at >= start) & (at < end)
            level[inside] = np.sin(np.pi * (at[inside] - start) / (end - start)) ** 2
        self.samples = (0.25 * voice * level).astype(np.float32)
        self.rate, self.seconds = RATE, seconds

    def write(self, folder, name):
        folder.mkdir(parents=True, exist_ok=True)
        with wave.open(str(folder / f"{name}.wav"), "wb") as file:
            file.setnchannels(1)
            file.setsampwidth(2)
            file.setframerate(RATE)
            file.writeframes((32767 * np.clip(self.samples, -1, 1)).astype("<i2").tobytes())
        words = [{"word": word, "start": start, "end": end} for word, start, end in self.words]
        (folder / f"{name}.json").write_text(json.dumps({"words": words}), encoding="utf-8")


def random_network(folder, kind, config):
    path = folder / f"{kind}.fb"
    (folder / f"{kind}.json").write_text(json.dumps(config))
    converters("random", "--kind", kind, "--no-self-test", "--config", folder / f"{kind}.json", "-o",
               path)
    return path


def converters(*arguments):
    subprocess.run([sys.executable, "-m", "converters", *map(str, arguments)], check=True, cwd=ROOT,
                   stdout=subprocess.DEVNULL)


def infer(infer_cli, *arguments):
    subprocess.run([infer_cli, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def face_at_rest(frames):
    return np.tile(np.array(FACE["mean"], np.float32), (frames, 1))


def make(infer_cli, folder):
    folder = pathlib.Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    speech = Sentence(MODEL2_WORDS, 6.4)
    speech.write(folder / "talk", "sentence")
    clip = Sentence(MODEL2_WORDS[:8], 4.4)
    for name, of in (("source", speech), ("target", clip)):
        shown = style_clip.synthetic_pose(of, int(of.seconds * 15), 15.0)
        np.savez(folder / f"{name}.npz", pose=shown, face=face_at_rest(len(shown)))
    body = random_network(folder, "zs_mstm2", {**ZS_MSTM2, **zs_mstm2.KIND.demo()})
    style = folder / "style.npz"
    converters("example", body, "-o", style)
    head = random_network(folder, "model1", {"d_text": 8, "ae_hidden": 8, "hidden1": 8, "hidden2": 8})
    talk = folder / "talk"
    common = (body, talk, "--style", style, "-o", folder / "out.npz", "--html")
    infer(infer_cli, *common, folder / "body.html")
    infer(infer_cli, *common, folder / "compare.html", "--source", folder / "source.npz",
          "--target", folder / "target.npz")
    infer(infer_cli, body, style, "-o", folder / "out.npz", "--html", folder / "silent.html")
    infer(infer_cli, head, talk, "-o", folder / "head.npz", "--html", folder / "head.html")
    return folder


if __name__ == "__main__":
    make(sys.argv[1], sys.argv[2])

"""Makes the folder of recordings: voices, texts, sound, and the motion of each speaker's style.

corpus/index.json              speakers with voice and style, utterances with their split
corpus/texts.tsv               sentences with their acts, for BERT and the classifier
corpus/SPEAKER/UTTERANCE/      speech.wav words.json utterance.json prosody.npz pose.npz face.csv
"""

import concurrent.futures
import dataclasses
import json
import pathlib
import wave

import numpy as np

from .. import engine
from . import gesture, prosody, speech, style, texts

_SECONDS = 16.8  # an utterance of Plan.words lasts about so long
_DEV, _TEST = 0.08, 0.12  # shares of a seen speaker's utterances


@dataclasses.dataclass(frozen=True)
class Plan:
    """What is to be made; the same plan makes the same corpus."""
    seed: int = 1
    hours: float = 8.4
    speakers: int = 240
    unseen: int = 16
    texts: int = 12000
    fewest: int = 4  # utterances of a speaker
    words: tuple = (26, 46)  # of an utterance, at least so many


def people(plan):
    """{speaker: (Voice, Style, splits of its utterances)}"""
    found = {}
    total = plan.speakers + plan.unseen
    each = max(plan.fewest, round(plan.hours * 3600 / _SECONDS / total))
    for unseen, count in ((False, plan.speakers), (True, plan.unseen)):
        rng = np.random.default_rng([plan.seed, unseen])
        voices = style.draw_voices(count, rng, unseen)
        styles = style.draw_styles(count, np.random.default_rng([plan.seed, 2 + unseen]))
        for n, (voice, motion) in enumerate(zip(voices, styles)):
            name = f"{'unseen' if unseen else 'speaker'}{n + 1:02d}"
            found[name] = voice, motion, ["unseen"] * each if unseen else _splits(each)
    return found


def _splits(count):
    dev, test = max(1, round(count * _DEV)), max(1, round(count * _TEST))
    return ["train"] * (count - dev - test) + ["dev"] * dev + ["test"] * test


def make(folder, plan, infer_cli, jobs=1, say=lambda line: None):
    """Writes the corpus; `say` gets a line after each speaker."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng([plan.seed, 9])
    texts.write_tsv(folder / "texts.tsv", texts.sample(plan.texts, rng))
    speakers = people(plan)
    work = [(folder, plan, n, name, *speakers[name], infer_cli)
            for n, name in enumerate(speakers)]
    entries = []
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        for made in pool.map(_speaker, work):
            entries += made
            say(f"{made[0]['speaker']}: {len(made)} utterances, "
                f"{sum(entry['seconds'] for entry in made):.0f} s")
    index = {"version": 1, "plan": dataclasses.asdict(plan),
             "speakers": {name: {"voice": style.fields(voice), "style": style.fields(motion)}
                          for name, (voice, motion, _) in speakers.items()},
             "utterances": entries}
    (folder / "index.json").write_text(json.dumps(index, indent=1) + "\n")
    return index


def _speaker(work):
    """Entries of a speaker's utterances, all of which one process of espeak-ng reads in order."""
    folder, plan, number, name, voice, motion, splits, infer_cli = work
    rng = np.random.default_rng([plan.seed, 10, number])
    entries = []
    with speech.Reader(voice) as reader:
        for n, split in enumerate(splits):
            identity = f"{name}-{n + 1:03d}"
            sentences = texts.monologue(split, rng, int(rng.integers(*plan.words)))
            samples, times = reader.read(sentences, rng)
            at = folder / name / identity
            at.mkdir(parents=True, exist_ok=True)
            chance = int(rng.integers(2**31))
            _write_speech(at, samples, sentences, times, chance)
            _write_prosody(at, samples, infer_cli)
            _write_motion(at, motion)
            entries.append({"id": identity, "speaker": name, "split": split,
                            "seconds": round(len(samples) / speech.RATE, 3)})
    return entries


def _write_speech(at, samples, sentences, times, chance):
    with wave.open(str(at / "speech.wav"), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(speech.RATE)
        file.writeframes((samples * 32767).astype("<i2").tobytes())
    words, spoken = [], []
    for sentence, spans in zip(sentences, times):
        spoken.append({"act": sentence.act, "first": len(words), "words": len(spans)})
        words += [{"word": word, "start": round(a, 5), "end": round(b, 5), "emphasis": emphasis}
                  for (word, emphasis), (a, b) in zip(sentence.words, spans)]
    transcript = [{key: word[key] for key in ("word", "start", "end")} for word in words]
    (at / "words.json").write_text(json.dumps({"words": transcript}, indent=0) + "\n")
    (at / "utterance.json").write_text(json.dumps(
        {"seconds": len(samples) / speech.RATE, "seed": chance, "sentences": spoken,
         "words": words}, indent=0) + "\n")


def _write_prosody(at, samples, infer_cli):
    f0 = engine.arrays_of(infer_cli, ["features", at / "speech.wav"])[0]["pitch"]
    level = prosody.loudness(samples.astype(np.float64), speech.RATE)
    np.savez(at / "prosody.npz", f0=f0, loudness=level.astype(np.float32))


def load(at):
    """(words, sentences, Prosody, seconds, seed) of an utterance's folder, for gesture()."""
    at = pathlib.Path(at)
    stored = json.loads((at / "utterance.json").read_text())
    words = [(w["word"], w["start"], w["end"], w["emphasis"]) for w in stored["words"]]
    sentences = []
    for s in stored["sentences"]:
        part = words[s["first"]:s["first"] + s["words"]]
        sentences.append((s["act"], part[0][1], part[-1][2]))
    with np.load(at / "prosody.npz") as file:
        spans = [(start, end) for _, start, end, _ in words]
        heard = prosody.hear(file["f0"], file["loudness"], spans, prosody.units_of(spans))
    return words, sentences, heard, stored["seconds"], stored["seed"]


def transfer(folder, utterance, speaker):
    """The truth of a transfer: what `utterance` ("SPEAKER/ID") looks like in the style of another
    speaker of the corpus at `folder`; {"pose", "face", "au", "strokes"}."""
    folder = pathlib.Path(folder)
    index = json.loads((folder / "index.json").read_text())
    motion = style.Style(**index["speakers"][speaker]["style"])
    words, sentences, heard, seconds, seed = load(folder / utterance)
    return gesture.gesture(words, sentences, heard, seconds, motion, seed)


def _write_motion(at, motion):
    words, sentences, heard, seconds, seed = load(at)
    made = gesture.gesture(words, sentences, heard, seconds, motion, seed)
    np.savez(at / "pose.npz", pose=made["pose"], face=made["face"])
    _write_face(at / "face.csv", made["au"])


def _write_face(path, au):
    """A CSV as OpenFace writes it, with the columns that are known."""
    names = ["frame", "face_id", "timestamp", "confidence", "success", "pose_Rx", "pose_Ry",
             "pose_Rz", "AU01_r", "AU02_r", "AU04_r", "AU05_r", "AU06_r", "AU07_r"]
    lines = [", ".join(names)]
    for n, row in enumerate(au):
        values = [f"{x:.3f}" for x in row[6:]] + [f"{x:.2f}" for x in row[:6]]
        lines.append(", ".join([str(n + 1), "0", f"{n / gesture.FACE_RATE:.3f}", "0.98", "1",
                                *values]))
    path.write_text("\n".join(lines) + "\n")

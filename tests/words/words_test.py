"""The words front end against Python's own readers and writers: random transcripts written by the
json and csv modules and by hand, real files where they are at hand, words on frames by the rules of
PATS, and numbers under a locale with a decimal comma.

usage: words_test.py WORDS_PROBE [unittest arguments]
Real files are looked for in $GESTUS_SHARED_DATA, else in shared/data beside the source tree.
"""
import csv
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROBE = pathlib.Path(sys.argv.pop(1)).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("GESTUS_SHARED_DATA", ROOT.parent / "shared" / "data"))
LETTERS = "abcxyzABC" + "äöüß" + "дом" + "שלום" + "👍🏽" + "é" + "'&%+="


class Transcript:

    def __init__(self, text):
        self.notes, self.words = [], []
        for line in text.splitlines():
            kind, _, rest = line.partition(" ")
            if kind == "word":
                word, start, end, timed = rest.split(" ")
                self.words.append((bytes.fromhex(word).decode("utf-8"), float(start), float(end),
                                   timed == "1"))
            elif kind == "note":
                self.notes.append(rest)
            else:
                setattr(self, kind, rest)


class WordsTest(unittest.TestCase):

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.random = random.Random(20180611)

    def write(self, content):
        path = self.folder / "transcript"
        path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
        return path

    def read(self, path, **environment):
        result = subprocess.run([PROBE, "read", path], capture_output=True, check=False,
                                env={**os.environ, **environment})
        self.assertEqual(result.returncode, 0, result.stderr)
        return Transcript(result.stdout.decode("utf-8"))

    def words(self, count=50, digits=3):
        """Random words (text, start, end) in order, with and without silences between them."""
        made, at = [], self.random.randrange(1000) / 1000
        for _ in range(count):
            text = "w" + "".join(self.random.choices(LETTERS, k=self.random.randrange(9)))
            start = round(at + self.random.choice([0, 0, 0.05, 0.7]), digits)
            end = round(start + self.random.randrange(20, 900) / 1000, digits)
            made.append((text, start, end))
            at = end
        return made

    def check(self, content, want, tolerance=0.0, **environment):
        got = self.read(self.write(content), **environment)
        self.assertEqual([w[0] for w in got.words], [w[0] for w in want])
        for one, other in zip(got.words, want):
            self.assertAlmostEqual(one[1], other[1], delta=tolerance)
            self.assertAlmostEqual(one[2], other[2], delta=tolerance)
        return got

    def test_json_of_whisper(self):
        for indent in (None, 2):
            for ascii_only in (False, True):
                words = self.words()
                segments = [{"id": i, "start": chunk[0][1], "end": chunk[-1][2], "text": "not used",
                             "words": [{"word": w, "start": s, "end": e, "score": 0.5}
                                       for w, s, e in chunk]}
                            for i, chunk in enumerate(words[k:k + 7] for k in range(0, 50, 7))]
                text = json.dumps({"segments": segments, "word_segments": []}, indent=indent,
                                  ensure_ascii=ascii_only)
                self.assertEqual(self.check(text, words).format, "WhisperX JSON")
                for segment in segments:
                    for word in segment["words"]:
                        word["word"] = " " + word["word"]
                        word["probability"] = word.pop("score")
                text = json.dumps({"segments": segments}, indent=indent, ensure_ascii=ascii_only)
                self.assertEqual(self.check(text, words).format, "openai-whisper JSON")

    def test_json_of_google(self):
        words = self.words()
        listed = [{"alternatives": [{"words": [
            {"start_time": f"{s:.3f}s", "end_time": f"{e:.3f}s", "word": w} for w, s, e in words]}]}]
        self.check(json.dumps(listed), words)
        split = [{"word": w, "startTime": {"seconds": str(int(s)), "nanos": round(s % 1 * 1e9)},
                  "endTime": {"seconds": int(e), "nanos": round(e % 1 * 1e9)}} for w, s, e in words]
        self.check(json.dumps({"results": [{"alternatives": [{"words": split}]}]}), words, 1e-9)

    def test_json_of_whisper_cpp(self):
        words = self.words()
        tokens = []
        for w, s, e in words:
            # A word in up to three tokens that share its time.
            cuts = sorted({0, len(w), *(self.random.randrange(1, len(w) + 1) for _ in range(2))})
            for a, b in zip(cuts, cuts[1:]):
                tokens.append({"text": (" " if a == 0 else "") + w[a:b], "offsets": {
                    "from": round((s + (e - s) * a / len(w)) * 1000),
                    "to": round((s + (e - s) * b / len(w)) * 1000)}})
        document = {"transcription": [{"text": "", "offsets": {"from": 0, "to": 1}, "tokens": tokens}]}
        self.check(json.dumps(document), words, 1e-9)

    def test_tables(self):
        for separator in ",;\t":
            for quoting in (csv.QUOTE_MINIMAL, csv.QUOTE_ALL):
                for columns in (("word", "start", "end"), ("End", "Text", "Begin"),
                                ("start_time", "end_time", "token")):
                    words = [(w + self.random.choice(["", ",x", ";", '"', '"x"']), s, e)
                             for w, s, e in self.words()]
                    path = self.folder / "table"
                    with open(path, "w", newline="", encoding="utf-8") as file:
                        writer = csv.writer(file, delimiter=separator, quoting=quoting)
                        writer.writerow(columns)
                        for w, s, e in words:
                            cells = {"word": w, "text": w, "token": w, "start": s, "begin": s,
                                     "start_time": s, "end": e, "end_time": e}
                            writer.writerow([cells[c.lower()] for c in columns])
                    self.check(path.read_bytes(), words)

    def test_textgrids(self):
        words = [(w + '"' * self.random.randrange(2), s, e) for w, s, e in self.words()]
        rows, at = [], 0.0
        for w, s, e in words:
            if s > at:
                rows.append((at, s, ""))
            rows.append((s, e, w))
            at = e
        quoted = [(a, b, '"' + t.replace('"', '""') + '"') for a, b, t in rows]
        head = 'File type = "ooTextFile"\nObject class = "TextGrid"\n\n'
        short = head + f'0\n{at}\n<exists>\n1\n"IntervalTier"\n"words"\n0\n{at}\n{len(rows)}\n'
        short += "".join(f"{a}\n{b}\n{t}\n" for a, b, t in quoted)
        long = head + f"xmin = 0 \nxmax = {at} \ntiers? <exists> \nsize = 1 \nitem []: \n"
        long += f'    item [1]:\n        class = "IntervalTier" \n        name = "words" \n'
        long += f"        xmin = 0 \n        xmax = {at} \n        intervals: size = {len(rows)} \n"
        for i, (a, b, t) in enumerate(quoted, 1):
            long += f"        intervals [{i}]:\n            xmin = {a} \n            xmax = {b} \n"
            long += f"            text = {t} \n"
        for text in (short, long):
            for encoding in ("utf-8", "utf-8-sig", "utf-16"):
                self.check(text.encode(encoding), words)

    def test_lines(self):
        words = self.words()
        self.check("".join(f"{s} {e} {w}\n" for w, s, e in words), words)
        self.check("".join(f"{s:.6f}\t{e:.6f}\t{w}\r\n" for w, s, e in words), words)
        self.check("".join(f"talk 1 {s} {e - s:.3f} {w} 0.9\n" for w, s, e in words), words, 1e-9)

    def test_subtitles_of_one_word(self):
        def clock(t, point):
            ms = round(t * 1000)
            return f"{ms // 3600000:02}:{ms // 60000 % 60:02}:{ms // 1000 % 60:02}{point}{ms % 1000:03}"

        def escape(text):
            return text.replace("&", "&amp;")

        words = [(w, s + 3590, e + 3590) for w, s, e in self.words()]
        srt = "".join(f"{i}\n{clock(s, ',')} --> {clock(e, ',')}\n{escape(w)}\n\n"
                      for i, (w, s, e) in enumerate(words, 1))
        vtt = "WEBVTT\n\n" + "".join(f"{clock(s, '.')} --> {clock(e, '.')} line:0\n{escape(w)}\n\n"
                                     for w, s, e in words)
        self.check(srt, words, 1e-9)
        self.check(vtt, words, 1e-9)

    def test_missing_times(self):
        for _ in range(20):
            words = self.words()
            lost = sorted(self.random.sample(range(1, 49), 12))
            entries = [{"word": w} if i in lost else {"word": w, "start": s, "end": e}
                       for i, (w, s, e) in enumerate(words)]
            want = list(words)
            for i in lost:
                first, last = i, i
                while first - 1 in lost:
                    first -= 1
                while last + 1 in lost:
                    last += 1
                start, end = words[first - 1][2], words[last + 1][1]
                length = [len(words[k][0]) for k in range(first, last + 1)]
                before, total = sum(length[:i - first]), sum(length)
                step = (end - start) / total
                want[i] = (words[i][0], start + step * before,
                           start + step * (before + len(words[i][0])))
            got = self.check(json.dumps({"words": entries}), want, 1e-9)
            self.assertEqual([i for i, w in enumerate(got.words) if not w[3]], lost)

    def test_decimal_comma(self):
        if shutil.which("localedef") is None:
            self.skipTest("no localedef")
        made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8",
                               self.folder / "de_DE.UTF-8"], capture_output=True, check=False)
        if not (self.folder / "de_DE.UTF-8").is_dir():
            self.skipTest(f"no de_DE: {made.stderr[:200]}")
        german = {"LC_ALL": "de_DE.UTF-8", "LOCPATH": str(self.folder)}
        words = self.words()
        lines = "".join(f"{s} {e} {w}\n" for w, s, e in words)
        listed = json.dumps([{"word": w, "start": s, "end": e} for w, s, e in words])
        for content in (lines, listed, lines.replace(".", ",")):
            self.assertEqual(self.check(content, words, **german).point, ",")

    def frames_by_pats(self, words, start, frames, by_end):
        """chahuja/mix-stage src/data/text.py, its rules in other words."""
        end = start + frames / 15
        kept = [i for i, (s, e, n) in enumerate(words) if n > 0 and
                ((start < e <= end) if by_end else (s < end and e > start))]
        begins = [0] + [max(0, min(int((words[i][0] - start) * 15), frames)) for i in kept[1:]]
        at = [(-1, -1)] * frames
        for k, i in enumerate(kept):
            stop = begins[k + 1] if k + 1 < len(kept) else frames
            duration, pieces = stop - begins[k], words[i][2]
            lengths = [int(duration / pieces)] * pieces
            lengths[-1] = duration - sum(lengths[:-1])
            f = begins[k]
            for piece, length in enumerate(lengths):
                at[f:f + length] = [(i, piece)] * length
                f += length
        return at

    def test_frames(self):
        for _ in range(150):
            words = [(s, e, self.random.randrange(5)) for _, s, e in self.words(30, 2)]
            start = self.random.choice([0, 0.37, 3.3, 7])
            frames = self.random.choice([0, 1, 15, 64, 200, 400])
            by_end = self.random.randrange(2)
            path = self.write("".join(f"{s} {e} {n}\n" for s, e, n in words))
            result = subprocess.run(
                [PROBE, "frames", path, str(start), str(frames), str(by_end)],
                capture_output=True, check=True, text=True)
            got = [tuple(map(int, line.split())) for line in result.stdout.splitlines()]
            self.assertEqual(got, self.frames_by_pats(words, start, frames, by_end))

    def test_real_google_file(self):
        path = DATA / "gesticulator_demo" / "jeremy_howard.json"
        if not path.is_file():
            self.skipTest(f"{path} is not there")
        want = [(w["word"], float(w["start_time"][:-1]), float(w["end_time"][:-1]))
                for result in json.loads(path.read_text(encoding="utf-8"))
                for w in result["alternatives"][0]["words"]]
        got = self.check(path.read_bytes(), want)
        self.assertEqual((len(got.words), got.notes), (77, []))

    def test_real_textgrid(self):
        path = DATA / "mfa_acoustic_corpus" / "acoustic_corpus.TextGrid"
        if not path.is_file():
            self.skipTest(f"{path} is not there")
        tier = path.read_text(encoding="utf-8").split('"words"', 1)[1].split('"IntervalTier"')[0]
        entries = re.findall(r'^([\d.]+)\n([\d.]+)\n"(.*)"$', tier, re.M)
        want = [(t, float(a), float(b)) for a, b, t in entries if t not in ("", "sil", "sp", "spn")]
        got = self.check(path.read_bytes(), want)
        self.assertGreater(len(want), 50)
        self.assertEqual(got.notes, [])


if __name__ == "__main__":
    unittest.main()

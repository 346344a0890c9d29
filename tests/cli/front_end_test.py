"""infer-cli from recordings, words and poses to motion.

front_end_test.py INFER_CLI GOLDENS [unittest arguments]
"""

import os
import shutil
import unittest

import numpy as np

from cli_harness import ROOT
from recordings import WORDS, FrontEndTest, lines, voice, wav


class SpeechTest(FrontEndTest):

    def test_recording_words_and_style(self):
        talker, speaker = self.talker("zs1", "bert"), self.write_speaker()
        report = self.report(talker[0], "talk.wav", "--words", "talk.txt", "--style", speaker,
                             "-o", "out.npz")
        out = self.load("out.npz")
        self.assertEqual(out["pose"].shape, (60, 6))
        self.assertEqual(report["kind"], "ZS-MSTM 1.0")
        self.assertEqual(report["frames"], 60)
        self.assertEqual(report["frame_rate"], 15)
        self.assertEqual(report["input"], "talk.wav")
        self.assert_says(report["used"], "talk.wav: 4.00 s, 8000 Hz -> speech, 60 frames",
                         "talk.txt: lines of start, end and word, 9 words -> text")
        self.assert_says(report["style_used"], "anna/anna.wav: 3.00 s", "45 frames -> style_pose")
        self.assert_says(report["notes"], "style: ", "anna/README.md was not used")
        self.good(*talker, "talk.wav", "talk.txt", "-o", "other.npz")
        self.assertFalse(np.array_equal(out["pose"], self.load("other.npz")["pose"]))

    def test_order_of_inputs_does_not_matter(self):
        talker = self.talker("zs1", "bert")
        self.good(*talker, "talk.wav", "talk.txt", "-o", "1.npz")
        for arguments in (["talk.txt", "talk.wav"], ["talk.wav", "--words", "talk.txt"],
                          ["--words", "talk.txt", "talk.wav"]):
            self.good(*talker, *arguments, "-o", "2.npz")
            self.assert_same(self.load("2.npz"), self.load("1.npz"))

    def test_a_folder_stands_for_its_files(self):
        talker = self.talker("zs1", "bert")
        self.good(*talker, "talk.wav", "talk.txt", "-o", "1.npz")
        self.write("talk/a.wav", wav(voice(4, 8000), 8000))
        self.write("talk/b.srt.txt", lines(WORDS))
        self.write("talk/notes.txt", b"Hello there, how are you\n")
        report = self.report(*talker, "talk/", "-o", "2.npz")
        self.assert_same(self.load("2.npz"), self.load("1.npz"))
        self.assert_says(report["notes"], "talk/notes.txt was not used")
        self.good(*talker, "talk")
        self.assertIn("talk.out.npz", self.listing())

    def test_what_is_absent_is_told(self):
        talker = self.talker("zs1", "bert")
        report = self.report(*talker, "talk.wav", "-o", "1.npz")
        self.assert_says(report["notes"], "text: no words, zeros stand for it")
        report = self.report(*talker, "talk.txt", "-o", "2.npz")
        self.assertEqual(self.load("2.npz")["pose"].shape, (54, 6))  # 3.6 s
        self.assert_says(report["notes"],
                         "speech: no recording, the mean of its statistics stands for it")
        report = self.report(*self.talker("zs1"), "talk.wav", "talk.txt", "-o", "3.npz")
        self.assert_says(report["notes"], "the weights file has no BERT for the words")
        self.assert_same(self.load("3.npz"), self.load("1.npz"))

    def test_plain_text_is_spread_over_the_recording(self):
        talker = self.talker("zs1", "bert")
        self.write("plain.txt", "Hello there, how are you? \U0001f44b".encode())
        text = self.good(*talker, "talk.wav", "plain.txt", "-o", "1.npz")
        self.assertIn("plain text, 6 words", text)
        self.assertIn("spread over the 4.00 s of the recording", text)
        report = self.report(*talker, "--words", "plain.txt", "-o", "2.npz")
        self.assert_says(report["notes"], "15 characters a second")
        self.assertEqual(self.load("2.npz")["pose"].shape[0], 27)  # 27 characters

    def test_features_fed_back_give_the_same(self):
        for names in (("zs1", "bert"), ("model1", "bert"), ("model2", "bert"), ("ast",), ("bank",)):
            weights = (self.talker if names[0] == "zs1" else self.weights)(*names)
            weights = [weights] if isinstance(weights, str) else weights
            words = ["talk.txt"] if len(names) > 1 else []
            network = ["--network", names[0]] if len(names) > 1 else []
            self.good(*weights, "talk.wav", *words, "-o", "1.npz", *network)
            self.good("features", weights[0], "talk.wav", *words, "-o", "f.npz", *network)
            self.good(*weights, "f.npz", "-o", "2.npz", *network)
            want = self.load("1.npz")
            want.pop("times_ms", None)  # which arrays do not tell
            self.assertEqual(sorted(self.load("2.npz")), sorted(want))
            self.assert_same(self.load("2.npz"), want)

    def test_arrays_in_the_mix_come_first(self):
        talker = self.talker("zs1", "bert")
        self.good("features", talker[0], "talk.wav", "talk.txt", "-o", "f.npz")
        text = self.load("f.npz")["text"]
        self.good(*talker, "talk.wav", "talk.txt", "-o", "1.npz")
        self.save("text.npz", {"text": text})
        report = self.report(*talker, "talk.wav", "text.npz", "-o", "2.npz")
        self.assert_same(self.load("2.npz"), self.load("1.npz"))
        self.assertEqual([a["name"] for a in report["inputs"]], ["text"])
        self.save("text.npz", {"text": 0 * text})
        report = self.report(*talker, "talk.wav", "text.npz", "talk.txt", "-o", "3.npz")
        self.assert_says(report["notes"], "talk.txt was not used, text is there already")
        self.good(*talker, "talk.wav", "-o", "4.npz")
        self.assert_same(self.load("3.npz"), self.load("4.npz"))
        self.save("text.npz", {"text": text[1:]})
        self.bad(*talker, "talk.wav", "text.npz",
                 says=["text.npz: text: 59 frames, expected 60"])

    def test_a_long_recording_runs_in_stretches(self):
        # 300 s are 4500 frames, and 4096 make a stretch.
        samples = np.zeros(300 * 4000)
        for at in (0, 265, 290):
            samples[at * 4000:(at + 10) * 4000] = voice(10, 4000)
        self.write("long.wav", wav(samples, 4000))
        talker = self.talker("zs1", "bert")
        self.write("long.txt", lines(WORDS + [("hello", 250.0, 250.5), ("no", 290, 299)]))
        self.good(*talker, "long.wav", "long.txt", "-o", "1.npz")
        self.assertEqual(self.load("1.npz")["pose"].shape[0], 4500)
        self.good("features", talker[0], "long.wav", "long.txt", "-o", "f.npz")
        self.good(*talker, "f.npz", "-o", "2.npz")
        self.assert_same(self.load("2.npz"), self.load("1.npz"))


class StyleTest(FrontEndTest):

    def test_a_style_file_is_the_folder(self):
        for name in ("zs1", "zs2"):
            weights, speaker = self.weights(name, "bert", "acts"), self.write_speaker()
            text = self.good("style", weights, speaker, "-o", "anna.style", "--network", name)
            self.assertIn("-> style_pose", text)
            common = (weights, "talk.wav", "talk.txt", "--network", name)
            self.good(*common, "--style", speaker, "-o", "1.npz")
            self.good(*common, "--style", "anna.style", "-o", "2.npz")
            self.assert_same(self.load("2.npz"), self.load("1.npz"), ["pose", "style"])
            other = self.talker(name, "bert", "acts")[2]
            self.good(*common, "--style", other, "-o", "3.npz")
            self.assertFalse(np.array_equal(self.load("3.npz")["pose"],
                                            self.load("1.npz")["pose"]))

    def test_features_of_a_speaker_are_a_clip(self):
        weights, speaker = self.weights("zs1", "bert"), self.write_speaker()
        self.good("features", weights, speaker, "-o", "clip.npz")
        self.good("style", weights, speaker, "-o", "1.style")
        self.good("style", weights, "clip.npz", "-o", "2.style")
        self.assert_same(self.load("2.style"), self.load("1.style"), ["style", "weights_checksum"])

    def test_dialog_acts_and_face(self):
        weights, speaker = self.weights("zs2", "bert", "acts"), self.write_speaker()
        report = self.report("style", weights, speaker, "-o", "anna.style", "--network", "zs2")
        self.assert_says(report["used"], "words -> style_tags", "-> style_pose, style_face")

    def test_files_of_a_style_may_lie_together(self):
        weights, speaker = self.weights("zs1", "bert"), self.write_speaker()
        self.good("style", weights, speaker, "-o", "1.style")
        for name in os.listdir(self.path("anna/poses")):
            shutil.move(self.path("anna/poses/" + name), self.path("anna/" + name))
        os.rmdir(self.path("anna/poses"))
        self.good("style", weights, speaker, "-o", "2.style")
        self.assert_same(self.load("2.style"), self.load("1.style"))

    def test_the_rate_of_poses(self):
        weights, speaker = self.weights("zs1", "bert"), self.write_speaker()
        report = self.report("style", weights, speaker, "-o", "1.style")
        self.assert_says(report["notes"], "taken for 15.00 frames per second")
        report = self.report("style", weights, speaker, "-o", "2.style", "--pose-fps", "30")
        self.assert_says(report["notes"], "the first 22 of 45 frames are taken")

    def test_people_missing_from_frames(self):
        weights = self.weights("zs1", "bert")
        self.write_poses("poses", 40, gaps={0, 1, 2, 17, 18, 39})
        report = self.report("style", weights, "talk.wav", "poses", "-o", "1.style",
                             "--pose-fps", "10")
        self.assert_says(report["notes"], "body: 6 frames of 40 lost")
        self.write_poses("nobody", 5, gaps=range(5))
        self.bad("style", weights, "talk.wav", "nobody", "-o", "2.style", says=["nobody"])


class NetworksTest(FrontEndTest):

    def test_a_bundle_chooses_by_what_there_is(self):
        report = self.report(*self.talker("zs1", "bert", "acts"), "talk.wav", "talk.txt",
                             "-o", "out.npz")
        self.assertEqual(report["kind"], "ZS-MSTM 1.0")
        weights = self.weights("ast", "bert", "acts")
        report = self.report(weights, "talk.wav", "talk.txt", "-o", "out.npz")
        self.assertEqual(report["kind"], "AST")
        self.assert_says(report["notes"], "talk.txt was not used: the network takes no text")
        weights = self.weights("zs1", "model1", "bert")
        report = self.report(weights, "talk.wav", "talk.txt", "-o", "out.npz")
        self.assertEqual(report["kind"], "Model 1")  # which needs no style
        report = self.report(*self.talker("zs1", "model1", "bert"), "talk.wav", "talk.txt",
                             "-o", "out.npz")
        self.assertEqual(report["kind"], "ZS-MSTM 1.0")
        self.bad(self.weights("model1", "model2"), "talk.wav", says=["--network NAME"])

    def test_models_of_words(self):
        report = self.report(self.weights("model1", "bert"), "talk.wav", "talk.txt",
                             "-o", "1.npz", "--network", "model1")
        out = self.load("1.npz")
        # "how" comes 0.15 s after "there,", "Deep" 0.5 s after "you?".
        self.assertEqual(out["times_ms"].tolist()[:4],
                         [[100, 400], [400, 700], [700, 850], [850, 1100]])
        self.assertEqual(len(out["times_ms"]), 10)
        self.assert_says(report["used"], "-> 10 items in 2 inter-pausal units")
        report = self.report(self.weights("model2", "bert"), "talk.wav", "talk.txt",
                             "-o", "2.npz", "--network", "model2")
        self.assertEqual(self.load("2.npz")["times_ms"].tolist(),
                         [[100, 1100], [1100, 1700], [2200, 3600]])
        report = self.report(self.weights("model2"), "talk.wav", "-o", "3.npz")
        self.assertEqual(len(self.load("3.npz")["times_ms"]), 1)
        self.assert_says(report["notes"], "text: no words, zeros stand for them")

    def test_bert_and_the_classifier_take_words(self):
        self.good(self.weights("bert"), "talk.txt", "-o", "1.npz")
        hidden = self.load("1.npz")["hidden"]
        self.assertEqual(hidden.shape, (1, 10, 16))  # "learn", "##ing"
        report = self.report(self.weights("acts"), "talk.txt", "-o", "2.npz")
        out = self.load("2.npz")
        self.assertEqual(out["act"].shape, (2,))
        self.assertEqual(out["times_ms"].tolist(), [[100, 1700], [2200, 3600]])
        self.assert_says(report["used"], "2 sentences")
        self.bad(self.weights("bert"), "talk.wav", says=["no words, expected a transcript"])

    def test_features_without_weights(self):
        self.write_poses("poses", 30)
        report = self.report("features", "talk.wav", "talk.txt", "poses", "-o", "f.npz")
        out = self.load("f.npz")
        for name in ("log_mel", "pitch", "word_ms", "body", "body_clean"):
            self.assertIn(name, out)
        self.assertEqual(out["word_ms"].tolist()[0], [100, 400])
        self.assertEqual({a["name"] for a in report["arrays"]}, set(out))
        self.assertEqual(len(report["notes"]), len(set(report["notes"])))

    def test_features_without_the_stages_of_the_sound(self):
        weights = self.talker("zs1", "bert")[0]
        self.good("features", weights, "talk.wav", "talk.txt", "-o", "all.npz")
        self.good("features", weights, "talk.wav", "talk.txt", "--no-sound", "-o", "few.npz")
        every, few = self.load("all.npz"), self.load("few.npz")
        self.assertEqual(set(every) - set(few), {"log_mel", "pitch", "pitch_strength", "jitter",
                                                 "shimmer", "hnr", "hammarberg"})
        self.assert_same(few, {name: every[name] for name in few})
        self.bad("features", "talk.wav", "--no-sound", "-o", "none.npz",
                 says=["talk.wav: nothing is left without the stages of the sound"])


@unittest.skipUnless(os.path.isdir(os.path.join(ROOT, "../shared/data")) or
                     "GESTUS_SHARED_DATA" in os.environ, "no ../shared/data")
class RealTest(FrontEndTest):
    DATA = os.environ.get("GESTUS_SHARED_DATA", os.path.join(ROOT, "../shared/data"))

    def test_a_recording_with_its_textgrid(self):
        folder = os.path.join(self.DATA, "mfa_acoustic_corpus")
        report = self.report(*self.talker("zs1", "bert"),
                             os.path.join(folder, "acoustic_corpus.wav"), "--words",
                             os.path.join(folder, "acoustic_corpus.TextGrid"), "-o", "out.npz")
        self.assert_says(report["used"], "26.7 s", "TextGrid")
        self.assertEqual(len(self.load("out.npz")["pose"]), 400)
        self.good(*self.talker("zs1", "bert"), folder, "-o", "folder.npz")
        self.assert_same(self.load("folder.npz"), self.load("out.npz"))


if __name__ == "__main__":
    unittest.main()

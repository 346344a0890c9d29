"""The corpus' texts and voices: acts, splits that share nothing, word times against the sound."""

import ctypes

import numpy as np
import pytest

from converters.kinds.bert import DIALOG_ACTS
from converters.training.corpus import (espeak, grammar, lexicon, prosody, recordings, speech, style,
                                        texts)

try:
    ctypes.CDLL(espeak.LIBRARY)
    ESPEAK = True
except OSError:
    ESPEAK = False
needs_espeak = pytest.mark.skipif(not ESPEAK, reason="needs Debian's espeak-ng")
VOICE = style.Voice("en-us+f3", 160, 55, 60, -1.0, -65.0, 1.0)


def test_every_dialog_act_has_sentences():
    assert set(grammar.TEMPLATES) == set(DIALOG_ACTS)
    rng = np.random.default_rng(1)
    for act in grammar.TEMPLATES:
        drawn = {grammar.plain(grammar.sentence(act, rng)) for _ in range(60)}
        assert all("{" not in text and "  " not in text and "*" not in text for text in drawn)
        assert all(text[0].isupper() and text[-1] in ".?!" for text in drawn)
    assert grammar.plain(grammar.sentence("Yes-No-Question", rng)).endswith("?")


def test_sentences_follow_their_seed():
    def drawn(seed):
        rng = np.random.default_rng(seed)
        return [s.text for _ in range(5) for s in texts.monologue("train", rng)]
    assert drawn(3) == drawn(3) != drawn(4)


def test_splits_share_no_sentence():
    spoken = {}
    for split, _ in texts.SHARES:
        rng = np.random.default_rng(5)
        spoken[split] = {s.text.lower() for _ in range(15) for s in texts.monologue(split, rng)}
        assert len(spoken[split]) > 50
    names = list(spoken)
    for n, one in enumerate(names):
        for other in names[n + 1:]:
            assert not spoken[one] & spoken[other]


def test_texts_for_language_models_know_their_split():
    found = texts.sample(600, np.random.default_rng(2))
    assert len({sentence.text for _, sentence in found}) == 600
    assert all(split == texts.split_of(sentence.text) for split, sentence in found)
    assert len({sentence.act for _, sentence in found}) > 35


def test_words_have_classes():
    assert lexicon.look_up("Enormous,")[2] == "wide"
    assert lexicon.look_up("the")[1] == 0
    assert lexicon.look_up("xylophone")[1] > 0.3
    weights = [lexicon.look_up(word)[1] for word in lexicon.words_of("THING")]
    assert max(weights) - min(weights) > 0.2  # by word, not by class alone


def test_unseen_speakers_share_no_voice_and_no_style():
    people = recordings.people(recordings.Plan(hours=1, speakers=20, unseen=6))
    kinds = {seen: [x for name, x in people.items() if name.startswith("speaker") == seen]
             for seen in (True, False)}
    variants = {seen: {voice.name.split("+")[1] for voice, _, _ in kinds[seen]} for seen in kinds}
    assert not variants[True] & variants[False]
    assert not {motion for _, motion, _ in kinds[True]} & {motion for _, motion, _ in kinds[False]}
    assert {s for _, _, splits in kinds[False] for s in splits} == {"unseen"}
    assert {s for _, _, splits in kinds[True] for s in splits} == {"train", "dev", "test"}


def test_styles_fill_their_ranges():
    styles = style.draw_styles(30, np.random.default_rng(1))
    for name, (low, high, _) in style.RANGES.items():
        values = [getattr(s, name) for s in styles]
        assert low <= min(values) and max(values) <= high
        if name not in ("head", "face"):
            assert max(values) - min(values) > 0.9 * (high - low)
    assert sum(s.head == s.face == 1 for s in styles) == 20


def read(seed, voice=VOICE):
    rng = np.random.default_rng(seed)
    sentences = texts.monologue("train", rng, 30)
    with speech.Reader(voice) as reader:
        return sentences, *reader.read(sentences, rng)


@needs_espeak
def test_the_same_seed_gives_the_same_sound():
    _, one, times = read(1)
    _, two, again = read(1)
    np.testing.assert_array_equal(one, two)
    assert times == again


def decibels(samples):
    return 10 * np.log10(np.mean(np.square(samples, dtype=np.float64)) + 1e-12)


@needs_espeak
def test_sound_lies_within_the_words():
    sentences, samples, times = read(2)
    inside = np.zeros(len(samples), bool)
    for sentence, spans in zip(sentences, times):
        assert len(spans) == len(sentence.words)
        for start, end in spans:
            part = slice(int(start * speech.RATE), int(end * speech.RATE))
            assert 0.03 < end - start < 1.5
            assert decibels(samples[part]) > VOICE.noise + 20
            inside[part] = True
    flat = [span for spans in times for span in spans]
    assert all(a[1] <= b[0] + 1e-9 for a, b in zip(flat, flat[1:]))
    # Outside there is the noise of the room, but for the 30 ms in which a sound may die away.
    for (_, end), (start, _) in zip(flat, flat[1:]):
        if start - end > 0.1:
            gap = samples[int((end + 0.03) * speech.RATE):int((start - 0.03) * speech.RATE)]
            assert decibels(gap) < VOICE.noise + 3
    assert decibels(samples[inside]) > decibels(samples[~inside]) + 25


@needs_espeak
def test_pauses_are_long_enough_for_several_units():
    _, _, times = read(3)
    flat = [span for spans in times for span in spans]
    pauses = np.array([b[0] - a[1] for a, b in zip(flat, flat[1:])])
    assert (pauses > 0.2).sum() >= 3 and (pauses < 0.01).sum() > len(pauses) / 2


def test_pauses_are_shaped_without_touching_words():
    rng = np.random.default_rng(1)
    samples = np.ones(speech.RATE, np.float32)
    samples[6000:12000] = 0
    shaped, spans = speech._shape_pauses(samples, [(0, 6000), (12000, 22050)], 1.0, rng)
    assert spans[0] == (0, 6000) and spans[1][1] - spans[1][0] == 10050
    assert spans[1][1] == len(shaped)
    assert (shaped[:6000] == 1).all() and (shaped[spans[1][0]:] == 1).all()
    assert not shaped[6000:spans[1][0]].any()


def test_words_that_espeak_joins_share_their_time():
    events = [[0, espeak.WORD, 1, 3, ""], [0, espeak.PHONEME, 1, 0, "a"],
              [100, espeak.WORD, 12, 2, ""], [100, espeak.PHONEME, 12, 0, "b"],
              [5000, espeak.PHONEME, 12, 0, "_:"], [9000, espeak.PHONEME, 12, 0, "c"]]
    spans = speech._spans(events, [1, 5, 12], 10000)
    assert spans == [(0, 50), (50, 100), (100, 5000)]


@needs_espeak
def test_an_unknown_voice_is_one_line():
    from converters.errors import ConvertError
    with pytest.raises(ConvertError, match="espeak-ng: no voice xx"):
        read(1, style.Voice("xx", 160, 50, 50, 0, -60, 1))


def test_accents_are_high_and_loud_words():
    f0, level = np.full(300, 100.0), np.full(300, 0.8)
    f0[100:150] = 100 * 2 ** (5 / 12)  # five semitones
    f0[200:250], level[250:300] = 0, 1.05  # unvoiced; louder
    words = [(0.0, 0.5), (1.0, 1.5), (2.0, 2.5), (2.5, 3.0)]
    heard = prosody.hear(f0, level, words, [(0.0, 3.0)])
    np.testing.assert_allclose(heard.accent, [0, 0.7, 0, 0.3], atol=0.02)
    assert heard.contour[125] == pytest.approx(5) and heard.contour[50] == pytest.approx(0)


def test_units_end_at_pauses_of_more_than_a_fifth_of_a_second():
    words = [(0.0, 1.0), (1.2, 2.0), (2.21, 3.0)]
    assert prosody.units_of(words) == [(0.0, 2.0), (2.21, 3.0)]


def test_loudness_is_decibels():
    rng = np.random.default_rng(0)
    noise = rng.normal(size=16000)
    noise[8000:] *= 0.1  # 20 dB less
    level = prosody.loudness(noise, 16000)
    assert level[10:40].mean() == pytest.approx(0.98, abs=0.05)
    assert level[60:].mean() == pytest.approx(0.48, abs=0.05)

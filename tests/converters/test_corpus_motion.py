"""The gesturer: limbs keep their lengths, strokes follow words, statistics follow the style."""

import dataclasses

import numpy as np
import pytest

from converters.training.corpus import face, figure, gesture, profiles, prosody, strokes, texts
from converters.training.corpus.style import NEUTRAL

RIGHT, LEFT = 3, 6  # wrists


def spoken(seed, count=12):
    """(words, sentences, prosody, seconds) of sentences spoken at 0.3 s a word, with a hum that
    rises on every fourth word."""
    rng = np.random.default_rng(seed)
    words, sentences, at = [], [], 0.3
    while len(sentences) < count:
        for sentence in texts.monologue("train", rng, 20):
            begin = at
            for word, emphasis in sentence.words:
                words.append((word, at, at + 0.28, emphasis))
                at += 0.3
            sentences.append((sentence.act, begin, at))
            at += 0.5
    frames = int(at / prosody.HOP)
    f0, loud = np.zeros(frames), np.zeros(frames)
    for n, (_, start, end, _) in enumerate(words):
        part = slice(int(start / prosody.HOP), int(end / prosody.HOP))
        f0[part], loud[part] = 110 * (1.25 if n % 4 == 0 else 1), 0.9
    spans = [(start, end) for _, start, end, _ in words]
    return words, sentences, prosody.hear(f0, loud, spans, prosody.units_of(spans)), at


SPOKEN = [spoken(seed) for seed in range(3)]


def made(seed=1, **style):
    motion = dataclasses.replace(NEUTRAL, **style)
    return [gesture.gesture(*what, motion, seed) for what in SPOKEN]


def joints(take):
    return take["pose"].reshape(-1, 2, 11).transpose(0, 2, 1)


def speed(takes, joint):
    """Mean speed of a joint in units a second."""
    return np.mean([np.linalg.norm(np.diff(joints(t)[:, joint], axis=0), axis=1).mean()
                    for t in takes]) * gesture.FRAME_RATE


def test_steps_and_bumps_are_smooth():
    x = np.linspace(-0.5, 1.5, 20001)
    s, b = profiles.step(x), profiles.bump(x)
    assert s[0] == 0 and s[-1] == 1 and (np.diff(s) >= 0).all()
    assert b.max() == pytest.approx(1) and b[0] == b[-1] == 0
    for curve in (s, b):
        second = np.diff(curve, 2) / (x[1] - x[0])**2
        assert np.abs(np.diff(second)).max() < 0.05  # no jump of the acceleration


def test_moves_that_overlap_reach_the_last_target():
    times = np.linspace(0, 3, 301)
    curve = profiles.moves(times, [0.0, 1.0], [(0.5, 1.0, [4.0, 1.0]), (1.0, 1.0, [2.0, -3.0])])
    np.testing.assert_allclose(curve[0], [0, 1])
    np.testing.assert_allclose(curve[-1], [2, -3])
    assert curve[:, 0].max() > 2  # on its way to 4


def test_arms_keep_their_lengths_and_reach():
    rng = np.random.default_rng(1)
    way = rng.uniform([-200, -350, 20], [250, 250, 300], (500, 3))
    for side in (-1, 1):
        shoulder = figure.SHOULDER * [side, 1, 1]
        elbow, wrist, hand = figure.arm(shoulder, way, side)

        def length(a, b):
            return np.linalg.norm(a - b, axis=1)
        np.testing.assert_allclose(length(elbow, shoulder), figure.UPPER_ARM)
        np.testing.assert_allclose(length(wrist, elbow), figure.FOREARM)
        np.testing.assert_allclose(length(hand, wrist), figure.HAND)
        wanted = np.linalg.norm(way, axis=1)
        near = wanted < 0.99 * (figure.UPPER_ARM + figure.FOREARM)
        near &= wanted > 1.2 * (figure.UPPER_ARM - figure.FOREARM)
        np.testing.assert_allclose((wrist - shoulder)[near], (way * [side, -1, 1])[near], atol=1e-9)


def test_links_in_the_picture_are_no_longer_than_they_are():
    for take in made(amplitude=1.6, turn=0.3):
        xy = joints(take)
        np.testing.assert_allclose(np.linalg.norm(xy[:, 1], axis=1), figure.UNIT, rtol=1e-5)
        assert not xy[:, 0].any()
        most = 1 / np.cos(0.3 + 0.25)  # as the frame is scaled by the shoulder that is turned
        for a, b, length in ((1, 2, figure.UPPER_ARM), (2, 3, figure.FOREARM),
                             (4, 5, figure.UPPER_ARM), (5, 6, figure.FOREARM),
                             (6, 10, figure.HAND)):
            assert np.linalg.norm(xy[:, a] - xy[:, b], axis=1).max() < length * most


def test_the_head_turns_as_openface_says():
    still = figure.head(figure.NOSE[None], np.zeros((1, 3)))[0, 0]
    down, left, tilted = figure.head(np.stack([figure.NOSE, [60, -160, 0]]), np.diag([0.2] * 3))
    assert down[0, 1] > still[1]  # Rx: the nose goes down
    assert left[0, 0] > still[0]  # Ry: to the speaker's left, which is right in the picture
    assert tilted[1, 1] > -160 + 5  # Rz: the left ear goes down


def test_the_same_seed_moves_the_same_and_another_differs():
    one, again, other = made(1), made(1), made(2)
    for name in ("pose", "face", "au"):
        np.testing.assert_array_equal(one[0][name], again[0][name])
        assert np.abs(one[0][name] - other[0][name]).max() > 0.01
    assert speed(other, RIGHT) == pytest.approx(speed(one, RIGHT), rel=0.15)
    au, take = one[0]["au"], other[0]["au"]
    assert np.mean([np.corrcoef(a, b)[0, 1] for a, b in zip(au.T, take.T)]) > 0.9


def test_strokes_begin_with_their_words():
    for (words, *_), take in zip(SPOKEN, made()):
        onsets = np.array([start for _, start, _, _ in words])
        for stroke in take["strokes"]:
            late = stroke.time - onsets
            assert 0 <= late[late >= 0].min() <= 0.04 + 1e-9
            assert stroke.prominence >= strokes.threshold(NEUTRAL)


def test_wrists_move_most_after_stressed_words():
    after, else_ = [], []
    for take in made():
        v = sum(np.linalg.norm(np.diff(joints(take)[:, j], axis=0), axis=1) for j in (RIGHT, LEFT))
        at = np.arange(len(v)) / gesture.FRAME_RATE
        near = np.zeros(len(v), bool)
        for stroke in take["strokes"]:
            near |= (at >= stroke.time) & (at < stroke.time + 0.6)
        after.append(v[near].mean())
        else_.append(v[~near].mean())
    assert np.mean(after) > 2 * np.mean(else_)


def test_amplitude_is_the_size_of_strokes():
    def spread(takes):
        return np.mean([joints(t)[:, RIGHT, 1].std() for t in takes])
    sizes = [spread(made(amplitude=a)) for a in (0.6, 1.0, 1.5)]
    assert sizes[1] / sizes[0] == pytest.approx(1 / 0.6, rel=0.25)
    assert sizes[2] > 1.25 * sizes[1]
    still = made(amplitude=0.001)
    assert speed(still, RIGHT) < 0.15 * speed(made(), RIGHT)


def test_frequency_is_the_number_of_strokes():
    counts = [sum(len(t["strokes"]) for t in made(frequency=f)) for f in (0.1, 0.4, 0.7, 1.0)]
    assert counts == sorted(counts) and counts[-1] > 3 * counts[0]


def test_velocity_is_the_speed_of_strokes():
    def fastest(takes):
        return np.mean([np.percentile(np.linalg.norm(np.diff(joints(t)[:, RIGHT], axis=0), axis=1),
                                      98) for t in takes])
    slow, fast = (fastest(made(velocity=v, frequency=0.3)) for v in (0.7, 1.4))
    assert fast > 1.4 * slow


def test_arms_say_which_hand_moves():
    assert speed(made(arms=1.0), RIGHT) > 4 * speed(made(arms=1.0), LEFT)
    assert speed(made(arms=-1.0), LEFT) > 4 * speed(made(arms=-1.0), RIGHT)
    both = made(arms=0.0)
    assert 0.5 < speed(both, LEFT) / speed(both, RIGHT) < 2


def test_orientation_and_rest():
    def mean(takes):
        return np.mean([joints(t).mean(axis=0) for t in takes], axis=0)
    turned, leaned = mean(made(turn=0.4)), mean(made(lean=0.1))
    straight = mean(made())
    assert turned[7, 0] > straight[7, 0] + 5  # the nose
    assert leaned[4, 1] > straight[4, 1] + 10 and leaned[1, 1] < straight[1, 1] - 10  # shoulders
    high, apart = mean(made(rest_height=1.0)), mean(made(rest_spread=1.0))
    assert high[RIGHT, 1] < straight[RIGHT, 1] - 50  # y points down
    assert apart[LEFT, 0] - apart[RIGHT, 0] > straight[LEFT, 0] - straight[RIGHT, 0] + 50


def test_head_and_face_activity():
    def deviation(takes, part):
        return np.mean([t["au"][:, part].std(axis=0).mean() for t in takes])
    angles, units = slice(6, 9), slice(0, 6)
    assert deviation(made(head=1.5), angles) == pytest.approx(1.5 * deviation(made(), angles),
                                                              rel=0.05)
    assert deviation(made(face=0.6), units) == pytest.approx(0.6 * deviation(made(), units),
                                                             rel=0.2)
    au = np.concatenate([t["au"] for t in made()])
    assert au[:, :6].min() >= 0 and au[:, :6].max() <= 5 and np.abs(au[:, 6:]).max() < 0.7


def test_brows_follow_accents_and_questions():
    words = [("the", 0.3 + 0.3 * n, 0.55 + 0.3 * n, False) for n in range(8)]
    words[4] = ("garden", 1.5, 1.9, True)
    flat = prosody.Prosody(np.zeros(400), np.ones(400), np.zeros(8))
    accent = dataclasses.replace(flat, accent=np.eye(8)[4])

    def brows(sentences, heard):
        video = np.arange(72) / gesture.FACE_RATE
        prominences = [strokes.prominence(w[0], a)[0] for w, a in zip(words, heard.accent)]
        rng = np.random.default_rng(0)
        units, _ = face.curves(video, words, prominences, sentences, heard, NEUTRAL, rng)
        return units[:, 1]
    plain = brows([("Statement-non-opinion", 0.3, 2.8)], flat)
    stressed = brows([("Statement-non-opinion", 0.3, 2.8)], accent)
    asked = brows([("Yes-No-Question", 0.3, 2.8)], flat)
    assert stressed[36:46].max() > plain[36:46].max() + 0.7
    assert np.median(asked[12:60]) > np.median(plain[12:60]) + 0.8


def test_the_face_moves_with_loudness_and_blinks():
    for take, (_, _, heard, _) in zip(made(), SPOKEN):
        times = np.arange(len(take["face"])) / gesture.FRAME_RATE
        points = take["face"].reshape(-1, 2, 15)
        jaw = points[:, 1, 2] - points[:, 1, 0]
        assert np.corrcoef(jaw, heard.at("loudness", times))[0, 1] > 0.5
        gap = points[:, 1, 12] - points[:, 1, 11]
        assert gap.min() < 3 and np.median(gap) > 5 and (gap > 0).all()

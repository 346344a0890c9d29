"""Losses and schedules against the formulas, written out in NumPy."""

import numpy as np
import pytest

torch = pytest.importorskip("torch")

# pylint: disable=wrong-import-position
from converters.reference.blocks import sinusoidal_positions  # noqa: E402
from converters.training import faces, losses, schedules, starts, statistics  # noqa: E402

RNG = np.random.default_rng(7)


def tensor(x):
    return torch.from_numpy(np.asarray(x, np.float64))


def test_reconstruction_is_the_mean_square():
    x, y = RNG.normal(size=(2, 3, 4, 5))
    assert float(losses.squares(tensor(x), tensor(y))) == pytest.approx(((x - y) ** 2).mean())
    want = ((np.diff(x, axis=1) - np.diff(y, axis=1)) ** 2).mean()
    assert float(losses.velocity(tensor(x), tensor(y))) == pytest.approx(want)


def test_tokens_are_cross_entropies_of_the_channels_without_padding():
    """Eq. 5.7 and 5.17."""
    targets = np.array([[[3, 4], [2, 5], [0, 2]], [[5, 3], [4, 2], [2, 0]]])
    logits = [RNG.normal(size=(2, 3, 6)) for _ in range(2)]
    want = 0.0
    for n, x in enumerate(logits):
        log_p = x - np.log(np.exp(x).sum(-1, keepdims=True))
        picked = np.take_along_axis(log_p, targets[:, :, n:n + 1], 2)[:, :, 0]
        want -= picked[targets[:, :, n] != 0].mean()
    got = losses.tokens([tensor(x) for x in logits], torch.from_numpy(targets))
    assert float(got) == pytest.approx(want)


def test_a_spread_shares_the_target_among_neighbours():
    logits = RNG.normal(size=(1, 4, 9))
    targets = torch.tensor([[[5], [2], [8], [0]]])
    log_p = (logits - np.log(np.exp(logits).sum(-1, keepdims=True)))[0]
    want = -log_p[1, 2]
    for row, level in ((0, 5), (2, 8)):
        bell = np.exp(-0.5 * ((np.arange(3, 9) - level) / 1.5) ** 2)
        want -= (bell / bell.sum() * log_p[row, 3:]).sum()
    assert float(losses.tokens([tensor(logits)], targets, 1.5)) == pytest.approx(want / 3)


def test_fader_is_low_when_style_cannot_be_told():
    """Eq. 6.7, errors brought into 0 to 1."""
    style, told = RNG.normal(size=(2, 6, 4))
    span = style.max(0) - style.min(0)
    error = np.clip(np.abs(style - told) / span, 0, 1)
    got = losses.fader(tensor(style), tensor(told), losses.span_of(tensor(style)))
    assert float(got) == pytest.approx(((1 - error) ** 2).mean())
    assert float(losses.fader(tensor(style), tensor(style), tensor(span))) == 1.0
    assert float(losses.fader(tensor(style), tensor(style + 9 * span), tensor(span))) == 0.0


def test_behaviour_compares_the_measures_of_equation_6_9():
    x, y = 20 * RNG.normal(size=(2, 3, 9, 8))
    joints = [1, 3]

    def measures(poses):
        points = poses.reshape(3, 9, 2, 4)
        found = [np.sqrt((np.diff(points[..., joints], order, axis=1) ** 2).sum(2)).mean((1, 2))
                 for order in (1, 2, 3)]
        return np.array([*found, 2 * np.ptp(points, axis=3).sum(2).mean(1)])

    want = ((np.log(measures(x) + 1) - np.log(measures(y) + 1)) ** 2).mean(1).sum() / 4
    assert float(losses.behaviour(tensor(x), tensor(y), joints)) == pytest.approx(want, rel=1e-4)
    usual = np.array([[3.0], [5.0], [9.0], [200.0]])
    want = (((measures(x) - measures(y)) / usual) ** 2).mean()
    found = losses.amount(tensor(x), tensor(y), joints, tensor(usual))
    assert float(found) == pytest.approx(want, rel=1e-4)


def test_noam_is_that_of_vaswani():
    schedule = {"name": "noam", "d_model": 64, "warmup": 4000}
    for step in (1, 10, 3999, 4000, 4001, 90000):
        want = 64 ** -0.5 * min(step ** -0.5, step * 4000 ** -1.5)
        assert schedules.rate(schedule, step) == pytest.approx(want)
    rates = [schedules.rate(schedule, step) for step in range(1, 9000)]
    assert np.argmax(rates) == 3999


def test_cyclical_goes_up_and_down_in_steps_of_196():
    """Smith 2017, "triangular"; thesis Table 7.2."""
    schedule = {"name": "cyclical", "low": 1e-7, "high": 0.1, "half": 196}
    for step in range(1, 1200):
        cycle = np.floor(1 + (step - 1) / (2 * 196))
        x = abs((step - 1) / 196 - 2 * cycle + 1)
        want = 1e-7 + (0.1 - 1e-7) * max(0, 1 - x)
        assert schedules.rate(schedule, step) == pytest.approx(want, abs=1e-12)
    assert schedules.rate(schedule, 197) == pytest.approx(0.1)


def test_warm_up_and_cosine():
    warmup = {"name": "warmup", "rate": 1e-5, "steps": 20000}
    assert schedules.rate(warmup, 1) == pytest.approx(1e-5 / 20000)
    assert schedules.rate(warmup, 10000) == pytest.approx(0.5e-5)
    assert schedules.rate(warmup, 20000) == schedules.rate(warmup, 99999) == pytest.approx(1e-5)
    cosine = {"name": "cosine", "rate": 2.0, "warmup": 10, "steps": 110, "least": 0.1}
    assert [schedules.rate(cosine, step) for step in (5, 10, 60, 110, 500)] == pytest.approx(
        [1.0, 2.0, 1.1, 0.2, 0.2])


def test_lambda_starts_at_zero_and_grows_by_a_hundredth():
    """Thesis 6.5.4."""
    got = [schedules.fader_weight(step, 0.01, 0.5) for step in (1, 2, 11, 51, 1000)]
    assert got == pytest.approx([0, 0.01, 0.1, 0.5, 0.5])
    assert schedules.fader_weight(100, 0.01, 0.0) == 0.0


def test_statistics_bring_the_deviation_to_one_half():
    parts = [RNG.normal(3, 2, size=(50, 3)), RNG.normal(1, 5, size=(70, 3))]
    rows = np.concatenate(parts)
    for by_column, axis in ((True, 0), (False, None)):
        found = statistics.of("x", parts, by_column)
        x = (rows - found["mean"]) / (2 * np.array(found["deviation"]))
        np.testing.assert_allclose(x.mean(axis), 0, atol=1e-6)
        np.testing.assert_allclose(x.std(axis), 0.5, rtol=1e-6)
    still = statistics.of("x", [np.full((9, 2), 4.0)], True)
    assert still["mean"] == [4.0, 4.0] and still["deviation"] == [1.0, 1.0]


def test_faces_become_tokens():
    channels = [{"name": "AU02", "minimum": 0.0, "step": 0.5, "levels": 11},
                {"name": "Ry", "minimum": -1.0, "step": 0.1, "levels": 21}]
    face = np.zeros((3, 9))
    face[:, 1], face[:, 7] = (0.24, 0.26, 9.0), (-1.0, 0.0, 0.96)
    got = faces.tokens_of([face, face[:1]], channels, 5)
    np.testing.assert_array_equal(got[0], [[3, 3], [4, 13], [13, 23], [2, 2], [0, 0]])
    np.testing.assert_array_equal(got[1, :, 0], [3, 2, 0, 0, 0])
    np.testing.assert_array_equal(faces.tokens_of([face], channels, 3)[0, :, 0], [3, 4, 13])
    np.testing.assert_array_equal(faces.before(got)[0, :, 0], [1, 3, 4, 13, 2])


def test_corruption_leaves_what_is_no_level():
    channels = [{"levels": 50}]
    tokens = np.tile(np.array([1, 7, 8, 9, 2, 0]), (200, 1))[:, :, None]
    got = faces.corrupted(tokens, channels, 0.8, np.random.default_rng(1))
    np.testing.assert_array_equal(got[:, [0, 4, 5]], tokens[:, [0, 4, 5]])
    changed = (got != tokens)[:, 1:4].mean()
    assert 0.3 < changed < 0.5 and got.min() == 0 and got.max() <= 52
    np.testing.assert_array_equal(faces.corrupted(tokens, channels, 0.0, RNG), tokens)


def test_heads_start_by_looking_back():
    attention = torch.nn.MultiheadAttention(128, 4)
    offsets = [0, 1, 6, 12]
    starts.look_back(attention, offsets)
    x = sinusoidal_positions(64, 128).float()[:, None]
    with torch.no_grad():
        weights = attention(x, x, x, average_attn_weights=False)[1][0]
    for head, offset in enumerate(offsets):
        rows = torch.arange(offset, 64)
        assert torch.equal(weights[head, offset:].argmax(1), rows - offset)


def test_content_starts_by_looking_at_itself():
    attention = torch.nn.MultiheadAttention(128, 4)
    torch.manual_seed(1)
    starts.attend_to_yourself(attention)
    x = 0.5 * torch.randn(64, 1, 128)
    with torch.no_grad():
        out, weights = attention(x, x, x)
    assert torch.equal(weights[0].argmax(1), torch.arange(64))
    assert torch.nn.functional.cosine_similarity(out[:, 0], x[:, 0]).mean() > 0.8

"""Position embeddings of published checkpoints, cut and stretched as the published code does."""

import numpy as np
import pytest

from converters.pos_embed import AUDIOSET_GRID, DEIT_GRID, adapt_ast, adapt_positions

torch = pytest.importorskip("torch")

# Linear interpolation in float32: two products and a sum of values of order one.
TOLERANCE = 1e-6


def published(positions, found, grid):
    """The rules of models.md, section 7, by torch.nn.functional.interpolate."""
    d = positions.shape[2]
    positions = positions.astype(np.float64)  # torch computes its coordinates in this precision
    x = torch.from_numpy(positions)[:, 2:].transpose(1, 2).reshape(1, d, *found)
    f, t = grid
    if t <= found[1]:
        begin = found[1] // 2 - t // 2
        x = x[:, :, :, begin:begin + t]
    else:
        x = torch.nn.functional.interpolate(x, size=(found[0], t), mode="bilinear",
                                            align_corners=False)
    if f <= found[0]:
        begin = found[0] // 2 - f // 2
        x = x[:, :, begin:begin + f]
    else:
        x = torch.nn.functional.interpolate(x, size=(f, t), mode="bilinear", align_corners=False)
    patches = x.reshape(1, d, f * t).transpose(1, 2)
    return torch.cat([torch.from_numpy(positions)[:, :2], patches], 1).numpy()


@pytest.mark.parametrize("found", [DEIT_GRID, AUDIOSET_GRID])
@pytest.mark.parametrize("grid", [(12, 5), (12, 1), (12, 101), (12, 24), (12, 150), (24, 24),
                                  (30, 7), (5, 33), (1, 1)])
def test_against_interpolate(found, grid):
    rng = np.random.default_rng(3)
    positions = rng.standard_normal((1, 2 + found[0] * found[1], 3)).astype(np.float32)
    got = adapt_positions(positions, found, grid)
    want = published(positions, found, grid)
    assert got.shape == want.shape and got.dtype == np.float32
    np.testing.assert_allclose(got, want, atol=TOLERANCE, rtol=0)


CONFIG = {"mel_bins": 128, "frames": 64, "patch": 16, "stride": 10, "d_model": 4}


def test_recognised_by_shape():
    rng = np.random.default_rng(4)
    colours = rng.standard_normal((4, 3, 16, 16)).astype(np.float32)
    arrays = {"v.pos_embed": np.zeros((1, 2 + 24 * 24, 4), np.float32),
              "v.patch_embed.proj.weight": colours}
    report = []
    adapt_ast(arrays, "", CONFIG, report)
    assert arrays["v.pos_embed"].shape == (1, 62, 4)
    np.testing.assert_allclose(arrays["v.patch_embed.proj.weight"][:, 0],
                               torch.from_numpy(colours).sum(1).numpy(), atol=TOLERANCE)
    assert len(report) == 2


@pytest.mark.parametrize("rows", [62, 63, 2 + 12 * 100])
def test_other_shapes_are_left_alone(rows):
    positions = np.ones((1, rows, 4), np.float32)
    arrays, report = {"v.pos_embed": positions}, []
    adapt_ast(arrays, "", CONFIG, report)
    assert arrays["v.pos_embed"] is positions and not report

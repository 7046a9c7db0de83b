"""The truth that `benchmarks/beam_pictures.py` judges by is that of the light it draws."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).resolve().parents[2] / "benchmarks"))

from beam_pictures_drawn import CYCLE, _light, draw


@pytest.mark.parametrize("number", [n for n, kind in enumerate(CYCLE) if kind in ("plain", "few pixels", "large")])
def test_second_moments_of_the_noise_free_picture_are_the_truth(number: int) -> None:
    picture = draw(7, number)
    truth, (h, w) = picture.truth, picture.pixels.shape
    light = _light(truth, (h, w))
    x, y = (np.arange(w) - (w - 1) / 2)[None], ((h - 1) / 2 - np.arange(h))[:, None]
    total = light.sum()
    dx, dy = x - (light * x).sum() / total, y - (light * y).sum() / total
    matrix = np.array([[(light * a * b).sum() / total for b in (dx, dy)] for a in (dx, dy)])
    values, axes = np.linalg.eigh(matrix)
    assert 4 * np.sqrt(values[::-1]) == pytest.approx(truth.on_pixels, rel=2e-3)
    assert [(light * x).sum() / total, (light * y).sum() / total] == pytest.approx([truth.x, truth.y], abs=0.01)
    if truth.minor / truth.major < 0.9:
        angle = np.degrees(np.arctan2(axes[1, 1], axes[0, 1]))
        assert (angle - truth.angle + 90) % 180 - 90 == pytest.approx(0, abs=0.2)


def test_a_picture_follows_from_its_seed_and_number() -> None:
    again, other = draw(7, 5), draw(8, 5)
    assert np.array_equal(draw(7, 5).pixels, again.pixels)
    assert again.truth != other.truth

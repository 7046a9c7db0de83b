"""Fourteen pictures of one laser beam along its way, of the package sigima (BSD-3), read where they lie: it is not
imported, for it wants more than PICO does. A halo surrounds the beam."""

from __future__ import annotations

import re
from functools import cache
from importlib.metadata import files
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from pico.kernels.frame import Frame
from pico.kernels.kernel import Result
from pico.kernels.pipeline import parsed, run

COUNT = 14


@cache
def pictures() -> dict[int, Path]:
    """Return the pictures by the place along the beam that their names say."""
    found = [Path(str(f.locate())) for f in files("sigima") or () if "laser_beam/TEM00_z_" in f.as_posix()]
    return {int(re.findall(r"\d+", p.stem)[-1]): p for p in sorted(found)}


@cache
def pixels(z: int) -> NDArray[np.uint8]:
    picture = np.asarray(Image.open(pictures()[z]))
    return picture if picture.ndim == 2 else picture[..., 0]


def frame(values: NDArray[np.number]) -> Frame:
    """One that takes no pixel for saturated: these are to be measured all the same."""
    return Frame(values, pixel_size=1.0, full_scale=256.0)


def measured(kernel: str, values: NDArray[np.number]) -> Result:
    return run(parsed(f"image | {kernel}"), frame(values))


def test_all_pictures_are_there() -> None:
    assert len(pictures()) == COUNT


@pytest.mark.parametrize("kernel", ["centroid", "gaussian_fit"])
def test_the_middle_of_a_real_beam_is_inside_its_frame(kernel: str) -> None:
    for z in pictures():
        found = measured(kernel, pixels(z)).value
        h, w = pixels(z).shape
        assert abs(found["x"]) < w / 8 and abs(found["y"]) < h / 8, (z, found)


def test_the_fitted_width_grows_along_the_beam() -> None:
    widths = [measured("gaussian_fit", pixels(z)).value["major"] for z in pictures() if z >= 23]
    assert len(widths) > 10 and widths == sorted(widths)


def test_second_moments_of_a_beam_with_a_halo_are_inside_the_frame_or_unknown() -> None:
    found = [measured("d4sigma", pixels(z)) for z in pictures()]
    known = [f for f in found if not f.unknown]
    assert known and all(0 < f.value["minor"] <= f.value["major"] < pixels(13).shape[1] for f in known)
    assert all("leaves the frame" in f.unknown or "does not settle" in f.unknown for f in found if f.unknown)


@pytest.mark.parametrize("z", [23, 50, 80])
def test_a_shift_of_the_picture_moves_the_middle_of_its_coarse_copy_by_as_much(z: int) -> None:
    # By the fit: a centroid follows the halo, whose part inside the frame a shift changes.
    whole = pixels(z).astype(float)
    h, w = (n // 4 * 4 - 16 for n in whole.shape)
    middles = []
    for shift in range(9):
        part = whole[:h, shift : shift + w]
        middles.append(measured("gaussian_fit", part.reshape(h // 4, 4, w // 4, 4).mean(axis=(1, 3))).value["x"])
    moved = [first - middle for first, middle in zip(middles[:1] * 9, middles, strict=True)]
    assert moved == pytest.approx([n / 4 for n in range(9)], abs=0.02)


def test_a_real_saturated_picture_is_refused() -> None:
    full = int((pixels(23) == 255).sum())
    found = run(parsed("image | centroid"), Frame(pixels(23), full_scale=255.0))
    assert full and found.unknown == f"{full} of {pixels(23).size} pixels read 255"

"""Light just outside of the region over which a beam is integrated: it reaches into the region, too, and widens the
beam. Needs numpy at its top: kernels import it inside their functions."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pico.kernels.background import Plane

Array = NDArray[np.float64]
_THICK = 0.12
"""The share of the region's side that the strip outside of it measures."""
_PIECES = 6
"""Pieces of a strip along each side."""
_SIGNIFICANT = 5.0


def light_beside(
    coarse: NDArray[np.float32], by: int, box: tuple[int, int, int, int], behind: Plane, total: float, moments: Array
) -> Array:
    """Return by how much light beside a beam may change its total and moments (6,), if each piece of it goes on to the
    middle of the region; zero if there is none that noise does not explain.

    `coarse`: the means of blocks of `by` pixels; `box` (top, bottom, left, right) of the region [blocks]; `moments`:
    column and row [px], variances along columns, rows and across [px^2].
    """
    left = coarse - behind.means(by)
    noise = np.sqrt(behind.variance) / by
    change = np.zeros(6)
    for piece, across in _pieces(box, (coarse.shape[0], coarse.shape[1])):
        values = left[piece]
        if not values.size:
            continue
        mean = float(values.mean())
        if abs(mean) * np.sqrt(values.size) > _SIGNIFICANT * noise:
            change += _reach(piece, across, mean, by, total, moments)
    return change


def _pieces(box: tuple[int, int, int, int], shape: tuple[int, int]) -> Iterator[tuple[tuple[slice, slice], bool]]:
    """Pieces of the strip around a region, and whether light goes in from each along a row."""
    top, bottom, left, right = box
    thick_y, thick_x = (max(1, round(_THICK * (high - low))) for low, high in ((top, bottom), (left, right)))
    rows, columns = (
        np.linspace(low, high, min(_PIECES, high - low) + 1).round().astype(int).tolist()
        for low, high in ((top, bottom), (left, right))
    )
    for first, last in pairwise(rows):
        yield (slice(first, last), slice(max(0, left - thick_x), left)), True
        yield (slice(first, last), slice(right, right + thick_x)), True
    for first, last in pairwise(columns):
        yield (slice(max(0, top - thick_y), top), slice(first, last)), False
        yield (slice(bottom, bottom + thick_y), slice(first, last)), False


def _reach(piece: tuple[slice, slice], across: bool, mean: float, by: int, total: float, moments: Array) -> Array:
    """What a band of light from a piece to the middle of the beam adds to total and moments."""
    rows, columns = piece
    y = np.array([rows.start, rows.stop]) * by - 0.5 - moments[1]
    x = np.array([columns.start, columns.stop]) * by - 0.5 - moments[0]
    along, beside = (x, y) if across else (y, x)
    far = along[0] if abs(along[0]) < abs(along[1]) else along[1]  # where the region ends
    wide, middle = beside[1] - beside[0], float(beside.mean())
    light = mean * wide * abs(far)
    first, second = light * far / 2, light * far**2 / 3
    own = [first, light * middle] if across else [light * middle, first]
    squares = [second, light * middle**2] if across else [light * middle**2, second]
    mixed = first * middle
    return np.array([light, *(m / total for m in own), *(m / total for m in (*squares, mixed))])

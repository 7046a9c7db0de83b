"""First and second moments of a picture above a plane, as ISO 11146 has them, and their covariance. Needs numpy at its
top: kernels import it inside their functions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pico.kernels.background import Plane
from pico.kernels.stripes import Stripes

Array = NDArray[np.float64]
Box = tuple[int, int, int, int]
"""Top, bottom, left, right [px], the second and the fourth exclusive."""
PIXEL = 1 / 12
"""What a pixel's own size adds to variances [px^2]."""


def finer(moments: Array, by: int) -> Array:
    """Return moments in blocks of `by` pixels in pixels."""
    return np.concatenate([moments[:2] * by + (by - 1) / 2, moments[2:] * by**2])


def coarser(moments: Array, by: int) -> Array:
    """Return moments in pixels in blocks of `by` pixels."""
    return np.concatenate([(moments[:2] - (by - 1) / 2) / by, moments[2:] / by**2])


def powers(size: int, first: float, highest: int = 4) -> Array:
    """Return the powers 0 to `highest` of the places along one side of a box, (size, highest + 1)."""
    places: Array = np.arange(size, dtype=np.float64) - first
    return np.vander(places, highest + 1, increasing=True)


def sums(values: Array, origin: tuple[float, float], highest: int = 2) -> Array:
    """Return the sums of value x row^j x column^k, (j, k), about an origin (row, column) of the array (h, w)."""
    h, w = values.shape
    found: Array = powers(h, origin[0], highest).T @ (values @ powers(w, origin[1], highest))
    return found


def _flat(box: Box, origin: tuple[float, float], highest: int) -> Array:
    """The sums of a picture that is 1 all over the box."""
    h, w = box[1] - box[0], box[3] - box[2]
    return np.outer(powers(h, origin[0], highest).sum(0), powers(w, origin[1], highest).sum(0))


def _basis(box: Box, shape: tuple[float, float], origin: tuple[float, float]) -> Array:
    """The three parts of a plane as polynomials (3, row^j, column^k) about an origin of a box."""
    basis = np.zeros((3, 2, 2))
    basis[0, 0, 0] = 1.0
    basis[1, 0, :] = (box[2] + origin[1] + 0.5) / shape[1] - 0.5, 1 / shape[1]
    basis[2, :, 0] = (box[0] + origin[0] + 0.5) / shape[0] - 0.5, 1 / shape[0]
    return basis


def _beam_sums(
    part: NDArray[np.float32], box: Box, shape: tuple[float, float], behind: Plane, origin: tuple[float, float],
    highest: int,
) -> Array:  # fmt: skip
    """The sums of a beam above its background."""
    found = sums(part.astype(np.float64), origin, highest)
    flat = _flat(box, origin, highest + 1)
    for coefficient, poly in zip(behind.coefficients, _basis(box, shape, origin), strict=True):
        found -= coefficient * _times(poly, flat, highest + 1)
    return found


def _times(poly: Array, sums: Array, size: int) -> Array:
    """The sums of what is weighted with a polynomial besides, up to `size` powers each."""
    out = np.zeros((size, size))
    for (j, k), coefficient in np.ndenumerate(poly):
        if coefficient:
            out += coefficient * sums[j : j + size, k : k + size]
    return out


def moments_of(sums: Array) -> tuple[float, Array]:
    """Return total and moments from sums about the origin of the array."""
    total = float(sums[0, 0])
    if total <= 0:
        return total, np.full(5, np.nan)
    row, column = sums[1, 0] / total, sums[0, 1] / total
    across, down, both = sums[0, 2] / total, sums[2, 0] / total, sums[1, 1] / total
    return total, np.array([column, row, across - column**2, down - row**2, both - row * column])


def within(box: Box) -> tuple[slice, slice]:
    """Return the rows and the columns of a box."""
    return slice(box[0], box[1]), slice(box[2], box[3])


def above_plane(part: NDArray[np.float32], box: Box, shape: tuple[float, float], behind: Plane) -> tuple[float, Array]:
    """Return total and moments of a beam in a box, in pixels of the picture. `part`: the picture of `shape` in it."""
    origin = ((box[1] - box[0] - 1) / 2, (box[3] - box[2] - 1) / 2)
    total, moments = moments_of(_beam_sums(part, box, shape, behind, origin, 2))
    moments[:2] += box[2] + origin[1], box[0] + origin[0]
    return total, moments


def _about(middle: float, scale: float) -> Array:
    """The powers 0 to 2 of `middle` + `scale` t as polynomials of t, a row each."""
    return np.array([[1, 0, 0], [middle, scale, 0], [middle**2, 2 * middle * scale, scale**2]])


def bent(curved: Array, box: Box, shape: tuple[float, float], total: float, moments: Array) -> Array:
    """Return by how much a background that `bend` tells changes total and moments (6,) over a box."""
    h, w = shape
    origin = (moments[1] - box[0], moments[0] - box[2])
    down, right = _about((moments[1] + 0.5) / h - 0.5, 1 / h), _about((moments[0] + 0.5) / w - 0.5, 1 / w)
    about = down.T @ curved @ right
    change: Array = _products(_weights(total, moments), about[None], _flat(box, origin, 4))[:, 0]
    return change


def _weights(total: float, moments: Array) -> Array:
    """How total and moments follow each pixel, as polynomials (6, row^j, column^k) about the middle of the beam."""
    weights = np.zeros((6, 3, 3))
    weights[0, 0, 0] = 1.0
    weights[1, 0, 1] = weights[2, 1, 0] = weights[3, 0, 2] = weights[4, 2, 0] = weights[5, 1, 1] = 1 / total
    weights[3:, 0, 0] = -moments[2:] / total
    return weights


def covariance(
    part: NDArray[np.float32], electrons_per_count: float, box: Box, shape: tuple[float, float], behind: Plane,
    beside: Stripes | None, total: float, moments: Array,
) -> Array:  # fmt: skip
    """Return the covariance (6, 6) of total and moments: shot noise of the beam, noise of each pixel, that of the plane
    and of the stripes, and what a pixel's own size may add. `part`: the picture of `shape` in the box."""
    origin = (moments[1] - box[0], moments[0] - box[2])
    beam, flat = _beam_sums(part, box, shape, behind, origin, 4), _flat(box, origin, 4)
    noise = beam / electrons_per_count + behind.variance * flat
    if beside is not None:
        columns, rows = beside.light()
        down, right = powers(box[1] - box[0], origin[0]), powers(box[3] - box[2], origin[1])
        smear = np.outer(down.sum(0), columns[box[2] : box[3]] @ right)
        smear += np.outer(rows[box[0] : box[1]] @ down, right.sum(0))
        noise += smear / electrons_per_count
    weights = _weights(total, moments)
    follow = _products(weights, _basis(box, shape, origin), flat)
    out: Array = _products(weights, weights, noise) + follow @ behind.covariance @ follow.T
    out[[3, 4], [3, 4]] += PIXEL**2 / 3
    if beside is not None:
        down, right = powers(box[1] - box[0], origin[0], 2), powers(box[3] - box[2], origin[1], 2)
        of_columns = np.einsum("ajk,j,xk->ax", weights, down.sum(0), right)
        of_rows = np.einsum("ajk,yj,k->ay", weights, down, right.sum(0))
        for variance, each in zip(beside.variances, (of_columns, of_rows), strict=True):
            out += variance * each @ each.T
    return out


def _products(some: Array, others: Array, sums: Array) -> Array:
    """The sums of what is weighted with the product of two polynomials each, (some, others)."""
    down = np.add.outer(np.arange(some.shape[1]), np.arange(others.shape[1]))
    right = np.add.outer(np.arange(some.shape[2]), np.arange(others.shape[2]))
    of_both = sums[down[:, None, :, None], right[None, :, None, :]]  # row^j column^k of some, then of others
    flat: Array = some.reshape(len(some), -1)
    size = flat.shape[1]
    return flat @ of_both.reshape(size, -1) @ others.reshape(len(others), -1).T

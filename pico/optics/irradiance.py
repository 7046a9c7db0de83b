"""What beams make on a detector, pixel by pixel: where those of one source meet they interfere.

The field of each wave is exp of a polynomial of second order in the detector's coordinates y and z, so the product of
two is as well. But for its term in y z that is a column times a row, so a picture of millions of pixels is a sum of
outer products, as few as make it, and costs as much as one exponential a pixel only where a beam is turned or skew by
more than a little. A narrow line of a source's spectrum is one more such product; of a wide one the degree of coherence
is taken pixel by pixel.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from pico.optics.beam import Beam, Wave
from pico.optics.coherence import Spectrum, degree

Axis = NDArray[np.float64]
_DARK = 45.0
"""Where the logarithm of the irradiance is this much below its greatest, nothing is there."""
_FLAT = 1e-5
"""A term in y z that stays below this changes nothing."""
_BENT = 0.1
"""A term in y z that stays below this is a few products, too, in single precision: those of its series."""
_FEW, _SAMPLES, _ALIKE = 4, 32, 1e-7
"""Of more products than this it is told which matter, at how many points of an axis, and the share below which one does
not."""
_BAND = 64
"""Rows to which products are added at once: as many as the caches of a processor hold."""
Term = tuple[complex, NDArray[np.complex128]]
"""The weight of a pair of waves at the peak, and how its exponent goes on from there along y and z."""


@dataclass(frozen=True, eq=False)
class Screen:
    """The plane that light falls on: its `origin`, and its axes `left` (y), `up` (z) and `along` its normal, (3,)."""

    origin: NDArray[np.float64]
    along: NDArray[np.float64]
    left: NDArray[np.float64]
    up: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Gauss:
    """A beam on a screen without what tells its waves apart: the polynomial c + slope . r + r' q r / 2, r = (y, z); the
    beam's transverse coordinates there, offset + turn r. `size`: the amplitude of a wave whose field is 1 [1/mm].
    `path`: the optical path of the chief ray's wavefront at r = 0, and how it goes on, `ahead` r [mm]."""

    c: complex
    slope: NDArray[np.complex128]
    q: NDArray[np.complex128]
    offset: NDArray[np.float64]
    turn: NDArray[np.float64]
    size: float
    path: float
    ahead: NDArray[np.float64]


def irradiance(
    beams: Sequence[Beam], screen: Screen, y: Axis, z: Axis, dtype: DTypeLike = np.float64
) -> NDArray[np.floating]:
    """Return the irradiance (len(z), len(y)) [mW/mm2] of beams at the points of a screen, y and z each in order [mm].

    Waves of one source and group interfere, as far as its spectrum leaves them in step; all else adds up.
    """
    total = np.zeros((len(z), len(y)), dtype=dtype)
    shapes = [_gauss(beam, screen) for beam in beams]
    for n, one in enumerate(beams):
        for m in range(n + 1):
            for spectrum, pairs in _pairs(one, beams[m]).items():
                _add(total, (one, beams[m]), (shapes[n], shapes[m]), pairs, spectrum, y, z)
    return np.maximum(total, 0.0, out=total)


def _gauss(beam: Beam, screen: Screen) -> _Gauss:
    k, true = beam.wave_number, 2 * math.pi * beam.index / beam.wavelength
    start = screen.origin - beam.at
    offset, turn = beam.frame @ start, beam.frame @ np.stack([screen.left, screen.up], axis=1)
    ahead = np.array([screen.left @ beam.along, screen.up @ beam.along])
    m = 1j * k * beam.curvature
    phase = 2 * math.pi * (beam.path % beam.wavelength) / beam.wavelength + true * float(start @ beam.along)
    size = math.sqrt(k * math.sqrt(float(np.linalg.det(beam.curvature.imag))) / math.pi)
    return _Gauss(
        c=complex(0.5 * offset @ m @ offset + 1j * phase), slope=turn.T @ m @ offset + 1j * true * ahead,
        q=turn.T @ m @ turn,
        offset=offset, turn=turn, size=size * math.sqrt(abs(float(beam.along @ screen.along))),
        path=beam.path + beam.index * float(start @ beam.along), ahead=beam.index * ahead,
    )  # fmt: skip


def _pairs(one: Beam, other: Beam) -> dict[Spectrum, list[tuple[Wave, Wave]]]:
    """Return the waves that interfere, those of one beam each pair once, by their spectrum: none for those that are
    always in step."""
    found: dict[Spectrum, list[tuple[Wave, Wave]]] = {}
    for n, a in enumerate(one.waves if one.source == other.source else ()):
        for m, b in enumerate(other.waves):
            if a.group == b.group and (one is not other or m <= n):
                apart = one is not other and bool(one.spectra)
                found.setdefault(one.spectra[a.group] if apart else (), []).append((a, b))
    return found


def _add(
    total: NDArray[np.floating], beams: tuple[Beam, Beam], shapes: tuple[_Gauss, _Gauss],
    pairs: Sequence[tuple[Wave, Wave]], spectrum: Spectrum, y: Axis, z: Axis,
) -> None:  # fmt: skip
    """Add what pairs of waves of two beams make together."""
    (one, other), (f, g) = beams, shapes
    q, slope, c = f.q + g.q.conj(), f.slope + g.slope.conj(), f.c + np.conj(g.c)
    peak = np.asarray(np.linalg.solve(-q.real, slope.real), dtype=np.float64)
    c, slope = c + slope @ peak + 0.5 * peak @ q @ peak, slope + q @ peak  # from its peak on
    spread = np.sqrt(2 * _DARK * np.abs(np.diagonal(np.linalg.inv(-q.real))))
    columns, rows = (_window(axis, peak[n], spread[n]) for n, axis in enumerate((y, z)))
    if columns.start == columns.stop or rows.start == rows.stop:
        return
    dy, dz = y[columns] - peak[0], z[rows] - peak[1]
    if c.real < -300:
        return
    terms = [(w * complex(np.exp(c)), slope + s) for w, s in (_term(one, other, f, g, a, b, peak) for a, b in pairs)]
    part = total[rows, columns]
    if not spectrum:
        _outer(part, terms, q, dy, dz)
        return
    away = f.ahead - g.ahead
    delta, span = f.path - g.path + float(away @ peak), float(np.abs(away) @ [np.abs(dy).max(), np.abs(dz).max()])
    narrow = tuple(line for line in spectrum if line.bends(delta, span) < _FLAT)
    if narrow:
        lines = [(complex(degree((line,), delta)), line.slope(delta) * away) for line in narrow]
        _outer(part, [(w * by, s + more) for w, s in terms for by, more in lines], q, dy, dz)
    if wide := tuple(line for line in spectrum if line not in narrow):
        _outer(part, terms, q, dy, dz, lambda z: degree(wide, delta + away[0] * dy + away[1] * z[:, None]))


def _outer(
    part: NDArray[np.floating], terms: Sequence[Term], q: NDArray[np.complex128], dy: Axis, dz: Axis,
    factor: Callable[[Axis], NDArray[np.complex128]] | None = None,
) -> None:  # fmt: skip
    """Add the real part of the sum of terms, times exp(r' q r / 2) and, for the rows of some dz, a `factor` (rows,
    len(dy)), r = (dy, dz)."""
    skew, most = q[0, 1], float(abs(q[0, 1]) * np.abs(dy).max() * np.abs(dz).max())
    apart = most > (_BENT if part.dtype == np.float32 and factor is None else _FLAT)
    column = 0 if apart else 0.5 * q[1, 1] * dz**2
    row = 0 if apart else 0.5 * q[0, 0] * dy**2
    first = np.stack([w * np.exp(s[1] * dz + column) for w, s in terms], axis=1)
    second = np.stack([np.exp(s[0] * dy + row) for _, s in terms])
    if not apart and factor is None:
        if part.dtype == np.float32 and len(terms) > _FEW and _calm(terms, q, dy, dz):
            first, second = _fewer(first, second)
        orders = next(n for n in range(1, 9) if most**n / math.factorial(n) <= _FLAT)  # of exp(skew dy dz)
        first = np.hstack([first * (skew * dz[:, None]) ** n / math.factorial(n) for n in range(orders)])
        second = np.vstack([second * dy**n for n in range(orders)])
        # the real part of a sum of products of complex numbers, as one real product
        left = np.hstack([first.real, -first.imag]).astype(part.dtype)
        right = np.vstack([second.real, second.imag]).astype(part.dtype)
        for start in range(0, len(dz), _BAND):
            part[start : start + _BAND] += left[start : start + _BAND] @ right
        return
    left = np.hstack([first.real, first.imag]).astype(part.dtype)
    real = np.vstack([second.real, -second.imag]).astype(part.dtype)
    imaginary = np.vstack([second.imag, second.real]).astype(part.dtype)
    far = np.array([np.abs(dy).max(), np.abs(dz).max()])
    turns = apart and far @ np.abs(q.imag) @ far > _FLAT
    for rows in (slice(start, start + _BAND) for start in range(0, len(dz), _BAND)):
        made = left[rows] @ real
        if turns or factor is not None:
            by: Any = 1.0 if factor is None else factor(dz[rows])
            by = by * np.exp(1j * _quadratic(q.imag, dy, dz[rows])) if turns else by
            made = made * np.real(by).astype(part.dtype) - left[rows] @ imaginary * np.imag(by).astype(part.dtype)
        if apart:
            made *= np.exp(_quadratic(q.real, dy, dz[rows]).astype(part.dtype))
        part[rows] += made


def _quadratic(q: NDArray[np.float64], dy: Axis, dz: Axis) -> NDArray[np.float64]:
    """Return r' q r / 2 at r = (dy, dz), (len(dz), len(dy))."""
    return np.asarray(0.5 * q[1, 1] * dz[:, None] ** 2 + q[0, 1] * dz[:, None] * dy + 0.5 * q[0, 0] * dy**2)


def _calm(terms: Sequence[Term], q: NDArray[np.complex128], dy: Axis, dz: Axis) -> bool:
    """Whether no term has more fringes than `_SAMPLES` of an axis show."""
    reach = np.array([np.abs(dy).max(), np.abs(dz).max()])
    turned = max(float((np.abs(s.imag) * reach).max()) for _, s in terms)
    return turned + float((np.abs(np.diagonal(q).imag) * reach**2).max()) < _SAMPLES / 4


def _fewer(
    first: NDArray[np.complex128], second: NDArray[np.complex128]
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Return factors of the same product, of as few columns and rows as make it to `_ALIKE` of its greatest.

    Waves that are shifted by 100 nm make all but the same, so that of the 56 columns of a tilted polarizer two or three
    are left. They are told by the singular values of the product at every so many points of each axis.
    """
    some, few = first[:: -(-len(first) // _SAMPLES)], second[:, :: -(-second.shape[1] // _SAMPLES)]
    u, sizes, v = np.linalg.svd(some @ few)
    count = int(np.count_nonzero(sizes > _ALIKE * sizes[0]))
    if not 0 < count < first.shape[1]:
        return first, second
    return first @ (few @ v[:count].conj().T) / sizes[:count], u[:, :count].conj().T @ some @ second


def _term(
    one: Beam, other: Beam, f: _Gauss, g: _Gauss, a: Wave, b: Wave, peak: NDArray[np.float64]
) -> Term:  # fmt: skip
    """Return the weight of a pair of waves at the peak, and how its exponent goes on from there along y and z."""
    i, j = 1j * one.wave_number * a.shift, -1j * other.wave_number * np.conj(b.shift)
    both = i @ (f.offset + f.turn @ peak) + j @ (g.offset + g.turn @ peak)
    twice = 1.0 if one is other and a is b else 2.0
    weight = twice * f.size * g.size * (a.field @ np.conj(b.field)) * np.exp(both)
    return complex(weight), i @ f.turn + j @ g.turn


def _window(axis: Axis, middle: float, reach: float) -> slice:
    """Return where an axis, rising or falling, is within reach of a point."""
    near = np.nonzero(np.abs(axis - middle) <= reach)[0]
    return slice(int(near[0]), int(near[-1]) + 1) if len(near) else slice(0, 0)

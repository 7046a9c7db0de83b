"""One ray and matrices of two rows are worked out in closed form: the same as for many rays, and as LAPACK has them."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from pico.optics import gaussian
from pico.optics.rays import Surface, cross, cross_alone, rays

numbers = st.floats(-3.0, 3.0).map(lambda x: round(x, 6))


def unit(x: float, y: float, z: float) -> NDArray[np.float64]:
    way = np.array([x, y, z])
    size = float(np.linalg.norm(way))
    return way / size if size > 1e-3 else np.array([1.0, 0.0, 0.0])


@given(
    at=st.tuples(numbers, numbers, numbers), along=st.tuples(numbers, numbers, numbers),
    normal=st.tuples(numbers, numbers, numbers), curvature=st.sampled_from([0.0, 0.01, -0.3, 0.6, -2.0]),
    radius=st.sampled_from([0.5, 2.0, math.inf]), glass=st.sampled_from([(1.0, 1.0), (1.0, 1.5), (1.7, 1.0)]),
    reflects=st.booleans(),
)  # fmt: skip
def test_a_ray_alone_goes_on_as_among_many(
    at: tuple[float, float, float], along: tuple[float, float, float], normal: tuple[float, float, float],
    curvature: float, radius: float, glass: tuple[float, float], reflects: bool,
) -> None:  # fmt: skip
    surface = Surface(np.array([0.3, -0.2, 0.1]), unit(*normal), curvature, radius, *glass, reflects)
    begun = rays(at, unit(*along))
    among, alone = cross(surface, begun), cross_alone(surface, begun.at[0], begun.along[0])
    assert (alone is not None) == bool(among.alive[0])
    if alone is not None:
        np.testing.assert_allclose(alone[0], among.at[0], rtol=0, atol=1e-9)
        np.testing.assert_allclose(alone[1], among.along[0], rtol=0, atol=1e-9)


@given(
    st.tuples(numbers, numbers, numbers), st.tuples(*[st.floats(0.1, 3.0)] * 2), st.floats(-0.8, 0.8),
    st.floats(-50.0, 50.0),
)  # fmt: skip
def test_a_curvature_is_handled_as_by_lapack(
    real: tuple[float, float, float], imaginary: tuple[float, float], skew: float, distance: float
) -> None:
    (a, b, d), (p, q) = real, imaginary
    mixed = skew * math.sqrt(p * q)  # positive definite: a beam has widths
    curvature = np.array([[a, b], [b, d]]) + 1j * np.array([[p, mixed], [mixed, q]])
    stretch = gaussian.stretch(curvature, distance)
    np.testing.assert_allclose(gaussian.inverse(stretch), np.linalg.inv(stretch), rtol=1e-9, atol=1e-12)
    phase = float(np.angle(1 + distance * np.linalg.eigvals(curvature)).sum())
    assert abs(gaussian.phase(curvature, distance) - phase) < 1e-6
    wide, narrow, angle = gaussian.widths(curvature, 0.0006)
    values, vectors = np.linalg.eigh(curvature.imag * math.pi / 0.0006)
    np.testing.assert_allclose((wide, narrow), 1 / np.sqrt(values), rtol=1e-9)
    if values[1] - values[0] > 1e-6 * values[1]:
        assert abs(abs(np.array([math.cos(angle), math.sin(angle)]) @ vectors[:, 0]) - 1.0) < 1e-6
        assert 0.0 <= angle <= math.pi

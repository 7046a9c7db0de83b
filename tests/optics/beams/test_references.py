"""Rays against optiland, Gaussian beams against finesse, by golden figures that those made; beams against rays.

`benchmarks/optics_references.py` makes the figures, and compares with the programs where they are installed.
"""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.optics_references import BEAMS, RAYS, beam_of, traced

from pico.optics.beam import Beam, Wave, beyond
from pico.optics.rays import Surface, cross, rays

RAY_CASES = json.loads(RAYS.read_text())["cases"]
BEAM_CASES = json.loads(BEAMS.read_text())["cases"]


@pytest.mark.parametrize("case", RAY_CASES, ids=lambda case: case["name"])
def test_rays_are_those_of_optiland(case: dict[str, Any]) -> None:
    """Points, directions and optical paths at every surface, to 1e-6 mm."""
    wanted = np.array(case["figures"])
    assert wanted.shape == (len(case["surfaces"]), len(case["rays"]), 7)
    assert np.abs(traced(case) - wanted).max() < 1e-6  # false for the nan of a lost ray


@pytest.mark.parametrize("case", BEAM_CASES, ids=lambda case: case["name"])
def test_beams_are_those_of_finesse(case: dict[str, Any]) -> None:
    """q behind every step, in the plane of the folds and across it, to 1e-6 of it."""
    found = beam_of(case)
    assert len(found) == len(case["figures"]) == len(case["path"])
    for step, q, figures in zip(case["path"], found, case["figures"], strict=True):
        level, upright = complex(*figures[:2]), complex(*figures[2:])
        assert (q.level, q.upright) == pytest.approx((level, upright), rel=1e-6), step


unit = st.floats(-1, 1)
three = st.tuples(unit, unit, unit)


@given(three, three, three, st.floats(-1 / 80, 1 / 80), st.floats(1, 2), st.booleans())
def test_curvatures_are_those_of_rays_around_the_chief_one(
    way: tuple[float, ...], aside: tuple[float, ...], bends: tuple[float, ...], curvature: float, index: float,
    reflect: bool,
) -> None:  # fmt: skip
    """A wavefront of any two curvatures, skew to a curved face that it meets aslant: M behind that face, out of any
    plane, is what relates slopes to places of rays near the chief one, which are traced exactly."""
    along = np.array(way) + np.array([1.5, 0, 0])
    along = along / np.linalg.norm(along)
    normal = along + 0.5 * np.array(aside)
    normal = normal / np.linalg.norm(normal)
    across = np.cross([0, 0, 1], along) / np.linalg.norm(np.cross([0, 0, 1], along))
    front = 0.01 * np.array([[bends[0], bends[1]], [bends[1], bends[2]]])
    wave = Wave(across.astype(complex), np.zeros(2, dtype=complex))
    beam = Beam("laser", 632.8e-6, np.zeros(3), along, across, front + 1e-12j * np.eye(2), (wave,))
    face = Surface(20 * along, normal, curvature, before=1.0, after=index)
    behind = beyond(beam, face, reflect=reflect)
    assert behind is not None

    step = 1e-4
    aways = step * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
    begun = rays(aways @ beam.frame, along + aways @ front @ beam.frame)
    crossed = cross(replace(face, reflects=reflect), begun)
    far = ((behind.at - crossed.at) @ behind.along) / (crossed.along @ behind.along)
    places = (crossed.at + far[:, None] * crossed.along - behind.at) @ behind.frame.T
    slopes = crossed.along @ behind.frame.T / (crossed.along @ behind.along)[:, None]
    there, turned = ((x[::2] - x[1::2]).T / (2 * step) for x in (places, slopes))
    assert crossed.alive.all()
    assert behind.curvature.real == pytest.approx(turned @ np.linalg.inv(there), abs=1e-8)


@pytest.mark.parametrize(("height", "meets"), [(5.0, True), (9.8, True), (10.2, False), (15.0, False)])
@pytest.mark.parametrize("turned", [1.0, -1.0])
def test_the_far_half_of_a_sphere_is_no_lens(height: float, meets: bool, turned: float) -> None:
    """A face of radius 10 mm with its vertex at the origin is the half up to 10 mm above it; a ray that comes nearly
    across its axis meets the sphere there or above."""
    face = Surface(np.zeros(3), np.array([0, 0, turned]), turned / 10, before=1.0, after=1.5 if turned > 0 else 1.0)
    met = cross(face, rays([[-50.0, 0.0, height]], [[1.0, 0.0, 1e-4]]))
    assert met.alive[0] == meets
    if meets:
        x = -math.sqrt(100 - (10 - met.at[0, 2]) ** 2)
        assert met.at[0] == pytest.approx([x, 0, height + 1e-4 * (50 + x)], abs=1e-9)

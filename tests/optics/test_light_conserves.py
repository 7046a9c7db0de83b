"""What must hold of any light: no power comes or goes at a face, and it finds its way back."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from light_benches import kind, light
from numpy.typing import NDArray
from test_spin_hall import bench

from pico.model.pose import Pose
from pico.optics.beam import Beam, Wave, beyond, forward
from pico.optics.elements.beam_splitter import meet as divide
from pico.optics.elements.lens import surfaces
from pico.optics.gaussian import from_waist
from pico.optics.light import irradiance
from pico.optics.part import Part, within
from pico.optics.plates import plate
from pico.optics.rays import Surface, rays, trace

LASER = Pose(100, 400)
unit = st.floats(-1, 1)
parts = st.tuples(unit, unit, unit, unit).filter(lambda p: sum(x * x for x in p) > 1e-3)


def beam_with(jones: tuple[float, float, float, float], *, wavy: bool = False, along: tuple[float, ...] = (1, 0, 0),
              across: tuple[float, ...] = (0, 1, 0)) -> Beam:  # fmt: skip
    """Return a beam of any polarization; `wavy`: with two waves more, which interfere with the first."""
    a, b, c, d = jones
    way, left = np.array(along, dtype=float), np.array(across, dtype=float)
    up = np.cross(way, left)
    field = complex(a, b) * left + complex(c, d) * up
    waves = [Wave(field, np.zeros(2, dtype=complex))]
    if wavy:
        waves += [Wave(0.5j * field, np.array([1e-4, -2e-4j])),
                  Wave(np.conj(field) * 0.7, np.array([1e-4j, 3e-4 + 0j]))]  # fmt: skip
    return Beam("laser", 632.8e-6, np.zeros(3), way, left, from_waist(0.4, 632.8e-6, 80.0), tuple(waves))


def part_of(name: str, pose: Pose, **parameters: object) -> Part:
    """Return a component as light finds it; its optic is at a height of 70 mm."""
    from pico.optics.axis import optic_of

    given_kind = kind(name, **parameters)
    return Part("x", given_kind, {}, pose, optic_of(given_kind, "x", pose, {}))


def raised(beam: Beam) -> Beam:
    """Return a beam in the plane of the optics."""
    return replace(beam, at=np.array([0.0, 0.0, 70.0]))


@given(parts, st.floats(-40, 40), st.floats(0, 1), st.floats(30, 150), st.booleans())
def test_a_splitter_without_loss(
    jones: tuple[float, float, float, float], yaw: float, passes: float, fold: float, wavy: bool
) -> None:
    beam = raised(beam_with(jones, wavy=wavy))
    part = part_of("beam_splitter_50_50", Pose(100, 0, yaw), transmittance=passes, reflectance=1 - passes, fold=fold)
    assume(abs(np.array(part.optic.normal) @ beam.along) > 0.1)
    assert sum(b.power for b in divide(part, beam).onward) == pytest.approx(beam.power, rel=1e-9)


@given(parts, st.floats(0.5, 1), st.floats(0, 1), st.floats(1, 1e5))
def test_a_polarizing_cube_never_makes_light(
    jones: tuple[float, float, float, float], passes: float, back: float, extinction: float
) -> None:
    beam = raised(beam_with(jones))
    part = part_of("polarizing_beam_splitter", Pose(100, 0), transmittance=passes, reflectance=back,
                   extinction=extinction)  # fmt: skip
    out = divide(part, beam).onward
    assert sum(b.power for b in out) <= beam.power * (1 + 1e-12)


@given(parts, st.floats(-85, 85), st.floats(1.3, 4.0), st.booleans())
def test_a_bare_plate(jones: tuple[float, float, float, float], yaw: float, index: float, wavy: bool) -> None:
    """All is there but what goes to and fro a third time: T R^3 of s and of p, by Fresnel's intensities."""
    beam = raised(beam_with(jones, wavy=wavy))
    part = part_of("neutral_density_filter", Pose(100, 0, yaw), thickness=2.0, refractive_index=index, coating="none")
    out = plate(part, forward(beam, 100.0))
    assert len(out) == 4
    i = math.radians(abs(yaw))
    o = math.asin(math.sin(i) / index)
    back = ((index - 1) / (index + 1)) ** 2
    r_s, r_p = (back, back) if i < 1e-5 else ((math.sin(i - o) / math.sin(i + o)) ** 2,
                                              (math.tan(i - o) / math.tan(i + o)) ** 2)  # fmt: skip
    if wavy:
        missing = beam.power - sum(b.power for b in out)
        low, high = sorted((1 - r) * r**3 for r in (r_s, r_p))
        assert low * beam.power - 1e-9 <= missing <= high * beam.power + 1e-9
    else:
        a, b, c, d = jones  # level is p
        stays = (a * a + b * b) * (1 - r_p) * r_p**3 + (c * c + d * d) * (1 - r_s) * r_s**3
        assert sum(b.power for b in out) == pytest.approx(beam.power - stays, abs=1e-9)


@given(parts, st.tuples(unit, unit, unit), st.floats(-1 / 60, 1 / 60), st.booleans(), st.floats(1.0, 2.0))
def test_faces_in_any_direction(
    jones: tuple[float, float, float, float], aside: tuple[float, float, float], bends: float, reflect: bool,
    index: float,
) -> None:  # fmt: skip
    """Curved or flat, met under any angle: the power of several waves that interfere stays, fields stay across."""
    beam = beam_with(jones, wavy=True)
    normal = np.array([1.0, 0, 0]) + np.array(aside)
    assume(np.linalg.norm(normal) > 0.2)
    normal = normal / np.linalg.norm(normal)
    assume(abs(normal[0]) > 0.2)
    out = beyond(beam, Surface(np.array([60.0, 0, 0]), normal, bends, before=1.0, after=index), reflect=reflect)
    if out is None:  # from the other side it comes out of the glass, and may be reflected totally
        assert not reflect and normal[0] < 0
        return
    if not reflect and normal[0] < 0:
        return  # the beam says that it runs in air, the face that it comes out of glass
    assert out.power == pytest.approx(beam.power, rel=1e-9)
    assert all(abs(wave.field @ out.along) < 1e-12 for wave in out.waves)
    assert np.linalg.det(np.stack([out.across, out.up, out.along])) == pytest.approx(1.0)


@settings(max_examples=20, deadline=None)
@given(st.floats(-90, 90), st.floats(-90, 90), st.floats(0, 600e-6))
def test_an_interferometer_keeps_light_of_any_polarization(half: float, quarter: float, longer: float) -> None:
    """Mach and Zehnder, one arm longer: the outputs share the light as cos^2 and sin^2, and all of it is there."""
    splitter, mirror = kind("beam_splitter_50_50"), kind("mirror_tip_tilt")
    kinds = {"laser": kind("hene_laser"), "h": kind("half_wave_plate"), "q": kind("quarter_wave_plate"),
             "b1": splitter, "b2": splitter, "m1": mirror, "m2": mirror, "one": kind("beam_camera"),
             "two": kind("beam_camera")}  # fmt: skip
    poses = {
        "laser": LASER, "h": Pose(230, 400), "q": Pose(300, 400), "b1": Pose(400, 400),
        "m1": Pose(700 + longer, 400, -45), "m2": Pose(400, 600, 135),
        "b2": Pose(700, 600), "one": Pose(900, 600), "two": Pose(700, 800, 90),
    }  # fmt: skip
    found = light(kinds, poses, {"h": {"angle": half}, "q": {"angle": quarter}})
    line = np.linspace(-3, 3, 121)
    area = (line[1] - line[0]) ** 2
    out = [irradiance(found.at(name), line, line).sum() * area for name in ("one", "two")]
    assert len(found.at("one")) == len(found.at("two")) == 2
    bright = math.cos(math.pi * longer / 632.8e-6) ** 2
    assert out == pytest.approx([bright, 1 - bright], abs=1e-5)
    assert sum(out) == pytest.approx(1.0, abs=1e-6)


lenses = st.tuples(
    st.floats(25, 200), st.one_of(st.floats(-400, -60), st.floats(60, 400), st.none()), st.floats(1.4, 1.9),
    st.floats(-25, 25), st.floats(-4, 4),
)  # fmt: skip


def lens_of(given_lens: tuple[float, float | None, float, float, float]) -> Part:
    radius, back, index, yaw, aside = given_lens
    return part_of("plano_convex_100", Pose(100, aside, yaw), radius_of_curvature=radius, center_thickness=5.0,
                   refractive_index=index, radius_of_curvature_back=back)  # fmt: skip


@given(lenses, st.tuples(unit, unit), st.tuples(unit, unit))
def test_a_ray_finds_its_way_back_through_a_real_lens(
    given_lens: tuple[float, float | None, float, float, float], off: tuple[float, float], slope: tuple[float, float]
) -> None:
    faces = surfaces(part := lens_of(given_lens), part.optic.radius, 632.8)
    screen = Surface(np.array([180.0, 0, 70]), np.array([1.0, 0, 0]))
    begun = rays([[0, 3 * off[0], 70 + 3 * off[1]]], [[1, 0.02 * slope[0], 0.02 * slope[1]]])
    there = trace([*faces, screen], begun)
    assume(all(r.alive[0] for r in there))
    start = Surface(begun.at[0], np.array([1.0, 0, 0]))
    back = trace([*faces[::-1], start], rays(there[-1].at, -there[-1].along))
    assert back[-1].alive[0]
    assert back[-1].at == pytest.approx(begun.at, abs=1e-9)
    assert back[-1].along == pytest.approx(-begun.along, abs=1e-12)
    assert back[-1].path == pytest.approx(there[-1].path, abs=1e-9)


def in_space(beam: Beam) -> NDArray[np.complex128]:
    """Return M of a beam as a tensor in space (3, 3)."""
    whole: NDArray[np.complex128] = beam.frame.T @ beam.curvature @ beam.frame
    return whole


@given(lenses, parts)
def test_a_beam_finds_its_way_back_through_a_real_lens(
    given_lens: tuple[float, float | None, float, float, float], jones: tuple[float, float, float, float]
) -> None:
    """Backwards in time a field is its conjugate: M becomes -conj M, and runs back to where it came from."""
    faces = surfaces(part := lens_of(given_lens), part.optic.radius, 632.8)
    begun = raised(beam_with(jones))
    there: Beam | None = begun
    for face in faces:
        there = beyond(there, face) if there else None
    assume(there is not None)
    assert there is not None
    end = forward(there, 70.0)
    turned = -end.along
    across = np.cross([0, 0, 1], turned) / np.linalg.norm(np.cross([0, 0, 1], turned))
    frame = np.stack([across, np.cross(turned, across)])
    (wave,) = end.waves
    back: Beam | None = replace(
        end, along=turned, across=across, curvature=frame @ -np.conj(in_space(end)) @ frame.T,
        waves=(replace(wave, field=np.conj(wave.field)),), path=0.0, length=0.0,
    )  # fmt: skip
    for face in faces[::-1]:
        back = beyond(back, face) if back else None
    assert back is not None
    home = forward(back, float((begun.at - back.at) @ back.along))
    assert home.at == pytest.approx(begun.at, abs=1e-9)
    assert home.along == pytest.approx(-begun.along, abs=1e-12)
    assert np.abs(in_space(home) + np.conj(in_space(begun))).max() < 1e-9 * np.abs(begun.curvature).max()
    assert home.waves[0].field == pytest.approx(np.conj(begun.waves[0].field), abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(st.floats(0.1, 1), st.floats(0, math.pi), st.floats(0.03, 3), st.tuples(unit, unit))
def test_what_lies_within_a_circle(narrow: float, angle: float, radius: float, off: tuple[float, float]) -> None:
    """Against the sum over rings and directions around the circle's center, lengths in units of the larger radius."""
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    shape = turn @ np.diag([1, 1 / narrow**2]) @ turn.T
    beam = replace(beam_with((1, 0, 0, 0)), curvature=1j * shape * 632.8e-6 / math.pi)
    middle, number = 2.0 * np.array(off), 1000
    nodes, weights = np.polynomial.legendre.leggauss(160)
    r, phi = (nodes + 1) * radius / 2, np.arange(number) * 2 * math.pi / number
    x, y = middle[0] + np.outer(r, np.cos(phi)), middle[1] + np.outer(r, np.sin(phi))
    density = np.exp(-2 * (shape[0, 0] * x**2 + 2 * shape[0, 1] * x * y + shape[1, 1] * y**2))
    wanted = float((weights * r) @ density.sum(axis=1)) * 2 * radius / (number * narrow)
    assert within(beam, middle, radius) == pytest.approx(wanted, abs=1e-9)


@pytest.mark.parametrize("angle", [0.0, 0.2, 3.0])
def test_what_lies_within_a_circle_of_a_spot_of_two_lobes(angle: float) -> None:
    """Polarizers crossed, or nearly: the middle of the spot is dark. Against the sum over its picture."""
    (arrival,) = bench(125.0, 150.0, 30.0, angle=angle).at("cam")
    line = np.linspace(-4, 4, 1601)
    picture, square = arrival.irradiance(line, line), line[:, None] ** 2
    for radius, y in ((0.4, 0.0), (0.8, 0.0), (0.6, 0.7), (1.5, -0.3)):
        inside = square + (line[None, :] - y) ** 2 <= radius**2
        wanted = float(picture[inside].sum() / picture.sum())
        assert within(arrival.beam, np.array([y, 0.0]), radius) == pytest.approx(wanted, abs=5e-4)
    assert (within(arrival.beam, np.zeros(2), 0.4) < 0.1) == (angle == 0.0)

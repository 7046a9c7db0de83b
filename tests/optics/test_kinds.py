"""Elements of the catalog against closed forms: plates, retroreflectors, curved mirrors, slits, filters, isolators."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from light_benches import kind, light, setup_of

from pico.model.pose import Pose
from pico.optics.axis import axis_of
from pico.optics.light import Light, light_of

LASER = Pose(100, 400)  # its exit at x = 160
WIDE = {"waist_radius": 1.0, "waist_position": 240.0}


def bench(name: str, at: Pose, values: dict[str, float] | None = None, **parameters: object) -> Light:
    kinds = {"laser": kind("hene_laser", **WIDE), "x": kind(name, **parameters)}
    return light(kinds, {"laser": LASER, "x": at}, {"x": values or {}})


def onward(found: Light) -> list[int]:
    """Return the numbers of the crossings that come from the element, the brightest first."""
    mine = [n for n, c in enumerate(found.crossings) if c.before == 0]
    return sorted(mine, key=lambda n: -found.crossings[n].power)


@given(st.floats(-7, 7).filter(lambda d: abs(d) > 2), st.floats(-25, 25))
def test_a_retroreflector_sends_light_back_as_far_on_its_other_side(aside: float, yaw: float) -> None:
    found = bench("retroreflector", Pose(400, 400 + aside, yaw))
    assert found.crossings[0].event == "reflected"
    back = found.crossings[onward(found)[0]].beam
    assert back.along == pytest.approx([-1, 0, 0], abs=1e-12)
    assert back.at[1:] == pytest.approx([400 + 2 * aside, 70], abs=1e-9)
    assert found.crossings[0].onward == pytest.approx(0.975**3 * (1 - found.crossings[0].clipped), rel=1e-9)
    # the way there and back is as long as to the plane across the beam through the corner, twice
    assert found.crossings[0].beam.length + (400 - found.crossings[0].beam.at[0]) == pytest.approx(240, abs=1e-9)
    assert back.length - (400 - back.at[0]) == pytest.approx(240, abs=1e-9)
    assert back.stokes[1] / back.stokes[0] == pytest.approx(found.crossings[0].beam.stokes[1] / 1.0, abs=1e-9)


def test_a_retroreflector_that_is_met_in_its_middle_is_unknown() -> None:
    found = bench("retroreflector", Pose(400, 400.5))
    assert "several sides" in found.crossings[onward(found)[0]].beam.unknown


@pytest.mark.parametrize("yaw", [45.0, -45.0, 30.0])
@pytest.mark.parametrize("name", ["plate_beam_splitter", "pellicle_beam_splitter", "retroreflector", "concave_mirror"])
def test_geometry_alone_sends_beams_where_light_does(name: str, yaw: float) -> None:
    kinds = {"laser": kind("hene_laser"), "x": kind(name, thickness=None)}
    poses = {"laser": LASER, "x": Pose(400, 400 if name != "retroreflector" else 404, yaw)}
    axis, found = axis_of(setup_of(kinds), poses, "laser"), light(kinds, poses)
    ends = {(m.component, *np.round(m.at, 3)) for leg in axis.legs for m in leg.met[-1:]}
    assert ends == {(c.component, *np.round(c.beam.at, 3)) for c in found.crossings}


@pytest.mark.parametrize("turned", [False, True])
def test_a_plate_splitter_walks_what_passes_and_shows_a_ghost(turned: bool) -> None:
    found = bench("plate_beam_splitter", Pose(400, 400, 45 + 180 * turned))
    (passes,) = (found.crossings[n] for n in onward(found) if found.crossings[n].beam.along[0] > 0.9)
    sent, ghost, *rest = (found.crossings[n] for n in onward(found) if found.crossings[n].beam.along[0] < 0.1)
    index, thick, bare = 1.46, 3.0, 0.005
    inside = math.asin(math.sin(math.pi / 4) / index)
    walk = thick * math.sin(math.pi / 4 - inside) / math.cos(inside)
    assert not rest and ghost.beam.ghost and not sent.beam.ghost
    assert abs(passes.beam.at[1] - 400) == pytest.approx(walk, rel=1e-9)
    if turned:  # the bare face comes first
        powers = (0.48 * (1 - bare), 0.48 * (1 - bare) ** 2, bare)
    else:
        powers = (0.48 * (1 - bare), 0.48, 0.48**2 * bare)
    assert [c.power for c in (passes, sent, ghost)] == pytest.approx(powers, rel=1e-9)
    apart = 2 * thick * math.tan(inside) * math.cos(math.pi / 4)
    assert abs(sent.beam.at[0] - ghost.beam.at[0]) == pytest.approx(apart, rel=1e-6)


@pytest.mark.parametrize(("wavelength", "passes", "back"), [(632.8, 0.95, 0.02), (532.0, 0.01, 0.98)])
def test_a_dichroic_mirror_tells_colours_apart(wavelength: float, passes: float, back: float) -> None:
    kinds = {"laser": kind("hene_laser", wavelength=wavelength), "x": kind("dichroic_mirror", rear_reflectance=0.0)}
    found = light(kinds, {"laser": LASER, "x": Pose(400, 400, 45)})
    ahead = next(c for c in found.crossings[1:] if c.beam.along[0] > 0.9)
    aside = next(c for c in found.crossings[1:] if c.beam.along[0] < 0.1)
    assert (ahead.power, aside.power) == pytest.approx((passes, back), rel=1e-9)


@pytest.mark.parametrize("incidence", [0.5, 10.0, 30.0])
def test_a_concave_mirror_is_astigmatic_off_its_axis(incidence: float) -> None:
    """Coddington: 2 / (R cos i) in the plane of incidence, 2 cos i / R across it."""
    found = bench("concave_mirror", Pose(400, 400, incidence), reflectance=1.0)
    back = found.crossings[onward(found)[0]].beam
    there = np.linalg.inv(np.linalg.inv(back.curvature) - (back.length - 240) * np.eye(2)).real
    before = found.crossings[0].beam.curvature.real[0, 0]
    c = math.cos(math.radians(incidence))
    assert there[0, 0] == pytest.approx(before - 2 / (200 * c), rel=1e-6)
    assert there[1, 1] == pytest.approx(before - 2 * c / 200, rel=1e-6)


@given(st.floats(0.1, 4), st.floats(-1.5, 1.5), st.sampled_from([0.0, 90.0]))
def test_a_slit_passes_what_lies_between_its_edges(width: float, aside: float, angle: float) -> None:
    found = bench("slit", Pose(400, 400 + aside), {"width": width}, angle=angle)
    middle = aside if angle == 90 else 0.0  # an upright slit stops what is beside it
    ends = [math.erf(math.sqrt(2) * (s * width / 2 - middle) / found.crossings[0].beam.widths[0]) for s in (1, -1)]
    assert found.crossings[0].onward == pytest.approx((ends[0] - ends[1]) / 2, abs=2e-6)


@pytest.mark.parametrize(
    ("wavelength", "yaw", "passes"), [(632.8, 0, 0.9), (640, 0, 1e-4), (632.8, 20, 1e-4), (624, 20, 0.9)]
)
def test_a_bandpass_moves_to_shorter_waves_where_it_is_tilted(wavelength: float, yaw: float, passes: float) -> None:
    kinds = {"laser": kind("hene_laser", wavelength=wavelength), "x": kind("bandpass_filter")}
    found = light(kinds, {"laser": LASER, "x": Pose(400, 400, yaw)})
    assert found.crossings[0].onward == pytest.approx(passes, rel=1e-6)


def test_what_a_bandpass_does_not_pass_goes_back_where_light_is_audited() -> None:
    kinds = {"laser": kind("hene_laser", wavelength=700.0), "x": kind("bandpass_filter")}
    poses = {"laser": LASER, "x": Pose(400, 400, 3)}
    found = light_of(setup_of(kinds), poses, lit=lambda _: True, astray=lambda first: 1e-6 * first.power)
    back = [c for c in found.crossings if c.before == 0 and c.beam.along[0] < 0]
    assert sum(c.power for c in back) == pytest.approx(1 - 1e-4, rel=1e-9)


def test_an_isolator_passes_one_way() -> None:
    ahead = bench("faraday_isolator", Pose(400, 400), clear_diameter=20.0)
    assert ahead.crossings[0].onward == pytest.approx(0.9, rel=1e-4)
    s0, s1, s2, s3 = ahead.crossings[1].beam.stokes
    assert (s1 / s0, s2 / s0, s3 / s0) == pytest.approx((0, 1, 0), abs=1e-9)
    assert bench("faraday_isolator", Pose(400, 400, 180)).crossings[0].onward == pytest.approx(10**-3.5, rel=1e-3)


def test_the_beam_of_a_diode_has_two_waists() -> None:
    found = light({"laser": kind("diode_laser"), "cam": kind("beam_camera")}, {"laser": LASER, "cam": Pose(1160, 400)})
    wide, narrow, angle = found.crossings[0].beam.widths
    reach = found.crossings[0].beam.length

    def radius(waist: float, away: float) -> float:
        return waist * math.hypot(1, away * 1.2 * 660e-6 / (math.pi * waist**2))

    assert sorted((wide, narrow)) == pytest.approx(sorted((radius(0.5, reach), radius(1.6, reach + 200))), rel=1e-9)
    assert abs(math.degrees(angle)) == pytest.approx(90, abs=1e-6)


@pytest.mark.parametrize(("blades", "passes"), [("open", 1.0), ("turning", 0.5), ("closed", 0.0)])
def test_a_chopper_passes_what_its_blades_let(blades: str, passes: float) -> None:
    kinds = {"laser": kind("hene_laser", waist_radius=0.5), "x": kind("chopper"), "cam": kind("beam_camera")}
    found = light(kinds, {"laser": LASER, "x": Pose(400, 400), "cam": Pose(700, 400)}, {"x": {"blades": blades}})
    assert sum(c.power for c in found.crossings if c.component == "cam") == pytest.approx(passes, abs=1e-6)

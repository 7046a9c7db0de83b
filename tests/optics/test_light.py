"""Beams over benches: Malus, plates and splitters, folds out of plane, edges, ghosts, and what nobody can say."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from light_benches import kind, light, setup_of

from pico.manifest.catalog import read_type
from pico.manifest.checks.elements import own
from pico.manifest.files import decode
from pico.manifest.text.tree import parse
from pico.model.catalog import ClearAperture
from pico.model.pose import Pose
from pico.optics import elements
from pico.optics.beam import Beam, forward, moments
from pico.optics.light import Light, irradiance
from pico.registered import modules
from pico.resources import catalog_dir

LASER = Pose(100, 400)  # its exit at x = 160


def row(*parts: str, apart: float = 90.0) -> dict[str, Pose]:
    return {"laser": LASER, **{name: Pose(220 + apart * n, 400) for n, name in enumerate(parts)}}


def powers(found: Light, name: str) -> list[float]:
    return [c.power for c in found.crossings if c.component == name]


@given(st.floats(-180, 180), st.floats(-180, 180))
def test_malus(first: float, second: float) -> None:
    kinds = {"laser": kind("hene_laser"), "p1": kind("linear_polarizer"), "p2": kind("linear_polarizer"),
             "cam": kind("beam_camera")}  # fmt: skip
    found = light(kinds, row("p1", "p2", "cam"), {"p1": {"angle": first}, "p2": {"angle": second}})
    wanted = math.cos(math.radians(first)) ** 2 * math.cos(math.radians(second - first)) ** 2
    assert sum(powers(found, "cam")) == pytest.approx(wanted, abs=1e-9)


@given(st.floats(-90, 90), st.floats(-90, 90))
def test_a_half_wave_plate_turns_and_a_quarter_wave_plate_makes_it_round(half: float, quarter: float) -> None:
    kinds = {"laser": kind("hene_laser"), "h": kind("half_wave_plate"), "q": kind("quarter_wave_plate"),
             "cam": kind("beam_camera")}  # fmt: skip
    found = light(kinds, row("h", "q", "cam"), {"h": {"angle": half}, "q": {"angle": quarter}})
    s0, s1, s2, s3 = found.crossings[1].beam.stokes
    turned = math.radians(4 * half)
    assert (s0, s1, s2, s3) == pytest.approx((1, math.cos(turned), math.sin(turned), 0), abs=1e-9)
    # linear at a through a quarter-wave plate with its fast axis at b: S3 = sin 2 (a - b)
    (arrival,) = found.at("cam")
    assert arrival.beam.stokes[3] == pytest.approx(math.sin(math.radians(2 * (2 * half - quarter))), abs=1e-9)


def test_s3_is_positive_where_the_field_turns_counter_clockwise_looking_into_the_beam() -> None:
    kinds = {"laser": kind("hene_laser"), "q": kind("quarter_wave_plate"), "cam": kind("beam_camera")}
    (arrival,) = light(kinds, row("q", "cam"), {"q": {"angle": -45.0}}).at("cam")
    field = arrival.beam.waves[0].field
    later = field * np.exp(-0.1j)  # fields run as exp(-iwt)
    before, after = (math.atan2(f.real @ arrival.beam.up, f.real @ arrival.beam.across) for f in (field, later))
    assert (after - before) % (2 * math.pi) == pytest.approx(0.1) and arrival.beam.stokes[3] == pytest.approx(1)


@pytest.mark.parametrize("name", ["linear_polarizer", "half_wave_plate"])
def test_what_is_turned_round_shows_minus_its_angle(name: str) -> None:
    def seen(angle: float, yaw: float) -> tuple[float, ...]:
        kinds = {"laser": kind("hene_laser", polarization=20.0), "x": kind(name), "cam": kind("beam_camera")}
        poses = {**row("x", "cam"), "x": Pose(300, 400, yaw), "cam": Pose(420, 400)}
        (arrival,) = light(kinds, poses, {"x": {"angle": angle}}).at("cam")
        return arrival.beam.stokes

    assert seen(33.0, 180.0) == pytest.approx(seen(-33.0, 0.0), abs=1e-9)
    assert seen(33.0, 180.0) != pytest.approx(seen(33.0, 0.0), abs=0.1)


def test_two_polarizing_elements_share_the_light_out() -> None:
    """A polarizing cube sends horizontal light on and vertical light to the side; both together are all of it."""
    for angle in (0.0, 30.0, 90.0):
        kinds = {
            "laser": kind("hene_laser", polarization=angle), "on": kind("beam_camera"), "side": kind("beam_camera"),
            "cube": kind("polarizing_beam_splitter", transmittance=1.0, reflectance=1.0, extinction=None),
        }  # fmt: skip
        poses = {"laser": LASER, "cube": Pose(300, 400), "on": Pose(500, 400), "side": Pose(300, 600, 90)}
        found = light(kinds, poses)
        on, side = sum(powers(found, "on")), sum(powers(found, "side"))
        assert (on, side) == pytest.approx(
            (math.cos(math.radians(angle)) ** 2, math.sin(math.radians(angle)) ** 2), abs=1e-9
        )
        assert on + side == pytest.approx(1.0, abs=1e-9)


def test_an_interferometer_sends_all_light_one_way_or_the_other() -> None:
    """Mach and Zehnder: with equal arms both outputs add up to the whole, whatever the lengths are."""
    for longer in (0.0, 1e-4, 2.5e-4):
        splitter, mirror = kind("beam_splitter_50_50"), kind("mirror_tip_tilt")
        kinds = {"laser": kind("hene_laser"), "b1": splitter, "b2": splitter, "m1": mirror, "m2": mirror,
                 "one": kind("beam_camera"), "two": kind("beam_camera")}  # fmt: skip
        poses = {
            "laser": LASER, "b1": Pose(300, 400), "m1": Pose(600 + longer, 400, -45),
            "m2": Pose(300, 600 + longer, 135),
            "b2": Pose(600 + longer, 600 + longer), "one": Pose(800, 600 + longer),
            "two": Pose(600 + longer, 800, 90),
        }  # fmt: skip
        found = light(kinds, poses)
        line = np.linspace(-3, 3, 241)
        area = (line[1] - line[0]) ** 2
        out = [irradiance(found.at(name), line, line).sum() * area for name in ("one", "two")]
        assert len(found.at("one")) == len(found.at("two")) == 2
        assert sum(out) == pytest.approx(1.0, abs=1e-6)
        assert min(out) == pytest.approx(0.0, abs=1e-6), "the arms are as long as each other"


def test_a_periscope_turns_the_polarization_with_the_image() -> None:
    """Up, then to the left: light that was level to the left is upright after it (its s becomes p)."""
    beam = _periscope(math.radians(0.0))
    assert abs(beam.waves[0].field @ np.array([0.0, 0.0, 1.0])) == pytest.approx(1.0)
    upright = _periscope(math.radians(90.0))
    assert abs(upright.waves[0].field @ np.array([1.0, 0.0, 0.0])) == pytest.approx(1.0)


def _periscope(angle: float) -> Beam:
    from pico.optics.beam import Wave, beyond
    from pico.optics.gaussian import from_waist
    from pico.optics.rays import Surface

    along, left, up = np.eye(3)
    field = (math.cos(angle) * left + math.sin(angle) * up).astype(complex)
    beam: Beam | None = Beam(
        "laser", 632.8e-6, np.zeros(3), along, left, from_waist(0.5, 632.8e-6), (Wave(field, np.zeros(2, complex)),)
    )
    for vertex, normal in (([100, 0, 0], [-1, 0, 1]), ([100, 0, 100], [0, 1, -1])):
        assert beam is not None
        surface = Surface(np.array(vertex, dtype=float), np.array(normal) / math.sqrt(2))
        beam = beyond(beam, surface, reflect=True)
    assert beam is not None and beam.along == pytest.approx([0, 1, 0])
    return beam


@given(st.floats(-2, 2), st.floats(0.2, 12), st.floats(-1, 1), st.floats(-1, 1))
def test_power_and_centroid_go_straight_on_through_space(x: float, away: float, one: float, two: float) -> None:
    """Several waves that interfere keep their power in free space, and their centroid runs straight."""
    from pico.optics.beam import Wave
    from pico.optics.gaussian import from_waist

    shifts = [np.array([one, two]) * 1e-3, np.array([1j * two, 1j * one]) * 1e-4 + x * 1e-4, np.zeros(2)]
    fields = [np.array([0, 1, 0.5j]), np.array([0, 0.3j, -1]), np.array([0, -0.8, 0.2])]
    waves = tuple(Wave(f.astype(complex), s.astype(complex)) for f, s in zip(fields, shifts, strict=True))
    along, left, _ = np.eye(3)
    beam = Beam("laser", 632.8e-6, np.zeros(3), along, left, from_waist(0.3, 632.8e-6, 40.0), waves)
    at = [moments(forward(beam, distance)) for distance in (0.0, 100 * away, 200 * away)]
    assert [power for power, _ in at] == pytest.approx([at[0][0]] * 3, rel=1e-9)
    assert at[1][1] == pytest.approx((at[0][1] + at[2][1]) / 2, abs=1e-9)


def test_an_edge_stops_what_lies_beside_it() -> None:
    kinds = {"laser": kind("hene_laser", waist_radius=1.0, waist_position=60.0), "i": kind("iris"),
             "cam": kind("beam_camera")}  # fmt: skip
    for opening, aside in ((2.0, 0.0), (3.0, 0.0), (1.0, 0.3)):
        poses = {"laser": LASER, "i": Pose(220, 400 + aside), "cam": Pose(400, 400)}
        found = light(kinds, poses, {"i": {"opening": opening}})
        x, y = np.meshgrid(np.linspace(-4, 4, 2001), np.linspace(-4, 4, 2001))
        spot = 2 / math.pi * np.exp(-2 * (x**2 + y**2))
        wanted = spot[(x - aside) ** 2 + y**2 <= (opening / 2) ** 2].sum() * 0.004**2
        assert sum(powers(found, "cam")) == pytest.approx(wanted, abs=5e-4)
        (arrival,) = found.at("cam")
        assert bool(arrival.beam.unknown) == (wanted < 0.9)


@pytest.mark.parametrize("beyond", [-0.3, -0.01, 0.01, 0.3, 1.0, 3.0])  # of the chief ray, past the edge [mm]
@pytest.mark.parametrize("name", ["iris", "plano_convex_100", "mirror_tip_tilt", "linear_polarizer", "power_meter"])
def test_a_beam_whose_chief_ray_misses_an_aperture_passes_with_the_rest(name: str, beyond: float) -> None:
    kinds = {"laser": kind("hene_laser", waist_radius=1.0, waist_position=240.0), "x": kind(name),
             "cam": kind("beam_camera")}  # fmt: skip
    aperture = kinds["x"].geometry.clear_aperture
    assert aperture
    away = aperture.diameter / 2 + beyond
    poses = {"laser": LASER, "x": Pose(400, 400 + away), "cam": Pose(1500, 1000)}
    first = light(kinds, poses).crossings[0]
    x, y = np.meshgrid(np.linspace(-3, 3, 1501), np.linspace(-3, 3, 1501))
    spot = 2 / math.pi * np.exp(-2 * (x**2 + y**2)) * ((y - away) ** 2 + x**2 <= (aperture.diameter / 2) ** 2)
    wanted = float(spot.sum()) * 0.004**2
    assert first.component == "x" and 1 - first.clipped == pytest.approx(wanted if wanted > 1e-4 else 1.0, abs=2e-3)
    assert (first.event == "blocked") == (wanted < 1e-4)


def test_bare_faces_of_a_plate_show_ghosts_and_nothing_is_lost() -> None:
    kinds = {"laser": kind("hene_laser"), "cam": kind("beam_camera"),
             "f": kind("neutral_density_filter", optical_density=0.0, thickness=3.0, refractive_index=1.5,
                       coating="none")}  # fmt: skip
    found = light(kinds, {"laser": LASER, "f": Pose(300, 400, 10), "cam": Pose(500, 400)})
    at_plate = found.crossings[0]
    assert at_plate.component == "f"
    out, inside = math.radians(10), math.asin(math.sin(math.radians(10)) / 1.5)
    one = (math.tan(out - inside) / math.tan(out + inside)) ** 2  # level light lies in the plane of incidence
    main, ghost = sorted((a.power for a in found.at("cam")), reverse=True)
    assert main == pytest.approx((1 - one) ** 2, rel=1e-9)
    assert ghost == pytest.approx((1 - one) ** 2 * one**2, rel=1e-9)
    assert at_plate.onward == pytest.approx(1.0, abs=2 * one**3), "all but what goes to and fro again"
    walk = 3.0 * math.sin(out - inside) / math.cos(inside)
    bright = max(found.at("cam"), key=lambda a: a.power)
    assert abs(bright.center[0]) == pytest.approx(walk, rel=1e-9)


def test_a_lens_that_stands_turned_round_focuses_elsewhere() -> None:
    """The principal plane of a plano-convex lens lies in its curved side."""

    def waist(yaw: float) -> float:
        kinds = {"laser": kind("hene_laser", waist_radius=2.0), "cam": kind("beam_camera"),
                 "l": kind("plano_convex_100", radius_of_curvature=51.5)}  # fmt: skip
        (arrival,) = light(kinds, {"laser": LASER, "l": Pose(300, 400, yaw), "cam": Pose(400, 400)}).at("cam")
        inverse = np.linalg.inv(arrival.beam.curvature)[0, 0]
        return 400.0 - float(inverse.real) - 300.0

    focal = 51.5 / (1.5151 - 1)
    thickness = 3.6
    assert waist(0.0) == pytest.approx(focal - thickness / 1.5151 + thickness / 2, abs=0.05)
    assert waist(180.0) == pytest.approx(focal + thickness / 2, abs=0.05)


def test_a_beam_that_misses_and_one_that_comes_back() -> None:
    kinds = {"laser": kind("hene_laser"), "m": kind("mirror_tip_tilt"), "block": kind("beam_block")}
    back = light(kinds, {"laser": LASER, "m": Pose(400, 400), "block": Pose(900, 900)})
    assert [(c.component, c.event) for c in back.crossings] == [("m", "reflected"), ("laser", "blocked")]
    gone = light(kinds, {"laser": LASER, "m": Pose(400, 800), "block": Pose(900, 900)})
    assert [(c.component, c.event) for c in gone.crossings] == [("", "left")]


def test_what_is_beyond_gaussian_beams_is_said_to_be_unknown() -> None:
    kinds = {"laser": kind("hene_laser", waist_radius=0.005), "p": kind("linear_polarizer"), "cam": kind("beam_camera")}
    (arrival,) = light(kinds, {"laser": LASER, "p": Pose(260, 400, 45), "cam": Pose(400, 400)}).at("cam")
    assert "polarizer" in arrival.beam.unknown


def test_a_new_element_is_one_new_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A plate that turns polarization by 90 deg, whatever it is."""
    (tmp_path / "rotator.py").write_text(
        "import numpy as np\nfrom dataclasses import replace\nfrom pico.optics.part import Met, arrived\n\n\n"
        "def meet(part, beam):\n    came = arrived(part, beam)\n"
        "    turned = (replace(w, field=np.cross(beam.along, w.field)) for w in came.waves)\n"
        "    return Met(came, (replace(came, waves=tuple(turned)),))\n"
    )
    monkeypatch.setattr(elements, "__path__", [*elements.__path__, str(tmp_path)])
    modules.cache_clear()
    try:
        base = kind("half_wave_plate")
        rotator = replace(base, optics=replace(base.optics, element="rotator"))
        found = light({"laser": kind("hene_laser"), "r": rotator, "cam": kind("beam_camera")}, row("r", "cam"))
        assert found.at("cam")[0].beam.stokes == pytest.approx((1, -1, 0, 0))
        assert "rotator" in own() and not unknown_elements("rotator")
    finally:
        monkeypatch.undo()
        modules.cache_clear()
    assert unknown_elements("rotator") and unknown_elements("polarizr") == ["did you mean `polarizer`?"]


def unknown_elements(name: str) -> list[str]:
    """What is said of a type of that element."""
    text = (catalog_dir() / "half_wave_plate.yaml").read_text().replace("element: waveplate", f"element: {name}")
    source, _ = decode("own.yaml", text.encode())
    assert source
    (document,), _ = parse(source)
    return [d.hint or "" for d in read_type(document)[1] if d.code == "unknown-element"]


@pytest.mark.parametrize(
    ("y", "height", "said"),
    [
        (480, 70, "passes 60 mm to the right of its aperture"),
        (420, 30, "passes 40 mm above its aperture"),
        (700, 70, ""),
    ],
)
def test_a_detector_without_light_is_told_how_the_beam_passes_it(y: float, height: float, said: str) -> None:
    from pico.optics.beam_table import troubles

    meter = kind("power_meter")
    low = replace(
        meter.geometry, height=height + 25.0, clear_aperture=ClearAperture(center=(0, 0, height), diameter=9.5)
    )
    kinds = {"laser": kind("hene_laser"), "pm": replace(meter, geometry=low), "block": kind("beam_block")}
    poses = {"laser": Pose(100, 420), "pm": Pose(500, y), "block": Pose(900, 420)}
    found = troubles(setup_of(kinds), light(kinds, poses))
    (dark,) = [d for d in found if d.code == "dark"]
    assert dark.summary == f"no light comes to pm: the beam of laser {said}" if said else "no light comes to pm"

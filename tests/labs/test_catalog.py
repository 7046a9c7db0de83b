"""Every component type of the catalog loads and can be held, seen and simulated as it says."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import pytest

from pico.backends.sim.world import initial_value
from pico.manifest.catalog import catalog_names, load_catalog, read_type
from pico.manifest.files import decode
from pico.manifest.text.tree import parse
from pico.model.body import Body
from pico.model.catalog import ComponentType, Parameter, as_first_written, lifted
from pico.model.quantities import dimension
from pico.model.robot import Fingers
from pico.resources import catalog_dir

CATALOG = load_catalog()
HELD = [name for name, kind in CATALOG.items() if kind.geometry.grasp]
FLAT = [name for name in HELD if CATALOG[name].geometry.grasp.fixture == "flat"]
LATER = (
    "room_lamp", "delay_stage", "retroreflector", "plate_beam_splitter", "pellicle_beam_splitter", "dichroic_mirror",
    "slit", "pinhole", "bandpass_filter", "faraday_isolator", "right_angle_prism", "wollaston_prism",
    "reflection_grating", "beam_expander", "filter_wheel", "chopper", "off_axis_parabola", "spatial_filter",
    "fiber_coupler", "spectrometer", "balanced_detector", "translation_stage",
)  # fmt: skip
"""Types of elements that the first release did not have, or had no parameters of."""
LENSES = (60, 75, 100, 125, 150, 200, 250)


def extent(body: Body) -> tuple[float, float, float]:
    """Full edge lengths of a body's box along the component's x, y, z [mm]."""
    if body.shape == "cylinder":
        d, length = body.size
        size = {"x": (length, d, d), "y": (d, length, d), "z": (d, d, length)}[body.axis]
    else:
        size = (body.size[0], body.size[1], body.size[2])
    c, s = abs(math.cos(math.radians(body.yaw))), abs(math.sin(math.radians(body.yaw)))
    return c * size[0] + s * size[1], s * size[0] + c * size[1], size[2]


def named(kind: ComponentType, name: str) -> Body:
    return next(b for b in kind.geometry.bodies if b.name == name)


def test_every_file_is_a_type_that_loads() -> None:
    assert len(catalog_names()) >= 23 and set(CATALOG) == set(catalog_names())


@pytest.mark.parametrize("focal_length", LENSES)
def test_lenses_carry_their_focal_length_exactly(focal_length: int) -> None:
    lens = CATALOG[f"plano_convex_{focal_length}"]
    assert lens.parameters["focal_length"].value == lens.number("focal_length", "mm") == focal_length
    curved, index = lens.parameters["radius_of_curvature"].value, lens.parameters["refractive_index"].value
    assert isinstance(curved, float) and isinstance(index, float)
    assert curved / (index - 1) == pytest.approx(focal_length, rel=0.002)  # lensmaker, one side flat


def test_lenses_differ_in_nothing_but_their_glass() -> None:
    def bare(kind: ComponentType) -> ComponentType:
        return replace(kind, name="", title="", parameters={})

    assert len({repr(bare(CATALOG[f"plano_convex_{f}"])) for f in LENSES}) == 1


@pytest.mark.parametrize("name", CATALOG)
def test_a_type_says_each_parameter_once_and_lifts_to_itself_from_how_it_was_first_written(name: str) -> None:
    kind = CATALOG[name]
    then = as_first_written(kind)
    assert not kind.optics.properties and (then.optics.properties or name in LATER)  # which came later
    assert as_first_written(lifted(then)) == then
    for key, was in then.optics.properties.items():
        now, parameter = lifted(then).parameters[key], kind.parameters[key]
        assert (now.value == parameter.value) and was == pytest.approx(_in_mm_and_mw(kind, key)), key


def _in_mm_and_mw(kind: ComponentType, key: str) -> object:
    parameter = kind.parameters[key]
    scale = {"nW": 1e-6}.get(parameter.unit, 1)
    return parameter.value * scale if isinstance(parameter.value, int | float) else parameter.value


def test_a_file_of_the_first_release_is_lifted_and_keeps_its_digest() -> None:
    text = (catalog_dir() / "beam_splitter_50_50.yaml").read_text()
    text = re.sub(r"  fold: .*\n", "", text) + "\n"
    text = text.replace(
        "  element: beam_splitter\n", "  element: beam_splitter\n  properties: {fold: 60, clear_diameter: 20}\n"
    )
    source, found = decode("own.yaml", text.encode())
    assert source is not None and not found
    kind, found = read_type(parse(source)[0][0])
    assert kind is not None and not found
    assert (kind.number("fold", "deg"), kind.number("clear_diameter", "mm")) == (60, 20)
    then = as_first_written(kind)
    assert then.optics.properties == {"fold": 60, "clear_diameter": 20} and "fold" not in then.parameters


def test_a_parameter_is_read_in_the_unit_that_is_asked_for() -> None:
    wide = {"a": Parameter(value=2.2, unit="cm"), "b": Parameter(value=22.0), "c": Parameter(value="wide", unit="mm")}
    kind = replace(CATALOG["iris"], parameters={**wide, "d": Parameter(value=3.0, unit="s")})
    assert [kind.number(name, "mm") for name in "abcde"] == [pytest.approx(22), 22, None, None, None]


@pytest.mark.parametrize("name", CATALOG)
def test_units_are_units_and_tolerances_can_be_met(name: str) -> None:
    kind = CATALOG[name]
    for thing in (*kind.parameters.values(), *kind.tunables.values(), *kind.measurables.values()):
        dimension(thing.unit)
    for tunable in kind.tunables.values():
        if tunable.datatype == "float":
            assert 0 < tunable.resolution <= tunable.tolerance
            assert tunable.range and (tunable.unit or tunable.description.startswith("minus the logarithm"))
        assert (tunable.axis is not None) == (tunable.mover == "motor")
        assert tunable.axis is None or tunable.axis.backlash <= tunable.tolerance


@pytest.mark.parametrize("name", CATALOG)
def test_what_a_type_can_do_is_what_it_has(name: str) -> None:
    kind = CATALOG[name]
    assert ("set" in kind.primitives) == any(t.mover in ("motor", "electronics") for t in kind.tunables.values())
    assert ("measure" in kind.primitives) == bool(kind.measurables)
    assert ("home" in kind.primitives) == any(t.axis and t.axis.kind == "homed" for t in kind.tunables.values())
    assert ("move" in kind.primitives) == (kind.pose.mover == "arm") == (kind.geometry.grasp is not None)


@pytest.mark.parametrize("name", CATALOG)
def test_bodies_stay_below_the_height_and_on_the_table(name: str) -> None:
    geometry = CATALOG[name].geometry
    tops = [b.at[2] + extent(b)[2] / 2 for b in geometry.bodies]
    assert max(tops) == pytest.approx(geometry.height) and geometry.height <= 140
    assert min(b.at[2] - extent(b)[2] / 2 for b in geometry.bodies) == pytest.approx(0)


@pytest.mark.parametrize("name", FLAT)
def test_fingers_close_on_the_grip_and_touch_nothing_else(name: str) -> None:
    kind, fingers = CATALOG[name], Fingers()
    grasp, grip = kind.geometry.grasp, named(kind, "grip")
    assert grasp is not None
    assert 90 <= grasp.height <= 115 and grasp.yaws == (0, 90)
    assert extent(grip)[:2] == (grasp.width, grasp.width)
    assert grip.at[2] - extent(grip)[2] / 2 <= grasp.height - fingers.tip
    assert grip.at[2] + extent(grip)[2] / 2 >= grasp.height + fingers.tip
    near, far = grasp.width / 2, grasp.width / 2 + fingers.opening + fingers.thickness
    for body in kind.geometry.bodies:
        x, y, z = extent(body)
        if body.at[2] + z / 2 <= grasp.height - fingers.tip:
            continue
        for along, across, at, beside in ((x, y, body.at[0], body.at[1]), (y, x, body.at[1], body.at[0])):
            in_breadth = abs(beside) - across / 2 < fingers.breadth / 2
            reach = (abs(at) - along / 2, abs(at) + along / 2)
            assert not in_breadth or reach[1] <= near + 1e-9 or reach[0] >= far, body.name


@pytest.mark.parametrize("name", HELD)
def test_nothing_that_grips_comes_near_the_clear_aperture(name: str) -> None:
    kind = CATALOG[name]
    aperture, grasp = kind.geometry.clear_aperture, kind.geometry.grasp
    assert grasp is not None
    if aperture:
        assert grasp.height - Fingers().tip >= aperture.center[2] + aperture.diameter / 2 + 1


@pytest.mark.parametrize("name", HELD)
def test_the_marker_lies_on_top_with_a_quiet_zone(name: str) -> None:
    geometry, plate = CATALOG[name].geometry, named(CATALOG[name], "plate")
    assert geometry.marker is not None
    assert geometry.marker.at == (plate.at[0], plate.at[1], geometry.height)
    assert min(extent(plate)[:2]) >= geometry.marker.size * 8 / 6  # six cells of the marker and one of white around


def test_what_is_set_at_first_lies_in_its_range() -> None:
    for name, own in CATALOG.items():
        for word, kind in own.tunables.items():
            first = initial_value(kind)
            if kind.range and isinstance(first, float):
                assert kind.range[0] <= first <= kind.range[1], (name, word)

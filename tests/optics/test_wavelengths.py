"""Light of another wavelength than a part is made for: glasses disperse, isolators miss their angle, detectors respond
by material or are blind, and each is told."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from light_benches import kind, light, setup_of

from pico.backends.conditions import conditions
from pico.backends.measured import Reading
from pico.backends.sim.readings import Table, measurer_of
from pico.backends.sim.world import new_world
from pico.manifest.load import load_folder
from pico.model.arming import CLASSES
from pico.model.catalog import ComponentType
from pico.model.materials.glass import GLASSES, index
from pico.model.materials.response import CURVES, blind, quantum_efficiency, ratio
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.pose import Pose
from pico.optics.audit.limits import class_1, class_3b, class_of
from pico.optics.audit.state import check_light
from pico.optics.beam_table import efficiency, troubles
from pico.optics.ends import stray_beams
from pico.resources import labs_dir

PLACES = {"laser": Pose(100, 400), "part": Pose(400, 400), "pm": Pose(700, 400)}


@pytest.mark.parametrize(
    ("glass", "at", "n"),
    [("N-BK7", 587.6, 1.5168), ("N-BK7", 632.8, 1.51509), ("N-BK7", 1550, 1.50066), ("N-SF11", 587.6, 1.78472),
     ("fused silica", 632.8, 1.45702), ("fused silica", 1550, 1.44402), ("CaF2", 587.6, 1.43385)],
)  # fmt: skip
def test_a_glass_has_the_index_of_its_data_sheet(glass: str, at: float, n: float) -> None:
    assert index(glass, at) == pytest.approx(n, abs=2e-5)


@pytest.mark.parametrize("glass", GLASSES)
def test_a_glass_disperses_normally_and_stays_at_its_ends(glass: str) -> None:
    low, high = GLASSES[glass].span
    found = [index(glass, w) for w in np.linspace(low, high, 50)]
    assert all(a > b for a, b in pairwise(found))
    assert index(glass, low / 2) == found[0] and index(glass, 2 * high) == found[-1]


def focal(of: ComponentType, wavelength: float) -> float:
    """The focal length that the curvature of a beam behind a lens tells: from where it comes to a focus."""
    laser = kind("hene_laser", wavelength=wavelength, waist_radius=2.0, waist_position=0.0)
    found = light({"laser": replace_nm(laser, wavelength), "part": of, "pm": kind("power_meter")}, PLACES)
    came = next(c.beam for c in found.crossings if c.component == "pm")
    before = next(c.beam for c in found.crossings if c.component == "part")
    behind, ahead = (1 / b.curvature.real[0, 0] for b in (came, before))
    return 1 / (1 / (300 - behind) + 1 / ahead) if abs(ahead) < 1e9 else 300 - behind


def replace_nm(laser: ComponentType, wavelength: float) -> ComponentType:
    own = laser.parameters["wavelength"]
    return replace(laser, parameters={**laser.parameters, "wavelength": replace(own, value=wavelength, unit="nm")})


@pytest.mark.parametrize("name", ["plano_convex_100", "biconvex"])
def test_a_lens_of_bk7_is_longer_in_the_infrared_by_its_index(name: str) -> None:
    base = kind(name)
    visible, far = focal(base, 632.8), focal(base, 1550.0)
    assert far / visible == pytest.approx((1.51509 - 1) / (1.50066 - 1), rel=2e-3)
    plain = replace(base, parameters={n: p for n, p in base.parameters.items() if n != "glass"})
    assert focal(plain, 1550.0) == pytest.approx(focal(plain, 632.8), rel=1e-3)


@pytest.mark.parametrize("wavelength", [633.0, 780.0, 1064.0])
def test_an_isolator_loses_by_what_its_rotation_misses(wavelength: float) -> None:
    laser = replace_nm(kind("hene_laser"), wavelength)
    bench = {"laser": laser, "part": kind("faraday_isolator"), "pm": kind("power_meter")}
    power = sum(a.power for a in light(bench, PLACES).at("pm"))
    turned = 45 * (633**2 - 258.2**2) / (wavelength**2 - 258.2**2)
    assert power == pytest.approx(0.9 * math.cos(math.radians(45 - turned)) ** 2, rel=1e-6)
    back = light({**bench}, {**PLACES, "part": Pose(400, 400, 180)})
    leak = sum(a.power for a in back.at("pm"))
    assert leak == pytest.approx(10**-3.5 + 0.9 * math.sin(math.radians(45 - turned)) ** 2, rel=1e-6)


@pytest.mark.parametrize(("pure", "share"), [(None, 0.05), (20, 0.995 / 20), (200, 0.995 / 200)])
def test_a_polarizing_cube_has_an_extinction_of_what_it_reflects(pure: float | None, share: float) -> None:
    kinds = {
        "laser": kind("hene_laser"), "part": kind("polarizing_beam_splitter", reflected_extinction=pure),
        "side": kind("power_meter"),
    }  # fmt: skip
    found = light(kinds, {"laser": PLACES["laser"], "part": PLACES["part"], "side": Pose(400, 600, 90)})
    assert sum(a.power for a in found.at("side")) == pytest.approx(share, rel=1e-6)


@pytest.mark.parametrize("sensor", CURVES)
def test_a_curve_of_a_detector_rises_in_wavelength_and_is_a_share(sensor: str) -> None:
    places = [w for w, _ in CURVES[sensor]]
    assert places == sorted(set(places)) and all(0 <= q <= 1 for _, q in CURVES[sensor])
    assert blind(sensor, places[0] - 1) and blind(sensor, places[-1] + 1)
    assert max(quantum_efficiency(sensor, w) for w in places) > 0.6


def test_silicon_is_blind_where_indium_gallium_arsenide_sees() -> None:
    assert blind("silicon", 1550) and blind("cmos", 1550) and not blind("InGaAs", 1550) and not blind("thermal", 10600)
    assert blind("InGaAs", 532) and not blind("silicon", 532)
    assert ratio("thermal", 10600, 633) == 1 and ratio("silicon", 1550, 633) == 0
    assert ratio("silicon", 780, 633) == pytest.approx(780 / 633 * 0.876 / 0.8399, rel=1e-3)
    assert ratio("", 400, 632.8) == pytest.approx(400 / 632.8)


def measured(
    detector: str, measurable: str, wavelength: float, values: Mapping[str, Any] | None = None, **parameters: Any
) -> Reading:
    """What the simulator reads of a detector in a beam of 1 mW."""
    laser = replace_nm(kind("hene_laser", power=1.0), wavelength)
    bench = setup_of({"laser": laser, "pm": kind(detector, **parameters)})
    placed = {name: replace(part, home=None, pose=PLACES[name]) for name, part in bench.lab.inventory.items()}
    setup = replace(bench, lab=replace(bench.lab, inventory=placed))
    world = new_world(setup)
    own = {"laser": {"emission": True, "shutter": "open"}, "pm": values or {}}
    for name, tunables in own.items():
        for tunable, value in tunables.items():
            world = world.with_value(name, tunable, ObservedValue(value=value))
    measurer = measurer_of(setup, "pm", measurable)
    assert measurer is not None
    return measurer.read(Table(setup, Path(), world), "pm", measurable)


@pytest.mark.parametrize(
    ("detector", "measurable", "sensor"),
    [("power_meter", "power", "silicon"), ("photodiode", "voltage", "silicon"), ("beam_camera", "image", "cmos"),
     ("beam_camera", "power", "cmos")],
)  # fmt: skip
def test_a_blind_detector_knows_nothing_and_says_why(detector: str, measurable: str, sensor: str) -> None:
    found = measured(detector, measurable, 1550.0)
    assert found.value is None and found.reason == "wavelength"
    assert found.unknown == f"pm is blind to the light of laser: {sensor} sees nothing at 1550 nm"


def test_a_head_of_another_material_sees_it() -> None:
    found = measured("power_meter", "power", 1550.0, sensor="thermal", shortest=190, longest=20000, uncertainty=0.0)
    assert found.value == pytest.approx(1.0, rel=0.01)


def test_a_meter_set_to_another_wavelength_is_told_with_the_factor() -> None:
    wrong = measured("power_meter", "power", 633.0, {"wavelength": 500.0}, uncertainty=0.0)
    said = wrong.conditions["wavelength"]
    assert said.startswith("pm is set to 500 nm, and the light has 633 nm: multiply by about 0.7")
    assert isinstance(wrong.value, float)
    assert wrong.value * float(said.rpartition(" ")[2]) == pytest.approx(1.0, rel=0.01)
    right = measured("power_meter", "power", 633.0, {"wavelength": 633.0}, uncertainty=0.0)
    assert right.conditions == {"wavelength": ""} and right.value == pytest.approx(1.0, rel=0.01)


def test_a_camera_takes_its_quantum_efficiency_where_it_is_given() -> None:
    places = {name: PLACES[name] for name in ("laser", "pm")}
    camera = light({"laser": kind("hene_laser"), "pm": kind("beam_camera")}, places).parts["pm"]
    assert efficiency(camera, 632.8) == pytest.approx(0.06) and efficiency(camera, 1550) == 0
    assert efficiency(camera, 900) == pytest.approx(0.06 * 0.12 / 0.594, rel=0.02)


def seen(values: Mapping[str, Mapping[str, Any]]) -> Observation:
    return Observation(backend="sim", components={
        name: ObservedComponent(presence="seen", pose=pose, values={
            t: ObservedValue(value=v) for t, v in values.get(name, {}).items()
        }) for name, pose in PLACES.items()
    })  # fmt: skip


MADE = {"part": "623 to 643", "pm": "440 to 980"}


@pytest.mark.parametrize(
    ("wavelength", "emits", "doubt"), [(633.0, True, False), (1064.0, True, True), (1064.0, False, False)]
)
def test_what_is_made_for_another_wavelength_is_not_assured(wavelength: float, emits: bool, doubt: bool) -> None:
    kinds = {
        "laser": replace_nm(kind("hene_laser"), wavelength),
        "part": kind("faraday_isolator"),
        "pm": kind("power_meter"),
    }
    setup = setup_of(kinds)
    found = conditions(setup, seen({"laser": {"emission": emits}}), "pm", setup.measurables_of("pm")["power"])
    said = ", ".join(f"{n} is made for {of} nm, and the light has 1064 nm" for n, of in MADE.items())
    assert found["in range"] == (said if doubt else "")


@pytest.mark.parametrize("wavelength", [532.0, 1064.0, 1550.0])
def test_each_part_outside_of_its_range_is_one_warning_by_beam_and_by_state(wavelength: float) -> None:
    from pico.model.state import ComponentState, LabState

    kinds = {
        "laser": replace_nm(kind("hene_laser"), wavelength),
        "part": kind("faraday_isolator"),
        "pm": kind("power_meter"),
    }
    setup = setup_of(kinds)
    by_beam = [d for d in troubles(setup, light(kinds, PLACES)) if d.code == "outside-range"]
    parts = {n: ComponentState(pose=p, values={"emission": True} if n == "laser" else {}) for n, p in PLACES.items()}
    by_state = [d for d in stray_beams(setup, LabState(lab="light", components=parts)) if d.code == "outside-range"]
    assert by_beam == by_state
    assert [d.address for d in by_beam] == (["part"] if wavelength == 532 else ["part", "pm"])
    assert ("blind" in by_beam[-1].summary) == (wavelength == 1550)


@pytest.mark.parametrize(
    ("wavelengths", "yaw", "blocks"),
    [((632.8,), 0, False), ((660,), 0, True), ((632.8,), 30, True), ((612,), 30, False), ((660, 632.8), 0, False)],
)
def test_a_bandpass_filter_that_passes_none_of_its_light_is_told(
    wavelengths: tuple[float, ...], yaw: float, blocks: bool
) -> None:
    from pico.model.state import ComponentState, LabState

    lasers = {f"laser{n}": replace_nm(kind("hene_laser"), w) for n, w in enumerate(wavelengths)}
    kinds = {**lasers, "filter": kind("bandpass_filter"), "pm": kind("power_meter")}
    places = {
        **{f"laser{n}": Pose(100 + 100 * n, 400 + 4 * n) for n in range(len(lasers))},
        "filter": Pose(500, 400, yaw),
        "pm": Pose(700, 400),
    }
    if len(lasers) == 2:  # from the other side, where the meter stood
        places |= {"laser1": Pose(900, 400, 180), "pm": Pose(700, 600)}
    setup = setup_of(kinds)
    by_beam = [d for d in troubles(setup, light(kinds, places)) if d.code == "outside-range" and d.address == "filter"]
    parts = {n: ComponentState(pose=p, values={"emission": True} if n in lasers else {}) for n, p in places.items()}
    state = LabState(lab="light", components=parts)
    by_state = [d for d in stray_beams(setup, state) if d.code == "outside-range" and d.address == "filter"]
    assert by_beam == by_state
    assert [d.summary.partition(":")[0] for d in by_beam] == (["filter blocks the beam of laser0"] if blocks else [])


def test_the_warning_stands_at_the_line_of_the_part(tmp_path: Path) -> None:
    (tmp_path / "lab.yaml").write_text("""apiVersion: pico/v1
kind: Lab
metadata: {name: ir}
table: {size: [1200, 900], beam_height: 70, holes: {pitch: 25, first: [12.5, 12.5], thread: M6}}
robots: {}
inventory:
  laser: {type: hene_laser, pose: {x: 120, y: 400, yaw: 0}, parameters: {power: 0.2, wavelength: 1550 nm}}
  iso: {type: faraday_isolator, pose: {x: 300, y: 400, yaw: 0}}
  pm: {type: power_meter, pose: {x: 640, y: 400, yaw: 0}}
""")
    (tmp_path / "state.yaml").write_text("""apiVersion: pico/v1
kind: LabState
metadata: {lab: ir}
components:
  laser: {emission: true, shutter: open}
  pm: {wavelength: 632.8}
""")
    found = [d for d in check_light(load_folder(tmp_path)) if d.code == "outside-range"]
    where = [(d.address, d.source.path.rpartition("/")[2], d.source.start.line) for d in found if d.source]
    assert where == [("iso", "lab.yaml", 8), ("pm", "state.yaml", 6)]


@pytest.mark.parametrize("lab", ["shel", "mach_zehnder", "two_arms", "crowded", "minimal"])
def test_no_part_of_a_shipped_lab_is_outside_of_its_range(lab: str) -> None:
    found = check_light(load_folder(labs_dir() / lab))
    assert [d.summary for d in found if d.code in ("outside-range", "endless")] == []


@pytest.mark.parametrize(
    ("wavelength", "first", "third"),
    [(248, 7.85e-7, 1.5), (308, 2.63e-8 * 10**2.6, 0.05 * 10**2.6), (355, 7.9e-3, 500), (405, 0.039, 500),
     (488, 0.039 * 10**0.76, 500), (532, 0.39, 500), (632.8, 0.39, 500), (780, 0.39 * 10**0.16, 500), (1064, 1.95, 500),
     (1180, 1.95 * 10**0.54, 500), (1310, 15.6, 500), (1550, 10.0, 500), (10600, 9.6, 500)],
)  # fmt: skip
def test_laser_classes_reach_from_the_ultraviolet_to_carbon_dioxide(
    wavelength: float, first: float, third: float
) -> None:
    assert class_1(wavelength) == pytest.approx(first, rel=0.01) and class_3b(wavelength) == pytest.approx(
        third, rel=0.01
    )
    visible = 400 <= wavelength <= 700
    assert class_of(0.99 * first, wavelength) == "1"
    assert class_of(1.02 * first, wavelength) == ("2" if visible else "3R" if wavelength > 302.5 else "3B")
    assert class_of(5.2 * first if not visible else 5.1, wavelength) == "3B"
    assert class_of(1.02 * third, wavelength) == "4"


def test_a_class_never_falls_with_power_and_is_four_where_no_limit_is_known() -> None:
    assert class_1(170) is None and class_of(1e-9, 170) == "4" and class_of(1e-9, 11000) == "4"
    for wavelength in np.linspace(180, 10600, 500):
        found = [CLASSES.index(class_of(p, float(wavelength))) for p in np.geomspace(1e-7, 1e3, 40)]
        assert found == sorted(found)


def test_a_glass_that_is_unknown_is_an_error_with_the_known_ones() -> None:
    from pico.manifest.checks.parameters import wrong_parameters

    wrong = kind("plano_convex_100", glass="N-BK8")
    assert [d.summary for d in wrong_parameters(wrong, lambda _: None)] == ["`glass` is `N-BK8`"]

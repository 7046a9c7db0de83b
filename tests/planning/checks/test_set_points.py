"""Set-points through the map of their device: one without an equivalent in its limits is told before all motion."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from commanding import Pico
from hypothesis import given
from hypothesis import strategies as st
from laser_lab import set_to

from pico.backends.hardware.instruments import Instruments, add
from pico.backends.hardware.settings import Settings
from pico.drivers.registry import driver
from pico.manifest.load import load_folder
from pico.model.calibration.results import AxisZero, Evidence, Provenance
from pico.model.instruments.conversion import Conversion, conversion
from pico.model.wiring import Wired
from pico.places.bench import BenchPlace
from pico.planning.checks.set_points import axes_of, check_set_points, refused
from pico.resources import labs_dir
from pico.vision.calibration import Calibration
from pico.vision.calibration_files import accepted_axes, write_calibration

EXAMPLE = Path(__file__).resolve().parents[3] / "examples" / "devices.yaml"
MOUNT = 'identity: {serial: "11400002"}\n    map: {angle: {property: angle}}'


def told(tmp_path: Path, before: str = "", after: str = "") -> list[str]:
    """Return what is told of the case study, wired as the example with a text of it replaced."""
    shutil.copytree(labs_dir() / "shel", tmp_path / "lab")
    text = EXAMPLE.read_text()
    assert before in text
    (tmp_path / "lab" / "devices.yaml").write_text(text.replace(before, after))
    read = load_folder(tmp_path / "lab")
    found = list(check_set_points(read))
    assert all(one.code == "set-point" and one.source is not None for one in found)
    return [f"{one.source.path if one.source else ''}: {one.summary}" for one in found]


def test_the_example_reaches_all_that_the_case_study_asks_for(tmp_path: Path) -> None:
    assert told(tmp_path) == []


@pytest.mark.parametrize("map", ["scale: 1, offset: 12.5", "scale: -1", "scale: -1, offset: 300"])
def test_a_mount_is_sent_to_an_equivalent_angle(tmp_path: Path, map: str) -> None:
    assert told(tmp_path, MOUNT, MOUNT[:-2] + f", {map}}}}}") == []


def test_an_angle_that_no_turn_brings_within_the_limits_is_told_at_its_line(tmp_path: Path) -> None:
    (found,) = told(tmp_path, MOUNT, MOUNT.replace("map:", "limits: {angle: [100, 200]}\n    map:"))
    assert ".yaml: p1_mount can't set p1.angle to " in found and "no whole turn of it lies within" in found


def test_a_stage_that_reaches_nothing_of_its_range_is_told_at_its_map(tmp_path: Path) -> None:
    first, second = told(tmp_path, "offset: -2", "offset: 80")[:2]
    assert "devices.yaml: ly_150_y reaches no value of ly_150.stage_y: -2 to 2 mm is position -82 to -78 mm" in first
    assert "ly_" in second


@pytest.mark.parametrize(("limits", "uncalibrated", "calibrated"), [
    ((0, 40), True, False),  # 30 deg, and by the calibration 342.5 deg
    ((340, 345), False, True),
    ((0, 360), True, True),
])  # fmt: skip
def test_what_is_checked_is_what_a_calibrated_mount_is_sent_to(
    tmp_path: Path, limits: tuple[float, float], uncalibrated: bool, calibrated: bool
) -> None:
    """The mount is reversed, and its zero is 12.5 deg off: its device goes to (30 - 12.5) deg times -1."""
    shutil.copytree(labs_dir() / "shel", tmp_path / "lab")
    own = MOUNT.replace("map:", f"limits: {{angle: [{limits[0]}, {limits[1]}]}}\n    map:")
    (tmp_path / "lab" / "devices.yaml").write_text(EXAMPLE.read_text().replace(MOUNT, own))
    read = load_folder(tmp_path / "lab")
    setup, state = read.require()
    values = {**state.components["p1"].values, "angle": 30.0}
    turned = replace(state, components={**state.components, "p1": replace(state.components["p1"], values=values)})
    axes = {"p1.angle": AxisZero(direction=-1, zero=12.5, sigma=0.1)}
    for known, within in (({}, uncalibrated), (axes, calibrated)):
        found = [d for d in check_set_points(replace(read, state=turned), known) if d.address == "p1.angle"]
        assert (found == []) is within, [d.summary for d in found]
        planned = [*refused(setup, [set_to("p1", "angle", 30.0)], calibrated=known)]
        assert (planned == []) is within
        made = axes_of(setup, known)["p1.angle"].conversion
        assert within is made.reaches(30.0)
    sent = Instruments(axes=axes)
    about, entry = driver("elliptec.rotator"), setup.wiring.devices["p1_mount"] if setup.wiring else None
    assert entry is not None
    add(setup, sent, "p1_mount", entry, about, object(), Settings(BenchPlace(tmp_path, "hardware")))
    driven = sent.tunables["p1.angle"]
    assert vars(driven)["_conversion"] == axes_of(setup, axes)["p1.angle"].conversion


@pytest.mark.parametrize(("evidence", "axes"), [("measured", True), ("simulated", False)])
def test_validate_and_the_judges_go_by_the_calibration_of_the_bench(
    tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch, evidence: Evidence, axes: bool
) -> None:
    shutil.copytree(labs_dir() / "shel", tmp_path / "lab")
    own = MOUNT.replace("map:", "limits: {angle: [80, 100]}\n    map:")
    (tmp_path / "lab" / "devices.yaml").write_text(EXAMPLE.read_text().replace(MOUNT, own))
    how = Provenance(bench="hardware", evidence=evidence)
    zero = {"p1.angle": AxisZero(direction=1, zero=60.0, sigma=0.1)}
    found = Calibration(cameras={}, axes=zero, provenance={"axes/p1.angle": how})
    write_calibration(tmp_path / "lab", "hardware", found)
    assert (accepted_axes(tmp_path / "lab", "hardware") == zero) is axes
    monkeypatch.chdir(tmp_path / "lab")
    answer = pico("validate", "--json")
    assert any("p1_mount can't set p1.angle" in d["summary"] for d in answer.data["diagnostics"]) is axes, answer


def test_an_axis_without_limits_or_without_its_driver_says_nothing() -> None:
    setup, _ = load_folder(labs_dir() / "shel").require()
    assert axes_of(replace(setup, wiring=None)) == {}


SPAN = st.tuples(st.floats(-400, 400), st.floats(1, 800)).map(lambda s: (s[0], s[0] + s[1]))


@given(st.floats(-720, 720), st.sampled_from([1.0, -1.0, 2.0, -0.5]), st.floats(-360, 360), SPAN)
def test_what_is_reached_is_within_the_limits_and_the_same_angle(
    value: float, scale: float, offset: float, limits: tuple[float, float]
) -> None:
    wired = Wired(property="angle", scale=scale, offset=offset)
    made: Conversion = conversion(wired, "deg", "deg", limits=limits)
    if made.reaches(value):
        at = made.to_device(value)
        assert limits[0] <= at <= limits[1]
        turns = (at - made.wired.to_device(value, "deg")) / 360
        assert turns == pytest.approx(round(turns), abs=1e-6)

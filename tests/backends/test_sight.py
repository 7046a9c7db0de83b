"""The simulated bench observed by sight, with errors in its cameras: what is found, told, and not guessed."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from bench_at import bench_at
from benches import plan_to, shel, sim

from pico.backends.last_seen import LastSeen, recall, remember
from pico.backends.sight import Look
from pico.backends.sim.hand import nudge, remove
from pico.backends.sim.store import load_world, save_world
from pico.backends.sim.world import FreePose, World, new_world
from pico.diagnostics import PicoError
from pico.model.calibration.results import AxisZero
from pico.model.catalog import Footprint
from pico.model.comparing.drift import drift_of
from pico.model.comparing.status import compare
from pico.model.observation import Observation, Uncertainty, UnknownObject, doubtful, live_state
from pico.model.plan import Plan
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup
from pico.model.simulated import BadLight, SimErrors
from pico.model.state import LabState, home_state
from pico.vision.calibration import Accuracy, Calibration
from pico.vision.calibration_files import write_calibration

ERRORS = SimErrors(camera_position=0.2, camera_rotation=0.05, focal_length=0.005, marker_height=0.1)
STATE: LabState = shel()[1]


def seeing(errors: SimErrors = ERRORS) -> Setup:
    """Return the bench of the case study, seen by two cameras of fewer pixels that are not where they should be."""
    setup = shel()[0]
    cameras = {n: replace(c, pixels=(1632, 1365)) if c.robot is None else c for n, c in setup.lab.cameras.items()}
    settings = replace(setup.lab.sim, observe="sight", errors=errors)
    return replace(setup, lab=replace(setup.lab, cameras=cameras, sim=settings))


SETUP = seeing()


def look(root: Path, setup: Setup = SETUP) -> Look:
    return asyncio.run(sim(setup, root).look())


def observe(root: Path, setup: Setup = SETUP) -> Observation:
    return asyncio.run(sim(setup, root).observe())


def planned(root: Path, wanted: LabState = STATE) -> Plan:
    return asyncio.run(plan_to(sim(SETUP, root), wanted))


def change(root: Path, what: Callable[[World], World]) -> None:
    save_world(bench_at(root), what(load_world(SETUP, bench_at(root))[0]))


def said(seen: Observation, code: str) -> list[str]:
    return [problem.summary for problem in seen.problems if problem.code == code]


def test_every_part_is_found_within_what_is_said_of_it(tmp_path: Path) -> None:
    seen = observe(tmp_path)
    world = new_world(SETUP)
    assert seen.problems == () and seen.components.keys() == world.components.keys()
    for name, part in seen.components.items():
        true = world.components[name]
        assert part.pose is not None and true.pose is not None and part.presence == "seen"
        assert part.pose.distance(true.pose) <= 4 * part.uncertainty.position
        assert abs(angle_between(part.pose.yaw, true.pose.yaw)) <= 4 * part.uncertainty.yaw
        assert part.values == true.values
    assert {name: part.how for name, part in seen.components.items() if part.how != "stereo"} == {
        "laser": "fixed",
        "cam": "fixed",
    }


@pytest.mark.slow
def test_the_same_table_looks_the_same_again(tmp_path: Path) -> None:
    assert observe(tmp_path).components == observe(tmp_path).components


def test_what_was_pushed_is_seen_where_it_is_and_what_was_taken_is_missing(tmp_path: Path) -> None:
    observe(tmp_path)
    change(tmp_path, lambda w: remove(SETUP, nudge(SETUP, w, "p2", dx=300, dy=200, dyaw=40), "p1"))
    seen = observe(tmp_path)
    pose = seen.components["p2"].pose
    assert pose is not None and pose.distance(Pose(500, 420)) < 0.3 and pose.yaw == pytest.approx(40, abs=0.2)
    assert seen.components["p1"].presence == "missing" and seen.components["p1"].pose is None
    (text,) = said(seen, "marker-hidden")
    assert text.startswith("p1: no camera sees its marker 2, and its place is in plain view: it was last at (1")
    assert {c.component: c.after for c in drift_of(SETUP, seen, STATE)}["p1"] is None


UNDER = Pose(470, 590, 0)
"""A place that the parked arm hides from both cameras."""


def test_what_the_arm_hides_is_where_it_was_last(tmp_path: Path) -> None:
    change(tmp_path, lambda w: replace(nudge(SETUP, w, "p2", dx=270, dy=370), clock=100.0))
    remember(
        bench_at(tmp_path), {"p2": LastSeen(pose=UNDER, uncertainty=Uncertainty(position=0.1, yaw=0.05), time=60.0)}
    )
    part = observe(tmp_path).components["p2"]
    assert (part.presence, part.pose, part.age, part.how) == ("seen", UNDER, 40.0, "remembered")
    (text,) = said(observe(tmp_path), "marker-hidden")
    assert "arm1 hides it" in text and "40 s ago" in text


def test_what_nobody_has_seen_is_missing_though_it_may_be_hidden(tmp_path: Path) -> None:
    change(tmp_path, lambda w: nudge(SETUP, w, "p2", dx=270, dy=370))
    assert observe(tmp_path).components["p2"].presence == "missing"


def test_only_what_was_seen_is_remembered(tmp_path: Path) -> None:
    observe(tmp_path)
    assert recall(bench_at(tmp_path)).keys() == new_world(SETUP).components.keys() - {"laser", "cam"}
    (tmp_path / ".pico/benches/sim" / "seen.json").write_text("{")
    assert recall(bench_at(tmp_path)) == {}


def with_stranger(world: World, marker: int, pose: Pose) -> World:
    thing = UnknownObject(pose=pose, footprint=Footprint(box=(60, 60)), height=140.0)
    return replace(world, unknown={f"unknown/{marker}": thing})


@pytest.mark.slow
def test_a_marker_that_is_there_twice_is_neither_part(tmp_path: Path) -> None:
    change(tmp_path, lambda w: with_stranger(w, 3, Pose(700, 250)))
    seen = observe(tmp_path)
    assert seen.components["p2"].presence == "missing"
    places = sorted((round(t.pose.x, -1), round(t.pose.y, -1)) for t in seen.unknown.values())
    assert places == [(200, 220), (700, 250)]
    (text,) = said(seen, "marker-duplicate")
    assert "(200, 220)" in text and "(700, 250)" in text
    plan = planned(tmp_path)
    assert plan.errored and not any(op.component == "p2" for op in plan.operations)
    others = LabState(lab=STATE.lab, components={n: c for n, c in STATE.components.items() if n != "p2"})
    assert not planned(tmp_path, others).errored


def test_an_unknown_marker_is_an_obstacle_larger_than_any_part(tmp_path: Path) -> None:
    change(tmp_path, lambda w: with_stranger(w, 77, Pose(700, 250, 20)))
    seen = observe(tmp_path)
    thing = seen.unknown["unknown/77"]
    assert thing.pose.distance(Pose(700, 250)) < 0.5 and thing.height > 140
    largest = max(k.geometry.footprint.radius for k in SETUP.catalog.values() if k.geometry.grasp)
    assert (thing.footprint.disc or 0) >= largest
    assert said(seen, "marker-unknown") == ["marker 77 at (700, 250) is not in the inventory"]


def test_a_part_that_leans_is_an_obstacle_and_not_upright(tmp_path: Path) -> None:
    half = math.radians(12) / 2
    free = FreePose(position=(500.0, 300.0, 5.0), quaternion=(math.cos(half), math.sin(half), 0.0, 0.0))
    change(tmp_path, lambda w: w.with_body("p2", presence="toppled", pose=Pose(500, 300), free=free))
    part = observe(tmp_path).components["p2"]
    assert part.presence == "toppled" and part.pose is not None and part.pose.distance(Pose(500, 300)) < 60
    assert [d.severity for d in look(tmp_path).observation.problems] == ["warning"]


def test_black_pictures_refuse_and_name_the_cameras(tmp_path: Path) -> None:
    blind = seeing(SimErrors(lost_frames=1.0))
    with pytest.raises(PicoError) as raised:
        observe(tmp_path, blind)
    assert raised.value.exit_code == 1
    assert {d.summary for d in raised.value.diagnostics} == {
        f"the picture of camera `{name}` is black" for name in ("left", "right")
    }
    assert all(
        p.presence == "missing" or p.how == "fixed" for p in look(tmp_path, blind).observation.components.values()
    )


def test_a_frame_that_is_lost_now_and_then_is_taken_again(tmp_path: Path) -> None:
    assert not observe(tmp_path, seeing(SimErrors(lost_frames=0.2))).problems


@pytest.mark.slow
@pytest.mark.parametrize("camera", ["left", None])
def test_cameras_that_moved_are_not_parts_that_moved(tmp_path: Path, camera: str | None) -> None:
    calibrated(tmp_path)
    seen = look(tmp_path)
    assert not seen.observation.problems and 0 < max(seen.sighting.datums.values()) < 0.1
    sim(SETUP, tmp_path).world.bump(camera, shift=(3.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0))
    assert 2 < look(tmp_path).sighting.datums["left"] < 4, "how far the calibration has drifted is shown"
    with pytest.raises(PicoError, match="camera `left` has moved") as raised:
        observe(tmp_path)
    assert {d.code for d in raised.value.diagnostics} == {"calibration-drift"}
    with pytest.raises(PicoError, match="since it was calibrated"):
        planned(tmp_path)
    assert recall(bench_at(tmp_path))["p2"].pose.distance(Pose(200, 220)) < 0.3, (
        "what moved cameras see is not remembered"
    )
    calibrated(tmp_path)
    assert not observe(tmp_path).problems


def test_uncalibrated_cameras_that_are_far_from_where_the_lab_has_them_are_told(tmp_path: Path) -> None:
    sim(SETUP, tmp_path).world.bump("left", shift=(3.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0))
    assert [drift.camera for drift in look(tmp_path).sighting.drift] == ["left"]


def calibrated(root: Path, position: float = 0.02) -> None:
    """Write a calibration as a perfect one would be; `position`: how well it is said to hold [mm]."""
    accuracy = Accuracy(position=position)
    cameras = sim(SETUP, root).world.true_cameras()
    write_calibration(root, "sim", Calibration(cameras, accuracy, dict.fromkeys(cameras, 0.0), "2026-11-01T12:00:00Z"))


def test_what_is_seen_less_exactly_than_it_must_stand_is_uncertain_and_not_right(tmp_path: Path) -> None:
    calibrated(tmp_path, 3.0)
    home = home_state(SETUP)
    there = replace(home.components["p2"], slot=None, pose=Pose(520, 420))
    wanted = LabState(lab=home.lab, components={"p2": there})
    change(tmp_path, lambda w: nudge(SETUP, w, "p2", dx=320, dy=200))
    seen = observe(tmp_path)
    assert doubtful(SETUP, "p2", seen.components["p2"])
    assert [c.text[:9] for c in drift_of(SETUP, seen, wanted) if c.component == "p2"] == ["uncertain"]
    rows = {row.component: row for row in compare(SETUP, None, wanted, seen).rows if row.tunable == "pose"}
    assert rows["p2"].note == "uncertain" and not rows["p2"].equal
    assert "uncertain" in {d.code for d in planned(tmp_path, wanted).diagnostics}


def test_a_lab_without_cameras_says_so(tmp_path: Path) -> None:
    blind = replace(SETUP, lab=replace(SETUP.lab, cameras={}))
    with pytest.raises(PicoError, match="no camera over its table"):
        observe(tmp_path, blind)


def test_only_what_is_sure_is_captured(tmp_path: Path) -> None:
    calibrated(tmp_path, 3.0)
    change(tmp_path, lambda w: nudge(SETUP, w, "p2", dx=320, dy=200))
    seen = observe(tmp_path)
    assert "p2" in live_state(SETUP, seen).components
    assert live_state(SETUP, seen, sure=True).components.keys() == {"laser", "cam"}


def test_a_thing_without_a_marker_is_an_obstacle_that_holds_all_of_it(tmp_path: Path) -> None:
    cup = UnknownObject(pose=Pose(640, 250), footprint=Footprint(disc=35.0), height=95.0)
    change(tmp_path, lambda w: replace(w, unknown={"unknown/cup": cup}))
    seen = observe(tmp_path)
    ((name, thing),) = seen.unknown.items()
    assert cup.pose.distance(thing.pose) + 35 <= (thing.footprint.disc or 0) + 2 < 80
    (text,) = said(seen, "unidentified")
    assert text.startswith("something without a marker stands or lies at (6") and name == "unknown/thing_1"
    assert any(p.code == "unidentified" for p in planned(tmp_path).diagnostics)
    assert len(observe(tmp_path, seeing(replace(ERRORS, light=BadLight(dim=0.2)))).unknown) == 1


def test_markers_that_were_swapped_are_told_until_something_is_moved(tmp_path: Path) -> None:
    observe(tmp_path)
    stuck = {"p2": SETUP.lab.inventory["lx_100"].marker, "lx_100": SETUP.lab.inventory["p2"].marker}
    change(tmp_path, lambda w: replace(w, stickers=stuck))
    for _ in range(2):  # that it was told once does not make it right
        texts = said(observe(tmp_path), "marker-swapped")
        assert len(texts) == 2 and texts[0].startswith("lx_100 stands where p2 stood at the last look")
    change(tmp_path, lambda w: nudge(SETUP, w, "p2", dx=8))
    assert said(observe(tmp_path), "marker-swapped") == []


def test_a_calibration_of_axes_or_some_cameras_leaves_the_other_cameras_as_the_lab_has_them(tmp_path: Path) -> None:
    before = look(tmp_path)
    true = sim(SETUP, tmp_path).world.true_cameras()
    for cameras in ({}, {"left": true["left"]}):
        write_calibration(
            tmp_path, "sim", Calibration(cameras, axes={"p1.angle": AxisZero(direction=1, zero=1.0, sigma=0.1)})
        )
        seen = look(tmp_path)
        assert seen.observation.components.keys() == before.observation.components.keys()
        assert seen.observation.components["p1"].pose == before.observation.components["p1"].pose

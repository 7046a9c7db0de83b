"""The simulated table as data: new, stored, disturbed by hand, and after its lab changed."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from bench_at import bench_at
from benches import shel
from hypothesis import given
from hypothesis import strategies as st
from tables import reset_world

from pico.backends.sim.hand import nudge, remove
from pico.backends.sim.reconcile import reconcile
from pico.backends.sim.store import load_world, save_world, world_from_json, world_path
from pico.backends.sim.world import FreePose, World, initial_value, new_world
from pico.diagnostics import ExitCode, PicoError
from pico.edge.lease import BenchLock
from pico.edge.local import embedded
from pico.model.catalog import Axis, Tunable
from pico.model.lab import Part
from pico.model.observation import ObservedRobot, ObservedValue, UnknownObject
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.record import as_json
from pico.model.setup import Setup

SETUP, _ = shel()


def test_what_a_killed_writer_left_beside_the_world_is_cleared_by_who_reads_it(tmp_path: Path) -> None:
    dead = subprocess.Popen(["true"])
    dead.wait()
    save_world(bench_at(tmp_path), new_world(SETUP))
    path = world_path(bench_at(tmp_path))
    for number in (dead.pid, os.getpid()):
        path.with_name(f".world.json.{number}.tmp").touch()
    load_world(SETUP, bench_at(tmp_path))
    assert {p.name for p in path.parent.iterdir()} == {"world.json", f".world.json.{os.getpid()}.tmp"}


def with_parts(**parts: Part | None) -> Setup:
    """The bench with parts added, replaced or (None) taken out of the inventory."""
    inventory = {k: v for k, v in (dict(SETUP.lab.inventory) | parts).items() if v is not None}
    return replace(SETUP, lab=replace(SETUP.lab, inventory=inventory))


def test_a_new_world_has_every_part_at_home_every_axis_homed_and_the_arm_parked() -> None:
    world = new_world(SETUP)
    assert world.components["p1"].pose == Pose(110, 220, 0)
    assert world.components["laser"].pose == Pose(120, 420, 0)
    assert world.components["p1"].values["angle"] == ObservedValue(value=0.0)
    assert world.components["laser"].values["emission"].value is False
    assert world.components["laser"].values["shutter"].value == "closed"
    assert world.robots["arm1"].holding is None
    assert {b.presence for b in world.components.values()} == {"seen"}


@pytest.mark.parametrize(
    ("kind", "first"),
    [
        (Tunable(range=(2, 9)), 5.5), (Tunable(range=(2, 9), initial=2.0), 2.0),
        (Tunable(range=(0.1, 1000)), 10.0), (Tunable(range=(0, 1000)), 500.0), (Tunable(range=(-70, 70)), 0.0),
        (Tunable(range=(2, 9), mover="person"), 5.5),
        (Tunable(datatype="bool"), False), (Tunable(datatype="bool", initial=True), True),
        (Tunable(datatype="choice", choices=("a", "b")), "a"),
        (Tunable(datatype="choice", choices=("a", "b"), initial="b"), "b"),
        (Tunable(datatype="choice", choices=("open", "closed")), "closed"),
        (Tunable(range=(2, 9), axis=Axis(kind="homed", speed=1, home=4)), 4),
    ],
)  # fmt: skip
def test_a_value_starts_as_its_type_says_or_in_the_middle_of_its_range(kind: Tunable, first: Value) -> None:
    assert initial_value(kind) == first


def test_a_lab_without_a_stored_world_gets_a_new_one_and_looking_writes_nothing(tmp_path: Path) -> None:
    assert load_world(SETUP, bench_at(tmp_path)) == (new_world(SETUP), ())
    assert list(tmp_path.iterdir()) == []


numbers = st.floats(-1e4, 1e4)
poses = st.builds(Pose, numbers, numbers, numbers)
values = st.builds(
    ObservedValue,
    value=numbers | st.booleans() | st.text(max_size=5) | st.none(),
    status=st.sampled_from(["known", "commanded", "unknown"]),
)
footprints = st.sampled_from([b.geometry.footprint for b in SETUP.catalog.values()])


@st.composite
def worlds(draw: st.DrawFn) -> World:
    world = new_world(SETUP)
    bodies = {}
    for name, body in world.components.items():
        presence = draw(st.sampled_from(["seen", "missing", "held", "toppled"]))
        free = FreePose(position=(draw(numbers), 2.0, 3.0), quaternion=(1.0, 0.0, 0.0, draw(numbers)))
        bodies[name] = replace(
            body,
            presence=presence,
            pose=None if presence == "missing" else draw(poses),
            free=free if presence == "toppled" else None,
            values=draw(st.dictionaries(st.text(max_size=4), values, max_size=2)),
        )
    unknown = UnknownObject(pose=draw(poses), footprint=draw(footprints), height=draw(numbers))
    robot = ObservedRobot(
        joints=tuple(draw(st.lists(numbers, max_size=7))), holding=draw(st.sampled_from([None, "p1"]))
    )
    return replace(
        world,
        components=bodies,
        unknown={"unknown/9": unknown},
        robots={"arm1": robot},
        openings=draw(st.dictionaries(st.just("arm1"), numbers)),
        clock=draw(numbers),
    )


@given(worlds())
def test_a_stored_world_comes_back_to_the_last_digit(world: World) -> None:
    assert world_from_json(json.loads(json.dumps(as_json(world)))) == world


STORED = as_json(new_world(SETUP))
BROKEN = [
    "", "{", "[]", "null", '{"schema": "pico.world/v9"}', '{"schema": "pico.world/v1"}', "\x00\xff",
    json.dumps(STORED).replace("110", "NaN"), json.dumps(STORED)[:500],
    json.dumps(STORED | {"shapes": {}}), json.dumps(STORED | {"components": {"p1": 3}}),
]  # fmt: skip


@pytest.mark.parametrize("content", BROKEN)
def test_a_broken_file_is_one_diagnostic_that_names_it_and_the_way_out(tmp_path: Path, content: str) -> None:
    path = world_path(bench_at(tmp_path))
    path.parent.mkdir(parents=True)
    path.write_text(content, encoding="latin-1")
    with pytest.raises(PicoError) as caught:
        load_world(SETUP, bench_at(tmp_path))
    (found,) = caught.value.diagnostics
    assert str(path) in found.summary
    assert "pico sim reset" in found.hint
    reset_world(SETUP, tmp_path, "test")
    assert load_world(SETUP, bench_at(tmp_path)) == (new_world(SETUP), ())


def test_a_file_cut_off_while_it_was_written_is_never_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    old = replace(new_world(SETUP), clock=1.0)
    save_world(bench_at(tmp_path), old)
    monkeypatch.setattr("os.fsync", lambda _: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(PicoError, match="no space left"):
        save_world(bench_at(tmp_path), replace(old, clock=2.0))
    assert load_world(SETUP, bench_at(tmp_path))[0] == old


# by hand


def test_a_nudge_shifts_and_turns() -> None:
    world = nudge(SETUP, new_world(SETUP), "p1", dx=5, dy=-2, dyaw=-190)
    assert world.components["p1"].pose == Pose(115, 218, 170)


def test_a_nudge_into_another_part_is_refused_naming_it_and_the_overlap() -> None:
    with pytest.raises(PicoError, match=r"overlap p2 by 10 mm") as caught:
        nudge(SETUP, new_world(SETUP), "p1", dx=40)
    assert "p2 stands at (200, 220, 0°)" in caught.value.diagnostics[0].hint


def test_parts_may_touch_but_not_leave_the_table() -> None:
    assert nudge(SETUP, new_world(SETUP), "p1", dx=30).components["p1"].pose == Pose(140, 220, 0)
    with pytest.raises(PicoError, match="fall off the table"):
        nudge(SETUP, new_world(SETUP), "p1", dx=-200)


def test_a_misspelt_part_is_answered_with_the_nearest() -> None:
    for act in (lambda w: nudge(SETUP, w, "lx_10"), lambda w: remove(SETUP, w, "lx_10")):
        with pytest.raises(PicoError) as caught:
            act(new_world(SETUP))
        assert caught.value.diagnostics[0].hint == "did you mean `lx_100`?"


def test_a_removed_part_is_missing_and_a_nudge_puts_it_home_again() -> None:
    gone = remove(SETUP, new_world(SETUP), "p1")
    assert (gone.components["p1"].presence, gone.components["p1"].pose) == ("missing", None)
    assert nudge(SETUP, gone, "p2", dx=-90).components["p2"].pose == Pose(110, 220, 0)
    with pytest.raises(PicoError, match="is not on the table"):
        remove(SETUP, gone, "p1")
    assert nudge(SETUP, gone, "p1", dx=1).components["p1"].pose == Pose(111, 220, 0)


def test_a_hand_takes_a_part_out_of_the_gripper() -> None:
    world = new_world(SETUP).with_body("p1", presence="held", pose=Pose(300, 300))
    world = replace(world, robots={"arm1": ObservedRobot(joints=(0.0,) * 7, holding="p1")}, openings={"arm1": 25.0})
    freed = nudge(SETUP, world, "p1", dy=70)
    assert freed.robots["arm1"].holding is None
    assert freed.openings == remove(SETUP, world, "p1").openings == {}  # closed pads would tell of a part between them
    assert (freed.components["p1"].presence, freed.components["p1"].pose) == ("seen", Pose(300, 370, 0))


# the lab changed


def test_a_new_part_appears_at_home_with_a_warning() -> None:
    new = Part(type="linear_polarizer", marker=40, home="storage/c1")
    world, found = reconcile(with_parts(p3=new), new_world(SETUP))
    assert world.components["p3"].pose == Pose(290, 130, 0)
    assert [(d.severity, d.address) for d in found] == [("warning", "p3")]
    assert reconcile(with_parts(p3=new), world) == (world, ())


def test_a_new_part_whose_home_is_taken_is_missing() -> None:
    world, found = reconcile(with_parts(p3=Part(type="linear_polarizer", home="storage/b1")), new_world(SETUP))
    assert world.components["p3"].presence == "missing"
    assert "p1 stands at its home" in found[0].summary


def test_a_part_that_left_the_inventory_is_an_obstacle_and_is_itself_again_when_it_comes_back() -> None:
    moved = nudge(SETUP, new_world(SETUP), "p2", dx=5)
    world, found = reconcile(with_parts(p2=None), moved)
    assert "p2" not in world.components
    assert world.unknown["unknown/3"].pose == Pose(205, 220, 0)
    assert "unknown/3" in found[0].summary
    with pytest.raises(PicoError, match="overlap unknown/3"):
        nudge(SETUP, world, "p1", dx=40)
    back, found = reconcile(SETUP, world)
    assert (back.unknown, back.components["p2"].pose) == ({}, Pose(205, 220, 0))
    assert len(found) == 1


def test_a_part_of_another_type_keeps_what_tunables_they_share() -> None:
    world = new_world(SETUP).with_value("p1", "angle", ObservedValue(value=45.0))
    part = replace(SETUP.lab.inventory["p1"], type="half_wave_plate")
    retyped, _ = reconcile(with_parts(p1=part), world)
    assert retyped.components["p1"].values["angle"].value == 45.0
    part = replace(SETUP.lab.inventory["p1"], type="plano_convex_100")
    assert reconcile(with_parts(p1=part), world)[0].components["p1"].values == {}


def test_nobody_changes_a_table_that_somebody_moves(tmp_path: Path) -> None:
    with BenchLock(bench_at(tmp_path)).held("test"), pytest.raises(PicoError) as caught:
        embedded(SETUP, bench_at(tmp_path), "kinematic").world.nudge("p1", dx=1)
    assert caught.value.exit_code == ExitCode.LOCKED

"""Two arms at one table: each reaches its half and the middle, and what crosses the middle changes hands there."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from checker import check

from pico.backends.sim.kinematic import KinematicWorld
from pico.bench import Bench
from pico.history.example import make_example
from pico.manifest.load import load_files, load_folder
from pico.model.lab import Setup
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.plan import Base, Plan, Target
from pico.model.pose import Pose
from pico.model.state import LabState, place_of
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import fk, joint_at
from pico.motion.types import Segment
from pico.planning import plan

THICK = 90.0
"""How far an arm, its hand or what it carries reaches from the lines between its joints [mm]."""
WAY = ("stored", "polarized", "focused", "wide", "tilted", "circular", "stored")
States = dict[str, LabState]


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> tuple[Setup, States, ArmMotion]:
    folder = tmp_path_factory.mktemp("two_arms")
    repository = make_example("two_arms", folder)
    setup, _ = load_folder(folder).require()
    commits = repository.log(repository.tips())
    states = {c.label: load_files(repository.files(c.id), setup=setup).require()[1] for c in commits}
    return setup, states, ArmMotion(setup)


def observed(setup: Setup, state: LabState) -> Observation:
    seen = {}
    for name in setup.lab.inventory:
        values = state.components[name].values if name in state.components else {}
        known = {k: ObservedValue(value=v) for k, v in values.items()}
        seen[name] = ObservedComponent(pose=place_of(setup, state, name)[1], values=known)
    return Observation(backend="sim", components=seen)


def planned(lab: tuple[Setup, States, ArmMotion], a: str, b: str) -> Plan:
    setup, states, motion = lab
    return plan(
        setup, observed(setup, states[a]), states[b], motion=motion, backend="sim", fidelity="kinematic", base=Base(),
        target=Target(),
    )  # fmt: skip


def arms(setup: Setup, pose: Pose) -> set[str]:
    mounts = {name: robot.mount for name, robot in setup.lab.robots.items()}
    return {name for name, m in mounts.items() if 300 <= math.hypot(pose.x - m.x, pose.y - m.y) <= 660}


def test_each_arm_has_storage_of_its_own_and_both_reach_the_middle(lab: tuple[Setup, States, ArmMotion]) -> None:
    setup, _, motion = lab
    reached = {}
    for name, slot in setup.lab.slots.items():
        reached[name] = {arm for arm in setup.lab.robots if motion.reach(arm, "p1", slot.pose, 0.0) is None}
        assert arms(setup, slot.pose) <= reached[name]
    sides = {
        side: {frozenset(reached[n]) for n in reached if n.startswith(side)} for side in ("left", "right", "shared")
    }
    assert sides == {
        "left": {frozenset({"arm1"})},
        "right": {frozenset({"arm2"})},
        "shared": {frozenset(setup.lab.robots)},
    }


def test_every_state_is_reached_from_every_other_and_only_what_crosses_is_put_down(
    lab: tuple[Setup, States, ArmMotion],
) -> None:
    setup, states, _ = lab
    for a, b in itertools.permutations(states, 2):
        made = planned(lab, a, b)
        assert not made.errored, (a, b, [d.summary for d in made.diagnostics])
        assert check(setup, observed(setup, states[a]), states[b], made, extensions=1) == [], (a, b)
        assert made.staging.count == ("circular" in (a, b)), (a, b)
        for move in made.operations:
            if move.primitive in ("move", "stow"):
                ends = [Pose(**move.arguments[end]["pose"]) for end in ("from", "to")]
                assert all(move.robot in arms(setup, end) for end in ends), (a, b, move)


def test_a_part_that_crosses_the_table_changes_hands_in_the_middle(lab: tuple[Setup, States, ArmMotion]) -> None:
    made = planned(lab, "focused", "circular")
    first, second = (o for o in made.operations if o.component == "qwp" and o.primitive in ("move", "stow"))
    assert (first.robot, second.robot) == ("arm1", "arm2")
    assert first.arguments["to"]["slot"].startswith("shared/")
    assert first.reason.text == "put down for arm2 to take on"
    assert (made.staging.count, made.staging.proven) == (1, True)


def test_arms_work_at_the_same_time_where_they_do_not_meet(lab: tuple[Setup, States, ArmMotion]) -> None:
    made = planned(lab, "stored", "focused")
    work = sum(o.seconds for o in made.operations if o.robot)
    assert made.bound is not None
    assert made.bound <= made.makespan < 0.6 * work


def test_where_arms_meet_one_waits_for_the_other(lab: tuple[Setup, States, ArmMotion]) -> None:
    made = planned(lab, "polarized", "focused")
    inside = [o for o in made.operations if "zone/arm1+arm2" in o.resources]
    assert {o.robot for o in inside} == {"arm1", "arm2"}
    for a, b in itertools.pairwise(inside):
        assert a.start + a.seconds <= b.start + 1e-6


def chain(setup: Setup, robot: str, joints: tuple[float, ...]) -> np.ndarray:
    """Points along the links of an arm, down to the finger tips, on the table [mm]."""
    mounted = setup.lab.robots[robot]
    c, s = math.cos(math.radians(mounted.mount.yaw)), math.sin(math.radians(mounted.mount.yaw))
    bends = [(0.0, 0.0, 0.0), *(joint_at(joints, n) for n in (2, 4, 6, 7)), fk(joints, mounted.gripper.tool)[0]]
    points = [p + (q - p) * t for p, q in itertools.pairwise(np.array(bends)) for t in np.linspace(0, 1, 12)]
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.array(points) @ turn + np.array([mounted.mount.x, mounted.mount.y, mounted.mount.z])


def test_arms_never_come_near_one_another_while_the_bench_follows_its_history(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[tuple[tuple[float, ...], tuple[float, ...]]] = []
    walk = KinematicWorld._walk

    def watched(self: KinematicWorld, robot: str, segment: Segment) -> Iterator[float]:
        for pause in walk(self, robot, segment):
            yield pause
            seen.append((self._joints["arm1"], self._joints["arm2"]))

    monkeypatch.setattr(KinematicWorld, "_walk", watched)
    make_example("two_arms", tmp_path / "lab")
    with Bench.open(tmp_path / "lab") as bench:
        for tag in WAY:
            made = bench.plan(tag)
            report = bench.apply(made)
            assert (report.outcome, report.failed, report.remaining) == ("done", 0, ()), (tag, report.diagnostics)
            assert report.seconds == pytest.approx(made.makespan, rel=0.01)
            assert bench.plan(tag).operations == ()
        setup = bench.setup
    both = [b for a, b in itertools.pairwise(seen) if a[0] != b[0] or a[1] != b[1]]
    nearest = min(
        np.linalg.norm(chain(setup, "arm1", one)[:, None] - chain(setup, "arm2", two)[None], axis=2).min()
        for one, two in both[::3]
    )
    assert nearest > 2 * THICK, "an arm is no thicker than that, nor what it carries"

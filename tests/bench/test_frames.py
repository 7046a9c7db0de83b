"""What moves in a run or a plan, moment by moment: as the twin moves it, and honest where nobody knows."""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from pico.bench.bench import Bench
from pico.bench.picturing.deeds import Deed, before, deeds_of_run
from pico.bench.picturing.frames import frames_of_plan, frames_of_run
from pico.bench.picturing.walking import ANGLE, Walk, thinned
from pico.motion.deferred import DeferredMotion
from pico.motion.kinematics import tool_pose
from pico.runs.document import RecordedRun
from pico.twin.snapshot import Recording, at

Document = dict[str, Any]


@pytest.fixture(scope="module")
def ran(
    case_study: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[Bench, Document, RecordedRun, Recording]]:
    """The case study after e1, with the frames of its plan, the run, and what the twin saw of it."""
    folder = shutil.copytree(case_study, tmp_path_factory.mktemp("frames") / "shel")
    with Bench.open(folder) as bench:
        plan, filmed = bench.plan("e1"), Recording()
        ahead, doubts = frames_of_plan(bench.setup, plan, bench.observe())
        assert not doubts
        run = bench.moves.run(plan, recording=filmed)
        list(run)
        assert run.report.reached
        yield bench, ahead, bench.history.recorded_run()[0], filmed


def track(found: Document, kind: str, index: int) -> list[tuple[float, list[float]]]:
    """The keys of an arm (its joints) or a body."""
    keys = [(said["time"], one) for said in found["moved"] for one in said[kind] if one[0] == index]
    return [(time, one[1] if kind == "arms" else one[1:]) for time, one in keys]


def between(keys: list[tuple[float, list[float]]], time: float) -> list[float]:
    """Where something is at a time, straight between its keys."""
    if time <= keys[0][0]:
        return keys[0][1]
    for (t0, a), (t1, b) in pairwise(keys):
        if t0 <= time <= t1 and t1 > t0:
            return [p + (time - t0) / (t1 - t0) * (q - p) for p, q in zip(a, b, strict=True)]
    return keys[-1][1]


def part(found: Document, name: str) -> int:
    (index,) = (one["index"] for one in found["scene"]["components"] if one["name"] == name)
    return int(index)


def test_a_replay_moves_as_the_twin_moved(ran: tuple[Bench, Document, RecordedRun, Recording]) -> None:
    bench, _, run, filmed = ran
    found, doubts = frames_of_run(bench.setup, run)
    assert (found["schema"], found["origin"], found["evidence"]) == ("pico.frames/v1", "reconstructed", "kinematic")
    assert not doubts and found["run"] == run.document.id
    arm, p2 = track(found, "arms", 0), track(found, "bodies", part(found, "p2"))
    began, ends = filmed.snapshots[0].time, filmed.snapshots[-1].time
    assert ends - began == pytest.approx(found["seconds"], abs=1e-3)
    for number in range(200):
        time = number / 199 * found["seconds"]
        there = at(filmed.snapshots, began + time)
        assert between(arm, time) == pytest.approx(there.joints["arm1"], abs=0.02)
        where = [1000 * v for v in there.places["p2"].position]
        assert between(p2, time)[:3] == pytest.approx(where, abs=4.0)


def test_a_run_that_goes_as_planned_looks_as_its_plan(ran: tuple[Bench, Document, RecordedRun, Recording]) -> None:
    bench, ahead, run, _ = ran
    found, _ = frames_of_run(bench.setup, run)
    assert ahead["origin"] == "planned" and ahead["plan"] == run.document.plan
    assert ahead["seconds"] == pytest.approx(found["seconds"], abs=1e-3)
    assert [step["address"] for step in ahead["steps"]] == [step["address"] for step in found["steps"]]
    for (t0, a), (t1, b) in zip(track(ahead, "arms", 0), track(found, "arms", 0), strict=True):
        assert t0 == pytest.approx(t1, abs=1e-3) and a == pytest.approx(b, abs=5e-3)


def test_it_tells_what_hands_hold_and_how_light_runs(ran: tuple[Bench, Document, RecordedRun, Recording]) -> None:
    _, ahead, _, _ = ran
    states = [
        said["data"]["state"] for said in ahead["told"] if said["kind"] == "component" and said["data"]["name"] == "p2"
    ]
    assert states[:2] == ["held", "seen"]
    assert [said["time"] for said in ahead["told"]] == sorted(said["time"] for said in ahead["told"])
    light = [said["data"]["beams"] for said in ahead["told"] if said["kind"] == "beams"]
    assert not any(beam["lit"] for beam in light[0]) and any(beam["lit"] for beam in light[-1])
    names = [phase for _, robot, phase in ahead["phases"] if robot == "arm1"][:8]
    assert names == ["approach", "descend", "grip", "lift", "transit", "lower", "release", "retreat"]
    last = {said["data"]["name"]: said["data"] for said in ahead["told"] if said["kind"] == "component"}
    assert last["p2"]["pose"] == {"x": 520.0, "y": 420.0, "yaw": 30.0}
    assert last["p2"]["values"]["angle"]["value"] == 90.0


def test_what_is_in_hand_goes_with_the_hand(ran: tuple[Bench, Document, RecordedRun, Recording]) -> None:
    bench, ahead, _, _ = ran
    arm, robot = track(ahead, "arms", 0), bench.setup.lab.robots["arm1"]
    keys = track(ahead, "bodies", part(ahead, "p2"))
    low = tool_pose(robot, tuple(between(arm, keys[0][0])))[2]
    moving = [(time, body) for time, body in keys if keys[0][0] < time < keys[-1][0] - 2.0 and body[2] > 1.0]
    assert len(moving) > 10 and max(body[2] for _, body in moving) > 50.0
    for time, body in moving:
        x, y, z, _ = tool_pose(robot, tuple(between(arm, time)))
        assert body[:3] == pytest.approx((x, y, z - low), abs=0.5)


def test_a_run_that_a_commit_carries_begins_as_it_began(ran: tuple[Bench, Document, RecordedRun, Recording]) -> None:
    bench, _, run, _ = ran
    carried = replace(run, before=None)
    deeds = deeds_of_run(carried)
    found, own = before(bench.setup, carried, deeds), before(bench.setup, run, deeds)
    for name, one in own.components.items():
        assert found.components[name].pose == one.pose, name
        assert found.components[name].values == one.values, name


def test_where_nobody_knows_the_way_it_jumps_and_says_so(ran: tuple[Bench, Document, RecordedRun, Recording]) -> None:
    bench, _, run, _ = ran
    deeds = deeds_of_run(run)
    (first,) = (deed for deed in deeds if deed.operation.id == "op1")
    elsewhere = {"pose": {"x": 900.0, "y": 100.0, "yaw": 0.0}}  # not where it stands
    odd = replace(first.operation, arguments={**first.operation.arguments, "from": elsewhere})
    walk = Walk(bench.setup, DeferredMotion(bench.setup), before(bench.setup, run, deeds))
    keys = list(walk.keys([replace(first, operation=odd)]))
    assert [one.code for one in walk.told] == ["way"] and "op1" in walk.told[0].summary
    assert [key.parts for key in keys] == [("p2",), ("p2",)] and keys[0].time == keys[1].time == first.end
    assert keys[0].moment.places["p2"].pose.x == pytest.approx(200.0)
    assert keys[1].moment.places["p2"].pose.x == pytest.approx(520.0)


def test_what_failed_stops_on_its_way(ran: tuple[Bench, Document, RecordedRun, Recording]) -> None:
    bench, _, run, _ = ran
    deeds = deeds_of_run(run)
    (first,) = (deed for deed in deeds if deed.operation.id == "op1")
    cut: Deed = replace(first, seconds=4.5, outcome="failed", after=None)
    keys = list(Walk(bench.setup, DeferredMotion(bench.setup), before(bench.setup, run, deeds)).keys([cut]))
    assert keys[-1].time == first.start + 4.5
    held = keys[-1].moment.seen
    assert held.robots["arm1"].holding == "p2" and held.components["p2"].presence == "held"


def test_between_the_waypoints_that_are_kept_joints_go_straight() -> None:
    times = tuple(0.02 * n for n in range(101))
    joints = tuple((math.sin(t), 0.5 * t) for t in times)
    kept = [(times[i], joints[i]) for i in (0, *thinned(times, joints))]
    assert 4 < len(kept) < 40 and kept[-1] == (times[-1], joints[-1])
    for time, found in zip(times, joints, strict=True):
        said = between([(t, list(q)) for t, q in kept], time)
        assert said == pytest.approx(found, abs=ANGLE + 1e-9)

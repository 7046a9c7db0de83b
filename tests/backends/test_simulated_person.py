"""The simulated person: how well a hand puts a part down and turns a screw, and benches on which it moves all parts."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pico.backends.sim.person import steps as hands
from pico.bench.bench import Bench
from pico.model.catalog import PoseTolerance, Tunable
from pico.model.pose import Pose, angle_between
from pico.resources import labs_dir

NUMBERS = st.floats(-500, 500)


@given(NUMBERS, NUMBERS, st.floats(-180, 180), st.integers())
def test_a_part_is_nudged_until_it_stands_within_its_tolerance(x: float, y: float, yaw: float, seed: int) -> None:
    goal, tolerance = Pose(x, y, yaw), PoseTolerance(position=0.3, yaw=0.3)
    at = hands.put(goal, tolerance, random.Random(seed))
    assert at.distance(goal) <= 0.3 and abs(angle_between(goal.yaw, at.yaw)) <= 0.3
    assert at == hands.put(goal, tolerance, random.Random(seed)), "the same world, the same hand"


def test_without_a_tolerance_to_look_for_a_hand_scatters_as_stated() -> None:
    loose, draw = PoseTolerance(position=1e6, yaw=360.0), random.Random(1)
    found = [hands.put(Pose(0, 0, 0), loose, draw) for _ in range(4000)]
    for values, sigma in (([p.x for p in found], 0.5), ([p.y for p in found], 0.5), ([p.yaw for p in found], 1.0)):
        assert (sum(v * v for v in values) / len(values)) ** 0.5 == pytest.approx(sigma, rel=0.05)


@given(NUMBERS, NUMBERS, st.floats(0.01, 5), st.integers())
def test_a_screw_is_turned_until_it_reads_what_it_should(start: float, goal: float, within: float, seed: int) -> None:
    kind = Tunable(unit="mrad", range=(-500, 500), tolerance=within, mover="person")
    found = hands.turn(kind, start, goal, random.Random(seed))
    assert isinstance(found, float) and abs(found - goal) <= within and -500 <= found <= 500


@pytest.mark.parametrize(("datatype", "goal"), [("bool", True), ("choice", "up")])
def test_what_has_no_scale_is_set_exactly(datatype: Any, goal: Any) -> None:
    kind = Tunable(datatype=datatype, choices=("up", "down") if datatype == "choice" else (), mover="person")
    assert hands.turn(kind, None, goal, random.Random(1)) == goal


def bench_of_hands(folder: Path) -> Path:
    """Write the lab `shel` without its arm, with a mirror whose screws a person turns."""
    lab = yaml.safe_load((labs_dir() / "shel" / "lab.yaml").read_text())
    del lab["robots"]
    lab["cameras"] = {name: one for name, one in lab.get("cameras", {}).items() if "robot" not in one}
    lab["inventory"]["flip"] = {"type": "mirror_flip", "marker": 40, "pose": {"x": 900, "y": 300, "yaw": 0}}
    (folder / "state").mkdir(parents=True)
    (folder / "lab.yaml").write_text(yaml.safe_dump(lab))
    return folder


def state(lab: Path, **components: Any) -> None:
    head = {"apiVersion": "pico/v1", "kind": "LabState", "metadata": {"lab": "shel"}}
    (lab / "state" / "table.yaml").write_text(yaml.safe_dump({**head, "components": components}))


def test_a_bench_without_arms_comes_to_its_manifest_by_hand(tmp_path: Path) -> None:
    lab = bench_of_hands(tmp_path / "lab")
    one, other = {"x": 400, "y": 600, "yaw": 0}, {"x": 520, "y": 600, "yaw": 90}
    state(lab, p1={"pose": one}, p2={"pose": other}, flip={"flipped": "down"})
    with Bench.open(lab) as bench:
        plan = bench.plan()
        moved = [op for op in plan.operations if op.primitive == "operator"]
        assert {op.component for op in moved} == {"p1", "p2", "flip"} and not plan.errored
        assert all("person" in op.resources for op in moved), "one person does one step after the other"
        assert bench.apply(plan).outcome == "done"
        assert not bench.plan().operations
    state(lab, p1={"pose": other}, p2={"pose": one}, flip={"flipped": "up"})  # each stands where the other goes
    with Bench.open(lab) as bench:
        plan = bench.plan()
        steps = [op.component for op in plan.operations if op.component in ("p1", "p2")]
        assert len(steps) == 3 and steps[0] == steps[2] != steps[1], "one is put aside on the way"
        report = bench.apply(plan)
        assert report.outcome == "done", report
        seen = bench.observe().components
        assert seen["flip"].values["flipped"].value == "up"
        for name, goal in (("p1", other), ("p2", one)):
            pose = seen[name].pose
            assert pose is not None and 0 < pose.distance(Pose(**goal)) <= 0.5

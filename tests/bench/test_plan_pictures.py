"""Pictures show what is held or has fallen over, and in red what makes a plan impossible."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from attended import ended_when
from bench_at import bench_at

import pico
from pico.backends.sim.store import load_world, save_world
from pico.backends.sim.world import FreePose
from pico.bench.bench import Bench
from pico.bench.picturing.contents import goals, marks, places, steps
from pico.drawing.conflict_marks import Mark
from pico.history.examples.example import make_example
from pico.model.operation import Operation, Reason
from pico.model.pose import Pose

P2 = "  p2:\n    pose:\n      x: 520"


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pictures") / "shel"
    make_example("shel", folder)
    return folder


@pytest.fixture
def folder(example: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(example, tmp_path / "shel"))


def write(path: Path, before: str, after: str) -> None:
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after, 1))


def red(image: np.ndarray) -> int:
    """How many pixels have the color of a mark."""
    return int(np.sum(np.all(np.abs(image.astype(int) - (205, 20, 20)) < 12, axis=2)))


def carrying(bench: Bench) -> str:
    """Stop a run at once while a component is in the gripper; return which."""
    carried = ended_when(bench, bench.plan("e1"), lambda event: event.data.get("phase") == "transit", at_once=True)
    (held,) = carried.held.values()
    return held


@pytest.mark.slow
def test_a_held_component_is_drawn_in_the_hand(folder: Path) -> None:
    with pico.open(folder) as bench:
        held = carrying(bench)
        in_space = bench.sim.placements()
        assert in_space[held].position[2] > 0.1  # m above the table
        assert places(bench.setup, bench.observe(), in_space)[held] == in_space[held]
        shown = bench.pictures.render(size=(320, 240))
        bench.sim.remove(held)
        assert np.mean(np.any(shown != bench.pictures.render(size=(320, 240)), axis=2)) > 0.002


def test_a_toppled_component_lies_where_it_fell(folder: Path) -> None:
    with pico.open(folder) as bench:
        world, _ = load_world(bench.setup, bench_at(folder))
        pose = world.components["p2"].pose
        lying = FreePose(position=(600.0, 300.0, 30.0), quaternion=(0.7071, 0.7071, 0.0, 0.0))
        fallen = replace(world.components["p2"], presence="toppled", pose=pose, free=lying)
        save_world(bench_at(folder), replace(world, components={**world.components, "p2": fallen}))
        placement = places(bench.setup, bench.observe(), bench.sim.placements())["p2"]
        assert placement == bench.sim.placements()["p2"]
        assert placement.tilt == pytest.approx(90, abs=0.1)
        assert bench.pictures.render(view="top", size=(320, 240)).shape == (240, 320, 3)


def test_what_nobody_knows_in_space_is_left_out(folder: Path) -> None:
    with pico.open(folder) as bench:
        held = carrying(bench)
        assert held not in places(bench.setup, bench.observe(), {})


def test_goals_that_overlap_are_outlined_in_red(folder: Path) -> None:
    with pico.open(folder) as bench:
        bench.apply()
    fine = pico.open(folder)
    assert red(fine.pictures.render(view="top", plan=True)) == 0
    write(folder / "state" / "table.yaml", P2, P2.replace("520", "310"))
    with pico.open(folder) as bench:
        plan = bench.plan()
        assert marks(bench.setup, plan) == (Mark("p2", "p1", "40 mm", goals=True),)
        assert goals(bench.setup, plan)["p2"].x == 310
        assert red(bench.pictures.render(view="top", plan=plan)) > 200


def test_a_ring_is_drawn_as_arrows_between_two(folder: Path) -> None:
    with pico.open(folder) as bench:
        bench.apply()
    for name in ("p1", "p2"):
        write(folder / "lab.yaml", f"  {name}:\n", f"  {name}:\n    stage: never\n")
    table = folder / "state" / "table.yaml"
    write(table, P2, P2.replace("520", "290"))
    write(table, "  p1:\n    pose:\n      x: 290", "  p1:\n    pose:\n      x: 520")
    with pico.open(folder) as bench:
        bench.lab.adopt()
        plan = bench.plan()
        assert plan.errored
        assert set(marks(bench.setup, plan)) == {Mark("p1", "p2", "60 mm"), Mark("p2", "p1", "60 mm")}
        image = bench.pictures.render(view="top", plan=plan)
        # p1 at x = 290, p2 at 520: the arrows bend to either side of the line between them
        assert red(image[:, 300:400]) > 60


def test_a_step_by_hand_is_drawn_with_its_way_and_said_to_be_one() -> None:
    moved = {"from": {"pose": {"x": 1, "y": 2, "yaw": 0}}, "to": {"pose": {"x": 30, "y": 2, "yaw": 0}}}
    lens = Operation(id="1", primitive="operator", component="lens", arguments=moved, reason=Reason(kind="operator"))
    flip = replace(lens, id="2", component="flip", arguments={"tunable": "flipped", "from": "up", "to": "down"})
    plan: Any = SimpleNamespace(operations=(lens, flip), changes=())
    first, second = steps(plan)
    assert first.words == "by hand, (1, 2, 0°) → (30, 2, 0°)" and first.goal == Pose(30, 2, 0)
    assert second.words == "by hand, up → down"

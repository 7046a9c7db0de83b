"""Every step is looked at: what an arm runs into is found, what it may touch is not reported."""

from __future__ import annotations

import pytest
from oracles.penetration import Watch
from physical import bench, finish, fresh, path_to, to

from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.kinematics import columns

GOAL = Pose(395.0, 420.0, 30.0)


@pytest.fixture(scope="module")
def setup() -> Setup:
    return bench()


def test_a_planned_move_touches_nothing_but_its_part(setup: Setup) -> None:
    world, physics = fresh(setup)
    watch = Watch(physics.twin)
    finish(physics, physics.move(to("lx_125", GOAL), path_to(setup, world, "lx_125", GOAL)))
    assert watch.touches == {}
    assert watch.steps == pytest.approx(physics.twin.data.time / 0.002, abs=1)


def test_a_hand_that_is_driven_into_a_part_is_found(setup: Setup) -> None:
    _, physics = fresh(setup)
    watch = Watch(physics.twin)
    part = physics.twin.placement("p1").pose
    over = columns(setup.lab.robots["arm1"], part.x, part.y, 0.0)[0]
    high, low = over.at(250.0), over.at(40.0)
    assert high is not None
    assert low is not None
    physics.twin.drive("arm1", (0.0, 2.0, 3.0), (physics.twin.joints("arm1"), high, low))
    physics.advance(3.5)
    assert any("p1/" in touch.first + touch.second for touch in watch.touches.values())
    assert watch.deepest > 0.01


@pytest.mark.slow
def test_nothing_is_touched_in_random_moves() -> None:
    import sys
    from pathlib import Path

    sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "benchmarks"))
    from pick_and_place import Run

    run = Run(bench(), 5, off=(2.0, 2.0), watched=True)
    done = list(run.trials(25))
    assert [t.failure for t in done if t.failure] == []
    assert run.watch is not None
    assert run.watch.touches == {}

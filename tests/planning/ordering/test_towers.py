"""A lens and a part 300 mm tall change places, by an arm and by a gantry, in the arms' own motions."""

from __future__ import annotations

from dataclasses import replace

import pytest
from planning_benches import moves, planned, see, want

from pico.model.catalog import ComponentType, Footprint, Geometry, Grasp
from pico.model.lab import Lab, Margins, Part, Slot, Table
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.motion.arms import ArmMotion

TOWER = Geometry(
    footprint=Footprint(box=(60, 60)), height=300, mass=1.0, grasp=Grasp(height=260, width=60, yaws=(0, 90))
)
LENS = Geometry(
    footprint=Footprint(box=(60, 60)), height=140, mass=0.3, grasp=Grasp(height=100, width=60, yaws=(0, 90))
)
ARM = Robot(mount=Mount(x=480, y=760, yaw=-90))
GANTRY = Robot(model="gantry", mount=Mount(x=0, y=0))
THERE, BACK = {"c0": (480, 420), "t": (250, 420)}, {"c0": (250, 420), "t": (480, 420)}


def towers(robot: Robot) -> Setup:
    lab = Lab(
        name="bench", table=Table(size=(1200, 900)), margins=Margins(body=2, fingers=2), robots={"arm1": robot},
        slots={f"s{n}": Slot(x=200 + 90 * n, y=230) for n in range(6)},
        inventory={"c0": Part(type="lens", home="s0"), "t": Part(type="tower", home="s3")},
    )  # fmt: skip
    kinds = {"lens": LENS, "tower": TOWER}
    return Setup(lab=lab, catalog={n: ComponentType(name=n, title=n, geometry=g) for n, g in kinds.items()})


@pytest.mark.parametrize("robot", [ARM, GANTRY])
def test_what_is_taller_than_the_arm_carries_is_refused_at_once(robot: Robot) -> None:
    setup = towers(robot)
    made = planned(setup, see(setup, THERE), want(BACK), ArmMotion(setup))
    (found,) = made.diagnostics
    assert made.operations == () and found.summary == (
        "t can't be picked up at (250, 420, 0°): t is 300 mm tall; to leave it arm1 must rise to 312 mm, and carries "
        "at 250 mm"
    )
    assert found.hint == "let arm1 carry higher (`transit_height: 312`), or let a person move it (`mover: person`)"


@pytest.mark.parametrize("robot", [ARM, GANTRY])
def test_as_high_as_the_refusal_says_they_change_places_and_the_arm_parks(robot: Robot) -> None:
    setup = towers(replace(robot, transit_height=312.0))
    made = planned(setup, see(setup, THERE), want(BACK), ArmMotion(setup))
    assert made.diagnostics == () and len(moves(made)) == 3
    assert made.operations[-1].primitive == "park"


def test_a_tower_that_only_stands_there_is_in_the_way_of_no_plan() -> None:
    setup = towers(GANTRY)
    made = planned(setup, see(setup, THERE), want({"c0": (30, 420), "t": (250, 420)}), ArmMotion(setup))
    assert made.diagnostics == () and moves(made) == [("c0", "30,420")]

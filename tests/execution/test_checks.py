"""What must hold of the bench before a plan starts, asked directly."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from benches import shel

from pico.backends.device import Capabilities
from pico.diagnostics import ExitCode, PicoError
from pico.execution.checks import require_applicable, require_current
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, live_state
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.state import home_state, place_of

SETUP, _ = shel("gantry")
HOME = {n: place_of(SETUP, home_state(SETUP), n)[1] for n in SETUP.lab.inventory}
AWAY = Pose(520, 420, 30)


def move(start: Pose, goal: Pose, id: str = "op1", name: str = "p2", **held: bool) -> Operation:
    arguments: dict[str, Any] = {"from": {"pose": as_json(start), **held}, "to": {"pose": as_json(goal)}}
    why = Reason(kind="changed")
    return Operation(id=id, primitive="move", component=name, robot="arm1", reason=why, arguments=arguments)


def seen(holding: str | None = None, without: str = "", **poses: Pose) -> Observation:
    parts = {n: ObservedComponent(pose=p) for n, p in {**HOME, **poses}.items() if n != without}
    return Observation(backend="sim", components=parts, robots={"arm1": ObservedRobot(joints=(), holding=holding)})


def plan(*operations: Operation, base: Observation | None = None) -> Plan:
    lab, was = LabRef(name="shel", digest=SETUP.digest()), Base(state=live_state(SETUP, base or seen()).as_json())
    return Plan(lab=lab, backend="sim", fidelity="kinematic", base=was, target=Target(), operations=operations)


def refused(made: Plan, now: Observation) -> str:
    with pytest.raises(PicoError) as caught:
        require_current(SETUP, made, now)
    assert caught.value.exit_code == ExitCode.STALE
    return "; ".join(d.summary for d in caught.value.diagnostics)


def test_a_part_that_is_picked_twice_is_looked_for_where_it_is_picked_first() -> None:
    require_current(SETUP, plan(move(HOME["p2"], AWAY), move(AWAY, HOME["p2"], "op2")), seen())


@pytest.mark.parametrize(
    ("dx", "dyaw", "stale"), [(0.4, 0.0, False), (0.6, 0.0, True), (0.0, 0.4, False), (0.0, 0.6, True)]
)
def test_a_part_is_picked_within_its_tolerance_in_place_and_yaw(dx: float, dyaw: float, stale: bool) -> None:
    assert SETUP.type_of("p2").pose.tolerance.position == SETUP.type_of("p2").pose.tolerance.yaw == 0.5
    there = Pose(HOME["p2"].x + dx, HOME["p2"].y, HOME["p2"].yaw + dyaw)
    made, now = plan(move(HOME["p2"], AWAY)), seen(p2=there)
    if stale:
        assert f"p2 changed by {dx:.3g} mm, {dyaw:.3g}°" in refused(made, now)
    else:
        require_current(SETUP, made, now)


@pytest.mark.parametrize(("dx", "dyaw"), [(3.0, 0.0), (0.0, 8.0)])
def test_a_part_is_not_picked_beside_where_the_plan_picks_it_whatever_the_plan_says_of_the_bench(
    dx: float, dyaw: float
) -> None:
    now = seen(p2=Pose(HOME["p2"].x + dx, HOME["p2"].y, HOME["p2"].yaw + dyaw))
    made = plan(move(HOME["p2"], AWAY), base=now)
    assert f"p2 was moved by {dx:g} mm and {dyaw:g}° from" in refused(made, now)


def test_a_part_that_nobody_sees_is_not_picked() -> None:
    made = plan(move(HOME["p2"], AWAY), base=seen(without="p2"))
    assert refused(made, seen(without="p2")) == "the plan is stale: p2 is not on the table"


def test_a_hand_holds_what_the_plan_says_it_holds() -> None:
    picked, held = plan(move(HOME["p2"], AWAY)), plan(move(HOME["p2"], AWAY, held=True))
    require_current(SETUP, held, seen(holding="p2"))
    assert refused(held, seen()) == "the plan is stale: arm1 holds nothing"
    assert refused(held, seen(holding="p1")) == "the plan is stale: arm1 holds p1"
    assert refused(picked, seen(holding="p2")) == "the plan is stale: arm1 holds p2"
    require_current(SETUP, picked, seen(holding="p1"))


def test_a_plan_is_for_one_backend_with_its_robots_and_primitives() -> None:
    able = Capabilities(
        name="sim", fidelity="kinematic", evidence="kinematic", lab_digest=SETUP.digest(),
        primitives=frozenset({"move"}), robots=("arm1",),
    )  # fmt: skip
    made = plan(move(HOME["p2"], AWAY))
    require_applicable(made, able)
    for change, said in (
        ({"name": "hardware"}, "the plan was made for sim, not for hardware"),
        ({"primitives": frozenset({"set"})}, "sim (kinematic) cannot move p2"),
        ({"robots": ()}, "the plan needs the robot arm1; sim has: none"),
    ):
        with pytest.raises(PicoError, match=r".") as caught:
            require_applicable(made, replace(able, **change))
        assert [d.summary for d in caught.value.diagnostics] == [said]

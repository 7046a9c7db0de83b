"""What must hold of the bench before a plan starts, asked directly."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from judged import require_applicable, require_current

from pico.backends.device import Capabilities
from pico.diagnostics import ExitCode, PicoError
from pico.manifest.load import load_folder
from pico.model.observation import (
    Observation,
    ObservedComponent,
    ObservedRobot,
    ObservedValue,
    Uncertainty,
    live_state,
)
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.state import home_state, place_of
from pico.policy.freshness import differing, edited
from pico.resources import labs_dir

SETUP, _ = load_folder(labs_dir() / "shel").require()
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
        was, is_now = (f"({p.x:.5g}, {p.y:.5g}, {p.yaw:.4g}°)" for p in (HOME["p2"], there))
        assert refused(made, now).split("; ")[0] == (
            f"the plan is stale: p2 changed by {dx:.3g} mm, {dyaw:.3g}°, tolerance 0.5 mm, 0.5°: "
            f"{is_now}, planned from {was}"
        )
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
    require_applicable(SETUP, made, able)
    for change, said in (
        ({"name": "hardware"}, "this plan was made for the bench `sim`, and this is `hardware`"),
        ({"fidelity": "physics"}, "the plan was made for kinematic, and this bench is served in physics"),
        ({"primitives": frozenset({"set"})}, "sim (kinematic) cannot move p2"),
        ({"robots": ()}, "the plan needs the robot arm1; sim has: none"),
    ):
        with pytest.raises(PicoError, match=r".") as caught:
            require_applicable(SETUP, made, replace(able, **change))
        assert [d.summary for d in caught.value.diagnostics] == [said]
    with pytest.raises(PicoError, match="were edited since") as caught:
        require_applicable(SETUP, made, replace(able, lab_digest="other"))
    assert caught.value.exit_code == ExitCode.STALE


@pytest.mark.parametrize(("measurable", "said"), [("pose", "no camera over the bench"), ("image", "the simulator has")])
def test_what_the_simulator_can_not_measure_is_told_by_what_is_missing(measurable: str, said: str) -> None:
    able = Capabilities(
        name="sim", fidelity="kinematic", evidence="kinematic", lab_digest=SETUP.digest(), simulated=True,
        primitives=frozenset({"measure"}), robots=("arm1",),
    )  # fmt: skip
    made = plan(replace(move(HOME["p2"], AWAY), primitive="measure", arguments={"measurable": measurable}))
    with pytest.raises(PicoError, match=said):
        require_applicable(SETUP, made, able)


def test_a_plan_of_another_lab_is_stale() -> None:
    made = plan(move(HOME["p2"], AWAY))
    other = replace(made, lab=LabRef(name="shel", digest="other"))
    assert refused(other, seen()) == "the plan is stale: the lab or its component types were edited since"


def test_a_value_that_has_changed_is_told_with_its_tolerance_and_one_that_nobody_knows_without() -> None:
    def with_angle(value: float | None) -> Observation:
        now = seen()
        part = replace(now.components["p2"], values={"angle": ObservedValue(value=value)})
        return replace(now, components={**now.components, "p2": part})

    made = plan(base=with_angle(10.0))
    tolerance = SETUP.type_of("p2").tunables["angle"].tolerance
    require_current(SETUP, made, with_angle(10.0 + 0.9 * tolerance))
    changed = refused(made, with_angle(13.0))
    assert changed == (f"the plan is stale: p2.angle changed by 3 deg, tolerance {tolerance:g}: 13, planned from 10")
    assert "p2.angle changed : " in refused(made, with_angle(None)) and "planned from 10" in refused(
        made, with_angle(None)
    )


def test_what_was_not_seen_then_and_is_now_and_what_is_gone_is_told() -> None:
    gone, come = seen(without="p2"), seen()
    assert refused(plan(base=gone), come) == "the plan is stale: p2 was not seen then and is now"
    assert refused(plan(base=come), gone).startswith("the plan is stale: p2 is missing now")
    held = replace(come, components={**come.components, "p2": replace(come.components["p2"], presence="held")})
    assert refused(plan(base=come), held).startswith("the plan is stale: p2 is held now")


def test_a_part_that_was_seen_badly_is_in_its_slot_still_where_it_is_in_no_other() -> None:
    slots = sorted(SETUP.lab.slots)
    home = SETUP.lab.inventory["p2"].home
    slot = SETUP.lab.slots[home].pose
    away = next(SETUP.lab.slots[s].pose for s in slots if s != home)

    def badly(pose: Pose) -> Observation:
        now = seen()
        part = ObservedComponent(pose=pose, uncertainty=Uncertainty(position=5.0, yaw=5.0))
        return replace(now, components={**now.components, "p2": part})

    off = Pose(slot.x + 2.0, slot.y, slot.yaw)
    require_current(SETUP, plan(base=seen(p2=slot)), badly(off))
    assert "p2 changed by" in refused(plan(base=seen(p2=slot)), seen(p2=Pose(off.x + 60, off.y)))
    assert "p2 changed" in refused(plan(base=seen(p2=slot)), badly(away))
    assert "p2 changed" in refused(plan(base=seen(p2=slot)), badly(Pose(slot.x + 55, slot.y + 55)))


def test_the_first_six_differences_of_a_lab_are_told_and_how_many_more() -> None:
    assert differing({"a": 1, "b": {"c": 2}}, {"a": 1, "b": {"c": 3}}) == ["b.c 2 → 3"]
    assert differing({"a": 1, "gone": [1]}, {"a": [2], "new": {"x": 1}}) == ["a", "gone removed", "new added"]
    seven = ({f"k{n}": n for n in range(7)}, {f"k{n}": n + 1 for n in range(7)})
    assert differing(*seven) == [*(f"k{n} {n} → {n + 1}" for n in range(6)), "and 1 more"]
    six = ({f"k{n}": n for n in range(6)}, {f"k{n}": n + 1 for n in range(6)})
    assert len(differing(*six)) == 6 and differing(1, 1) == [] and differing(1, 2, "at") == ["at 1 → 2"]


def test_what_differs_in_two_benches_is_told_by_its_path() -> None:
    other = replace(SETUP, lab=replace(SETUP.lab, table=replace(SETUP.lab.table, beam_height=75.0)))
    assert edited(SETUP, other) == [f"table.beam_height {SETUP.lab.table.beam_height:g} → 75"]
    assert edited(SETUP, SETUP) == []

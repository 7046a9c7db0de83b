"""When a plan, or the report of a run, may say that the bench equals what was wanted."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pico_cli.views import plan as view
from pico_cli.views import report as report_view
from planning_benches import bench, part, planned, see, want

from pico.backends.device import Capabilities
from pico.execution.report import run_report
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, Uncertainty
from pico.model.pose import Pose
from pico.model.trace.event import Event

SETUP = bench({"a": part(), "b": part(home="s2")})
THERE = want({"a": (400, 250), "b": "s2"})
SEEN = see(SETUP, {"a": (400, 250), "b": "s2"})
ABLE = Capabilities(
    name="sim",
    fidelity="kinematic",
    evidence="kinematic",
    lab_digest="",
    primitives=frozenset(),
    robots=(),
    simulated=True,
)
OVER = Event(run="r", seq=1, kind="run_finished", time=0.0, data={"outcome": "done"})
UNSURE = Uncertainty(position=5.0, yaw=5.0)


def seen(name: str, **change: object) -> Observation:
    """Return what was seen, with something about one component otherwise."""
    part = replace(SEEN.components[name], **change)  # type: ignore[arg-type]
    return replace(SEEN, components={**SEEN.components, name: part})


def held(name: str) -> Observation:
    """Return the bench with a part in a hand that can't be set down, for nobody knows how it is held."""
    robots = {"arm1": ObservedRobot(joints=(0.0,) * 7, holding=name)}
    parts = {**SEEN.components, name: ObservedComponent(presence="held")}
    return replace(SEEN, components=parts, robots=robots)


@pytest.mark.parametrize(
    ("found", "equal"),
    [
        (SEEN, True),
        (seen("a", pose=Pose(400.1, 250, 0)), True),
        (seen("b", pose=Pose(166, 66, 45)), True),
        (seen("b", pose=Pose(166, 66, 45), uncertainty=UNSURE), True),
        (seen("a", uncertainty=UNSURE), False),
        (seen("a", presence="toppled"), False),
        (seen("a", presence="missing", pose=None), False),
        (held("b"), False),
    ],
)
def test_equal_is_said_by_plan_and_report_alike(found: Observation, equal: bool) -> None:
    plan = planned(SETUP, found, THERE)
    report = run_report(SETUP, plan, (OVER,), found, wall=0.0, able=ABLE)
    assert plan.operations == ()
    assert (plan.reached, report.reached) == (equal, equal)
    assert ("the bench equals" in view.text(plan)) is equal
    assert ("The bench equals" in report_view.text(report)) is equal


def test_what_the_state_does_not_name_counts_where_it_lies_or_is_held() -> None:
    wanted = want({"a": (400, 250)})
    assert planned(SETUP, SEEN, wanted).reached
    assert planned(SETUP, seen("b", presence="missing", pose=None), wanted).reached  # a spare part that was lent
    assert not planned(SETUP, seen("b", presence="toppled"), wanted).reached
    assert not planned(SETUP, held("b"), wanted).reached


@pytest.mark.parametrize("b", [{"presence": "missing", "pose": None}, {"presence": "toppled"}])
def test_a_plan_for_some_components_does_not_speak_for_what_nobody_sees(b: dict[str, object]) -> None:
    before = seen("b", **b)
    start = replace(
        before, components={**before.components, "a": replace(SEEN.components["a"], pose=Pose(500, 250, 0))}
    )
    made = planned(SETUP, start, THERE, targets=("a",))
    plan = replace(made, target=replace(made.target, only=("a",)))
    report = run_report(SETUP, plan, (OVER,), before, wall=0.0, able=ABLE)
    assert "will not equal" in view.text(plan)
    assert report.left == ("b",) and "does not equal" in report_view.text(report)


def test_a_pose_near_a_slot_is_reached_only_there() -> None:
    near = want({"a": (400, 250), "b": (166, 66, 45)})
    assert planned(SETUP, seen("b", pose=Pose(166, 66, 45)), near).reached
    assert not planned(SETUP, SEEN, near).reached


def test_a_plan_that_only_sets_a_part_down_is_of_a_state() -> None:
    robots = {"arm1": ObservedRobot(joints=(0.0,) * 7, holding="b", picked=Pose(166, 66, 45))}
    parts = {**SEEN.components, "b": ObservedComponent(presence="held", pose=Pose(300, 300, 0))}
    plan = planned(SETUP, replace(SEEN, components=parts, robots=robots), want({"a": (400, 250), "b": (166, 66, 45)}))
    assert [op.reason.kind for op in plan.operations] == ["held", "parked"]
    assert plan.operations[0].arguments["to"] == {"pose": {"x": 166, "y": 66, "yaw": 45}}
    assert not plan.asked


@pytest.mark.parametrize(("longer", "told"), [(1.9, False), (1.0, False), (30.0, True)])
def test_what_took_notably_longer_than_foretold_is_told(longer: float, told: bool) -> None:
    start = seen("a", pose=Pose(500, 250, 0))
    plan = planned(SETUP, start, THERE)
    (move,) = (op for op in plan.operations if op.primitive == "move")
    data = {"seconds": move.seconds + longer}
    ended = Event(run="r", seq=1, kind="operation_done", time=0.0, operation=move.id, component="a", data=data)
    report = run_report(SETUP, plan, (ended, replace(OVER, seq=2)), SEEN, wall=0.0, able=ABLE)
    said = [(d.severity, d.code, f"{move.seconds:.1f} s was foretold" in d.summary) for d in report.diagnostics]
    assert said == ([("note", "slow", True)] if told else [])

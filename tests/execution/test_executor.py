"""What a run does next: what is tried again, what a failure stops, what an interruption lets happen."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from pico.diagnostics import error
from pico.execution.executor import Dispatch, Executor, retried
from pico.execution.resume import renumbered
from pico.model.observation import ObservedComponent
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose


def op(id: str, *after: str, primitive: Any = "set", **more: Any) -> Operation:
    return Operation(
        id=id, primitive=primitive, component=id, after=after, resources=(id,), reason=Reason(kind="changed"), **more
    )  # fmt: skip


MOVE = op("m", primitive="move", arguments={"from": {"pose": {"x": 1, "y": 1, "yaw": 0}}, "to": {"slot": "a"}})
FINAL = replace(MOVE, arguments={**MOVE.arguments, "irreversible": True})
STANDING = ObservedComponent(pose=Pose(7, 8, 9))


def end(outcome: Any, code: str = "", after: ObservedComponent | None = None) -> OperationResult:
    return OperationResult(key="r/x/1", outcome=outcome, error=error(code, code) if code else None, after=after)


@pytest.mark.parametrize(
    ("operation", "result", "again"),
    [
        (MOVE, end("failed", "misplaced", STANDING), True),
        (MOVE, end("failed", "dropped", STANDING), True),
        (MOVE, end("failed", "dropped", replace(STANDING, presence="toppled")), False),
        (MOVE, end("failed", "dropped", None), False),
        (MOVE, end("failed", "blocked", STANDING), False),
        (MOVE, end("failed", "jammed", STANDING), False),
        (MOVE, end("unknown", "unseen", STANDING), False),
        (
            replace(MOVE, arguments={**MOVE.arguments, "irreversible": True}),
            end("failed", "misplaced", STANDING),
            False,
        ),
        (op("s"), end("failed", "timeout"), True),
        (op("s"), end("failed", "jammed"), True),
        (op("s"), end("failed", "range"), False),
        (op("s"), end("unknown", "timeout"), False),
        (op("h", primitive="home"), end("failed", "timeout"), True),
        (op("g", primitive="operator"), end("failed", "timeout"), False),
    ],
)
def test_only_what_is_safe_is_tried_again(operation: Operation, result: OperationResult, again: bool) -> None:
    found = retried(Dispatch(operation.id, operation, 1, "r"), result)
    assert (found is not None) == again
    if found is not None:
        assert found.key == f"r/{operation.id}/2"
        if operation.primitive == "move":
            assert found.operation.arguments["from"] == {"pose": {"x": 7, "y": 8, "yaw": 9}}
    assert retried(Dispatch(operation.id, operation, 3, "r"), result) is None


def test_a_failure_lets_siblings_finish_unless_it_is_to_stop_everything() -> None:
    for stop, due in ((False, ["c"]), (True, [])):
        executor = Executor([op("a"), op("b", "a"), op("c", "s"), op("s")], "r", stop_on_error=stop)
        first, second = executor.due()
        assert (first.id, second.id) == ("a", "s")
        assert [o.id for o in executor.over(first, end("failed", "range")).skipped] == ["b"]
        executor.over(second, end("done"))
        assert [d.id for d in executor.due()] == due
        assert executor.broken is stop


def test_interrupted_nothing_is_begun_nor_tried_again_and_what_was_refused_counts_as_not_begun() -> None:
    executor = Executor([op("a"), op("b"), op("c")], "r")
    a, b, c = executor.due()
    executor.interrupt()
    assert executor.over(a, end("failed", "timeout")).again is None
    executor.refused(b)
    executor.over(c, end("done"))
    assert executor.due() == []
    assert executor.idle
    assert [o.id for o in executor.graph.waiting()] == ["b"]


def setting(id: str, before: Any, after: Any, *waits: str, tunable: str = "exposure") -> Operation:
    return Operation(
        id=id, primitive="set", component="cam", after=waits, resources=("cam",), reason=Reason(kind="interlock"),
        arguments={"tunable": tunable, "from": before, "to": after},
    )  # fmt: skip


TWO_GOALS = [
    setting("bright", 10, 0.5), op("first", "bright", primitive="optimize"), setting("dim", 0.5, 2.0, "first"),
    op("second", "first", "dim", primitive="optimize"), setting("back", 2.0, 10, "dim", "first", "second"),
]  # fmt: skip


def walked(operations: list[Operation], outcomes: dict[str, Any], interrupted_in: str = "") -> list[str]:
    """Return what is begun, in order, where operations end so, and it is interrupted while one is under way."""
    executor, begun = Executor(operations, "r"), list[str]()
    while due := executor.due():
        for dispatch in due:
            begun.append(dispatch.id)
            if dispatch.id == interrupted_in:
                executor.interrupt()
            executor.over(dispatch, end(outcomes.get(dispatch.id, "done"), "range" if dispatch.id in outcomes else ""))
    return begun


@pytest.mark.parametrize(
    ("interrupted_in", "outcomes", "begun"),
    [
        ("", {}, ["bright", "first", "dim", "second", "back"]),
        ("first", {}, ["bright", "first", "back"]),
        ("second", {}, ["bright", "first", "dim", "second", "back"]),
        ("bright", {}, ["bright", "back"]),
        ("bright", {"bright": "failed"}, ["bright"]),
        ("", {"bright": "failed"}, ["bright"]),
        ("", {"first": "failed"}, ["bright", "first", "back"]),
        ("", {"dim": "failed"}, ["bright", "first", "dim", "back"]),
    ],
)
def test_what_was_set_to_measure_is_set_back_whatever_becomes_of_the_rest(
    interrupted_in: str, outcomes: dict[str, Any], begun: list[str]
) -> None:
    assert walked(TWO_GOALS, outcomes, interrupted_in) == begun


def test_interrupted_no_shutter_opens_and_what_the_bench_refuses_is_not_asked_again() -> None:
    dark = [
        setting("close", "open", "closed", tunable="shutter"), op("read", "close", primitive="measure"),
        setting("open", "closed", "open", "read", tunable="shutter"),
    ]  # fmt: skip
    assert walked(dark, {}, "read") == ["close", "read"] and walked(dark, {}) == ["close", "read", "open"]
    executor = Executor(TWO_GOALS, "r")
    (bright,) = executor.due()
    executor.interrupt()
    executor.over(bright, end("done"))
    (back,) = executor.due()
    executor.refused(back)
    assert executor.due() == [] and "back" in [o.id for o in executor.graph.waiting()]


def test_where_nothing_can_be_done_in_order_nothing_is_set_back() -> None:
    executor = Executor(TWO_GOALS, "r")
    (bright,) = executor.due()
    executor.give_up()
    executor.over(bright, end("done"))
    assert executor.due() == []


def test_a_resumed_plan_has_ids_of_its_own_and_the_same_order() -> None:
    plan = Plan(
        lab=LabRef(name="l", digest=""), backend="sim", fidelity="kinematic", base=Base(), target=Target(),
        operations=(op("op1"), op("op2", "op1")),
    )  # fmt: skip
    again = renumbered(plan, 2)
    assert [(o.id, o.after) for o in again.operations] == [("r2.op1", ()), ("r2.op2", ("r2.op1",))]
    assert again.digest == again.sealed().digest

"""A plan that brings light back as well: the goals that its moves spoil, that are not met, or whose search was cut
short, sought at its end."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from pico.diagnostics import PicoError
from pico.model.observation import Observation, with_value
from pico.model.operation import Operation, Reason, searched_by
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.motion.types import Motion
from pico.planning.checks.interlocks import policy_rules
from pico.planning.foreseen import foreseen
from pico.planning.measuring import measuring
from pico.planning.optimizing import Turn, optimizing
from pico.planning.passes.schedule import makespan, schedule
from pico.planning.sought import sought_by


def realigned(
    setup: Setup, seen: Observation, plan: Plan, sought: Sequence[Turn], motion: Motion | None,
    measured: Sequence[tuple[str, str]] = (),
) -> Plan:  # fmt: skip
    """Return the plan, sealed, with an optimization for each goal that is `sought`, in this order, and after them
    measurements of what is to be `measured`; `seen`: the bench that it starts from. A goal that cannot be begun then is
    an error of the plan."""
    before = plan.operations
    then = foreseen(setup, seen, before)
    try:
        whole = [*before, *optimizing(setup, then, sought, motion, before)] if sought else before
    except PicoError as exc:
        return replace(plan, operations=(), diagnostics=(*plan.diagnostics, *exc.diagnostics)).sealed()
    operations = schedule([*whole, *measured_last(setup, then, measured, _RECORDED, motion, whole)])
    took = makespan(operations)
    bound = None if plan.bound is None else round(plan.bound + took - plan.makespan, 6)
    return replace(plan, operations=operations, makespan=took, bound=bound).sealed()


def measured_last(
    setup: Setup, then: Observation, measured: Sequence[tuple[str, str]], reason: Reason, motion: Motion | None,
    whole: Sequence[Operation],
) -> list[Operation]:  # fmt: skip
    """Return the operations that measure when all else is done; an arm of which something comes before parks then."""
    working = {op.robot for op in whole}
    parked = replace(then, robots={name: robot for name, robot in then.robots.items() if name not in working})
    made = measuring(setup, parked, measured, reason, motion)
    return [replace(op, after=op.after or tuple(op.id for op in whole)) for op in made]


def again(
    setup: Setup, seen: Observation, plan: Plan, sought: Mapping[str, Operation], *, motion: Motion | None
) -> Plan:  # fmt: skip
    """Return a plan with optimizations after all of its operations, which bring their tunables back to where each had
    begun; `sought`: those that were cut short, by their keys.

    Raises PicoError for tunables of which nobody knows where they stand then.
    """
    out, after = [*plan.operations], seen
    for op in plan.operations:
        if op.primitive == "set":
            after = with_value(after, op.component, str(op.arguments["tunable"]), op.arguments["to"])
    for key, cut in sought.items():
        one, stages = sought_by(cut.arguments)
        waits = [op.id for op in out]
        for op in optimizing(setup, after, [Turn(one, stages)], motion, out):
            given = {**op.arguments, "again": key} if op.primitive == "optimize" else op.arguments
            out.append(replace(op, arguments=given, after=tuple(dict.fromkeys((*waits, *op.after)))))
    timed, tuned = schedule(out), {address for cut in sought.values() for address in searched_by(cut.arguments)}
    wanted = _without(plan.target_state, tuned)  # these have their last word by light
    return replace(
        plan, operations=timed, makespan=makespan(timed), policy=policy_rules(setup, seen, timed),
        target=replace(plan.target, state=wanted.as_json()),
    ).sealed()  # fmt: skip


def _without(state: LabState, tuned: Collection[str]) -> LabState:
    """Return a state that says nothing of some tunables."""
    parts = {
        name: replace(part, values={t: v for t, v in part.values.items() if f"{name}.{t}" not in tuned})
        for name, part in state.components.items()
    }
    return replace(state, components=parts)


_RECORDED = Reason(kind="align", text="the commit recorded it")

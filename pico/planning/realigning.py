"""A plan that brings light back as well: the goals that its moves spoil, or that are not met, sought at its end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pico.diagnostics import PicoError
from pico.model.observation import Observation
from pico.model.operation import Operation, Reason
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.motion.types import Motion
from pico.planning.foreseen import foreseen
from pico.planning.measuring import measuring
from pico.planning.optimizing import Turn, optimizing
from pico.planning.schedule import makespan, schedule


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


_RECORDED = Reason(kind="align", text="the commit recorded it")

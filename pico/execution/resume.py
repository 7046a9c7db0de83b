"""A run that is taken up again: a new plan to the same goal, under the id of the run, with operations of its own."""

from __future__ import annotations

from dataclasses import replace

from pico.model.plan import Plan


def renumbered(plan: Plan, time: int) -> Plan:
    """Return the plan with ids that no earlier plan of its run has: `op3` of the second resumption is `r2.op3`.

    The journal knows the keys of the run's earlier plans; what is planned now is not what they did.
    """
    new = {op.id: f"r{time}.{op.id}" for op in plan.operations}
    operations = tuple(replace(op, id=new[op.id], after=tuple(new[a] for a in op.after)) for op in plan.operations)
    return replace(plan, operations=operations).sealed()

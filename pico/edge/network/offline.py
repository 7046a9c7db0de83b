"""How long what runs may go on by itself, where its edge is cut off from the coordinator and the lease is over."""

from __future__ import annotations

from pico.control.gate import OFFLINE
from pico.model.goal import goal_from_json
from pico.model.plan import Plan
from pico.model.setup import Setup


def offline(setup: Setup, plan: Plan) -> float:
    """Return for how long a run of `plan` may go on beyond its lease [s]: as long as the optimizations in it declare,
    and the Lab of the bench allows; 0 where none declares anything."""
    said = [goal_from_json(op.arguments["what"]).budget.offline or 0.0
            for op in plan.operations if op.primitive == "optimize"]  # fmt: skip
    allowed = setup.lab.policy.offline
    return min(max(said, default=0.0), OFFLINE if allowed is None else allowed)

"""Light that a state asks for: a plan brings what somebody lets out, last of all, and leaves the rest shut."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pico.diagnostics import Diagnostic
from pico.model.arming import LaserClass
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.plan import UNARMED, Plan
from pico.model.setup import Setup
from pico.planning.checks.emission import left_shut, lets_out, refused, unlicensed
from pico.planning.checks.interlocks import stay_shut
from pico.planning.passes.draft import Draft
from pico.planning.passes.values import value_operations


def light_withheld(draft: Draft) -> Draft:
    """Return the plan with the requests that it leaves as they are: those that let light out of a laser which nobody
    lets emit. Undoing lets no light out at all: it only shuts."""
    setup, seen = draft.setup, draft.seen
    asked = [c for c in draft.changes if c.requested and not c.tolerated and draft.only.chosen(c.component, c.tunable)]
    made = {(c.component, c.tunable): value_operations(setup, seen, (c,))[0] for c in asked}
    opening = {one: ops for one, ops in made.items() if any(lets_out(setup, op) for op in ops)}
    if draft.goal.target.cause in ("undo", "redo"):
        return replace(draft, withheld={one: {} for one in opening})
    lasers = unlicensed(setup, seen, [op for ops in opening.values() for op in ops])
    own = {one: _of(setup, one[0], lasers) for one in opening}
    return replace(draft, withheld={one: left for one, left in own.items() if left})


def _of(setup: Setup, component: str, lasers: Mapping[str, LaserClass]) -> dict[str, LaserClass]:
    """Return those among some lasers that a component opens: itself, or all where it is a shutter on the table."""
    apart = setup.type_of(component).optics.element != "source"
    return {name: of for name, of in lasers.items() if apart or name == component}


def light_told(draft: Draft) -> Draft:
    """Return the plan with what is said of light that it leaves shut: of each laser with the command that opens it."""
    shut = stay_shut(draft.setup, draft.seen, draft.operations)
    lasers = {**{name: of for one in draft.withheld.values() for name, of in one.items()}, **shut}
    undone = sorted(f"{component}.{tunable}" for (component, tunable), of in draft.withheld.items() if not of)
    text = f"undoing lets no light out: {', '.join(undone)} {'stays' if len(undone) == 1 else 'stay'} as is"
    hint = "`pico apply` brings what the manifest asks for"
    notes = [Diagnostic("note", UNARMED, text, hint=hint)] if undone else []
    return draft.told(*left_shut(draft.seen, lasers), *notes)


def without_light(setup: Setup, seen: Observation, plan: Plan) -> Plan:
    """Return a plan without the operations that let light out of lasers which nobody lets emit, with a warning for each
    of these; the same plan where there are none."""
    shut = unlicensed(setup, seen, plan.operations)
    if not shut:
        return plan
    gone = {op.id: op.after for op in plan.operations if lets_out(setup, op) and _of(setup, op.component, shut)}
    kept = [op for op in plan.operations if op.id not in gone]
    waits = [[w for a in op.after for w in gone.get(a, (a,)) if w not in gone] for op in kept]
    operations = tuple(replace(op, after=tuple(dict.fromkeys(w))) for op, w in zip(kept, waits, strict=True))
    still = refused(setup, seen, operations)  # a shutter that is moved away is not left out
    told = still or left_shut(seen, shut)
    return replace(plan, operations=operations, diagnostics=(*plan.diagnostics, *told)).sealed()


def light_last(draft: Draft) -> Draft:
    """Return the plan such that light comes out after all else is done; a laser behind its own shutter, which is
    closed, warms up meanwhile."""
    lit = {op.id for op in draft.operations if _comes_out(draft.setup, draft.seen, op)}
    others = [op for op in draft.operations if op.id not in lit]
    waited = {e for op in others for e in op.after}
    last = [op.id for op in others if op.id not in waited]
    operations = (
        replace(op, after=tuple(dict.fromkeys((*op.after, *last)))) if op.id in lit else op for op in draft.operations
    )
    return replace(draft, operations=tuple(operations))


def _comes_out(setup: Setup, seen: Observation, op: Operation) -> bool:
    if op.primitive not in ("set", "operator") or not lets_out(setup, op):
        return False
    behind = seen.known_values.get(op.component, {}).get("shutter") == "closed"
    return op.arguments.get("tunable") == "shutter" or not behind

"""Why a plan is as it is: why each move, why in this order, why not fewer. A pure function of setup and plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.model.diff import Change
from pico.model.operation import Operation
from pico.model.plan import Plan, Staging
from pico.model.record import record
from pico.model.setup import Setup
from pico.planning.checks.contacts import Contact, Spot, bases, fingers, mouth, spot_of
from pico.planning.explaining.blocking import Block, Clash, blocks_of, moved_by, ring_through, rings_of, why_impossible
from pico.planning.explaining.graph import Dependency, PlanGraph, ScheduledOperation, graph_of


@record
class Because:
    """One reason why an operation comes after another, in words.

    `contact`: something would come too near to something else otherwise; `path`: so would an arm, or what it carries,
    on its way; `beam`: a shutter; `turn`: robots take turns; `parked`; `own`: an earlier step of the same component.
    """

    kind: Literal["contact", "path", "beam", "turn", "parked", "own"]
    text: str
    contact: Contact | None = None


@record
class Wait:
    """An operation that another waits for (`until`: when it is done [s]), or that waits for it. `resource`: only
    because both need it."""

    operation: str
    component: str
    until: float
    because: tuple[Because, ...] = ()
    resource: str | None = None


@record
class ExplainedOperation:
    """One operation: what waits for what, and how it lies in time; times in s."""

    operation: Operation
    change: Change | None = None
    waits_for: tuple[Wait, ...] = ()
    holds_up: tuple[Wait, ...] = ()
    critical: bool
    spare: float


@record
class Fewer:
    """Why a plan has no fewer moves. `moved`: components that move at all, each of which needs one; `staging`: how
    many are put down on the way; `rings`: who blocks whom in rings that only such a stop breaks."""

    moved: int
    moves: int
    staging: Staging
    rings: tuple[tuple[Block, ...], ...] = ()


@record
class Explanation:
    """The explanation of a plan, or of what it does with one `component`.

    `bound`: no order of these operations ends before that [s], where it is known. `changes`: what differs; `steps`:
    the operations in their order; `clashes`, `blocks`: what makes it impossible, as far as geometry tells;
    `diagnostics`: what was found that concerns the component.
    """

    plan: str
    component: str | None = None
    makespan: float
    bound: float | None
    changes: tuple[Change, ...] = ()
    steps: tuple[ExplainedOperation, ...] = ()
    fewer: Fewer
    clashes: tuple[Clash, ...] = ()
    blocks: tuple[Block, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def explain(setup: Setup, plan: Plan, component: str | None = None) -> Explanation:
    """Return why `plan` moves what it moves, in this order, and no less; of one component where it is given.

    Conflicts are computed anew from where operations pick and place. Raises PicoError for a component that neither the
    lab nor the plan has.
    """
    if component is not None:
        _require(setup, plan, component)
    graph = graph_of(plan)
    chosen = [n for n in graph.nodes if component in (None, n.operation.component)]
    clashes, blocks = why_impossible(setup, plan)
    return Explanation(
        plan=plan.digest, component=component, makespan=plan.makespan, bound=plan.bound,
        changes=tuple(c for c in plan.changes if component in (None, c.component)),
        steps=tuple(_step(setup, plan, graph, node) for node in chosen),
        fewer=_fewer(setup, plan, component),
        clashes=tuple(c for c in clashes if component in (None, c.a, c.b)),
        blocks=blocks if component is None or any(component == b.blocker for b in blocks) else (),
        diagnostics=tuple(d for d in plan.diagnostics if component in (None, d.address.partition(".")[0])),
    )  # fmt: skip


def _require(setup: Setup, plan: Plan, component: str) -> None:
    known = {*setup.lab.inventory, *(o.component for o in plan.operations)}
    if component not in known:
        hint = did_you_mean(component, known)
        raise PicoError(error("unknown-component", f"the lab has no component `{component}`", hint=hint))


def _step(setup: Setup, plan: Plan, graph: PlanGraph, node: ScheduledOperation) -> ExplainedOperation:
    operation = node.operation
    by_id = {o.id: o for o in plan.operations}
    waits = [_wait(setup, by_id[e.source], operation, by_id[e.source], e) for e in graph.edges if _into(e, operation)]
    holds = [_wait(setup, operation, by_id[e.target], by_id[e.target], e) for e in graph.edges if _from(e, operation)]
    return ExplainedOperation(
        operation=operation, change=_change_of(plan, operation), waits_for=tuple(waits), holds_up=tuple(holds),
        critical=node.critical, spare=node.spare,
    )  # fmt: skip


def _into(edge: Dependency, operation: Operation) -> bool:
    return edge.target == operation.id and (edge.after or not edge.implied)


def _from(edge: Dependency, operation: Operation) -> bool:
    return edge.source == operation.id and (edge.after or not edge.implied)


def _change_of(plan: Plan, operation: Operation) -> Change | None:
    if operation.reason.kind == "interlock":
        return None
    key = (operation.component, operation.arguments.get("tunable", "pose"))
    return next((c for c in plan.changes if (c.component, c.tunable) == key), None)


def _wait(setup: Setup, first: Operation, then: Operation, other: Operation, edge: Dependency) -> Wait:
    because = tuple(why_after(setup, first, then)) if edge.after else ()
    resource = None if edge.after else ", ".join(edge.resources)
    return Wait(
        operation=other.id, component=other.component, until=round(other.start + other.seconds, 6), because=because,
        resource=resource,
    )  # fmt: skip


def why_after(setup: Setup, first: Operation, then: Operation) -> Iterator[Because]:
    """Yield why `then` comes after `first`, in words and with the contacts that each reason stands for."""
    if first.primitive == "home" and first.component == then.component:
        yield Because(kind="own", text="the axis must be homed first")
    elif _shutter(first) or _shutter(then):
        yield Because(kind="beam", text=_beam(first, then))
    elif then.kind.parks:
        yield Because(kind="parked", text=f"{then.component} parks when its moves are done")
    elif first.kind.parks:
        yield Because(kind="turn", text=f"robots take turns: {first.component} must be out of the way")
    elif first.component == then.component:
        yield Because(kind="own", text="its own earlier step")
    else:
        found = list(_geometric(setup, first, then))
        yield from found or [Because(kind="path", text="the arm, or what it carries, would pass too near on its way")]


def _shutter(operation: Operation) -> bool:
    return operation.arguments.get("tunable") == "shutter"


def _beam(first: Operation, then: Operation) -> str:
    if _shutter(first):
        return f"the shutter of {first.component} is set before anything works in the beam"
    return f"the shutter of {then.component} is set when nothing works in the beam any more"


def _geometric(setup: Setup, first: Operation, then: Operation) -> Iterator[Because]:
    """Yield how `then` needs the place that `first` leaves, and how `first` needs the place empty that `then` takes."""
    leaves, takes = _end(setup, first, "from"), _end(setup, then, "to")
    a, b = first.component, then.component
    if leaves and takes:
        where = f"{a} still stood at {leaves}"
        if by := bases(setup, b, takes.pose, a, leaves.pose):
            yield Because(kind="contact", text=f"if {where}, {by.text}", contact=by)
        elif by := mouth(setup, takes.slot, a, leaves.pose):
            yield Because(kind="contact", text=f"{takes.slot} must be empty first: {by.text}", contact=by)
        elif by := mouth(setup, leaves.slot, b, takes.pose):
            text = f"{a} must have left {leaves}: with {b} at {takes}, {by.text}"
            yield Because(kind="contact", text=text, contact=by)
    if leaves:
        yield from _by_fingers(setup, then, a, leaves, f"if {a} still stood at {leaves}")
    goal = _end(setup, first, "to")
    if takes and goal and (by := bases(setup, a, goal.pose, b, takes.pose)):
        yield Because(
            kind="contact",
            text=f"if {b} already stood at {takes} when {a} is put down at {goal}, {by.text}",
            contact=by,
        )
    elif takes and goal and (by := mouth(setup, goal.slot, b, takes.pose)):
        yield Because(
            kind="contact", text=f"{goal} must be empty until {a} is there: with {b} at {takes}, {by.text}", contact=by
        )
    if takes:
        yield from _by_fingers(setup, first, b, takes, f"if {b} already stood at {takes}")


def _by_fingers(setup: Setup, operation: Operation, other: str, at: Spot, case: str) -> Iterator[Because]:
    """Yield how the fingers of an operation would meet another component where it is picked up and put down."""
    yaw = operation.arguments.get("grasp_yaw", 0.0)
    for key, verb in (("from", "picked up"), ("to", "put down")):
        place = _end(setup, operation, key)
        if place is None or other not in setup.lab.inventory:
            continue
        if by := fingers(setup, operation.robot, yaw, operation.component, place.pose, other, at.pose):
            text = f"{case} while {operation.component} is {verb} at {place}, {by.text}"
            yield Because(kind="contact", text=text, contact=by)


def _end(setup: Setup, operation: Operation, key: str) -> Spot | None:
    if operation.component not in setup.lab.inventory or operation.arguments.get("tunable"):
        return None
    return spot_of(setup, operation.arguments.get(key))


def _fewer(setup: Setup, plan: Plan, component: str | None) -> Fewer:
    moves = [o for o in plan.operations if o.kind.carries]
    moved = {o.component for o in moves}
    stops = {n for n, count in _counts(moves).items() if count > 1}
    rings = _rings(setup, plan, component, stops) if stops else ()
    return Fewer(moved=len(moved), moves=len(moves), staging=plan.staging, rings=rings)


def _counts(moves: Sequence[Operation]) -> Mapping[str, int]:
    counts: dict[str, int] = {}
    for o in moves:
        counts[o.component] = counts.get(o.component, 0) + 1
    return counts


def _rings(setup: Setup, plan: Plan, component: str | None, stops: set[str]) -> tuple[tuple[Block, ...], ...]:
    """Return the rings that stops on the way break: that through the component, or one for each stop."""
    blocks = blocks_of(setup, plan)
    if component is not None:
        ring = ring_through(component, blocks) if component in moved_by(plan) else ()
        return (ring,) if ring else ()
    return tuple(r for r in rings_of(blocks) if stops & {b.blocker for b in r})


Kind = Literal["changed", "stays", "absent", "impossible"]


def kind_of(plan: Plan, component: str) -> Kind:
    """Return what a plan does with a component that is in the inventory: whether anything is done with it, it stays as
    it is, nobody sees it, or the plan is impossible."""
    if any(o.component == component for o in plan.operations):
        return "changed"
    if plan.errored:
        return "impossible"
    return "stays" if component in plan.base.state else "absent"

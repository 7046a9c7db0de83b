"""The plan: physical diff -> target check -> order with staging -> paths -> schedule -> reasons. Pure."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, error, warning
from pico.model.observation import Observation, left_standing
from pico.model.operation import Operation, Reason, new_id
from pico.model.plan import Base, Blocking, LabRef, Plan, Staging, Target
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.state import LabState, references_of
from pico.motion.types import Blocked, Motion, MovePath
from pico.planning.actors import actors, asides, hand_warnings
from pico.planning.checks.clearance import beams_in_the_way
from pico.planning.checks.emission import lets_out, uncovered
from pico.planning.checks.interlocks import policy_rules, stay_shut, unguarded, with_interlocks
from pico.planning.checks.target import Source, check_target, no_source
from pico.planning.checks.tethers import check_tethers
from pico.planning.light import light_last, told_of, withheld
from pico.planning.parts.movers import Place
from pico.planning.parts.selection import done_by, samples_kept, selection, told
from pico.planning.parts.setdown import after_set_downs, parked_first, set_downs
from pico.planning.parts.situation import Situation, read_situation
from pico.planning.request import Preference, Request
from pico.planning.values import OPERATOR_SECONDS, homing, value_operations

if TYPE_CHECKING:
    from pico.planning.ordering.conflicts import Conflicts
    from pico.planning.ordering.meetings import Item
    from pico.planning.ordering.search import OrderedMove
    from pico.planning.ordering.solve import OrderedMoves

MOVE_SECONDS = 10.0
"""What a pick and place takes where no motion is asked for [s]."""
PARK_SECONDS = 3.0
"""What a park takes where no motion is asked for [s]."""


@dataclass(frozen=True, slots=True)
class Compiled:
    """The operations of a plan, in no final order, and what is to be said about them."""

    operations: tuple[Operation, ...] = ()
    staging: Staging = field(default_factory=lambda: Staging(proven=True))
    diagnostics: tuple[Diagnostic, ...] = field(default=())
    bound: float | None = None
    blocking: tuple[Blocking, ...] | None = None


def plan(
    setup: Setup, seen: Observation, wanted: LabState, *, motion: Motion | None, backend: str, fidelity: str,
    base: Base, target: Target, exact: bool = False, source: Source | None = None,
    prefer: Preference = "fewest-moves", targets: Collection[str] = (), exclude: Collection[str] = (),
) -> Plan:  # fmt: skip
    """Return the operations that make the bench as `seen` equal to `wanted`, in an order that never collides.

    Without `motion` reach and paths are left out and times are nominal. `exact`: move what differs within tolerance,
    too. `source` tells where in the manifests an address such as `p2.pose` is written. `prefer`: fewest moves first and
    then time, or time first. `targets`: plan for these components only, and what must make way for them; `exclude`:
    leave these as they are. Raises nothing for an impossible state: the plan is then `errored`, holds no operation, and
    its diagnostics say what is in the way. Raises PicoError for a target that the lab does not have.
    """
    only = selection(setup, targets, exclude, samples=target.cause in ("undo", "recover"))
    request = Request(setup, seen, wanted, motion, source or no_source, exact, prefer=prefer, only=only)
    return compiled_plan(request, backend=backend, fidelity=fidelity, base=base, target=target)


def compiled_plan(request: Request, *, backend: str, fidelity: str, base: Base, target: Target) -> Plan:
    """Return the sealed plan of a request."""
    from pico.planning.schedule import least_makespan, makespan, schedule

    setup = request.setup
    emptied = set_downs(setup, request.seen, request.motion)
    request = replace(request, seen=emptied.seen)
    situation = read_situation(setup, request.seen, request.wanted, exact=request.exact)
    moves = compile_moves(request, situation) if situation.moving else Compiled()
    asked = tuple(c for c in situation.changes if request.only.chosen(c.component, c.tunable))
    left = withheld(request, asked, undoing=target.cause == "undo")
    asked = tuple(c for c in asked if (c.component, c.tunable) not in left)
    values, notes = value_operations(setup, request.seen, asked, request.reason)
    referred = [a for a in references_of(request.wanted) if request.only.chosen(*a.split("."))]
    values += homing(setup, request.seen, referred)
    diagnostics = (*emptied.diagnostics, *situation.diagnostics, *moves.diagnostics, *notes)
    operations: tuple[Operation, ...] = ()
    if not any(d.severity == "error" for d in diagnostics):
        ordered = after_set_downs(setup, emptied, (*moves.operations, *values), request.motion)
        if request.only.everything or any(lets_out(setup, o) for o in ordered):
            ordered = parked_first(setup, request.seen, ordered, request.motion)
        ordered = light_last(setup, request.seen, ordered)
        diagnostics = (*diagnostics, *told_of(request, left, stay_shut(setup, request.seen, ordered)))
        guarded = with_interlocks(setup, request.seen, ordered)
        operations = schedule(guarded)
        diagnostics = (*diagnostics, *unguarded(setup, request.seen, operations))
        diagnostics = (*diagnostics, *uncovered(setup, request.seen, operations))
        diagnostics = (*diagnostics, *left_standing(setup, request.seen, {o.robot for o in operations}))
    changes = situation.changes
    if not request.only.everything and operations:
        diagnostics = (*diagnostics, *told(request.only, changes, operations))
    staying = tuple(samples_kept(request.only, changes))
    if staying:
        without = {*(target.exclude or ()), *(f"{one.address}.pose" for one in staying)}
        target, diagnostics = replace(target, exclude=tuple(sorted(without))), (*diagnostics, *staying)
    if staying or not request.only.everything:
        done = done_by(operations)
        own = {(c.component, c.tunable) for c in changes if request.only.chosen(c.component, c.tunable)} | done
        changes = tuple(c for c in changes if (c.component, c.tunable) in own)
    if operations:
        diagnostics = (*diagnostics, *beams_in_the_way(setup, request.seen, request.wanted, changes))
    return Plan(
        lab=LabRef(name=setup.lab.name, digest=setup.digest()), backend=backend, fidelity=fidelity, base=base,
        target=target, changes=changes, operations=operations,
        staging=Staging() if _errored(diagnostics) else moves.staging,
        makespan=makespan(operations), bound=least_makespan(operations, moves.bound),
        policy=policy_rules(setup, request.seen, operations), blocking=moves.blocking,
        diagnostics=diagnostics,
    ).sealed()  # fmt: skip


def _errored(diagnostics: Sequence[Diagnostic]) -> bool:
    return any(d.severity == "error" for d in diagnostics)


def compile_moves(request: Request, situation: Situation) -> Compiled:
    """Return the moves of arms and people, with the parks at the end."""
    from pico.planning.explaining.proof import proof, standing_proof
    from pico.planning.explaining.refusal import explain, storage_note
    from pico.planning.ordering.solve import OrderedMoves, OrderingProblem, solve

    movers, obstacles, put_off = actors(request, situation)
    if not movers:
        return Compiled(diagnostics=tuple(put_off))
    impossible = check_target(request.setup, movers, obstacles, request.source, alone=request.alone)
    impossible += check_tethers(request.setup, movers, request.source)
    if impossible:
        blocking = standing_proof(request.setup, movers, obstacles, request.motion)
        return Compiled(diagnostics=(*put_off, *impossible), blocking=blocking)
    others = () if request.alone else asides(request, situation, movers)
    if request.alone:
        movers = tuple(replace(m, stages=False) for m in movers)
    answer = solve(OrderingProblem(
        request.setup, request.seen, movers, tuple(obstacles), others, request.motion,
        fastest=request.prefer == "shortest-time",
    ))  # fmt: skip
    if not isinstance(answer, OrderedMoves):
        why = proof(answer)
        return Compiled(diagnostics=(*put_off, *explain(answer, request.source, why)), blocking=why.blocking)
    operations, notes = _operations(request, answer)
    count, least = answer.staged, min(answer.staged, answer.least)
    staging = Staging(count=count, lower_bound=least, proven=count == least)
    return Compiled(
        tuple(operations), staging, (*put_off, *hand_warnings(movers), *notes, *storage_note(answer)), answer.tour.bound
    )


def _operations(request: Request, answer: OrderedMoves) -> tuple[list[Operation], list[Diagnostic]]:
    from pico.planning.explaining.reasons import move_reasons
    from pico.planning.ordering.meetings import items
    from pico.planning.ordering.order import precedence, reduced

    table, steps, paths = answer.table, answer.steps, answer.paths
    closure = precedence(table, steps, paths.extra if paths else {})
    reasons = move_reasons(request.setup, request.wanted, table, steps, closure)
    before, notes = reduced(closure), list[Diagnostic]()
    made: dict[int, Operation] = {}  # by the number of the item
    moved: dict[int, Operation] = {}  # by that of the step
    for n, item in enumerate(items(request.setup, steps, paths)):
        after = [made[e].id for e in item.waits if e in made]
        if item.park:
            done = _park(item, [moved[k] for k in item.park.steps])
            if isinstance(done, Diagnostic):
                notes.append(done)
                continue
            made[n] = replace(done, after=tuple(dict.fromkeys((*done.after, *after))))
        else:
            k = item.step or 0
            done = _moved(request, table, steps[k], item, paths.moves[k] if paths else None, reasons[k])
            after = [*(moved[e].id for e in before[k]), *after]
            made[n] = moved[k] = replace(done, after=tuple(dict.fromkeys(after)))
    return [*made.values()], notes


def _moved(
    request: Request, table: Conflicts, step: OrderedMove, item: Item, path: MovePath | None, reason: Reason
) -> Operation:
    actor = table.movers[step.mover]
    start, goal = actor.places[step.start], actor.places[step.goal]
    nominal = MOVE_SECONDS if step.hold.robot else OPERATOR_SECONDS
    owners = (step.hold.robot, actor.name, *item.zones) if step.hold.robot else None
    return Operation(
        id=new_id(), component=actor.name, robot=step.hold.robot,
        primitive="operator" if step.hold.robot is None else "stow" if goal.slot else "move",
        arguments=_arguments(start, goal, step.hold.yaw if step.hold.robot else None, actor.name),
        resources=owners or (actor.name, *sorted(request.setup.lab.robots)),  # a person works where no arm moves
        reason=request.reason or reason, seconds=path.seconds if path else nominal,
    )  # fmt: skip


def _park(item: Item, own: Sequence[Operation]) -> Operation | Diagnostic:
    """Return the park of an arm after its operations `own`, or why it can't park."""
    assert item.park is not None
    robot, path = item.park.robot, item.park.path
    if isinstance(path, Blocked):
        if item.park.before is None:  # one that was found standing there: where a move would end so there is no plan
            return warning("not-parked", f"{robot} can't park: {path.text}", address=robot)
        return error("blocked", f"{robot} can't park: {path.text}", address=robot)
    waited = {e for op in own for e in op.after}
    return Operation(
        id=new_id(), primitive="park", component=robot, robot=robot,
        after=tuple(op.id for op in own if op.id not in waited),
        resources=(robot, *item.zones), reason=Reason(kind="parked", text="out of the beam"),
        seconds=path.seconds if path else PARK_SECONDS,
    )  # fmt: skip


def _arguments(start: Place, goal: Place, grasp_yaw: float | None, name: str) -> dict[str, Any]:
    if grasp_yaw is None:
        return {"text": f"move {name} from {start} to {goal}", "from": _place(start), "to": _place(goal)}
    return {"from": _place(start), "to": _place(goal), "grasp_yaw": grasp_yaw}


def _place(place: Place) -> dict[str, Any]:
    return {"pose": as_json(place.pose)} | ({"slot": place.slot} if place.slot else {})

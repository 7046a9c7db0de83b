"""The plan: physical diff -> target check -> order with staging -> paths -> schedule -> reasons. Pure."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, error, warning
from pico.model.lab import Setup
from pico.model.observation import Observation
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Staging, Target
from pico.model.record import as_json
from pico.model.state import LabState
from pico.motion.types import Blocked, Motion, MovePath
from pico.planning.actors import actors, asides, hand_warnings
from pico.planning.interlocks import policy_rules, unguarded, with_interlocks
from pico.planning.movers import Place
from pico.planning.request import Preference, Request
from pico.planning.selection import done_by, selection, told
from pico.planning.situation import Situation, read_situation
from pico.planning.target import Source, check_target, no_source
from pico.planning.tethers import check_tethers
from pico.planning.values import OPERATOR_SECONDS, value_operations

if TYPE_CHECKING:
    from pico.planning.order import Turn
    from pico.planning.solve import Solution
    from pico.planning.together import Meetings

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
    only = selection(setup, targets, exclude)
    request = Request(setup, seen, wanted, motion, source or no_source, exact, prefer=prefer, only=only)
    return compiled_plan(request, backend=backend, fidelity=fidelity, base=base, target=target)


def compiled_plan(request: Request, *, backend: str, fidelity: str, base: Base, target: Target) -> Plan:
    """Return the sealed plan of a request."""
    from pico.planning.schedule import least_makespan, makespan, schedule

    setup = request.setup
    situation = read_situation(setup, request.seen, request.wanted, exact=request.exact)
    moves = compile_moves(request, situation) if situation.moving else Compiled()
    asked = tuple(c for c in situation.changes if request.only.chosen(c.component))
    values, notes = value_operations(setup, request.seen, asked, request.reason)
    diagnostics = (*situation.diagnostics, *moves.diagnostics, *notes)
    operations: tuple[Operation, ...] = ()
    if not any(d.severity == "error" for d in diagnostics):
        offset = len(moves.operations)
        shifted = [replace(o, after=tuple(str(int(e) + offset) for e in o.after)) for o in values]
        guarded = with_interlocks(setup, request.seen, (*moves.operations, *shifted))
        operations = schedule(guarded)
        diagnostics = (*diagnostics, *unguarded(setup, request.seen, operations))
    changes = situation.changes
    if not request.only.everything and operations:
        diagnostics = (*diagnostics, *told(request.only, changes, operations))
    if not request.only.everything:
        done = done_by(operations)
        changes = tuple(c for c in changes if request.only.chosen(c.component) or (c.component, c.tunable) in done)
    return Plan(
        lab=LabRef(name=setup.lab.name, digest=setup.digest()), backend=backend, fidelity=fidelity, base=base,
        target=target, changes=changes, operations=operations,
        staging=Staging() if _errored(diagnostics) else moves.staging,
        makespan=makespan(operations), bound=least_makespan(operations, moves.bound),
        policy=policy_rules(setup, request.seen, operations),
        diagnostics=diagnostics,
    ).sealed()  # fmt: skip


def _errored(diagnostics: Sequence[Diagnostic]) -> bool:
    return any(d.severity == "error" for d in diagnostics)


def compile_moves(request: Request, situation: Situation) -> Compiled:
    """Return the moves of arms and people, with the parks at the end."""
    from pico.planning.refusal import explain, storage_note
    from pico.planning.solve import Problem, Solution, solve

    movers, obstacles, put_off = actors(request, situation)
    if not movers:
        return Compiled(diagnostics=tuple(put_off))
    impossible = check_target(request.setup, movers, obstacles, request.source)
    impossible += check_tethers(request.setup, movers, request.source)
    if impossible:
        return Compiled(diagnostics=(*put_off, *impossible))
    others = () if request.alone else asides(request, situation, movers)
    if request.alone:
        movers = tuple(replace(m, stages=False) for m in movers)
    answer = solve(Problem(
        request.setup, request.seen, movers, tuple(obstacles), others, request.motion,
        fastest=request.prefer == "shortest-time",
    ))  # fmt: skip
    if not isinstance(answer, Solution):
        return Compiled(diagnostics=(*put_off, *explain(answer, request.source)))
    operations, notes = _operations(request, answer)
    count, least = answer.staged, min(answer.staged, answer.least)
    staging = Staging(count=count, lower_bound=least, proven=count == least)
    return Compiled(
        tuple(operations), staging, (*put_off, *hand_warnings(movers), *notes, *storage_note(answer)), answer.tour.bound
    )


def _operations(request: Request, answer: Solution) -> tuple[list[Operation], list[Diagnostic]]:
    from pico.planning.order import precedence, reduced, turns
    from pico.planning.reasons import move_reasons
    from pico.planning.together import meetings

    table, steps, paths = answer.table, answer.steps, answer.paths
    closure = precedence(table, steps, paths.extra if paths else {})
    reasons = move_reasons(request.setup, request.wanted, table, steps, closure)
    met = meetings(request.setup, steps, paths) if paths and len(request.setup.lab.robots) > 1 else None
    operations = []
    for k, (step, after) in enumerate(zip(steps, reduced(closure), strict=True)):
        actor = table.movers[step.mover]
        path = paths.moves[k] if paths else None
        start, goal = actor.places[step.start], actor.places[step.goal]
        nominal = MOVE_SECONDS if step.hold.robot else OPERATOR_SECONDS
        operations.append(Operation(
            id="", component=actor.name, robot=step.hold.robot, after=tuple(str(e) for e in after),
            primitive="operator" if step.hold.robot is None else "stow" if goal.slot else "move",
            arguments=_arguments(start, goal, step.hold.yaw if step.hold.robot else None, actor.name),
            resources=_resources(request.setup, step.hold.robot, actor.name, met.zones.get(k, ()) if met else None),
            reason=request.reason or reasons[k], seconds=path.seconds if path else nominal,
        ))  # fmt: skip
    return _with_parks(operations, turns(steps), paths.parks if paths else (), met)


def _arguments(start: Place, goal: Place, grasp_yaw: float | None, name: str) -> dict[str, Any]:
    if grasp_yaw is None:
        return {"text": f"move {name} from {start} to {goal}", "from": _place(start), "to": _place(goal)}
    return {"from": _place(start), "to": _place(goal), "grasp_yaw": grasp_yaw}


def _place(place: Place) -> dict[str, Any]:
    return {"pose": as_json(place.pose)} | ({"slot": place.slot} if place.slot else {})


def _resources(
    setup: Setup, robot: str | None, component: str, zones: tuple[str, ...] | None = None
) -> tuple[str, ...]:
    """A person works where no arm moves; several arms take turns where nobody knows which `zones` they come into."""
    if robot is None:
        return (component, *sorted(setup.lab.robots))
    if zones is None:
        zones = ("arms",) if len(setup.lab.robots) > 1 else ()
    return (robot, component, *zones)


def _with_parks(
    operations: list[Operation], turns: Sequence[Turn], paths: Sequence[MovePath | Blocked], met: Meetings | None
) -> tuple[list[Operation], list[Diagnostic]]:
    """Return the operations with a park after each turn; the next robot's turn waits for it, or, where it is known
    which steps meet, these for one another."""
    out, notes = list(operations), []
    parks: dict[int, int] = {}
    for n, turn in enumerate(turns):
        path = paths[n] if paths else None
        if isinstance(path, Blocked):
            stuck = error if n + 1 < len(turns) else warning
            notes.append(stuck("blocked", f"{turn.robot} can't park: {path.text}", address=turn.robot))
            continue
        waited = {int(e) for k in turn.steps for e in operations[k].after}
        after = tuple(str(k) for k in turn.steps if k not in waited)
        for k in turns[n + 1].steps if met is None and n + 1 < len(turns) else ():
            out[k] = replace(out[k], after=(*out[k].after, str(len(out))))
        parks[n] = len(out)
        out.append(Operation(
            id="", primitive="park", component=turn.robot, robot=turn.robot, after=after,
            resources=(turn.robot, *(met.parks.get(n, ()) if met else ())),
            reason=Reason(kind="parked", text="out of the beam"), seconds=path.seconds if path else PARK_SECONDS,
        ))  # fmt: skip
    for k, waits in met.waits.items() if met else ():
        ends = (str(e if e >= 0 else parks[-1 - e]) for e in waits if e >= 0 or -1 - e in parks)
        out[k] = replace(out[k], after=tuple(dict.fromkeys((*out[k].after, *ends))))
    return out, notes

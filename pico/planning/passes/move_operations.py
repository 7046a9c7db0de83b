"""From moves in order to operations: what is carried where, by whom, why, and after what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from pico.diagnostics import Diagnostic, warning
from pico.model.operation import Operation, Reason, new_id
from pico.model.record import as_json
from pico.motion.types import Blocked, MovePath
from pico.planning.explaining.reasons import move_reasons
from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.meetings import Item, items
from pico.planning.ordering.order import precedence, reduced
from pico.planning.ordering.search import OrderedMove
from pico.planning.ordering.solve import OrderedMoves
from pico.planning.parts.movers import Place
from pico.planning.passes.draft import Draft
from pico.planning.passes.values import OPERATOR_SECONDS, hands_of

MOVE_SECONDS = 10.0
"""What a pick and place takes where no motion is asked for [s]."""
PARK_SECONDS = 3.0
"""What a park takes where no motion is asked for [s]."""


def move_operations(draft: Draft, answer: OrderedMoves) -> tuple[list[Operation], list[Diagnostic]]:
    """Return the operations of ordered moves, each after those that it waits for, and what is to be said of parks."""
    table, steps, paths = answer.table, answer.steps, answer.paths
    closure = precedence(table, steps, paths.extra if paths else {})
    reasons = move_reasons(draft.setup, draft.goal.wanted, table, steps, closure)
    before, notes = reduced(closure), list[Diagnostic]()
    made: dict[int, Operation] = {}  # by the number of the item
    moved: dict[int, Operation] = {}  # by that of the step
    for n, item in enumerate(items(draft.setup, steps, paths)):
        after = [made[e].id for e in item.waits if e in made]
        if item.park:
            done = _park(item, [moved[k] for k in item.park.steps])
            if isinstance(done, Diagnostic):
                notes.append(done)
                continue
            made[n] = replace(done, after=tuple(dict.fromkeys((*done.after, *after))))
        else:
            k = item.step or 0
            done = _moved(draft, table, steps[k], item, paths.moves[k] if paths else None, reasons[k])
            after = [*(moved[e].id for e in before[k]), *after]
            made[n] = moved[k] = replace(done, after=tuple(dict.fromkeys(after)))
    return [*made.values()], notes


def _moved(
    draft: Draft, table: Conflicts, step: OrderedMove, item: Item, path: MovePath | None, reason: Reason
) -> Operation:
    actor = table.movers[step.mover]
    start, goal = actor.places[step.start], actor.places[step.goal]
    nominal = MOVE_SECONDS if step.hold.robot else OPERATOR_SECONDS
    owners = (step.hold.robot, actor.name, *item.zones) if step.hold.robot else None
    return Operation(
        id=new_id(), component=actor.name, robot=step.hold.robot,
        primitive="operator" if step.hold.robot is None else "stow" if goal.slot else "move",
        arguments=_arguments(start, goal, step.hold.yaw if step.hold.robot else None, actor.name),
        resources=owners or (actor.name, *hands_of(draft.setup)),
        reason=draft.goal.reason or reason, seconds=path.seconds if path else nominal,
    )  # fmt: skip


def _park(item: Item, own: Sequence[Operation]) -> Operation | Diagnostic:
    """Return the park of an arm after its operations `own`, or why it can't park."""
    assert item.park is not None
    robot, path = item.park.robot, item.park.path
    if isinstance(path, Blocked):
        # found standing there, in nobody's way: where it is in one's, or a move would end so, there is no plan
        return warning("not-parked", f"{robot} can't park: {path.text}", address=robot)
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

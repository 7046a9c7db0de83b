"""Why each move is in the plan, in words: what changed, what it waits for, what it makes room for."""

from __future__ import annotations

from collections.abc import Sequence

from pico.geometry import separation
from pico.model.operation import Reason
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.planning.ordering.conflicts import Conflicts, Spot
from pico.planning.ordering.order import Closure
from pico.planning.ordering.search import OrderedMove


def move_reasons(
    setup: Setup, wanted: LabState, table: Conflicts, steps: Sequence[OrderedMove], closure: Closure
) -> tuple[Reason, ...]:
    """Return the reason of each step."""
    return tuple(_reason(setup, wanted, table, steps, closure, k) for k in range(len(steps)))


def _reason(
    setup: Setup, wanted: LabState, table: Conflicts, steps: Sequence[OrderedMove], closure: Closure, k: int
) -> Reason:
    step = steps[k]
    mover = table.movers[step.mover]
    waits, overlap, why = _waiting(table, steps, closure, k)
    if step.hold.robot is None:
        return Reason(kind="operator", of=waits, overlap=overlap, text=why or "only a person can move it")
    if mover.right and step.goal in mover.goals:
        return Reason(kind="in_the_way", of=waits, text=f"back to where it was{', ' + why if why else ''}")
    if step.goal not in mover.goals:
        kind = "in_the_way" if mover.right else "staged"
        of, overlap, text = _making_room(table, steps, k)
        return Reason(kind="in_the_way" if kind == "in_the_way" else "staged", of=of, overlap=overlap, text=text)
    to_storage = mover.places[step.goal].slot is not None
    if to_storage and (mover.name not in wanted.components or mover.start.slot is None):
        return Reason(kind="stowed", of=waits, overlap=overlap, text=why or "not wanted on the table")
    return Reason(kind="changed", of=waits, overlap=overlap, text=why)


def _waiting(
    table: Conflicts, steps: Sequence[OrderedMove], closure: Closure, k: int
) -> tuple[tuple[str, ...], float | None, str]:
    """Return the components that a step waits for, by how much the nearest would overlap, and that in words."""
    step, names, best, text = steps[k], [], 0.0, ""
    for e in range(k):
        earlier = steps[e]
        if (
            e not in closure[k]
            or earlier.mover == step.mover
            or not step.mask & table.bit(earlier.mover, earlier.start)
        ):
            continue
        name = table.movers[earlier.mover].name
        names.append(name)
        depth = body_overlap(table, (step.mover, step.goal), (earlier.mover, earlier.start))
        if depth > best:
            best, text = depth, f"after {name}: its base would overlap by {depth:.3g} mm"
        elif not text:
            text = f"after {name}: {_touching(table, depth, name)}"
    return tuple(dict.fromkeys(names)), round(best, 3) if best > 0 else None, text


def _touching(table: Conflicts, depth: float, name: str) -> str:
    margin = table.setup.lab.margins.body
    if depth > -margin:
        return f"its base would come within {max(0.0, -depth):.3g} mm"
    return f"a finger of the gripper would touch {name}"


def body_overlap(table: Conflicts, a: Spot, b: Spot) -> float:
    """Return how deep the bodies at two spots overlap [mm]; negative: how far apart they are."""
    return -separation(table.shape(*a), table.shape(*b))


def _making_room(table: Conflicts, steps: Sequence[OrderedMove], k: int) -> tuple[tuple[str, ...], float | None, str]:
    """Return whom a component makes room for when it is put down in storage, and that in words."""
    step = steps[k]
    bit, back = table.bit(step.mover, step.start), _next_of(steps, k)
    of, best, text = [], 0.0, ""
    for later in steps[k + 1 : back]:
        if not later.mask & bit:
            continue
        name = table.movers[later.mover].name
        of.append(name)
        depth = body_overlap(table, (later.mover, later.goal), (step.mover, step.start))
        if depth > best:
            best, text = depth, f"makes room for {name}: their bases would overlap by {depth:.3g} mm"
        elif not text:
            text = f"makes room for {name}: {_touching(table, depth, table.movers[step.mover].name)}"
    if not of:
        onward = steps[back].hold.robot if back < len(steps) else step.hold.robot
        handed = onward is not None and onward != step.hold.robot
        text = f"put down for {onward} to take on" if handed else "put down in storage to be gripped at another angle"
    return tuple(dict.fromkeys(of)), round(best, 3) if best > 0 else None, text


def _next_of(steps: Sequence[OrderedMove], k: int) -> int:
    """Return the index of the next step of the same mover, or the end."""
    return next((n for n in range(k + 1, len(steps)) if steps[n].mover == steps[k].mover), len(steps))

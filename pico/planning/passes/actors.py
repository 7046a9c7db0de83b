"""Who moves, who may be moved to make room, and who stays."""

from __future__ import annotations

from collections.abc import Sequence

from pico.diagnostics import Diagnostic, warning
from pico.geometry import Grid
from pico.planning.checks.standing import goal_shape
from pico.planning.checks.target import check_target
from pico.planning.parts.movers import Mover, Obstacle, mover, standing_obstacles
from pico.planning.passes.draft import Draft


def actors(draft: Draft) -> tuple[tuple[Mover, ...], list[Obstacle], list[Diagnostic]]:
    """Return the movers and what stays; a mover that depends on a part which can't be planned for stays as well."""
    setup, seen = draft.setup, draft.seen
    names, put_off = [n for n in draft.moving if draft.only.chosen(n)], list[Diagnostic]()
    left = {n for n in draft.moving if draft.only.excluded(n)}
    if not draft.robots and len(setup.lab.robots):
        held = [n for n in names if setup.movable(n)]
        names = [n for n in names if n not in held]
        put_off += [warning("blocked", f"{n} is not moved: no gripper is free", address=n) for n in held]
    unserved = {n: why for n in names if (why := _out_of_hand(draft, n))}
    names = [n for n in names if n not in unserved]
    put_off += [warning("blocked", f"{n} is not moved: {why}", address=n) for n, why in unserved.items()]
    while True:
        movers = {n: _mover(draft, n, right=False) for n in names}
        obstacles = standing_obstacles(setup, seen, movers)
        pulled = _pulled_in(draft, movers, obstacles) - {d.address for d in put_off}
        if pulled:
            names = sorted({*names, *pulled})
            continue
        troubled = left | {str(d.address) for d in (*draft.diagnostics, *put_off)}
        lost = _dependents(draft, movers, obstacles, troubled)
        if not lost:
            return tuple(movers.values()), obstacles, put_off
        put_off += lost
        names = [n for n in names if n not in {d.address for d in lost}]


def _out_of_hand(draft: Draft, name: str) -> str:
    """Return why no arm with a free gripper gets to a part, or to where it is to go, if that is for an arm that holds
    something; else empty."""
    motion, setup = draft.motion, draft.setup
    busy = sorted({*setup.lab.robots} - {*draft.robots})
    if not motion or not busy or not draft.robots or not setup.movable(name):
        return ""
    one = _mover(draft, name, right=False)
    for places, where in (((0,), "to it"), (one.goals, "to where it is to go")):
        poses = [one.places[p].pose for p in places]
        free, taken = (
            [motion.reach(robot, name, pose, 0.0) for robot in robots for pose in poses]
            for robots in (draft.robots, busy)
        )
        if None in free:
            continue
        barred = next((b.text for b in free if b and b.obstacle in busy), "")
        if barred or any(b is None or b.obstacle in busy for b in taken):
            return barred or f"no arm with a free gripper gets {where}"
    return ""


def _mover(draft: Draft, name: str, *, right: bool) -> Mover:
    return mover(draft.setup, draft.seen, draft.goal.wanted, name, draft.robots, right=right)


def _pulled_in(draft: Draft, movers: dict[str, Mover], obstacles: list[Obstacle]) -> set[str]:
    """Return what was not asked for but should move anyway, and stands where a mover should end."""
    if not draft.only.targets:
        return set()
    may = {n for n in draft.moving if not draft.only.excluded(n)}
    shapes = Grid.of({o.name: o.shape for o in obstacles if o.name in may})
    margin = draft.setup.lab.margins.body
    goals = (goal_shape(m, m.goal) for m in movers.values())
    return {name for shape in goals for name in shapes.conflicts(shape, margin)}


def _dependents(
    draft: Draft, movers: dict[str, Mover], obstacles: list[Obstacle], troubled: set[str]
) -> list[Diagnostic]:
    """Return a warning for each mover whose goal is taken by a part that lies there, or that waits for such a one."""
    bad = [o for o in obstacles if o.name in troubled and _can_not_move(draft, o.name)]
    if not bad:
        return []
    found = []
    for name, actor in movers.items():
        for clash in check_target(draft.setup, [actor], bad, draft.goal.source, alone=bool(draft.goal.alone))[:1]:
            found.append(warning("blocked", f"{name} is not moved: {clash.summary}", hint=clash.hint, address=name))
    return found


def _can_not_move(draft: Draft, name: str) -> bool:
    part = draft.seen.components.get(name)
    return part is not None and (part.presence != "seen" or draft.setup.movable(name))


def asides(draft: Draft, movers: Sequence[Mover]) -> tuple[Mover, ...]:
    """Return the parts that may be moved only to make room: those that are right, and those that were not asked for,
    which then go where they belong."""
    if draft.goal.alone:
        return ()
    setup, busy = draft.setup, {m.name for m in movers}
    put_off = {n for n in draft.moving if n not in busy and (draft.only.chosen(n) or not draft.robots)}
    names = [
        n for n, part in sorted(draft.seen.components.items())
        if n in setup.lab.inventory and n not in busy and n not in put_off and not draft.only.excluded(n)
        and part.presence == "seen" and part.pose is not None and setup.movable(n)
        and (setup.lab.inventory[n].stage != "never" or n in draft.moving)
    ]  # fmt: skip
    return tuple(_mover(draft, n, right=n not in draft.moving) for n in names)


def hand_warnings(draft: Draft, movers: Sequence[Mover]) -> list[Diagnostic]:
    """Return a warning for each part of a lab with arms that only a person may move."""
    if not draft.setup.lab.robots:
        return []
    return [
        warning(
            "operator", f"{m.name} must be moved by hand from {m.start} to {m.goal}: no arm may move it",
            hint="the simulator has a person who does that; on a real bench move it first, then plan again",
            address=m.name,
        )
        for m in movers if m.holds and m.holds[0].robot is None
    ]  # fmt: skip

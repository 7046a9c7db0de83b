"""Who moves, who may be moved to make room, and who stays."""

from __future__ import annotations

from collections.abc import Sequence

from pico.diagnostics import Diagnostic, warning
from pico.geometry import Grid
from pico.planning.checks.target import check_target, goal_shape
from pico.planning.parts.movers import Mover, Obstacle, mover, standing_obstacles
from pico.planning.parts.situation import Situation
from pico.planning.request import Request


def actors(request: Request, situation: Situation) -> tuple[tuple[Mover, ...], list[Obstacle], list[Diagnostic]]:
    """Return the movers and what stays; a mover that depends on a part which can't be planned for stays as well."""
    setup, seen = request.setup, request.seen
    names, put_off = [n for n in situation.moving if request.only.chosen(n)], list[Diagnostic]()
    left = {n for n in situation.moving if request.only.excluded(n)}
    if not situation.robots and len(setup.lab.robots):
        held = [n for n in names if setup.movable(n)]
        names = [n for n in names if n not in held]
        put_off += [warning("blocked", f"{n} is not moved: no gripper is free", address=n) for n in held]
    while True:
        movers = {n: _mover(request, situation, n, right=False) for n in names}
        obstacles = standing_obstacles(setup, seen, movers)
        pulled = _pulled_in(request, situation, movers, obstacles) - {d.address for d in put_off}
        if pulled:
            names = sorted({*names, *pulled})
            continue
        troubled = left | {str(d.address) for d in (*situation.diagnostics, *put_off)}
        lost = _dependents(request, movers, obstacles, troubled)
        if not lost:
            return tuple(movers.values()), obstacles, put_off
        put_off += lost
        names = [n for n in names if n not in {d.address for d in lost}]


def _mover(request: Request, situation: Situation, name: str, *, right: bool) -> Mover:
    return mover(request.setup, request.seen, request.wanted, name, situation.robots, right=right)


def _pulled_in(request: Request, situation: Situation, movers: dict[str, Mover], obstacles: list[Obstacle]) -> set[str]:
    """Return what was not asked for but should move anyway, and stands where a mover should end."""
    if not request.only.targets:
        return set()
    may = {n for n in situation.moving if not request.only.excluded(n)}
    shapes = Grid.of({o.name: o.shape for o in obstacles if o.name in may})
    margin = request.setup.lab.margins.body
    goals = (goal_shape(m, m.goal) for m in movers.values())
    return {name for shape in goals for name in shapes.conflicts(shape, margin)}


def _dependents(
    request: Request, movers: dict[str, Mover], obstacles: list[Obstacle], troubled: set[str]
) -> list[Diagnostic]:
    """Return a warning for each mover whose goal is taken by a part that lies there, or that waits for such a one."""
    bad = [o for o in obstacles if o.name in troubled and _can_not_move(request, o.name)]
    if not bad:
        return []
    found = []
    for name, actor in movers.items():
        for clash in check_target(request.setup, [actor], bad, request.source, alone=request.alone)[:1]:
            found.append(warning("blocked", f"{name} is not moved: {clash.summary}", hint=clash.hint, address=name))
    return found


def _can_not_move(request: Request, name: str) -> bool:
    part = request.seen.components.get(name)
    return part is not None and (part.presence != "seen" or request.setup.movable(name))


def asides(request: Request, situation: Situation, movers: Sequence[Mover]) -> tuple[Mover, ...]:
    """Return the parts that may be moved only to make room: those that are right, and those that were not asked for,
    which then go where they belong."""
    setup, busy = request.setup, {m.name for m in movers}
    put_off = {n for n in situation.moving if n not in busy and (request.only.chosen(n) or not situation.robots)}
    names = [
        n for n, part in sorted(request.seen.components.items())
        if n in setup.lab.inventory and n not in busy and n not in put_off and not request.only.excluded(n)
        and part.presence == "seen" and part.pose is not None and setup.movable(n)
        and (setup.lab.inventory[n].stage != "never" or n in situation.moving)
    ]  # fmt: skip
    return tuple(_mover(request, situation, n, right=n not in situation.moving) for n in names)


def hand_warnings(movers: Sequence[Mover]) -> list[Diagnostic]:
    return [
        warning(
            "operator", f"{m.name} must be moved by hand from {m.start} to {m.goal}: no arm may move it",
            hint="apply waits for a person there; or write into the manifest where it stands", address=m.name,
        )
        for m in movers if m.holds and m.holds[0].robot is None
    ]  # fmt: skip

"""Is the state wanted possible at all? What would overlap, by how much, and where there is room instead."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from pico.diagnostics import Diagnostic, SourceRange, error
from pico.geometry import Grid, Shape, conflict, fits, moved, overhang, separation
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.types import Motion
from pico.planning.checks.free_places import Trial, free_slots, nearest_free, trial_of
from pico.planning.checks.standing import Standing, Standpoint, forbidden, goal_shape, in_bounds
from pico.planning.parts.movers import Mover, Obstacle, Place
from pico.planning.parts.phrases import listed

Source = Callable[[str], SourceRange | None]


def no_source(_: str) -> SourceRange | None:
    """Know no place in any file."""
    return None


def located(source: Source, mover: Mover, axis: str = "x") -> SourceRange | None:
    """Return where a manifest says where a mover belongs."""
    return source(f"{mover.name}.slot" if mover.goal.slot else f"{mover.name}.pose.{axis}")


def check_target(
    setup: Setup,
    movers: Sequence[Mover],
    obstacles: Sequence[Obstacle],
    source: Source = no_source,
    *,
    alone: bool = False,
    motion: Motion | None = None,
) -> list[Diagnostic]:
    """Return an error for each mover that can't stand at its goal, whatever the order: beside what stays and the
    goals of the others, on the table, outside of keep-outs, in its slot. `alone`: where nothing else is to move.
    With `motion` a place is offered instead only where an arm brings the part there."""
    ends = {o.name: Standpoint(o.name, o.shape, False, o.height) for o in obstacles}
    ends |= {m.name: Standpoint(m.name, goal_shape(m, m.goal), True, m.geometry.height) for m in movers}
    standing = Standing(ends, Grid.of({name: end.shape for name, end in ends.items()}))
    others, trial = {m.name: m for m in movers}, trial_of(movers, obstacles, motion)
    found: list[Diagnostic] = []
    told: set[frozenset[str]] = set()
    for mover in movers:
        found += _where(setup, mover, source)
        for other in _overlaps(setup, mover, standing.grid, others):
            if frozenset((mover.name, other)) not in told:
                told.add(frozenset((mover.name, other)))
                found.append(_overlap(setup, mover, ends[other], standing, source, alone, trial))
    return found


def _overlaps(setup: Setup, mover: Mover, grid: Grid[str], others: Mapping[str, Mover]) -> list[str]:
    """Return what is in the way of the mover at its goal, however the others are turned in their slots: nothing if a
    turn of the part in its own avoids it."""
    margin = setup.lab.margins.body
    places = [mover.places[goal] for goal in mover.goals]
    hits: list[list[str]] = []
    for place in [p for p in places if in_bounds(setup, mover, p)] or places:
        shape = goal_shape(mover, place)
        near = sorted(n for n in grid.near(shape, margin) if n != mover.name)
        hits.append([n for n in near if _always_meets(shape, margin, grid.shapes[n], others.get(n))])
        if not hits[-1]:
            return []
    return [n for n in hits[0] if all(n in turn for turn in hits)] or hits[0]


def _always_meets(shape: Shape, margin: float, stands: Shape, other: Mover | None) -> bool:
    """Whether a shape comes too near to what stands there, or to a mover at every place where it may end."""
    ends = [goal_shape(other, other.places[g]) for g in other.goals] if other else [stands]
    return all(conflict(shape, end, margin) for end in ends)


def _overlap(
    setup: Setup, mover: Mover, other: Standpoint, standing: Standing, source: Source, alone: bool, trial: Trial
) -> Diagnostic:  # fmt: skip
    margin = setup.lab.margins.body
    shape = goal_shape(mover, mover.goal)
    gap = separation(shape, other.shape)
    apart, axis = room_between(shape, other.shape, margin)
    stands = "is to stand" if other.moves else "stands"
    where = f"{other.name} {stands} at ({other.shape.x:.4g}, {other.shape.y:.4g})"
    need = f"the bases need {apart:.4g} mm between centers along {axis}"
    if gap <= 0:
        what = f"it would overlap {other.name} by {-gap:.3g} mm" if gap < 0 else f"it would touch {other.name}"
    else:
        what = f"it would come within {gap:.3g} mm of {other.name}, and {margin:.3g} mm must stay free"
    return error(
        "impossible", f"{mover.name} cannot stand at {_spot(mover.goal)}: {what}", detail=f"{where}; {need}",
        hint=_way_out(setup, mover, other, standing, alone, trial), address=f"{mover.name}.pose",
        label=f"{where}; {need}", source=located(source, mover),
    )  # fmt: skip


def _spot(place: Place) -> str:
    return f"{place.pose} ({place.slot})" if place.slot else str(place.pose)


def room_between(a: Shape, b: Shape, margin: float) -> tuple[float, str]:
    """Return how far the centers must lie apart along x or y, whichever axis they lie apart along now [mm]."""
    axis = "x" if abs(a.x - b.x) >= abs(a.y - b.y) else "y"
    side = 1.0 if (a.x >= b.x if axis == "x" else a.y >= b.y) else -1.0
    low, high = 0.0, 2 * (a.radius + b.radius + margin)
    for _ in range(40):
        middle = (low + high) / 2
        dx, dy = (b.x + side * middle - a.x, 0.0) if axis == "x" else (0.0, b.y + side * middle - a.y)
        if conflict(moved(a, dx, dy), b, margin):
            low = middle
        else:
            high = middle
    return round(high, 2), axis


def _way_out(
    setup: Setup, mover: Mover, other: Standpoint, standing: Standing, alone: bool, trial: Trial
) -> str:  # fmt: skip
    ways = []
    if kept := trial.kept(mover):
        return f"no other place would do: {kept.text}" + (f"; {kept.help}" if kept.help else "")
    if mover.goal.slot:
        free_ones = free_slots(setup, mover, standing, trial)
        ways.append(f"choose a free slot: {listed(free_ones, 'or')}" if free_ones else "no slot is free for it")
    elif free := nearest_free(setup, mover, standing, trial):
        ways.append(f"nearest free place {_place_text(mover.goal.pose, free)}")
    if other.name not in setup.lab.inventory:
        ways.append(f"take {other.name} away by hand")
    elif other.moves or (setup.movable(other.name) and not alone):
        ways.append(f"give {other.name} another place")
    elif setup.movable(other.name):
        ways.append(f"move {other.name} first")
    return "; or ".join(ways) or "choose a place farther away: no arm was found to bring it to one near by"


def _place_text(pose: Pose, free: tuple[float, float]) -> str:
    if free[1] == pose.y:
        return f"along x is x = {free[0]:g}"
    if free[0] == pose.x:
        return f"along y is y = {free[1]:g}"
    return f"is x = {free[0]:g}, y = {free[1]:g}"


def _where(setup: Setup, mover: Mover, source: Source) -> list[Diagnostic]:
    """Return what is wrong with the goal itself, whatever else stands on the table."""
    found = []
    shape, name, spot = goal_shape(mover, mover.goal), mover.name, _spot(mover.goal)
    address = f"{name}.pose"
    blame = located(source, mover)
    turns = any(in_bounds(setup, mover, mover.places[g]) for g in mover.goals)
    out = 0.0 if turns or setup.lab.beside_table(mover.goal.slot) else overhang(setup.lab.table, shape)
    if out > 0:
        width, depth = setup.lab.table.size
        inside = moved(shape, min(max(shape.x, shape.radius), width - shape.radius) - shape.x, 0.0)
        axis = "y" if overhang(setup.lab.table, inside) > 0 else "x"
        found.append(error(
            "impossible", f"{name} cannot stand at {spot}: it would stick out {_mm(out)} mm over the table's edge",
            hint=f"the table goes from x = 0 to {width:g} and from y = 0 to {depth:g}", address=address,
            source=located(source, mover, axis),
        ))  # fmt: skip
    for zone in () if turns else forbidden(setup, mover, shape):
        why = setup.lab.keep_out[zone].reason
        found.append(error(
            "impossible", f"{name} cannot stand at {spot}: it would reach into keep-out {zone}",
            detail=why, hint="choose a place outside of it", address=address, source=blame,
        ))  # fmt: skip
    slot = mover.goal.slot
    if slot and not fits(setup.lab.slots[slot], mover.geometry.footprint):
        most, needs = setup.lab.slots[slot].fits, mover.geometry.footprint.radius
        found.append(error(
            "impossible", f"{name} does not fit in {slot}: it reaches {needs:.3g} mm from its center, the slot takes "
            f"{most:g} mm", hint="choose a larger slot", address=address, source=blame,
        ))  # fmt: skip
    return found


def _mm(length: float) -> str:
    return f"{length:.0f}" if length >= 100 else f"{length:.3g}"

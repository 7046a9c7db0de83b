"""Where on the free table a component may be put down meanwhile, in regions that a lab gives for it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from pico.geometry import Grid, Shape, capture_disc, placed, separation
from pico.model.lab import Region
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.planning.parts.movers import Mover, Obstacle, Place

PITCH = 20.0
"""Distance of the spots looked at [mm]."""
MOST = 6
"""How many spots a component is given, apart from one another."""


def with_spots(setup: Setup, movers: Sequence[Mover], obstacles: Sequence[Obstacle]) -> tuple[Mover, ...]:
    """Return the movers, each with a few spots in the staging regions that are free of everybody at its start and at
    its goal, and of every slot: whatever moves when, nobody needs them but others that are put down there."""
    regions = [r for _, r in sorted(setup.lab.regions.items()) if r.staging]
    shapes = {f"{m.name} {p}": placed(m.geometry.footprint, m.places[p].pose) for m in movers for p in (0, *m.goals)}
    shapes |= {o.name: o.shape for o in obstacles}
    taken, mouths = Grid.of(shapes), Grid.of({name: capture_disc(s) for name, s in setup.lab.slots.items()})
    return tuple(_with(setup, m, regions, taken, mouths) if m.stages else m for m in movers)


def _with(setup: Setup, mover: Mover, regions: Sequence[Region], taken: Grid[str], mouths: Grid[str]) -> Mover:
    margin, chosen = setup.lab.margins.body, list[Shape]()
    spots: list[Place] = []
    goal = mover.goal.pose
    near = sorted(_grid(mover, regions), key=lambda p: (round(p.distance(goal), 6), p.x, p.y, p.yaw))
    for pose in near:
        shape = placed(mover.geometry.footprint, pose)
        if not any(_inside(shape, region) for region in regions):
            continue
        if taken.conflicts(shape, margin) or mouths.conflicts(shape, 0.0):
            continue
        if all(separation(shape, other) > margin for other in chosen):
            chosen.append(shape)
            spots.append(Place(pose))
        if len(spots) == MOST:
            break
    known = len(mover.places)
    staging = (*mover.staging, *range(known, known + len(spots)))
    return replace(mover, places=(*mover.places, *spots), staging=staging)


def _grid(mover: Mover, regions: Sequence[Region]) -> Iterator[Pose]:
    yaws = sorted({mover.start.pose.yaw, mover.goal.pose.yaw})
    for region in regions:
        (left, right), (front, back) = region.area.x, region.area.y
        for n in range(int((right - left) / PITCH) + 1):
            for k in range(int((back - front) / PITCH) + 1):
                yield from (Pose(left + n * PITCH, front + k * PITCH, yaw) for yaw in yaws)


def _inside(shape: Shape, region: Region) -> bool:
    xs = [x for x, _ in shape.vertices] or [shape.x - shape.radius, shape.x + shape.radius]
    ys = [y for _, y in shape.vertices] or [shape.y - shape.radius, shape.y + shape.radius]
    sides = ((xs, region.area.x), (ys, region.area.y))
    return all(low <= min(values) and max(values) <= high for values, (low, high) in sides)

"""Several arms at one table: which of them makes each move, and in which order, so that all are done soonest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from pico.geometry import disc, polygon, separation
from pico.motion.zones import HAND, WIDTHS, Zone, shared_zones
from pico.planning.ordering.arm_times import ArmWork, soonest, timed
from pico.planning.ordering.clock import Clock
from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.order import precedence
from pico.planning.ordering.search import OrderedMove

PASSES = 2
"""How often each move that two arms can make is given to the other, to see whether all is then done sooner."""


def shared_out(clock: Clock, steps: Sequence[OrderedMove]) -> tuple[OrderedMove, ...]:
    """Return the steps in the order, and each by the arm, in which they are done soonest, as far as it is found."""
    best, seconds = _soonest(clock, tuple(steps))
    for _ in range(PASSES):
        before = best
        for step in before:
            for other in handed(clock, step):
                tried = tuple(other if s == step else s for s in best)
                tried, value = _soonest(clock, tried)
                if value < seconds - 1e-6:
                    best, seconds = tried, value
        if best == before:
            break
    return best


def _soonest(clock: Clock, steps: tuple[OrderedMove, ...]) -> tuple[tuple[OrderedMove, ...], float]:
    work = work_of(clock, steps)
    order = soonest(work, range(len(steps)))
    return tuple(steps[k] for k in order), timed(work, order)[0]


def handed(clock: Clock, step: OrderedMove) -> Iterator[OrderedMove]:
    """Yield the same move by each other arm that can make it wherever the arm that now does can."""
    table, seen = clock.table, {step.hold.robot}
    for hold in table.movers[step.mover].holds:
        mask = None if hold.robot in seen else table.held(step.mover, step.start, step.goal, hold)
        if mask is not None and mask | step.mask == step.mask:
            seen.add(hold.robot)
            yield replace(step, hold=hold, mask=mask)


def work_of(clock: Clock, steps: Sequence[OrderedMove]) -> ArmWork:
    """Return what the arms of a bench have to do: times as they tell, zones by where they pick and place."""
    table, setup, count = clock.table, clock.table.setup, range(len(steps))
    robots, zones = sorted(setup.lab.robots), shared_zones(setup)
    arm = tuple(robots.index(s.hold.robot or "") for s in steps)
    near = [
        [frozenset(z for z, zone in enumerate(zones) if _near(table, zone, s, p)) for p in (s.start, s.goal)]
        for s in steps
    ]
    return ArmWork(
        arms=len(robots), arm=arm, loaded=tuple(clock.loaded(s) for s in steps),
        start=tuple(clock.start(s) for s in steps), again=tuple(clock.again(s) for s in steps),
        between=tuple(
            tuple(clock.between(steps[i], steps[j]) if i != j and arm[i] == arm[j] else 0.0 for j in count)
            for i in count
        ),
        end=tuple(clock.end(s) for s in steps), before=precedence(table, steps, {}),
        enters=tuple(pick | place for pick, place in near), stays=tuple(place for _, place in near),
        zones=tuple((robots.index(z.robots[0]), robots.index(z.robots[1])) for z in zones),
    )  # fmt: skip


def _near(table: Conflicts, zone: Zone, step: OrderedMove, at: int) -> bool:
    """Whether an arm that picks or places at one of a mover's places is in a zone, taken as straight from its base."""
    robot, pose = step.hold.robot or "", table.movers[step.mover].places[at].pose
    if robot not in zone.robots:
        return False
    mount, area = table.setup.lab.robots[robot].mount, polygon(zone.corners)
    hand = disc(pose.x, pose.y, max(HAND, table.movers[step.mover].geometry.footprint.radius))
    along = [n / 8 for n in range(8)]
    links = (disc(mount.x + t * (pose.x - mount.x), mount.y + t * (pose.y - mount.y), WIDTHS[1]) for t in along)
    return any(separation(shape, area) <= 0.0 for shape in (hand, *links))

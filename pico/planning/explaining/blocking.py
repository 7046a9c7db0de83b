"""Who blocks whom in a plan: who must leave before another arrives, and the rings that this may close."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from pico.model.plan import Plan
from pico.model.record import record
from pico.model.setup import Setup
from pico.planning.checks.contacts import Contact, Spot, bases, ends_of, fingers, holds, mouth, starts_of
from pico.staging.feedback.digraph import ordered, shortest_cycle


@record
class Block:
    """`blocker` must leave its place before `blocked` can go straight to its goal. `by`: the nearest contact."""

    blocker: str
    blocked: str
    by: Contact
    every_grasp: bool = False

    @property
    def text(self) -> str:
        """`m1 must leave before m2 arrives: their bases would overlap by 22 mm`."""
        tried = ", every grasp angle tried" if self.every_grasp else ""
        return f"{self.blocker} must leave before {self.blocked} arrives: {self.by.text}{tried}"


@record
class Clash:
    """Two components whose goals are too near to each other, whatever the order of moves."""

    a: str
    b: str
    by: Contact


def moved_by(plan: Plan) -> tuple[str, ...]:
    """Return the components that a plan moves, or, where it is impossible, would have to; sorted."""
    moved = {o.component for o in plan.operations if o.kind.carries}
    wanted = {c.component for c in plan.changes if c.tunable == "pose" and not c.tolerated}
    return tuple(sorted(moved | wanted))


def blocks_of(setup: Setup, plan: Plan) -> tuple[Block, ...]:
    """Return every pair of components that the plan moves of which one must leave before the other arrives.

    Judged by where they start and end alone, for moves straight to the goal: bases, slots, and fingers in every hold
    that what stays put allows. Reach and the way of the arm are left out.
    """
    starts, ends = starts_of(setup, plan), ends_of(setup, plan)
    movers = [name for name in moved_by(plan) if name in starts and setup.movable(name)]
    still = {name: spot for name, spot in starts.items() if name not in movers}
    found = []
    for b in movers:
        free = _free_holds(setup, b, starts[b], ends[b], still)
        found += [
            block for a in movers
            if a != b and (block := _block(setup, a, b, starts, ends, free))
        ]  # fmt: skip
    return tuple(found)


def _free_holds(
    setup: Setup, name: str, start: Spot, end: Spot, still: Mapping[str, Spot]
) -> tuple[tuple[str, float], ...]:
    """Return the holds in which nothing that stays put is in the way of the fingers; all of them where none is free."""
    every = tuple(holds(setup, name))
    free = tuple(
        (robot, yaw) for robot, yaw in every
        if not any(
            fingers(setup, robot, yaw, name, at.pose, other, spot.pose)
            for other, spot in still.items() for at in (start, end)
        )
    )  # fmt: skip
    return free or every


def _block(
    setup: Setup,
    a: str,
    b: str,
    starts: Mapping[str, Spot],
    ends: Mapping[str, Spot],
    free: Sequence[tuple[str, float]],
) -> Block | None:
    """Return how `a` where it stands blocks the direct move of `b`."""
    there, end = starts[a].pose, ends[b]
    by = bases(setup, b, end.pose, a, there) or mouth(setup, end.slot, a, there)
    if by:
        return Block(blocker=a, blocked=b, by=by)
    least: Contact | None = None
    for robot, yaw in free:
        touches = [
            c for at in (starts[b].pose, end.pose) if (c := fingers(setup, robot, yaw, b, at, a, there))
        ]  # fmt: skip
        if not touches:
            return None
        worst = max(touches, key=lambda c: c.overlap)
        least = worst if least is None or worst.overlap < least.overlap else least
    return Block(blocker=a, blocked=b, by=least, every_grasp=True) if least else None


def ring_through(name: str, blocks: Iterable[Block]) -> tuple[Block, ...]:
    """Return a shortest ring of blocks through a component, starting with what it blocks; nothing where there is
    none."""
    between = {(block.blocker, block.blocked): block for block in blocks}
    blocked = {a: [b for c, b in between if c == a] for pair in between for a in pair}
    ring = shortest_cycle(ordered(blocked), name, blocked) if name in blocked else None
    return tuple(between[a, b] for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)) if ring else ()


def rings_of(blocks: Sequence[Block]) -> tuple[tuple[Block, ...], ...]:
    """Return a shortest ring through each component that lies in one, each ring once, the shorter ones first."""
    found: dict[frozenset[str], tuple[Block, ...]] = {}
    for name in sorted({b.blocker for b in blocks}):
        if ring := ring_through(name, blocks):
            found.setdefault(frozenset(b.blocker for b in ring), ring)
    return tuple(sorted(found.values(), key=len))


def clashes_of(setup: Setup, plan: Plan) -> tuple[Clash, ...]:
    """Return the pairs, at least one of which the plan moves, that can't both stand where they should."""
    ends, movers = ends_of(setup, plan), moved_by(plan)
    found = []
    for n, a in enumerate(movers):
        others = [*movers[n + 1 :], *(name for name in sorted(ends) if name not in movers)]
        found += [
            Clash(a=a, b=b, by=by) for b in others
            if a in ends and b in ends and (by := bases(setup, a, ends[a].pose, b, ends[b].pose))
        ]  # fmt: skip
    return tuple(found)


def why_impossible(setup: Setup, plan: Plan) -> tuple[tuple[Clash, ...], tuple[Block, ...]]:
    """Return what makes an impossible plan so, as far as geometry tells: goals that clash, or else the rings through
    the components that its diagnostics name. Nothing for a plan that can be applied."""
    if not plan.errored:
        return (), ()
    named = {d.address.partition(".")[0] for d in plan.diagnostics if d.severity == "error"}
    clashes = tuple(c for c in clashes_of(setup, plan) if {c.a, c.b} & named)
    if clashes:
        return clashes, ()
    blocks = blocks_of(setup, plan)
    found = {pair: block for name in sorted(named) for block in ring_through(name, blocks) if (pair := _pair(block))}
    return (), tuple(found.values())


def _pair(block: Block) -> tuple[str, str]:
    return block.blocker, block.blocked

"""Which moves exclude which standing components: bodies at every place, fingers at pick and place, reach, paths.

Every (mover, place) has a bit. A configuration is the union of the bits of the places taken; a move is possible
where its mask meets none of them. Masks are computed when they are first asked for.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from pico.geometry import (
    Grid,
    Shape,
    capture_disc,
    conflict,
    finger_height,
    finger_zones,
    fits,
    outline,
    overhang,
    placed,
    reaches,
    separation,
)
from pico.model.catalog import Footprint
from pico.model.observation import slot_at
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.reach import check_tether
from pico.motion.types import Blocked, Motion
from pico.planning.parts.movers import Hold, Mover, Obstacle, with_storage
from pico.planning.parts.spots import with_spots

FEW, MANY_SLOTS, ENOUGH_SLOTS = 7, 60, 24
"""With few movers up to so many of the free storage slots are considered for each, with more so many."""
EVERY_SLOT = 3000
"""Where these do not suffice, so many slots are considered for all movers together."""

Spot = tuple[int, int]
"""A mover and one of its places, by index."""
Look = tuple[Footprint, float, Pose]
"""What a spot is to its neighbors: footprint, height and pose."""


@dataclass(frozen=True, slots=True)
class Way:
    """One way to make a move: how the component is held, and the bits of the spots that must be empty."""

    hold: Hold
    mask: int


class Conflicts:
    """The tables of one planning problem. A mask is None where something that stays excludes it. `on_table`: parts may
    be put down in the lab's staging regions, too; `every_slot`: in any slot that is free, not only in the nearest."""

    def __init__(
        self,
        setup: Setup,
        movers: Sequence[Mover],
        obstacles: Sequence[Obstacle],
        motion: Motion | None,
        on_table: bool,
        every_slot: bool = False,
    ) -> None:
        self.setup, self.motion = setup, motion
        self.more_slots = False
        """Whether there are more free slots than are considered."""
        self.obstacles = {o.name: o for o in obstacles}
        self.static: Grid[str] = Grid.of({o.name: o.shape for o in obstacles})
        self._mouths: Grid[str] = Grid.of({name: capture_disc(slot) for name, slot in setup.lab.slots.items()})
        movers = self._stored(movers, every_slot)
        movers = self.movers = with_spots(setup, movers, obstacles) if on_table else movers
        self.spots: list[Spot] = [(i, p) for i, m in enumerate(movers) for p in range(len(m.places))]
        self._bits = {spot: 1 << n for n, spot in enumerate(self.spots)}
        self._in_use = {s for o in obstacles if (s := self._slot_used(o.name, o.standing.pose))}
        """The slots in which something stays."""
        self._users, self._ends_in = self._in_slots()
        self.ends = sum_of(self._bits[i, p] for i, m in enumerate(movers) for p in {0, *m.goals})
        """Where movers stand at first and where they may end."""
        self._own = [sum_of(self._bits[i, p] for p in range(len(m.places))) for i, m in enumerate(movers)]
        self._alike = self._group()
        self._mobile: Grid[Look] = Grid.of({look: placed(look[0], look[2]) for look in self._alike})
        self._arrive: dict[Spot, int | None] = {}
        self._grip: dict[tuple[int, int, Hold], int | None] = {}
        self._ways: dict[tuple[int, int, int], tuple[Way, ...]] = {}
        self.blocked_holds: set[tuple[int, Hold]] = set()
        self.blocked_paths: dict[tuple[int, int, int, Hold], int | None] = {}

    def _slot_used(self, name: str, pose: Pose) -> str | None:
        """Return the slot in which a component is at a pose; what is bolted uses none."""
        return slot_at(self.setup, pose) if name in self.setup.lab.inventory and self.setup.movable(name) else None

    def _in_slots(self) -> tuple[dict[str, int], int]:
        """Return the spots that are in each slot, and those where movers may be in the end."""
        users, ends = dict[str, int](), 0
        for i, p in self.spots:
            mover = self.movers[i]
            ends |= self._bits[i, p] if p in mover.finished else 0
            if slot := self._slot_used(mover.name, mover.places[p].pose):
                users[slot] = users.get(slot, 0) | self._bits[i, p]
        return users, ends

    def _stored(self, movers: Sequence[Mover], every_slot: bool) -> tuple[Mover, ...]:
        """Give movers the storage slots that nothing which stays keeps from being free."""
        slots = self.setup.lab.slots if any(m.stages for m in movers) else {}
        free = [name for name in sorted(slots) if not self.static.conflicts(self._mouths.shapes[name], 0.0)]
        most = MANY_SLOTS if len(movers) <= FEW else ENOUGH_SLOTS
        most = max(most, EVERY_SLOT // len(movers)) if every_slot else most
        self.more_slots = len(free) > most
        wanted = {m.goal.slot for m in movers}
        return tuple(with_storage(self.setup, m, free, wanted, most) for m in movers)

    def _group(self) -> dict[Look, int]:
        """Return the bits of the spots that look the same: one comparison of shapes is enough for all of them."""
        alike: dict[Look, int] = {}
        for i, p in self.spots:
            look = self._look(i, p)
            alike[look] = alike.get(look, 0) | self._bits[i, p]
        return alike

    def _look(self, i: int, place: int) -> Look:
        geometry = self.movers[i].geometry
        return geometry.footprint, geometry.height, self.movers[i].places[place].pose

    def bit(self, mover: int, place: int) -> int:
        """Return the bit of a spot."""
        return self._bits[mover, place]

    def at(self, mask: int) -> Iterator[Spot]:
        """Yield the spots whose bits are in `mask`."""
        while mask:
            low = mask & -mask
            yield self.spots[low.bit_length() - 1]
            mask ^= low

    @property
    def starts(self) -> int:
        """The bits of where movers stand at first."""
        return sum_of(self._bits[i, 0] for i in range(len(self.movers)))

    def by_slot(self) -> dict[str | None, int]:
        """Return the bits of the spots in each slot; None: of those in none."""
        found: dict[str | None, int] = {}
        for i, p in self.spots:
            slot = self.movers[i].places[p].slot
            found[slot] = found.get(slot, 0) | self._bits[i, p]
        return found

    def shape(self, mover: int, place: int) -> Shape:
        """Return the footprint of a mover at one of its places."""
        return self._mobile.shapes[self._look(mover, place)]

    def arrive(self, i: int, place: int) -> int | None:
        """Return the spots that exclude the body of mover `i` at `place`."""
        if (i, place) not in self._arrive:
            self._arrive[i, place] = self._body(i, place)
        return self._arrive[i, place]

    def _body(self, i: int, place: int) -> int | None:
        mover, lab = self.movers[i], self.setup.lab
        shape, slot, margin = self.shape(i, place), mover.places[place].slot, lab.margins.body
        if (overhang(lab.table, shape) > 0 and not lab.beside_table(slot)) or self.static.conflicts(shape, margin):
            return None
        if any(reaches(k, 0.0, mover.geometry.height) and conflict(shape, outline(k)) for k in lab.keep_out.values()):
            return None
        if slot is not None and self.static.conflicts(self._mouths.shapes[slot], 0.0):
            return None
        if slot is not None and not fits(lab.slots[slot], mover.geometry.footprint):
            return None
        if place in mover.staging and self.covered_in_use(i, place):
            return None
        return self.near_body(i, place)

    def _meeting(self, i: int, shape: Shape, margin: float, above: float = -1.0) -> int:
        """Return the spots of others, taller than `above`, that come too near to a shape that mover `i` needs."""
        mask = 0
        for look in self._mobile.near(shape, margin):
            others = self._alike[look] & ~self._own[i]
            if look[1] > above and others and conflict(shape, self._mobile.shapes[look], margin):
                mask |= others
        return mask

    def grip(self, i: int, place: int, hold: Hold) -> int | None:
        """Return the spots that exclude picking or placing mover `i` at `place` in this hold."""
        key = (i, place, hold)
        if key not in self._grip:
            self._grip[key] = self._fingers(i, place, hold)
        return self._grip[key]

    def _fingers(self, i: int, place: int, hold: Hold) -> int | None:
        mask, keep_out = 0, self.setup.lab.keep_out.values()
        lowest, zones = self._zones(i, place, hold)
        for zone in zones:
            if any(
                self.obstacles[o].height > lowest for o in self.static.conflicts(zone, self.setup.lab.margins.fingers)
            ):
                return None
            if any(reaches(k, lowest, float("inf")) and conflict(zone, outline(k)) for k in keep_out):
                return None
            mask |= self._meeting(i, zone, self.setup.lab.margins.fingers, above=lowest)
        return None if self.unreachable(i, place, hold) else mask

    def _zones(self, i: int, place: int, hold: Hold) -> tuple[float, tuple[Shape, ...]]:
        """Return how low the fingers come around a mover at a place, and where they need room."""
        mover = self.movers[i]
        grasp = mover.geometry.grasp
        if hold.robot is None or grasp is None:
            return 0.0, ()
        gripper = self.setup.lab.robots[hold.robot].gripper
        return finger_height(grasp, gripper), finger_zones(grasp, gripper, hold.yaw, mover.places[place].pose)

    def finger_hits(self, i: int, place: int, hold: Hold) -> Iterator[tuple[str, float]]:
        """Yield the things that stay which the fingers come too near to, and how near [mm], negative where they
        overlap."""
        lowest, zones = self._zones(i, place, hold)
        for zone in zones:
            for name in self.static.conflicts(zone, self.setup.lab.margins.fingers):
                if self.obstacles[name].height > lowest:
                    yield name, separation(zone, self.obstacles[name].shape)

    def fingers_kept_out(self, i: int, place: int, hold: Hold) -> bool:
        """Whether the fingers would reach into a keep-out."""
        lowest, zones = self._zones(i, place, hold)
        keep_out = self.setup.lab.keep_out.values()
        return any(reaches(k, lowest, float("inf")) and conflict(z, outline(k)) for z in zones for k in keep_out)

    def near_body(self, i: int, place: int) -> int:
        """Return the spots of others that are where a mover, or the mouth of its slot, would be, and those in a slot
        whose mouth it would cover; but where both may be in the end, nobody forbids it."""
        mover = self.movers[i]
        slot, mask = mover.places[place].slot, self._meeting(i, self.shape(i, place), self.setup.lab.margins.body)
        users = sum_of(self._users.get(s, 0) for s in self._covered(i, place)) & ~self._own[i]
        mask |= users & ~self._ends_in if place in mover.finished else users
        return mask | self._meeting(i, self._mouths.shapes[slot], 0.0) if slot else mask

    def covered_in_use(self, i: int, place: int) -> set[str]:
        """Return the slots in which something stays whose mouths a mover would cover."""
        return self._in_use.intersection(self._covered(i, place))

    def _covered(self, i: int, place: int) -> Iterator[str]:
        """Yield the slots whose mouths a mover covers at a place that is not in them."""
        slot = self.movers[i].places[place].slot
        return (s for s in self._mouths.conflicts(self.shape(i, place), 0.0) if s != slot)

    def near_fingers(self, i: int, place: int, hold: Hold) -> int:
        """Return the spots of others that are where the fingers need room."""
        lowest, zones = self._zones(i, place, hold)
        return sum_of(self._meeting(i, zone, self.setup.lab.margins.fingers, above=lowest) for zone in zones)

    def hindrances(self, i: int) -> int:
        """Return the spots that exclude the direct move of mover `i` in one hold or another."""
        mover = self.movers[i]
        masks = [self.arrive(i, g) for g in mover.goals]
        masks += [self.grip(i, p, h) for p in (0, *mover.goals) for h in mover.holds]
        masks += [self.blocked_paths.get((i, 0, g, h)) for g in mover.goals for h in mover.holds]
        return sum_of(m for m in masks if m)

    def unreachable(self, i: int, place: int, hold: Hold) -> Blocked | None:
        """Return why the robot of a hold can't pick or place mover `i` at `place`, or its cable keeps it from there."""
        name, pose = self.movers[i].name, self.movers[i].places[place].pose
        if place and (short := check_tether(self.setup, name, pose)):
            return short
        return self.motion.reach(hold.robot, name, pose, hold.yaw) if self.motion and hold.robot else None

    def ways(self, i: int, start: int, goal: int) -> tuple[Way, ...]:
        """Return how mover `i` can go from one place to another, the preferred way first; none where what stays
        excludes all of them. A way that needs everything that an earlier one needs is left out."""
        key = (i, start, goal)
        if key not in self._ways:
            self._ways[key] = tuple(self._find_ways(i, start, goal))
        return self._ways[key]

    def _find_ways(self, i: int, start: int, goal: int) -> Iterator[Way]:
        masks: list[int] = []
        for hold in self.movers[i].holds if self.arrive(i, goal) is not None else ():
            mask = self.held(i, start, goal, hold)
            if mask is not None and not any(m | mask == mask for m in masks):
                masks.append(mask)
                yield Way(hold, mask)

    def held(self, i: int, start: int, goal: int, hold: Hold) -> int | None:
        """Return the spots that exclude a move of mover `i` in one hold; None where what stays excludes it."""
        path = self.blocked_paths.get((i, start, goal, hold), 0)
        parts = (self.arrive(i, goal), self.grip(i, start, hold), self.grip(i, goal, hold), path)
        return None if any(p is None for p in parts) else sum_of(p for p in parts if p)

    def way(self, i: int, start: int, goal: int, taken: int) -> Way | None:
        """Return the first way to make a move while the spots of `taken` are taken."""
        return next((w for w in self.ways(i, start, goal) if not w.mask & taken), None)

    def forbid(self, i: int, start: int, goal: int, hold: Hold, spot: Spot | None) -> None:
        """Exclude a hold for a move: while `spot` is taken, or for good (None), because its path is blocked."""
        key = (i, start, goal, hold)
        known = self.blocked_paths.get(key, 0)
        self.blocked_paths[key] = None if spot is None or known is None else known | self._bits[spot]
        self._ways.pop((i, start, goal), None)

    def forbid_hold(self, i: int, hold: Hold) -> None:
        """Exclude a hold wherever a mover stands: the mover itself is in the way of it."""
        self._grip |= {(i, p, hold): None for p in range(len(self.movers[i].places))}
        self._ways = {key: ways for key, ways in self._ways.items() if key[0] != i}
        self.blocked_holds.add((i, hold))


def sum_of(masks: Iterable[int]) -> int:
    """Return the union of masks."""
    union = 0
    for mask in masks:
        union |= mask
    return union

"""What a hand still holds, after a run was stopped or killed, is set down before anything else: where it was picked, or
in a free storage slot."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pico.diagnostics import Diagnostic, warning
from pico.geometry import Grid, fits, placed
from pico.model.observation import Observation, ObservedRobot, astray
from pico.model.operation import Operation, Reason, new_id
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.motion.types import Blocked, Motion, MovePath, StandingObject
from pico.planning.parts.movers import Obstacle, Place, standing_obstacles, turned

SET_DOWN_SECONDS = 6.0
"""What setting a part down takes where no motion is asked for [s]."""
PARK_SECONDS = 3.0
"""What a park takes where no motion is asked for [s]."""
TRIES = 12
"""How many places are tried for a part that is held."""


@dataclass(frozen=True, slots=True)
class EmptiedHands:
    """The bench as it will be once every hand is empty: what leads there, and what can't be set down."""

    seen: Observation
    operations: tuple[Operation, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def set_downs(setup: Setup, seen: Observation, motion: Motion | None) -> EmptiedHands:
    """Return the operations that empty the hands, one after the other, and the bench as it then is.

    A part for which there is no place stays in the hand, with a warning that says why; one that another hand was in the
    way of is tried again once that is empty.
    """
    settled, told = EmptiedHands(seen), dict[str, Diagnostic]()
    full = [r for r, hand in sorted(seen.robots.items()) if hand.holding is not None and r in setup.lab.robots]
    while True:
        for robot in full:
            found = _emptied(setup, settled, robot, seen.robots[robot], motion)
            if isinstance(found, EmptiedHands):
                settled = found
                full.remove(robot)
                break
            told[robot] = found
        else:
            return replace(settled, diagnostics=tuple(told[robot] for robot in full))


def _emptied(
    setup: Setup, settled: EmptiedHands, robot: str, hand: ObservedRobot, motion: Motion | None
) -> EmptiedHands | Diagnostic:
    seen, name = settled.seen, hand.holding or ""
    part = seen.components.get(name)
    if part is None or part.pose is None or name not in setup.lab.inventory:
        return _stuck(robot, name, "nobody knows how it is held")
    obstacles = standing_obstacles(setup, seen, {})
    places = _places(setup, name, hand, obstacles)
    far = {p: b for p in places if motion and (b := motion.reach(robot, name, p.pose, 0.0))}
    near = [place for place in places if place not in far]
    why = far[places[-1]].text if far and not near else "no storage slot is free"
    for place in near[:TRIES]:
        path = _path(setup, seen, robot, name, place, obstacles, motion)
        if isinstance(path, Blocked):
            why = path.text
            continue
        after = tuple(op.id for op in settled.operations)
        operation = _operation(name, robot, as_json(part.pose), place, path, after)
        joints = path.end if path else hand.joints
        components = {**seen.components, name: replace(part, presence="seen", pose=place.pose)}
        robots = {**seen.robots, robot: replace(hand, joints=joints, holding=None)}
        now = replace(seen, components=components, robots=robots)
        return replace(settled, seen=now, operations=(*settled.operations, operation))
    return _stuck(robot, name, why)


def _operation(
    name: str, robot: str, held: Any, place: Place, path: MovePath | None, after: tuple[str, ...]
) -> Operation:
    to = {"pose": as_json(place.pose)} | ({"slot": place.slot} if place.slot else {})
    return Operation(
        id=new_id(), primitive="stow" if place.slot else "move", component=name, robot=robot, resources=(robot, name),
        arguments={"from": {"pose": held, "held": True}, "to": to}, after=after,
        reason=Reason(kind="held", text=f"{robot} still holds it"),
        seconds=path.seconds if path else SET_DOWN_SECONDS,
    )  # fmt: skip


def _places(setup: Setup, name: str, hand: ObservedRobot, obstacles: Sequence[Obstacle]) -> list[Place]:
    """Where a part may be set down: where it was picked, its home, then the slots nearest to where it was picked."""
    grid = Grid.of({o.name: o.shape for o in obstacles})
    geometry, margin = setup.type_of(name).geometry, setup.lab.margins.body
    free = (
        place for place in _wished(setup, name, hand)
        if not grid.conflicts(placed(geometry.footprint, place.pose), margin)
    )  # fmt: skip
    return list(dict.fromkeys(free))


def _wished(setup: Setup, name: str, hand: ObservedRobot) -> Iterator[Place]:
    footprint, home = setup.type_of(name).geometry.footprint, setup.lab.inventory[name].home
    if hand.picked is not None:
        yield Place(hand.picked, None)  # exactly there: in a slot as well
    if home is not None:
        yield from turned(setup, home, footprint)
    near = hand.picked or (setup.lab.slots[home].pose if home else None)
    slots = [s for s, slot in setup.lab.slots.items() if fits(slot, footprint)]
    for slot in sorted(slots, key=lambda s: (setup.lab.slots[s].pose.distance(near) if near else 0.0, s)):
        yield from turned(setup, slot, footprint)


def _path(
    setup: Setup, seen: Observation, robot: str, name: str, place: Place, obstacles: Sequence[Obstacle],
    motion: Motion | None,
) -> MovePath | Blocked | None:  # fmt: skip
    if motion is None:
        return None
    standing: dict[str, StandingObject] = {o.name: o.standing for o in obstacles}
    others = {n: r.joints for n, r in seen.robots.items() if n != robot}
    held, joints = seen.components[name].pose, seen.robots[robot].joints
    assert held is not None  # `_emptied` looked
    return motion.set_down(robot, name, held, place.pose, standing, joints, others)


def _stuck(robot: str, name: str, why: str) -> Diagnostic:
    return warning(
        "held", f"{robot} holds {name} and can't set it down: {why}",
        hint=f"take {name} out of the gripper by hand, then plan again", address=name,
    )  # fmt: skip


def parked_first(
    setup: Setup, seen: Observation, rest: Sequence[Operation], motion: Motion | None
) -> tuple[Operation, ...]:  # fmt: skip
    """Return the operations after a park of each arm that was stopped on its way with an empty hand, and that none of
    them uses. An arm that has no way to its park pose, not even once others are parked, is left where it stands."""
    used, parks = {o.robot for o in rest}, list[Operation]()
    left = [name for name in astray(setup, seen) if name not in used]
    while True:
        for name in left:
            found = _park_path(setup, seen, name, motion)
            if not isinstance(found, Blocked):
                parks.append(park_operation(setup, seen, name, [p.id for p in parks[-1:]], motion))
                joints = found.end if found else ()
                seen = replace(seen, robots={**seen.robots, name: replace(seen.robots[name], joints=joints)})
                left.remove(name)
                break
        else:
            break
    last = tuple(p.id for p in parks[-1:])
    return (*parks, *(replace(o, after=(*last, *o.after)) if o.robot else o for o in rest))


def _park_path(setup: Setup, seen: Observation, robot: str, motion: Motion | None) -> MovePath | Blocked | None:
    others = {n: r.joints for n, r in seen.robots.items() if n != robot}
    standing: dict[str, StandingObject] = {o.name: o.standing for o in standing_obstacles(setup, seen, {})}
    return motion.park(robot, seen.robots[robot].joints, standing, others) if motion else None


def park_operation(
    setup: Setup, seen: Observation, robot: str, after: Sequence[str], motion: Motion | None
) -> Operation:
    """Return the operation that parks an arm, after those with some ids."""
    path = _park_path(setup, seen, robot, motion)
    return Operation(
        id=new_id(), primitive="park", component=robot, robot=robot, resources=(robot,), after=tuple(after),
        reason=Reason(kind="parked", text="out of the beam"),
        seconds=path.seconds if isinstance(path, MovePath) else PARK_SECONDS,
    )  # fmt: skip

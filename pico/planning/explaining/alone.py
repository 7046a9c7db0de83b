"""Why a part can't get home even by itself: who can't hold, reach or place it, or has no free path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from pico.diagnostics import Diagnostic, error
from pico.geometry import capture_disc, separation
from pico.model.pose import Pose
from pico.motion.types import Blocked
from pico.planning.checks.loads import overload
from pico.planning.checks.target import Source, located
from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.paths import NoPath
from pico.planning.ordering.solve import Refusal
from pico.planning.parts.movers import Hold
from pico.planning.parts.phrases import listed


def alone_refused(refused: Refusal, i: int, source: Source) -> Diagnostic:
    """A mover that can't get home even with all other movers off the table."""
    table = refused.table
    mover = table.movers[i]
    own = [b for b in refused.blocked if b.step.mover == i]
    if own:
        direct = [b for b in own if b.step.start == 0 and b.step.goal in mover.goals]
        return no_path(table, (direct or own)[0], source)
    if not mover.holds:
        return _no_hand(table, mover.name, source)
    for verb, places in (("picked up", (0,)), ("put down", mover.goals)):
        if all(table.grip(i, p, h) is None for p in places for h in mover.holds):
            return _no_grip(table, i, verb, places, source)
    address, blame = f"{mover.name}.pose", located(source, mover)
    if mouth := _mouth_taken(table, i):
        return replace(mouth, address=address, source=blame)
    gets, reached = f"{mover.name} can't go from {mover.start} to {mover.goal}", _arms_at_ends(table, i)
    if all(reached) and not reached[0] & reached[1]:
        first, then = (listed(sorted(arms), "or") for arms in reached)
        return error(
            "unreachable", f"{gets}: only {first} reaches where it stands, and only {then} where it is to go",
            detail=f"{mover.name}: {'no slot where one hands it to the other' if mover.stages else 'stage: never'}",
            hint=f"give {first} and {then} a free slot that both reach, or a region with `staging: true`"
            + ("" if mover.stages else f", and allow staging of {mover.name}"), address=address, source=blame,
        )  # fmt: skip
    storage = "stage: never" if not mover.stages else "no storage slot where it could be put down in between"
    turn = "free a storage slot" if mover.stages else f"allow staging of {mover.name}, with a storage slot free"
    return error(
        "blocked", f"{gets}: no one grasp is free at both ends",
        detail=f"{mover.name}: {storage}", hint=f"{turn}, or leave more room on one side of it",
        address=address, source=blame,
    )  # fmt: skip


def _mouth_taken(table: Conflicts, i: int) -> Diagnostic | None:
    """Return that something which stays stands in the mouth of the slot where a mover is to go, if it does."""
    slot = table.movers[i].goal.slot
    if slot is None:
        return None
    mouth = capture_disc(table.setup.lab.slots[slot])
    others, name = sorted(table.static.conflicts(mouth, 0.0)), table.movers[i].name
    if not others:
        return None
    most = min(separation(mouth, table.static.shapes[n]) for n in others) + mouth.radius
    stand = "stands" if len(others) == 1 else "stand"
    less = f"give {slot} a `capture` of less than {most:.3g} mm, or " if most > 0 else ""
    return error(
        "blocked", f"{name} can't be put down in {slot}: {listed(others)} {stand} in its mouth",
        detail=f"what is within {table.setup.lab.slots[slot].capture:g} mm of its center counts as in it",
        hint=f"{less}move {listed(others)} away first",
    )  # fmt: skip


def _arms_at_ends(table: Conflicts, i: int) -> tuple[set[str], set[str]]:
    """Return the arms that reach a mover where it stands, and where it is to go."""
    mover = table.movers[i]
    start, goal = (
        {h.robot for h in mover.holds if h.robot and any(not table.unreachable(i, p, h) for p in places)}
        for places in ((0,), mover.goals)
    )
    return start, goal


def _no_hand(table: Conflicts, name: str, source: Source) -> Diagnostic:
    if heavy := overload(table.setup, name, source):
        return heavy
    if table.setup.lab.robots:
        return error("blocked", f"{name} can't be moved: no robot has its gripper free", address=name)
    hint = f"move it by hand, then `pico capture {name}`; or add an arm under `robots:` in lab.yaml"
    return error("no-arm", f"{name} can't be moved: the lab has no arm", hint=hint, address=name)


def _no_grip(table: Conflicts, i: int, verb: str, places: Sequence[int], source: Source) -> Diagnostic:
    mover = table.movers[i]
    place = mover.places[places[0]]
    where = f"{mover.name} can't be {verb} at {place}"
    stands = verb == "picked up"
    standing = source(f"slots.{place.slot}") if place.slot else None  # where it stands now is in no state
    address, blame = f"{mover.name}.pose", standing if stands else located(source, mover)
    hits = [(h, hit) for p in places for h in mover.holds for hit in table.finger_hits(i, p, h)]
    holds = sorted(mover.holds, key=lambda h: _away(table, h, place.pose))  # the nearest arm is told of
    reach = [b for p in places for h in holds if (b := table.unreachable(i, p, h))]
    reach.sort(key=lambda b: b.obstacle is None)
    free = [h for h in mover.holds if not any(hold == h for hold, _ in hits)]
    if reach and (free or not hits):
        by_hand = "by hand: " if stands and reach[0].kind == "reach" else ""
        return error(
            "unreachable", f"{where}: {reach[0].text}",
            hint=by_hand + (reach[0].help or "bring it nearer to the arm, or turn it"),
            address=address, source=blame,
        )  # fmt: skip
    if not hits:
        return error("blocked", f"{where}: a keep-out leaves no room for the fingers", address=address, source=blame)
    names = sorted({name for _, (name, _) in hits})
    deepest = min(gap for _, (_, gap) in hits)
    touch = f"by {-deepest:.3g} mm" if deepest < 0 else f"(only {deepest:.3g} mm apart)"
    return error(
        "blocked", f"{where}: a finger of the gripper would touch {listed(names)} {touch}, every grasp yaw tried",
        hint=f"move {listed(names, 'or')} away first, or leave more room there", address=address, source=blame,
    )  # fmt: skip


def _away(table: Conflicts, hold: Hold, pose: Pose) -> float:
    """Return how far a place is from the base of the arm of a hold [mm]."""
    mount = table.setup.lab.robots[hold.robot].mount if hold.robot else None
    return math.hypot(pose.x - mount.x, pose.y - mount.y) if mount else 0.0


def _struck(blocked: Blocked) -> str:
    """What is in the way and by how much; a depth alone says nothing."""
    if not blocked.obstacle:
        return ""
    return f"in the way: {blocked.obstacle}" + (f" by {blocked.by:.3g} mm" if blocked.by is not None else "")


def no_path(table: Conflicts, no: NoPath, source: Source) -> Diagnostic:
    mover, blocked = table.movers[no.step.mover], no.blocked
    goal = mover.places[no.step.goal]
    primitive = "stow" if goal.slot else "move"
    during = f" during {blocked.segment}" if blocked.segment else ""
    code = "unreachable" if blocked.kind == "reach" else "blocked"
    hint = f"move {blocked.obstacle} away first" if blocked.obstacle in table.obstacles else "choose another place"
    if blocked.segment == "park":
        return error(
            code, f"after it brings {mover.name} to {goal} {no.step.hold.robot} can't park: {blocked.text}",
            detail=_struck(blocked),
            hint=blocked.help or hint, address=f"{mover.name}.pose", source=located(source, mover),
        )  # fmt: skip
    return error(
        code, f"{primitive} of {mover.name} to {goal} has no free path{during}: {blocked.text}",
        detail=_struck(blocked),
        hint=blocked.help or hint, address=f"{mover.name}.pose", source=located(source, mover),
    )  # fmt: skip

"""The shortest repair of what is suspected, in words: a command where one helps, else what a hand does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pico.diagnosis.darkness import NO_LIGHT, STOPS
from pico.diagnosis.doubt import POSSIBLE
from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.diagnosis.grouping import Suspect

_STEERS = ("stage_y", "stage_z", "tip", "tilt")


def repair(setup: Setup, suspect: Suspect | None, values: Mapping[str, Mapping[str, Any]]) -> str:
    """Return what brings a suspect back, or where to look if no known cause explains what changed; `values`: of what
    stands, by component."""
    if suspect is None:
        return f"{_seen(setup)} what has left the last commit"
    part, kind = suspect.part, suspect.kind
    if kind.startswith("zero of "):
        tunable = kind.removeprefix("zero of ")
        axis = setup.type_of(part).tunables[tunable].axis
        if axis is not None and axis.kind == "homed":
            return f"`pico do {part} home {tunable}`; where that does not help its mount slipped: turn it back by hand"
        return f"turn {part} back in its mount"
    hands = {
        POSSIBLE: f"check {', '.join([part, *suspect.like])} in this order; run `pico morning` again after each",
        NO_LIGHT: f"look at {part}: its key, its supply, its shutter",
        STOPS: f"look for what stands in the beam up to {[part, *suspect.like][-1]}; `pico beam` shows its way",
        "power": f"look at the supply of {part}, and let it warm up",
        "focal length": f"check which lens stands in the mount of {part}",
        "retardance": f"check which wave plate stands in the mount of {part}",
        "polarization": f"turn {part} back about its beam",
        "turned about the beam": f"turn {part} back in its mount",
        "dirt": _cleaned(part, suspect.like),
        "extinction": f"clean {part}; where that does not help it is worn: put in another",
        "gain": f"check the gain of {part}, and the filter before it",
        "dark level": f"close {part} to light of the room, and let it cool; `pico measure {part}.dark` shows a frame",
        "moved along": f"put {part} back where its beam is collimated: {_seen(setup)} where it stands",
    }
    if kind in hands:
        return hands[kind]
    if kind == "moved across" and setup.type_of(part).optics.element == "detector":
        return f"fasten {part} and put it back; where it may stay, `pico morning --accept`"
    return _by_light(setup, part, values) or f"put {part} back by hand"


def _seen(setup: Setup) -> str:
    """Return the commands of a bench that show where its parts stand."""
    return "`pico look` and `pico drift` show" if setup.lab.cameras else "`pico drift` shows"


def _cleaned(part: str, like: Sequence[str]) -> str:
    if not like:
        return f"clean {part}"
    return f"clean {part}; where `pico morning` still says so, {' then '.join(like)}"


def unread(address: str) -> str:
    """Return what to do where all that was read is as usual, but one measurement could not be taken."""
    return f"`pico measure {address}` reads it again, and says what is wrong"


def _by_light(setup: Setup, part: str, values: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the command that takes out by motors what a part does to the beam; empty where none can."""
    goals = setup.lab.goals or {}
    steering = [n for n in values if any(t in setup.type_of(n).tunables for t in _STEERS)]
    for name, goal in goals.items():
        wanted = goal.reach or goal.maximize or goal.minimize
        if wanted and any(address.partition(".")[0] in (part, *steering) for address in goal.tunables):
            return f"`pico optimize {name}`"
    mover = part if part in steering else next(iter(sorted(steering)), "")
    cameras = [n for n in sorted(values) if "centroid" in setup.measurables_of(n)]
    return f"`pico optimize center {mover} {cameras[0]}`" if mover and cameras else ""

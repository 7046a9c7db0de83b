"""Why no light reaches a detector, as far as the bench says it: what is shut or off on its way, what passes next to
nothing, what stands in the way, and what is missing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from pico.model.diff import show_value
from pico.model.goal import Goal
from pico.model.observation import Observation, slot_at
from pico.model.pose import Pose, short
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.model.vocabulary import measured_in
from pico.optics.axis import Axis, Values, beams
from pico.optics.ends import closures
from pico.planning.goal_light import standing_poses

PASSES = 1e-3
"""The share of a beam below which a part is said to pass next to nothing of it."""
_ANALYZES = ("polarizer", "wollaston", "prism", "grating")
"""Elements that pass little of a beam, or send it elsewhere, by its polarization or wavelength, as they are to."""
_MOST = 3
"""So many ends of beams are named at most."""


def detects(setup: Setup, component: str) -> bool:
    """Return whether a component of the inventory reads light."""
    return component in setup.lab.inventory and setup.type_of(component).optics.element == "detector"


def darkness(setup: Setup, seen: Observation, wanted: LabState | None, detector: str) -> tuple[str, ...]:
    """Return what keeps light from a detector, in words: `laser.shutter is closed`, `m1 is in storage/b1`.

    If beams come to the detector by how parts stand, that is what shuts all of them, or passes less than `PASSES` of
    them. Else it is the first that holds of these: a mirror that is flipped the wrong way; parts of the ways in the
    state `wanted` that do not stand on the table; where the beams end instead. Empty if the bench says none of this.
    """
    known, poses = seen.known_values, standing_poses(seen)
    if ways := list(_ways(setup, poses, known, detector)):
        found = [tuple(_shut(setup, known, way)) for way in ways]
        if not all(found):
            passing = dict(_faint(setup, poses, known, ways))
            found = [one or passing.get(way, ()) for one, way in zip(found, ways, strict=True)]
        return tuple(dict.fromkeys(why for one in found for why in one)) if all(found) else ()
    if flipped := tuple(_flipped(setup, poses, known, detector)):
        return flipped
    if wanted is None:
        return ()
    meant = {name: place_of(setup, wanted, name) for name in setup.lab.inventory}
    placed = {name: pose for name, (slot, pose) in meant.items() if slot is None}
    along = [name for way in _ways(setup, placed, known, detector) for name in way]
    missing = tuple(why for name in dict.fromkeys((*along, detector)) if (why := gone(setup, seen, name)))
    return missing or tuple(_ends(setup, poses, known))


def unlit(setup: Setup, seen: Observation, goal: Goal) -> str:
    """Return that no light reaches any detector that a goal reads, with what shuts it: `no light reaches cam:
    laser.shutter is closed`; empty if light may come, also where the goal itself opens something to look."""
    opened = {address.partition(".")[2] for look in (goal.looks or {}).values() for address in look}
    looks = goal.looks or ("",)
    named = dict.fromkeys(c for look in looks for c, _ in measured_in(setup, goal.seen_in(look)) if detects(setup, c))
    if not named or opened & {"shutter", "emission"}:
        return ""
    known, poses = seen.known_values, standing_poses(seen)
    found = [[tuple(_shut(setup, known, way)) for way in _ways(setup, poses, known, name)] for name in named]
    if not all(ways and all(ways) for ways in found):
        return ""
    reasons = dict.fromkeys(why for ways in found for way in ways for why in way)
    return f"no light reaches {' or '.join(named)}: {', '.join(reasons)}"


def gone(setup: Setup, seen: Observation, name: str) -> str:
    """Return why a part does not stand on the table: `lens is in storage/a1`; empty if it does."""
    part = seen.components.get(name)
    if part is None or part.presence != "seen" or part.pose is None:
        return f"{name} is {part.presence if part else 'missing'}"
    slot = slot_at(setup, part.pose) if setup.movable(name) else None
    return f"{name} is in {slot}" if slot else ""


def _ways(setup: Setup, poses: Mapping[str, Pose], values: Values, detector: str) -> Iterator[tuple[str, ...]]:
    """Yield the parts on each way from a source to a detector, whatever is shut."""
    for axis in beams(setup, poses, values):
        for way in axis.ways(detector):
            yield (axis.source, *(met.component for met in way))


def _shut(setup: Setup, known: Values, way: Sequence[str]) -> Iterator[str]:
    """Yield what lets no light out along a way."""
    for name in way:
        element = setup.type_of(name).optics.element
        for tunable, value in closures(known.get(name, {})) if element in ("source", "shutter") else ():
            yield f"{name} is switched off" if tunable == "emission" else f"{name}.{tunable} is {show_value(value)}"


def _faint(
    setup: Setup, poses: Mapping[str, Pose], known: Values, ways: Sequence[tuple[str, ...]]
) -> Iterator[tuple[tuple[str, ...], tuple[str, ...]]]:
    """Yield each way with what passes next to nothing along it."""
    from pico.optics.light import light_of

    light = light_of(setup, poses, known, lit=lambda _: True)
    behind: dict[tuple[str, str, int | None], int] = {}
    for number, crossing in enumerate(light.crossings):
        behind.setdefault((crossing.beam.source, crossing.component, crossing.before), number)
    for way in ways:
        reasons = list[str]()
        before: int | None = None
        for name in way[1:]:
            before = behind.get((way[0], name, before))
            if before is None:
                break
            here = light.crossings[before]
            share = here.onward / here.power if here.power > 0 else 1.0
            kind = setup.type_of(name)
            if name != way[-1] and share < PASSES and kind.optics.element not in _ANALYZES:
                own = known.get(name, {})
                stands = [
                    f"{name}.{t} is {show_value(v)} {kind.tunables[t].unit}".rstrip()
                    for t, v in sorted(own.items()) if t in kind.tunables and t in ("opening", "position", "pinhole")
                ]  # fmt: skip
                light_is = f"the beam of {way[0]} at {short(here.beam.wavelength * 1e6)} nm"
                text = f"{name} passes only {100 * share:.2g} % of {light_is}"
                reasons.append(f"{text} ({', '.join(stands)})" if stands else text)
        yield way, tuple(reasons)


def _flipped(setup: Setup, poses: Mapping[str, Pose], known: Values, detector: str) -> Iterator[str]:
    """Yield the flip mirrors of which one alone, flipped the other way, would bring light to a detector."""
    for name in sorted(poses):
        if "flipped" in setup.type_of(name).tunables:
            now = known.get(name, {}).get("flipped")
            turned = {**known, name: {**known.get(name, {}), "flipped": "up" if now == "down" else "down"}}
            if next(_ways(setup, poses, turned, detector), None) is not None:
                yield f"{name}.flipped is {now}" if now else f"{name}.flipped is unknown, and may be up"


def _ends(setup: Setup, poses: Mapping[str, Pose], known: Values) -> Iterator[str]:
    """Yield where the beams of all sources that may shine end; what shuts them, if none may."""
    found = list(beams(setup, poses, known))
    shining = [axis for axis in found if not any(_shut(setup, known, (axis.source,)))]
    for axis in found if not shining else ():
        yield from _shut(setup, known, (axis.source,))
    ends = dict.fromkeys(text for axis in shining for text in _ends_of(axis))
    yield from list(ends)[:_MOST]


def _ends_of(axis: Axis) -> Iterator[str]:
    for leg in axis.legs:
        last = leg.met[-1]
        if last.event in ("reflected", "divided"):
            continue
        before, bent = leg.before, list[str]()
        while before is not None:
            bent.insert(0, axis.legs[before].met[-1].component)
            before = axis.legs[before].before
        where = "leaves the table" if last.event == "left" else f"ends on {last.component}"
        yield f"the beam of {axis.source} {where}{', turned by ' if bent else ''}{' and '.join(bent)}"

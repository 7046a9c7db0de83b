"""Where branches end: what is above the class 1 limit must end on a part that is declared to end beams.

Up to class 3R the housings of irises, detectors and couplers and the mounts of optics end beams, too: what they scatter
is harmless.

Branches that end within a pupil of each other (7 mm, the aperture that IEC 60825-1 measures through) may be looked into
at once: those of the way that light is meant to take may interfere, and their fields add up; what goes astray adds its
power.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from pico.optics.audit.branches import Branches, spot
from pico.optics.audit.findings import Finding
from pico.optics.beam import forward
from pico.optics.following import Crossing
from pico.optics.part import Part, within

PUPIL = 7.0
"""Branches that end no further apart are looked into at once [mm]."""
FACING = math.cos(math.radians(45))
"""How square to its mouth a trap must be hit, at least."""
_SAME = 1e-9
_BLOCK = "end it in a beam block (`optics: {ends_beams: true}` in a part's type declares one)"


def open_ends(branches: Branches) -> Iterator[Finding]:
    """Yield a finding for each place where a branch ends that is no block, above the limit."""
    for members in _meeting(branches):
        number = max(members, key=lambda n: branches.light.crossings[n].power)
        crossing, power = branches.light.crossings[number], _together(branches, members)
        if power > branches.harmless * (1 + _SAME):
            yield branches.finding("end", number, ending(branches, crossing), power, hint=_hint(branches, crossing))
    for number, crossing in enumerate(branches.light.crossings):
        yield from _on_the_way(branches, number, crossing)
    for _ in branches.light.endless:
        number = len(branches.light.crossings) - 1
        text = "goes round and round, and is not followed to its end"
        yield branches.finding("endless", number, text, branches.light.crossings[number].power)


def ending(branches: Branches, crossing: Crossing) -> str:
    """Return in words why a beam that ends at a crossing ends badly; empty where it goes on, or ends on a block."""
    name, part = crossing.component, branches.part(crossing)
    if part is None:
        return f"leaves the table at {spot(crossing)}"
    if crossing.event not in ("blocked", "detected"):
        return ""
    element, declared = part.kind.optics.element, branches.setup.ends_beams(name)
    if element == "source":
        comes = f"comes back to {name}" if name == branches.laser else f"comes to the laser {name}"
        return "" if declared else comes
    if crossing.clipped >= 1.0 and element in _STOPS and _housed(branches, part):
        return ""
    if crossing.event == "detected" or crossing.clipped >= 1.0:
        return "" if declared else f"ends on {name}, which is not declared to end beams"
    return _outside(branches, crossing, part)


def _outside(branches: Branches, crossing: Crossing, part: Part) -> str:
    """Return in words where a beam ends on the outside of a part; empty where that is a block, and takes it. A block
    that gives no `opening` (nor `diameter`) takes what comes to it from any side."""
    if part.optic.center is not None or not branches.setup.ends_beams(part.name):
        housing = f"ends on the housing of {part.name} at {spot(crossing)}"
        return "" if _housed(branches, part) else housing
    opening = part.kind.number("opening", "mm") or part.kind.number("diameter", "mm")
    if opening is None:
        return ""
    axis = part.axes[0]
    facing = float(crossing.beam.along @ axis)
    if facing < FACING:
        return f"comes to {part.name} from the side at {spot(crossing)}, not into its opening"
    far = float((part.origin - crossing.beam.at) @ axis) / facing
    at_mouth = forward(crossing.beam, far)
    taken = within(at_mouth, at_mouth.frame @ (part.origin - at_mouth.at), opening / 2)
    if crossing.power * (1 - taken) <= max(branches.harmless, _ROUND_OFF * crossing.power):
        return ""
    return f"ends beside the opening of {part.name} at {spot(crossing)}"


_ROUND_OFF = 1e-6
KEEPS = frozenset((
    "bandpass", "beam_splitter", "block", "detector", "expander", "filter", "grating",
    "iris", "isolator", "lens", "mirror", "none", "parabola", "plate_splitter", "polarizer", "prism", "retroreflector",
    "roof_mirror", "shutter", "slit", "source", "spatial_filter", "waveplate", "wollaston",
))  # fmt: skip
"""Elements that absorb what they neither send on nor send astray."""


_STOPS = frozenset(("iris", "slit"))
"""Elements that are made to stop light."""
_HOUSED = KEEPS - {"block", "none", "source"}
"""Elements whose housings and mounts end beams up to class 3R: not a laser, nor a block beside its opening."""


def _housed(branches: Branches, part: Part) -> bool:
    """Return whether the housing of a part ends a beam of this laser; not if the lab says that the part ends none."""
    refused = branches.setup.lab.inventory[part.name].ends_beams is False
    return branches.ordinary and not refused and part.kind.optics.element in _HOUSED


def _hint(branches: Branches, crossing: Crossing) -> str:
    part = branches.part(crossing)
    if part is not None and part.kind.optics.element == "source":
        return f"turn what sends it back, or declare that its head takes it: `ends_beams: true` for {part.name}"
    if part is not None and branches.setup.ends_beams(part.name):
        return f"move {part.name} into the beam, facing it"
    return _BLOCK


def _meeting(branches: Branches) -> Iterator[list[int]]:
    """Yield the numbers of crossings that end badly at one place."""
    groups: list[list[int]] = []
    for number, crossing in enumerate(branches.light.crossings):
        if not ending(branches, crossing):
            continue
        for group in groups:
            first = branches.light.crossings[group[0]]
            near = float(np.linalg.norm(first.beam.at - crossing.beam.at)) <= PUPIL
            if first.component == crossing.component and near:
                group.append(number)
                break
        else:
            groups.append([number])
    yield from groups


def _together(branches: Branches, members: list[int]) -> float:
    """Return the most power [mW] that branches have together."""
    mine = [branches.light.crossings[n] for n in members]
    fields = sum(math.sqrt(c.power) for c in mine if not c.beam.ghost)
    most = branches.light.crossings[0].power
    return min(most, fields**2 + sum(c.power for c in mine if c.beam.ghost))


def _on_the_way(branches: Branches, number: int, crossing: Crossing) -> Iterator[Finding]:
    """Yield what an edge stops of a beam, and what a part keeps of it without a word."""
    name, part = crossing.component, branches.part(crossing)
    if part is None or ending(branches, crossing):
        return
    stopped = crossing.power * crossing.clipped
    takes = branches.setup.ends_beams(name) or _housed(branches, part)
    if stopped > branches.harmless and crossing.clipped > _ROUND_OFF and not takes:
        text = f"is stopped in part by the edge of {name} at {spot(crossing)}"
        hint = f"a wider one, or one that is declared to end beams: `ends_beams: true` for {name}"
        yield branches.finding("edge", number, text, stopped, hint=hint)
    kept = crossing.power - stopped - crossing.onward
    unknown = part.kind.optics.element not in KEEPS and not branches.setup.ends_beams(name)
    if unknown and kept > branches.harmless and kept > _ROUND_OFF * crossing.power:
        text = f"is kept by {name}, and nobody says where it goes"
        yield branches.finding("lost", number, text, kept, hint=f"declare it: `ends_beams: true` for {name}")

"""A mirror that sends a beam back on its own way: what comes back through the iris that it came through is made as much
as can be, as a detector beside the way sees it."""

from __future__ import annotations

from pico.model.goal import Goal
from pico.planning.asked import Asked, Ready
from pico.planning.nominal_bench import STEERS
from pico.planning.openings import stopped_down

TAKES = "MIRROR [IRIS] [DETECTOR]: back through the iris that the light came through"
LEAST = 1


def make(asked: Asked) -> Ready:
    """Return the goal of a mirror; the iris on its way and the detector that sees what comes back are found where they
    are not named."""
    words = [asked.part(word) for word in asked.words]
    mirror = words[0]
    if not asked.has(mirror, *STEERS):
        raise asked.refused(f"{mirror} has no motors for tip and tilt", "`pico catalog show mirror_tip_tilt`")
    named = [w for w in words[1:] if asked.element(w) == "iris"]
    detectors = [w for w in words[1:] if asked.element(w) == "detector"]
    back = {d: way for d in detectors or asked.detectors for way in asked.ways(d) if mirror in way[:-1]}
    irises = {d: _both_ways(asked, way, mirror) for d, way in back.items()}
    if not back:
        text = f"nothing that measures light sees what {mirror} sends back"
        raise asked.refused(text, "a splitter before it, with a power meter or a photodiode on its other side")
    found = next(((d, i) for d, own in irises.items() for i in own if not named or i in named), None)
    if found is None:
        text = f"{named[0] if named else 'no iris with a motor'} is not on the way to {mirror} and back"
        raise asked.refused(text, f"an iris between the splitter and {mirror}: where light must come back to")
    detector, iris = found
    light, opening, look = asked.light_of(detector), stopped_down(asked, iris), asked.look("back")
    return Ready(asked.name, Goal(
        tunables=asked.bounds(mirror, *STEERS), maximize=f"{look}.{light}", looks={look: {f"{iris}.opening": opening}},
    ))  # fmt: skip


def _both_ways(asked: Asked, way: list[str], mirror: str) -> list[str]:
    """Return the irises with a motor that a way passes before a mirror, and behind it again, the last on the way to it
    first."""
    at = way.index(mirror)
    passed = [n for n in way[:at] if n and asked.element(n) == "iris" and asked.has(n, "opening")]
    return [n for n in reversed(passed) if n in way[at:]]

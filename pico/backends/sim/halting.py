"""What a halted arm does with the move that it is in the middle of: whichever leads to a safe end sooner."""

from __future__ import annotations

from typing import Literal

from pico.backends.sim.faults import Fault
from pico.motion.types import MovePath, SegmentName

Way = Literal["goes_on", "leaves_it", "undecided", "may_turn_back"]


def phase_at(path: MovePath, elapsed: float) -> SegmentName:
    """Return the segment in which a path is `elapsed` seconds after its start."""
    ends = 0.0
    for segment in path.segments:
        ends += segment.seconds
        if elapsed < ends - 1e-9:
            return segment.name
    return path.segments[-1].name


def way_out(path: MovePath, elapsed: float) -> Way:
    """Return what an arm that is halted may do: leave a part that it has not gripped yet, go on where it already lowers
    it or holds it since an earlier run, or turn back with it where that is sooner."""
    names = {segment.name for segment in path.segments}
    if "grip" not in names:  # a park, or a part that was in the hand already: its end is the safe one
        return "goes_on"
    phase = phase_at(path, elapsed)
    if phase in ("approach", "descend"):
        return "leaves_it"
    if phase == "grip":
        return "undecided"
    return "may_turn_back" if phase in ("lift", "transit") else "goes_on"


def strikes(fault: Fault, path: MovePath, elapsed: float) -> bool:
    """Return whether what goes wrong on the way of a part does so by now: in the middle of its transit, or later."""
    if fault.kind not in ("drop", "jam"):
        return False
    ends = 0.0
    for segment in path.segments:
        if segment.name == "transit":
            return ends + fault.at * segment.seconds <= elapsed < ends + segment.seconds + 0.5
        ends += segment.seconds
    return False


def sooner(path: MovePath, elapsed: float, back: MovePath) -> bool:
    """Return whether the way back ends before the rest of the path does."""
    return back.seconds < path.seconds - elapsed

"""What a halted arm does with the move that it is in the middle of: whichever leads to a safe end sooner. For every
backend."""

from __future__ import annotations

from typing import Literal

from pico.motion.types import MovePath, Stage

Way = Literal["goes_on", "leaves_it", "undecided", "may_turn_back"]


def way_out(path: MovePath, stage: Stage) -> Way:
    """Return what an arm that is halted may do: leave a part that it has not gripped yet, go on where it already lowers
    it or holds it since an earlier run, or turn back with it where that is sooner."""
    names = {segment.name for segment in path.segments}
    if "grip" not in names:  # a park, or a part that was in the hand already: its end is the safe one
        return "goes_on"
    if stage.segment in ("approach", "descend"):
        return "leaves_it"
    if stage.segment == "grip":
        return "undecided"
    return "may_turn_back" if stage.segment in ("lift", "transit") else "goes_on"


def sooner(path: MovePath, stage: Stage, back: MovePath) -> bool:
    """Return whether the way back ends before the rest of the path does."""
    return back.seconds < path.seconds - path.gone(stage)

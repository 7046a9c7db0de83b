"""As much light through a pinhole as can be: the pinhole of a spatial filter moves across the focus, or the lens before
a pinhole across and along."""

from __future__ import annotations

from pico.model.goal import Goal
from pico.planning.asked import Asked, Ready

TAKES = "FILTER|PINHOLE [DETECTOR]: as much light through it as can be, by its stages or its lens"
LEAST = 1
_HOLE = ("pinhole_y", "pinhole_z")
_LENS = ("stage_y", "stage_z")


def make(asked: Asked) -> Ready:
    """Return the goal of a spatial filter or a pinhole; the lens before it and the detector behind are found."""
    hole = asked.part(asked.words[0])
    light = asked.light_of(asked.words[1] if len(asked.words) > 1 else asked.meter_behind(hole))
    if asked.has(hole, *_HOLE):
        return Ready(asked.name, Goal(tunables=asked.bounds(hole, *_HOLE), maximize=light))
    lens = next((n for n in reversed(asked.way(hole)[:-1]) if n and asked.element(n) == "lens"), None)
    if lens is None or not asked.has(lens, *_LENS):
        text = f"{hole} has no stages, nor has the lens before it" if lens else f"no lens stands before {hole}"
        raise asked.refused(text, "`pico catalog show spatial_filter`, or a lens_xyz_stage before a pinhole")
    along = ("stage_x",) if asked.has(lens, "stage_x") else ()
    return Ready(asked.name, Goal(tunables=asked.bounds(lens, *_LENS, *along), maximize=light))

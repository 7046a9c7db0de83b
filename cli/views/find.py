"""Where one part is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.diagnostics import Diagnostic
from pico.model.observation import ObservedComponent, slot_at
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.setup import Setup

from .style import number

_AT_HOLE = 0.05  # mm from a hole that nobody sees
_VERB = {"seen": "stands", "toppled": "lies on its side", "held": "is in a gripper"}


def text(setup: Setup, name: str, part: ObservedComponent, problems: Sequence[Diagnostic]) -> str:
    """Return one line: pose, nearest hole, slot, how surely and since when."""
    if part.pose is None:
        return f"Nobody sees {name}."
    where = f"{name} {_VERB.get(part.presence, part.presence)} at {part.pose}, {hole(setup, part.pose)}"
    slot = slot_at(setup, part.pose) if part.presence == "seen" else None
    known = [*([f"in {slot}"] if slot else []), *_known(part)]
    return "; ".join([where, *known])


def _known(part: ObservedComponent) -> list[str]:
    when = f"{number(part.age, 0)} s ago" if part.age else "now"
    sigma = f" ± {part.uncertainty.position:.2f} mm, {part.uncertainty.yaw:.2f}°"
    if part.how in ("fixed", "gripper", ""):
        return ["the lab fixes it there"] if part.how == "fixed" else []
    if part.how == "placed":
        return [f"an arm put it there {when}, and it was not seen since{sigma}"]
    return [f"last seen {when}{sigma}" if part.how == "remembered" else f"seen {when}{sigma} by {part.how}"]


def hole(setup: Setup, pose: Pose) -> str:
    """Return where a pose is from the nearest hole: `12 mm right of hole 21,17`; holes count from 1,1, front left."""
    holes = setup.lab.table.holes
    column, row = (
        max(0, round((at - first) / holes.pitch)) for at, first in zip((pose.x, pose.y), holes.first, strict=True)
    )
    dx, dy = pose.x - holes.first[0] - column * holes.pitch, pose.y - holes.first[1] - row * holes.pitch
    words = [
        f"{number(abs(d), 1)} mm {words[d > 0]}"
        for d, words in ((dx, ("left of", "right of")), (dy, ("in front of", "behind")))
        if abs(d) > _AT_HOLE
    ]
    return f"{' and '.join(words) or 'at'} hole {column + 1},{row + 1}"


def data(setup: Setup, name: str, part: ObservedComponent, problems: Sequence[Diagnostic]) -> dict[str, Any]:
    """Return schema `pico.find/v1`: `component`, `found` (presence, pose, uncertainty, age, how), `slot`, `hole`."""
    found = {k: v for k, v in as_json(part).items() if k != "values"}
    place = part.pose
    return {
        "schema": "pico.find/v1",
        "component": name,
        "found": found,
        "slot": slot_at(setup, place) if place and part.presence == "seen" else None,
        "hole": hole(setup, place) if place else None,
        "problems": as_json(problems),
    }

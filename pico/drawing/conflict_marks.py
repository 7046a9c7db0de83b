"""What is in whose way, in red on the drawing from above: outlines where two overlap, arrows to what has to wait."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pico.drawing.canvas import Canvas, Point
from pico.drawing.names import write_name
from pico.drawing.outlines import outline
from pico.model.catalog import Footprint
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.twin.lettering import Color

_RED: Color = (205, 20, 20)
LEGEND = "red: in each other's way; an arrow leads from what must leave first to what waits for it"


@dataclass(frozen=True, slots=True)
class Mark:
    """Two components in each other's way, with a few words such as `22 mm`.

    `waits` can't go to its goal before `blocker` has left its place; where `goals`, both can't stand at their goals.
    """

    blocker: str
    waits: str
    text: str = ""
    goals: bool = False


def draw_marks(
    canvas: Canvas, setup: Setup, marks: Sequence[Mark], places: Mapping[str, Pose], ghosts: Mapping[str, Pose],
    size: float,
) -> None:  # fmt: skip
    """Draw the outlines that overlap, and over them the arrows."""
    ends = {**places, **ghosts}
    for name, pose in sorted(_standing(marks, places, ends), key=str):
        _overlapping(canvas, setup.type_of(name).geometry.footprint, pose)
    for mark in marks:
        first = ends if mark.goals else places
        if mark.blocker not in first or mark.waits not in ends:
            continue
        if mark.goals or mark.waits not in places:
            at = canvas.pixel(_between(first[mark.blocker], ends[mark.waits]))
            write_name(canvas, mark.text, (*at, *at), size, _RED, weight=600, line=True)
        else:
            _arrow(canvas, places[mark.blocker], places[mark.waits], mark.text, size)


def _standing(marks: Sequence[Mark], places: Mapping[str, Pose], ends: Mapping[str, Pose]) -> set[tuple[str, Pose]]:
    """Return each component in somebody's way with where it is so, once."""
    blockers = {(m.blocker, (ends if m.goals else places).get(m.blocker)) for m in marks}
    found = blockers | {(m.waits, ends.get(m.waits)) for m in marks}
    return {(name, pose) for name, pose in found if pose is not None}


def _overlapping(canvas: Canvas, footprint: Footprint, pose: Pose) -> None:
    corners = outline(footprint, pose)
    canvas.fill(corners, _RED, 0.12)
    canvas.line(corners, _RED, 2.2, closed=True)


def _between(a: Pose, b: Pose) -> Point:
    return (a.x + b.x) / 2, (a.y + b.y) / 2


def _arrow(canvas: Canvas, start: Pose, end: Pose, words: str, size: float) -> None:
    """An arrow that bends to its right, so that two which lead to and fro stand apart; words at its middle."""
    dx, dy = end.x - start.x, end.y - start.y
    side = (start.x + dx / 2 + 0.22 * dy, start.y + dy / 2 - 0.22 * dx)
    curve = [_bend((start.x, start.y), side, (end.x, end.y), n / 24) for n in range(25)]
    canvas.line(curve[2:22], _RED, 2.2)
    canvas.arrow(curve[21], curve[23], _RED, 2.2, 13.0)
    at = canvas.pixel(curve[12])
    write_name(canvas, words, (*at, *at), size, _RED, weight=600)


def _bend(a: Point, side: Point, b: Point, t: float) -> Point:
    """The point at `t` of a quadratic Bezier curve."""
    u, v, w = (1 - t) ** 2, 2 * t * (1 - t), t * t
    return u * a[0] + v * side[0] + w * b[0], u * a[1] + v * side[1] + w * b[1]

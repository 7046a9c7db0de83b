"""The steps of a plan on the drawing from above: where each takes its component, numbered, and what the numbers say."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.drawing.canvas import Canvas, Point
from pico.drawing.label_places import bounds
from pico.drawing.names import write_name
from pico.drawing.outlines import outline
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup
from pico.twin.lettering import Color, extent, write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MOVE: Color = (214, 96, 0)
_GHOST: Color = (255, 240, 222)
_WHITE: Color = (255, 255, 255)
_INK: Color = (34, 40, 49)
_FAINT: Color = (96, 105, 118)
_PAPER: Color = (252, 252, 253)
_RULE: Color = (214, 218, 224)


@dataclass(frozen=True, slots=True)
class DrawnStep:
    """One step: its number, what it is done to, and in words what is done.

    `start`, `goal`: of a move, where `component` is taken from and to.
    """

    number: int
    title: str
    words: str
    component: str = ""
    start: Pose | None = None
    goal: Pose | None = None


def draw_ghost(canvas: Canvas, setup: Setup, name: str, goal: Pose) -> None:
    """Draw where a component is to go: a dashed outline with a line where it faces."""
    footprint = setup.type_of(name).geometry.footprint
    corners = outline(footprint, goal)
    canvas.fill(corners, _GHOST, 0.55)
    canvas.dashes([*corners, corners[0]], MOVE, 1.5, (6, 4))
    front = footprint.disc if footprint.disc is not None else max(x for x, _ in footprint.vertices)
    canvas.line((goal.apply(0.45 * front, 0), goal.apply(front, 0)), MOVE, 1.5)


def draw_way(canvas: Canvas, setup: Setup, name: str, start: Pose, goal: Pose, size: float) -> None:
    """Draw an arrow from where a component stands to where it goes, and by how much it turns where it stays."""
    if start.distance(goal) > 1.0:
        canvas.arrow((start.x, start.y), (goal.x, goal.y), MOVE, 1.6, 10.0)
    turn = angle_between(start.yaw, goal.yaw)
    if stays(setup, name, start, goal) and abs(turn) > 0.05:
        around = bounds([canvas.pixel(p) for p in outline(setup.type_of(name).geometry.footprint, goal)])
        write_name(canvas, f"{turn:+.3g}°", around, 0.85 * size, MOVE, weight=600)


def stays(setup: Setup, name: str, start: Pose, goal: Pose) -> bool:
    """Return whether a component moves so little that its goal overlaps it."""
    return start.distance(goal) <= setup.type_of(name).geometry.footprint.radius


def draw_numbers(canvas: Canvas, setup: Setup, steps: Sequence[DrawnStep], size: float) -> None:
    """Draw the number of each move at the upper right of its goal, or beside it where another one is there already."""
    taken: list[Point] = []
    radius = 0.72 * size
    for step in steps:
        if step.goal is None:
            continue
        corners = [canvas.pixel(p) for p in outline(setup.type_of(step.component).geometry.footprint, step.goal)]
        right, up = max(u for u, _ in corners), min(v for _, v in corners)
        left, down = min(u for u, _ in corners), max(v for _, v in corners)
        spots = [(right, up), (left, up), (right, down), (left, down)]
        spot = next((s for s in spots if all(math.dist(s, t) > 2.2 * radius for t in taken)), spots[0])
        taken.append(spot)
        canvas.badge(str(step.number), spot, radius, MOVE, _WHITE)


def with_list(image: NDArray[np.uint8], steps: Sequence[DrawnStep], size: float) -> NDArray[np.uint8]:
    """Return the drawing with the list of the steps below it, numbers of moves in the color of their arrows."""
    import numpy as np

    if not steps:
        return image
    width, line = image.shape[1], round(1.55 * size)
    margin = 0.08 * width
    titles = max(extent(s.title, size, 600)[0] for s in steps)
    entry = 2.2 * size + titles + size + max(extent(s.words, size)[0] for s in steps)
    columns = max(1, min(3, int((width - 2 * margin + 1.5 * size) // (entry + 1.5 * size))))
    rows = math.ceil(len(steps) / columns)
    panel = np.full((rows * line + round(1.6 * size), width, 3), _PAPER, np.uint8)
    panel[0, round(margin) : round(width - margin)] = _RULE
    pitch = (width - 2 * margin) / columns
    for index, step in enumerate(steps):
        column, row = divmod(index, rows)
        left, foot = margin + column * pitch, (row + 1) * line + 0.2 * size
        ink = MOVE if step.goal else _FAINT
        write(panel, str(step.number), (left + 1.4 * size, foot), size, ink, align="right", weight=600)
        write(panel, step.title, (left + 2.2 * size, foot), size, _INK, weight=600)
        write(panel, step.words, (left + 3.2 * size + titles, foot), size, _FAINT)
    return np.vstack([image, panel])


def goals_of(steps: Sequence[DrawnStep]) -> Mapping[str, Pose]:
    """Return where each component ends that a step moves."""
    return {s.component: s.goal for s in steps if s.goal is not None}

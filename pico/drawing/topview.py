"""The bench from above, as a drawing: footprints and where they face, slots, beams, reach, what is to move where."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pico.drawing.beams import Place, beam_paths, flat
from pico.drawing.canvas import Canvas, Point
from pico.drawing.conflict_marks import LEGEND, Mark, draw_marks
from pico.drawing.dimensions import Dimension, draw_dimensions, legend
from pico.drawing.label_places import bounds
from pico.drawing.names import Named, write_first, write_name, write_names
from pico.drawing.outlines import circle, outline, square
from pico.drawing.steps import MOVE, DrawnStep, draw_ghost, draw_numbers, draw_way, goals_of, stays, with_list
from pico.model.catalog import Footprint
from pico.model.lab import Box2
from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.motion.kinematics import span, tool_pose
from pico.motion.types import Joints
from pico.optics.axis import Values, staged
from pico.twin.lettering import Color

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_PAPER, _TABLE, _EDGE = (252, 252, 253), (240, 242, 245), (120, 128, 138)
_HOLES, _INK, _FAINT = (212, 216, 222), (34, 40, 49), (126, 134, 146)
_REGION, _SLOT, _REACH = (226, 235, 246), (168, 176, 187), (122, 152, 190)
_BEAM, _FORBIDDEN, _PALE = (224, 36, 36), (196, 60, 60), (240, 178, 170)
_ARM = (150, 164, 184)
_COLORS: dict[str, Color] = {
    "source": (42, 74, 128),
    "lens": (58, 138, 196),
    "polarizer": (52, 136, 108),
    "waveplate": (128, 92, 182),
    "mirror": (176, 132, 44),
    "roof_mirror": (176, 132, 44),
    "retroreflector": (176, 132, 44),
    "parabola": (176, 132, 44),
    "plate_splitter": (60, 150, 160),
    "beam_splitter": (60, 150, 160),
    "detector": (188, 58, 50),
    "none": (104, 112, 124),
}
_OPTIC_WIDTH = 3.0  # pixels
_END = 9.0  # mm, of the circle where a line that nobody must miss ends
FACES_LEGEND = "tick: where a component faces"
REACH_LEGEND = f"dashed arcs: reach of the arm · {FACES_LEGEND}"
_PLATE = 36.0  # mm, half of what is drawn for a slot
_LENS = 16.0  # mm, of a camera's circle
_DATUM: Color = (60, 66, 76)
_EYE: Color = (96, 76, 140)
_GRASP_HEIGHT = 100.0  # mm, where nothing that can be grasped says otherwise


def draw(
    setup: Setup,
    poses: Mapping[str, Place],
    joints: Mapping[str, Joints],
    *,
    width: int,
    height: int | None,
    ghosts: Mapping[str, Pose],
    labels: bool,
    beams: bool,
    values: Values | None = None,
    marks: Sequence[Mark] = (),
    steps: Sequence[DrawnStep] = (),
    dimensions: Sequence[Dimension] = (),
    red: Sequence[Sequence[Point]] = (),
) -> NDArray[np.uint8]:
    """Return the drawing (height, width, 3); see `pico.drawing.picture.render`."""
    canvas = drawn(
        setup, poses, joints, width=width, height=height, ghosts=ghosts, labels=labels, beams=beams, values=values,
        marks=marks, steps=steps, dimensions=dimensions, red=red,
    )  # fmt: skip
    return with_list(canvas.finished(), steps, 0.95 * letters(width, height))


def letters(width: int, height: int | None) -> float:
    """Return the size of the letters on a drawing [pixels]."""
    return max(9.0, _unit(width, height))


def _unit(width: int, height: int | None) -> float:
    return min(width / 64, height / 48) if height else width / 64


def drawn(
    setup: Setup,
    poses: Mapping[str, Place],
    joints: Mapping[str, Joints],
    *,
    width: int,
    height: int | None,
    ghosts: Mapping[str, Pose],
    labels: bool,
    beams: bool | Sequence[tuple[Point, Point]],
    values: Values | None = None,
    marks: Sequence[Mark] = (),
    steps: Sequence[DrawnStep] = (),
    dimensions: Sequence[Dimension] = (),
    red: Sequence[Sequence[Point]] = (),
) -> Canvas:
    """Return the canvas with everything on it but the list of the steps. `beams`: those of the sources, or these lines
    [mm]; `red`: lines of points [mm] that nobody must miss, beside which other beams are pale."""
    canvas, size = new_canvas(setup, width, height), letters(width, height)
    _draw_table(canvas, setup)
    _draw_areas(canvas, setup)
    _draw_slots(canvas, setup)
    for robot in setup.lab.robots.values():
        if robot.model == "xarm7":
            _draw_reach(canvas, setup, robot)
    if isinstance(beams, bool):
        beams = [(start[:2], end[:2]) for _, start, end in beam_paths(setup, poses, values)] if beams else ()
    for start, end in beams:
        canvas.line((start, end), _PALE if red else _BEAM, 1.2)
        canvas.occupy_line(start, end)
    places = flat(poses)
    for name, pose in sorted(places.items()):
        _draw_component(canvas, setup, name, pose, (values or {}).get(name, {}))
    for line in red:
        canvas.line(line, _BEAM, 3.0)
        canvas.line(circle(line[-1], _END, 24), _BEAM, 3.0, closed=True)
    for name, robot in sorted(setup.lab.robots.items()):
        if robot.model == "xarm7":
            _draw_arm(canvas, name, robot, joints.get(name), size)
    usual = REACH_LEGEND if setup.lab.robots else FACES_LEGEND
    _draw_legend(canvas, setup, size, LEGEND if marks else legend(dimensions) if dimensions else usual)
    _draw_eyes(canvas, setup)
    moves = [step for step in steps if step.goal is not None]
    ghosts = {**ghosts, **goals_of(moves)}
    _draw_goals(canvas, setup, places, ghosts, moves, size)
    draw_numbers(canvas, setup, moves, size)
    draw_marks(canvas, setup, marks, places, ghosts, size)
    draw_dimensions(canvas, dimensions, size)
    if labels:
        gone = {n: goal for n, goal in ghosts.items() if n not in places or not stays(setup, n, places[n], goal)}
        named = [(name, pose, _INK) for name, pose in places.items()]
        named += [(name, goal, MOVE) for name, goal in gone.items()]
        things = [Named(n, outline(setup.type_of(n).geometry.footprint, pose), ink) for n, pose, ink in named]
        write_names(canvas, things, size)
    _name_places(canvas, setup, size)
    return canvas


def _draw_goals(
    canvas: Canvas, setup: Setup, places: Mapping[str, Pose], ghosts: Mapping[str, Pose], moves: Sequence[DrawnStep],
    size: float,
) -> None:  # fmt: skip
    """Draw where components go and how: along the steps, and straight where there are none."""
    ways = [(s.component, s.start, s.goal) for s in moves]
    ways += [(n, places.get(n), goal) for n, goal in sorted(ghosts.items()) if n not in goals_of(moves)]
    for name, _, goal in ways:
        if goal is not None:
            draw_ghost(canvas, setup, name, goal)
            canvas.occupy(outline(setup.type_of(name).geometry.footprint, goal))
    for name, start, goal in ways:
        if start is not None and goal is not None:
            draw_way(canvas, setup, name, start, goal, size)


def new_canvas(setup: Setup, width: int, height: int | None) -> Canvas:
    """Return the canvas on which table and mounts fit, with room for a title above and a scale below; without a
    `height` as high as these are."""
    x, y = setup.lab.table.size
    mounts = [robot.mount for robot in setup.lab.robots.values()]
    left, right = min([0.0, *(m.x - 80 for m in mounts)]), max([x, *(m.x + 80 for m in mounts)])
    low, high = min([0.0, *(m.y - 80 for m in mounts)]), max([y, *(m.y + 80 for m in mounts)])
    unit, side = _unit(width, height), 0.035 * width
    head, foot = 3.6 * unit, 4.08 * unit
    scale = (width - 2 * side) / (right - left)
    if height is None:
        height = round(head + foot + scale * (high - low))
    scale = min(scale, (height - head - foot) / (high - low))
    spare = height - head - foot - scale * (high - low)
    origin = ((width - scale * (left + right)) / 2, height - foot - spare / 2 + scale * low)
    return Canvas(width, height, scale, origin, _PAPER)


def _draw_table(canvas: Canvas, setup: Setup) -> None:
    x, y = setup.lab.table.size
    outline = ((0.0, 0.0), (x, 0.0), (x, y), (0.0, y))
    canvas.fill([(px + 6, py - 8) for px, py in outline], (222, 225, 230))  # a shadow
    canvas.fill(outline, _TABLE)
    holes = setup.lab.table.holes
    columns = range(int((x - holes.first[0]) / holes.pitch) + 1)
    rows = range(int((y - holes.first[1]) / holes.pitch) + 1)
    grid = [(holes.first[0] + i * holes.pitch, holes.first[1] + j * holes.pitch) for i in columns for j in rows]
    canvas.dots(grid, 2.6, _HOLES)
    canvas.line(outline, _EDGE, 1.2, closed=True)


def _draw_areas(canvas: Canvas, setup: Setup) -> None:
    for _, region in sorted(setup.lab.regions.items()):
        canvas.fill(_corners(region.area), _REGION, 0.55)
        canvas.dashes(_closed(region.area), (160, 184, 214), 1.0, (6, 4))
    for _, zone in sorted(setup.lab.keep_out.items()):
        canvas.fill(_corners(zone.area), (250, 226, 226), 0.7)
        canvas.dashes(_closed(zone.area), _FORBIDDEN, 1.2, (5, 4))


def _draw_slots(canvas: Canvas, setup: Setup) -> None:
    for _, slot in sorted(setup.lab.slots.items()):
        canvas.fill(square(slot.pose, _PLATE), (255, 255, 255), 0.8)
        canvas.line(square(slot.pose, _PLATE), _SLOT, 1.0, closed=True)


def _draw_eyes(canvas: Canvas, setup: Setup) -> None:
    """Markers that lie on the table, and the cameras over it with a tick to where they look."""
    for datum in setup.lab.datums.values():
        corners = square(Pose(datum.x, datum.y, datum.yaw), datum.size / 2)
        canvas.fill(corners, _DATUM)
        canvas.fill(square(Pose(datum.x, datum.y, datum.yaw), datum.size / 6), (255, 255, 255))
        canvas.occupy(corners)
    for camera in setup.lab.cameras.values():
        if camera.robot is not None:
            continue
        (x, y, _), (to_x, to_y, _) = camera.position, camera.look_at
        away = math.hypot(to_x - x, to_y - y)
        if away > 1.0:
            ux, uy = (to_x - x) / away, (to_y - y) / away
            canvas.line(((x + _LENS * ux, y + _LENS * uy), (x + 45 * ux, y + 45 * uy)), _EYE, 1.6)
        body = circle((x, y), _LENS, 24)
        canvas.dashes([*body, body[0]], _EYE, 1.6, (3, 2))  # it hangs over what stands there
        canvas.occupy(body)


def _name_places(canvas: Canvas, setup: Setup, size: float) -> None:
    """Name cameras, slots and areas where there is room for it."""
    for name, camera in sorted(setup.lab.cameras.items()):
        if camera.robot is None:
            body = circle(camera.position[:2], _LENS, 24)
            write_name(canvas, name, bounds([canvas.pixel(p) for p in body]), 0.85 * size, _EYE)
    for name, slot in sorted(setup.lab.slots.items()):
        u, v = canvas.pixel((slot.x, slot.y))
        write_first(canvas, name.rpartition("/")[2], [(u, v + 0.35 * size)], 0.95 * size, _FAINT)
    for _, slot in sorted(setup.lab.slots.items()):
        canvas.occupy(square(slot.pose, _PLATE))
    areas = [(name, region.area, (96, 124, 160)) for name, region in sorted(setup.lab.regions.items())]
    areas += [(f"keep out: {name}", zone.area, _FORBIDDEN) for name, zone in sorted(setup.lab.keep_out.items())]
    for words, area, color in areas:
        wide = canvas.room(words, 0.8 * size)[0] / 2 + 3
        (left, foot), (right, top) = canvas.pixel((area.x[0], area.y[0])), canvas.pixel((area.x[1], area.y[1]))
        tops, sides = (top - 4, foot + 1.1 * size, top + 1.1 * size, foot - 4), (right - wide, left + wide)
        write_first(canvas, words, [(u, v) for v in tops for u in sides], 0.8 * size, color)


def _draw_reach(canvas: Canvas, setup: Setup, robot: Robot) -> None:
    """Where the tool reaches at the height at which parts are held, and how far at least."""
    grasps = [k.geometry.grasp.height for k in setup.catalog.values() if k.geometry.grasp]
    for radius in span(robot, max(grasps, default=_GRASP_HEIGHT)):
        if radius < 1.0:
            continue
        for arc in on_table(setup, circle((robot.mount.x, robot.mount.y), radius, 180)):
            canvas.dashes(arc, _REACH, 1.2, (8, 5))


def _draw_component(canvas: Canvas, setup: Setup, name: str, pose: Pose, values: Mapping[str, Any]) -> None:
    """Footprint, a line where the optic stands across the beam, and a tick where the component faces."""
    kind = setup.type_of(name)
    color = _COLORS.get(kind.optics.element, _COLORS["none"])
    corners = outline(kind.geometry.footprint, pose)
    canvas.occupy(corners)
    canvas.fill(corners, _mixed(color, 0.80))
    canvas.line(corners, color, 1.3, closed=True)
    front = _front(kind.geometry.footprint)
    ox, oy, _ = kind.frames.optical
    if kind.geometry.clear_aperture and kind.optics.element not in ("source", "none"):
        ahead, left = staged(kind, values)
        ox, oy = kind.geometry.clear_aperture.center[0] + ahead, kind.geometry.clear_aperture.center[1] + left
        half = max(9.0, kind.geometry.clear_aperture.diameter / 2)
        canvas.line((pose.apply(ox, oy - half), pose.apply(ox, oy + half)), color, _OPTIC_WIDTH)
        canvas.line((pose.apply(ox, oy), pose.apply(front, oy)), color, 1.2)
    else:
        canvas.line((pose.apply(0, 0), pose.apply(front, 0)), color, 1.6)
    tick = [pose.apply(front + 4.5, 0), pose.apply(front - 3.5, 4.5), pose.apply(front - 3.5, -4.5)]
    canvas.fill(tick, color)


def _draw_arm(canvas: Canvas, name: str, robot: Robot, joints: Joints | None, size: float) -> None:
    mount = robot.mount
    x, y, _, yaw = tool_pose(robot, joints or tuple(math.radians(a) for a in robot.park))
    canvas.fill(_strip((mount.x, mount.y), (x, y), 21.0), _ARM, 0.35)
    hand = Pose(x, y, yaw)
    canvas.fill([hand.apply(a * 55, b * 24) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))], _ARM, 0.55)
    for side in (-1, 1):
        jaw = [hand.apply(side * (38 + 8 * a), 11 * b) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        canvas.fill(jaw, (88, 98, 114), 0.8)
    base = circle((mount.x, mount.y), 62.0, 48)
    canvas.occupy([hand.apply(a * 55, b * 24) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    canvas.fill(base, (214, 221, 230))
    canvas.line(base, (96, 108, 126), 1.5, closed=True)
    canvas.text(name, (mount.x, mount.y), 0.95 * size, _INK, align="center", weight=600, shift=(0, 0.35 * size))
    canvas.taken[-1] = bounds([canvas.pixel(p) for p in base])


def _draw_legend(canvas: Canvas, setup: Setup, size: float, words: str) -> None:
    """Title above, and below the scale bar, the axes and what the dashed lines are."""
    x, y = setup.lab.table.size
    canvas.text(setup.lab.title or setup.lab.name, (0, y), 1.25 * size, _INK, weight=600, shift=(0, -0.9 * size))
    canvas.text(
        f"{x:g} x {y:g} mm, beam {setup.lab.table.beam_height:g} mm high",
        (x, y), 0.85 * size, _FAINT, align="right", shift=(0, -0.9 * size),
    )  # fmt: skip
    length = next((s for s in (50.0, 100.0, 200.0, 500.0) if s * canvas.scale > 60), 1000.0)
    down = 1.4 * size / canvas.scale
    tick = 4 / canvas.scale
    for a, b in (((0, -down), (length, -down)), *(((e, -down - tick), (e, -down + tick)) for e in (0.0, length))):
        canvas.line((a, b), _INK, 1.5)
    canvas.text(f"{length:g} mm", (length, -down), 0.85 * size, _INK, shift=(8, 0.3 * size))
    canvas.text(words, (x, -down), 0.85 * size, _FAINT, align="right", shift=(0, 0.3 * size))


def _front(footprint: Footprint) -> float:
    return footprint.disc if footprint.disc is not None else max(x for x, _ in footprint.vertices)


def on_table(setup: Setup, ring: list[Point]) -> list[list[Point]]:
    """The stretches of a closed line that lie on the table."""
    x, y = setup.lab.table.size
    inside = [0 <= px <= x and 0 <= py <= y for px, py in ring]
    if all(inside):
        return [[*ring, ring[0]]]
    first = inside.index(False)
    arcs: list[list[Point]] = [[]]
    for i in range(first, first + len(ring)):
        if inside[i % len(ring)]:
            arcs[-1].append(ring[i % len(ring)])
        elif arcs[-1]:
            arcs.append([])
    return [arc for arc in arcs if len(arc) > 1]


def _strip(start: Point, end: Point, half: float) -> list[Point]:
    length = math.hypot(end[0] - start[0], end[1] - start[1]) or 1.0
    nx, ny = -(end[1] - start[1]) / length * half, (end[0] - start[0]) / length * half
    return [(p[0] + s * nx, p[1] + s * ny) for p, s in ((start, 1), (end, 1), (end, -1), (start, -1))]


def _corners(area: Box2) -> list[Point]:
    return [(area.x[0], area.y[0]), (area.x[1], area.y[0]), (area.x[1], area.y[1]), (area.x[0], area.y[1])]


def _closed(area: Box2) -> list[Point]:
    corners = _corners(area)
    return [*corners, corners[0]]


def _mixed(color: Color, white: float) -> Color:
    r, g, b = (round(c * (1 - white) + 255 * white) for c in color)
    return r, g, b

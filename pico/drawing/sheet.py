"""The bench as a sheet to print: a drawing from above at true scale, each component named, and a parts list."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pico.drawing import parts_list as partslist
from pico.drawing.beams import Place, beam_paths, flat
from pico.drawing.label_places import Box, along, bounds, free_place, leader, overlap
from pico.drawing.outlines import circle, outline, square
from pico.drawing.svg import Drawing, Point, text_box, text_width
from pico.model.lab import Box2, Slot
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.kinematics import span
from pico.optics.axis import Values, staged
from pico.optics.geometry import Vector
from pico.twin.surfaces import HOLE_RADIUS

_INK, _FAINT, _EDGE, _HOLE = "#222831", "#6b7480", "#788a8a", "#d3d8de"
_BEAM, _MOVER, _RULE = "#e02424", "#66738a", "#d6dae0"
COLORS = {
    "source": "#2a4a80", "lens": "#3a8ac4", "polarizer": "#34886c", "waveplate": "#805cb6", "mirror": "#b0842c",
    "roof_mirror": "#b0842c", "retroreflector": "#b0842c", "parabola": "#b0842c",
    "plate_splitter": "#3c96a0", "beam_splitter": "#3c96a0",
    "detector": "#bc3a32", "none": "#68707c",
}  # fmt: skip
_HALF_SLOT = 36.0


def sheet(setup: Setup, poses: Mapping[str, Place], *, subtitle: str = "", values: Values | None = None) -> str:
    """Return the SVG of a bench with components at `poses`; `subtitle` says which state it is, `values` as
    `render` takes them."""
    places = flat(poses)
    width, depth = setup.lab.table.size
    size = max(width, depth) / 100
    table = partslist.rows(setup, places)
    margin, head, pitch = 4 * size, 7 * size, 1.7 * size
    widths = _columns(table, size)
    whole = max(width, sum(widths)) + 2 * margin
    height = head + depth + 5 * size + (len(table) + 2) * pitch + margin
    drawing = Drawing(whole, height, (margin, head + depth))
    _table(drawing, setup, size, subtitle)
    labels = _fixed(drawing, setup, places, size)
    _beams(drawing, beam_paths(setup, poses, values))
    for name, pose in sorted(places.items()):
        _component(drawing, setup, name, pose, (values or {}).get(name, {}))
    _names(drawing, setup, places, labels, size)
    _list(drawing, table, widths, (margin, head + depth + 5 * size), size, pitch)
    return drawing.finished()


def _table(drawing: Drawing, setup: Setup, size: float, subtitle: str) -> None:
    """The table with its holes, a title above it, a scale below it."""
    width, depth = setup.lab.table.size
    drawing.group("table")
    drawing.shape(((0, 0), (width, 0), (width, depth), (0, depth)), fill="#f3f5f7", stroke=_EDGE, stroke_width=1.5)
    holes = setup.lab.table.holes
    columns = range(int((width - holes.first[0]) / holes.pitch) + 1)
    rows = range(int((depth - holes.first[1]) / holes.pitch) + 1)
    grid = [(holes.first[0] + i * holes.pitch, holes.first[1] + j * holes.pitch) for i in columns for j in rows]
    drawing.dots(grid, 2 * HOLE_RADIUS, _HOLE)
    drawing.group("title")
    left, top = drawing.at((0, depth))
    drawing.text(setup.lab.title or setup.lab.name, (left, top - 3.2 * size), 2 * size, _INK, bold=True)
    about = f"{width:g} x {depth:g} mm, holes every {holes.pitch:g} mm ({holes.thread})"
    about += f", beam {setup.lab.table.beam_height:g} mm high"
    drawing.text(f"{subtitle} · {about}" if subtitle else about, (left, top - 1.2 * size), 1.1 * size, _FAINT)
    down = drawing.at((0, 0))[1] + 1.6 * size
    drawing.rule((left, down), (left + 100, down), _INK, 0.15 * size)
    for end in (left, left + 100):
        drawing.rule((end, down - 0.5 * size), (end, down + 0.5 * size), _INK, 0.15 * size)
    drawing.text("100 mm", (left + 100 + size, down + 0.4 * size), 1.1 * size, _INK)
    drawing.text("x to the right, y up from the front-left corner; yaw counter-clockwise",
                 (left + width, down + 0.4 * size), 1.1 * size, _FAINT, anchor="end")  # fmt: skip


def _fixed(drawing: Drawing, setup: Setup, places: Mapping[str, Pose], size: float) -> list[Box]:
    """Draw regions, slots and arms with their names; return where the names are, and what no other may cover."""
    taken: list[Box] = []
    drawing.group("regions")
    for _, area, color in _areas(setup):
        (x0, x1), (y0, y1) = area.x, area.y
        border = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        drawing.shape(border, stroke=color, stroke_width=0.08 * size, stroke_dasharray=f"{size} {0.7 * size}")
    drawing.group("slots")
    for name, slot in sorted(setup.lab.slots.items()):
        drawing.shape(_plate(slot), fill="#ffffff", fill_opacity=0.75, stroke="#a8b0bb", stroke_width=0.08 * size)
        if all(slot.pose.distance(p) > 1.4 * _HALF_SLOT for p in places.values()):
            x, y = drawing.at((slot.x, slot.y))
            _write(drawing, name.rpartition("/")[2], (x, y + 0.35 * size), size, _FAINT, taken)
    for name, robot in sorted(setup.lab.robots.items()):
        drawing.group(f"robot-{name}")
        center = (robot.mount.x, robot.mount.y)
        if robot.model == "xarm7":
            drawing.circle(center, 62, fill="#dfe5ec", stroke=_MOVER, stroke_width=0.15 * size)
            for radius in (r for r in span(robot, 100.0) if r > 1.0):
                _arcs(drawing, setup, center, radius, size)
        x, y = drawing.at(center)
        _write(drawing, name, (x, y + 0.35 * size), size, _INK, taken, bold=True)
        taken.append((x - 62, y - 62, x + 62, y + 62))
    return taken


def _plate(slot: Slot) -> list[Point]:
    return square(slot.pose, _HALF_SLOT)


def _areas(setup: Setup) -> list[tuple[str, Box2, str]]:
    """Regions and keep-out volumes: what is written at them, where they are, and their color."""
    found = [(name, region.area, "#5f80b0") for name, region in sorted(setup.lab.regions.items())]
    return [*found, *((f"keep out: {n}", zone.area, "#c43c3c") for n, zone in sorted(setup.lab.keep_out.items()))]


def _area_names(drawing: Drawing, setup: Setup, taken: list[Box], size: float) -> None:
    """Write the name of each area at one of its corners where there is room."""
    drawing.group("area-names")
    for words, area, color in _areas(setup):
        wide = text_width(words, size)
        (left, foot), (right, top) = drawing.at((area.x[0], area.y[0])), drawing.at((area.x[1], area.y[1]))
        corners = [
            (x, y) for y in (top - 0.5 * size, foot + 1.1 * size, top + 1.1 * size, foot - 0.5 * size)
            for x in (right - wide / 2, left + wide / 2)
        ]  # fmt: skip
        for at in corners:
            if _write(drawing, words, at, size, color, taken):
                break


def _write(
    drawing: Drawing, words: str, at: Point, size: float, color: str, taken: list[Box], bold: bool = False
) -> bool:
    """Write a name with its middle at `at`, unless it would lie on another one; return whether it is written."""
    box = text_box(words, at, size, "middle", bold)
    if any(overlap(box, other) for other in taken):
        return False
    drawing.text(words, at, size, color, anchor="middle", bold=bold, halo=True)
    taken.append(box)
    return True


def _arcs(drawing: Drawing, setup: Setup, center: Point, radius: float, size: float) -> None:
    """The part of a circle that lies on the table."""
    from pico.drawing.topview import on_table

    for arc in on_table(setup, circle(center, radius, 180)):
        dash = f"{1.2 * size} {0.8 * size}"
        drawing.shape(arc, closed=False, stroke=_MOVER, stroke_width=0.1 * size, stroke_dasharray=dash)


def _beams(drawing: Drawing, paths: Iterable[tuple[str, Vector, Vector]]) -> None:
    drawing.group("beams")
    for _, start, end in paths:
        drawing.shape((start[:2], end[:2]), closed=False, stroke=_BEAM, stroke_width=1.5)


def _component(drawing: Drawing, setup: Setup, name: str, pose: Pose, values: Mapping[str, Any]) -> None:
    """Footprint, a line where the optic stands across the beam, and a tick where the component faces."""
    kind = setup.type_of(name)
    color = COLORS.get(kind.optics.element, COLORS["none"])
    drawing.group(name, f"{name}: {kind.title}, {pose}")
    drawing.shape(outline(kind.geometry.footprint, pose), fill=color, fill_opacity=0.18, stroke=color, stroke_width=1.5)
    print_ = kind.geometry.footprint
    front = print_.disc if print_.disc is not None else max(x for x, _ in print_.vertices)
    aperture = kind.geometry.clear_aperture
    x, y, _ = aperture.center if aperture else kind.frames.optical
    ahead, left = staged(kind, values)
    x, y = x + ahead, y + left
    if aperture and kind.optics.element not in ("source", "none"):
        half = max(9.0, aperture.diameter / 2)
        drawing.shape((pose.apply(x, y - half), pose.apply(x, y + half)), closed=False, stroke=color, stroke_width=4)
    drawing.shape((pose.apply(min(x, front), y), pose.apply(front, y)), closed=False, stroke=color, stroke_width=1.5)
    drawing.shape([pose.apply(front + a, b) for a, b in ((5, 0), (-4, 5), (-4, -5))], fill=color)


def _names(drawing: Drawing, setup: Setup, places: Mapping[str, Pose], taken: list[Box], size: float) -> None:
    """Each name at the nearest free place to its component, with a line to it where that is not right beside it."""
    shapes = {n: _around(drawing, outline(setup.type_of(n).geometry.footprint, p)) for n, p in places.items()}
    width, depth = setup.lab.table.size
    left, bottom = drawing.at((0, 0))
    within = (left, bottom - depth, left + width, bottom)
    labels: list[Box] = []
    letters = 1.15 * size
    drawing.group("names")
    for name, shape in sorted(shapes.items(), key=lambda item: (item[1][1], item[1][0])):
        wide = text_width(name, letters, bold=True)
        others = [*taken, *labels, *shapes.values()]
        crossed = [other for other in others if other != shape]
        box, beside = free_place(shape, wide, letters, others, within, crossed=crossed) or (shape, True)
        labels.append(box)
        foot = ((box[0] + box[2]) / 2, box[1] + 0.77 * letters)
        if not beside:
            drawing.rule(*leader(shape, box), _FAINT, 0.08 * size)
            labels += along(*leader(shape, box))
        drawing.text(name, foot, letters, _INK, anchor="middle", bold=True, halo=True)
    slots = [_around(drawing, _plate(slot)) for slot in setup.lab.slots.values()]
    _area_names(drawing, setup, [*taken, *labels, *shapes.values(), *slots], size)


def _around(drawing: Drawing, points: Sequence[Point]) -> Box:
    return bounds([drawing.at(point) for point in points])


def _columns(rows: Sequence[tuple[str, ...]], size: float) -> list[float]:
    """The widths of the columns of the parts list [mm]."""
    letters = 1.1 * size
    return [
        max(text_width(row[i], letters, i == 0 or row is partslist.HEAD) for row in (partslist.HEAD, *rows)) + 2 * size
        for i in range(len(partslist.HEAD))
    ]


def _list(
    drawing: Drawing, rows: Sequence[tuple[str, ...]], widths: list[float], at: Point, size: float, pitch: float
) -> None:
    drawing.group("parts")
    letters = 1.1 * size
    for number, row in enumerate((partslist.HEAD, *rows)):
        foot, left = at[1] + (number + 0.6) * pitch, at[0]
        for i, (cell, width) in enumerate(zip(row, widths, strict=True)):
            color, bold = (_INK if number else _FAINT), number == 0 or i == 0
            if i in partslist.NUMBERS:
                drawing.text(cell, (left + width - 2 * size, foot), letters, color, anchor="end", bold=bold)
            else:
                drawing.text(cell, (left, foot), letters, color, bold=bold)
            left += width
        drawing.rule((at[0], foot + 0.5 * size), (left - 2 * size, foot + 0.5 * size), _RULE, 0.08 * size)

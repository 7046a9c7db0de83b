"""A drawing as SVG, one unit a millimetre: shapes in the table frame (y up), and text whose width is known.

Each text says how wide it is to be drawn (`textLength`), so that what does not overlap here overlaps nowhere, whatever
font a reader has.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from typing import Literal

from pico.drawing.label_places import Box

Point = tuple[float, float]

_FONT = "Helvetica, Arial, 'Liberation Sans', sans-serif"
_NARROW, _WIDE = "ijltfrI.,:;|!'()[] /°·", "mwMW@%→"
_RISE, _FALL = 0.74, 0.22  # of a letter above and below its base line, as shares of the font's size


def text_width(text: str, size: float, bold: bool = False) -> float:
    """Return how wide `text` is drawn [mm], near what a Helvetica takes."""
    widths = sum(0.3 if c in _NARROW else 0.85 if c in _WIDE else 0.68 if c.isupper() else 0.55 for c in text)
    return widths * size * (1.06 if bold else 1.0)


def text_box(text: str, at: Point, size: float, anchor: str = "start", bold: bool = False) -> Box:
    """Return the box of `text` with its base line at `at` (x, y down) [mm]."""
    width = text_width(text, size, bold)
    left = at[0] - {"start": 0.0, "middle": 0.5, "end": 1.0}[anchor] * width
    return left, at[1] - _RISE * size, left + width, at[1] + _FALL * size


class Drawing:
    """An SVG of `width` x `height` mm; `origin`: where (0, 0) of the table frame is in it."""

    def __init__(self, width: float, height: float, origin: Point) -> None:
        size = {"width": f"{width:g}mm", "height": f"{height:g}mm", "viewBox": f"0 0 {width:g} {height:g}"}
        self._root = ET.Element("svg", {"xmlns": "http://www.w3.org/2000/svg", **size, "font-family": _FONT})
        self._group = self._root
        self._origin = origin

    def at(self, point: Point) -> Point:
        """Return where a point of the table frame is in the drawing, y down."""
        return self._origin[0] + point[0], self._origin[1] - point[1]

    def group(self, name: str, title: str = "") -> None:
        """Begin a group; what is drawn next belongs to it. `title` shows where a pointer rests on it."""
        self._group = ET.SubElement(self._root, "g", {"id": name})
        if title:
            ET.SubElement(self._group, "title").text = title

    def shape(self, points: Sequence[Point], *, closed: bool = True, **style: str | float) -> None:
        """Draw a polygon, or a line where it is not `closed`, through `points` of the table frame."""
        words = " ".join(f"{x:.6g},{y:.6g}" for x, y in map(self.at, points))
        self._add("polygon" if closed else "polyline", {"points": words}, style)

    def circle(self, center: Point, radius: float, **style: str | float) -> None:
        """Draw a circle around a point of the table frame."""
        x, y = self.at(center)
        self._add("circle", {"cx": f"{x:.6g}", "cy": f"{y:.6g}", "r": f"{radius:.6g}"}, style)

    def dots(self, centers: Sequence[Point], diameter: float, color: str) -> None:
        """Draw discs around points of the table frame, as one path."""
        words = "".join(f"M{x:.6g} {y:.6g}h0" for x, y in map(self.at, centers))
        self._add("path", {"d": words}, {"stroke": color, "stroke_width": diameter, "stroke_linecap": "round"})

    def text(
        self, text: str, at: Point, size: float, color: str, *,
        anchor: Literal["start", "middle", "end"] = "start", bold: bool = False, halo: bool = False,
    ) -> None:  # fmt: skip
        """Write `text` with its base line at `at`, in the drawing's own coordinates (y down); `halo` sets it off."""
        if not text:
            return
        place = {"x": f"{at[0]:.6g}", "y": f"{at[1]:.6g}", "textLength": f"{text_width(text, size, bold):.6g}"}
        style: dict[str, str | float] = {
            "font_size": f"{size:g}",
            "text_anchor": anchor,
            "fill": color,
            "lengthAdjust": "spacingAndGlyphs",
        }
        if bold:
            style["font_weight"] = "bold"
        if halo:  # not a white stroke: where `paint-order` is not known it is drawn over the letters
            left, top, right, bottom = text_box(text, at, size, anchor, bold)
            ground = {"x": f"{left:.6g}", "y": f"{top:.6g}", "width": f"{right - left:.6g}", "rx": f"{0.2 * size:.3g}"}
            self._add("rect", {**ground, "height": f"{bottom - top:.6g}"}, {"fill": "#ffffff", "fill_opacity": 0.8})
        self._add("text", place, style).text = text

    def rule(self, start: Point, end: Point, color: str, width: float) -> None:
        """Draw a line in the drawing's own coordinates (y down)."""
        ends = dict(zip(("x1", "y1", "x2", "y2"), (f"{v:.6g}" for v in (*start, *end)), strict=True))
        self._add("line", ends, {"stroke": color, "stroke_width": width})

    def finished(self) -> str:
        """Return the file's text."""
        ET.indent(self._root, " ")
        return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(self._root, encoding="unicode") + "\n"

    def _add(self, tag: str, place: Mapping[str, str], style: Mapping[str, str | float]) -> ET.Element:
        words = {k if k in ("textLength", "lengthAdjust") else k.replace("_", "-"): str(v) for k, v in style.items()}
        fill = {} if "fill" in words else {"fill": "none"}
        return ET.SubElement(self._group, tag, {**place, **fill, **words})

"""A length between two things, in columns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .style import paint

if TYPE_CHECKING:
    from pico.drawing.ruler import End, Measured, Span

_WIDTH = 10


def text(found: Measured, *, along_beam: bool = False) -> str:
    """Return both ends, and the distances in columns with their units; or those `along_beam` alone."""
    if along_beam:
        return "\n".join(_by_light(found))
    names = max(len(found.a.name), len(found.b.name))
    lines = [_end(end, names) for end in (found.a, found.b)]
    head = "".join(f"{word:>{_WIDTH}}" for word in ("distance", "dx", "dy", "dz", "angle"))
    rows = [paint("dim", f"{'':22}{head}"), _row("centers" if _both(found) else "points", found.centers)]
    if found.surfaces:
        between = f"{found.surfaces.a} - {found.surfaces.b}"
        if found.surfaces.gap >= 0:
            rows.append(f"{_row('nearest faces', found.surfaces.span)}   {between}")
        else:
            rows.append(f"  {'nearest faces':<20}overlap by {-found.surfaces.gap:.2f} mm   {between}")
    if found.beam:
        rows += ["", *_beam(found), *_by_light(found)]
    return "\n".join([*lines, "", *rows])


def _both(found: Measured) -> bool:
    return bool(found.a.component and found.b.component)


def _end(end: End, names: int) -> str:
    x, y, z = end.at
    return f"  {end.name:<{names}}  ({x:.2f}, {y:.2f}, {z:.2f}) mm  {end.what}"


def _row(title: str, span: Span) -> str:
    lengths = "".join(f"{v + 0.0:>{_WIDTH}.2f}" for v in (span.length, *_rounded(span.delta)))
    return f"  {title:<20}{lengths}{_rounded((span.angle,))[0]:>{_WIDTH - 1}.2f}°  mm"


def _rounded(values: Sequence[float]) -> list[float]:
    """Two decimals, and no minus before a zero."""
    return [round(v, 2) + 0.0 for v in values]


def _beam(found: Measured) -> list[str]:
    beam = found.beam
    assert beam is not None
    ahead, left, above = _rounded((beam.ahead, beam.left, beam.above))
    side = "left" if left >= 0 else "right"
    rows = [
        f"  along the axis of {beam.axis}: {ahead:.2f} mm ahead, {abs(left):.2f} mm to the {side}, {above:.2f} mm up"
    ]
    if beam.turned is not None and abs(beam.turned) >= 0.005:
        rows.append(f"  {found.b.component} faces {beam.turned:+.2f}° from {found.a.component}")
    return rows


def _by_light(found: Measured) -> list[str]:
    rows = []
    for way in found.ways:
        over = f" over {', '.join(way.over)}" if way.over else ""
        rows.append(f"  along the beam of {way.source}{over}: {way.length:.2f} mm")
    if len(found.ways) == 2:
        rows.append(f"  the two ways differ by {found.ways[1].length - found.ways[0].length:.2f} mm")
    return rows


def data(found: Measured, *, along_beam: bool = False) -> dict[str, Any]:
    """Return schema `pico.ruler/v1`: both ends, `centers`, `surfaces`, `beam` and `ways`; mm and deg."""
    surfaces, beam = found.surfaces, found.beam
    return {
        "schema": "pico.ruler/v1",
        "a": {"name": found.a.name, "at": found.a.at, "what": found.a.what},
        "b": {"name": found.b.name, "at": found.b.at, "what": found.b.what},
        "centers": _span(found.centers),
        "surfaces": {**_span(surfaces.span), "gap": surfaces.gap, "a": surfaces.a, "b": surfaces.b}
        if surfaces
        else None,
        "beam": {
            "axis": beam.axis, "ahead": beam.ahead, "left": beam.left, "above": beam.above, "turned": beam.turned,
        }
        if beam
        else None,
        "ways": [{"source": way.source, "over": way.over, "length": way.length} for way in found.ways],
    }  # fmt: skip


def _span(span: Span) -> dict[str, Any]:
    dx, dy, dz = span.delta
    return {
        "start": span.start, "end": span.end, "distance": span.length, "dx": dx, "dy": dy, "dz": dz,
        "angle": span.angle,
    }  # fmt: skip

"""Beams, a row for each component that they come to."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .measured import power
from .style import columns, number, paint, wrap

if TYPE_CHECKING:
    from pico.bench.light import Beams
    from pico.optics.beam_table import BeamRow

HEAD = ("component", "after", "radius", "left, up", "wavefront", "power", "polarization", "clipped", "")
_OFF = HEAD.index("left, up")
_CENTERED = 1e-3  # mm: nobody minds less
_TENTH = 1e-4  # mm: no radius is told more exactly
_WORDS = {"left": "leaves the table", "blocked": "ends here", "detected": "", "passed": "", "reflected": "",
          "divided": ""}  # fmt: skip


def text(found: Beams) -> str:
    """Return a table for each source, and each way that a divided beam goes."""
    if not found.rows:
        return f"No source of light stands on the table ({found.goal})."
    lines: list[str] = []
    for source in dict.fromkeys(row.source for row in found.rows):
        mine = [row for row in found.rows if row.source == source]
        off = "; it is off or shut, and shown as if it shone" if source in found.dark else ""
        lines += ["" if lines else None, f"The beam of {source}, {found.goal}{off}:"]  # type: ignore[list-item]
        lines += ["", *_table(mine)]
    unknown = dict.fromkeys(row.unknown for row in found.rows if row.unknown)
    lines += [line for why in unknown for line in ("", *wrap(f"Radius unknown: {why}.", ""))]
    return "\n".join(line for line in lines if line is not None)


def _table(rows: list[BeamRow]) -> list[str]:
    ways = _ways(rows)
    cells = [list(HEAD)]
    for way in ways:
        cells += [[""] * len(HEAD)] if len(cells) > 1 else []
        cells += [_cells(row) for row in way]
    if not any(row[_OFF] for row in cells[1:]):
        cells = [row[:_OFF] + row[_OFF + 1 :] for row in cells]
    head, *rest = columns(cells, indent="  ")
    return [paint("dim", head), *(line.rstrip() for line in rest)]


def _ways(rows: list[BeamRow]) -> list[list[BeamRow]]:
    """Return rows way by way: each begins where another was divided."""
    ways: list[list[BeamRow]] = []
    for row in rows:
        for way in ways:
            if way[-1].number == row.before:
                way.append(row)
                break
        else:
            ways.append([row])
    return ways


def _cells(row: BeamRow) -> list[str]:
    name = row.component or "(table's edge)"
    clipped = f"{number(100 * row.clipped)} %" if row.clipped >= 5e-4 else ""
    note = "; ".join(w for w in ("ghost" if row.ghost else "", _WORDS[row.event] if row.component else "leaves") if w)
    radius = "unknown" if row.unknown else _radius(row.radii) + _unsure(row)
    off = _offset(row)
    return [name, f"{row.length:.1f} mm", radius, off, _front(row), power(row.power), polarization(row), clipped, note]


def _offset(row: BeamRow) -> str:
    """Return how far from the middle of a component a beam comes, to the left and up; empty where it is centered."""
    if not row.component or math.hypot(*row.offset) < _CENTERED:
        return ""
    left, up = (f"{value:.3f}".replace("-0.000", "0.000") for value in row.offset)
    return f"{left}, {up} mm"


def _radius(radii: tuple[float, float]) -> str:
    wide, narrow = (_length(r) for r in radii)
    return wide if wide == narrow else f"{wide} x {narrow}"


def _unsure(row: BeamRow) -> str:
    """Return one standard deviation of the larger radius by what was measured of the glass, where that is anything."""
    return f" ± {_length(row.sigma[0])}" if row.sigma and row.sigma[0] > _TENTH else ""


def _length(value: float) -> str:
    return f"{value:.3f} mm" if value >= 0.1 else f"{1000 * value:.1f} um"


def _front(row: BeamRow) -> str:
    if row.unknown:
        return ""
    found = row.front[0] if row.front[0] is not None else row.front[1]
    if found is None or abs(found) > 1e5:
        return "flat"
    return f"{'diverges' if found > 0 else 'converges'} {abs(found):.0f} mm"


def polarization(row: BeamRow) -> str:
    """Return `linear 22.8°`, `circular, counter-clockwise`, `elliptical`, or that there is none."""
    if row.degree < 0.05:
        return "none"
    part = "" if row.degree > 0.99 else f"{100 * row.degree:.0f} % "
    turn = "counter-clockwise" if row.ellipticity > 0 else "clockwise"
    share = abs(row.ellipticity) / row.degree
    if share > 0.99:
        return f"{part}circular, {turn}"
    angle = f"{row.angle + 0.0:.1f}°".replace("-0.0°", "0.0°")
    return f"{part}linear {angle}" if share < 0.05 else f"{part}elliptical {angle}, {turn}"


def data(found: Beams) -> dict[str, Any]:
    """Return schema `pico.beam/v1`: `goal`, `dark` sources, `rows` (mm, mW, deg) and `diagnostics`."""
    return {
        "schema": "pico.beam/v1", "goal": found.goal, "dark": list(found.dark),
        "rows": [as_json(row) for row in found.rows],
        "diagnostics": [as_json(d) for d in found.diagnostics],
    }  # fmt: skip

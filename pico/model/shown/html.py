"""Tables and lines as HTML, all text escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

MOST_ROWS = 60
"""So many rows of a table are shown."""


def table(title: str, head: Sequence[str], rows: Iterable[Sequence[object]], below: str = "") -> str:
    """Return a table with a title above it and a line below; where it is long, its first rows and how many more."""
    all_rows = [[escape(str(cell)) for cell in row] for row in rows]
    shown = all_rows[:MOST_ROWS]
    more = len(all_rows) - len(shown)
    parts = [f"<div><b>{escape(title)}</b></div>"]
    if shown:
        parts.append("<table><thead><tr>" + "".join(f"<th>{escape(h)}</th>" for h in head) + "</tr></thead><tbody>")
        parts += ["<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in shown]
        parts.append("</tbody></table>")
    if more > 0:
        parts.append(f"<div>and {more} more</div>")
    if below:
        parts.append(f"<div>{escape(below)}</div>")
    return "".join(parts)


def number(value: object, sigma: object = None) -> str:
    """Return a value as a person reads it: `1.234 ± 0.01`."""
    said = f"{value:.6g}" if isinstance(value, float) else "none" if value is None else str(value)
    return f"{said} ± {sigma:.2g}" if isinstance(sigma, int | float) else said

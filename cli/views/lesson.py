"""What the twin of a bench learned from its runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .style import columns, count, paint

if TYPE_CHECKING:
    from pico.runs.learning import Lesson, Row


def text(lesson: Lesson, *, shown: str) -> str:
    """Return a line for each number: what the twin said before, what was measured, what it says now."""
    learned = lesson.learned
    head = [paint("dim", word) for word in ("", "data", "the twin said", "measured", "it says now", "")]
    rows = columns([head, *(_row(row) for row in lesson.rows)], indent="  ")
    lines = [f"From {count(len(learned.runs), 'run')} ({learned.evidence}):", "", *rows, ""]
    seconds = lesson.seconds
    if seconds.get("planned"):
        said = f"{seconds['before']:.1f} s before, {seconds['after']:.1f} s now"
        lines.append(f"All operations took {seconds['measured']:.1f} s; the twin said {said}.")
    lines.append(f"Wrote {shown}. Commit it with the lab." if lesson.written else "Nothing was written (--dry-run).")
    return "\n".join(lines)


def _row(row: Row) -> list[str]:
    measured = f"{_said(row.measured, row.unit)} ± {row.sigma:.2g}" if row.measured is not None else "too few"
    odd = f"{count(row.outliers, 'outlier')} left out" if row.outliers else ""
    note = row.because.removeprefix("too few, ") or odd
    return [row.what, f"{row.count}", _said(row.before, row.unit), measured, _said(row.after, row.unit), note]


def _said(value: float, unit: str) -> str:
    return f"{value:.3g} x" if unit == "x" else f"{value:.3f} {unit}"


def data(lesson: Lesson, **_: Any) -> dict[str, Any]:
    """Return schema `pico.lesson/v1`: the rows, the seconds, and under `learned` the document that is written."""
    found = {"rows": lesson.rows, "seconds": lesson.seconds, "learned": lesson.learned, "written": lesson.written}
    return {"schema": "pico.lesson/v1", **as_json(found)}

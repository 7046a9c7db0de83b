"""A run that is done again: its operations, and what was measured then and now."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.model.record import as_json
from pico.runs.operations import OperationRun
from pico.scripting.replaying import Compared, Replayed

from .measured import value
from .style import columns, count, wrap


def head(run: str, planned: Sequence[OperationRun]) -> str:
    """Return what is about to be done again."""
    return f"{count(len(planned), 'operation')} of run {run}, in their order:"


def step(op: OperationRun) -> str:
    """Return an operation in a line."""
    to = op.arguments.get("to")
    goal = (to.get("slot") or "its pose") if isinstance(to, dict) else to
    return f"  {op.primitive} {op.address}{f' → {goal}' if to is not None else ''}"


def text(made: Replayed) -> str:
    """Return what became of it, and the numbers of both runs."""
    report = made.report
    lines = [f"Run {report.run}: {report.outcome}, {count(report.done, 'operation')} done in {report.seconds:.1f} s."]
    if made.compared:
        rows = [["", "then", "now", ""], *(_row(one) for one in made.compared)]
        lines += ["", *(f"  {row}" for row in columns(rows))]
    for why in dict.fromkeys(f"{one.address}: {one.why}" for one in made.compared if one.why):
        lines += wrap(f"not to be compared: {why}", "  ")
    return "\n".join(lines)


def _row(one: Compared) -> list[str]:
    apart = "" if one.sigmas is None else f"{one.sigmas:.1f} sigma apart"
    return [one.address, value(one.then, one.unit), value(one.now, one.unit), "not comparable" if one.why else apart]


def data(made: Replayed) -> dict[str, Any]:
    """Return the same as JSON: `pico.replayed/v1`."""
    return {"schema": "pico.replayed/v1", **as_json(made)}

"""What an optimization came to: whether the goal is met, what was measured and set before and after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .measured import solved, value
from .style import columns, count, paint, seconds, wrap

if TYPE_CHECKING:
    from pico.bench.goals import Chosen, Optimized
    from pico.diagnostics import Diagnostic
    from pico.model.setup import Setup
    from pico.model.trace.report import RunReport


def text(
    found: Optimized, chosen: Chosen, setup: Setup, report: RunReport, *, advice: str = "",
    began: Mapping[str, float] = MappingProxyType({}), **_: Any,
) -> str:  # fmt: skip
    """Return the outcome in a line, a table of before and after, and how to go back; `advice`: what to do about it;
    `began`: where its tunables stood before."""
    spent = f"{count(found.measurements, 'measurement')}, {seconds(found.seconds)} on the bench"
    said = paint("green", "met") if found.met else paint("yellow", "not met")
    lines = wrap(f"{chosen.name}: {said} in {spent} ({chosen.algorithm}: {chosen.why})", "  ")
    for one in found.stages:
        stood = "found" if one.get("last") else "not found"
        lines += wrap(f"{one['goal']} first: {stood} after {count(one['measurements'], 'measurement')}", "  ")
    if not found.met:
        lines += wrap(f"Stopped: {found.why}.", "  ")
    lines += _table(found, chosen, setup, began)
    if said := solved({"solution": found.solution, "last": found.last}):
        lines += wrap(f"It was left at {said}.", "  ")
    back = "; `pico undo` goes back" if found.measurements else ""
    lines += wrap(f"= help: {advice}", "  ") if advice else []
    return "\n".join([*lines, f"  `pico runs show {report.run}`{back}"])


def _table(found: Optimized, chosen: Chosen, setup: Setup, began: Mapping[str, float]) -> list[str]:
    rows = [[paint("dim", cell) for cell in ("", "before", "after", "")]]
    first, last = {**began, **(found.first or {})}, found.last or {}
    for name in chosen.goal.tunables:
        component, _, tunable = name.partition(".")
        unit = setup.type_of(component).tunables[tunable].unit
        rows.append([name, *(value(of[name], unit) if name in of else "-" for of in (first, last)), ""])
    for name in [
        c for c in found.columns if c != "time" and c not in chosen.goal.tunables and not c.endswith("_sigma")
    ]:
        texts = chosen.goal.expressions[0] if name == "objective" else name
        none = "saturated" if found.saturated else "dark"
        cells = [value(of[name], "", of.get(f"{name}_sigma")) if name in of else none for of in (first, last)]
        near = found.tolerance.get(name)
        goal = f"to {(chosen.goal.reach or {})[name]:g} within {near:g}" if near and chosen.goal.reach else ""
        rows.append([texts, *cells, goal])
    return [f"  {row}" for row in columns(rows)]


def data(
    found: Optimized, chosen: Chosen, setup: Setup, report: RunReport, *, cautions: Sequence[Diagnostic] = (), **_: Any
) -> dict[str, Any]:  # fmt: skip
    """Return schema `pico.optimization/v1`: `goal`, `algorithm`, `met`, `why`, `measurements`, `seconds`, `first`,
    `last`, `points` (an array in the content store, its `columns`), `run`; `stages`: the same of the goals that were
    sought first, `measurements` counted from the first on; `diagnostics`: what else came up."""
    return {"schema": "pico.optimization/v1", **as_json(found), "goal": chosen.name, "algorithm": chosen.algorithm,
            "chosen": chosen.why, "run": report.run,
            "diagnostics": as_json((*cautions, *report.diagnostics))}  # fmt: skip

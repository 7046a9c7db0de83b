"""Error budgets: what contributes to a result, and what would have to be held tighter."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .measured import power
from .style import columns, count, paint, wrap

if TYPE_CHECKING:
    from pico.diagnosis.budget import Contribution, ErrorBudget, Tighter
    from pico.diagnosis.claims import Budgeted

SMALL = 0.001
"""The share of the variance below which contributions are only counted."""
_MUCH = 0.02
"""The same for what is shown beside a diff."""
Effect = Callable[["Contribution"], float | None]


def text(found: Sequence[Budgeted], *, goal: str, whole: bool = True, repeats: bool = False) -> str:
    """Return the budget of one result, `whole`, or a line for each claim."""
    if whole:
        return "\n".join(_whole(found[0], goal, repeats))
    if not found:
        return "The lab claims nothing: `claims:` in lab.yaml, or `pico budget cam.centroid.y`."
    rows = [[one.claim, *_claimed(one)] for one in found]
    head = ["claim", "value", "claimed to", "tolerances leave", ""]
    return "\n".join([f"Claims, in {goal}:", "", *columns([[paint("dim", h) for h in head], *rows], indent="  ")])


def _claimed(one: Budgeted) -> list[str]:
    if one.budget is None:
        return ["", f"{one.to or ''}", "", f"can't be told: {one.why}"]
    verdict = paint("green", "carried") if one.carried else paint("yellow", f"not carried: `pico budget {one.claim}`")
    return [_sized(one.budget.value, one.budget.unit), f"{one.to}", _of(one.budget.tolerated, one.budget), verdict]


def _whole(one: Budgeted, goal: str, repeats: bool) -> list[str]:
    budget = one.budget
    assert budget is not None  # of one result nobody is asked who cannot tell
    effect: Effect = (lambda row: row.repeated) if repeats else (lambda row: row.tolerated)
    total = budget.repeated if repeats else budget.tolerated
    lines = [f"{paint('bold', one.claim or budget.of)} in {goal}: {_sized(budget.value, budget.unit)}"]
    lines += [f"  {one.claim} = {budget.of}"] if one.claim else []
    lines += [
        f"  {look}: {', '.join(f'{k} = {_value(v)}' for k, v in own.items())}" for look, own in budget.looks.items()
    ]
    lines += ["", *_table(budget, effect, total, repeats), ""]
    within = f"{_of(budget.tolerated, budget)} within the tolerances"
    repeated = f"{_of(budget.repeated, budget)} as well as the bench repeats"
    lines += [f"Root of the sum of squares: {f'{repeated}; {within}' if repeats else f'{within}; {repeated}'}."]
    if budget.lost:
        lines += [paint("yellow", f"No light may be left within the tolerance of {', '.join(budget.lost)}: not in it.")]
    return [*lines, *(_wanted(one, budget) if one.wanted is not None else [])]


def _table(budget: ErrorBudget, effect: Effect, total: float, repeats: bool) -> list[str]:
    known = sorted(((effect(row) or 0.0, row) for row in budget.rows), key=lambda pair: -pair[0])
    shown = [(size, row) for size, row in known if total and (size / total) ** 2 >= SMALL]
    head = ["error", "repeats to" if repeats else "tolerance", "sensitivity", "effect", "of variance", ""]
    rows = [_row(row, size, total, budget.unit, repeats) for size, row in shown]
    if rest := [size for size, row in known[len(shown) :]]:
        word = f"{len(rest)} others" if len(rest) > 1 else "1 other"
        rows += [[word, "", "", _sized(math.hypot(*rest), budget.unit), "", ""]]
    return columns([[paint("dim", one) for one in head], *rows], indent="  ")


def _row(row: Contribution, size: float, total: float, unit: str, repeats: bool) -> list[str]:
    limit = None if repeats else row.tolerance
    held = f"± {limit:.3g} {row.unit}" if limit is not None else f"{row.repeats:.2g} {row.unit} (1 sigma)"
    per = f"{row.derivative:+.3g} {unit}/{row.unit}".replace(" /", " 1/")
    note = "" if not row.bent else "not in proportion"
    name = f"{row.address} ({row.look})" if row.look else row.address
    return [name, held, per, _sized(size, unit), f"{100 * (size / total) ** 2:.1f} %", note]


def _wanted(one: Budgeted, budget: ErrorBudget) -> list[str]:
    said = f"{one.claim or 'The result'} to {one.to}" + (
        f" ({_sized(one.wanted or 0.0, budget.unit)})" if budget.unit else ""
    )
    if one.carried:
        return ["", paint("green", f"{said}: the tolerances carry that.")]
    if not one.tighter:
        return ["", paint("yellow", f"{said}: not while light may be lost.")]
    rows = [_tighter(held) for held in one.tighter]
    lines = [
        "",
        paint("yellow", f"{said} needs {count(len(rows), 'error')} held tighter:"),
        "",
        *columns(rows, indent="  "),
    ]
    if any(not held.reached for held in one.tighter):
        text = "What the bench does not repeat so well, no tolerance makes better: let light align it, or measure it."
        lines += ["", *wrap(text, "")]
    return lines


def _tighter(held: Tighter) -> list[str]:
    fine = "" if held.reached else paint("yellow", "finer than it repeats")
    return [held.said, paint("dim", f"from {'± ' if held.limit else ''}{held.was:.2g}"), fine]


def _of(size: float, budget: ErrorBudget) -> str:
    share = "" if budget.nothing else f" ({100 * size / abs(budget.value):.2g} %)"
    return f"{_sized(size, budget.unit)}{share}"


def _sized(value: float, unit: str) -> str:
    return power(value) if unit == "mW" else f"{value:.3g} {unit}".rstrip()


def _value(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def change(what: str, before: Budgeted, after: Budgeted) -> list[str]:
    """Return lines for how a result and its errors differ between two states."""
    ends = [one.why if one.budget is None else _known(one.budget) for one in (before, after)]
    lines = [f"{what}: {ends[0]} → {ends[1]}"]
    if before.budget is None or after.budget is None:
        return lines
    effects = [{(r.address, r.look): r.tolerated or 0.0 for r in one.rows} for one in (before.budget, after.budget)]
    total = max(before.budget.tolerated, after.budget.tolerated)
    names = sorted({*effects[0], *effects[1]}, key=lambda k: -max(one.get(k, 0.0) for one in effects))
    rows = []
    for name in names:
        then, now = (one.get(name, 0.0) for one in effects)
        if max(then, now) ** 2 >= _MUCH * total * total:
            sizes = [_sized(size, after.budget.unit) for size in (then, now)]
            rows.append([f"by {name[0]}{f' ({name[1]})' if name[1] else ''}", f"{sizes[0]} → {sizes[1]}"])
    return [*lines, *columns(rows, indent="  ")]


def _known(budget: ErrorBudget) -> str:
    share = "" if budget.nothing else f" ({100 * budget.tolerated / abs(budget.value):.2g} %)"
    return f"{_sized(budget.value, budget.unit)} ± {_sized(budget.tolerated, budget.unit)}{share}"


def data(found: Sequence[Budgeted], *, goal: str, **_: Any) -> dict[str, Any]:
    """Return schema `pico.budget/v1`: `goal`, and `results`: `claim`, `of`, `looks`, `value`, `unit`, `tolerated` and
    `repeated` (one standard deviation, in the unit), `rows`, `lost`, `to`, `wanted`, `carried`, `tighter`; or `why` one
    can't be told."""
    return {"schema": "pico.budget/v1", "goal": goal, "results": [one_data(one) for one in found]}


def one_data(one: Budgeted) -> dict[str, Any]:
    """Return one of the `results`."""
    told = {"claim": one.claim, "to": one.to, "why": one.why}
    if (budget := one.budget) is None:
        return told
    rows = [{k: v for k, v in as_json(row).items() if k != "derivative" or math.isfinite(v)} for row in budget.rows]
    sums = {"tolerated": budget.tolerated, "repeated": budget.repeated, "lost": list(budget.lost)}
    judged = {"wanted": one.wanted, "carried": one.carried, "tighter": as_json(one.tighter)}
    return (
        told
        | {"of": budget.of, "looks": as_json(budget.looks), "value": budget.value, "unit": budget.unit}
        | sums
        | ({"rows": rows} | judged)
    )

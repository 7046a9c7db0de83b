"""Two runs side by side."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from pico.kernels.measured import in_order
from pico.model.record import as_json
from pico.model.trace.run import Run

from .diff import lines
from .measured import numbers, value
from .runs import deed, moment, shown
from .style import columns, count, paint, seconds, shorten

_HASH = re.compile(r"[0-9a-f]{40,64}")

if TYPE_CHECKING:
    from pico.history.runs.comparing import Comparison, MeasuredTwice, Pair
    from pico.runs.operations import OperationRun


def text(found: Comparison) -> str:
    """Return where the two ended, what each operation took, and what else differs."""
    block = [*columns([_title("A", found.a), _title("B", found.b)]), "", *_ends(found)]
    if found.operations:
        head = [paint("dim", cell) for cell in ("operation", "A", "B", "", "how it ended")]
        block += ["", *columns([head, *(_pair(p) for p in found.operations)], indent="  ")]
    if found.measured:
        head = [paint("dim", cell) for cell in ("measured", "A", "B", "")]
        block += ["", *columns([head, *(_measured(m) for m in found.measured)], indent="  ")]
    if found.differing:
        head = [paint("dim", cell) for cell in ("otherwise", "A", "B")]
        rows = [[shown(d.name), _fact(d.a), _fact(d.b)] for d in found.differing]
        block += ["", *columns([head, *rows], indent="  ")]
    else:
        block += ["", "Nothing else differs."]
    return "\n".join(block)


def _measured(m: MeasuredTwice) -> list[str]:
    why = paint("yellow", f"not comparable: {'; '.join(m.incomparable)}") if m.incomparable else ""
    a, b = (shown(value(in_order(one.kernel, one.value), one.unit)) for one in (m.a, m.b))
    return [m.address, a, b, why]


def _title(letter: str, d: Run) -> list[str]:
    return [paint("bold", letter), shown(d.id), moment(d.started_at), d.evidence, deed(d)]


def _ends(found: Comparison) -> list[str]:
    if found.changes is None:
        said = "led to the same state" if found.same else "led to different states"
        return [f"They {said}; how the bench was seen afterwards is not known of both."]
    beyond = [c for c in found.changes if not c.tolerated]
    within = len(found.changes) - len(beyond)
    near = f", {count(within, 'tunable')} within tolerance" if within else ""
    if not beyond:
        same = "They led to the same state" if found.same else "They ended alike"
        return [f"{same}{near}."]
    return [f"Where A ended → where B ended{near}:", *lines(beyond)]


def _pair(p: Pair) -> list[str]:
    longer = ""
    if p.a and p.b and p.a.seconds is not None and p.b.seconds is not None:
        apart = p.b.seconds - p.a.seconds
        longer = f"{apart:+.1f} s" if abs(apart) >= 0.05 else "="
    a, b = _outcome(p.a), _outcome(p.b)
    return [
        shown(f"{p.primitive} {p.address}" + (f" → {p.to}" if p.to else "")),
        _took(p.a),
        _took(p.b),
        longer,
        a if a == b else f"{a} → {b}",
    ]


def _took(op: OperationRun | None) -> str:
    return "-" if op is None or op.seconds is None else seconds(op.seconds)


def _outcome(op: OperationRun | None) -> str:
    return "not in it" if op is None else op.outcome


def _fact(value: Any) -> str:
    if value is None:
        return "-"
    word = str(value).removeprefix("sha256:")
    return word[:12] if _HASH.fullmatch(word) else shorten(shown(word), 36)


def data(found: Comparison) -> dict[str, Any]:
    """Return schema `pico.run-comparison/v1`: `a`, `b` (documents), `same`, `changes`, `operations`, `differing`,
    `measured`, each number with its own unit, too (`numbers`)."""
    said: dict[str, Any] = as_json(found)
    for told, one in zip(said["measured"], found.measured, strict=True):
        told["numbers"] = {"a": numbers(one.a), "b": numbers(one.b)}
    return {"schema": "pico.run-comparison/v1", **said}

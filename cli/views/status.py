"""Committed, desired and live, side by side."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from pico.model.comparing.status import Status, StatusRow
from pico.model.record import as_json
from pico.model.state import is_reference

from .style import columns, count, listed, paint, place, valued, wrap
from .unread import in_known, unread

LONG = 40


def text(status: Status, *, every: bool = False) -> str:
    """Return the table of three columns; of a long one only what differs, unless `every`."""
    rows = [r for r in status.rows if every or len(status.rows) <= LONG or not r.equal]
    head = [
        "",
        f"committed ({status.head})" if status.head else "committed",
        "desired (manifest)",
        f"live ({status.backend})",
    ]
    table = [[paint("dim", cell) for cell in head], *map(_cells, rows)]
    table += [
        [name, "-", "-", f"{place(as_json(pose))}  {paint('yellow', 'an obstacle, not in the inventory')}"]
        for name, pose in sorted(status.unknown.items())
    ]
    below = [[], *_below(rows), *([] for _ in status.unknown)]
    lines = [own for row, more in zip(columns(table), below, strict=True) for own in (row, *more)] * (len(table) > 1)
    hidden = len(status.rows) - len(rows)
    if hidden:
        lines.append(paint("dim", f"and {hidden} more that are equal in all three; --all shows them"))
    return "\n".join([*lines, "", *_summary(status)]).lstrip("\n")


def _below(rows: Sequence[StatusRow]) -> Iterator[list[str]]:
    """Yield for each row why the bench is not where light says that it should be: it would widen the table. What is
    said of several that are one goal is said once, below the last of them."""
    last = {row.near: row for row in rows if row.off and is_reference(row.desired) and not row.note}
    yield from (wrap(row.near, "    ") if last.get(row.near) is row else [] for row in rows)


def _cells(row: StatusRow) -> list[str]:
    unit = f" {row.unit}" if row.unit else ""
    committed = "-" if row.committed is None else valued(row.committed, row.unit)
    desired = (
        "="
        if row.committed is not None and not row.edited
        else "-"
        if row.desired is None
        else valued(row.desired, row.unit)
    )
    desired = paint("yellow", f"{desired} *") if row.edited else desired
    if row.unstated:
        live = paint("yellow", f"{place(row.live)}{unit}  set, but in no state")
    elif row.note:
        live = paint("red", row.note)
    elif row.live is None:
        live = "unknown" + paint("red", " !") * row.off
    elif row.off and is_reference(row.desired):
        live = paint("yellow" if row.edited else "red", f"{valued(row.live, row.unit)} !")
    elif row.off:
        aside = f", {row.aside}" * bool(row.aside)
        live = paint("yellow" if row.edited else "red", f"{place(row.live)}{aside}{unit} !")
    else:
        live = "=" if row.exact else f"= {row.near}".rstrip()
    if row.kept and not row.note:
        live = f"{place(row.live)}{unit}{paint('dim', f'  kept: {row.kept} has the last word')}"
    if row.requested and not row.note:
        live = "unknown" if row.live is None else f"{_light(row.live)}{unit}"
        live += paint("dim", f" (requested: {_light(row.desired)}{unit})")
    return [row.address, committed, desired, live]


def _light(value: Any) -> str:
    """Return what lets light out as a person says it: emission is on or off."""
    return ("on" if value else "off") if isinstance(value, bool) else place(value)


def _summary(status: Status) -> list[str]:
    drifts = sum(r.drifted for r in status.rows)
    pending = sum(r.off and not r.drifted for r in status.rows)
    lost = sum(bool(r.note) for r in status.rows)
    edits = sum(r.edited for r in status.rows)
    unstated = [r.address for r in status.rows if r.unstated]
    differ = "differs" if drifts == 1 else "differ"
    parts = [
        (edits, f"{count(edits, 'edit')} not committed (*)"),
        (pending, f"{count(pending, 'tunable')} of the bench to bring to the manifest (!)"),
        (
            drifts,
            f"{count(drifts, 'setting')} {differ} from both the commit and the manifest (!)",
        ),
        (len(unstated), f"{count(len(unstated), 'setting')} in no state"),
        (lost, f"{count(lost, 'component')} not seen as it should be"),
        (len(status.unknown), f"{count(len(status.unknown), 'stranger')} on the table"),
    ]
    unknown = [r.address for r in status.rows if r.unread]
    told = [unread(unknown)] if unknown else []
    said = " · ".join(words for number, words in parts if number)
    if not said:
        if all(row.committed is None for row in status.rows):
            return [*told, 'The bench is as the manifest says; nothing is committed yet: `pico commit -m "why"`.']
        but = ["light that is asked for"] if any(r.requested for r in status.rows) else []
        kept = sum(bool(r.kept) for r in status.rows)
        but += [f"{count(kept, 'value')} that alignment has the last word on"] if kept else []
        end = ["`pico capture` writes the values kept into the manifest; `pico apply --exact` drives to its numbers."]
        return [
            f"Committed, desired and live are equal{in_known(unknown)}{f', but for {listed(but)}' if but else ''}.",
            *told,
            *end[: bool(kept)],
        ]
    advice = []
    if any(d.code == "goes-on" for d in status.cut_short):
        advice.append("A run goes on: this is the bench in between.")
    elif pending or drifts:
        advice.append("`pico plan` shows what would move; `pico capture` takes the live values into the manifest.")
    elif unstated:
        advice.append(
            f"`pico capture {' '.join(unstated)}` writes {'it' if len(unstated) == 1 else 'them'} into the manifest."
        )
    elif edits and not lost:
        advice.append('The bench is as the manifest says; `pico commit -m "why"` keeps it.')
    return [said, *told, *advice]


def data(status: Status, **_: Any) -> dict[str, Any]:
    """Return schema `pico.status/v1`: `head`, `rows` (component, tunable, committed, desired, live, ...), `unknown`,
    `cut_short`."""
    found: dict[str, Any] = as_json(status)
    return found

"""One revision: the commit, what it changed, and the state that it holds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.diff import place_json
from pico.model.record import as_json
from pico.model.state import place_of

from .diff import lines
from .log import entry_data, evidence_lines, header, noted
from .style import columns, paint, place, valued

if TYPE_CHECKING:
    from pico.history.shown import Shown


def text(found: Shown) -> str:
    """Return the commit, its physical diff, its runs and notes, then every component of the state, or the one asked."""
    entry, component = found.entry, found.component
    what = [f"  {entry.unreadable}"] if entry.unreadable else lines(entry.changes) or [f"  {_nothing(component)}"]
    said = [line for part, notes in found.notes.items() for line in noted(part, notes).splitlines()]
    table = [[paint("dim", cell) for cell in ("component", "where", "tunables")], *_rows(found)]
    digest = found.state.digest()
    head = f"{component} at {entry.commit.label}:" if component else f"State {digest[:19]}:"
    block = [*header(entry), "", "Changed:", *what, *evidence_lines(entry), "", *said, *([""] if said else [])]
    return "\n".join([*block, head, *columns(table, indent="  ")])


def _nothing(component: str | None) -> str:
    return f"nothing of {component}" if component else "no change on the table"


def _rows(found: Shown) -> list[list[str]]:
    setup, state = found.setup, found.state
    rows = []
    for name in sorted(setup.lab.inventory) if found.component is None else [found.component]:
        values = state.components[name].given if name in state.components else {}
        kinds = setup.type_of(name).tunables
        said = [f"{k} {valued(v, kinds[k].unit if k in kinds else '')}" for k, v in values.items()]
        rows.append([name, place(place_json(*place_of(setup, state, name))), ", ".join(said)])
    return rows


def data(found: Shown) -> dict[str, Any]:
    """Return schema `pico.revision/v1`: the commit as in `pico.log/v1`, `state` (of the component asked for alone), its
    digest, and `notes`."""
    state = found.state.as_json()
    some = {name: part for name, part in state.items() if found.component in (None, name)}
    return {
        "schema": "pico.revision/v1", **entry_data(found.entry), "state": some, "digest": found.state.digest(),
        "notes": as_json(found.notes),
    }  # fmt: skip

"""One revision: the commit, what it changed, and the state that it holds."""

from __future__ import annotations

from typing import Any

from pico.history.folder import Entry
from pico.model.diff import place_json
from pico.model.lab import Setup
from pico.model.state import LabState, place_of

from .diff import lines
from .log import entry_data
from .style import columns, paint, place, wrap


def text(entry: Entry, setup: Setup, state: LabState) -> str:
    """Return the commit, its physical diff, then every component of the state."""
    c = entry.commit
    refs = f" ({', '.join(c.refs)})" if c.refs else ""
    head = [
        paint("yellow", f"commit {c.short}{refs}"),
        f"{c.author}, {c.time:%Y-%m-%d %H:%M}",
        "",
        *wrap(c.message, "    "),
    ]
    what = [entry.unreadable] if entry.unreadable else lines(entry.changes) or ["  nothing on the table"]
    table = [[paint("dim", cell) for cell in ("component", "where", "tunables")], *_rows(setup, state)]
    return "\n".join([*head, "", "Changed:", *what, "", f"State {state.digest()[:19]}:", *columns(table, indent="  ")])


def _rows(setup: Setup, state: LabState) -> list[list[str]]:
    rows = []
    for name in sorted(setup.lab.inventory):
        values = state.components[name].values if name in state.components else {}
        kinds = setup.type_of(name).tunables
        said = [
            f"{k} {place(v)}{' ' + kinds[k].unit if k in kinds and kinds[k].unit else ''}" for k, v in values.items()
        ]
        rows.append([name, place(place_json(*place_of(setup, state, name))), ", ".join(said)])
    return rows


def data(entry: Entry, setup: Setup, state: LabState) -> dict[str, Any]:
    """Return schema `pico.revision/v1`: the commit as in `pico.log/v1`, `state` and its digest."""
    return {"schema": "pico.revision/v1", **entry_data(entry), "state": state.as_json(), "digest": state.digest()}

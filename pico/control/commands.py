"""The commands of a bench as the coordinator keeps them: numbered by lease, each under its key, each with one end.

Pure, as the leases are. A row is written before anything is sent, and sent again until the edge answers: the edge knows
each key, and does nothing twice.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from pico.control.gate import Command, Memory, Record

State = Literal["waiting", "done", "failed", "unknown", "withdrawn"]
OPEN: frozenset[State] = frozenset({"waiting", "unknown"})
"""States that are not the last: what waits for the edge, and what only somebody who looks can tell."""
WINDOW = 4
"""Commands of a lease that may be on their way at a time."""


@dataclass(frozen=True, slots=True)
class Row:
    """A command and what became of it; `unknown` until the edge has looked or a named person (`by`) said so."""

    command: Command
    state: State = "waiting"
    result: str = ""
    by: str = ""


@dataclass(frozen=True, slots=True)
class Commands:
    """The rows of a bench by key."""

    rows: Mapping[str, Row] = field(default_factory=dict)

    def of(self, token: int) -> tuple[Row, ...]:
        """Return the commands of a lease in their order."""
        return tuple(sorted((r for r in self.rows.values() if r.command.token == token), key=lambda r: r.command.seq))

    def due(self, token: int) -> tuple[Command, ...]:
        """Return what is to be sent, or sent again, for the lease that counts: in order, a few at a time."""
        return tuple(r.command for r in self.of(token) if r.state == "waiting")[:WINDOW]

    def whole(self, token: int, count: int) -> bool:
        """Whether so many commands of a lease are there, all of them: only then may their client leave them to the
        coordinator."""
        return [row.command.seq for row in self.of(token)] == list(range(1, count + 1))

    def _with(self, row: Row) -> Commands:
        return replace(self, rows={**self.rows, row.command.key: row})


def submitted(commands: Commands, command: Command) -> Commands:
    """Take a command on, which its client has numbered; one that is known stays as it is. Raises ValueError for a known
    key with other content, and for a number that another command of the lease has."""
    known = commands.rows.get(command.key)
    if known is not None:
        if known.command.digest != command.digest:
            raise ValueError(f"{command.key} is recorded with other content")
        return commands
    if any(row.command.seq == command.seq for row in commands.of(command.token)):
        raise ValueError(f"lease {command.token} has another command {command.seq} than {command.key}")
    return commands._with(Row(command))


def answered(commands: Commands, record: Record) -> Commands:
    """Write what the edge says of a command: an end stays, and of what began it is not known yet how it ended."""
    row = commands.rows.get(record.command.key)
    if row is None or row.state not in OPEN or row.command.digest != record.command.digest:
        return commands
    if record.phase == "started":
        return commands
    return commands._with(replace(row, state=record.phase, result=record.result))


def reconciled(commands: Commands, memory: Memory) -> Commands:
    """Bring what is open in line with what the edge remembers, as it says whenever it is heard of. What waits of leases
    below the one that it fenced for, and it has no record of, will never be done."""
    for key, row in commands.rows.items():
        if row.state in OPEN and (known := memory.records.get(key)):
            commands = answered(commands, known)
        elif row.state in OPEN and row.command.token < memory.fenced:
            commands = commands._with(replace(row, state="withdrawn"))
    return commands


def resolved(commands: Commands, key: str, state: State, by: str) -> Commands:
    """Write what a named person says of a command whose end nobody knows; raises ValueError without a name, and for
    one that is no end."""
    row = commands.rows[key]
    if not by.strip() or state in OPEN:
        raise ValueError("whoever settles an unknown end says who they are, and which end it was")
    return commands._with(replace(row, state=state, by=by)) if row.state == "unknown" else commands

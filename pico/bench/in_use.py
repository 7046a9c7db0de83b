"""Whether somebody moves the bench now, how far that is, and what must wait for its end."""

from __future__ import annotations

import json
from contextlib import suppress

from pico.bench.opened import Opened
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning


def moved_by(opened: Opened) -> str:
    """Return who moves the bench, for what, and how many operations of how many are done; empty where nobody does: who
    has it for an instant, without a run, leaves it as one finds it."""
    holder, run = opened.wait(opened.edge.holder()), opened.wait(opened.edge.unended())
    return f"{holder.said}{_far(opened, run)}" if holder and run else ""


def _far(opened: Opened, run: str) -> str:
    """Return `e1, 14 of 25 operations done` of the run that goes on, where that is known."""
    with suppress(PicoError):  # looking must not fail because of the journal
        memory = opened.edge.memory
        document = memory.document(run) if memory else None
        if memory and document:
            plan = json.loads(document)
            ids = {op["id"] for op in plan["operations"]}
            done = {r.key.split("/")[1] for r in memory.records(run=run) if r.kind == "done"}
            goal = plan["target"].get("revision")
            if not ids:  # it is open
                return f", {len(done)} operations done"
            return f"{f' {goal}' if goal else ''}, {len(ids & done)} of {len(ids)} operations done"
    return ""


def goes_on(opened: Opened) -> tuple[Diagnostic, ...]:
    """Return that somebody moves the bench, for who looks at it meanwhile."""
    who = moved_by(opened)
    hint = "what is shown is the bench in between: look again when that is over; `pico stop` ends it safely"
    return (warning("goes-on", f"a run goes on: {who}", hint=hint),) if who else ()


def in_use(opened: Opened, hint: str) -> PicoError | None:
    """Return the error (exit code LOCKED) that somebody moves the bench; None where nobody does."""
    who = moved_by(opened)
    return PicoError(error("locked", f"the bench is in use by {who}", hint=hint), ExitCode.LOCKED) if who else None


def refuse_in_use(opened: Opened) -> None:
    """Raise PicoError (exit code LOCKED) where somebody moves the bench."""
    if found := in_use(opened, "`pico stop` ends it safely"):
        raise found

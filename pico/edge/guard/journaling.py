"""The journal of light that was ended beside any run, by the guard or by a stop: an operation for each device, in the
run under way or in one of its own."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from pico.backends.device import Device
from pico.backends.hardware.guard.note import Ended
from pico.base import clock
from pico.diagnostics import PicoError, error
from pico.edge import emission
from pico.edge.about import about_run
from pico.edge.running import new_run_id
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult, Outcome, Reason
from pico.model.setup import Setup
from pico.runs.journal import Journal, is_locked

LOCKED, AGAIN = 120.0, 2.0
"""For so long a journal that can't be written is tried again, and how often [s]."""


def record_ended(
    setup: Setup, device: Device, path: Path, ended: Ended, under_way: str | None, token: int
) -> None:  # fmt: skip
    """Write into the journal at `path` what became of each device that was to end light: in the run `under_way`, else
    in one of its own. `token`: the last that was given out. Called in a thread of its own, with a connection of its
    own; a journal that another process locks is tried again, for LOCKED seconds. One that can't be written keeps no
    light on, and what moves next says so."""
    operations = list(_operations(ended))
    if not operations:
        return
    run, ends = under_way, time.monotonic() + LOCKED
    while True:
        try:
            with closing(Journal(path)) as journal:
                run = run or _begun(setup, device, journal, [operation for operation, _ in operations], ended)
                _write(journal, run, operations, token, ends_run=under_way is None)
            return
        except PicoError as exc:
            if not is_locked(exc) or time.monotonic() > ends:
                return
        time.sleep(AGAIN)


def _write(
    journal: Journal, run: str, operations: list[tuple[Operation, OperationResult]], token: int, *, ends_run: bool
) -> None:  # fmt: skip
    for operation, result in operations:
        key = f"{run}/{operation.id}/1"
        if journal.intend(key, operation, token) is None:
            journal.started(key, None, token)
            journal.ended(replace(result, key=key), token)
    if ends_run:
        done = sum(result.outcome == "done" for _, result in operations)
        tally = {"done": done, "failed": len(operations) - done}
        journal.end_run(run, "failed" if tally["failed"] else "done", tally)


def _operations(ended: Ended) -> Iterator[tuple[Operation, OperationResult]]:
    at = clock.now()
    why = Reason(kind="interlock", text=f"{ended.by} ended light: {ended.why}")
    for end in ended.ends:
        for one in end.closings:
            component, _, tunable = one.address.partition(".")
            operation = Operation(
                id=f"dark_{component}_{tunable}.{at}", primitive="set", component=component, reason=why,
                arguments={"tunable": tunable, "from": None, "to": "closed" if tunable == "shutter" else False},
                resources=(one.address, component),
            )  # fmt: skip
            wrong = error("not-reached", f"{one.address}: {one.wrong}", address=component) if one.wrong else None
            outcome: Outcome = "done" if one.dark and not one.wrong else "failed"
            yield operation, OperationResult(key="", outcome=outcome, error=wrong)


def _begun(setup: Setup, device: Device, journal: Journal, operations: list[Operation], ended: Ended) -> str:
    able = asyncio.run(device.describe())  # asks no instrument
    seen = Observation(backend=able.name)
    plan = emission.dark_plan(setup, seen, operations, able, f"{ended.by} ended light: {ended.why}")
    run = new_run_id()
    journal.begin_run(run, plan.digest, ended.by, document=plan.to_json(), about=about_run(setup, plan, able))
    return run

"""`pico stop`."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError, error

from ..session import Session
from ..views import stopped as view

if TYPE_CHECKING:
    from pico.runs.journal import RunRecord

PATIENCE = 60.0
"""Seconds that are waited for the run to end."""

Now = Annotated[bool, typer.Option("--now", help="Stop at once: arms brake, shutters close, grippers hold.")]


def stop(context: typer.Context, now: Now = False) -> int:
    """Stop the run that goes on, from any terminal.

    As Ctrl-C in its own would. Nothing more starts; a part in the hand goes to its goal or back, whichever is sooner.
    """
    from pico.backends.lease import BenchLock
    from pico.backends.stopping import ask_to_stop
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    lock = BenchLock(root)
    holder = lock.holder()
    if holder is None:
        session.show(view, None, None)
        return ExitCode.DONE
    ask_to_stop(root, holder.token, "now" if now else "safely")
    until = time.monotonic() + PATIENCE
    while (still := lock.holder()) is not None and still.token == holder.token:
        if time.monotonic() > until:
            text = f"process {holder.pid} was asked to stop and has not ended in {PATIENCE:.0f} s"
            raise PicoError(error("stop", text, hint="`pico stop --now`; else the emergency stop of the arm"))
        time.sleep(0.02)
    session.show(view, holder, _last_run(root))
    return ExitCode.DONE


def _last_run(root: Path) -> RunRecord | None:
    from pico.attachment import bench_folder
    from pico.runs.journal import Journal

    journal = Journal(bench_folder(root) / "journal.sqlite", looking=True)
    try:
        runs = journal.runs()
        return runs[-1] if runs else None
    finally:
        journal.close()

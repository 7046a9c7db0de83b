"""Stopping the run that somebody else's process has under way; it needs no lock, and no lab that can be read."""

from __future__ import annotations

import time
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.edge.lease import BenchLock
from pico.edge.link.opening import remembered
from pico.edge.protocol import Holder
from pico.edge.stopping import ask_to_stop
from pico.manifest.load import find_lab
from pico.runs.journal import RunRecord

PATIENCE = 60.0
"""Seconds that are waited for the run to end."""


def stop(folder: Path, *, now: bool = False) -> tuple[Holder | None, RunRecord | None]:
    """Stop what moves the bench of the lab around `folder`, and wait for its end; `now`: in mid-motion.

    Returns who was stopped (None where nobody has the bench), and the last run. Raises PicoError where it does not end.
    """
    root = find_lab(folder)
    lock = BenchLock(root)
    holder = lock.holder()
    if holder is None:
        return None, None
    ask_to_stop(root, holder.token, "now" if now else "safely")
    until = time.monotonic() + PATIENCE
    while (still := lock.holder()) is not None and still.token == holder.token:
        if time.monotonic() > until:
            text = f"process {holder.pid} was asked to stop and has not ended in {PATIENCE:.0f} s"
            raise PicoError(error("stop", text, hint="`pico stop --now`; else the emergency stop of the arm"))
        time.sleep(0.02)
    with remembered(root) as memory:
        return holder, memory.last() if memory else None

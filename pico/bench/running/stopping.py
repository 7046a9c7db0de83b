"""Stopping the run that somebody else's process has under way; it needs no lock, and no lab that can be read."""

from __future__ import annotations

import time
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.edge.network.opening import holder_of, line_of, remembered
from pico.edge.network.remotes import Far
from pico.edge.protocol import Holder
from pico.edge.stopping import ask_to_stop
from pico.runs.journal import RunRecord

PATIENCE = 60.0
"""Seconds that are waited for the run to end."""


def stop(root: Path, *, now: bool = False, far: Far | None = None) -> tuple[Holder | None, RunRecord | None]:
    """Stop what moves the bench of the lab in `root`, or `far`, and wait for its end; `now`: in mid-motion.

    Returns who was stopped (None where nobody has the bench), and the last run. Raises PicoError where it does not end.
    """
    holder = holder_of(root, far)
    if holder is None:
        return None, None
    _ask(root, far, holder, now)
    until = time.monotonic() + PATIENCE
    while (still := holder_of(root, far)) is not None and still.token == holder.token:
        if time.monotonic() > until:
            text = f"{holder.who} was asked to stop and has not ended in {PATIENCE:.0f} s"
            raise PicoError(error("stop", text, hint="`pico stop --now`; else the emergency stop of the arm"))
        time.sleep(0.02 if far is None else 0.2)
    with remembered(root, far) as memory:
        return holder, memory.last() if memory else None


def _ask(root: Path, far: Far | None, holder: Holder, now: bool) -> None:
    if far is None:
        ask_to_stop(root, holder.token, "now" if now else "safely")
    elif (line := line_of(root, far)) is not None:
        line.call("stop" if now else "halt")

"""What became of a run that was stopped from another terminal."""

from __future__ import annotations

from typing import Any

from pico.edge.protocol import RECORDING, STEERING, Holder
from pico.model.record import as_json
from pico.runs.journal import RunRecord


def text(holder: Holder | None, run: RunRecord | None) -> str:
    """Return who was stopped, how far it came, and what next."""
    if holder is None:
        return "Nothing moves: nobody has the bench."
    lines = [f"Stopped {holder.what} of {holder.who}."]
    if run is not None and run.tally is not None:
        names = {"done": "done", "failed": "not completed", "unknown": "with unknown outcome", "skipped": "not started"}
        counts = {name: int(run.tally.get(end, 0)) for end, name in names.items()}
        lines.append(", ".join(f"{n} {name}" for name, n in counts.items() if n or name == "done") + ".")
    goes_on = "" if holder.what.startswith((STEERING, RECORDING)) else "Continue with `pico resume`; go"
    return "\n".join([*lines, f"{goes_on or 'Go'} back with `pico undo`."])


def data(holder: Holder | None, run: RunRecord | None) -> dict[str, Any]:
    """Return schema `pico.stopped/v1`: the `holder` that was stopped, or none, and its `run`."""
    return {"schema": "pico.stopped/v1", "holder": as_json(holder), "run": as_json(run)}

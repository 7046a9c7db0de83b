"""What became of a run that was stopped from another terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.edge.protocol import RECORDING, STEERING, Holder
from pico.model.record import as_json
from pico.runs.journal import RunRecord


def text(
    holder: Holder | None, run: RunRecord | None, *, bench: str, others: Sequence[tuple[str, Holder]] = (),
    now: bool = False,
) -> str:  # fmt: skip
    """Return who was stopped, how far it came, and what next; if nobody was, which `others` are in use."""
    if holder is None:
        flag = " --now" if now else ""
        said = [f"{name} is in use by {who.said}: `pico --bench {name} stop{flag}` stops it." for name, who in others]
        return "\n".join([f"Nothing moves on {bench}: it is not in use.", *said])
    lines = [f"Stopped {holder.what} of {holder.who}."]
    if run is not None and run.tally is not None:
        names = {"done": "done", "failed": "not completed", "unknown": "with unknown outcome", "skipped": "not started"}
        counts = {name: int(run.tally.get(end, 0)) for end, name in names.items()}
        lines.append(", ".join(f"{n} {name}" for name, n in counts.items() if n or name == "done") + ".")
    goes_on = "" if holder.what.startswith((STEERING, RECORDING)) else "Continue with `pico resume`; go"
    return "\n".join([*lines, f"{goes_on or 'Go'} back with `pico undo`."])


def data(
    holder: Holder | None, run: RunRecord | None, *, bench: str, others: Sequence[tuple[str, Holder]] = (),
    now: bool = False,
) -> dict[str, Any]:  # fmt: skip
    """Return schema `pico.stopped/v1`: the `bench`, the `holder` that was stopped, or none, and its `run`; the `others`
    of this lab that are in use if none was."""
    elsewhere = {name: as_json(who) for name, who in others}
    return {
        "schema": "pico.stopped/v1", "bench": bench, "holder": as_json(holder), "run": as_json(run), "others": elsewhere
    }  # fmt: skip

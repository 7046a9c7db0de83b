"""What became of a run that was stopped from another terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.backends.hardware.guard.note import Ended
from pico.edge.protocol import RECORDING, STEERING, Holder
from pico.model.record import as_json
from pico.runs.journal import RunRecord

from .style import paint

BY_HAND = "Switch it off at its own key."


def text(
    holder: Holder | None, run: RunRecord | None, *, bench: str, others: Sequence[tuple[str, Holder]] = (),
    now: bool = False, light: Ended | None = None,
) -> str:  # fmt: skip
    """Return who was stopped, how far it came, and what next; if nobody was, which `others` are in use. `light`: what
    became of each laser."""
    if holder is None:
        flag = " --now" if now else ""
        said = [f"{name} is in use by {who.said}: `pico --bench {name} stop{flag}` stops it." for name, who in others]
        return "\n".join([f"Nothing moves on {bench}: it is not in use.", *said, *_light(light)])
    lines = [f"Stopped {holder.what} of {holder.who}."]
    if run is not None and run.tally is not None:
        names = {"done": "done", "failed": "not completed", "unknown": "with unknown outcome", "skipped": "not started"}
        counts = {name: int(run.tally.get(end, 0)) for end, name in names.items()}
        lines.append(", ".join(f"{n} {name}" for name, n in counts.items() if n or name == "done") + ".")
    goes_on = "" if holder.what.startswith((STEERING, RECORDING)) else "Continue with `pico resume`; go"
    return "\n".join([*lines, *_light(light), f"{goes_on or 'Go'} back with `pico undo`."])


def _light(light: Ended | None) -> list[str]:
    """Return a line a laser: by which devices it is dark, or that it may still emit."""
    lines = []
    for end in light.ends if light is not None else ():
        dark = ", ".join(one.address for one in end.closings if one.dark)
        wrong = f"; not reached: {end.wrong}" if end.wrong else ""
        if end.is_dark:
            lines.append(f"{end.laser} is dark: {dark} read back{wrong}.")
        else:
            why = end.wrong or "no device closes a shutter of it or switches it off"
            lines.append(paint("red", f"{end.laser} MAY STILL EMIT: {why}. {BY_HAND}"))
    for name in light.disarmed if light is not None else ():
        lines.append(f"The arming of {name} has ended: `pico laser arm {name}` lets its light out again.")
    return lines


def data(
    holder: Holder | None, run: RunRecord | None, *, bench: str, others: Sequence[tuple[str, Holder]] = (),
    now: bool = False, light: Ended | None = None,
) -> dict[str, Any]:  # fmt: skip
    """Return schema `pico.stopped/v1`: the `bench`, the `holder` that was stopped, or none, and its `run`; the `others`
    of this lab that are in use if none was; what became of each laser (`light`) if light was to end."""
    elsewhere = {name: as_json(who) for name, who in others}
    found = {
        "schema": "pico.stopped/v1", "bench": bench, "holder": as_json(holder), "run": as_json(run), "others": elsewhere
    }  # fmt: skip
    if light is not None:
        ends = [{**as_json(end), "dark": end.is_dark} for end in light.ends]
        found["light"] = {"at": light.at, "lasers": ends, "disarmed": list(light.disarmed)}
    return found

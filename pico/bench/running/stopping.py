"""Stopping the run that somebody else's process has under way, and ending light; it needs no lock, and only ending the
light of a bench that no process serves needs a lab that can be read."""

from __future__ import annotations

import asyncio
import time

from pico.backends.devices import EMULATED, HARDWARE
from pico.backends.hardware.guard.note import Ended
from pico.diagnostics import PicoError, error
from pico.edge.network.opening import holder_of, line_of, remembered
from pico.edge.network.remotes import Place
from pico.edge.protocol import Holder
from pico.edge.stopping import ask_to_stop
from pico.places.bench import BenchPlace
from pico.runs.journal import RunRecord

PATIENCE = 60.0
"""Seconds that are waited for the run to end."""


def stop(place: Place, *, now: bool = False) -> tuple[Holder | None, RunRecord | None]:
    """Stop what moves a bench, and wait for its end; `now`: in mid-motion.

    Returns who was stopped (None where nobody has the bench), and the last run. Raises PicoError where it does not end.
    """
    holder = holder_of(place)
    if holder is None:
        return None, None
    _ask(place, holder, now)
    until = time.monotonic() + PATIENCE
    while (still := holder_of(place)) is not None and still.token == holder.token:
        if time.monotonic() > until:
            text = f"{holder.who} was asked to stop and has not ended in {PATIENCE:.0f} s"
            raise PicoError(error("stop", text, hint="`pico stop --now`; else the emergency stop of the arm"))
        time.sleep(0.02 if isinstance(place, BenchPlace) else 0.2)
    with remembered(place) as memory:
        return holder, memory.last() if memory else None


def end_light(place: Place) -> Ended | None:
    """End all light of a bench, whoever has it and whether or not anything moves; return what became of each laser,
    None for a bench that emits nothing. Raises PicoError if that can't even be tried."""
    line = line_of(place)
    if line is not None:
        ended: Ended | None = line.call("end_light")
        return ended
    assert isinstance(place, BenchPlace)
    if place.name not in (HARDWARE, EMULATED) or not place.folder.exists():
        return None
    from pico.edge.link.server import end_light_of

    return asyncio.run(end_light_of(place))


def _ask(place: Place, holder: Holder, now: bool) -> None:
    if isinstance(place, BenchPlace):
        ask_to_stop(place, holder.token, "now" if now else "safely")
    elif (line := line_of(place)) is not None:
        line.call("stop" if now else "halt")


def moved_elsewhere(place: Place) -> tuple[tuple[str, Holder], ...]:
    """Return which other benches of this machine somebody moves, by name, and who."""
    from pico.history.runs.benches import other_benches

    found = ((one.name, holder_of(one)) for one in other_benches(place, place.root))
    return tuple((name, holder) for name, holder in found if holder is not None)

"""Turns a recorded run into a film once it is over; Ctrl-C ends the film where it is, and it can be played."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

from ..session import Session
from ..terminal.waiting import waiting
from ..views import film as view

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.plan import Plan
    from pico.model.trace.event import Event
    from pico.twin.snapshot import Recording


def film(session: Session, bench: Bench, plan: Plan, recording: Recording, events: Sequence[Event], path: Path) -> None:
    """Write the film of a run and say where it is; raises PicoError."""
    from pico.bench.picturing.contents import captions

    done, total = 0, 1
    pictures = bench.moves.film(recording, session.folder / path, captions=captions(events, view.titles(plan)))
    with waiting(f"Filming {path}") as line, closing(pictures):
        try:
            for done, total in pictures:
                line.share = done / total
        except KeyboardInterrupt:
            pass
    if not done:
        session.say("No film: it was interrupted before its first picture.")
        return
    first, last = recording.snapshots[0].time, recording.snapshots[-1].time
    session.show(view, session.folder / path, shown=path, seconds=last - first, share=done / total)

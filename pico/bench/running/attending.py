"""A run that somebody attends: signals end it in order, and what goes wrong beside it never leaves it in mid-motion."""

from __future__ import annotations

import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from pico.bench.running.execution import Execution
from pico.model.trace.event import Event

SAFELY = "Stopping: what is in a hand goes to its goal or back, whichever is sooner (press again to stop at once)"
UNMOVED = "Stopping: what has begun comes to its end, what was set for it is set back (press again to stop at once)"
AT_ONCE = "Stopping at once: arms brake, shutters close, grippers hold what they hold"
DEADLINE = 10.0
"""Seconds after SIGTERM or SIGHUP in which a run may come to its safe end."""
ENDING = (signal.SIGTERM, signal.SIGHUP)
"""Come where nobody can press again, and often more than once: a terminal or a link is gone, a machine shuts down."""


def attend(
    run: Execution, show: Callable[[Event], None] = lambda _: None, say: Callable[[str], None] = lambda _: None
) -> tuple[int, ...]:
    """Iterate a run to its end, showing each event; return the signals that ended it.

    `say` is told what a signal leads to, in its handler. Where `show` raises, the run is halted at a safe waypoint
    before that goes on to the caller.
    """
    with interrupts(run, say) as came:
        try:
            for event in run:
                show(event)
        except BaseException:
            if not run.over:
                run.halt()
                deque(run, maxlen=0)
            raise
    return tuple(came)


@contextmanager
def interrupts(run: Execution, say: Callable[[str], None]) -> Iterator[list[int]]:
    """While a run goes on, let signals end it in order: nothing is raised, the events come to their end.

    SIGINT halts it at a safe waypoint; a second one, or SIGQUIT, stops it at once. SIGTERM and SIGHUP halt it too, and
    stop it after DEADLINE; where they were ignored they stay so, as under nohup. Only the main thread hears signals.
    Yields the signals that came.
    """
    came: list[int] = []
    late = threading.Timer(DEADLINE, run.stop)
    late.daemon = True

    def heard(number: int, _: object) -> None:
        first, at_once = not came, number == signal.SIGQUIT or (number == signal.SIGINT and bool(came))
        ending = number in ENDING and not any(n in ENDING for n in came)
        came.append(number)
        if first or at_once:
            (run.stop if at_once else run.halt)()
        if ending:
            late.start()
        if first or at_once:
            with suppress(OSError):  # who would read it may be gone
                carries = any(op.kind.carries for op in run.plan.operations)
                say(AT_ONCE if at_once else SAFELY if carries else UNMOVED)

    before = listen(heard)
    try:
        yield came
    finally:
        late.cancel()
        for number, handler in before.items():
            signal.signal(number, handler)


def listen(heard: Callable[[int, Any], None]) -> dict[int, Any]:
    """Have `heard` called for the signals that end a run; return what they did before, to be brought back."""
    if threading.current_thread() is not threading.main_thread():
        return {}
    before: dict[int, Any] = {n: signal.getsignal(n) for n in (signal.SIGINT, signal.SIGQUIT, *ENDING)}
    kept = {n: h for n, h in before.items() if h is not None and not (n in ENDING and h == signal.SIG_IGN)}
    for number in kept:
        signal.signal(number, heard)
    return kept

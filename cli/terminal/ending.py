"""SIGTERM and SIGHUP end a command as Ctrl-C does: what is half done is tidied away, and the exit code says so."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager

ENDING = (signal.SIGTERM, signal.SIGHUP)


class Ended(KeyboardInterrupt):
    """Somebody, or the system, wants the command to be over, and nobody may be there to press again."""


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Raise `Ended` where SIGTERM or SIGHUP comes, once; those that are ignored stay so, as under nohup."""

    def heard(*_: object) -> None:
        for number in before:
            signal.signal(number, lambda *_: None)  # a terminal that closes sends more than one
        raise Ended

    before = {n: h for n in ENDING if (h := signal.getsignal(n)) is not signal.SIG_IGN}
    for number in before:
        signal.signal(number, heard)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)

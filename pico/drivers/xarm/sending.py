"""`python -m pico.drivers.xarm.sending`: sends an arm's set-points, and does nothing else; see `sender.py`.

It reads pickled tuples from standard input, of the process that started it: `("open", host, port)`,
`("follow", number, name, path, doing, pace)`, `("end", number, how)` and `("beat",)`; and answers on standard output:
`("opened", what is wrong)`, and of each path, by its number, `("sends", number, sent)` ten times a second and once
`("ended", number, sent, how, why)`, `("fault", number, sent, diagnostics)` or `("lost", number, sent, why)`.

If its input ends, the arm comes to rest on its path; if it says nothing for RESTS, too, until it says something again.
Meanwhile the control box is not judged by its silence: of an emulated one, which may live in the process that stands
still, that would be no wonder, and no arm moves.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import threading
import time
from contextlib import suppress
from typing import Any, BinaryIO

from pico.base.awake import Awake
from pico.diagnostics import PicoError
from pico.drivers.path import Path
from pico.drivers.xarm.library import library
from pico.drivers.xarm.link import Link
from pico.drivers.xarm.sender import BEAT, ENDS, PAUSE, RESTS
from pico.drivers.xarm.streaming import BRAKE, How, Stream


class Sending:
    """Obeys one process, and tells it what became of each path."""

    def __init__(self, out: BinaryIO) -> None:
        self._out, self._telling = out, threading.Lock()
        self._link: Link | None = None
        self._now: tuple[int, Stream] | None = None
        self._clock, self._parent = Awake(time.monotonic, PAUSE), os.getppid()
        self._heard = self._clock.now()

    def serve(self, inbox: BinaryIO) -> None:
        """Obey until the input ends; then come to rest."""
        threading.Thread(target=self._watch, daemon=True, name="watch").start()
        with suppress(EOFError, OSError):
            while True:
                what, *words = pickle.load(inbox)
                self._heard = self._clock.now()
                if what != "beat":
                    getattr(self, f"_{what}")(*words)
        self._rest()

    def _open(self, host: str, port: int) -> None:
        if self._link is not None:
            self._link.close()
        self._link, wrong = None, ""
        try:
            self._link = Link.opened(host, port)
            self._link.arm.set_timeout(ENDS)  # a box that is silent for less is found out by `_watch`
        except Exception as exc:
            wrong = str(exc) or type(exc).__name__
        self._tell("opened", wrong)

    def _follow(self, number: int, name: str, path: Path, doing: str, pace: float) -> None:
        assert self._link is not None
        stream = Stream(name, self._link, path, doing=doing, pace=pace, set_points=True)
        self._now = number, stream
        stream.done.add_done_callback(lambda _: self._ended(number, stream))
        stream.start()

    def _end(self, number: int, how: How) -> None:
        if self._now and self._now[0] == number:
            self._now[1].end(how)

    def _rest(self) -> None:
        if self._now:
            self._now[1].end("halted")
            self._now[1].join(4 * BRAKE)
        if self._link is not None:
            self._link.close()

    def _watch(self) -> None:
        """Say that it is alive, and end what moves if nobody else is, or if the control box is silent, for a request
        may hang in it."""
        while True:
            time.sleep(BEAT / 2)
            age = self._clock.now() - self._heard
            moves = self._now is not None and not self._now[1].done.done()
            if os.getppid() != self._parent and not moves:
                os._exit(0)  # its input stays open if a process that was forked off has a copy
            if not moves or self._now is None:
                continue
            number, stream = self._now
            self._tell("sends", number, stream.sent)
            stream.rests = age > RESTS
            if stream.rests:
                stream.link.excuse()
            if age > ENDS:
                stream.why = f"PICO itself did not run for {age:.1f} s"
                stream.end("halted")
            try:
                stream.require_alive()
            except ConnectionError as exc:
                stream.end("stopped")
                self._finish("lost", number, stream.sent, str(exc))

    def _ended(self, number: int, stream: Stream) -> None:
        try:
            how = stream.done.result()
        except PicoError as exc:
            self._finish("fault", number, stream.sent, tuple(exc.diagnostics))
        except ConnectionError as exc:
            self._finish("lost", number, stream.sent, str(exc))
        else:
            self._finish("ended", number, stream.sent, how, stream.why)

    def _finish(self, what: str, number: int, *words: Any) -> None:
        """Tell how a path ended, once."""
        with self._telling:
            if self._now is None or self._now[0] != number:
                return
            self._now = None
        self._tell(what, number, *words)

    def _tell(self, *message: Any) -> None:
        with self._telling, suppress(OSError):  # who started it is gone: its input ends, too
            pickle.dump(message, self._out)
            self._out.flush()


def main() -> None:
    """Serve the process that started this one."""
    for name in ("SIGINT", "SIGHUP"):  # keys of a terminal: who started it ends the motion, and closes the pipe
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    out = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # whatever the library prints is no message
    library()
    Sending(out).serve(sys.stdin.buffer)


if __name__ == "__main__":
    main()

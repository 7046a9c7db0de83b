"""The process that sends the set-points of one arm, as the process sees it that wants the arm to move.

Set-points are due every 4 ms, and a thread of a Python process that computes beside them gets its turn every 80 ms or
so. So they are sent by a process that does nothing else (`sending.py`), over a connection of its own. It is started
once, before the first motion. What it says of itself comes back over a pipe, and both sides say ten times a second that
they are alive. If this process is gone, the arm comes to rest on its path; if it stands still, too, and goes on where
it was once this process does, within ENDS. If the other process is gone or stands still, no set-point comes any more:
the arm stands, and the operation fails. A stop does not depend on it: this process keeps a connection of its own, and
stops the control box over that once the other came to rest, or had its time and was killed.
"""

from __future__ import annotations

import pickle
import queue
import subprocess
import sys
import threading
import time
from concurrent.futures import Future, wait
from contextlib import suppress
from typing import Any

from pico.base.awake import Awake
from pico.diagnostics import PicoError
from pico.drivers.path import Path
from pico.drivers.xarm.link import Link
from pico.drivers.xarm.streaming import How

BEAT = 0.1
"""How often each side says that it is alive while the arm moves [s]."""
SILENT = 0.5
"""How long the process that sends may say nothing [s], by the time in which this one was running itself."""
RESTS = 0.3
"""How long this process may say nothing until the arm comes to rest [s]; three beats."""
ENDS = 3.0
"""How long it may say nothing until the motion is over [s]: what the bench looks like by then it does not know."""
PAUSE = 0.3
"""The most that a pause of the listener itself counts [s]; more than it takes between two looks."""
STARTING = 4.0
"""How long it may take until the process runs and has its connection [s]."""
MODULE = "pico.drivers.xarm.sending"


class SenderLost(Exception):
    """The process that sends set-points is gone, or says nothing; as text, what became of it."""


class Sender:
    """A process that sends set-points. `open` comes before `follow`, and anew for each link of the driver's own."""

    def __init__(self) -> None:
        """Start it, without waiting until it runs."""
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", MODULE],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        self.pid = self._process.pid
        self.link: Link | None = None
        """The link of the driver for which its own connection was opened."""
        self._outbox: queue.SimpleQueue[tuple[Any, ...] | None] = queue.SimpleQueue()
        self._opening: Future[str] | None = None
        self._stream: SentStream | None = None
        self._count = 0
        self._gone = ""
        self._clock = Awake(time.monotonic, PAUSE)
        self._heard = self._clock.now()
        for work in (self._write, self._read):
            threading.Thread(target=work, daemon=True, name="set-points").start()

    def open(self, link: Link, host: str, port: int) -> None:
        """Have it connect to the control box; raises ConnectionError if none answers, SenderLost if it does not."""
        if self.link is link:
            self.require_alive(asked=False)
            return
        self._opening = Future()
        if not self._gone:
            self._outbox.put(("open", host, port))
        else:
            self._opening.set_result("")
        try:
            wrong = self._opening.result(STARTING)
        except TimeoutError as exc:
            self.kill()
            raise SenderLost(f"did not start within {STARTING:g} s") from exc
        self.require_alive(asked=False)
        if wrong:
            raise ConnectionError(wrong)
        self.link = link

    def follow(self, name: str, path: Path, *, doing: str, pace: float) -> SentStream:
        """Begin to send the set-points of a path, over the connection that `open` made."""
        assert self.link is not None
        self._count += 1
        self._heard = self._clock.now()
        self._stream = SentStream(self, self._count, self.link)
        self.say("follow", self._count, name, path, doing, pace)
        if self._gone:
            self._stream.fail(SenderLost(self._gone))
        return self._stream

    def say(self, *message: Any) -> None:
        """Send it a message, without waiting."""
        self._outbox.put(message)

    def require_alive(self, *, asked: bool = True) -> None:
        """Raise SenderLost if it is gone, or, where it was `asked` to say so, has said nothing for SILENT."""
        if self._gone:
            raise SenderLost(self._gone)
        if asked and (age := self._clock.now() - self._heard) > SILENT:
            raise SenderLost(f"said nothing for {age:.1f} s")

    def kill(self) -> None:
        """End it now: it sends nothing more."""
        with suppress(OSError):
            self._process.kill()

    def close(self) -> None:
        """Let it end by itself: what moves comes to rest."""
        self._outbox.put(None)

    def _write(self) -> None:
        pipe = self._process.stdin
        assert pipe is not None
        with suppress(OSError):  # it is gone: the thread that reads says so
            while (message := self._next()) is not None:
                pickle.dump(message, pipe)
                pipe.flush()
        with suppress(OSError):
            pipe.close()

    def _next(self) -> tuple[Any, ...] | None:
        moves = self._stream is not None and not self._stream.done.done()
        try:
            return self._outbox.get(timeout=BEAT if moves else None)
        except queue.Empty:
            return ("beat",)

    def _read(self) -> None:
        pipe = self._process.stdout
        assert pipe is not None
        with suppress(EOFError, OSError, pickle.UnpicklingError):
            while True:
                what, *words = pickle.load(pipe)
                self._heard = self._clock.now()
                if what == "opened" and self._opening is not None and not self._opening.done():
                    self._opening.set_result(words[0])
                elif self._stream is not None and words[0] == self._stream.number:
                    self._stream.hear(what, *words[1:])
        self.kill()
        self._gone = f"ended (exit code {self._process.wait()})"
        pipe.close()
        self.close()
        if self._opening is not None and not self._opening.done():
            self._opening.set_result("")
        if self._stream is not None:
            self._stream.fail(SenderLost(self._gone))


class SentStream:
    """A path on which another process sends an arm, see `Stream`. It fails with SenderLost, too."""

    def __init__(self, sender: Sender, number: int, link: Link) -> None:
        self.done: Future[How] = Future()
        self.sent = 0
        """Set-points that the control box took, as far as reported."""
        self.why = ""
        """Why it came to rest, if the process that sends it decided that."""
        self.number, self.link = number, link
        self._sender = sender
        self._wanted: How = "moves"

    def end(self, how: How) -> None:
        """Let it come to rest on the path, now."""
        self._wanted = how
        self._sender.say("end", self.number, how)

    def join(self, within: float) -> None:
        """Wait until nothing more is sent: a process that does not come to that within this time [s] is killed."""
        if not wait([self.done], within).done:
            self._sender.kill()
            wait([self.done], within)

    def require_alive(self) -> None:
        """Raise SenderLost if nothing is heard of the process, ConnectionError if the driver's own link is silent."""
        self._sender.require_alive()
        self.link.require_heard()

    def hear(self, what: str, sent: int, said: Any = None, why: str = "") -> None:
        """Take what the process says of it."""
        self.sent, self.why = sent, why
        if self.done.done() or what == "sends":
            return
        if what == "ended":
            self.done.set_result(said)
        else:
            self.done.set_exception(PicoError(said) if what == "fault" else ConnectionError(said))

    def fail(self, why: SenderLost) -> None:
        """Take that the process is gone; one that was to end has ended."""
        if not self.done.done():
            self.done.set_exception(why) if self._wanted == "moves" else self.done.set_result(self._wanted)

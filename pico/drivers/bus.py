"""One worker thread a bus: vendors' libraries block, so all calls of what shares a link queue here, with deadlines.

A call that does not return in time is told as late, and its thread is abandoned: the link is closed under it, so that
nothing more is sent by it, and opened anew for the next call. Nobody waits longer than LONGEST. A link that tells of
itself whether it is alive is looked after while nobody asks anything, too. Seconds throughout.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, Generic, TypeVar

from pico.diagnostics import PicoError, error
from pico.plug_ins.faults import blamed

H = TypeVar("H")
T = TypeVar("T")
LONGEST = 5.0
"""Nobody waits longer than this for a call, its turn included [s]."""
USUAL = 2.0
"""How long a call may take, where its driver says nothing else [s]."""
_AGAIN = 0.05
"""How often one who waits for its turn looks whether the call ahead is overdue [s]."""
BEAT = 0.2
"""How often a link is looked after while nobody asks anything [s]."""


@dataclass(eq=False)
class _Call:
    steps: tuple[Callable[[Any], Any], ...]
    within: float
    put: float
    done: Future[Any] = field(default_factory=Future)
    began: float | None = None

    def left(self, now: float) -> float:
        """How long it may still be waited for [s]; below zero it is overdue."""
        latest = self.put + LONGEST
        return (latest if self.began is None else min(latest, self.began + self.within)) - now


class _Worker(Generic[H]):
    """A thread that does calls over one link, until it is told to leave; `lost` is told why the link was lost."""

    def __init__(
        self, opened: Callable[[], H], closed: Callable[[H], object], calls: deque[_Call],
        alive: Callable[[H], object] | None, lost: Callable[[str], object],
    ) -> None:  # fmt: skip
        self._opened, self._closed, self._alive, self._lost = opened, closed, alive, lost
        self.calls = calls
        self.now: _Call | None = None
        self.changed = threading.Condition()
        self.leaving = False
        self._link: H | None = None
        self.thread = threading.Thread(target=self._work, daemon=True, name="pico-bus")
        self.thread.start()

    def put(self, call: _Call, first: bool) -> None:
        with self.changed:
            (self.calls.appendleft if first else self.calls.append)(call)
            self.changed.notify()

    def leave(self) -> deque[_Call]:
        """Let the thread end after what it does now, with the link closed under it; returns what has not begun."""
        with self.changed:
            self.leaving = True
            left, self.calls = self.calls, deque()
            link = self._link
            self.changed.notify()
        if link is not None:  # what hangs in a read comes back; closing may hang, too
            threading.Thread(target=self._close, args=(link,), daemon=True).start()
        return left

    def _next(self) -> _Call | None:
        while True:
            with self.changed:
                if not self.calls and not self.leaving:
                    self.changed.wait(BEAT if self._alive and self._link is not None else None)
                if self.calls or self.leaving:
                    self.now = None if self.leaving else self.calls.popleft()
                    if self.now:
                        self.now.began = time.monotonic()
                    return self.now
            self._beat()

    def _beat(self) -> None:
        """Let go of a link that is not alive any more, nor a moment later: what it said may not be read yet, where
        this machine is busy."""
        link = self._link
        for last in (False, True):
            try:
                if self._alive and link is not None:
                    self._alive(link)
                return
            except Exception as exc:
                self._drop(exc) if last else time.sleep(BEAT / 2)

    def _work(self) -> None:
        while call := self._next():
            if not call.done.set_running_or_notify_cancel():
                continue
            try:
                result = self._done(call)
            except BaseException as exc:
                if not isinstance(exc, PicoError):  # what a device says is no reason to distrust its link
                    self._drop(exc)
                call.done.set_exception(exc)
            else:
                call.done.set_result(result)
        self._drop()

    def _done(self, call: _Call) -> object:
        """Return what the last step of a call gives. Who was abandoned in one of them does not begin the next."""
        result: object = None
        for step in (self._open, *call.steps):
            result = step(self._link)
            if self.leaving:
                raise TimeoutError("its answer came too late")
        return result

    def _open(self, link: H | None) -> None:
        if link is not None:
            self._beat()
        if self._link is None:
            self._link = self._opened()

    def _drop(self, why: BaseException | None = None) -> None:
        link, self._link = self._link, None
        if link is not None:
            if why is not None:
                self._lost(str(why) or type(why).__name__)
            self._close(link)

    def _close(self, link: H) -> None:
        with suppress(Exception):
            self._closed(link)


class Bus(Generic[H]):
    """A link that one or more devices share: `opened` opens it, `closed` closes it, also while a call hangs in it; both
    may block. It is opened by the first call, and anew after each that failed otherwise than by a PicoError. `alive`
    raises where the link is not any more, without asking over it: called before each call, and every BEAT while nobody
    asks anything.
    `lost` says why the link before this one was lost, '' where none was."""

    def __init__(
        self, opened: Callable[[], H], closed: Callable[[H], object], alive: Callable[[H], object] | None = None
    ) -> None:
        self._opened, self._closed, self._alive = opened, closed, alive
        self.lost = ""
        self._worker: _Worker[H] | None = None
        self._lock = threading.Lock()
        self._users: set[object] = set()

    def use(self, user: object) -> None:
        """Keep the link open until this user, too, lets go of it."""
        self._users.add(user)

    async def let_go(self, user: object) -> None:
        """Close the link where nobody else uses it."""
        self._users.discard(user)
        if not self._users:
            await self.close()

    async def ask(
        self, name: str, what: str, run: Callable[[H], T], *,
        before: Callable[[H], object] = lambda link: None, within: float = USUAL, first: bool = False,
    ) -> T:  # fmt: skip
        """Return what `run` gives with the open link, in the bus's own thread, after `before`; `first`: before all that
        wait for their turn.

        Raises PicoError, about device `name` that was asked to do `what`, where that takes longer than `within` (from
        when it began; opening the link included), where its turn does not come, and for whatever `run` raises.
        """
        call = _Call((before, run), within, time.monotonic())
        self._hired().put(call, first)
        waiting = asyncio.wrap_future(call.done)
        try:
            while not waiting.done():
                left = call.left(time.monotonic())
                if left <= 0:
                    self._require_prompt()
                    raise _late(name, what, call)
                await asyncio.wait([waiting], timeout=left if call.began is not None else min(left, _AGAIN))
                if call.began is None:
                    self._require_prompt()
        except BaseException:
            waiting.cancel()  # what has not begun never does
            raise
        try:
            return waiting.result()  # type: ignore[no-any-return]
        except PicoError:
            raise
        except asyncio.CancelledError as exc:
            raise PicoError(error("device-closed", f"{name} was let go before it could {what}", address=name)) from exc
        except Exception as exc:
            said = str(exc) or type(exc).__name__
            text = f"{name} failed when it was asked to {what}: {said}"
            if (mistake := blamed(exc)) is not None and not isinstance(exc, OSError):  # a lost link is no mistake
                text = f"{name} failed when it was asked to {what}: {mistake.summary}"
                raise PicoError(replace(mistake, summary=text, address=name)) from exc
            raise PicoError(error("device-lost", text, hint=_HINT, address=name)) from exc

    async def close(self) -> None:
        """Close the link; what waits for its turn is cancelled. It opens again for the next call."""
        with self._lock:
            worker, self._worker = self._worker, None
        if worker is None:
            return
        for call in worker.leave():
            call.done.cancel()
        await asyncio.to_thread(worker.thread.join, USUAL)

    def _hired(self) -> _Worker[H]:
        with self._lock:
            if self._worker is None:
                self._worker = self._hire(deque())
            return self._worker

    def _hire(self, calls: deque[_Call]) -> _Worker[H]:
        return _Worker(self._opened, self._closed, calls, self._alive, lambda why: setattr(self, "lost", why))

    def _require_prompt(self) -> None:
        """Abandon the thread where its call is overdue; another one takes what waits."""
        with self._lock:
            worker = self._worker
            now = worker.now if worker else None
            if worker and now and not now.done.done() and now.left(time.monotonic()) <= 0:
                self.lost = "it did not answer in time"
                self._worker = self._hire(worker.leave())


_HINT = "check its cable, power and address; `pico devices check` asks all of them"


def _late(name: str, what: str, call: _Call) -> PicoError:
    if call.began is None:
        text = f"{name} was not asked to {what}: its bus was busy for {LONGEST:g} s"
    else:
        text = f"{name} did not answer within {min(call.within, LONGEST):g} s when it was asked to {what}"
    return PicoError(error("device-late", text, hint=_HINT, address=name))

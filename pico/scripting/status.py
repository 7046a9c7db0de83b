"""What was asked for and may not be over yet, as ophyd and bluesky know it; one thing at a time moves the bench."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import TimeoutError as NotYet
from typing import Any, Generic, TypeVar

T = TypeVar("T")


class Status(Generic[T]):
    """Something under way on a bench: `done`, then `success`; its `result` once it is over.

    >>> status = bench["p1"].angle.set(10)
    >>> status.wait()
    """

    def __init__(self, future: Future[T], what: str, halt: Callable[[], None] = lambda: None) -> None:
        """`what` it is, in words; `halt` brings it to its safe end."""
        self._future, self._what, self._halt = future, what, halt

    def __repr__(self) -> str:
        how = "done" if self.success else "failed" if self.done else "under way"
        return f"<{self._what}: {how}>"

    @property
    def done(self) -> bool:
        """Whether it is over, well or not."""
        return self._future.done()

    @property
    def success(self) -> bool:
        """Whether it is over, and went well."""
        return self._future.done() and self._future.exception() is None

    @property
    def result(self) -> T:
        """What came of it, waiting for its end; raises what went wrong."""
        self.wait()
        return self._future.result()

    def add_callback(self, callback: Callable[[Status[T]], None]) -> None:
        """Call `callback` with this once it is over, at once where it is."""
        self._future.add_done_callback(lambda _: callback(self))

    def exception(self, timeout: float | None = 0.0) -> BaseException | None:
        """Return what went wrong, None for nothing; raises TimeoutError where it is not over in `timeout` seconds."""
        return self._future.exception(timeout)

    def wait(self, timeout: float | None = None) -> None:
        """Wait for its end; raises what went wrong (PicoError), and TimeoutError where it is not over in `timeout`
        seconds. Ctrl-C halts it at a safe end before it goes on to the caller."""
        try:
            self._future.result(timeout)
        except KeyboardInterrupt:
            self._halt()
            self._future.exception()
            raise
        except NotYet:
            if self._future.done():
                raise
            raise TimeoutError(f"{self._what} is not over after {timeout:g} s") from None


class Queue:
    """A thread that does one thing after the other, started when something is first asked of it."""

    def __init__(self) -> None:
        self._pool: ThreadPoolExecutor | None = None
        self._last: Future[Any] | None = None
        self._lock = threading.Lock()

    def ask(self, work: Callable[[], T]) -> Future[T]:
        """Have `work` done after what was asked for before, and return its future."""
        with self._lock:
            if self._pool is None:
                self._pool = ThreadPoolExecutor(1, "pico script")
            future = self._pool.submit(work)
            self._last = future
            return future

    @property
    def busy(self) -> bool:
        """Whether something that was asked for is not over."""
        return self._last is not None and not self._last.done()

    def idle(self) -> None:
        """Wait until all that was asked for is over, whatever came of it; in the thread itself at once."""
        last = self._last
        if last is not None and not threading.current_thread().name.startswith("pico script"):
            last.exception()

    def close(self) -> None:
        """Wait for what is under way, and end the thread."""
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None

"""The coordinator of `pico gui` among those that a checkout knows: it is one of them while its process lives.

It may be killed, and then puts nothing back. So its process holds a kernel lock, and whoever next asks for the
coordinators of the checkout puts back what it finds left over.
"""

from __future__ import annotations

import fcntl
import os
import time
from contextlib import suppress
from dataclasses import replace

from pico.base.state_files import PAGE_LOCK
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.network import remotes
from pico.edge.network.tokens import keep_token
from pico.places.bench import BenchPlace

ASKED_WITHIN = 20
"""Hundredths of a second in which others see whether the lock is held."""


class OwnPage:
    """The coordinator at `url` as the one that serves the bench at `place`, until `end`; raises PicoError (exit code
    LOCKED) if another page has it."""

    def __init__(self, place: BenchPlace, url: str) -> None:
        root = place.root
        self._place, self._url = place, url
        path = remotes.lock_of_page(root)
        self._lock = PAGE_LOCK.lock(path)
        try:
            _take(self._lock)
            known = remotes.left_over_put_back(root)
            named = {**known.named, remotes.PAGE: remotes.Remote(url)}
            remotes.keep(root, replace(known, named=named))
        except BlockingIOError:
            os.close(self._lock)
            text, hint = "another `pico gui` has this bench", "open that one in the browser, or end it"
            raise PicoError(error("locked", text, hint=hint), ExitCode.LOCKED) from None
        except PicoError:
            os.close(self._lock)
            raise

    def mean(self, bench: str, secret: str) -> None:
        """Let commands that mean the bench reach it as `bench` (LAB/BENCH) there, by `secret`; raises PicoError."""
        keep_token(self._url, secret)
        known = remotes.known(self._place.root)
        if remotes.PAGE in known.named:
            remotes.keep(self._place.root, replace(known, page=(self._place.name, bench)))

    def end(self) -> None:
        """Put back what was before; raises PicoError."""
        try:
            remotes.put_back(self._place.root, self._url)
        finally:
            os.close(self._lock)


def _take(lock: int) -> None:
    """Lock; who only asks whether it is locked has it for an instant, and does not count."""
    for _ in range(ASKED_WITHIN):
        with suppress(BlockingIOError):
            return fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        time.sleep(0.01)
    return fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)

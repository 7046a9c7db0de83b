"""One who watches a bench: events in order, none left out, and the latest frame alone."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable

MOST = 2000
"""Events that wait for somebody who does not take them; beyond, the watcher is `lost`, and is to begin anew."""


class Watcher:
    """What waits to be sent to one who watches."""

    def __init__(self) -> None:
        self.news, self.lost = asyncio.Event(), False
        self._texts: deque[str] = deque()
        self._frame: bytes | None = None

    def tell(self, text: str) -> None:
        """Let an event be sent, after those before it."""
        self.lost = self.lost or len(self._texts) >= MOST
        if not self.lost:
            self._texts.append(text)
        self.news.set()

    def show(self, frame: bytes, whole: Callable[[], bytes]) -> None:
        """Let a frame be sent; where the one before was not sent yet, `whole` takes the place of both."""
        self._frame = frame if self._frame is None else whole()
        self.news.set()

    def forget(self) -> None:
        """Let the frame that waits not be sent: it is of another scene."""
        self._frame = None

    def taken(self) -> list[str | bytes]:
        """Return what is to be sent now, events first."""
        self.news.clear()
        found: list[str | bytes] = [*self._texts, *([self._frame] if self._frame is not None else [])]
        self._texts.clear()
        self._frame = None
        return found

"""What an emulator says over a wire: a serial line that is a pseudo-terminal. One thread each."""

from __future__ import annotations

import os
import selectors
import threading
from typing import Protocol

PAUSE = 0.005
"""How often a device is asked whether it has anything to say by itself [s]."""


class Conversation(Protocol):
    """What a device says to one who is connected; called from one thread."""

    def heard(self, data: bytes) -> bytes:
        """Return what is answered to these bytes; commands may come in pieces."""
        ...

    def due(self) -> bytes:
        """Return what the device says by itself by now."""
        ...


class _Served:
    def __init__(self) -> None:
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True, name="pico-emulator")

    def _serve(self) -> None:
        raise NotImplementedError

    def close(self) -> None:
        """End it; whoever is connected is cut off."""
        self._closing.set()
        self._thread.join(2)


class SerialServed(_Served):
    """A conversation on a serial line that exists nowhere but in this machine."""

    def __init__(self, conversation: Conversation) -> None:
        super().__init__()
        import tty

        self._conversation = conversation
        self._ours, self._theirs = os.openpty()  # theirs stays open: the line is there while nobody has it open
        tty.setraw(self._theirs)
        self.address: dict[str, str | int] = {"port": os.ttyname(self._theirs)}
        self._thread.start()

    def _serve(self) -> None:
        with selectors.DefaultSelector() as waiting:
            waiting.register(self._ours, selectors.EVENT_READ)
            while not self._closing.is_set():
                said = b""
                if waiting.select(PAUSE):
                    said = self._conversation.heard(os.read(self._ours, 4096))
                if said := said + self._conversation.due():
                    os.write(self._ours, said)
        os.close(self._ours)
        os.close(self._theirs)

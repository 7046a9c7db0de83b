"""What an emulator says over a wire: a TCP port of 127.0.0.1, or a serial line (a pseudo-terminal). One thread each."""

from __future__ import annotations

import os
import selectors
import socket
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from pico.emulators.disturbance import Line

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


class _Served(ABC):
    def __init__(self) -> None:
        self._closing = threading.Event()
        self.line: Line | None = None
        self.reboot: Callable[[], None] = lambda: None
        """What the device forgets when it restarts."""
        self._thread = threading.Thread(target=self._serve, daemon=True, name="pico-emulator")

    def _heard(self, conversation: Conversation, data: bytes) -> bytes:
        """Return what is on the wire once `data` was heard, or nothing was (b"")."""
        line = self.line
        if line is None:
            return conversation.heard(data) if data else conversation.due()
        if data and not line.hears():
            return b""
        return line.sent(conversation.heard(data) if data else conversation.due())

    @abstractmethod
    def _serve(self) -> None: ...

    def close(self) -> None:
        """End it; whoever is connected is cut off."""
        self._closing.set()
        self._thread.join(2)


class TcpServed(_Served):
    """Conversations on a port of 127.0.0.1, a new one for each who connects."""

    def __init__(self, conversation: Callable[[], Conversation]) -> None:
        super().__init__()
        self._conversation = conversation
        self._listening = socket.create_server(("127.0.0.1", 0))
        self._listening.setblocking(False)
        self.address: dict[str, str | int] = {"host": "127.0.0.1", "port": self._listening.getsockname()[1]}
        self._thread.start()

    def idle(self) -> None:
        """What the device does by itself, also where nobody is connected; called all the time."""

    def _serve(self) -> None:
        with selectors.DefaultSelector() as waiting, self._listening:
            waiting.register(self._listening, selectors.EVENT_READ)
            open_: dict[socket.socket, Conversation] = {}
            while not self._closing.is_set():
                for key, _ in waiting.select(PAUSE):
                    if key.fileobj is self._listening:
                        with suppress(OSError):
                            link, _ = self._listening.accept()
                            link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                            waiting.register(link, selectors.EVENT_READ)
                            open_[link] = self._conversation()
                    elif isinstance(key.fileobj, socket.socket):
                        self._answer(key.fileobj, open_, waiting)
                self.idle()
                for link, conversation in list(open_.items()):
                    if said := self._heard(conversation, b""):
                        with suppress(OSError):
                            link.sendall(said)
            for link in open_:
                link.close()

    def _answer(
        self, link: socket.socket, open_: dict[socket.socket, Conversation], waiting: selectors.BaseSelector
    ) -> None:  # fmt: skip
        try:
            data = link.recv(65536)
            if data:
                link.sendall(self._heard(open_[link], data))
        except OSError:
            data = b""
        if not data:
            waiting.unregister(link)
            del open_[link]
            link.close()


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
                    said = self._heard(self._conversation, os.read(self._ours, 4096))
                if said := said + self._heard(self._conversation, b""):
                    os.write(self._ours, said)
        os.close(self._ours)
        os.close(self._theirs)

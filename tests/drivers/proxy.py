"""What goes wrong on a wire: a proxy between a client and an emulator, on a TCP port or a serial line, that drops,
delays, duplicates, truncates and garbles what the device says, freezes, cuts the link, or takes nobody (`gone`)."""

from __future__ import annotations

import os
import selectors
import socket
import threading
import tty
from collections.abc import Callable
from contextlib import suppress
from typing import Literal

Fault = Literal["none", "dropped", "delayed", "duplicated", "truncated", "garbage", "frozen", "gone"]
FAULTS: tuple[Fault, ...] = ("dropped", "delayed", "duplicated", "truncated", "garbage", "frozen")
LATE = 2.5
"""How much later a delayed reply comes [s]: after the client has given up on it."""


class Faults:
    """What happens to replies: `fault` to each, while it is set."""

    def __init__(self) -> None:
        self.fault: Fault = "none"
        self.heard: list[bytes] = []

    def said(self, data: bytes, send: Callable[[bytes], object]) -> None:
        """Let the client have a reply, as it becomes."""
        if self.fault == "delayed":
            later = threading.Timer(LATE, lambda: _quietly(send, data))
            later.daemon = True
            later.start()
        elif self.fault == "duplicated":
            send(data + data)
        elif self.fault == "truncated":
            send(data[: len(data) // 2])
        elif self.fault == "garbage":
            send(bytes(0x80 | b for b in data[:-1]) + data[-1:])
        elif self.fault == "none":
            send(data)


def _quietly(send: Callable[[bytes], object], data: bytes) -> None:
    with suppress(OSError, ValueError):
        send(data)


class Proxy:
    """A link in between; `address` is what the client opens."""

    def __init__(self, address: dict[str, str | int], faults: Faults) -> None:
        self.faults, self._closing = faults, threading.Event()
        visa = str(address.get("visa", ""))
        host, port = ("127.0.0.1", int(visa.split("::")[2])) if visa else (address.get("host"), address["port"])
        self._back = (str(host), int(port)) if host else None
        self._line = None if host else str(port)
        if host:
            self._listening = socket.create_server(("127.0.0.1", 0))
            front = self._listening.getsockname()[1]
            self.address: dict[str, str | int] = {"visa": f"TCPIP0::127.0.0.1::{front}::SOCKET"} if visa else {
                "host": "127.0.0.1", "port": front}  # fmt: skip
        else:
            self._ours, self._theirs = os.openpty()
            tty.setraw(self._theirs)
            self.address = {"port": os.ttyname(self._theirs)}
        self._pairs: list[tuple[socket.socket, socket.socket]] = []
        self._thread = threading.Thread(target=self._tcp if host else self._serial, daemon=True)
        self._thread.start()

    def cut(self) -> None:
        """Cut all that are connected; they may connect again. A serial line can't be cut."""
        for pair in self._pairs:
            for link in pair:
                with suppress(OSError):
                    link.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        self._closing.set()
        self._thread.join(2)

    def _tcp(self) -> None:
        assert self._back
        self._listening.setblocking(False)
        with selectors.DefaultSelector() as waiting, self._listening:
            waiting.register(self._listening, selectors.EVENT_READ, None)
            while not self._closing.is_set():
                for key, _ in waiting.select(0.005):
                    if key.data is None:
                        front, _ = self._listening.accept()
                        if self.faults.fault == "gone":
                            front.close()
                            continue
                        back = socket.create_connection(self._back)
                        self._pairs.append((front, back))
                        waiting.register(front, selectors.EVENT_READ, (back, False))
                        waiting.register(back, selectors.EVENT_READ, (front, True))
                    else:
                        self._passed(key, waiting)
            for pair in self._pairs:
                for link in pair:
                    link.close()

    def _passed(self, key: selectors.SelectorKey, waiting: selectors.BaseSelector) -> None:
        link, (other, reply) = key.fileobj, key.data
        assert isinstance(link, socket.socket)
        try:
            data = link.recv(65536)
            if data and reply:
                self.faults.said(data, other.sendall)
            elif data and self.faults.fault not in ("frozen", "gone"):
                self.faults.heard.append(data)
                other.sendall(data)
        except OSError:
            data = b""
        if not data:
            for end in (link, other):
                with suppress(KeyError, ValueError):
                    waiting.unregister(end)
                end.close()

    def _serial(self) -> None:
        back = os.open(str(self._line), os.O_RDWR | os.O_NOCTTY)
        with selectors.DefaultSelector() as waiting:
            waiting.register(self._ours, selectors.EVENT_READ, False)
            waiting.register(back, selectors.EVENT_READ, True)
            while not self._closing.is_set():
                for key, _ in waiting.select(0.005):
                    data = os.read(key.fd, 4096)
                    if key.data:
                        self.faults.said(data, lambda said: os.write(self._ours, said))
                    elif self.faults.fault not in ("frozen", "gone"):
                        self.faults.heard.append(data)
                        os.write(back, data)
        for end in (self._ours, self._theirs, back):
            os.close(end)

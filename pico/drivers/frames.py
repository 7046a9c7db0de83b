"""Cameras behind a plain server of frames over TCP: whatever grabs pictures where PICO has no driver for it, and what
an emulated bench has.

A request is a line of JSON, `{"do": "identify", "id": 7}` or `{"do": "grab", "id": 8, "exposure": 2.5, "gain": 0}` (ms,
dB; each may be missing); the answer is a line of JSON with the same `id`, of a frame with its `shape`, its `dtype`
(`uint8` or `uint16`), the number of its `bytes` and their `crc32`, and then these, row by row. A server that counts its
pictures sends that, too, as `number`: a picture whose number is not above that of the one before is an earlier one. An
answer that comes twice, or too late, is none to the next request, and a frame that came otherwise than it was sent is
none.
"""

from __future__ import annotations

import json
import socket
import zlib
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError
from pico.drivers import judging
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.model.wiring import DeviceEntry

if TYPE_CHECKING:
    import numpy as np

_GRAB = 4.5
"""How long a picture may take [s]."""
_LARGEST = 1 << 28


class FrameLink:
    """A connection to a server of frames. Raises OSError, or ValueError for what is no answer."""

    def __init__(self, host: str, port: int) -> None:
        self._socket = socket.create_connection((host, port), timeout=_GRAB)
        self._file = self._socket.makefile("rb")
        self._id = 0
        self.count = -1
        """The number of the last picture, -1 before the first."""

    def ask(self, **request: Any) -> tuple[dict[str, Any], bytes]:
        """Return the answer to a request, and the bytes that come with it."""
        self._id += 1
        self._socket.sendall(json.dumps({**request, "id": self._id}).encode() + b"\n")
        said = json.loads(self._file.readline(65536) or "null")
        if not isinstance(said, dict):
            raise ValueError("it hung up")
        if type(said.get("id")) is not int or said["id"] != self._id or "error" in said:
            raise ValueError(said.get("error", f"it answers request {said.get('id')}, and {self._id} was asked"))
        size = said.get("bytes", 0)
        if type(size) is not int or not 0 <= size <= _LARGEST:
            raise ValueError(f"a frame of {size!r:.40} bytes")
        data = self._file.read(size)
        if len(data) != size:
            raise ValueError("it hung up in the middle of a frame")
        if data and said.get("crc32") != zlib.crc32(data):
            raise ValueError("a frame came otherwise than it was sent")
        return said, data

    def close(self) -> None:
        """Hang up, also while somebody waits for an answer."""
        self._socket.close()


class FrameCamera:
    """A camera of a server of frames."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[FrameLink]) -> None:
        self.name = name
        self._line = Line(name, bus, entry.identity, _identity)

    async def connect(self) -> Identity:
        return await self._line.connect()

    async def grab(self, *, exposure: float | None = None, gain: float | None = None) -> np.ndarray:
        """Return one picture, (rows, columns) or (rows, columns, 3), uint8 or uint16."""
        asked = {key: value for key, value in (("exposure", exposure), ("gain", gain)) if value is not None}

        def take(link: FrameLink) -> np.ndarray:
            said, data = link.ask(do="grab", **asked)
            try:
                taken = judging.picture(said, data)
            except PicoError as exc:
                raise PicoError([replace(one, address=self.name) for one in exc.diagnostics]) from exc
            link.count = judging.counted(self.name, said.get("number"), link.count)
            return taken

        return await self._line.ask("take a picture", take, within=_GRAB)

    async def stop(self) -> None:
        """A camera does not move."""

    async def close(self) -> None:
        await self._line.close()


def _identity(link: FrameLink) -> Identity:
    said, _ = link.ask(do="identify")
    return Identity(**{key: str(said.get(key, "")) for key in ("vendor", "model", "serial", "firmware")})


CAMERA = Driver(
    kind="camera",
    made=FrameCamera,
    opened=lambda entry: FrameLink(str(entry.address["host"]), int(entry.address["port"])),
    closed=lambda link: link.close(),
    address={"host": "the server's name or number", "port": "its TCP port"},
    bus=("host", "port"),
    required=("host",),
    properties={"frame": "count", "exposure": "ms", "gain": "dB"},
    settings={},
    maturity="emulated",
    emulator="frames",
)
"""`frames.camera`."""

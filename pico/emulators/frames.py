"""A server of frames, as `pico.drivers.frames` describes it: pictures of what is behind the camera."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping
from typing import Any

from pico.emulators.behind import Behind, Emulator
from pico.emulators.serving import TcpServed
from pico.model.wiring import DeviceEntry


class Frames:
    """A conversation about frames: what is behind it has `frame`, and is told `exposure` and `gain` before."""

    def __init__(self, serial: str, behind: Behind) -> None:
        self._serial, self._behind, self._rest = serial, behind, b""

    def heard(self, data: bytes) -> bytes:
        lines = (self._rest + data).split(b"\n")
        self._rest = lines.pop()
        return b"".join(self._answer(line) for line in lines)

    def due(self) -> bytes:
        return b""

    def _answer(self, line: bytes) -> bytes:
        try:
            asked: dict[str, Any] = json.loads(line)
            do, said = asked.get("do"), {"id": asked.get("id")}
        except (ValueError, AttributeError):
            do, said = None, {}
        if do == "identify":
            return _line({**said, "vendor": "PICO", "model": "frames", "serial": self._serial, "firmware": "1"})
        if do != "grab":
            return _line({**said, "error": "it knows `identify` and `grab`"})
        for key in ("exposure", "gain"):
            if key in asked:
                self._behind.write(key, asked[key])
        picture = self._behind.read("frame")
        if picture is None:
            return _line({**said, "error": "there is no picture"})
        data: bytes = picture.tobytes()
        about = {**said, "shape": list(picture.shape), "dtype": picture.dtype.name, "bytes": len(data)}
        about["crc32"] = zlib.crc32(data)
        return _line(about) + data


def _line(said: Mapping[str, Any]) -> bytes:
    return json.dumps(said).encode() + b"\n"


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> TcpServed:
    ((entry, behind),) = devices.values()
    return TcpServed(lambda: Frames(str(entry.identity.get("serial", "")), behind))


SERVER = Emulator(started=_started, bus=("host", "port"))

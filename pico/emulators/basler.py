"""A Basler camera: the vendor's own emulation within pypylon, which shows the pictures in a folder in turn. Who
triggers it says so at a port of ours first: then they are replaced by what is behind the camera, its `frame` (rows,
columns), 8 or 16 bit.

Two files, both replaced: of one alone it would read what was there when grabbing began. Nothing else may lie there.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from itertools import count
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from pico.emulators.behind import Behind, Emulator
from pico.emulators.serving import TcpServed
from pico.model.wiring import DeviceEntry

MOST = 16
"""How many cameras a process may emulate: how many there are is told to the vendor's library before it begins."""
_DARK = np.zeros((480, 640), np.uint8)
_FAST = (cv2.IMWRITE_PNG_COMPRESSION, 0)
_free = count()


class Shown:
    """One emulated camera, and the conversation that has its pictures replaced: each line is answered by `ready`."""

    def __init__(self, behind: Behind) -> None:
        os.environ.setdefault("PYLON_CAMEMU", str(MOST))
        self._behind, self._last = behind, np.zeros(0)
        self._folder = tempfile.TemporaryDirectory(prefix="pico-camera-")
        top = Path(self._folder.name)
        self._images, self._spare = top / "images", top / "spare.png"
        self._images.mkdir()
        width, height = behind.read("pixels") or self._replace().shape[1::-1]
        self._served = TcpServed(lambda: self)
        serial = f"0815-{next(_free) % MOST:04X}"
        self.identity = {"vendor": "Basler", "model": "Emulation", "serial": serial, "firmware": ""}
        self.address: dict[str, str | int] = {
            "serial": serial, "images": str(self._images), "asks": int(self._served.address["port"]),
            "width": int(width), "height": int(height),
        }  # fmt: skip
        if not self._last.size:
            self._show(np.zeros((height, width), np.uint8))

    def heard(self, data: bytes) -> bytes:
        """Replace the pictures for each line."""
        asked = data.count(b"\n")
        if asked:
            self._replace()
        return b"ready\n" * asked

    def due(self) -> bytes:
        """Nothing is said unasked."""
        return b""

    def _replace(self) -> Any:
        frame = self._behind.read("frame")
        frame = _DARK if frame is None else frame
        if frame is not self._last:
            self._show(frame)
        return frame

    def _show(self, frame: Any) -> None:
        self._last = frame
        for name in ("a.png", "b.png"):
            cv2.imwrite(str(self._spare), frame, _FAST)
            self._spare.replace(self._images / name)

    def close(self) -> None:
        """End it, and take its pictures away."""
        self._served.close()
        self._folder.cleanup()


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> Shown:
    ((_, behind),) = devices.values()
    return Shown(behind)


CAMERA = Emulator(started=_started, bus=("serial",))

"""A Basler camera: the vendor's own emulation within pypylon, which shows the pictures in a folder in turn. They are
replaced whenever what is behind it has another `frame` (rows, columns), 8 or 16 bit.

Two files, both replaced: of one alone it would read what was there when grabbing began. Nothing else may lie there.
"""

from __future__ import annotations

import os
import tempfile
import threading
from collections.abc import Mapping
from itertools import count
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from pico.emulators.behind import Behind, Emulator
from pico.model.wiring import DeviceEntry

MOST = 16
"""How many cameras a process may emulate: how many there are is told to the vendor's library before it begins."""
LOOK = 0.02
"""How often it is looked whether there is another frame [s]."""
_DARK = np.zeros((480, 640), np.uint8)
_free = count()


class Shown:
    """One emulated camera, and the thread that keeps its pictures as what is behind it."""

    def __init__(self, behind: Behind) -> None:
        os.environ.setdefault("PYLON_CAMEMU", str(MOST))
        self._behind = behind
        self._folder = tempfile.TemporaryDirectory(prefix="pico-camera-")
        top = Path(self._folder.name)
        self._images, self._spare = top / "images", top / "spare.png"
        self._images.mkdir()
        self._last: Any = None
        self._replace()
        self.address: dict[str, str | int] = {"serial": f"0815-{next(_free) % MOST:04X}", "images": str(self._images)}
        self.identity = {
            "vendor": "Basler",
            "model": "Emulation",
            "serial": str(self.address["serial"]),
            "firmware": "",
        }
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._keep, daemon=True, name="pico-emulator")
        self._thread.start()

    def _keep(self) -> None:
        while not self._closing.wait(LOOK):
            self._replace()

    def _replace(self) -> None:
        frame = self._behind.read("frame")
        if frame is self._last and self._last is not None:
            return
        self._last = frame
        for name in ("a.png", "b.png"):
            cv2.imwrite(str(self._spare), _DARK if frame is None else frame)
            self._spare.replace(self._images / name)
        if frame is None:
            self._last = _DARK

    def close(self) -> None:
        """End it, and take its pictures away."""
        self._closing.set()
        self._thread.join(2)
        self._folder.cleanup()


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> Shown:
    ((_, behind),) = devices.values()
    return Shown(behind)


CAMERA = Emulator(started=_started, bus=("serial",))

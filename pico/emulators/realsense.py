"""A RealSense camera: a device of software within the vendor's pyrealsense2, which gives what is behind the camera each
time it is asked: its `frame` (rows, columns), uint8, and its `depth` [mm], where NaN and None are not known."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from itertools import count
from typing import Any

import numpy as np

from pico.emulators.behind import Behind, Emulator
from pico.model.wiring import DeviceEntry

_DARK = np.zeros((480, 640), np.uint8)
_UNIT = 1e-3
"""What a count of depth is [m]."""
_free = count(1)


class Software:
    """One emulated camera: `rs.emulated`, by its number, adds it to a context of the library, and gives what is to be
    called for each picture."""

    def __init__(self, entry: DeviceEntry, behind: Behind) -> None:
        import pyrealsense2 as rs

        self._rs, self._behind, self._number = rs, behind, next(_free)
        self._serial = str(entry.identity.get("serial", entry.address["serial"]))
        first = behind.read("frame")
        width, height = behind.read("pixels") or (_DARK if first is None else first).shape[1::-1]
        self._size = int(width), int(height)
        self.address: dict[str, str | int] = {
            "serial": self._serial, "software": self._number, "width": int(width), "height": int(height)
        }  # fmt: skip
        if not hasattr(rs, "emulated"):
            rs.emulated = {}
        rs.emulated[self._number] = self._added

    def close(self) -> None:
        """End it: nobody opens it any more."""
        del self._rs.emulated[self._number]

    def _added(self, context: Any) -> Callable[[], None]:
        rs = self._rs
        device = rs.software_device()
        device.register_info(rs.camera_info.name, "Software")
        device.register_info(rs.camera_info.serial_number, self._serial)
        sensor = device.add_sensor("Stereo Module")
        sensor.add_read_only_option(rs.option.depth_units, _UNIT)
        depth = sensor.add_video_stream(self._stream(rs.stream.depth, 0, rs.format.z16, 2))
        eye = sensor.add_video_stream(self._stream(rs.stream.infrared, 1, rs.format.y8, 1))
        device.create_matcher(rs.matchers.default)
        device.add_to(context)
        numbers = count(1)

        def shoot() -> None:
            number, now = next(numbers), time.time() * 1000
            for profile, pixels in ((depth, self._depth()), (eye, self._frame())):
                frame = rs.software_video_frame()
                frame.bpp = pixels.dtype.itemsize
                frame.stride = self._size[0] * frame.bpp
                frame.timestamp, frame.domain = now, rs.timestamp_domain.system_time
                frame.frame_number, frame.profile = number, profile.as_video_stream_profile()
                frame.depth_units, frame.pixels = _UNIT, np.ascontiguousarray(pixels)
                sensor.on_video_frame(frame)

        shoot.device = device  # type: ignore[attr-defined]  # it lives as long as somebody asks it
        return shoot

    def _stream(self, kind: Any, index: int, form: Any, bpp: int) -> Any:
        rs = self._rs
        eye = rs.intrinsics()
        eye.width, eye.height = self._size
        eye.fx = eye.fy = float(self._size[0])
        eye.ppx, eye.ppy = self._size[0] / 2, self._size[1] / 2
        eye.model, eye.coeffs = rs.distortion.none, [0.0] * 5
        stream = rs.video_stream()
        stream.type, stream.index, stream.uid, stream.fmt, stream.bpp = kind, index, index + 1, form, bpp
        stream.width, stream.height, stream.fps, stream.intrinsics = *self._size, 30, eye
        return stream

    def _frame(self) -> Any:
        found = self._behind.read("frame")
        return np.zeros(self._size[::-1], np.uint8) if found is None else np.asarray(found, np.uint8)

    def _depth(self) -> Any:
        found = self._behind.read("depth")
        if found is None:
            return np.zeros(self._size[::-1], np.uint16)
        return np.rint(np.nan_to_num(np.asarray(found, float)) / 1000 / _UNIT).astype(np.uint16)


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> Software:
    ((entry, behind),) = devices.values()
    return Software(entry, behind)


CAMERA = Emulator(started=_started, bus=("serial",))
"""`realsense`."""

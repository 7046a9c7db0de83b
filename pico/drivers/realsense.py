"""RealSense depth cameras through the vendor's pyrealsense2: gray pictures of the left infrared eye, and depth maps."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.drivers import judging
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.drivers.visa import require_read_back
from pico.model.instruments.declaration import Setting
from pico.model.wiring import DeviceEntry

if TYPE_CHECKING:
    import numpy as np

REPLY = 2000
"""How long a picture may take [ms]."""
SIZE, RATE = (1280, 720), 30
"""Columns and rows of a picture, and pictures a second, where the lab says nothing."""
_GRAB = 4.9
"""How long a picture may take in all [s]."""
_UNIT = (1e-6, 1e-2)
"""What a count of depth can be [m]."""
_EXPOSURE = 0.02
"""How far the exposure that is read back may be from what was set [of itself]."""


class _Link:
    """A camera that streams; an emulated one, which the vendor's library has, is `asked` for each picture."""

    def __init__(self, entry: DeviceEntry) -> None:
        import pyrealsense2 as rs

        self._rs, wanted = rs, rs.config()
        context = rs.context()
        self._pipeline = rs.pipeline(context)  # before a device of software is added: else it finds none
        software = entry.address.get("software")
        self._asked: Callable[[], object] = rs.emulated[software](context) if software else lambda: None
        serial = str(entry.address["serial"])
        if serial not in (one.get_info(rs.camera_info.serial_number) for one in context.query_devices()):
            raise ConnectionError(f"no camera with the serial number {serial} is there")  # it would wait for one
        said: dict[str, Any] = {"width": SIZE[0], "height": SIZE[1], "rate": RATE, **entry.settings, **entry.address}
        width, height, rate = (int(said[key]) for key in ("width", "height", "rate"))
        self.size = width, height
        self.numbers = {stream: judging.Counted() for stream in ("infrared", "depth")}
        wanted.enable_device(serial)
        wanted.enable_stream(rs.stream.depth, 0, width, height, rs.format.z16, rate)
        wanted.enable_stream(rs.stream.infrared, 1, width, height, rs.format.y8, rate)
        self.device = self._pipeline.start(wanted).get_device()

    def taken(self, name: str, stream: str) -> tuple[np.ndarray, Any]:
        """Return the pixels of the next frame but one of a stream (`infrared`, `depth`), and the frame: the first began
        before it was asked for. Raises PicoError for what is none of its size, and for one that was sent before."""
        for _ in range(2):
            self._asked()
            found = self._pipeline.wait_for_frames(REPLY)
            frame = found.get_depth_frame() if stream == "depth" else found.get_infrared_frame(1)
            self.numbers[stream].require_newer(name, frame.get_frame_number())
        return judging.pixels(name, frame.get_data(), *self.size), frame

    def told(self, what: str) -> str:
        """Return what the camera says of itself, '' where it says nothing of that."""
        key = getattr(self._rs.camera_info, what)
        return str(self.device.get_info(key)) if self.device.supports(key) else ""

    def set(self, name: str, what: str, value: float, scale: float) -> None:
        """Set an option of its eyes, in a unit that is `scale` of the library's; raises PicoError where it has none."""
        option = getattr(self._rs.option, what)
        for sensor in self.device.query_sensors():
            if sensor.supports(option):
                sensor.set_option(option, value * scale)
                found = sensor.get_option(option) / scale
                if abs(found - value) > _EXPOSURE * abs(value):
                    require_read_back(name, f"the {what}", value, found)
                return
        raise PicoError(error("device", f"{name} has no {what} that can be set", address=name))

    def close(self) -> None:
        """Let go of it."""
        self._pipeline.stop()


class DepthCamera:
    """A depth camera."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[_Link]) -> None:
        self.name, self._limits = name, entry.limits
        self._line = Line(name, bus, entry.identity, _identity)

    async def connect(self) -> Identity:
        return await self._line.connect(within=_GRAB)  # beside another vendor's library it takes seconds

    async def grab(self, *, exposure: float | None = None, gain: float | None = None) -> np.ndarray:
        """Return one picture, taken after the call, with this exposure [ms] and gain where they are given."""
        asked = [(w, v, u, s) for w, v, u, s in (("exposure", exposure, "ms", 1000.0), ("gain", gain, "", 1.0))
                 if v is not None]  # fmt: skip
        for what, value, unit, _ in asked:
            if limits := self._limits.get(what):
                require_within(self.name, what, value, limits, unit)

        def take(link: _Link) -> np.ndarray:
            for what, value, _, scale in asked:
                link.set(self.name, what, value, scale)
            found, _ = link.taken(self.name, "infrared")
            if str(found.dtype) != "uint8":
                raise _no_frame(self.name, f"its pixels are of type {found.dtype}, not uint8")
            return found

        return await self._line.ask("take a picture", take, within=_GRAB)

    async def depth(self) -> np.ndarray:
        """Return one depth map, taken after the call, [mm], NaN where nothing was found."""

        def take(link: _Link) -> np.ndarray:
            import numpy as np

            found, frame = link.taken(self.name, "depth")
            unit = frame.get_units()
            if str(found.dtype) != "uint16":
                raise _no_frame(self.name, f"its counts are of type {found.dtype}, not uint16")
            if not isinstance(unit, int | float) or not _UNIT[0] <= unit <= _UNIT[1]:
                raise _no_frame(self.name, f"a count of its depth is {unit} m")
            counts = found.astype(float)
            return np.where(counts > 0, counts * unit * 1000, np.nan)

        return await self._line.ask("measure depth", take, within=_GRAB)

    async def stop(self) -> None:
        """Nothing moves here."""

    async def close(self) -> None:
        await self._line.close()


def _no_frame(name: str, why: str) -> PicoError:
    return PicoError(error("device-reply", f"what {name} sent is no picture of it: {why}", address=name))


def _identity(link: _Link) -> Identity:
    return Identity(
        vendor="RealSense", model=link.told("name"), serial=link.told("serial_number"),
        firmware=link.told("firmware_version"),
    )  # fmt: skip


CAMERA = Driver(
    kind="depth camera", made=DepthCamera, opened=_Link, closed=_Link.close,
    address={
        "serial": "its serial number", "software": "which one of the vendor's library stands in for it",
        "width": "of its pictures", "height": "of its pictures",
    },
    bus=("serial",), settings={
        "width": Setting(kind=int, default=SIZE[0], unit="pixel", range=(1, 8192), about="columns of its pictures"),
        "height": Setting(kind=int, default=SIZE[1], unit="pixel", range=(1, 8192), about="rows of its pictures"),
        "rate": Setting(kind=int, default=RATE, unit="Hz", range=(1, 300), about="pictures a second"),
    }, properties={"exposure": "ms", "gain": "", "frame": "count", "depth": "mm"},
    needs=("pyrealsense2", "realsense"), maturity="emulated", emulator="realsense",
)  # fmt: skip
"""`realsense.camera`."""

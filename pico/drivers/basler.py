"""Basler cameras through the vendor's pypylon: one picture a software trigger, taken after it was asked for."""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING, Any

from pico.drivers import judging
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.drivers.visa import require_read_back
from pico.model.wiring import DeviceEntry

if TYPE_CHECKING:
    import numpy as np

REPLY = 2000
"""How long a picture may take beyond its exposure [ms]."""
_GRAB = 4.9
"""How long a picture may take in all [s]."""
_RENDERED = 4.0
"""How long an emulated one's picture may take to be drawn [s]."""
_UNNUMBERED = (0, 2**64 - 1)
"""What the library says for the number of a picture where the camera has none."""
_EXPOSURE = 0.02
"""How far the exposure that is read back may be from what was set: cameras round it [of itself]."""


class _Link:
    """An open camera that grabs; an emulated one is `asked` for its picture before each trigger, and has it then."""

    def __init__(self, entry: DeviceEntry) -> None:
        from pypylon import pylon

        wanted = pylon.DeviceInfo()
        wanted.SetSerialNumber(str(entry.address["serial"]))
        self.camera = camera = pylon.InstantCamera(pylon.TlFactory.GetInstance().CreateFirstDevice(wanted))
        camera.Open()
        self.numbers = judging.Counted()
        self._asked: socket.socket | None = None
        if images := entry.address.get("images"):  # before it grabs: then these are locked
            self._asked = socket.create_connection(("127.0.0.1", int(entry.address["asks"])), _RENDERED)
            camera.TestImageSelector.Value = "Off"
            camera.ImageFileMode.Value = "On"
            camera.ImageFilename.Value = str(images)
            camera.Width.Value, camera.Height.Value = int(entry.address["width"]), int(entry.address["height"])
        for node, value in entry.settings.items():
            camera.GetNodeMap().GetNode(node).FromString(str(value))
        camera.TriggerSelector.Value = "FrameStart"
        camera.TriggerMode.Value = "On"
        camera.TriggerSource.Value = "Software"
        camera.StartGrabbing(pylon.GrabStrategy_LatestImageOnly)

    def trigger(self) -> None:
        """Have a picture taken now."""
        if self._asked is not None:
            self._asked.sendall(b"picture\n")
            if self._asked.recv(64) != b"ready\n":
                raise OSError("what emulates it is gone")
        self.camera.ExecuteSoftwareTrigger()

    def close(self) -> None:
        """Let go of it."""
        if self._asked is not None:
            self._asked.close()
        self.camera.StopGrabbing()
        self.camera.Close()


class Camera:
    """A camera."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[_Link]) -> None:
        self.name, self._limits = name, entry.limits
        self._line = Line(name, bus, entry.identity, _identity)

    async def connect(self) -> Identity:
        return await self._line.connect()

    async def grab(self, *, exposure: float | None = None, gain: float | None = None) -> np.ndarray:
        """Return one picture, taken after the call, with this exposure [ms] and gain [dB] where they are given."""
        for what, value, unit in (("exposure", exposure, "ms"), ("gain", gain, "dB")):
            if value is not None and (limits := self._limits.get(what)):
                require_within(self.name, what, value, limits, unit)
        longest = (exposure or 0.0) / 1000

        def take(link: _Link) -> np.ndarray:
            self._set(link.camera, exposure, gain)
            return _taken(self.name, link, REPLY + round(longest * 1000))

        return await self._line.ask("take a picture", take, within=_GRAB)

    def _set(self, camera: Any, exposure: float | None, gain: float | None) -> None:
        if exposure is not None:
            camera.ExposureTime.Value = exposure * 1000
            found = camera.ExposureTime.Value / 1000
            if abs(found - exposure) > _EXPOSURE * exposure:
                require_read_back(self.name, "the exposure [ms]", exposure, found)
        if gain is not None:
            camera.Gain.Value = gain

    async def stop(self) -> None:
        """Nothing moves here."""

    async def close(self) -> None:
        await self._line.close()


def _taken(name: str, link: _Link, within: int) -> np.ndarray:
    """Return the picture of one trigger; what came before it is thrown away. Raises what pypylon raises, and PicoError
    for what is no picture of its size, and for one that was sent before."""
    from pypylon import pylon

    camera = link.camera
    while camera.GetGrabResultWaitObject().Wait(0):
        camera.RetrieveResult(0, pylon.TimeoutHandling_Return).Release()
    camera.WaitForFrameTriggerReady(within, pylon.TimeoutHandling_ThrowException)
    link.trigger()
    result = camera.RetrieveResult(within, pylon.TimeoutHandling_ThrowException)
    try:
        if not result.GrabSucceeded():
            raise OSError(f"the picture failed: {result.GetErrorDescription()}")
        taken = judging.pixels(name, result.Array, int(camera.Width.Value), int(camera.Height.Value))
        if link.numbers.last >= 0 or result.BlockID not in _UNNUMBERED:
            link.numbers.require_newer(name, result.BlockID)
        return taken
    finally:
        result.Release()


def _identity(link: _Link) -> Identity:
    said = link.camera.GetDeviceInfo()
    return Identity(vendor=said.GetVendorName(), model=said.GetModelName(), serial=said.GetSerialNumber())


CAMERA = Driver(
    kind="camera", made=Camera, opened=_Link, closed=_Link.close,
    address={
        "serial": "its serial number", "images": "a folder of pictures, which an emulated one shows",
        "asks": "a port at which it is asked to put them there", "width": "of them", "height": "of them",
    },
    bus=("serial",), settings={}, more_settings="any node of the camera by its name",
    properties={"exposure": "ms", "gain": "dB", "frame": "count"},
    needs=("pypylon.pylon", "basler"), maturity="emulated", emulator="basler",
)  # fmt: skip

"""Basler cameras through the vendor's pypylon: one picture a software trigger, taken after it was asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

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
_EXPOSURE = 0.02
"""How far the exposure that is read back may be from what was set: cameras round it [of itself]."""


def _opened(entry: DeviceEntry) -> Any:
    from pypylon import pylon

    wanted = pylon.DeviceInfo()
    wanted.SetSerialNumber(str(entry.address["serial"]))
    camera = pylon.InstantCamera(pylon.TlFactory.GetInstance().CreateFirstDevice(wanted))
    camera.Open()
    if images := entry.address.get("images"):  # before it grabs: then these are locked
        camera.TestImageSelector.Value = "Off"
        camera.ImageFileMode.Value = "On"
        camera.ImageFilename.Value = str(images)
    for node, value in entry.settings.items():
        camera.GetNodeMap().GetNode(node).FromString(str(value))
    camera.TriggerSelector.Value = "FrameStart"
    camera.TriggerMode.Value = "On"
    camera.TriggerSource.Value = "Software"
    camera.StartGrabbing(pylon.GrabStrategy_LatestImageOnly)
    return camera


def _closed(camera: Any) -> None:
    camera.StopGrabbing()
    camera.Close()


class Camera:
    """A camera."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Any]) -> None:
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

        def take(camera: Any) -> np.ndarray:
            self._set(camera, exposure, gain)
            return _taken(camera, REPLY + round(longest * 1000))

        return await self._line.ask("take a picture", take, within=min(REPLY / 1000 + longest + 1, 5.0))

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


def _taken(camera: Any, within: int) -> np.ndarray:
    """Return the picture of one trigger; what came before it is thrown away. Raises what pypylon raises."""
    from pypylon import pylon

    while camera.GetGrabResultWaitObject().Wait(0):
        camera.RetrieveResult(0, pylon.TimeoutHandling_Return).Release()
    camera.WaitForFrameTriggerReady(within, pylon.TimeoutHandling_ThrowException)
    camera.ExecuteSoftwareTrigger()
    result = camera.RetrieveResult(within, pylon.TimeoutHandling_ThrowException)
    try:
        if not result.GrabSucceeded():
            raise OSError(f"the picture failed: {result.GetErrorDescription()}")
        taken: np.ndarray = result.Array.copy()
        return taken
    finally:
        result.Release()


def _identity(camera: Any) -> Identity:
    said = camera.GetDeviceInfo()
    return Identity(vendor=said.GetVendorName(), model=said.GetModelName(), serial=said.GetSerialNumber())


CAMERA = Driver(
    kind="camera", made=Camera, opened=_opened, closed=_closed,
    address={"serial": "its serial number", "images": "a folder of pictures, which an emulated one shows"},
    bus=("serial",), properties={"exposure": "ms", "gain": "dB", "frame": "count"},
    needs=("pypylon.pylon", "basler"), maturity="emulated", emulator="basler",
)  # fmt: skip

"""Cameras that measure depth, too."""

from __future__ import annotations

from pico.drivers.protocols import DepthCamera
from pico.model.instruments.kind import InstrumentKind


async def _reads(camera: DepthCamera) -> str:
    rows, columns = (await camera.grab()).shape[:2]
    return f"{columns} x {rows} pixels"


KIND = InstrumentKind(
    name="depth camera", about="a camera that measures depth, too", protocol=DepthCamera, reads=_reads, role="camera",
    datatypes=(),
)  # fmt: skip

"""Cameras, over the bench or in the beam."""

from __future__ import annotations

from pico.drivers.protocols import Camera
from pico.model.instruments.kind import InstrumentKind


async def _reads(camera: Camera) -> str:
    rows, columns = (await camera.grab()).shape[:2]
    return f"{columns} x {rows} pixels"


KIND = InstrumentKind(
    name="camera", about="a camera over the bench, or in the beam", protocol=Camera, reads=_reads, role="camera",
    datatypes=(),
)  # fmt: skip

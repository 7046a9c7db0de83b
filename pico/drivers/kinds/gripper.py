"""Grippers."""

from __future__ import annotations

from pico.drivers.protocols import Gripper
from pico.model.instruments.kind import InstrumentKind


async def _reads(gripper: Gripper) -> str:
    grip = await gripper.grip()
    width = [] if grip.width is None else [f"{grip.width:.1f} mm open"]
    return ", ".join([*width, "holds something" if grip.holds else "holds nothing"])


KIND = InstrumentKind(
    name="gripper", about="what opens and closes around a part", protocol=Gripper, reads=_reads, role="gripper",
    datatypes=(),
)  # fmt: skip

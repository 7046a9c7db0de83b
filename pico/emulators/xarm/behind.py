"""An emulated arm with its gripper as a device of an emulated bench: what is behind it says where it stands, and what
is between its fingers."""

from __future__ import annotations

from collections.abc import Mapping

from pico.emulators.behind import Behind, Emulator
from pico.emulators.xarm.server import XArmEmulator
from pico.model.wiring import DeviceEntry

SERIAL = "XI130500000000"
"""Of who is told none."""
_POSTURE = (0.0, -1.05, 0.0, 0.52, 0.0, 1.57, 0.0)
"""Where it stands with nothing behind it [rad]."""


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> XArmEmulator:
    """Start one for an arm and its gripper, which share a link: what is behind the first of them knows `joints` [rad],
    `width` [mm], `pace`, its `faults`, and what is called as `fingers`, `moved` and `way` (see `XArmEmulator`);
    each may be missing. It is told the `emulator`, for faults to be injected."""
    _, behind = next(iter(devices.values()))
    serial = next((str(e.identity["serial"]) for e, _ in devices.values() if "serial" in e.identity), SERIAL)
    made = XArmEmulator(
        joints=behind.read("joints") or _POSTURE, serial=serial, pace=float(behind.read("pace") or 1.0),
        width=behind.read("width"), fingers=behind.read("fingers"), moved=behind.read("moved"),
        way=behind.read("way"),
        faults=str(behind.read("faults") or ""), faulted=lambda faults: behind.write("faults", faults),
    )  # fmt: skip
    behind.write("emulator", made)
    made.start()
    return made


BOX = Emulator(started=_started, bus=("host",))

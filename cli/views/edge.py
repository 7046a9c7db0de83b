"""What is served, and where."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .style import columns, paint

if TYPE_CHECKING:
    from pico.backends.device import Capabilities
    from pico.model.wiring import DeviceEntry


def text(lab: str, able: Capabilities, socket: Path, devices: Mapping[str, DeviceEntry]) -> str:
    """Return what is served, how it is reached, and a line a device with where it was reached."""
    words = {"hardware": " --backend hardware", "emulated": " --backend hardware --emulate"}.get(able.name, "")
    first = f"{lab} is served: {able.name} ({able.fidelity}), at {socket}"
    rows = [[name, entry.driver, paint("dim", _address(entry))] for name, entry in devices.items()]
    last = f"Commands in its folder reach it (`pico{words} status`). Ctrl-C ends that."
    return "\n".join([first, *(f"  {line}" for line in columns(rows)), last])


def _address(entry: DeviceEntry) -> str:
    return " ".join(f"{key}={value}" for key, value in entry.address.items())


def data(lab: str, able: Capabilities, socket: Path, devices: Mapping[str, DeviceEntry]) -> dict[str, Any]:
    """Return schema `pico.edge/v1`: `lab`, `backend`, `fidelity`, `socket`, and of each of the `devices` its driver and
    the address at which it was reached."""
    reached = {name: {"driver": entry.driver, "address": dict(entry.address)} for name, entry in devices.items()}
    return {
        "schema": "pico.edge/v1", "lab": lab, "backend": able.name, "fidelity": able.fidelity, "socket": str(socket),
        "devices": reached,
    }  # fmt: skip

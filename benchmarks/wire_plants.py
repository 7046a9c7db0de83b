"""Faults that `benchmarks/wire_replies.py` puts into drivers, and has to find."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pico.drivers import elliptec_slider, frames, judging, realsense, scpi_values
from pico.model.instruments.readout import Readout, unknown


@dataclass(frozen=True)
class Plant:
    """A fault, and the cases of the drivers in which it has to be found."""

    put: Callable[[], object]
    drivers: tuple[str, ...]


def _set(where: Any, **values: Any) -> Callable[[], object]:
    return lambda: [setattr(where, name, value) for name, value in values.items()]


def _loose_number(raw: str, unit: str, **_: Any) -> Any:
    try:
        return Readout(unit=unit, value=float(raw), raw=raw)
    except ValueError:
        return unknown(unit, "garbled", raw)


def _any_position(raw: str, names: Any, moving: object = "") -> Any:
    code = next((code for code in names if code in raw), None)
    return unknown("", "garbled", raw) if code is None else Readout(unit="", value=names[code], raw=raw)


def _believed(name: str, taken: Any, *_: object) -> Any:
    return np.array(taken)


def _ready_whatever_is_reported() -> None:
    from pico.drivers.xarm.arm import XArm

    state = XArm._state

    def ready(self: Any, link: Any) -> Any:
        return replace(state(self, link), enabled=link is self._ready_link)

    XArm._state = ready  # type: ignore[method-assign]


def _no_fault() -> None:
    from pico.drivers.xarm.link import Link

    Link.fault = lambda self: 0  # type: ignore[method-assign]


def _as_the_library_has_it() -> None:
    from pico.drivers.xarm import replies

    replies.sound = lambda *_: True


PLANTS: dict[str, Plant] = {
    "float": Plant(_set(judging, number=_loose_number), ("scpi.meter", "scpi.number")),
    "sentinel": Plant(_set(judging, _LEAST_SENTINEL=1e99), ("scpi.meter", "scpi.number")),
    "switch": Plant(_set(judging, switched=lambda raw: raw.strip() not in ("0", "OFF")), ("scpi.laser",)),
    "hex": Plant(_set(judging, hexadecimal=lambda raw, digits, **_: int(raw, 16)), ("elliptec.rotator",)),
    "picture": Plant(
        _set(frames, zlib=type("zlib", (), {"crc32": staticmethod(lambda _: None)})), ("frames.camera",)),
    "position": Plant(_set(scpi_values, position_of=_any_position), ("scpi.choice",)),
    "between": Plant(_set(elliptec_slider, OFF=17), ("elliptec.slider",)),
    "library": Plant(_as_the_library_has_it, (
        "xarm.arm-joints", "xarm.arm-state", "xarm.gripper-position", "xarm.gripper-status", "xarm.gripper-fault")),
    "no fault": Plant(_no_fault, ("xarm.arm-fault",)),
    "motors": Plant(_ready_whatever_is_reported, ("xarm.arm-report",)),
    "pixels": Plant(_set(judging, pixels=_believed), ("basler.camera", "realsense.camera")),
    "stale": Plant(
        _set(judging.Counted, require_newer=lambda *_: None),
        ("basler.camera", "realsense.camera", "realsense.camera-depth")),
    "unit": Plant(_set(realsense, _UNIT=(-1e9, 1e9)), ("realsense.camera-depth",)),
}  # fmt: skip
"""By name."""

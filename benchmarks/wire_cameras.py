"""Basler and RealSense cameras for `benchmarks/wire_replies.py`: stand-ins for the vendors' libraries, whose results
are replaced. There is no wire to edit: the libraries have that to themselves. What PICO has of it is the result of a
grab: whether it succeeded, its size, its type, its number, its pixels, and of depth the unit.

A result is a line of JSON and its pixels: `good`, `shape`, `dtype`, `number`, and `units` [m] of depth.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.machinery import ModuleSpec
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
from wire_grammars import NOTHING, Allowed

from pico.emulators.behind import Alone
from pico.model.wiring import DeviceEntry

COLUMNS, ROWS = 6, 4
UNITS = 1e-4
BASLER = DeviceEntry(driver="basler.camera", emulator="basler", address={"serial": "7"}, identity={"serial": "7"})
DEPTH = DeviceEntry(
    driver="realsense.camera", emulator="realsense", address={"serial": "7"}, identity={"serial": "7"},
    settings={"width": COLUMNS, "height": ROWS},
)  # fmt: skip


class Eye:
    """What a camera of a library sends: the picture behind it, numbered on."""

    def __init__(self, behind: Alone, forger: Any) -> None:
        self._behind, self._forger, self.number = behind, forger, 0

    def result(self, stream: str, forge: bool = True) -> Any:
        """Return the next result of a stream (`gray`, `depth`); raises RuntimeError as the libraries do."""
        pixels = np.ascontiguousarray(self._behind.read(stream))
        head = {"good": True, "shape": pixels.shape, "dtype": str(pixels.dtype), "number": self.number}
        head |= {"units": UNITS} if stream == "depth" else {}
        sent = json.dumps(head).encode() + b"\n" + pixels.tobytes()
        line, _, data = (self._forger.passed(stream.encode(), sent) if forge else sent).partition(b"\n")
        try:
            said = json.loads(line)
            found = np.frombuffer(data, said["dtype"]).reshape(said["shape"])
            return SimpleNamespace(
                pixels=found, good=bool(said["good"]), number=said["number"], units=said.get("units", 0.0)
            )
        except (ValueError, KeyError, TypeError, RecursionError, OverflowError) as exc:
            raise RuntimeError(f"the stream is broken: {exc}") from exc


def pylon(eye: Eye) -> ModuleType:
    """Return a stand-in for `pypylon.pylon`."""

    class Result:
        def __init__(self) -> None:
            self._made = eye.result("gray")
            self.BlockID, self.Array = self._made.number, self._made.pixels

        def GrabSucceeded(self) -> bool:
            return bool(self._made.good)

        def GetErrorDescription(self) -> str:
            return "incomplete"

        def Release(self) -> None:
            pass

    class Camera:
        def __init__(self, device: object) -> None:
            self.nodes: dict[str, Any] = {}

        def __getattr__(self, name: str) -> Any:
            size = {"Width": COLUMNS, "Height": ROWS}
            return self.nodes.setdefault(name, SimpleNamespace(Value=size.get(name)))

        def Open(self) -> None:
            pass

        Close = StopGrabbing = Open

        def StartGrabbing(self, strategy: object) -> None:
            eye.number = 0

        def ExecuteSoftwareTrigger(self) -> None:
            eye.number += 1

        def GetGrabResultWaitObject(self) -> Any:
            return SimpleNamespace(Wait=lambda within: False)

        def WaitForFrameTriggerReady(self, within: int, how: object) -> None:
            pass

        def RetrieveResult(self, within: int, how: object) -> Result:
            return Result()

        def GetDeviceInfo(self) -> Any:
            return SimpleNamespace(
                GetVendorName=lambda: "Basler", GetModelName=lambda: "M", GetSerialNumber=lambda: "7"
            )

    made: Any = ModuleType("pypylon.pylon")
    made.InstantCamera, made.GrabStrategy_LatestImageOnly = Camera, 1
    made.TimeoutHandling_Return = made.TimeoutHandling_ThrowException = 1
    made.DeviceInfo = lambda: SimpleNamespace(SetSerialNumber=lambda serial: None)
    made.TlFactory = SimpleNamespace(GetInstance=lambda: SimpleNamespace(CreateFirstDevice=lambda wanted: None))
    return made  # type: ignore[no-any-return]


def realsense(eye: Eye) -> ModuleType:
    """Return a stand-in for `pyrealsense2`."""

    class Frame:
        def __init__(self, stream: str) -> None:
            self._made = eye.result(stream, forge=eye.number % 2 == 0)  # the first of two is not used
            if not self._made.good:
                raise RuntimeError('null pointer passed for argument "frame_ref"')

        def get_data(self) -> Any:
            return self._made.pixels

        def get_units(self) -> Any:
            return self._made.units

        def get_frame_number(self) -> Any:
            return self._made.number

    class Frames:
        def get_infrared_frame(self, index: int) -> Frame:
            return Frame("gray")

        def get_depth_frame(self) -> Frame:
            return Frame("depth")

    class Device:
        def get_info(self, key: str) -> str:
            return {"serial_number": "7", "name": "D4"}.get(key, "")

        def supports(self, key: str) -> bool:
            return True

        def query_sensors(self) -> list[Any]:
            return []

    class Pipeline:
        def __init__(self, context: object) -> None:
            eye.number = 0

        def start(self, config: object) -> Any:
            return SimpleNamespace(get_device=Device)

        def wait_for_frames(self, within: int) -> Frames:
            eye.number += 1
            return Frames()

        def stop(self) -> None:
            pass

    class Config:
        def enable_device(self, serial: str) -> None:
            pass

        def enable_stream(self, *what: object) -> None:
            pass

    made: Any = ModuleType("pyrealsense2")
    made.pipeline, made.config = Pipeline, Config
    made.context = lambda: SimpleNamespace(query_devices=lambda: [Device()])
    made.camera_info = SimpleNamespace(serial_number="serial_number", name="name", firmware_version="firmware")
    made.stream = SimpleNamespace(depth=1, infrared=2)
    made.format = SimpleNamespace(z16=1, y8=2)
    return made  # type: ignore[no-any-return]


def wire(name: str, library: Callable[[Eye], ModuleType]) -> Callable[[Any, Any], Any]:
    """Return what taps a camera: it yields its entry and what is behind it while the library `name` is stood in for."""

    @contextmanager
    def tapped(case: Any, forger: Any) -> Iterator[tuple[DeviceEntry, Alone]]:
        behind = Alone(case.at_first)
        top, _, below = name.partition(".")
        before = {one: sys.modules.get(one) for one in (top, name)}
        made = library(Eye(behind, forger))
        made.__spec__ = ModuleSpec(name, None)
        sys.modules[name] = made
        if below:
            package: Any = ModuleType(top)
            package.__path__, package.__spec__ = [], ModuleSpec(top, None, is_package=True)
            setattr(package, below, made)
            sys.modules[top] = package
        try:
            yield case.entry, behind
        finally:
            for one, was in before.items():
                sys.modules.pop(one) if was is None else sys.modules.__setitem__(one, was)

    return tapped


def _said(sent: bytes, true: bytes, kinds: tuple[str, ...]) -> tuple[dict[str, Any], np.ndarray] | None:
    """Return what a result says and its pixels, if it is one of the camera's size, whole and newer than the last."""
    head, _, data = sent.partition(b"\n")
    try:
        said, mine = json.loads(head), json.loads(true.partition(b"\n")[0])
        if said["dtype"] not in kinds or said["shape"] != [ROWS, COLUMNS] or not said["good"]:
            return None
        if type(said["number"]) is not int or said["number"] < mine["number"]:
            return None
        return said, np.frombuffer(data, said["dtype"]).reshape(ROWS, COLUMNS)
    except (ValueError, KeyError, TypeError, RecursionError):
        return None


def gray(*kinds: str) -> Callable[[bytes, bytes, Any], Allowed]:
    """A picture of the size of the sensor, of one of some types."""

    def says(sent: bytes, true: bytes, _: Any) -> Allowed:
        found = _said(sent, true, kinds)
        return NOTHING if found is None else Allowed(found[1], unknown=sent != true)

    return says


def depth(sent: bytes, true: bytes, _: Any) -> Allowed:
    """Counts of a unit between 1 um and 1 cm, 0 where nothing was found, in mm."""
    found = _said(sent, true, ("uint16",))
    unit = found[0].get("units") if found else None
    if found is None or type(unit) not in (int, float) or not (math.isfinite(unit) and 1e-6 <= unit <= 1e-2):
        return NOTHING
    counts = found[1].astype(float)
    return Allowed(np.where(counts > 0, counts * unit * 1000, np.nan), unknown=sent != true)


def odd(reply: bytes, draw: Any) -> bytes:
    """A failed grab, one of another size, type or unit, an earlier one, none."""
    head, _, data = reply.partition(b"\n")
    said = json.loads(head)
    said |= draw.choice([
        {"good": False}, {"shape": [COLUMNS, ROWS]}, {"shape": [1, ROWS * COLUMNS]}, {"shape": [ROWS * COLUMNS]},
        {"shape": [0, 0]}, {"dtype": "float64"}, {"dtype": "int8"}, {"dtype": "uint32"}, {"number": said["number"] - 1},
        {"number": None}, {"number": -1}, {"units": 0.0}, {"units": math.nan}, {"units": -1e-4}, {"units": 1e6},
    ])  # fmt: skip
    if said["dtype"] not in ("uint8", "uint16", "int8"):
        data = np.zeros(int(np.prod(said["shape"])), said["dtype"]).tobytes()
    return json.dumps(said).encode() + b"\n" + (b"" if 0 in said["shape"] else data)

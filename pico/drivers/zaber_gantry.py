"""A gantry of Zaber stages on one chain: x, y and z in mm, and a rotary stage that turns the hand; the driver
`zaber.gantry`.

Each straight leg of a path is one move of every stage, with speeds and accelerations in the ratio of the ways, so that
the tool goes straight and all arrive together; at the corners it rests, as the path does. Its joints are x, y, z [m]
and yaw [rad] in the table frame: the zero of each stage is that of the table.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from pico.diagnostics import PicoError, error
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.path import Path
from pico.drivers.protocols import ArmState, Identity
from pico.drivers.zaber import CHAIN, COUNTS, STAGE, Stage, opened
from pico.model.instruments.addresses import number_in
from pico.model.instruments.complaint import Complaint
from pico.model.instruments.declaration import Setting
from pico.model.wiring import DeviceEntry

AXES = ("x", "y", "z", "yaw")
SCALE = (1000.0, 1000.0, 1000.0, math.degrees(1.0))
"""What a joint [m, rad] is of the unit of its stage [mm, deg]."""
ASTRAY = (1.0, 1.0, 1.0, 0.5)
"""How far from a path's first posture each stage may stand to follow it [mm, deg]."""
STRAIGHT = 1e-4
"""What a leg may bend and still be one move of each stage [m, rad]."""
_STANDS = 1e-6
"""By less than this a stage does not go [mm, deg]."""


def of_axis(entry: DeviceEntry, axis: str) -> DeviceEntry:
    """Return the entry of one stage of a gantry; who it is, is asked of x alone."""
    turns = axis == "yaw"
    counts = entry.setting("counts_per_deg" if turns else "counts_per_mm", 0.0)
    return replace(
        entry, driver="zaber.stage",
        address={**{k: v for k, v in entry.address.items() if k in ("host", "port")},
                 "device": int(entry.address.get(axis, USUAL[axis])), "axis": 1},
        settings={"counts_per_unit": counts, "unit": "deg" if turns else "mm"},
        limits={"position": entry.limits[axis]} if axis in entry.limits else {},
        identity=entry.identity if axis == "x" else {},
    )  # fmt: skip


class Gantry:
    """Implements `pico.drivers.protocols.Arm`."""

    test = "it turns its hand by 5 deg, out and back, and is stopped on its way"
    """What its motion test does."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Any]) -> None:
        """Open nothing yet. Raises PicoError for settings that make no sense."""
        self.name = name
        self._stages = tuple(Stage(f"{name} ({axis})", of_axis(entry, axis), bus) for axis in AXES)
        self._moving = False
        self._ended = ""

    async def connect(self) -> Identity:
        """Ask who answers at each stage, and return who x is; moves nothing. Raises PicoError."""
        first, *_ = [await stage.connect() for stage in self._stages]
        return first

    async def ready(self) -> ArmState:
        """Return how it is: a stage needs no preparation. Raises PicoError for one that was not homed."""
        return await self.state()

    async def state(self) -> ArmState:
        """Return how it is; raises PicoError if a stage does not say where it is, or was not homed."""
        at = await self._positions()
        joints = tuple(v / scale for v, scale in zip(at, SCALE, strict=True))
        return ArmState(joints=joints, age=0.0, moving=self._moving, enabled=True)

    async def follow(self, times: np.ndarray, joints: np.ndarray, *, doing: str = "") -> ArmState:
        """Follow `joints` (n, 4) [m, m, m, rad] at `times` (n,) [s], and return once it is at rest there.

        Raises PicoError if it does not stand at the first of them, was stopped, or a stage fails: then all stop.
        """
        path, during = self._checked(times, joints), f" during {doing}" if doing else ""
        if self._moving:
            raise PicoError(error("arm-moves", f"{self.name} is moving already", address=self.name))
        self._moving, self._ended = True, ""
        try:
            await self._require_there(path.joints[0])
            corners = path.corners(STRAIGHT)
            for first, last in pairwise(corners):
                self._require_going(during)
                await self._leg(path.times[first : last + 1], path.joints[first : last + 1])
        except PicoError as exc:
            self._require_going(during, exc)
            raise
        finally:
            self._moving = False
        self._require_going(during)
        return await self.state()

    async def carry(self, mass: float, center: tuple[float, float, float]) -> None:
        """Do nothing: stages do not reckon with what they carry."""

    async def halt(self) -> None:
        """Come to rest on the path, decelerated; `follow` then raises PicoError."""
        if self._moving:
            await self._end("halted")

    async def stop(self) -> None:
        """Stop all stages now, decelerated."""
        await self._end("stopped")

    async def recover(self) -> ArmState:
        """Return how it is: faults of stages are cleared when they are told."""
        return await self.ready()

    async def motion_test(self) -> Mapping[str, float]:
        """Try its motion and its stop, see `pico.drivers.protocols.MotionTested`; raises PicoError."""
        from pico.drivers.motion_test import motion_test

        return await motion_test(self.name, self)

    async def close(self) -> None:
        """Come to rest, and let go of the link."""
        await self.halt()
        for stage in self._stages:
            await stage.close()

    async def _end(self, how: str) -> None:
        self._ended = self._ended or how
        found = await asyncio.gather(*(stage.stop() for stage in self._stages), return_exceptions=True)
        if failed := [one for one in found if isinstance(one, BaseException)]:
            raise failed[0]

    async def _positions(self) -> list[float]:
        found = await asyncio.gather(*(stage.position() for stage in self._stages))
        if unknown := [axis for axis, at in zip(AXES, found, strict=True) if at is None]:
            text = f"{self.name} does not know where it is: {', '.join(unknown)} was not homed since it has power"
            hint = "home its stages with the vendor's program, z first, with the table clear below the hand"
            raise PicoError(error("device-unhomed", text, hint=hint, address=self.name))
        return [float(at) for at in found if at is not None]

    def _checked(self, times: np.ndarray, joints: np.ndarray) -> Path:
        times, joints = np.asarray(times, float), np.asarray(joints, float)
        fits = times.ndim == 1 and joints.shape == (len(times), len(AXES)) and len(times) > 0
        if not (fits and np.isfinite(times).all() and np.isfinite(joints).all() and (np.diff(times) > 0).all()):
            text = f"{self.name} follows n growing times and n postures of 4 joints, not {times.shape}, {joints.shape}"
            raise PicoError(error("arm-path", text, address=self.name))
        return Path(times - times[0], joints)

    async def _require_there(self, start: np.ndarray) -> None:
        at = await self._positions()
        for axis, found, joint, scale, most in zip(AXES, at, start, SCALE, ASTRAY, strict=True):
            if (off := abs(found - joint * scale)) > most:
                text = f"{self.name} does not stand where its path begins: {axis} is {off:.1f} off"
                hint = "look again, and plan from where it stands"
                raise PicoError(error("arm-astray", text, hint=hint, address=self.name))

    def _require_going(self, during: str, cause: PicoError | None = None) -> None:
        if self._ended:
            text = f"{self.name} was {self._ended} on its way{during}"
            raise PicoError(error("device-stopped", text, address=self.name)) from cause

    async def _leg(self, times: np.ndarray, joints: np.ndarray) -> None:
        """Move all stages along one straight leg; if one fails, the others stop."""
        moves = []
        for stage, scale, at in zip(self._stages, SCALE, joints.T, strict=True):
            way = abs(at[-1] - at[0]) * scale
            if way > _STANDS:
                speed = float(np.max(np.abs(np.diff(at)) / np.diff(times))) * scale
                ramp = max(float(times[-1] - times[0]) - way / speed, way / speed / 100)  # as long as it speeds up
                going = stage.move_to(float(at[-1] * scale), speed=speed, acceleration=speed / ramp)
                moves.append(asyncio.ensure_future(going))
        if not moves:
            return
        done, _ = await asyncio.wait(moves, return_when=asyncio.FIRST_EXCEPTION)
        failed = [exc for one in done if (exc := one.exception())]
        if failed and not self._ended:
            await asyncio.gather(*(stage.stop() for stage in self._stages), return_exceptions=True)
        await asyncio.gather(*moves, return_exceptions=True)
        if failed:
            raise failed[0]


USUAL = {"x": "1", "y": "2", "z": "3", "yaw": "4"}
"""The numbers of the stages in the chain."""


def stages_of(entry: DeviceEntry) -> list[dict[str, str]]:
    """Return the place of each stage of a gantry in the chain, as a stage alone has it."""
    return [{"device": number_in(entry.address.get(axis, USUAL[axis])), "axis": "1"} for axis in AXES]


def complaints_of(entry: DeviceEntry) -> Iterator[Complaint]:
    """Yield the axes of a gantry that are said to be one stage."""
    first: dict[str, str] = {}
    for axis, place in zip(AXES, stages_of(entry), strict=True):
        if (other := first.setdefault(place["device"], axis)) != axis:
            stated = axis if axis in entry.address else other
            text = f"`{axis}` and `{other}` are both the stage {place['device']} of the chain"
            hint = f"each axis has a stage of its own; if the address leaves `{axis}` out, it is {USUAL[axis]}"
            yield Complaint(f"address.{stated}", text, hint)


GANTRY = Driver(
    kind="arm", robot="gantry", made=Gantry, opened=opened, closed=lambda link: link.close(),
    address={"host": "its IP address, where it has one", "port": "the TCP port, or the serial port",
             **{axis: f"the number of the stage of {axis} in the chain" for axis in AXES}},
    bus=("host", "port"), usual=USUAL, numbers=dict.fromkeys(AXES, CHAIN), takes=stages_of, check=complaints_of,
    properties=dict(zip(AXES, ("mm", "mm", "mm", "deg"), strict=True)),
    settings={
        "counts_per_mm": Setting(
            range=COUNTS, about="counts a mm of x, y and z: 1 / the microstep size on the vendor's page"
        ),
        "counts_per_deg": Setting(range=COUNTS, about="counts a degree of yaw"),
    },
    needs=STAGE.needs, maturity="emulated", emulator="zaber", link="zaber",
)  # fmt: skip

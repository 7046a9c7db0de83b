"""The gripper at an xArm's end, over the arm's own link; the driver `xarm.gripper`."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

from pico.diagnostics import PicoError, error
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.line import Line
from pico.drivers.protocols import Grip, Identity
from pico.drivers.xarm.arm import DRIVER as ARM
from pico.drivers.xarm.faults import gripper_fault, gripper_told
from pico.drivers.xarm.library import imported
from pico.drivers.xarm.link import Link, identity
from pico.model.instruments.declaration import Setting
from pico.model.instruments.fault import DeviceFault
from pico.model.wiring import DeviceEntry

PULSES = 850
"""What the gripper counts from shut to open."""
_STROKE = 84.0  # mm
_SPEED = 1500  # pulses/s
_MOVING, _HOLDING = 1, 2
_NEAR = 12  # pulses, about 1 mm: what is farther from where it was sent has something between its fingers
_STILL = 3
_EVERY, _LONGEST, _STARTING = 0.05, 5.0, 0.3  # s


class XArmGripper:
    """Implements `pico.drivers.protocols.Gripper`. It can't be told a force."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Link]) -> None:
        """Open nothing yet."""
        self.name = name
        self._stroke = float(entry.setting("stroke", _STROKE))
        self._line = Line(name, bus, entry.identity, self._identified)
        self._enabled: Link | None = None

    async def connect(self) -> Identity:
        """Open the link, and ask which arm answers: the gripper has no serial number of its own. Raises PicoError."""
        await imported(self.name)
        return await self._line.connect()

    async def move_to(self, width: float, *, force: float | None = None) -> Grip:
        """Bring the fingers `width` [mm] apart, or as near as what is between them allows, and say what was found.

        Raises PicoError for a width that it does not have, a `force`, a fault, a stop, and where it does not come to
        rest.
        """
        if force is not None:
            raise PicoError(error("gripper-force", f"{self.name} can't be told a force", address=self.name))
        if not 0.0 <= width <= self._stroke:
            text = f"{self.name} opens to {self._stroke:g} mm, not to {width:g} mm"
            raise PicoError(error("gripper-width", text, address=self.name))
        stops, target = self._line.stops, round(width * PULSES / self._stroke)
        began, alike = time.monotonic(), 0
        before, _ = await self._line.move("move", lambda link: self._sent(link, target))
        while alike < _STILL:
            await asyncio.sleep(_EVERY)
            self._line.require_running(stops, "its fingers are where they came to rest")
            pulses, status = await self._line.ask("tell where it is", self._where)
            spent = time.monotonic() - began
            starting = spent < _STARTING and abs(pulses - target) > _NEAR  # its status may be from before
            alike = 0 if starting or status & 3 == _MOVING or pulses != before else alike + 1
            before = pulses
            if spent > _LONGEST:
                text = f"{self.name} did not come to rest within {_LONGEST:g} s"
                raise PicoError(error("gripper-astray", text, hint="look what keeps it", address=self.name))
        return self._grip(before, status, target)

    async def grip(self) -> Grip:
        """Return how the fingers are, moving nothing."""
        pulses, status = await self._line.ask("tell where it is", self._where)
        return self._grip(pulses, status, None)

    async def faults(self) -> tuple[DeviceFault, ...]:
        """Return the fault of the gripper, if it has one. Raises PicoError if the link is lost."""
        number = await self._line.ask("tell its fault", self._fault)
        return (gripper_fault(self.name, number),) if number else ()

    async def clear(self, *, by_person: bool = False) -> None:
        """Clear the fault of the gripper, see `pico.drivers.protocols.Faulting`; what it holds it keeps holding."""
        await self._line.ask("clear its fault", lambda link: self._cleared(link, by_person))

    async def stop(self) -> None:
        """Stop the fingers; what they hold they keep holding."""
        await self._line.stop(self._kept)

    async def close(self) -> None:
        """Let go of the link."""
        await self._line.close()

    def _identified(self, link: Link) -> Identity:
        arm = identity(self.name, link)
        return Identity(vendor=arm.vendor, model="xArm Gripper", serial=arm.serial, firmware=arm.firmware)

    def _grip(self, pulses: int, status: int, target: int | None) -> Grip:
        held = status & 3 == _HOLDING or (target is not None and pulses - target > _NEAR)
        return Grip(width=pulses * self._stroke / PULSES, holds=held)

    def _ask(self, link: Link, what: str, call: Callable[[], Any]) -> Any:
        """As `Link.ask`; a fault of the gripper is told as one."""
        if fault := self._fault(link):
            raise PicoError(gripper_told(self.name, fault))
        return link.ask(self.name, what, call, taken=(0, 2))

    def _fault(self, link: Link) -> int:
        """Return the number of its fault now, 0 for none."""
        said = link.ask(
            self.name, "tell its fault", lambda: link.arm.get_gripper_err_code(check_baud=False), taken=(0, 2)
        )
        return int(said or 0)

    def _cleared(self, link: Link, by_person: bool) -> None:
        fault = self._fault(link)
        if not fault:
            return
        if not by_person:
            raise PicoError(gripper_told(self.name, fault))
        link.ask(self.name, "clear its fault", lambda: link.arm.clean_gripper_error(check_baud=False), taken=(0, 2))
        self._enabled = None  # it is enabled again before it moves
        if still := self._fault(link):
            raise PicoError(gripper_told(self.name, still))

    def _sent(self, link: Link, target: int) -> tuple[int, int]:
        arm = link.arm
        if self._enabled is not link:
            self._ask(link, "start", lambda: arm.set_gripper_enable(True))
            self._ask(link, "change its mode", lambda: arm.set_gripper_mode(0))
            self._ask(link, "take its speed", lambda: arm.set_gripper_speed(_SPEED))
            self._enabled = link
        self._ask(link, "move", lambda: arm.set_gripper_position(target, wait=False, wait_motion=False))
        return self._where(link)

    def _where(self, link: Link) -> tuple[int, int]:
        """Its position [pulses] and status, asked."""
        link.require_heard()
        pulses = self._ask(link, "tell where it is", lambda: link.arm.get_gripper_position(check_baud=False))
        status = link.ask(self.name, "tell its status", link.arm.get_gripper_status)
        return int(pulses), int(status or 0)

    def _kept(self, link: Link) -> None:
        pulses, status = self._where(link)
        if status & 3 == _MOVING:
            self._ask(link, "stop", lambda: link.arm.set_gripper_position(pulses, wait=False, wait_motion=False))


DRIVER = Driver(
    kind="gripper",
    robot="xarm7",
    made=XArmGripper,
    opened=ARM.opened,
    closed=ARM.closed,
    alive=ARM.alive,
    address=ARM.address,
    bus=ARM.bus,
    places=(),
    properties={},
    settings={"stroke": Setting(default=_STROKE, unit="mm", range=(1, 500), about="how far its fingers open")},
    one_identity=True,
    needs=ARM.needs,
    load=ARM.load,
    maturity="emulated",
    emulator=ARM.emulator,
    link=ARM.link,
)

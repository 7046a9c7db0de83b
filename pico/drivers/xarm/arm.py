"""An xArm7 that follows joint trajectories of our own timing; the driver `xarm.arm`."""

from __future__ import annotations

import asyncio
import math
import socket
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, TypeVar

import numpy as np

from pico.diagnostics import PicoError, error
from pico.drivers.bus import BEAT, LONGEST, Bus
from pico.drivers.driver import Driver
from pico.drivers.line import Line
from pico.drivers.path import Path
from pico.drivers.protocols import ArmState, Identity
from pico.drivers.xarm.faults import box_fault, clearable, told
from pico.drivers.xarm.library import CONTROL_PORT, imported, library
from pico.drivers.xarm.link import Link, identity
from pico.drivers.xarm.path import checked
from pico.drivers.xarm.sender import Sender, SenderLost, SentStream
from pico.drivers.xarm.settings import FENCE, PROPERTIES, SETTINGS, differing, settings
from pico.drivers.xarm.streaming import BRAKE, How, Stream
from pico.model.instruments.fault import DeviceFault
from pico.model.wiring import DeviceEntry

T = TypeVar("T")
ASTRAY = 0.02
"""How far from a path's first posture an arm may stand to follow it [rad]."""
_MOVING, _STOPPED, _RESET = 1, 4, 5
_BY_THE_BOX, _BY_SET_POINTS = 0, 1
_REPORTED = 1.5
"""How long it may take until what was told is reported [s]."""
_GONE = object()
_LOOK = "look at the arm, then run the command again"
_RETURNED = 0.5
"""How long after a stop it may take until the arm is at rest [s]."""


class XArm:
    """Implements `pico.drivers.protocols.Arm`."""

    test = "it turns its last joint by 5 deg, out and back, and is stopped on its way"
    """What its motion test does."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Link]) -> None:
        """Open nothing yet. Raises PicoError for settings that make no sense."""
        self.name, self.settings, self._bus = name, settings(name, entry), bus
        self._line = Line(name, bus, entry.identity, self._identified)
        self._link: Link | None = None
        self._ready_link: object = None  # by which it was got ready, _GONE once that was lost under a motion
        self._stream: Stream | SentStream | None = None
        self._host, self._port = str(entry.address.get("host", "")), int(entry.address.get("port", CONTROL_PORT))
        self._sender: Sender | None = None

    async def connect(self) -> Identity:
        """Open the link and ask who answers; moves nothing. Raises PicoError."""
        await imported(self.name)
        return await self._line.connect()

    async def ready(self) -> ArmState:
        """Configure, read back, enable. Raises PicoError for a fault, and for all that is read back otherwise."""
        stops = self._line.stops
        self._sending()  # it starts while the box is configured
        return await self._line.ask("get ready", lambda link: self._made_ready(link, stops), within=LONGEST)

    async def state(self) -> ArmState:
        """Return how it is; raises PicoError where the link is lost: where its last report is too old, too."""
        return await self._line.ask("tell its state", self._state)

    async def follow(self, times: np.ndarray, joints: np.ndarray, *, doing: str = "") -> ArmState:
        """Follow `joints` (n, 7) [rad] at `times` (n,) [s], and return once it is at rest there; `doing` names the
        operation in what is raised.

        Raises PicoError where it does not stand at the first of them, was stopped, met a fault, or the link was lost.
        """
        path = checked(self.name, times, joints, self.settings)
        during = f" during {doing}" if doing else ""
        try:
            begin = self._line.move("begin to move", lambda link: self._begun(link, path, doing), within=LONGEST)
            stream = await begin
            how = await _ended(stream)
        except SenderLost as exc:
            self._let_go(at_once=True)
            with suppress(PicoError):  # no set-point comes any more: it stands already
                await self.stop()
            text = f"{self.name} was stopped{during}: the process that sends its set-points {exc}"
            raise PicoError(error("device-stopped", text, hint=_LOOK, address=self.name)) from exc
        except ConnectionError as exc:
            self._ready_link = _GONE
            stream.link.distrust(exc)
            text, hint = f"{self.name} was lost{during}: {exc}", "look at the arm; then get it ready again"
            raise PicoError(error("device-lost", text, hint=hint, address=self.name)) from exc
        except asyncio.CancelledError:
            stream.end("halted")
            raise
        if how != "moves":
            text = f"{self.name} was {how} on its way{during}{f': {stream.why}' if stream.why else ''}"
            raise PicoError(error("device-stopped", text, address=self.name))
        return await self.state()

    async def carry(self, mass: float, center: tuple[float, float, float]) -> None:
        """Reckon with `mass` [kg] in the hand beside its load, its center [mm] from the flange; a box that is told of
        another load is to be started again. Raises PicoError where it can't."""
        await self._line.move("reckon with what it carries", lambda link: self._loaded(link, mass, center))

    async def halt(self) -> None:
        """Come to rest on the path, decelerated; `follow` then raises PicoError."""
        if self._stream:
            self._stream.end("halted")
            await asyncio.to_thread(self._stream.join, BRAKE + _RETURNED)

    async def stop(self) -> None:
        """Stop all motion now, decelerated, without waiting for another call."""
        stream, link = self._stream, self._link
        self._line.stopped()
        if stream:
            stream.end("stopped")
        if link is not None:
            with suppress(ConnectionError, PicoError):  # asked again in its turn, over a new link where need be
                await asyncio.to_thread(self._still, link)
        await self._line.stop(self._still)

    async def recover(self, *, by_person: bool = False) -> ArmState:
        """Clear a fault that may be cleared, and get ready; `by_person`: any fault, for a person looked at the arm and
        says so. Raises PicoError naming what a person must do."""
        await self.clear(by_person=by_person)
        return await self.ready()

    async def faults(self) -> tuple[DeviceFault, ...]:
        """Return the fault of the control box, if it has one. Raises PicoError if the link is lost."""
        number = await self._line.ask("tell its fault", Link.fault)
        return (box_fault(self.name, number),) if number else ()

    async def clear(self, *, by_person: bool = False) -> None:
        """Clear the fault of the control box, see `pico.drivers.protocols.Faulting`."""
        await self._line.ask("clear its fault", lambda link: self._cleared(link, by_person))

    async def motion_test(self) -> Mapping[str, float]:
        """Try its motion, its stop and its limits, see `pico.drivers.protocols.MotionTested`; raises PicoError."""
        from pico.drivers.motion_test import motion_test

        return await motion_test(self.name, self)

    async def close(self) -> None:
        """Let go of the link."""
        await self.halt()
        self._let_go()
        await self._line.close()
        self._ready_link = None

    def _sending(self) -> Sender | None:
        """Return the process that sends set-points, started if there is none; None for an arm that takes none."""
        if self._sender is None and self.settings.set_points:
            self._sender = Sender()
        return self._sender

    def _let_go(self, *, at_once: bool = False) -> None:
        """Let the process that sends set-points end: once what moves is at rest, or `at_once`."""
        sender, self._sender = self._sender, None
        if sender is not None:
            sender.kill() if at_once else sender.close()

    def _connected(self, link: Link) -> Sender | None:
        """Return the process that sends set-points, with its connection to the box over which this one has `link`."""
        sender = self._sending()
        try:
            if sender is not None:
                sender.open(link, socket.gethostbyname(self._host), self._port)
        except SenderLost as exc:
            self._let_go()
            text = f"{self.name} can't move: the process that sends its set-points {exc}"
            raise PicoError(error("arm-refused", text, hint="run the command again", address=self.name)) from exc
        return sender

    def _identified(self, link: Link) -> Identity:
        self._link = link
        return identity(self.name, link)

    def _state(self, link: Link) -> ArmState:
        link.require_heard()
        state, fault = link.state(), link.fault()
        on = all(link.arm.motor_enable_states[:7]) and state not in (_STOPPED, _RESET) and not fault
        enabled = bool(on and link is self._ready_link)
        moving, at = state == _MOVING, link.joints()
        lost = self._lost_since(link)
        return ArmState(joints=at, age=link.age, moving=moving, enabled=enabled, fault=fault, lost=lost)

    def _lost_since(self, link: Link) -> str:
        """Why the link was lost by which it was got ready; '' where it was not."""
        return "" if self._ready_link in (None, link) else self._bus.lost or "its link was opened anew"

    def _ask(self, link: Link, what: str, call: Callable[[], Any], *more: int) -> Any:
        return link.ask(self.name, what, call, taken=(0, 2, *more))

    def _made_ready(self, link: Link, stops: int) -> ArmState:
        self._ready_link = None
        if fault := link.fault():
            raise PicoError(told(self.name, fault))
        if link.state() == _MOVING:
            text, hint = f"{self.name} moves, and not by PICO", "end the other program that moves it"
            raise PicoError(error("arm-moves", text, hint=hint, address=self.name))
        for what, call, more in self._configuration(link):
            self._line.require_running(stops, "it was to get ready")
            self._ask(link, what, call, *more)
        self._require_inside(link)
        self._ask(link, "put up its fence", lambda: link.arm.set_fence_mode(True))
        if wrong := _reported(link, lambda: differing(self.name, self.settings, link.arm)):
            raise PicoError(wrong)
        self._line.require_running(stops, "it was to get ready")
        self._ask(link, "enable its motors", lambda: link.arm.motion_enable(True))
        self._start(link)
        self._line.require_running(stops, "it was to get ready")  # the stop is told once more after this
        self._ready_link = link
        if _reported(link, lambda: not self._state(link).enabled):
            self._ready_link = None
            raise PicoError(error("arm-refused", f"{self.name} did not enable its motors", address=self.name))
        self._connected(link)
        return self._state(link)

    def _configuration(self, link: Link) -> list[tuple[str, Callable[[], Any], tuple[int, ...]]]:
        """What it is told, in order. What changes how it moves resets the box, which then is "not ready" (9), as it
        should be: the mode comes last."""
        arm, to = link.arm, self.settings
        ranges = [v for pair in to.ranges for v in pair]
        return [
            ("hold still", lambda: arm.set_state(4), ()),
            ("clear its warnings", arm.clean_warn, ()),
            ("take its gravity direction", lambda: arm.set_gravity_direction(list(to.gravity), wait=False), ()),
            ("take its load", lambda: arm.set_tcp_load(to.load, list(to.load_center)), (9,)),
            ("take its tool offset", lambda: arm.set_tcp_offset(list(to.offset), is_radian=True, wait=False), ()),
            ("take its tool's shape", lambda: arm.set_collision_tool_model(to.tool_model), ()),
            ("look out for itself", lambda: arm.set_self_collision_detection(True), ()),
            ("take its collision sensitivity", lambda: arm.set_collision_sensitivity(to.sensitivity), ()),
            ("hold still", lambda: arm.set_state(4), ()),  # the library has just let it go
            ("not to rebound", lambda: arm.set_collision_rebound(False), ()),
            ("take its tool's speed", lambda: arm.set_reduced_max_tcp_speed(to.tool_speed), ()),
            ("take its joints' speed", lambda: arm.set_reduced_max_joint_speed(to.joint_speed, is_radian=True), ()),
            ("take its joint range", lambda: arm.set_reduced_joint_range(ranges, is_radian=True), ()),
            ("take its fence", lambda: arm.set_reduced_tcp_boundary(to.boundary), ()),
            ("keep these limits", lambda: arm.set_reduced_mode(True), ()),
        ]

    def _require_inside(self, link: Link) -> None:
        """Raise PicoError where the tool, its offset included, is outside the fence: putting that up is a fault."""
        at = self._ask(link, "tell where its tool is", lambda: link.arm.get_position(is_radian=True))
        for axis, v, (low, high) in zip("xyz", at, (self.settings.fence[a] for a in FENCE), strict=False):
            if not low <= v <= high:
                text = f"the tool of {self.name} is outside its fence: {axis} is {v:.0f} mm, of {low:.0f} to {high:.0f}"
                hint = f"move it there by hand, or correct `limits: {axis}` or the tool's offset in `settings`"
                raise PicoError(error("arm-outside", text, hint=hint, address=self.name))

    def _start(self, link: Link) -> None:
        mode = _BY_SET_POINTS if self.settings.set_points else _BY_THE_BOX
        self._ask(link, "change its mode", lambda: link.arm.set_mode(mode))
        self._ask(link, "start", lambda: link.arm.set_state(0))

    def _begun(self, link: Link, path: Path, doing: str) -> Stream | SentStream:
        self._require_ready(link)
        if self._stream and self._stream.link is link and not self._stream.done.done():
            raise PicoError(error("arm-moves", f"{self.name} is moving already", address=self.name))
        if fault := link.fault():
            raise PicoError(told(self.name, fault, doing))
        at = link.joints()
        off = max(abs(a - b) for a, b in zip(at, path.joints[0], strict=True))
        if off > ASTRAY:
            text = f"{self.name} does not stand where its path begins: a joint is {math.degrees(off):.1f} deg off"
            raise PicoError(
                error("arm-astray", text, hint="look again, and plan from where it stands", address=self.name)
            )
        if link.state() in (_STOPPED, _RESET):
            self._start(link)
        pace = self.settings.pace
        if (sender := self._connected(link)) is not None:
            self._stream = sender.follow(self.name, path, doing=doing, pace=pace)
        else:
            own = self._stream = Stream(self.name, link, path, doing=doing, pace=pace, set_points=False)
            own.start()
        return self._stream

    def _require_ready(self, link: Link) -> None:
        """Raise PicoError where it was not got ready over this link."""
        link.require_heard()
        if link is not self._ready_link:
            why = self._lost_since(link)
            text = f"{self.name} is not ready to move" + (f": it was lost, for {why}" if why else "")
            hint = "get it ready first: its settings may be lost"
            raise PicoError(error("arm-refused", text, hint=hint, address=self.name))

    def _loaded(self, link: Link, mass: float, center: tuple[float, float, float]) -> None:
        self._require_ready(link)
        own, whole = self.settings.load, self.settings.load + mass
        at = [(own * a + mass * b) / whole if whole else 0.0
              for a, b in zip(self.settings.load_center, center, strict=True)]  # fmt: skip
        self._ask(link, "take the load in its hand", lambda: link.arm.set_tcp_load(whole, at), 9)
        self._start(link)

    def _still(self, link: Link) -> None:
        if self._stream and not self._stream.done.done():
            self._stream.end("stopped")
            self._stream.join(BRAKE + _RETURNED)
        self._ask(link, "stop", lambda: link.arm.set_state(_STOPPED))

    def _cleared(self, link: Link, by_person: bool) -> None:
        fault = link.fault()
        if not fault:
            return
        if not (by_person or clearable(fault)):
            raise PicoError(told(self.name, fault))
        self._ask(link, "clear its fault", link.arm.clean_error, 1)
        if still := link.fault():  # asked: what the library has may be 0.2 s old
            raise PicoError(told(self.name, still))


def _reported(link: Link, wrong: Callable[[], T]) -> T:
    """Return what is wrong by what a box reports, as soon as that is nothing: reports that were on their way, or that
    this machine was too busy to read, are older than what was told."""
    link.await_reports(2)
    ends = time.monotonic() + _REPORTED
    while (found := wrong()) and time.monotonic() < ends:
        link.await_reports(1)
    return found


async def _ended(stream: Stream | SentStream) -> How:
    """Return how a stream ended; raises ConnectionError as soon as the link is silent, for a request in it may hang,
    and SenderLost as soon as the process is that sends it."""
    done = asyncio.wrap_future(stream.done)
    done.add_done_callback(lambda ended: ended.exception())  # also where nobody waits for it any more
    while not (await asyncio.wait([done], timeout=BEAT))[0]:
        try:
            stream.require_alive()
        except (ConnectionError, SenderLost):
            stream.end("stopped")
            raise
    return done.result()


def _opened(entry: DeviceEntry) -> Link:
    host, port = str(entry.address["host"]), int(entry.address.get("port", CONTROL_PORT))
    return Link.opened(socket.gethostbyname(host), port)  # the library takes any other word for a serial port


DRIVER = Driver(
    kind="arm",
    robot="xarm7",
    made=XArm,
    opened=_opened,
    closed=Link.close,
    alive=Link.require_heard,
    address={
        "host": "the name or IPv4 address of the control box",
        "port": f"its control port, {CONTROL_PORT} as sold",
    },
    bus=("host",),
    places=(),
    properties=PROPERTIES,
    settings=SETTINGS,
    one_identity=True,
    needs=("xarm", "xarm"),
    load=library,
    maturity="emulated",
    emulator="xarm",
    link="xarm",
)

"""The control box on the wire: a control port and the vendor's report ports, on a loopback address of its own.

The vendor's library takes reports only from ports 30001 to 30003, so that every emulated arm needs its own address;
where the machine has only 127.0.0.1, there can be one. The control port is free, since 502 is the administrator's.
"""

from __future__ import annotations

import itertools
import os
import selectors
import socket
import threading
import time
from collections.abc import Callable, Mapping

from pico.emulators.disturbance import Line
from pico.emulators.xarm.claw import Claw
from pico.emulators.xarm.control_box import ControlBox
from pico.emulators.xarm.frames import finished, split
from pico.emulators.xarm.registers import answer
from pico.emulators.xarm.reports import EVERY, report
from pico.emulators.xarm.wire import Wire, WireFault
from pico.motion.types import Joints

_NO_FAULTS = "0 0 0"
_TICK = 0.005
_CONNECTIONS = 5
"""The box takes no more at a time, as users of the vendor's report."""
_ADDRESSES = itertools.count(1)
_MOTION_FINISHED = 2


class XArmEmulator:
    """An emulated xArm7, in a thread of this process; `pace`: how many times faster than real its clock runs.

    `fingers(joints, wanted, now)` says how far apart [mm] the fingers come to rest that are to go to `wanted`;
    `moved(joints, seconds)` is told every step and returns the fault that this meant for the arm, or 0; `way(before,
    after)` says how far a step can go, see `ControlBox`. They are
    called from the emulator's thread. What they raise is raised by `close`. `faults`: the box's fault, the emergency
    stop that is pressed and the gripper's fault, 0 for none, as `faulted` is told whenever they change.
    """

    def __init__(
        self, *, joints: Joints, serial: str = "XI130500000000", pace: float = 1.0, firmware: str = "v2.7.1",
        stroke: float = 84.0, width: float | None = None,
        fingers: Callable[[Joints, float, float], float] | None = None,
        moved: Callable[[Joints, float], int] | None = None, faults: str = "",
        faulted: Callable[[str], None] | None = None,
        way: Callable[[Joints, Joints], tuple[float, int]] | None = None,
    ) -> None:  # fmt: skip
        claw = Claw(stroke=stroke)
        if width is not None:
            claw.pulses = claw.target = claw.ends = width * 850 / stroke
        self.box = ControlBox(tuple(joints), serial=serial, firmware=firmware, claw=claw, moved=moved, way=way)
        if faults:
            self.box.error, self.box.pressed, claw.error = (int(number) for number in faults.split())
        self._faulted, self._faults_told = faulted, faults or _NO_FAULTS
        if fingers:
            claw.fingers = lambda wanted, now: fingers(self.box.joints, wanted, now)
        self.lock = threading.RLock()
        self.faults: list[WireFault] = []
        self.transcript: list[tuple[bytes, bytes]] | None = None
        """Requests and answers where somebody put a list here."""
        self._pace, self._began = pace, time.monotonic()
        self._frozen, self._alive = threading.Event(), False
        self._thread: threading.Thread | None = None
        self._selector = selectors.DefaultSelector()
        self._listeners: list[socket.socket] = []
        self._controls: dict[socket.socket, Wire] = {}
        self._readers: dict[socket.socket, tuple[int, float]] = {}
        self._host, self._port = "", 0
        self._broken: BaseException | None = None
        self.line: Line | None = None
        """Of its reports; commands are answered as ever."""

    @property
    def address(self) -> Mapping[str, str | int]:
        """What replaces the address in a lab's `device:` entry."""
        return {"host": self._host, "port": self._port}

    @property
    def joints(self) -> Joints:
        """Where the arm is now [rad]."""
        with self.lock:
            return self.box.joints

    @property
    def width(self) -> float:
        """How far apart the fingers are now [mm]."""
        with self.lock:
            return self.box.claw.width

    def start(self) -> None:
        """Listen, and serve from a thread of its own. Raises OSError where no loopback address is free."""
        if not self._host:
            self._host, self._port, self._listeners = _listening()
        else:
            self._listeners = _at(self._host, self._port)
        for listener in self._listeners:
            self._selector.register(listener, selectors.EVENT_READ)
        self._alive = True
        self._thread = threading.Thread(target=self._serve, daemon=True, name="emulated xarm")
        self._thread.start()

    def close(self) -> None:
        """End, and let go of the ports. Raises what the world behind it raised."""
        self.kill()
        broken, self._broken = self._broken, None
        if broken:
            raise broken

    def kill(self) -> None:
        """End as a process does that is killed: every connection is gone at once."""
        self._frozen.clear()
        self._alive = False
        if self._thread:
            self._thread.join()
            self._tell_faults()
        self._thread = None
        for open_ in (*self._listeners, *self._controls, *self._readers):
            self._forget(open_)
        self._listeners = []

    def restart(self) -> None:
        """Come up again at the same address, as after a power cycle: what was not saved is lost."""
        self.kill()
        with self.lock:
            self.box = self.box.restarted()
        self.start()

    def reboot(self) -> None:
        """Restart from a thread of its own, for the one that serves ends."""
        threading.Thread(target=self.restart, daemon=True, name="emulated xarm restart").start()

    def freeze(self) -> None:
        """Answer nothing and tell nothing any more, with all connections open."""
        self._frozen.set()

    def thaw(self) -> None:
        """Go on."""
        self._frozen.clear()

    def wire(self, kind: str, *, register: int | None = None, times: int = 1, seconds: float = 0.0) -> None:
        """Let the next answers (of one register) go wrong on the wire: see `WireFault`."""
        with self.lock:
            self.faults.append(WireFault(kind, register, times, seconds))

    def fault(self, number: int) -> None:
        """Let the arm come to a fault now."""
        with self.lock:
            self.box.fail(number)

    def gripper_fault(self, number: int) -> None:
        """Let the gripper come to a fault now: its fingers stay where they are."""
        with self.lock:
            self.box.claw.error = number

    def press(self, button: int = 1) -> None:
        """Press an emergency stop (faults 1 to 3); it stays pressed."""
        with self.lock:
            self.box.pressed = button
            self.box.fail(button)

    def release(self) -> None:
        """Release the emergency stop; the fault stays until it is cleared."""
        with self.lock:
            self.box.pressed = 0

    def _now(self) -> float:
        return (time.monotonic() - self._began) * self._pace

    def _serve(self) -> None:
        try:
            while self._alive:
                if self._frozen.is_set():
                    time.sleep(_TICK)
                    continue
                ready = self._selector.select(_TICK)
                with self.lock:
                    self.box.advance(self._now())
                    for key, _ in ready:
                        self._receive(key.fileobj)  # type: ignore[arg-type]
                    self._send_due()
                    self._tell_faults()
        except BaseException as exc:
            self._broken = exc

    def _tell_faults(self) -> None:
        now = f"{self.box.error} {self.box.pressed} {self.box.claw.error}"
        if self._faulted and now != self._faults_told:
            self._faulted(now)
        self._faults_told = now

    def _receive(self, at: socket.socket) -> None:
        if at in self._listeners:
            self._accept(at)
            return
        try:
            data = at.recv(4096)
        except OSError:
            data = b""
        if not data:
            self._forget(at)
        elif at in self._controls:
            wire = self._controls[at]
            frames, wire.buffer = split(wire.buffer + data)
            for frame in frames:
                self.box.advance(self._now())
                said = answer(self.box, frame)
                if self.transcript is not None:
                    asked = frame.transaction.to_bytes(2, "big") + frame.protocol.to_bytes(2, "big")
                    whole = asked + (1 + len(frame.payload)).to_bytes(2, "big") + bytes([frame.register])
                    self.transcript.append((whole + frame.payload, said))
                wire.say(said, frame.register, self.faults, time.monotonic())
                wire.protocol = frame.protocol

    def _accept(self, listener: socket.socket) -> None:
        connection, _ = listener.accept()
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if len(self._controls) >= _CONNECTIONS:
            connection.close()
            return
        connection.settimeout(1.0)
        port = listener.getsockname()[1]
        if port == self._port:
            self._controls[connection] = Wire()
        else:
            self._readers[connection] = (port, 0.0)
        self._selector.register(connection, selectors.EVENT_READ)

    def _send_due(self) -> None:
        now = time.monotonic()
        over, self.box.finished = self.box.finished, []
        for connection, wire in list(self._controls.items()):
            for transaction, _ in over:
                wire.due.append((now, finished(transaction, wire.protocol, _MOTION_FINISHED)))
            self._send(connection, wire.ready(now))
        for connection, (port, last) in list(self._readers.items()):
            if self.box.now - last >= EVERY[port]:
                self._readers[connection] = (port, self.box.now)
                said = self.reported(connection, port)
                self._send(connection, self.line.sent(said) if self.line else said)

    def reported(self, to: socket.socket, port: int) -> bytes:
        """Return what a reader at a report port is sent now."""
        return report(port, self.box)

    def _send(self, to: socket.socket, data: bytes) -> None:
        try:
            if data:
                to.sendall(data)
        except OSError:
            self._forget(to)

    def _forget(self, closed: socket.socket) -> None:
        if closed.fileno() >= 0:
            self._selector.unregister(closed)
            closed.close()
        self._controls.pop(closed, None)
        self._readers.pop(closed, None)


def _listening() -> tuple[str, int, list[socket.socket]]:
    """Listen at a loopback address where all report ports are free."""
    for number in itertools.islice(_ADDRESSES, 200):
        seed = os.getpid() * 31 + number
        host = f"127.{10 + seed % 240}.{seed // 240 % 250}.{1 + seed // 60000 % 250}"
        try:
            listeners = _at(host, 0)
        except OSError:
            continue
        return host, listeners[0].getsockname()[1], listeners
    listeners = _at("127.0.0.1", 0)
    return "127.0.0.1", listeners[0].getsockname()[1], listeners


def _at(host: str, port: int) -> list[socket.socket]:
    listeners: list[socket.socket] = []
    try:
        for at in (port, *EVERY):
            listener = socket.socket()
            listeners.append(listener)
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind((host, at))
            listener.listen()
    except OSError:
        for listener in listeners:
            listener.close()
        raise
    return listeners

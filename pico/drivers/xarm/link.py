"""An open link to a control box: what it answers, and how long ago it was last heard of."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

from pico.base.awake import Awake
from pico.diagnostics import PicoError, error
from pico.drivers.protocols import Identity
from pico.drivers.xarm.faults import told
from pico.drivers.xarm.library import OPENING, connected, dropped

SILENT = 0.6
"""A box that was not heard of for so long is lost [s], by the time in which this process was running itself.

The library's own `connected` stays true for a box that froze. The box reports every 0.2 s, and a report that was lost
on its way is sent again 0.2 s later (the least that TCP waits): so one lost packet is heard of after 0.4 s at the
latest, and 0.6 s of nothing is two in a row, or no box. An answer counts as a report: the one to each set-point says
that the box took it, or which fault it has.

What may go wrong meanwhile is bounded by something shorter. Set-points are 4 ms apart, each waits for the answer to the
one before, and an arm that gets none stays at the last: it goes on by one set-point, that is 4 mm at 1 m/s. Under a
move of the box itself (`follow: moves`) it goes on to the end of that move at most, whatever is noticed here. So this
limit decides how soon a loss is told (a look every 0.2 s and a second one 0.1 s later: 0.9 s in all), not how far an
arm goes unheard.

What this process did not read because it was not running is no silence: while it stands still it sends nothing, and
what the box said lies in the socket. See `pico.base.awake.Awake`.
"""
PAUSE = 0.3
"""The most that a pause of this process counts [s]; it looks every 0.2 s at least."""
_AGAIN = 0.05
_TAKEN = (0, 2)
"""Codes of the library for what was done; 2 with a warning."""
_UNANSWERED = (-1, 3, 4, 5, 6, 7, 8)
"""Codes for a request that got no answer, or one that belongs to no request: the stream can't be trusted any more."""
_STOPPED = (1, 9, -2, -9)
"""Codes for a fault, a box that is not ready and one that was stopped; which one it is, only register 15 says."""


class Link:
    """A connection that reports. All its methods block, for `library.ANSWER` at most each."""

    def __init__(self, arm: Any) -> None:
        self.arm = arm
        self._news, self._clock = threading.Condition(), Awake(time.monotonic, PAUSE)
        self._heard, self._count = self._clock.now(), 0
        self._wrong = ""
        arm.register_report_callback(self._hear)

    @classmethod
    def opened(cls, host: str, port: int) -> Link:
        """Connect, and wait for the first report; raises ConnectionError where that takes too long."""
        link = cls(connected(host, port))
        try:
            link.await_reports(1, OPENING)
        except BaseException:
            link.close()
            raise
        return link

    def close(self) -> None:
        """Let go of it, at once."""
        dropped(self.arm)

    def _hear(self, report: object) -> None:
        with self._news:
            self._heard, self._count = self._clock.now(), self._count + 1
            self._news.notify_all()

    @property
    def age(self) -> float:
        """How long ago the box was last heard of [s], by the time in which this process was running."""
        return self._clock.now() - self._heard

    def await_reports(self, count: int, within: float = SILENT) -> None:
        """Wait for so many more reports; raises ConnectionError where each takes longer than `within` [s]."""
        with self._news:
            for _ in range(count):
                before, began = self._count, self._clock.now()
                while self._count == before:
                    if self._clock.now() - began > within:
                        raise ConnectionError(f"the control box reported nothing for {within:g} s")
                    self._news.wait(min(_AGAIN, within))

    def excuse(self) -> None:
        """Count its silence from now on."""
        self._heard = self._clock.now()

    def distrust(self, why: Exception) -> None:
        """Count as lost from now on."""
        self._wrong = str(why) or type(why).__name__

    def require_heard(self) -> None:
        """Raise ConnectionError where the link is silent, whatever the library says of it."""
        if self._wrong:
            raise ConnectionError(self._wrong)
        if not self.arm.connected:
            raise ConnectionError("the control box closed the connection")
        if self.age > SILENT:
            raise ConnectionError(f"the control box reported nothing for {self.age:.1f} s")

    def ask(
        self, name: str, what: str, call: Callable[[], Any], *, taken: Sequence[int] = _TAKEN, doing: str = ""
    ) -> Any:
        """Return what a call of the library gives beside its code (None, a value or a list).

        Raises ConnectionError where nothing answers; PicoError, about `name`, for a fault or a refusal of `what`.
        """
        answer = call()
        code, values = (answer[0], answer[1:]) if isinstance(answer, list | tuple) else (answer, ())
        if code in taken:
            self.excuse()
            return values[0] if len(values) == 1 else values or None
        if code in _UNANSWERED:
            raise ConnectionError(f"the control box gave no answer when it was asked to {what}")
        fault = self.fault()
        if fault:
            raise PicoError(told(name, fault, doing))
        during = f" during {doing}" if doing else ""
        if code in _STOPPED:
            text, hint = f"{name} was stopped{during}: it did not {what}", "get it ready again"
        else:
            text, hint = f"{name} refused to {what}{during} (code {code})", ""
        raise PicoError(error("arm-refused", text, hint=hint, address=name))

    def fault(self) -> int:
        """Return the box's fault now, 0 where there is none: asked, for what was reported last may be old."""
        code, (fault, _) = self.arm.get_err_warn_code()
        if code != 0:
            raise ConnectionError("the control box gave no answer when it was asked for its fault")
        return int(fault)

    def joints(self) -> tuple[float, ...]:
        """Return where the joints are now [rad]; asked, for what was reported last is up to 0.2 s old."""
        code, angles = self.arm.get_servo_angle(is_radian=True)
        if code != 0:
            raise ConnectionError("the control box gave no answer when it was asked where it is")
        return tuple(float(v) for v in angles[:7])

    def state(self) -> int:
        """Return the box's state now (1 in motion, 2 ready, 3 paused, 4 stopped, 5 reset)."""
        code, state = self.arm.get_state()
        if code != 0:
            raise ConnectionError("the control box gave no answer when it was asked for its state")
        return int(state)


def identity(name: str, link: Link) -> Identity:
    """Return who answers; raises PicoError where it is no xArm7, or its serial number makes no sense."""
    serial = str(link.ask(name, "tell its serial number", link.arm.get_robot_sn))
    if link.arm.axis != 7:
        text = f"{name} is no xArm7: it has {link.arm.axis} joints"
        raise PicoError(error("device-identity", text, hint="check its address", address=name))
    if not serial[2:6].isdigit():  # the library chooses the table of joint limits by them
        text = f"the serial number of {name} makes no sense: `{serial[:40]}`"
        raise PicoError(error("device-identity", text, hint="is it the address of an xArm7?", address=name))
    firmware = ".".join(str(v) for v in link.arm.version_number)
    return Identity(vendor="UFACTORY", model="xArm7", serial=serial, firmware=firmware)

"""Motion in a thread of its own: set-points of a path at 250 Hz, or the control box's own moves along its corners.

Set-points are sent so by a process that does nothing else (`sending.py`); moves of the box by the driver's own, which
shares the link with the bus (the vendor's library does one request at a time). A thread that was late goes on where it
was: set-points never leap.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from itertools import pairwise
from typing import Literal

import numpy as np

from pico.diagnostics import PicoError, error
from pico.drivers.path import Path
from pico.drivers.xarm.link import Link

PERIOD = 0.004
"""Between set-points [s]."""
BRAKE = 0.25
"""How long coming to rest on the path takes [s]; a joint at the vendor's greatest speed then slows at 20 rad/s2."""
NEAR = 2e-3
"""How far from its end a joint may be for being there [rad]."""
_LATE = 3.0  # periods that a late thread goes on by at once
_LEAP = 0.08
"""By how much of the path a set-point may be ahead of the last one [s]: the box takes none that is 0.3 rad off, which a
bench whose time goes ten times as fast would come to."""
_ARRIVING = 1.0

How = Literal["moves", "halted", "stopped"]


def rate(since: float, brake: float = BRAKE) -> float:
    """Return how fast a path is gone along, as a share, so long after it was to come to rest [s]."""
    return 0.0 if since >= brake else 0.5 * (1.0 + math.cos(math.pi * since / brake))


class Stream:
    """A path that an arm follows, in the `control` mode that the box is in already: `done` has how it ended.

    It fails with ConnectionError where the link is lost, and with PicoError for a fault.
    """

    def __init__(self, name: str, link: Link, path: Path, *, doing: str, pace: float, set_points: bool) -> None:
        self.done: Future[How] = Future()
        self.sent = 0
        """Set-points that were taken."""
        self.why = ""
        """Why it came to rest, if it was not asked to."""
        self.rests = False
        """Whether it comes to rest on its path for now."""
        self._name, self.link, self._path, self._doing, self._pace = name, link, path, doing, pace
        self._wanted: How = "moves"
        self._run: Callable[[], None] = self._follow if set_points else self._move
        self._thread = threading.Thread(target=self._work, daemon=True, name=f"{name} moves")

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def end(self, how: How) -> None:
        """Let it come to rest on the path, now."""
        self._wanted = how

    def join(self, within: float) -> None:
        """Wait until it sends nothing more, for so long at most [s]."""
        self._thread.join(within)

    def require_alive(self) -> None:
        """Raise ConnectionError if the link is silent: a request in it may hang."""
        self.link.require_heard()

    def _work(self) -> None:
        try:
            self._run()
        except (PicoError, ConnectionError) as exc:
            self.done.set_exception(exc)
        except Exception as exc:  # whatever the library makes of an answer that is none
            self.done.set_exception(ConnectionError(f"its answer makes no sense: {exc or type(exc).__name__}"))
        else:
            self.done.set_result(self._wanted)

    def _follow(self) -> None:
        period = PERIOD * self._pace
        place, braking, due = 0.0, 0.0, time.monotonic()
        before = due
        while True:
            now = time.monotonic()
            passed = min((now - before) * self._pace, _LATE * period, _LEAP)
            before = now
            ends = self._wanted != "moves"
            place += passed * rate(braking)
            braking = min(BRAKE, braking + passed) if ends or self.rests else max(0.0, braking - passed)
            self._set(self._path.at(place))
            if place >= self._path.seconds or (ends and rate(braking) == 0.0):
                break
            due = max(due + PERIOD, now - _LATE * PERIOD)
            time.sleep(max(0.0, due - time.monotonic()))
        self._arrive(self._path.at(place))

    def _set(self, joints: list[float]) -> None:
        self.link.require_heard()
        arm = self.link.arm
        self.link.ask(
            self._name, "take a set-point", lambda: arm.set_servo_angle_j(joints, is_radian=True), doing=self._doing
        )
        self.sent += 1

    def _move(self) -> None:
        """Drive from corner to corner, one move at a time: the box would go on with what is queued if we were lost."""
        path, arm = self._path, self.link.arm
        corners = path.corners()
        for first, last in pairwise(corners):
            stretch = slice(first, last + 1)
            turns = np.abs(np.diff(path.joints[stretch], axis=0)) / np.diff(path.times[stretch])[:, None]
            end, speed = path.joints[last].tolist(), max(0.01, float(turns.max()))
            self.link.ask(
                self._name,
                "move",
                lambda end=end, speed=speed: arm.set_servo_angle(angle=end, speed=speed, mvacc=10.0, is_radian=True),  # type: ignore[misc]
                doing=self._doing,
            )
            self._await_rest()
            if self._wanted != "moves":
                return
        self._arrive(path.joints[-1].tolist())

    def _await_rest(self) -> None:
        """Wait until the box's own move is over, or is to end."""
        while (state := self.link.state()) in (0, 1, 3):
            self.link.require_heard()
            if self._wanted != "moves":
                self.link.ask(self._name, "come to rest", lambda: self.link.arm.set_state(6))
            time.sleep(0.01)
        if state > 3:
            self.link.ask(self._name, "arrive", lambda: -9, doing=self._doing)

    def _arrive(self, end: list[float]) -> None:
        """Wait until the joints are where they were sent; raises PicoError where they do not come there."""
        until = time.monotonic() + _ARRIVING
        while max(abs(a - b) for a, b in zip(self.link.joints(), end, strict=True)) > NEAR:
            self.link.require_heard()
            if fault := self.link.fault():
                self.link.ask(self._name, "arrive", lambda fault=fault: fault, taken=(), doing=self._doing)  # type: ignore[misc]
            if time.monotonic() > until:
                text = (
                    f"{self._name} did not come to where it was sent{f' during {self._doing}' if self._doing else ''}"
                )
                hint = "what is in its way? look at the bench"
                raise PicoError(error("arm-astray", text, hint=hint, address=self._name))
            time.sleep(0.005)

"""The presses of keys of one teleoperation, as its edge heard them: the gate that they hold up, and what ended each."""

from __future__ import annotations

from collections import Counter
from typing import Any, Literal

from pico.teleop.deadman import Gate, Refused
from pico.teleop.frames import Frame, Stopped


class Presses:
    """`gate`: what was heard by now. `stopped`: what ended the last press, empty while one goes on; `ended`: how many
    so; `after`: for how long at most something moved after the last frame of a press that was heard [s]."""

    def __init__(self, now: float) -> None:
        self.gate = Gate(heard=now)
        self.stopped: Stopped | Literal[""] = ""
        self.ended, self.after = Counter[str](), 0.0

    def hear(self, frame: Frame, now: float) -> Refused:
        """Take a frame, and return why it authorizes nothing; see `Gate.hear`."""
        self.listen(now)
        before = self.gate
        self.gate, refused = before.hear(frame, now)
        if before.pressed and not self.gate.pressed:
            self._count("released" if frame.release else "late")
        elif self.gate.press > before.press and not refused:
            self.stopped = ""
        return refused

    def listen(self, now: float) -> None:
        """End the press that goes on where nothing was heard of it for too long."""
        if self.gate.lapsed(now):
            self.end("silent")

    def end(self, why: Stopped) -> None:
        """End the press that goes on, if one does: going on takes a fresh one."""
        if self.gate.pressed:
            self._count(why)
        self.gate = self.gate.closed()

    def moved(self, now: float) -> None:
        """Take note that a step ended now."""
        self.after = max(self.after, now - self.gate.held)

    def told(self) -> dict[str, Any]:
        """Return what the journal holds of it."""
        return {"presses": dict(self.ended), "after": round(self.after, 3)}

    def _count(self, why: Stopped) -> None:
        self.stopped = why
        self.ended[why] += 1

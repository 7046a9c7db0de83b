"""The dead-man of a teleoperation, as a pure state machine: which frame authorizes a step, and until when.

The time is passed in. A frame authorizes one step at most, and only one that is over SILENCE after the frame was heard;
the latest frame counts and none is queued. A press that fell silent is over: going on takes a fresh press.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

from pico.teleop.frames import SILENCE, Frame

Refused = Literal["", "stale", "late", "lapsed"]
"""Why a frame authorizes nothing: a later one was heard before it; it was too long on its way; its press is over."""


@dataclass(frozen=True, slots=True)
class Gate:
    """What was heard by now. `heard`: when the last frame came, `press` that it was of, and `pending`, the frame that
    authorizes a step; all of them by the edge's clock [s]."""

    seq: int = 0
    heard: float = -math.inf
    press: int = 0
    held: float = -math.inf
    """When the last frame of the press came."""
    over: int = 0
    """The highest press that is over: it authorizes nothing more."""
    pending: Frame | None = None

    def hear(self, frame: Frame, now: float) -> tuple[Gate, Refused]:
        """Return the gate after a frame, and why that authorizes nothing; empty where it does, or asks for nothing."""
        if frame.seq <= self.seq:
            return self, "stale"
        gate = replace(self, seq=frame.seq, heard=now)
        if frame.release:
            return gate.closed(), ""
        if not frame.press:
            return gate, ""
        gate = replace(gate, pending=None)
        if not abs(now - frame.seen) <= SILENCE:  # also what is ahead of its time, or no number
            return replace(gate, over=max(self.over, frame.press)), "late"
        silent = frame.press == self.press and now - self.held > SILENCE
        if frame.press <= self.over or frame.press < self.press or silent:
            return replace(gate, over=max(self.over, frame.press)), "lapsed"
        return replace(gate, press=frame.press, held=now, pending=frame), ""

    def silent(self, now: float) -> float:
        """Return for how long nothing was heard [s]."""
        return now - self.heard

    @property
    def pressed(self) -> bool:
        """Whether a press goes on, by what was heard."""
        return self.press > self.over

    def lapsed(self, now: float) -> bool:
        """Return whether a press goes on of which nothing was heard for too long: it is over."""
        return self.pressed and now - self.held > SILENCE

    def authorized(self, now: float, seconds: float) -> Frame | None:
        """Return the frame that authorizes a step which takes so long from now on, or None."""
        fits = self.pending is not None and now + seconds <= self.held + SILENCE
        return self.pending if fits else None

    def taken(self) -> Gate:
        """Return the gate once the step that a frame authorized has begun."""
        return replace(self, pending=None)

    def closed(self) -> Gate:
        """Return the gate after the key was released, or its step refused: that press is over."""
        return replace(self, pending=None, over=max(self.over, self.press))

"""Teleoperation: what a hand on a key says, and what comes back.

A frame authorizes at most one step, which is over `SILENCE` seconds after it was heard at the latest: a key that is
held is a frame every few hundredths of a second, and no frame is no motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from pico.model.record import record

SILENCE = 0.2
"""Seconds after the last frame that was heard at which all motion is over."""
STEP_SECONDS = 0.15
"""What one step takes at most [s]: the rest of SILENCE is for its frame to be heard."""
STEPS = frozenset({"take", "jog", "let_go"})
"""What a device does in a teleoperation: take a part in hand where it stands, make one step, set it down where it is.
No plan has them."""
Phase = Literal["taking", "ready", "letting go", "over"]
Stopped = Literal["released", "silent", "late", "refused"]
"""What ends a press: the key was let go; nothing was heard of it for SILENCE; a frame of it was too long on its way; a
step of it was refused."""


@record
class Frame:
    """What a hand on a key says. `seq` counts up; `seen`: the edge's clock in the last answer that was heard [s], so
    that a frame that was long on its way is known. `press` counts presses of keys: frames of one press go on with it,
    and `tunable` is to change `by` so much, in its unit; 0 only says that somebody is there. `release`: no key is down
    any more. `end`: the person is done."""

    seq: int
    seen: float = 0.0
    press: int = 0
    tunable: str = ""
    by: float = 0.0
    release: bool = False
    end: bool = False


@record
class Answer:
    """What the edge says to a frame: its `clock` [s], and why the frame authorizes nothing (`refused`, empty where it
    does). `values`: where what is jogged stands; `steps` done so far, and `missed`, those that were not; `limit`: why
    the last one was not, empty where it was. `stopped`: what ended the last press, empty while one goes on."""

    clock: float
    refused: str = ""
    phase: Phase = "ready"
    values: Mapping[str, float] = field(default_factory=dict)
    steps: int = 0
    missed: int = 0
    limit: str = ""
    stopped: Stopped | Literal[""] = ""


def over(clock: float) -> Answer:
    """Return what is said to a frame where nothing is steered."""
    return Answer(clock=clock, refused="over", phase="over")

"""What goes wrong with emulated devices by themselves: a scenario, `emulation.yaml` beside the instruments."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field

from pico.model.quantities import Length
from pico.model.record import record


@record
class Disturbance:
    """What goes wrong with one emulated device. Lengths and angles are in the units of its driver's properties."""

    travel: tuple[float, float] | None = None
    """The least and greatest position that the device accepts."""
    lost_steps: float = 0.0
    """The share of each move that an axis does not make though it counts it, 0 to 1."""
    settle_error: float = 0.0
    """Standard deviation of where an axis comes to rest."""
    noise: float = 0.0
    """Standard deviation of a reading: of a position in its unit, of a power as a share of it."""
    reboot_after: float | None = None
    """After how many seconds of wall time the device restarts, once."""
    reboot_after_commands: int | None = None
    """After how many commands the device restarts, once."""
    latency: float = 0.0
    """By how much each reply is late, in seconds of wall time."""
    dropped_replies: float = 0.0
    """The share of replies that are lost on the wire, 0 to 1; of an arm, of its reports."""
    unsafe: tuple[float, float] | None = None
    """From when until when a safety input reads unsafe, in seconds of the bench's clock since its emulators were
    started."""

    def __post_init__(self) -> None:
        if self.travel is not None and self.travel[0] >= self.travel[1]:
            raise ValueError("`travel` is [least, greatest]")
        if self.unsafe is not None and not 0 <= self.unsafe[0] < self.unsafe[1]:
            raise ValueError("`unsafe` is [from, until] [s], and not negative")
        for name in ("lost_steps", "dropped_replies"):
            if not 0 <= getattr(self, name) <= 1:
                raise ValueError(f"`{name}` is a share, 0 to 1")
        for name in ("settle_error", "noise", "latency"):
            if getattr(self, name) < 0:
                raise ValueError(f"`{name}` is not negative")
        for name in ("reboot_after", "reboot_after_commands"):
            if getattr(self, name) is not None and getattr(self, name) <= 0:
                raise ValueError(f"`{name}` is above 0")


@record
class Visitor:
    """A person at the emulated bench for a while: an upright cylinder that arms hit and light curtains notice."""

    x: Length
    y: Length
    """Where its axis stands in the table frame [mm]; beside the table, too."""
    radius: Length = 200.0
    height: Length = 800.0
    """How far it rises above the table top [mm]."""
    arrives: float = 0.0
    leaves: float = math.inf
    """From when until when it is there, in seconds of the bench's clock since its emulators were started."""

    def __post_init__(self) -> None:
        if not (self.radius > 0 and self.height > 0):
            raise ValueError("`radius` and `height` are above 0")
        if not 0 <= self.arrives < self.leaves:
            raise ValueError("`arrives` is not negative, and before `leaves`")

    def is_there(self, seconds: float) -> bool:
        """Return whether it is at the bench so long after the emulators were started [s]."""
        return self.arrives <= seconds < self.leaves


@record
class Emulation:
    """A scenario of the emulated bench of a lab: what goes wrong with each device, drawn from `seed`, and who comes to
    the table when."""

    lab: str
    seed: int = 1
    devices: Mapping[str, Disturbance] = field(default_factory=dict)
    people: Mapping[str, Visitor] = field(default_factory=dict)

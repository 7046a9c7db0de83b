"""Who lets a laser emit, and until when. A state asks for light; that it comes out above class 2 takes a person."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from pico.base import clock
from pico.base.state_files import ARMED
from pico.model.record import record

LaserClass = Literal["1", "2", "3R", "3B", "4"]
CLASSES: tuple[LaserClass, ...] = ("1", "2", "3R", "3B", "4")


def within(of: LaserClass, most: LaserClass) -> bool:
    """Return whether a class of lasers is no more dangerous than another one."""
    return CLASSES.index(of) <= CLASSES.index(most)


@record
class LaserRole:
    """What the `people` (as Git's `user.name` has them) of a role may arm: lasers up to `laser_class`, for at most so
    many `hours`."""

    people: tuple[str, ...]
    laser_class: LaserClass = "3R"
    hours: float = 8.0

    def __post_init__(self) -> None:
        if not 0 < self.hours <= 24 * 7:
            raise ValueError(f"`hours` is above 0 and at most {24 * 7}, a week; not {self.hours:g}")


@record
class ArmingPolicy:
    """Who may arm lasers above class 2, by role; and the evidence for which nobody has to (`waived`): what is simulated
    or emulated has no light. Hardware is never waived."""

    waived: tuple[Literal["kinematic", "physics", "emulated"], ...] = ()
    roles: Mapping[str, LaserRole] = field(default_factory=dict)


@record
class Arming:
    """That a person lets a laser emit: `by` (Git's user.name) in a `role`, up to a class, from `begins` to `ends` (ISO
    8601, UTC), on a `backend`. `unattended`: given beforehand, for runs that nobody watches; that person answers.
    `ended_by`: who disarmed it, at `ends`. `seen_over`: its end was seen, so that it never counts again, whatever a
    clock says later."""

    schema: str = ARMED.schema
    laser: str
    by: str
    role: str
    laser_class: LaserClass
    begins: str
    ends: str
    backend: str
    unattended: bool | None = None
    ended_by: str | None = None
    seen_over: bool | None = None

    def __post_init__(self) -> None:
        for name in ("begins", "ends"):
            clock.parse_zoned(getattr(self, name))


@record
class Licence:
    """What lets a laser emit now: up to `laser_class`, and where a person armed it, `by` whom and until when (`ends`).
    Without a person it is waived, for nothing is emitted. `withheld`: why it is for class 2 only, though a person armed
    it for more."""

    laser_class: LaserClass
    by: str = ""
    ends: str = ""
    unattended: bool | None = None
    withheld: str | None = None

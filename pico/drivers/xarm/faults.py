"""What the faults of an xArm mean, what a person must do, and which of them software may clear.

Numbers: the vendor's published list of control box errors (C), joint errors (S) and gripper errors (G); the words and
the judgement what may be cleared are PICO's. Cleared from here is only what does not ask to look at the arm first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pico.diagnostics import Diagnostic, error
from pico.model.instruments.fault import AGAIN, DeviceFault, fault_diagnostic


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault: what it means, what a person must do, and whether `recover` clears it."""

    means: str
    must: str
    clearable: bool = False


_LOOK = "look at the arm first: it hit something, or its load is not the one that `settings` say"
_RESTART = "switch the control box off at its emergency stop and on again; if it comes back, ask the vendor"
_VENDOR = "ask the vendor's support"
_REPLAN = "plan again from where it stands"

BOX: Mapping[int, Fault] = {
    1: Fault("the emergency stop of the control box is pressed", "release it once the bench is safe"),
    2: Fault("the emergency stop inputs of the control box are open", "close the loop of the emergency stop inputs"),
    3: Fault("the emergency stop of the enabling switch is pressed", "release it once the bench is safe"),
    10: Fault("a motor has an error", _RESTART),
    **{10 + n: Fault(f"the motor of joint {n} has an error", _RESTART) for n in range(1, 8)},
    18: Fault("the force sensor does not answer", "check whether a force sensor is mounted and connected"),
    19: Fault("what is at the arm's end does not answer", "check its plug and its baud rate"),
    21: Fault("its kinematics have no solution there", _REPLAN, clearable=True),
    22: Fault("it was about to collide with itself", "move it out of there in manual mode"),
    23: Fault("a joint is beyond its range", "turn that joint back into its range by hand"),
    24: Fault("it was to move faster than it may", "lower the speed, or plan around the singularity", clearable=True),
    25: Fault("the control box could not plan the motion", _REPLAN, clearable=True),
    26: Fault("the control box missed its real time", _VENDOR),
    27: Fault("a joint did not reply", _RESTART),
    28: Fault("the module at the arm's end does not answer", _RESTART),
    30: Fault("a joint turned faster than it may", _LOOK),
    31: Fault("it met a resistance: a collision, or a wrong load", _LOOK),
    32: Fault("an arc has no solution", _REPLAN, clearable=True),
    33: Fault("the inputs of the control box do not answer", _RESTART),
    34: Fault("a recording took too long", "record it again, shorter", clearable=True),
    35: Fault("the tool is beyond the fence", "bring it back inside in manual mode"),
    36: Fault("too many delayed commands wait", "send fewer of them", clearable=True),
    37: Fault("it moved on its own in manual mode", "check load and mounting direction in `settings`"),
    38: Fault("a joint's angle makes no sense", "press the emergency stop, and ask the vendor's support"),
    39: Fault("the power board does not answer", _VENDOR),
    40: Fault("no joint trajectory leads there without a fault", _REPLAN, clearable=True),
    41: Fault("its friction file is not valid", _RESTART),
    42: Fault("its calibration file is not valid", _RESTART),
    50: Fault("the force sensor can't be read", "check the force sensor"),
    51: Fault("the force sensor refuses its mode", "check the force sensor"),
    52: Fault("the force sensor can't be zeroed", "check the force sensor"),
    53: Fault("the force sensor is overloaded", "take the load off the force sensor"),
    60: Fault("set-points moved the tool faster than it may", "lower the speed", clearable=True),
    110: Fault("the arm's base does not answer", _VENDOR),
    111: Fault("a device at the control box does not answer", "check its plug and its baud rate"),
}
"""By the number that the control box reports."""

_UNLISTED = Fault("the vendor's list does not say what that is", _VENDOR)

GRIPPER: Mapping[int, str] = {
    9: "its current can't be measured",
    11: "its current is too high",
    12: "it is too fast",
    14: "its set-point is too far",
    15: "its memory fails",
    20: "its driver fails",
    21: "its driver does not start",
    23: "it is far from where it should be: something blocks it",
    25: "its set-point is beyond its range",
    26: "its position is beyond its range",
    33: "its driver is overloaded",
    34: "its motor is overloaded",
    36: "its driver is of another type",
}
GRIPPER_CHECK = (
    "see what blocks its fingers, and remove it; if nothing does, and it comes back, ask the vendor's support"
)
"""What a person checks for any fault of the gripper."""


def told(name: str, number: int, doing: str = "") -> Diagnostic:
    """Return what a fault of the control box is, for a person; `doing`: the operation that met it."""
    known = BOX.get(number, _UNLISTED)
    return error(
        "arm-fault",
        f"{name} stopped{f' during {doing}' if doing else ''} with fault C{number}: {known.means}",
        detail="it may be cleared from here" if known.clearable else "it is cleared only after a person was there",
        hint=known.must if known.clearable else f"{known.must}; then {AGAIN}",
        address=name,
    )


def box_fault(name: str, number: int) -> DeviceFault:
    """Return a fault of the control box, by the number that it reports."""
    known = BOX.get(number, _UNLISTED)
    return DeviceFault(
        device=name, number=f"C{number}", means=known.means, check=known.must, person=not known.clearable,
        code="arm-fault",
    )  # fmt: skip


def clearable(number: int) -> bool:
    """Return whether a fault is cleared without that a person looked at the arm."""
    return number in BOX and BOX[number].clearable


def gripper_fault(name: str, number: int) -> DeviceFault:
    """Return a fault of the gripper, by the number that it reports."""
    return DeviceFault(
        device=name, number=f"G{number}", means=GRIPPER.get(number, _UNLISTED.means), check=GRIPPER_CHECK,
        code="gripper-fault",
    )  # fmt: skip


def gripper_told(name: str, number: int) -> Diagnostic:
    """Return what a fault of the gripper is, for a person."""
    return fault_diagnostic(gripper_fault(name, number))

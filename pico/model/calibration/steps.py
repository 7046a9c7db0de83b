"""The steps of a calibration: what each finds, of which parts of a bench, and which it builds on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from pico.base import clock
from pico.model.calibration.results import ACCEPTED, Provenance
from pico.model.record import record

CalibrationStep = Literal["intrinsics", "extrinsics", "axes", "dark", "arms", "hands"]
STEPS: Mapping[CalibrationStep, str] = {
    "intrinsics": "the lens of each camera over the table, by the board that a person holds up",
    "extrinsics": "where each of these cameras stands, by the datums, which are the frame of the table",
    "axes": "direction and zero of each mount that turns, by its scale, which a person reads",
    "dark": "what cameras in the beam and power meters read without light",
    "arms": "base, joints and tool of each arm, by the board that it shows",
    "hands": "lens and place of each camera in a hand, by the board on the table",
}
"""What each step finds, in the order in which they are done."""
BEFORE: Mapping[CalibrationStep, CalibrationStep] = {"extrinsics": "intrinsics", "arms": "extrinsics", "hands": "arms"}
"""The step that must be done before another one."""


@record
class StepStanding:
    """How one step of a calibration stands for one part of a bench."""

    step: CalibrationStep
    subject: str
    """A camera, an arm, or the address of a tunable or measurable."""
    why: str = ""
    """Why it is still to be done, or again; empty if it counts."""
    how: Provenance | None = None
    """How its result came about, None without one."""
    age: float | None = None
    """How old the result is [days]."""


def standing(
    subjects: Mapping[CalibrationStep, tuple[str, ...]], found: Mapping[str, Provenance], bench: str,
    serials: Mapping[str, str], now: str, lasts: float | None,
) -> tuple[StepStanding, ...]:  # fmt: skip
    """Return how each step stands for each of its `subjects`, in the order of the steps.

    `found`: how results came about, by `step/subject`; `serials`: of the devices that answer, by device; `now`: ISO
    8601; `lasts`: for how long a result counts [s], None for ever.
    """
    rows = []
    for step in STEPS:
        for subject in subjects.get(step, ()):
            how = found.get(f"{step}/{subject}")
            age = clock.seconds_between(how.at, now) if how and how.at else None
            why = "not done yet" if how is None else _why(how, bench, serials, age, lasts)
            days = None if age is None else age / 86400
            rows.append(StepStanding(step=step, subject=subject, why=why, how=how, age=days))
    return tuple(rows)


def refusal(how: Provenance | None, bench: str, serials: Mapping[str, str]) -> str:
    """Return why a bench refuses a result for where it came from, empty if it does not; one that does not say it counts
    as simulated. `serials`: of the devices that answer, by device."""
    return _why(how or Provenance(bench="sim", evidence="simulated"), bench, serials, None, None)


def _why(how: Provenance, bench: str, serials: Mapping[str, str], age: float | None, lasts: float | None) -> str:
    if how.evidence != ACCEPTED.get(bench, how.evidence):
        return f"its result is {how.evidence} (bench {how.bench}), and {bench} accepts only {ACCEPTED[bench]} ones"
    for device, then in sorted(how.serials.items()):
        now = serials.get(device, then)
        if now != then:
            return f"it was made of {device} with serial number {then}, and {now or 'none'} answers"
    if lasts is not None and age is not None and age > lasts:
        return f"its result is {age / 86400:.1f} days old, and counts for {lasts / 86400:g}"
    return ""

"""Steps that look: whether the calibration holds, and what moves by itself within hours."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pico.base import clock
from pico.bench.calibrating.subjects import standing_of
from pico.bench.commissioning.standing import HOURS, AtBench, Found, shortened
from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.calibration.steps import STEPS, StepStanding
from pico.model.commissioning import CODE
from pico.model.observation import Observation
from pico.vision.calibration_files import command, not_counting, read_calibration

FIRST_HAND = ("", "stereo", "known height")
"""How a pose is known that was seen just now."""


def calibration(at: AtBench) -> Found:
    """Every step of the calibration was done on this bench, with the devices that answer, not too long ago, and what
    cameras see of the datums now agrees with it. Raises PicoError, which names each step that is missing and the
    command for it."""
    root, name = at.edge.place.root, at.edge.place.name
    at.bench.wait(at.device.links.instruments())
    rows = standing_of(at.device, at.edge.now())
    wrong = [*_missing(rows, name)]
    wrong += [replace(one, severity="error") for one in not_counting(root, name)]
    datums: Mapping[str, float] = {}
    if not wrong:
        look = at.bench.cameras.scan()
        datums = look.sighting.datums
        wrong = [one for one in look.observation.problems if one.severity == "error"]
    known = None if wrong else read_calibration(root, name)
    if known is None:
        raise PicoError(wrong)
    age = max((row.age for row in rows if row.age is not None), default=None)
    steps = {f"{row.step}/{row.subject}": row.how.at for row in rows if row.how}
    data = {"made_at": known.made_at, "age_days": age and round(age, 2), "digest": known.digest,
            "position_mm": known.accuracy.position, "steps": steps,
            "datums_mm": {name: round(off, 3) for name, off in datums.items()}}  # fmt: skip
    aged = f"its oldest result is {age:.1f} days old" if age is not None else "of no known date"
    sure = f"a position on the table is known to {known.accuracy.position:.3f} mm"
    off = f", datums are seen within {max(datums.values()):.3f} mm of it now" if datums else ""
    return Found(told=f"{aged}, {sure}{off}", data=data)


def _missing(rows: Sequence[StepStanding], bench: str) -> Iterator[Diagnostic]:
    """Yield one error for each step that is still to be done, with the command for it."""
    for step in STEPS:
        left = [row for row in rows if row.step == step and row.why]
        for why in dict.fromkeys(row.why for row in left):
            names = ", ".join(row.subject for row in left if row.why == why)
            hint = f"`{command(bench)} {step}`: {STEPS[step]}"
            yield error(CODE, f"the step `{step}` of the calibration is missing for {names}: {why}", hint=hint)


def drift(at: AtBench) -> Found:
    """Parts that nobody moves stand where they stood, within the tolerance of each, for `hours`. Begins with a look,
    and each later one counts; it ends with the first after so many hours. Raises PicoError for what has moved."""
    now, poses = at.edge.now(), _poses(at.bench.observe())
    begun, number = at.before, _runs(at)
    moved = _moved_since(at, int(begun["run"])) if begun else set()
    was = {name: pose for name, pose in dict(begun.get("poses", {})).items() if name not in moved}
    if not was:
        first = {"since": now, "run": number, "poses": poses, "looks": [], "hours": at.hours}
        if not poses:
            raise PicoError(error(CODE, "nobody sees any part: nothing to tell drift by"))
        return Found(told=_until(now, at.hours, 1), data=first, begun=True)
    shifts = {name: _shift(pose, poses[name]) for name, pose in was.items() if name in poses}
    most = max(shifts, key=lambda name: shifts[name], default="")
    look = {"at": now, "part": most, "shift_mm": round(shifts.get(most, 0.0), 4)}
    data: dict[str, Any] = {**begun, "hours": at.hours, "looks": [*begun["looks"], look], "left_out": sorted(moved)}
    setup, hours = at.edge.setup, _hours(str(begun["since"]), now)
    wrong = [
        error(CODE, f"{name} has moved by {by:.2f} mm within {hours:.1f} h, and nobody moved it", address=name)
        for name, by in shifts.items()
        if by > setup.type_of(name).pose.tolerance.position
    ]
    wrong += [error(CODE, f"{name} is not seen any more", address=name) for name in sorted(was.keys() - poses.keys())]
    if wrong:
        raise PicoError(wrong)
    if hours < at.hours:
        return Found(told=_until(str(begun["since"]), at.hours, 1 + len(data["looks"])), data=data, begun=True)
    greatest = max(data["looks"], key=lambda one: float(one["shift_mm"]))
    looks = 1 + len(data["looks"])
    told = f"at most {greatest['shift_mm']:.3f} mm ({greatest['part']}) within {hours:.2f} h, {looks} looks"
    return Found(told=told + shortened(at.hours, HOURS, "h"), data=data)


def _until(since: str, hours: float, looks: int) -> str:
    return f"begun at {since}, to be looked at again after {hours:g} h; looks so far: {looks}"


def _poses(seen: Observation) -> dict[str, list[float]]:
    return {
        name: [round(part.pose.x, 4), round(part.pose.y, 4), round(part.pose.yaw, 4)]
        for name, part in sorted(seen.components.items())
        if part.presence == "seen" and part.pose is not None and part.how in FIRST_HAND
    }


def _shift(a: Any, b: Any) -> float:
    return float(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5)


def _hours(since: str, now: str) -> float:
    return clock.seconds_between(since, now) / 3600


def _runs(at: AtBench) -> int:
    last = at.edge.memory.last() if at.edge.memory else None
    return last.number if last else 0


def _moved_since(at: AtBench, number: int) -> set[str]:
    """Return the parts that runs after a number were to move."""
    memory, found = at.edge.memory, set[str]()
    for run in memory.runs() if memory else ():
        if run.number > number:
            plan: Mapping[str, Any] = json.loads((memory and memory.document(run.run)) or "{}")
            moving = ("move", "stow", "operator", "teleoperate", "optimize")
            found |= {str(o["component"]) for o in plan.get("operations", ()) if o["primitive"] in moving}
    return found

"""The report of a commissioning: that a bench was walked through by a person, step by step, and found fit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import Any, Literal

from pico.base.formats import Format
from pico.model.record import digest, record
from pico.model.setup import Setup

Step = Literal[
    "devices", "identities", "calibration", "reach", "motion", "first_move", "stop_distance", "safety_inputs",
    "pick_and_place", "drift",
]  # fmt: skip
STEPS: tuple[Step, ...] = (
    "devices", "identities", "calibration", "reach", "motion", "first_move", "stop_distance", "safety_inputs",
    "pick_and_place", "drift",
)  # fmt: skip
BEFORE: Mapping[Step, tuple[Step, ...]] = {
    "identities": ("devices",),
    "reach": ("devices",),
    "motion": ("devices", "identities"),
    "first_move": ("devices", "reach"),
    "stop_distance": ("first_move",),
    "safety_inputs": ("devices",),
    "pick_and_place": ("calibration", "first_move", "stop_distance", "safety_inputs"),
    "drift": ("calibration",),
}
"""Steps that must have passed before another one."""
ONE_MOTION = "first-motion"
"""The code of an arm that makes one motion a command."""
CODE = "commission"
"""Of what is told of reports."""
FORMAT = Format("pico.commissioning")
FILES: Mapping[str, str] = {"hardware": "commissioning.json", "emulated": "commissioning-emulated.json"}
"""The report of each bench of a lab, in the lab's folder, so that Git keeps what was found when."""
DAYS = 90.0
"""So long a report counts where nobody says how long."""
NEAR = 250.0
"""The greatest speed of tools where a person may be near [mm/s]: of a bench whose stops nobody has tried yet."""
_FIRST: tuple[Step, ...] = ("first_move", "stop_distance", "safety_inputs")


@record
class Basis:
    """What a report is of: the digests of how devices and safety inputs are `wired` and of the `bench` (table, arms,
    cameras), and who answered at each device (`vendor`, `model`, `serial`, `firmware`)."""

    wired: str
    bench: str
    identities: Mapping[str, Mapping[str, str]] = field(default_factory=dict)


@record
class StepResult:
    """What became of a step: `begun` where it goes on another day. `at`: when (ISO 8601, UTC); `by` whom; `told`: what
    was found, in words; `data`: in numbers."""

    outcome: Literal["passed", "failed", "begun"]
    at: str
    by: str
    told: str
    data: Mapping[str, Any] = field(default_factory=dict)


@record
class Commissioning:
    """A report: of which `lab` and which `bench` of it, what that was (`basis`), for how many `days` a step counts, and
    the steps that were done."""

    schema: str = FORMAT.schema
    lab: str
    bench: Literal["hardware", "emulated"]
    basis: Basis
    days: float = DAYS
    steps: Mapping[str, StepResult] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not 0 < self.days <= 366:
            raise ValueError(f"`days` is above 0 and at most 366, not {self.days:g}")

    def passed(self, step: Step) -> bool:
        """Return whether a step was done, and found well."""
        return step in self.steps and self.steps[step].outcome == "passed"


def basis_of(setup: Setup, identities: Mapping[str, Mapping[str, str]]) -> Basis:
    """Return what a report of a bench would be of now."""
    lab, wiring = setup.at_speed(1.0).lab, setup.wiring  # the speed of a run is no other bench
    wired = {"devices": wiring.devices, "safety_inputs": wiring.safety_inputs} if wiring else {}
    bench = {"table": lab.table, "robots": lab.robots, "cameras": lab.cameras, "keep_out": lab.keep_out}
    return Basis(wired=digest(wired), bench=digest(bench), identities=identities)


def changed(report: Commissioning, basis: Basis) -> tuple[str, ...]:
    """Return in words what of a bench is another than when its report was made."""
    return tuple(_changed(report.basis, basis))


def slowly(report: Commissioning | None, bench: str, basis: Basis) -> bool:
    """Return whether tools must move as where a person may be near: a real bench until its first move, its stop and its
    safety inputs were tried, and whenever it is another one since; an emulated one only while that is being done."""
    if report is None or report.bench != bench:
        return bench == "hardware"
    return bool(changed(report, basis)) or not all(report.passed(step) for step in _FIRST)


def motion_tried(report: Commissioning | None, device: str, identity: Mapping[str, str]) -> bool:
    """Return whether the motion test of an arm's driver passed on the device that answers: the serial number and the
    firmware are those of the report, and there is a serial number."""
    if report is None or report.bench != "hardware" or "motion" not in report.steps:
        return False
    tried = report.steps["motion"].data.get("devices", {}).get(device, {})
    same = all(tried.get(key) == identity.get(key) for key in ("serial", "firmware"))
    return bool(identity.get("serial")) and tried.get("passed") is True and same


def _changed(was: Basis, now: Basis) -> Iterator[str]:
    if was.wired != now.wired:
        yield "the devices or safety inputs of the lab's files were changed since"
    if was.bench != now.bench:
        yield "the table, arms, cameras or keep-out zones of the lab were changed since"
    for name in sorted({*was.identities, *now.identities}):
        before, after = was.identities.get(name), now.identities.get(name)
        if before is None or after is None:
            yield f"{name} is {'new' if before is None else 'not there any more'}"
            continue
        for key in ("vendor", "model", "serial", "firmware"):
            if before.get(key, "") != after.get(key, ""):
                yield f"the {key} of {name} is {after.get(key) or 'none'}, and was {before.get(key) or 'none'}"

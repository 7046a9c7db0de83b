"""What a backend saw of a bench: poses with uncertainty and age, values, what is held, what is unknown."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import field, replace
from typing import Any, Literal

from pico.diagnostics import Diagnostic, warning
from pico.model.arming import Licence
from pico.model.catalog import Footprint
from pico.model.lab import Slot
from pico.model.measurement import Measurement
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState

NO_VIEW = "no-view"
"""The code of what is said if no camera over the table can be used."""
UNLOOKED = "unlooked"
"""How a component is known of which nothing is known for that reason."""
Presence = Literal["seen", "missing", "held", "toppled"]
LACKING = ("driver", "plugin", "kind", "emulator")
"""Codes of problems of one device alone: its driver is not installed, or is broken, or nothing emulates it."""
GUARD = "guard"
"""The code of what the guard of light says: it ended light, or could not."""
LOST = "arm-lost"
"""The code of the problem that an arm was lost since it was got ready."""


@record
class Uncertainty:
    """One standard deviation of an observed pose: position [mm], yaw [deg]."""

    position: float = 0.0
    yaw: float = 0.0


@record
class ObservedValue:
    """The value of a tunable. `commanded`: what was last asked for, not read back. `unknown`: has no value."""

    value: Value | None = None
    status: Literal["known", "commanded", "unknown"] = "known"


@record
class ObservedComponent:
    """One component as it was seen: no pose where it is `missing`; `toppled` where it lies on its side; `held` by a
    robot. `age`: seconds since it was seen.

    `how` its pose is known: `stereo`, `known height` (one camera), `in hand`; `fixed` where the lab says; `gripper`;
    `remembered`, `placed` where something hides it and it was seen, or put down by an arm, last; empty: exactly.
    `unlooked` of one that is `missing` only because no camera over the table can be used.
    """

    presence: Presence = "seen"
    pose: Pose | None = None
    uncertainty: Uncertainty = Uncertainty()
    age: float = 0.0
    values: Mapping[str, ObservedValue] = field(default_factory=dict)
    how: str = ""

    @property
    def is_unlooked(self) -> bool:
        """Whether its place is unknown because nothing looked, and not because a look did not find it."""
        return self.presence == "missing" and self.how == UNLOOKED


@record
class UnknownObject:
    """Something that the inventory does not have: an obstacle, never moved. Named `unknown/<marker>`."""

    pose: Pose
    footprint: Footprint
    height: float


@record
class ObservedRobot:
    """A robot as it was seen: joint angles from the base outward [rad], and the component in its gripper.

    `picked`: where that component stood before, as the journal knows; `opening`: the distance between the pads [mm],
    where the gripper tells.
    """

    joints: tuple[float, ...]
    holding: str | None = None
    picked: Pose | None = None
    opening: float | None = None


@record
class Aligned:
    """Why a tunable stays at its live value, whatever a state says: light has the last word on it, by a `goal`.
    `at`: when that was met with the live value (the wall, ISO 8601); empty for a value that no plan set and with which
    the goal was not met."""

    goal: str
    at: str = ""


@record
class Observation:
    """A bench as a backend saw it. `time`: the backend's own clock [s], which simulated time advances.

    `person`: whether somebody is at the table, None where nothing tells.

    `measurements`: what was measured of it as it is, by address (`cam.image`); what was only peeked at is no such.

    `aligned`: tunables by address (`m1.tip`) that a plan to the state at hand leaves at their live values, as
    `pico.bench.alignment.own_values` found for that state; a backend itself knows of none.

    `licences`: what lets lasers emit now, by name, as the edge knows it; of one that it does not name nothing does,
    unless its class is 1 or 2.

    `waits`: when a simulated bench was told to let time pass (ISO 8601), and how long [s]; None for no such time.

    `problems`: what could not be told, or is not as it should be; an error about a component keeps a plan from
    touching it.
    """

    backend: str
    time: float = 0.0
    observed_at: str = ""
    components: Mapping[str, ObservedComponent] = field(default_factory=dict)
    unknown: Mapping[str, UnknownObject] = field(default_factory=dict)
    robots: Mapping[str, ObservedRobot] = field(default_factory=dict)
    person: bool | None = None
    measurements: Mapping[str, Measurement] = field(default_factory=dict)
    licences: Mapping[str, Licence] | None = None
    problems: tuple[Diagnostic, ...] = ()
    aligned: Mapping[str, Aligned] | None = None
    waits: tuple[tuple[str, float], ...] | None = None

    @property
    def known_values(self) -> dict[str, dict[str, Value]]:
        """The tunables that were read back, by component, in the units of the catalog."""
        return {
            name: {t: v.value for t, v in part.values.items() if v.status == "known" and v.value is not None}
            for name, part in self.components.items()
        }


def with_value(seen: Observation, component: str, tunable: str, value: Value) -> Observation:
    """Return what would be seen once a tunable is set to a value."""
    part = seen.components[component]
    part = replace(part, values={**part.values, tunable: ObservedValue(value=value)})
    return replace(seen, components={**seen.components, component: part})


def doubtful(setup: Setup, name: str, part: ObservedComponent) -> bool:
    """Return whether a component was seen less exactly than it must stand: then nobody can say that it is right."""
    tolerance = setup.type_of(name).pose.tolerance
    return part.uncertainty.position > tolerance.position or part.uncertainty.yaw > tolerance.yaw


def slot_at(setup: Setup, pose: Pose) -> str | None:
    """Return the slot in whose capture radius `pose` lies, the nearest of them, or None."""
    near = _slot_cells(setup.lab.slots).get((int(pose.x // _CELL), int(pose.y // _CELL)), ())
    within = [
        (slot.pose.distance(pose), name)
        for name in near
        if (slot := setup.lab.slots[name]).pose.distance(pose) <= slot.capture
    ]
    return min(within)[1] if within else None


_CELL = 50.0  # mm
_cells_of: tuple[Mapping[str, Slot], dict[tuple[int, int], list[str]]] = ({}, {})


def _slot_cells(slots: Mapping[str, Slot]) -> dict[tuple[int, int], list[str]]:
    """Return the slots whose capture radius may reach into each square cell; those of the last lab are remembered."""
    global _cells_of  # noqa: PLW0603
    if _cells_of[0] is not slots:
        cells: dict[tuple[int, int], list[str]] = {}
        for name, slot in slots.items():
            for column in range(int((slot.x - slot.capture) // _CELL), int((slot.x + slot.capture) // _CELL) + 1):
                for row in range(int((slot.y - slot.capture) // _CELL), int((slot.y + slot.capture) // _CELL) + 1):
                    cells.setdefault((column, row), []).append(name)
        _cells_of = (slots, cells)
    return _cells_of[1]


def live_state(setup: Setup, seen: Observation, *, sure: bool = False) -> LabState:
    """Return the live laboratory state: poses as observed, for the name of a slot says neither where in it a part
    stands nor how it is turned.

    Missing, held and toppled parts and unknown values are left out; with `sure` also what was seen less exactly than
    it must stand, or is only remembered.
    """
    components = {}
    for name, part in seen.components.items():
        if part.presence != "seen" or part.pose is None:
            continue
        if sure and (
            part.how in ("remembered", "placed") or (name in setup.lab.inventory and doubtful(setup, name, part))
        ):
            continue
        values = {k: v.value for k, v in part.values.items() if v.value is not None and v.status != "unknown"}
        components[name] = ComponentState(pose=part.pose, values=values)
    return LabState(lab=setup.lab.name, components=components)


def left_standing(setup: Setup, seen: Observation, used: Collection[str | None] = ()) -> Iterator[Diagnostic]:
    """Yield a warning for each arm with an empty hand that stands away from its park pose, one that was stopped on its
    way; `used`: those that will be moved."""
    for name in astray(setup, seen):
        if name not in used:
            hint = "mind the beam and your hands; `pico recover` parks it, and so does `pico apply`, where it has a way"
            yield warning(
                "not-parked", f"{name} stands where it was stopped, not at its park pose", hint=hint, address=name
            )


def astray(setup: Setup, seen: Observation) -> Iterator[str]:
    """Yield the arms with an empty hand that stand away from their park pose."""
    for name, state in sorted(seen.robots.items()):
        arm = setup.lab.robots.get(name)
        if arm is None or arm.model != "xarm7" or not state.joints or state.holding:
            continue
        if not arm.is_parked(state.joints):
            yield name


def observed_from_json(data: Mapping[str, Any] | None) -> ObservedComponent | None:
    """Return the observed component whose `as_json` gave `data`; None for None."""
    if data is None:
        return None
    return ObservedComponent(
        presence=data["presence"],
        pose=Pose(**data["pose"]) if "pose" in data else None,
        uncertainty=Uncertainty(**data["uncertainty"]),
        age=float(data["age"]),
        values={k: ObservedValue(value=v.get("value"), status=v["status"]) for k, v in data["values"].items()},
        how=data.get("how", ""),
    )

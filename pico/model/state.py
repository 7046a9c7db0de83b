"""The laboratory state: every component with the values of its tunables. What a commit holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

from pico.model.by_light import LightReference, is_reference, reference_from_json
from pico.model.lab import Setup
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.record import as_json, digest, record


@record
class ComponentState:
    """Where a component is (at most one of a slot's name and a pose; neither for a part whose pose the lab fixes) and
    the values of its other tunables, in the units that its type declares. `by_light`: tunables whose value light finds;
    these have none in `values`."""

    slot: str | None = None
    pose: Pose | None = None
    values: Mapping[str, Value] = field(default_factory=dict)
    by_light: Mapping[str, LightReference] = field(default_factory=dict)

    @property
    def given(self) -> dict[str, Any]:
        """What the state gives its tunables, as a change holds it: values, and references to light as data."""
        return {**self.values, **{name: one.as_json() for name, one in self.by_light.items()}}

    def as_json(self) -> dict[str, Any]:
        """Return the flat form that manifests use: `slot` or `pose`, and one key a tunable."""
        place: dict[str, Any] = {"slot": self.slot} if self.slot else {}
        if self.pose:
            place["pose"] = as_json(self.pose)
        return place | self.given


@record
class Expectation:
    """A CEL expression over the observed bench that must hold after an apply, and what to say where it does not."""

    that: str
    message: str = ""


@record
class LabState:
    """Components of the inventory with their tunables, and what is expected of the bench in this state."""

    lab: str
    components: Mapping[str, ComponentState] = field(default_factory=dict)
    expect: tuple[Expectation, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """Return the state as flat JSON data, components by name."""
        return {name: part.as_json() for name, part in sorted(self.components.items())}

    def digest(self) -> str:
        """Return the digest of the leaves: independent of how the files are laid out."""
        return digest(self.as_json())


def state_from_json(lab: str, data: Mapping[str, Any]) -> LabState:
    """Return the state whose `as_json` gave `data`; raises KeyError or TypeError for anything else."""
    components = {}
    for name, flat in data.items():
        rest = {k: v for k, v in flat.items() if k not in ("slot", "pose")}
        by_light = {k: reference_from_json(v) for k, v in rest.items() if is_reference(v)}
        pose, values = Pose(**flat["pose"]) if "pose" in flat else None, {k: rest[k] for k in rest if k not in by_light}
        components[name] = ComponentState(slot=flat.get("slot"), pose=pose, values=values, by_light=by_light)
    return LabState(lab=lab, components=components)


def references_of(state: LabState) -> dict[str, LightReference]:
    """Return the references to light of a state by address (`p1.angle`), sorted."""
    return {
        f"{name}.{tunable}": one
        for name, part in sorted(state.components.items())
        for tunable, one in sorted(part.by_light.items())
    }


def place_of(setup: Setup, state: LabState, component: str) -> tuple[str | None, Pose]:
    """Return where `component` belongs in `state`: (slot or None, pose).

    A part that the state does not name belongs in its home slot or at its fixed pose. Raises KeyError for a
    component or slot that the lab does not have.
    """
    part = setup.lab.inventory[component]
    wanted = state.components.get(component)
    if wanted and wanted.pose:
        return None, wanted.pose
    slot = wanted.slot if wanted and wanted.slot else None
    if slot is None and part.pose:
        return None, part.pose
    slot = slot or part.home
    assert slot is not None  # Part guarantees one of home and pose
    return slot, setup.lab.slots[slot].pose


def home_state(setup: Setup) -> LabState:
    """Return the state in which every part of the inventory is at home: what a new simulated world starts from."""
    components = {
        name: ComponentState(slot=part.home) if part.home else ComponentState(pose=part.pose)
        for name, part in setup.lab.inventory.items()
    }
    return LabState(lab=setup.lab.name, components=components)

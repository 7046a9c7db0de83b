"""The laboratory state: every component with the values of its tunables. What a commit holds.

A set-point is a number, or where light says: `{null_of: [p1, p2], offset: 1}`. A number is worth what its axis is;
after a part was re-mounted, homed or exchanged the same number is another angle. What light says outlives that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, Literal

from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.record import as_json, digest, record
from pico.model.setup import Setup
from pico.model.shown.html import number, table

NULL: Final = "null_of"
THROUGH: Final = "through"
OFFSET = "offset"


@dataclass(frozen=True)
class ReferenceKind:
    """One kind of reference: the elements that it `takes` two of; the `elements` and `tunables` that it stands for; an
    `example` of what it names."""

    takes: tuple[str, ...]
    elements: tuple[str, ...]
    tunables: tuple[str, ...]
    example: tuple[str, str]


KINDS: Mapping[str, ReferenceKind] = {
    NULL: ReferenceKind(("polarizer", "waveplate"), ("polarizer", "waveplate"), ("angle",), ("p1", "p2")),
    THROUGH: ReferenceKind(("iris",), ("mirror",), ("tip", "tilt"), ("iris1", "iris2")),
}


@record
class LightReference:
    """Where light says that a tunable belongs: `null_of` two parts, at which as little light passes both as can be, or
    `through` two irises; exactly one. `offset`: how much farther, in the tunable's unit."""

    null_of: tuple[str, str] | None = None
    through: tuple[str, str] | None = None
    offset: float = 0.0

    @property
    def kind(self) -> Literal["null_of", "through"]:
        """Which of the two it is."""
        return NULL if self.null_of is not None else THROUGH

    @property
    def parts(self) -> tuple[str, str]:
        """The two parts that it names."""
        found = self.null_of or self.through
        assert found is not None
        return found

    @property
    def text(self) -> str:
        """It in words: `1° from the null of p1 and p2`."""
        return said(self.as_json())

    def goal(self, address: str) -> str:
        """Return the name of the goal that it is for the tunable at an address: that of its own, `p2.angle`; a beam
        through two irises is one goal for all that bring it there, `through iris1 iris2`."""
        return address if self.kind == NULL else " ".join((THROUGH, *sorted(self.parts)))

    def as_json(self) -> dict[str, Any]:
        """Return it as a manifest holds it; an offset of 0 is none."""
        return {self.kind: list(self.parts)} | ({OFFSET: self.offset} if self.offset else {})


def is_reference(value: Any) -> bool:
    """Return whether a value, as a change or a document holds it, is one that light finds."""
    return isinstance(value, Mapping) and (NULL in value or THROUGH in value)


def reference_from_json(data: Mapping[str, Any]) -> LightReference:
    """Return the reference whose `as_json` gave `data`; raises KeyError, TypeError or ValueError for anything else."""
    first, second = data[NULL] if NULL in data else data[THROUGH]
    pair = (str(first), str(second))
    offset = float(data.get(OFFSET, 0.0))
    return LightReference(null_of=pair, offset=offset) if NULL in data else LightReference(through=pair, offset=offset)


def said(data: Mapping[str, Any], unit: str = "deg") -> str:
    """Return a reference, as data, in words: `1° from the null of p1 and p2`, `through iris1 and iris2`. What a person
    wrote who made a mistake is said as it is."""
    kind = NULL if NULL in data else THROUGH
    named = data[kind] if isinstance(data.get(kind), list | tuple) else [data.get(kind)]
    pair, offset = " and ".join(str(name) for name in named), data.get(OFFSET)
    if kind == THROUGH:
        return f"through {pair}"
    if not offset:
        return f"at the null of {pair}"
    away = f"{offset:.6g}{'°' if unit in ('deg', '') else f' {unit}'}" if isinstance(offset, int | float) else offset
    return f"{away} from the null of {pair}"


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

    def __repr__(self) -> str:
        return f"<state of {self.lab}: {len(self.components)} parts, {self.digest()[:15]}>"

    def _repr_html_(self) -> str:
        rows = [
            (name, part.slot or part.pose or "", ", ".join(f"{k} {number(v)}" for k, v in sorted(part.values.items())))
            for name, part in sorted(self.components.items())
        ]
        return table(repr(self)[1:-1], ("part", "where", "tunables"), rows)

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


def goals_of(state: LabState) -> dict[str, dict[str, LightReference]]:
    """Return the goals that references to light are, by name: each with its references by address."""
    found: dict[str, dict[str, LightReference]] = {}
    for address, one in references_of(state).items():
        found.setdefault(one.goal(address), {})[address] = one
    return found


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


def with_values(state: LabState, values: Mapping[str, Value]) -> LabState:
    """Return a state with some tunables of components that it names at other values, by address."""
    parts = dict(state.components)
    for address, value in values.items():
        component, _, tunable = address.partition(".")
        if component in parts:
            part = parts[component]
            parts[component] = replace(part, values={**part.values, tunable: value})
    return replace(state, components=parts)

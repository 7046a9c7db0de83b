"""A small bench for tables of what lets light out: two lasers of changeable power, a shutter, a holder, a camera."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any

from pico.manifest.catalog import load_catalog
from pico.manifest.load import load_folder
from pico.model.arming import Licence
from pico.model.catalog import ComponentType, Parameter, Tunable
from pico.model.lab import Part, Policy
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.operation import Operation, Reason
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.resources import labs_dir

STRONGEST = 100.0
"""The most that a laser of this bench can emit [mW]: class 3B."""
POSES = {
    "laser": Pose(120, 420, 0), "second": Pose(120, 600, 0), "bare": Pose(120, 250, 0), "gate": Pose(300, 420, 0),
    "holder": Pose(500, 420, 0), "cam": Pose(1060, 420, 0),
}  # fmt: skip
UNKNOWN = ObservedValue(status="unknown")


def commanded(value: Any) -> ObservedValue:
    return ObservedValue(value=value, status="commanded")


@cache
def _types() -> dict[str, ComponentType]:
    catalog = load_catalog()
    laser = catalog["hene_laser_expanded"]
    power = Tunable(unit="mW", range=(0.0, STRONGEST), mover="electronics")
    parameters = {n: p for n, p in laser.parameters.items() if n not in ("power", "laser_class")}
    tunable = replace(laser, name="tunable_laser", parameters=parameters, tunables={**laser.tunables, "power": power})
    plain = replace(laser, name="bare_laser", parameters={**laser.parameters, "power": Parameter(value=3, unit="mW")},
                    tunables={"emission": laser.tunables["emission"]})  # fmt: skip
    others = {name: catalog[name] for name in ("shutter", "sample_holder", "beam_camera")}
    return {"tunable_laser": tunable, "bare_laser": plain, **others}


@cache
def bench(**policy: Any) -> Setup:
    """Return the bench. `laser` and `second` have a shutter and a power of their own, `bare` (3 mW, class 3R) only its
    emission; `gate` is a shutter in the beam of `laser`."""
    setup, _ = load_folder(labs_dir() / "minimal").require()
    kinds = {"laser": "tunable_laser", "second": "tunable_laser", "bare": "bare_laser", "gate": "shutter",
             "holder": "sample_holder", "cam": "beam_camera"}  # fmt: skip
    parts = {name: Part(type=kind, pose=POSES[name]) for name, kind in kinds.items()}
    return Setup(lab=replace(setup.lab, inventory=parts, policy=Policy(**policy)), catalog=_types())


def with_type(setup: Setup, part: str, **changes: Any) -> Setup:
    """Return the bench with a part of a type of its own that differs in some fields."""
    kind = replace(setup.type_of(part), name=f"type_{part}", **changes)
    inventory = {**setup.lab.inventory, part: replace(setup.lab.inventory[part], type=kind.name)}
    return Setup(lab=replace(setup.lab, inventory=inventory), catalog={**setup.catalog, kind.name: kind})


DARK: Mapping[str, Mapping[str, Any]] = {
    "laser": {"emission": True, "shutter": "closed", "power": 0.3},
    "second": {"emission": True, "shutter": "closed", "power": 0.3},
    "bare": {"emission": False}, "gate": {"shutter": "open"},
}  # fmt: skip
"""Both lasers on behind their own shutters, at a power of class 1; the third one off."""


def observed(
    licences: Mapping[str, Licence] | None = None, without: tuple[str, ...] = (), **values: Mapping[str, Any]
) -> Observation:  # fmt: skip
    """Return the bench as observed: `DARK`, with other values of some parts; an `ObservedValue` as it is, None for a
    tunable that is not read at all."""
    parts = {}
    for name, pose in POSES.items():
        own = {**DARK.get(name, {}), **values.get(name, {})}
        read = {
            k: v if isinstance(v, ObservedValue) else ObservedValue(value=v) for k, v in own.items() if v is not None
        }
        parts[name] = ObservedComponent(pose=pose, values=read)
    for name in without:
        parts[name] = replace(parts[name], presence="missing", pose=None)
    return Observation(backend="sim", components=parts, licences=licences)


def set_to(component: str, tunable: str, to: Any, id: str = "op1", primitive: str = "set", **more: Any) -> Operation:
    arguments = {"tunable": tunable, "from": None, "to": to}
    return Operation(id=id, primitive=primitive, component=component, arguments=arguments, reason=Reason(kind="asked"),
                     **more)  # fmt: skip


def carry(component: str, x: float, y: float, id: str = "m1", **more: Any) -> Operation:
    at = POSES[component]
    arguments = {"from": {"pose": {"x": at.x, "y": at.y, "yaw": at.yaw}}, "to": {"pose": {"x": x, "y": y, "yaw": 0.0}}}
    return Operation(id=id, primitive="move", component=component, robot="arm1", arguments=arguments,
                     reason=Reason(kind="changed"), **more)  # fmt: skip


def search(tunables: Mapping[str, Any], primitive: str = "optimize", first: Any = None, id: str = "op1") -> Operation:
    """Return an operation that searches or steers tunables, by address, within bounds (None for none)."""
    arguments: dict[str, Any] = {"goal": "g", "what": {"tunables": dict(tunables)}}
    arguments |= {"first": [{"what": {"tunables": one}} for one in first]} if first else {}
    return Operation(id=id, primitive=primitive, component="cam", arguments=arguments, reason=Reason(kind="align"))

"""The shipped benches with something changed on them, and what the beam audit says of a plan that opens their laser."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from pico.diagnostics import Diagnostic
from pico.history.examples.replay import replay
from pico.manifest.catalog import load_catalog
from pico.manifest.load import load_files, load_folder
from pico.model.catalog import Parameter
from pico.model.lab import Part
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.policy.audit import audit_of, told_of

LABS = Path(__file__).resolve().parents[2] / "labs"
CATALOG = load_catalog()


@dataclass(frozen=True)
class Bench:
    """A bench: its lab and types, where everything stands, and what it is set to."""

    setup: Setup
    poses: Mapping[str, Pose]
    values: Mapping[str, Mapping[str, Any]]

    def move(self, name: str, *, dx: float = 0.0, dy: float = 0.0, dyaw: float = 0.0) -> Bench:
        at = self.poses[name]
        return replace(self, poses={**self.poses, name: Pose(at.x + dx, at.y + dy, at.yaw + dyaw)})

    def without(self, name: str) -> Bench:
        return replace(self, poses={n: p for n, p in self.poses.items() if n != name})

    def set(self, name: str, **values: Any) -> Bench:
        return replace(self, values={**self.values, name: {**self.values.get(name, {}), **values}})

    def unset(self, name: str, tunable: str) -> Bench:
        own = {key: value for key, value in self.values.get(name, {}).items() if key != tunable}
        return replace(self, values={**self.values, name: own})

    def put(self, name: str, kind: str, x: float, y: float, yaw: float = 0.0, **parameters: Any) -> Bench:
        """Add a part of a type of the catalog with other parameters; None: without it."""
        parts = {**self.setup.lab.inventory, name: Part(type=kind, home="none")}
        setup = replace(self.setup, lab=replace(self.setup.lab, inventory=parts),
                        catalog={**self.setup.catalog, kind: CATALOG[kind]})  # fmt: skip
        poses = {**self.poses, name: Pose(x, y, yaw)}
        return replace(self, setup=setup, poses=poses).made(name, **parameters)

    def made(self, name: str, **changes: Any) -> Bench:
        """Give a part a type of its own: with other parameters, `tilt` another range of tip and tilt [mrad]."""
        kind, tilt, ends, element = self.setup.type_of(name), changes.pop("tilt", None), "ends", "element"
        parameters = dict(kind.parameters)
        optics = replace(kind.optics, ends_beams=changes.pop(ends, kind.optics.ends_beams))
        optics = replace(optics, element=changes.pop(element, optics.element))
        for key, value in changes.items():
            unit = parameters[key].unit if key in parameters else ""
            parameters.pop(key, None)
            if value is not None:
                parameters[key] = Parameter(value=value, unit=unit)
        tunables = dict(kind.tunables)
        if tilt is not None:
            tunables |= {n: replace(tunables[n], range=tilt) for n in ("tip", "tilt")}
        made = replace(kind, name=f"type_{name}", parameters=parameters, optics=optics, tunables=tunables)
        lab = self.setup.lab
        part = replace(lab.inventory[name], type=made.name)
        lab = replace(lab, inventory={**lab.inventory, name: part})
        return replace(self, setup=Setup(lab=lab, catalog={**self.setup.catalog, made.name: made}))

    def policy(self, **words: Any) -> Bench:
        lab = self.setup.lab
        return replace(self, setup=replace(self.setup, lab=replace(lab, policy=replace(lab.policy, **words))))

    @property
    def seen(self) -> Observation:
        """The bench as observed."""
        parts = {
            name: ObservedComponent(
                pose=pose, values={k: ObservedValue(value=v) for k, v in self.values.get(name, {}).items()}
            )
            for name, pose in self.poses.items()
        }
        return Observation(backend="sim", components=parts)


def bench_of(setup: Setup, state: LabState) -> Bench:
    poses = {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}
    return Bench(setup, poses, {name: dict(part.values) for name, part in state.components.items()})


@cache
def shipped(lab: str) -> Bench:
    """Return a shipped bench as its manifests want it, its laser on."""
    return bench_of(*load_folder(LABS / lab).require())


@cache
def states(lab: str) -> Mapping[str, Bench]:
    """Return a shipped bench at each commit of its history, by tag."""
    files = {str(path.relative_to(LABS / lab)): path.read_bytes()
             for path in sorted((LABS / lab).rglob("*.yaml")) if path.name != "history.yaml"}  # fmt: skip
    history = yaml.safe_load((LABS / lab / "history.yaml").read_text())["commits"]
    return {one.tag: bench_of(*load_files(one.files, [], root=lab).require()) for one in replay(history, files)}


def plan_of(bench: Bench, *operations: Operation) -> Plan:
    """Return a plan of these operations, as if it led to where the bench is."""
    setup = bench.setup
    return Plan(
        lab=LabRef(name=setup.lab.name, digest=""), backend="sim", fidelity="kinematic", base=Base(), target=Target(),
        operations=operations,
    )  # fmt: skip


def setting(component: str, tunable: str, to: Any, number: int = 1, primitive: str = "set") -> Operation:
    arguments = {"tunable": tunable, "to": to} if primitive == "set" else {"tunable": tunable}
    return Operation(
        id=f"op{number}", primitive=primitive, component=component, arguments=arguments, reason=Reason(kind="asked")
    )


def carrying(bench: Bench, component: str, *after: str, dx: float = 0.0) -> Operation:
    """Return the operation of an arm that moves a part by `dx` [mm]."""
    at = bench.poses[component]
    to = {"pose": as_json(replace(at, x=at.x + dx))}
    return Operation(
        id="carry", primitive="move", component=component, robot="arm1", after=after,
        arguments={"from": {"pose": as_json(at)}, "to": to}, reason=Reason(kind="asked"),
    )  # fmt: skip


def said(bench: Bench, *operations: Operation) -> Iterator[Diagnostic]:
    """Yield what the audit says of a plan; without operations of one that opens the shutter of the laser."""
    laser = "laser"
    opening = setting(laser, "shutter", "open")
    shut = bench if operations else bench.set(laser, shutter="closed", emission=True)
    plan = plan_of(shut, *(operations or (opening,)))
    yield from told_of(plan, *audit_of(shut.setup, plan, shut.seen))

"""Small benches for the tests of planning: blocks of 60 x 60 mm on a table of 800 x 500, storage at the front."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from pico.model.catalog import Axis, ComponentType, Footprint, Geometry, Grasp, Tunable
from pico.model.lab import Lab, Part, Slot, Table
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState
from pico.motion.types import Motion
from pico.planning import PlanGoal, Planner

Places = Mapping[str, str | tuple[float, ...]]

GRASP = Grasp(height=100, width=30)
TALL = Geometry(footprint=Footprint(box=(60, 60)), height=140, mass=0.3, grasp=GRASP)
TYPES = {
    "block": ComponentType(
        name="block",
        title="Block in a rotation mount",
        geometry=TALL,
        tunables={
            "angle": Tunable(
                unit="deg", period=360, tolerance=0.1, mover="motor", axis=Axis(kind="homed", speed=30), settle=0
            ),
            "exposure": Tunable(unit="ms", settle=100),
            "filter": Tunable(datatype="choice", choices=("red", "blue"), mover="person"),
        },
    ),
    "one_way": ComponentType(
        name="one_way", title="Jaws close along x", geometry=replace(TALL, grasp=replace(GRASP, yaws=(0.0,)))
    ),
    "low": ComponentType(
        name="low", title="Low", geometry=replace(TALL, height=60, grasp=replace(GRASP, height=50, yaws=(0.0,)))
    ),
    "tall_one_way": ComponentType(
        name="tall_one_way", title="Tall", geometry=replace(TALL, grasp=replace(GRASP, height=110, yaws=(0.0,)))
    ),
    "rail": ComponentType(name="rail", title="Long part", geometry=replace(TALL, footprint=Footprint(box=(120, 60)))),
}  # fmt: skip
SLOTS = {"s1": Slot(x=60, y=60), "s2": Slot(x=160, y=60)}


def bench(parts: Mapping[str, Part | str], slots: Mapping[str, Slot] = SLOTS, **lab: Any) -> Setup:
    """Return a lab with these parts; one that is named by its type alone has its home in the first slot."""
    first = next(iter(slots), "none")
    inventory = {n: Part(type=p, home=first) if isinstance(p, str) else p for n, p in parts.items()}
    settings: dict[str, Any] = {
        "name": "bench",
        "table": Table(size=(800, 500)),
        "slots": slots,
        "robots": {"arm1": Robot(mount=Mount(x=400, y=500, yaw=-90))},
        "inventory": inventory,
    }
    return Setup(lab=Lab(**settings | lab), catalog=TYPES)


def part(kind: str = "block", **rest: Any) -> Part:
    """Return a part of a type, at home in the first slot where nothing else is said."""
    return Part(type=kind, **({"home": "s1"} | rest if "pose" not in rest else rest))


def see(
    setup: Setup, places: Places, values: Mapping[str, Mapping[str, Any]] | None = None, **rest: Any
) -> Observation:
    """Return the observation of parts at (x, y[, yaw]) or in slots."""
    components = {}
    for name, where in places.items():
        pose = setup.lab.slots[where].pose if isinstance(where, str) else Pose(*where)
        known = {
            k: ObservedValue(value=v) if v is not None else ObservedValue(value=None, status="unknown")
            for k, v in (values or {}).get(name, {}).items()
        }
        components[name] = ObservedComponent(pose=pose, values=known)
    return Observation(backend="sim", components=components, **rest)


def want(places: Places, values: Mapping[str, Mapping[str, Any]] | None = None) -> LabState:
    """Return the state with parts at (x, y[, yaw]) or in slots."""
    values = values or {}
    return LabState(
        lab="bench",
        components={
            n: ComponentState(slot=w, values=values.get(n, {})) if isinstance(w, str)
            else ComponentState(pose=Pose(*w), values=values.get(n, {}))
            for n, w in places.items()
        },
    )  # fmt: skip


def planned(setup: Setup, seen: Observation, wanted: LabState, motion: Motion | None = None, **rest: Any) -> Plan:
    """Return the plan."""
    return Planner(setup, motion, seen).plan(PlanGoal(wanted, **rest))


def one(
    goal: Callable[..., PlanGoal], setup: Setup, seen: Observation, *arguments: Any, motion: Motion | None = None
) -> Plan:  # fmt: skip
    """Return the plan of one operation: `goal` is a function of `pico.planning`, with its arguments after the bench."""
    planner = Planner(setup, motion, seen)
    return planner.plan(goal(planner, *arguments))


def moves(made: Plan) -> list[tuple[str, str]]:
    """Return (component, destination) of each move, in order."""
    out = []
    for o in made.operations:
        if o.primitive in ("move", "stow") or (o.primitive == "operator" and "from" in o.arguments):
            to = o.arguments["to"]
            out.append((o.component, to.get("slot") or f"{to['pose']['x']:g},{to['pose']['y']:g}"))
    return out

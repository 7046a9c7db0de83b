"""What rules see of a plan and its bench: plain JSON data, in the units of the manifests."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.policy.beams import open_beams


def policy_values(setup: Setup, plan: Plan, seen: Observation, spoken: Collection[str]) -> dict[str, Any]:
    """Return those of `plan`, `operations`, `components`, `lasers`, `lab`, `backend`, `fidelity` and `supervised` that
    are `spoken` of.

    An operation is that of the plan with `robot` ("" for none), `by_hand`, the `mass` of what it moves [kg] and
    `open_beams`: the lasers whose beam may be open while it runs. A component has its type, parameters, `mass`,
    `radius` and `height` [mm], `beam_height` [mm], `seating`, where it is seen (`live`: its tunables as read back) and
    what it shall be (`desired`), `moves`, and the keep-out zones (`keep_out`) that it would stand in.
    """
    lasers = [n for n in sorted(setup.lab.inventory) if setup.type_of(n).optics.element == "source"]
    opened = open_beams(setup, plan.operations, seen, lasers) if "operations" in spoken else {}
    moving = {op.component for op in plan.operations if op.carries or op.kind.by_hand}
    told: dict[str, Callable[[], Any]] = {
        "plan": lambda: {k: v for k, v in as_json(plan).items() if k not in ("policy", "digest")},
        "operations": lambda: [_operation(setup, op, opened[op.id]) for op in plan.operations],
        "components": lambda: {n: _component(setup, n, plan, seen, n in moving) for n in sorted(setup.lab.inventory)},
        "lasers": lambda: lasers,
        "lab": lambda: _lab(setup),
        "backend": lambda: plan.backend,
        "fidelity": lambda: plan.fidelity,
        "supervised": lambda: _people(seen),
    }
    return {name: value() for name, value in told.items() if name in spoken}


def _lab(setup: Setup) -> dict[str, Any]:
    lab = as_json(setup.lab)
    kept = {k: lab[k] for k in ("name", "table", "regions", "keep_out", "margins") if k in lab}
    return kept | {"open_beam": setup.lab.policy.open_beam}


def _people(seen: Observation) -> str:
    """Return who answers for the bench: those whose armings count now."""
    return ", ".join(sorted({one.by for one in (seen.licences or {}).values() if one.by}))


def _operation(setup: Setup, op: Operation, opened: list[str]) -> dict[str, Any]:
    moved = (op.carries or op.kind.by_hand) and op.component in setup.lab.inventory
    mass = setup.type_of(op.component).geometry.mass if moved else 0.0
    own = {"robot": op.robot or "", "by_hand": op.kind.by_hand, "mass": mass, "open_beams": opened}
    return {**as_json(op), **own}


def _component(setup: Setup, name: str, plan: Plan, seen: Observation, moves: bool) -> dict[str, Any]:
    kind, part, live = setup.type_of(name), setup.lab.inventory[name], seen.components.get(name)
    read = {k: v.value for k, v in live.values.items() if v.status == "known" and v.value is not None} if live else {}
    wanted = plan.target.state.get(name, {})
    return {
        "type": kind.name,
        "element": kind.optics.element,
        "parameters": {k: p.value for k, p in kind.parameters.items()},
        "mass": kind.geometry.mass,
        "radius": kind.geometry.footprint.radius,
        "height": kind.geometry.height,
        "beam_height": kind.frames.optical[2],
        "seating": setup.seating_of(name),
        "stage": part.stage,
        "tethered": part.tether is not None,
        "presence": live.presence if live else "missing",
        "pose": as_json(live.pose) if live and live.pose else {},
        "live": read,
        "desired": {k: v for k, v in wanted.items() if k not in ("slot", "pose")},
        "moves": moves,
        "keep_out": _zones(setup, name, plan) if moves and setup.lab.keep_out else [],
    }


def _zones(setup: Setup, name: str, plan: Plan) -> list[str]:
    """Return the keep-out zones that a component would stand in, wherever operations put it down."""
    from pico.geometry import conflict, outline, placed, reaches

    geometry = setup.type_of(name).geometry
    goals = [op.arguments["to"]["pose"] for op in plan.operations if op.component == name and _placed(op)]
    shapes = [placed(geometry.footprint, Pose(**goal)) for goal in goals]
    zones = {k: z for k, z in setup.lab.keep_out.items() if reaches(z, 0.0, geometry.height)}
    return sorted(k for k, zone in zones.items() if any(conflict(shape, outline(zone)) for shape in shapes))


def _placed(op: Operation) -> bool:
    return isinstance(op.arguments.get("to"), dict) and "pose" in op.arguments["to"]

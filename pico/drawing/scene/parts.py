"""Components as a scene has them: what they are, and how they stand now. mm, deg."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pico.geometry.mass import bodies_of
from pico.model.body import Body
from pico.model.catalog import ComponentType
from pico.model.observation import ObservedComponent, UnknownObject
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.optics.axis import shift
from pico.twin.placement import Placement, upright
from pico.twin.scene import orientation

STAGES = ("stage_x", "stage_y", "stage_z")
RECALLED = ("remembered", "placed", "fixed")
"""How a pose is known that was not seen just now."""


def part(setup: Setup, name: str) -> dict[str, Any]:
    """Return what a component of the inventory is: type, shapes, tunables with their limits."""
    own, kind = setup.lab.inventory[name], setup.type_of(name)
    geometry = kind.geometry
    return {
        "name": name, "type": own.type, "title": kind.title, "element": kind.optics.element, "serial": own.serial,
        "note": own.note, "home": own.home, "marker": own.marker, "movable": setup.movable(name),
        "height": geometry.height, "footprint": as_json(geometry.footprint),
        "optical": list(kind.frames.optical), "aperture": as_json(geometry.clear_aperture),
        "bodies": [_body(body) for body in bodies_of(geometry)],
        "tunables": {key: as_json(tunable) for key, tunable in sorted(kind.tunables.items())},
        "measurables": {key: as_json(measurable) for key, measurable in sorted(kind.measurables.items())},
    }  # fmt: skip


def stranger(name: str, thing: UnknownObject) -> dict[str, Any]:
    """Return what something is that no inventory has: a block of its outline."""
    from pico.model.catalog import Geometry

    block = Geometry(footprint=thing.footprint, height=thing.height, mass=0.0)
    return {
        "name": name, "type": "", "title": "not in the inventory", "element": "none", "movable": False,
        "height": thing.height, "footprint": as_json(thing.footprint),
        "bodies": [_body(replace(body, name="block")) for body in bodies_of(block)], "tunables": {}, "measurables": {},
    }  # fmt: skip


def standing(setup: Setup, name: str, seen: ObservedComponent, place: Placement | None) -> dict[str, Any]:
    """Return how a component stands: `state` (`seen` now, `known` from before, `held`, `lost`), where, and what its
    tunables read."""
    kind = setup.type_of(name)
    values = {key: as_json(value) for key, value in sorted(seen.values.items())}
    found = {"name": name, "state": state_of(seen), "presence": seen.presence, "how": seen.how, "values": values}
    if any(body.rides for body in kind.geometry.bodies):
        found["stages"] = _stages(kind, {key: value.value for key, value in seen.values.items()})
    return found | where(place)


def stands(name: str, thing: UnknownObject) -> dict[str, Any]:
    """Return where something stands that no inventory has."""
    return {"name": name, "state": "seen", "presence": "seen", "how": "", "values": {}} | where(upright(thing.pose))


def state_of(seen: ObservedComponent) -> str:
    """Return how a component is known: it is `lost` where it is missing or lies on its side."""
    if seen.presence in ("missing", "toppled"):
        return "lost"
    if seen.presence == "held":
        return "held"
    return "known" if seen.how in RECALLED else "seen"


def where(place: Placement | None) -> dict[str, Any]:
    """Return a place as `position` [mm], `quaternion` (w, x, y, z) and, seen from above, `pose`; null where unknown."""
    if place is None:
        return {"position": None, "quaternion": None, "pose": None}
    pose = place.pose
    return {
        "position": [round(1000 * v, 4) for v in place.position], "quaternion": [round(v, 7) for v in place.quaternion],
        "pose": {"x": round(pose.x, 4), "y": round(pose.y, 4), "yaw": round(pose.yaw, 4)},
    }  # fmt: skip


def _stages(kind: ComponentType, values: Mapping[str, Any]) -> dict[str, float]:
    return {key: shift(kind, values, key) for key in STAGES}


def _body(body: Body) -> dict[str, Any]:
    """A box of the whole `size` along x, y, z, or a cylinder of diameter and length along its own z."""
    return {
        "name": body.name, "shape": body.shape, "size": list(body.size), "at": list(body.at),
        "quaternion": [round(v, 9) + 0.0 for v in orientation(body)], "color": list(body.color),
        **({"rides": body.rides} if body.rides else {}),
    }  # fmt: skip

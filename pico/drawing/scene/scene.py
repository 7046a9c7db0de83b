"""The scene of a bench as one document (`pico.scene/v1`), from which a page draws it and goes on by frames and events.

Lengths are in mm, angles in deg, joints in rad; quaternions are (w, x, y, z). A component has an `index` that stays its
own as long as the `epoch` does; `rev` counts what changes beyond where things are.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from pico.drawing.scene.arms import links_of, reach_of
from pico.drawing.scene.parts import part, standing, stands, stranger
from pico.drawing.scene.rays import segments
from pico.model.lab import Table
from pico.model.observation import ObservedComponent
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.twin.moment import Moment
from pico.twin.scene import TABLE_THICKNESS

SCHEMA = "pico.scene/v1"
UNITS = {"length": "mm", "angle": "deg", "joint": "rad", "power": "mW", "wavelength": "nm", "time": "s"}
Document = dict[str, Any]
LOST = ObservedComponent(presence="missing")


def numbered(setup: Setup, moment: Moment, before: tuple[str, ...] = ()) -> tuple[str, ...]:
    """Return the names of the components by their index: those of the inventory first, then strangers as they come."""
    names = before or tuple(sorted(setup.lab.inventory))
    return names + tuple(name for name in sorted(moment.seen.unknown) if name not in names)


def scene(setup: Setup, moment: Moment, names: tuple[str, ...]) -> Document:
    """Return what a bench is and how it stands; its `epoch` and `rev` are for who counts them."""
    return {
        "schema": SCHEMA, "units": UNITS, "lab": setup.lab.name, "time": moment.seen.time,
        "table": _table(setup), "cameras": _cameras(setup),
        "arms": [arm(setup, name, number, moment) for number, name in enumerate(sorted(setup.lab.robots))],
        "components": [component(setup, name, number, moment) for number, name in enumerate(names)],
        "beams": beams(setup, moment),
    }  # fmt: skip


def component(setup: Setup, name: str, index: int, moment: Moment) -> Document:
    """Return what a component is, and how it stands."""
    thing = moment.seen.unknown.get(name)
    kind = part(setup, name) if name in setup.lab.inventory else stranger(name, thing) if thing else {}
    return {**kind, **now(setup, name, index, moment)}


def now(setup: Setup, name: str, index: int, moment: Moment) -> Document:
    """Return how a component stands."""
    if name in setup.lab.inventory:
        seen, place = moment.seen.components.get(name, LOST), moment.places.get(name)
        hands = (robot for robot, one in moment.seen.robots.items() if one.holding == name)
        found = standing(setup, name, seen, None if seen.presence == "missing" else place)
        found["held_by"] = next(hands, None)
    elif thing := moment.seen.unknown.get(name):
        found = stands(name, thing)
    else:
        found = {"name": name, "state": "lost", "presence": "missing", "position": None, "quaternion": None}
    return {"index": index, **found}


def arm(setup: Setup, name: str, index: int, moment: Moment) -> Document:
    """Return an arm: its links, and how it stands."""
    robot, seen = setup.lab.robots[name], moment.seen.robots.get(name)
    mount = robot.mount if robot.model != "gantry" else type(robot.mount)(x=0.0, y=0.0)
    joints = seen.joints if seen is not None and seen.joints else robot.park_joints
    return {
        "index": index, "name": name, "model": robot.model, "mount": as_json(mount), "links": links_of(robot),
        "reach": reach_of(robot), "stroke": robot.gripper.stroke, "tool": robot.gripper.tool,
        "park": list(robot.park_joints), "joints": list(joints), "width": width(setup, name, moment),
        "holding": seen.holding if seen is not None else None, "known": seen is not None,
    }  # fmt: skip


def width(setup: Setup, name: str, moment: Moment) -> float:
    """Return how far the pads of a gripper are apart [mm]: as it tells, else closed on what it holds, else open."""
    seen, gripper = moment.seen.robots.get(name), setup.lab.robots[name].gripper
    if (told := moment.openings.get(name)) is not None:
        return told
    held = seen.holding if seen is not None else None
    grasp = setup.type_of(held).geometry.grasp if held and held in setup.lab.inventory else None
    return grasp.width if grasp is not None else gripper.stroke


def beams(setup: Setup, moment: Moment) -> list[Document]:
    """Return the light among what stands on the table."""
    known = {name: place for name, place in moment.places.items() if name in setup.lab.inventory}
    return segments(setup, known, moment.seen.known_values)


def lighted(setup: Setup, moment: Moment) -> Mapping[str, Any]:
    """Return that on which the light depends, to be compared."""
    return {
        name: (moment.places.get(name), seen.presence, dict(seen.values))
        for name, seen in moment.seen.components.items()
        if name in setup.lab.inventory and seen.presence != "held"
    }


def _table(setup: Setup) -> Document:
    lab, table = setup.lab, setup.lab.table
    return {
        "size": list(table.size), "thickness": 1000 * TABLE_THICKNESS, "beam_height": table.beam_height,
        "holes": as_json(table.holes) | {"count": _holes(table)},
        "slots": [{"name": name, **as_json(slot)} for name, slot in sorted(lab.slots.items())],
        "regions": [{"name": name, **as_json(region)} for name, region in sorted(lab.regions.items())],
        "keep_out": [{"name": name, **as_json(volume)} for name, volume in sorted(lab.keep_out.items())],
    }  # fmt: skip


def _holes(table: Table) -> list[int]:
    """How many holes there are along x and along y."""
    holes = table.holes
    return [math.floor((size - at) / holes.pitch) + 1 for size, at in zip(table.size, holes.first, strict=True)]


def _cameras(setup: Setup) -> list[Document]:
    shown = ("position", "look_at", "roll", "field_of_view", "pixels", "robot")
    return [
        {"name": name, **{key: as_json(getattr(camera, key)) for key in shown}}
        for name, camera in sorted(setup.lab.cameras.items())
    ]

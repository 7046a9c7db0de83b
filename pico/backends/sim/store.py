"""The simulated table on disk: `world.json` in the folder of its bench, replaced as a whole."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from pico.backends.sim.reconcile import reconcile
from pico.backends.sim.world import FreePose, RememberedShape, World, WorldBody, new_world
from pico.base import clock
from pico.base.state_files import WORLD
from pico.cameras.errors import CameraShift
from pico.diagnostics import Diagnostic
from pico.disk import sweep, writing
from pico.geometry.seat import Seat
from pico.model.catalog import Footprint
from pico.model.observation import ObservedRobot, ObservedValue, UnknownObject
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.optics.unseen import Unseen
from pico.places.bench import BenchPlace


def world_path(place: BenchPlace) -> Path:
    """Return where the world of a bench is kept."""
    return WORLD.path(place.folder)


def load_world(setup: Setup, place: BenchPlace) -> tuple[World, tuple[Diagnostic, ...]]:
    """Return the simulated table of a bench and what had to change because the lab did.

    A bench without one gets a new world; nothing is written, and what a killed writer left is cleared. Raises PicoError
    where the file can't be read.
    """
    path = world_path(place)
    with suppress(OSError):
        sweep(path.parent)
    world = WORLD.read(path, world_from_json)
    return reconcile(setup, world) if world else (new_world(setup), ())


def save_world(place: BenchPlace, world: World, *, durable: bool = True) -> None:
    """Store the world: a reader sees the old one or the new one. Raises PicoError where it can't.

    `durable`: on the disk when this returns, so that it outlives a power failure and not only this process.
    """
    path = world_path(place)
    what = f"the simulated table cannot be stored in {path}"
    WORLD.write(path, as_json(world), what=what, durable=durable)
    if not durable:
        return
    with writing(path, what=what, code="world-file"):
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def world_from_json(data: Any) -> World:
    """Return the world whose `as_json` gave `data`; raises KeyError, TypeError or ValueError for anything else."""
    data = WORLD.lifted(data)
    shapes = {
        k: RememberedShape(footprint=_footprint(v["footprint"]), height=_number(v["height"]))
        for k, v in data["shapes"].items()
    }
    components = {k: _body(v) for k, v in data["components"].items()}
    for name, body in components.items():
        if body.type not in shapes:
            raise ValueError(f"{name} has the type {body.type!r} that it does not describe")
    return World(
        lab=str(data["lab"]),
        seed=int(data["seed"]),
        clock=_number(data["clock"]),
        components=components,
        robots={k: _robot(v) for k, v in data["robots"].items()},
        openings={k: _number(v) for k, v in data.get("openings", {}).items()},
        unknown={k: _unknown(v) for k, v in data["unknown"].items()},
        shapes=shapes,
        cameras={k: _shift(v) for k, v in data.get("cameras", {}).items()},
        stickers={str(k): None if v is None else int(v) for k, v in data.get("stickers", {}).items()},
        person=data.get("person") is True,
        stuck=tuple(str(one) for one in data.get("stuck", ())),
        waits=tuple((_time(at), _number(seconds)) for at, seconds in data.get("waits", ())),
    )


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"{value!r} is no finite number")
    return float(value)


def _time(text: Any) -> str:
    clock.parse_utc(str(text))
    return str(text)


def _numbers(values: Any) -> tuple[float, ...]:
    return tuple(_number(v) for v in values)


def _pose(data: Mapping[str, Any]) -> Pose:
    return Pose(_number(data["x"]), _number(data["y"]), _number(data["yaw"]))


def _unseen(data: Mapping[str, Any]) -> Unseen:
    sizes = {k: _number(v) for k, v in data.items() if k != "optic"}
    return Unseen(optic=str(data.get("optic", "")), **sizes)


def _body(data: Mapping[str, Any]) -> WorldBody:
    presence, free = data["presence"], data.get("free")
    if presence not in ("seen", "missing", "held", "toppled"):
        raise ValueError(f"{presence!r} is no presence")
    if presence == "seen" and "pose" not in data:
        raise ValueError("a part that is seen has no pose")
    return WorldBody(
        type=str(data["type"]),
        marker=data.get("marker"),
        presence=presence,
        pose=_pose(data["pose"]) if "pose" in data else None,
        free=_free(free) if free else None,
        seat=_seat(data["seat"]) if data.get("seat") else None,
        values={k: _value(v) for k, v in data["values"].items()},
        offsets={k: _number(v) for k, v in data.get("offsets", {}).items()},
        unseen=_unseen(data["unseen"]) if data.get("unseen") else None,
    )


def _free(data: Mapping[str, Any]) -> FreePose:
    x, y, z = _numbers(data["position"])
    a, b, c, d = _numbers(data["quaternion"])
    return FreePose(position=(x, y, z), quaternion=(a, b, c, d))


def _seat(data: Mapping[str, Any]) -> Seat:
    pitch, roll, height = (_number(data[key]) for key in ("pitch", "roll", "height"))
    return Seat(pitch=pitch, roll=roll, height=height, count=int(data["count"]))


def _shift(data: Mapping[str, Any]) -> CameraShift:
    (x, y, z), (a, b, c) = _numbers(data["shift"]), _numbers(data["turn"])
    return CameraShift(shift=(x, y, z), turn=(a, b, c))


def _value(data: Mapping[str, Any]) -> ObservedValue:
    value, status = data.get("value"), data["status"]
    if status not in ("known", "commanded", "unknown") or not isinstance(value, float | int | bool | str | None):
        raise ValueError(f"{dict(data)!r} is no value")
    return ObservedValue(value=value, status=status)


def _robot(data: Mapping[str, Any]) -> ObservedRobot:
    return ObservedRobot(joints=_numbers(data["joints"]), holding=data.get("holding"))


def _footprint(data: Mapping[str, Any]) -> Footprint:
    box, corners = data.get("box"), data.get("polygon")
    return Footprint(
        disc=data.get("disc"),
        box=(_number(box[0]), _number(box[1])) if box else None,
        polygon=tuple((_number(x), _number(y)) for x, y in corners) if corners else None,
    )


def _unknown(data: Mapping[str, Any]) -> UnknownObject:
    return UnknownObject(
        pose=_pose(data["pose"]), footprint=_footprint(data["footprint"]), height=_number(data["height"])
    )

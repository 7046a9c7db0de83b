"""Whether the cameras of a lab can see what they are there for: the table, the slots, the datum markers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import fields

from pico.diagnostics import Diagnostic, did_you_mean, error, warning
from pico.manifest.text.places import where, where_key
from pico.manifest.text.tree import Document
from pico.model.lab import Camera, Lab
from pico.model.setup import Setup

MARKERS = 1000
"""How many markers the dictionary has (OpenCV's DICT_4X4_1000)."""
DATUMS = 3
"""How many datum markers tell a camera that was bumped from parts that were moved."""

_Vector = tuple[float, float, float]


def check_cameras(document: Document, lab: Lab) -> Iterator[Diagnostic]:
    """Yield what is wrong with the cameras, the markers and the simulated errors of a lab."""
    for name, camera in lab.cameras.items():
        wrong = list(_values(document, name, camera))
        yield from wrong
        yield from _riding(document, lab, name, camera)
        if not wrong and camera.robot is None:
            yield from _sees_table(document, lab, name, camera)
    yield from _numbers(document, lab)
    yield from _errors(document, lab)


def check_view(document: Document, setup: Setup) -> Iterator[Diagnostic]:
    """Yield warnings for what the cameras of a lab, each right in itself, do not see together."""
    lab = setup.lab
    cameras = [c for c in lab.cameras.values() if c.robot is None]
    if not cameras:
        return
    blind = [name for name, slot in lab.slots.items() if not _any_sees(cameras, (slot.x, slot.y, 0.0))]
    if blind and not all(robot.model == "gantry" for robot in lab.robots.values()):
        hint = "turn a camera there, or give it a wider field_of_view"
        summary = f"no camera over the table sees {_few([f'slot {name}' for name in blind])}"
        yield warning("unseen", summary, hint=hint, source=where_key(document, "cameras"))
    seen = [name for name, datum in lab.datums.items() if _any_sees(cameras, (datum.x, datum.y, 0.0))]
    if len(seen) < DATUMS:
        hint = f"fix {DATUMS} markers or more to the table, wide apart, and name them under `datums:`"
        many = f"{len(seen)} datum marker{'' if len(seen) == 1 else 's'}"
        summary = f"the cameras see {many}: a bumped camera can't be told from moved parts"
        yield warning("datums", summary, hint=hint, source=where_key(document, "cameras"))
    for name, part in _covers(setup):
        hint = "fix the datum marker where nothing stands"
        yield warning("datums", f"{part} stands on datum {name}", hint=hint, source=where_key(document, "datums", name))


def _covers(setup: Setup) -> Iterator[tuple[str, str]]:
    """Datums, and the parts at home or fixed that stand on them."""
    for name, datum in setup.lab.datums.items():
        for part, one in setup.lab.inventory.items():
            slot = setup.lab.slots.get(one.home or "")
            place = one.pose or (slot.pose if slot else None)
            reach = setup.type_of(part).geometry.footprint.radius + datum.size / 2
            if place and math.hypot(place.x - datum.x, place.y - datum.y) < reach:
                yield name, part


def _values(document: Document, name: str, camera: Camera) -> Iterator[Diagnostic]:
    depth = camera.depth
    rules = [
        ("field_of_view", 0 < camera.field_of_view < 170, "above 0 and below 170 deg"),
        ("pixels", min(camera.pixels) >= 16 and max(camera.pixels) <= 16384, "16 to 16384 along each edge"),
        ("look_at", math.dist(camera.position, camera.look_at) > 1, "another point than its position"),
        ("noise", camera.noise >= 0, "zero or more gray levels"),
        ("blur", 0 <= camera.blur <= 50, "0 to 50 pixels"),
        ("depth", depth is None or (0 < depth.range[0] < depth.range[1] and depth.noise >= 0), "[near, far] mm"),
    ]  # fmt: skip
    for key, right, hint in rules:
        if not right:
            source = where(document, "cameras", name, key)
            yield error("value", f"the {key} of camera {name} can't be", hint=f"expected {hint}", source=source)


def _riding(document: Document, lab: Lab, name: str, camera: Camera) -> Iterator[Diagnostic]:
    if camera.robot is None:
        return
    source = where(document, "cameras", name, "robot")
    if camera.robot not in lab.robots:
        hint = did_you_mean(camera.robot[:40], lab.robots) or "declare it under `robots:`"
        summary = f"camera {name} rides on a robot that this lab does not have: `{camera.robot[:40]}`"
        yield error("unknown-robot", summary, hint=hint, source=source)
    elif lab.robots[camera.robot].model != "xarm7":
        hint = "leave out `robot:` and give its position over the table"
        yield error("unknown-robot", f"camera {name} can't ride on a gantry", hint=hint, source=source)


def _sees_table(document: Document, lab: Lab, name: str, camera: Camera) -> Iterator[Diagnostic]:
    width, depth = lab.table.size
    spots = [(width * i / 8, depth * j / 8, 0.0) for i in range(9) for j in range(9)]
    if camera.position[2] > 0 and _any_sees([camera], *spots):
        return
    hint = "`position` and `look_at` are in mm, from the front-left corner of the table, z up"
    source = where(document, "cameras", name, "look_at" if camera.position[2] > 0 else "position")
    yield error("unseen", f"camera {name} does not see the table", hint=hint, source=source)


def _any_sees(cameras: Sequence[Camera], *spots: _Vector) -> bool:
    return any(_sees(camera, spot) for camera in cameras for spot in spots)


def _sees(camera: Camera, spot: _Vector) -> bool:
    """Return whether a point is within the field of view, distortion left aside; axes as `Camera` says."""
    forward = _unit(_minus(camera.look_at, camera.position))
    up = (0.0, 1.0, 0.0) if abs(forward[2]) > math.sqrt(0.5) else (0.0, 0.0, 1.0)
    right = _unit(_cross(forward, up))
    way = _minus(spot, camera.position)
    depth, x, y = _dot(way, forward), _dot(way, right), _dot(way, _cross(forward, right))
    if depth <= 0:
        return False
    roll = math.radians(camera.roll)
    x, y = x * math.cos(roll) + y * math.sin(roll), y * math.cos(roll) - x * math.sin(roll)
    half = math.tan(math.radians(camera.field_of_view) / 2)
    return abs(y) <= half * depth and abs(x) <= half * depth * camera.pixels[0] / camera.pixels[1]


def _numbers(document: Document, lab: Lab) -> Iterator[Diagnostic]:
    carriers = [(("inventory", n, "marker"), p.marker) for n, p in lab.inventory.items()]
    carriers += [(("datums", n, "marker"), d.marker) for n, d in lab.datums.items()]
    for path, marker in carriers:
        if marker is not None and marker >= MARKERS:
            hint = f"markers count from 0 to {MARKERS - 1}"
            yield error("value", f"the marker of {path[1]} is {marker}", hint=hint, source=where(document, *path))
    for name, datum in lab.datums.items():
        if datum.size <= 0:
            source = where(document, "datums", name, "size")
            yield error(
                "value", f"the size of datum {name} is {datum.size:g}", hint="expected above zero", source=source
            )


def _errors(document: Document, lab: Lab) -> Iterator[Diagnostic]:
    errors = lab.sim.errors
    rules = [(key, getattr(errors, key) >= 0, "zero or more") for key in ("camera_position", "camera_rotation")]
    rules += [(key, getattr(errors, key) >= 0, "zero or more") for key in ("marker_height", "noise")]
    rules += [(key, 0 <= getattr(errors, key) < 1, "a share, 0 to below 1") for key in ("focal_length",)]
    rules += [("lost_frames", 0 <= errors.lost_frames <= 1, "a share, 0 to 1")]
    wrong: list[tuple[tuple[str, ...], float, str]]
    wrong = [(("errors", key), getattr(errors, key), hint) for key, right, hint in rules if not right]
    arm = [(("errors", "arm", f.name), getattr(errors.arm, f.name)) for f in fields(errors.arm)] if errors.arm else []
    wrong += [(path, value, "zero or more") for path, value in arm if value < 0]
    if light := errors.light:
        wrong += [(("errors", "light", "dim"), light.dim, "a share, above 0 to 1")] if not 0 < light.dim <= 1 else []
        rest = (("defocus", light.defocus), ("scatter", light.scatter), ("glare", light.glare))
        wrong += [(("errors", "light", key), value, "zero or more") for key, value in rest if value < 0]
    for path, value, hint in wrong:
        source = where(document, "sim", *path)
        yield error("value", f"sim.{'.'.join(path)} is {value:g}", hint=f"expected {hint}", source=source)


def _few(names: Sequence[str]) -> str:
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def _minus(a: _Vector, b: _Vector) -> _Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _dot(a: _Vector, b: _Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: _Vector, b: _Vector) -> _Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _unit(a: _Vector) -> _Vector:
    length = math.sqrt(_dot(a, a))
    return a[0] / length, a[1] / length, a[2] / length

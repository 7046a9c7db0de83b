"""Whether a lab and the types of its parts fit together: places, markers, beam height, what the grippers can hold."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from pico.diagnostics import Diagnostic, SourceRange, did_you_mean, error, warning
from pico.manifest.checks.cameras import check_cameras, check_view
from pico.manifest.checks.former_names import check_former_names
from pico.manifest.checks.own_parameters import lasting, unattached
from pico.manifest.checks.required_version import check_requirement
from pico.manifest.checks.trims import check_own_trims
from pico.manifest.text.names import check_names, check_own_name
from pico.manifest.text.places import where, where_key
from pico.manifest.text.tree import Document
from pico.model.catalog import ComponentType
from pico.model.lab import Lab
from pico.model.robot import TOOL_SPEED, Fingers, Robot
from pico.model.setup import Setup

BEAM_HEIGHT_MISMATCH = 0.5
"""How far a type's optical frame may lie from the lab's beam height [mm]."""


def check_lab(document: Document, lab: Lab) -> list[Diagnostic]:
    """Return what is wrong with a lab in itself, each at its place in the document."""
    found = [*check_requirement(document), *_names(document)]
    found += check_former_names(document, lab)
    found += _homes(document, lab)
    found += _markers(document, lab)
    found += _on_table(document, lab)
    found += _ranges(document, lab)
    found += check_cameras(document, lab)
    found += _policy(document, lab)
    return found


def _policy(document: Document, lab: Lab) -> Iterator[Diagnostic]:
    lasts = lab.policy.calibrated_for
    if lasts is not None and (wrong := lasting(lasts, "calibrated_for")):
        yield replace(wrong, source=where(document, "policy", "calibrated_for"))
    if lab.policy.offline is not None and (wrong := unattached(lab.policy.offline)):
        yield replace(wrong, source=where(document, "policy", "offline"))


def check_setup(document: Document, setup: Setup) -> list[Diagnostic]:
    """Return where the parts of a lab don't fit it: one diagnostic a type, at the first part of that type."""
    first: dict[str, str] = {}
    for name, part in setup.lab.inventory.items():
        first.setdefault(part.type, name)
    found: list[Diagnostic] = []
    for type_name, part_name in first.items():
        if type_name in setup.catalog:
            found += _type(document, setup, setup.catalog[type_name], part_name)
    found += _slots_fit(document, setup)
    found += check_own_trims(document, setup)
    found += check_view(document, setup)
    return found


def _names(document: Document) -> list[Diagnostic]:
    found = [
        d
        for key in ("inventory", "robots", "cameras", "datums", "keep_out", "goals", "claims")
        for d in check_names(document, key)
    ]
    found += [d for key in ("slots", "regions") for d in check_names(document, key, parts=True)]
    return found + check_own_name(document)


def _homes(document: Document, lab: Lab) -> Iterator[Diagnostic]:
    owner: dict[str, str] = {}
    for name, part in lab.inventory.items():
        if part.home is None:
            continue
        at = where(document, "inventory", name, "home")
        if part.home not in lab.slots:
            hint = did_you_mean(part.home[:40], lab.slots) or "declare it under `slots:`"
            yield error(
                "unknown-slot", f"the home of {name} is no slot of this lab: `{part.home[:40]}`", hint=hint, source=at
            )
        elif part.home in owner:
            other = where(document, "inventory", owner[part.home], "home")
            detail = f"{owner[part.home]} has it at {other}"
            taken = {p.home for p in lab.inventory.values()}
            free = [f"`{slot}`" for slot in sorted(lab.slots) if slot not in taken]
            hint = f"free slots: {', '.join(free[:4])}" if free else "give each part its own home: add a slot"
            yield error(
                "slot", f"{name} and {owner[part.home]} have one home, {part.home}", detail=detail, hint=hint, source=at
            )
        else:
            owner[part.home] = name


def _markers(document: Document, lab: Lab) -> Iterator[Diagnostic]:
    owner: dict[int, tuple[str, ...]] = {}
    carriers = [(("inventory", n, "marker"), p.marker) for n, p in lab.inventory.items()]
    carriers += [(("datums", n, "marker"), d.marker) for n, d in lab.datums.items()]
    for path, marker in carriers:
        if marker is None:
            continue
        if marker < 0:
            hint = "markers count from 0"
            yield error("value", f"the marker of {path[1]} is {marker}", hint=hint, source=where(document, *path))
        elif marker in owner:
            other = owner[marker]
            detail = f"{other[1]} has it at {where(document, *other)}"
            hint = "give each its own marker"
            yield error(
                "duplicate",
                f"{path[1]} and {other[1]} carry the same marker, {marker}",
                detail=detail,
                hint=hint,
                source=where(document, *path),
            )
        owner.setdefault(marker, path)


def _on_table(document: Document, lab: Lab) -> Iterator[Diagnostic]:
    width, depth = lab.table.size
    if width <= 0 or depth <= 0:
        return  # said by itself
    places: list[tuple[str, tuple[str, ...], float, float]] = []
    places += [(f"slot {n}", ("slots", n), s.x, s.y) for n, s in lab.slots.items() if not lab.beside_table(n)]
    places += [(n, ("inventory", n, "pose"), p.pose.x, p.pose.y) for n, p in lab.inventory.items() if p.pose]
    places += [(f"datum {n}", ("datums", n), d.x, d.y) for n, d in lab.datums.items()]
    for what, path, x, y in places:
        if not (0 <= x <= width and 0 <= y <= depth):
            yield off_table(what, x, y, lab.table.size, where(document, *path, "y" if 0 <= x <= width else "x"))


def off_table(what: str, x: float, y: float, size: tuple[float, float], source: SourceRange) -> Diagnostic:
    """Return the diagnostic of something placed beyond the edge of a table of `size` [mm]."""
    hint = f"expected x in 0 to {size[0]:g} and y in 0 to {size[1]:g} mm"
    return error("off-table", f"{what} is off the table: ({x:g}, {y:g})", hint=hint, source=source)


def _ranges(document: Document, lab: Lab) -> Iterator[Diagnostic]:
    intervals: list[tuple[tuple[str, ...], tuple[float, float]]] = []
    for kind, areas in (("regions", lab.regions), ("keep_out", lab.keep_out)):
        for name, owner in areas.items():
            intervals += [((kind, name, "area", "x"), owner.area.x), ((kind, name, "area", "y"), owner.area.y)]
    intervals += [(("keep_out", name, "z"), zone.z) for name, zone in lab.keep_out.items()]
    for path, (low, high) in intervals:
        if low >= high:
            source = where(document, *path)
            yield error("value", f"{'.'.join(path)} is empty", hint="expected [least, greatest]", source=source)
    positive: list[tuple[tuple[str | int, ...], float]] = [
        (("table", "size", 0), lab.table.size[0]), (("table", "size", 1), lab.table.size[1]),
        (("table", "beam_height"), lab.table.beam_height), (("table", "holes", "pitch"), lab.table.holes.pitch),
    ]  # fmt: skip
    positive += [(("slots", n, "capture"), s.capture) for n, s in lab.slots.items()]
    for place, value in positive:
        if value <= 0:
            words = "".join(f"[{p}]" if isinstance(p, int) else f".{p}" for p in place)[1:]
            yield error("value", f"{words} is {value:g}", hint="expected above zero", source=where(document, *place))
    for name, robot in lab.robots.items():
        if not 0 < robot.speed <= 1:
            source = where(document, "robots", name, "speed")
            yield error(
                "value", f"the speed of {name} is {robot.speed:g}", hint="expected a share, above 0 to 1", source=source
            )
        if not 0 < robot.fastest <= TOOL_SPEED:
            source = where(document, "robots", name, "tool_speed")
            text = f"the tool speed of {name} is {robot.fastest:g} mm/s"
            hint = f"expected above 0 to {TOOL_SPEED:g} mm/s, the vendor's limit; 250 where a person may be near"
            yield error("value", text, hint=hint, source=source)


def _type(document: Document, setup: Setup, kind: ComponentType, part: str) -> Iterator[Diagnostic]:
    at = where(document, "inventory", part, "type")
    beam, optical = setup.lab.table.beam_height, kind.frames.optical[2]
    if kind.optics.element != "none" and abs(optical - beam) > BEAM_HEIGHT_MISMATCH:
        yield error(
            "beam-height",
            f"the optical axis of {part} is at {optical:g} mm, the beam of this lab at {beam:g} mm",
            detail=f"type {kind.name}, frames.optical",
            hint=f"use a type made for {beam:g} mm, or change table.beam_height",
            source=at,
        )
    aperture = kind.geometry.clear_aperture
    if aperture is not None and abs(aperture.center[2] - beam) > aperture.diameter / 2:
        way = "above" if beam > aperture.center[2] else "below"
        text = f"the beam of this lab runs {abs(aperture.center[2] - beam):g} mm {way} the aperture of {part}"
        hint = f"its radius is {aperture.diameter / 2:g} mm; in a lab like this its center is [.., .., {beam:g}]"
        detail = f"type {kind.name}, geometry.clear_aperture"
        yield warning("beam-height", text, detail=detail, hint=hint, source=at)
    if kind.geometry.footprint.radius > max(setup.lab.table.size) / 2:
        hint = "check the size of its footprint in the catalog"
        yield error("footprint", f"{part} ({kind.name}) is larger than the table", hint=hint, source=at)
    if setup.movable(part) and setup.lab.robots:
        yield from _grasp(setup.lab.robots, kind, part, at)


def _grasp(robots: Mapping[str, Robot], kind: ComponentType, part: str, at: SourceRange) -> Iterator[Diagnostic]:
    reasons = [_no_grasp(robot, kind) for robot in robots.values()]
    if all(reasons):
        yield error(
            "grasp",
            f"no gripper of this lab can hold {part} ({kind.name})",
            detail=reasons[0],
            hint=_better_grasp(next(iter(robots.values())), kind),
            source=at,
        )


def _better_grasp(robot: Robot, kind: ComponentType) -> str:
    """Return what grasp of a type a robot's gripper could hold it by: other yaws, else another height."""
    grasp, fingers = kind.geometry.grasp, robot.gripper.fingers
    otherwise = "change the grasp of the type, or its seating to `bolted`"
    if grasp is None or not isinstance(fingers, Fingers) or grasp.width + 2 * fingers.opening > robot.gripper.stroke:
        return otherwise
    free = [yaw for yaw in dict.fromkeys((*grasp.yaws, 0.0, 90.0)) if not touches_aperture(kind, fingers, yaw)]
    if free:
        return f"expected `yaws: [{', '.join(f'{yaw:g}' for yaw in free)}]` in the grasp of {kind.name}"
    for height in range(math.ceil(grasp.height), math.floor(kind.geometry.height) + 1):
        higher = replace(kind, geometry=replace(kind.geometry, grasp=replace(grasp, height=float(height))))
        if not any(touches_aperture(higher, fingers, yaw) for yaw in grasp.yaws):
            return f"expected `height: {height}` or more in the grasp of {kind.name}"
    return otherwise


def _no_grasp(robot: Robot, kind: ComponentType) -> str:
    """Why a robot's gripper can't hold a type, or ''."""
    grasp, fingers = kind.geometry.grasp, robot.gripper.fingers
    assert grasp is not None
    if not isinstance(fingers, Fingers):
        return ""
    open_width = grasp.width + 2 * fingers.opening
    if open_width > robot.gripper.stroke:
        return f"it must open {open_width:g} mm, and opens {robot.gripper.stroke:g} mm"
    for yaw in grasp.yaws:
        if touches_aperture(kind, fingers, yaw):
            return f"closing at {yaw:g} deg, its pads would touch the clear aperture"
    return ""


def touches_aperture(kind: ComponentType, fingers: Fingers, yaw: float) -> bool:
    """Return whether the pads, closed at `yaw` [deg], reach into the beam's way through the clear aperture.

    Pads reach `fingers.tip` below the tool center point. The way is the aperture's disc, prolonged along local x.
    """
    grasp, aperture = kind.geometry.grasp, kind.geometry.clear_aperture
    if grasp is None or aperture is None:
        return False
    _, y, z = aperture.center
    if grasp.height - fingers.tip >= z + aperture.diameter / 2:
        return False
    c, s = abs(math.cos(math.radians(yaw))), abs(math.sin(math.radians(yaw)))
    half = c * fingers.breadth / 2 + s * fingers.thickness / 2
    pads = [side * s * (grasp.width + fingers.thickness) / 2 for side in (-1, 1)]
    return any(abs(pad - y) < half + aperture.diameter / 2 for pad in pads)


def _slots_fit(document: Document, setup: Setup) -> Iterable[Diagnostic]:
    for name, part in setup.lab.inventory.items():
        kind, slot = setup.catalog.get(part.type), setup.lab.slots.get(part.home or "")
        if kind and slot and slot.fits is not None and kind.geometry.footprint.radius > slot.fits + 1e-9:
            yield error(
                "slot",
                f"{name} does not fit its home {part.home}",
                detail=f"it reaches {kind.geometry.footprint.radius:.4g} mm out, the slot takes {slot.fits:g} mm",
                hint="choose a larger slot",
                source=where_key(document, "inventory", name, "home"),
            )

"""Where a beam goes: the chief ray of a source by geometry alone, in the table frame [mm].

This is the one answer for pictures, planner, policy, validation and ruler. A ray runs straight, passes what it can pass
through within its clear aperture, is reflected at mirrors (their tip, tilt and piezo count), divided at splitters, and
ends at a detector, a block, a housing, or where it leaves the table. Lenses do not bend it and shutters are taken as
open: whoever asks knows what is shut.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pico.geometry.shape import Shape, placed
from pico.model.catalog import ClearAperture, ComponentType
from pico.model.pose import Pose
from pico.model.quantities import QuantityError, convert
from pico.model.setup import Setup
from pico.optics.geometry import Event, Kick, Struck, Vector, geometry_of
from pico.optics.unseen import SEEN, Unseen

Values = Mapping[str, Mapping[str, Any]]
"""Tunables of components by name, in the units of the catalog."""
LEGS = 256
"""Straight pieces after which a beam that goes round and round is followed no more."""

_NEAR = 1e-6  # mm: what a ray has just left
_RADIANS = {"mrad": 1e-3, "deg": math.pi / 180, "rad": 1.0}


@dataclass(frozen=True, slots=True)
class Meeting:
    """A component that the ray meets: what it does there, where [mm], and how far from the source along the beam [mm].
    `component` is empty where the ray leaves the table."""

    component: str
    event: Event
    at: Vector
    length: float


@dataclass(frozen=True, slots=True)
class Leg:
    """A straight piece of a beam from `start`, where it has come `begun` [mm] already, with what it meets in order; the
    last of these ends it. `before`: the number of the leg that it goes on from; None for the first."""

    start: Vector
    begun: float
    met: tuple[Meeting, ...]
    before: int | None = None

    @property
    def end(self) -> Vector:
        return self.met[-1].at


@dataclass(frozen=True, slots=True)
class Axis:
    """The beam of a source: a tree of legs, each after the one that it goes on from. `endless` where it was followed no
    further than `LEGS` legs."""

    source: str
    legs: tuple[Leg, ...]
    endless: bool = False

    @property
    def meetings(self) -> tuple[Meeting, ...]:
        """All that the beam meets, leg by leg."""
        return tuple(meeting for leg in self.legs for meeting in leg.met)

    def reaches(self, component: str) -> bool:
        """Whether light of the source comes to a component: through it, off it, or into it; not onto its housing."""
        return any(m.component == component and m.event != "blocked" for m in self.meetings)

    def ways(self, component: str) -> tuple[tuple[Meeting, ...], ...]:
        """Return each way from the source to a component: what is met, in order, the component last."""
        return tuple(
            (*self._before(number), *leg.met[: at + 1])
            for number, leg in enumerate(self.legs)
            for at, meeting in enumerate(leg.met)
            if meeting.component == component and meeting.event != "blocked"
        )

    def _before(self, number: int) -> tuple[Meeting, ...]:
        before = self.legs[number].before
        return () if before is None else (*self._before(before), *self.legs[before].met)


@dataclass(frozen=True, slots=True)
class Ray:
    """A ray from a point [mm] in a direction of length 1, `begun` [mm] from its source, that leaves a component;
    `before`: the number of the leg that it goes on from."""

    at: Vector
    towards: Vector
    begun: float
    leaves: str
    before: int | None = None
    wavelength: float = 0.0  # mm


@dataclass(frozen=True, slots=True)
class Optic:
    """A component as a ray finds it: its outline on the table and its height; center, normal and radius of its
    aperture, None where nothing passes. `element`: what it is to a ray as its tunables are."""

    name: str
    element: str
    shape: Shape
    height: float
    center: Vector | None
    normal: Vector
    radius: float
    left: Vector = (0.0, 1.0, 0.0)
    kicks: tuple[Kick, ...] = ()


def axis_of(setup: Setup, poses: Mapping[str, Pose], source: str, values: Values | None = None) -> Axis:
    """Return the beam of `source` among the components that stand at `poses` (the source one of them).

    `values`: their tunables in the units of the catalog, of which `tip`, `tilt` and `piezo` of mirrors count, stages, 0
    where unknown, and the `opening` of an iris, wide open where unknown.
    """
    known = values or {}
    optics = [optic_of(setup.type_of(n), n, pose, known.get(n, {})) for n, pose in poses.items()]
    frame = setup.type_of(source).frames.optical
    own = poses[source]
    x, y = own.apply(*frame[:2])
    turned = math.radians(own.yaw)
    wavelength = (setup.type_of(source).number("wavelength", "nm") or 632.8) * 1e-6
    rays = [Ray((x, y, frame[2]), (math.cos(turned), math.sin(turned), 0.0), 0.0, source, None, wavelength)]
    legs: list[Leg] = []
    for ray in rays:
        if len(legs) == LEGS:
            return Axis(source, tuple(legs), endless=True)
        leg, last = _leg(setup.lab.table.size, optics, ray)
        rays += _onward(ray, leg, last, len(legs))
        legs.append(leg)
    return Axis(source, tuple(legs))


def beams(setup: Setup, poses: Mapping[str, Pose], values: Values | None = None) -> Iterator[Axis]:
    """Yield the beam of each source that stands on the table, by name."""
    for name in sorted(poses):
        if setup.type_of(name).optics.element == "source":
            yield axis_of(setup, poses, name, values)


def optic_of(
    kind: ComponentType, name: str, pose: Pose, values: Mapping[str, Any], unseen: Unseen = SEEN
) -> Optic:  # fmt: skip
    """Return a component as a ray finds it, with its tunables as `values` and otherwise as `unseen` says."""
    geometry, element = kind.geometry, kind.optics.element
    if element == "mirror" and values.get("flipped") == "down":
        element = "none"  # what is flipped away lets light pass
    does = geometry_of(element)
    aperture = _aperture(kind) if element not in ("block", "source") else None
    center = aperture.center if aperture else (0.0, 0.0, 0.0)
    (ahead, left), up = staged(kind, values), shift(kind, values, "stage_z")
    x, y = pose.apply(center[0] + ahead, center[1] + left)
    tip, tilt = (_turn(kind, values, key) for key in ("tip", "tilt")) if does.turns else (0.0, 0.0)
    opening = values.get("opening") if element == "iris" else None
    if does.folds:
        # what comes along +x is divided to `fold` degrees from it: the coating stands half way
        fold = kind.number("fold", "deg")
        fold = 90.0 if fold is None else fold
        tip = math.radians(fold / 2 + math.copysign(90.0, fold))
    facing = math.radians(pose.yaw) + tip + (math.pi if does.faces_back else 0.0)
    normal = (math.cos(facing) * math.cos(tilt), math.sin(facing) * math.cos(tilt), math.sin(tilt))
    where = (x, y, center[2] + up) if aperture else None
    yaw = math.radians(pose.yaw)
    aside = (-math.sin(yaw), math.cos(yaw), 0.0)
    if unseen.displaced:
        local = (center[0] + ahead, center[1] + left, center[2] + up)
        where = unseen.place(pose, local, kind.frames.optical) if aperture else None
        normal, aside = (unseen.point(pose, _own(pose, way)) for way in (normal, aside))
    if where is not None and (pushed := shift(kind, values, "piezo")):
        where = _sum(where, _times(normal, pushed))
    shape = placed(geometry.footprint, pose)
    width = aperture.diameter if aperture else 0.0
    if isinstance(opening, int | float):
        width = min(width, float(opening))
    return Optic(name, element, shape, geometry.height, where, normal, width / 2, aside, does.kicks(kind))


def _own(pose: Pose, way: Vector) -> Vector:
    """Return a direction on the table in the frame of what is at `pose`."""
    x, y = Pose(0.0, 0.0, -pose.yaw).apply(way[0], way[1])
    return x, y, way[2]


def _aperture(kind: ComponentType) -> ClearAperture | None:
    """Return where light passes a component: as its geometry says, else as wide as the element is, around its axis."""
    if kind.geometry.clear_aperture:
        return kind.geometry.clear_aperture
    width = kind.number("clear_diameter", "mm")
    return None if width is None else ClearAperture(center=kind.frames.optical, diameter=width)


def _turn(kind: ComponentType, values: Mapping[str, Any], key: str) -> float:
    """Return a tunable that is an angle [rad]; 0 where it is not known or there is none."""
    return _in(kind, values, key, "rad")


def first_met(table: tuple[float, float], optics: Sequence[Optic], ray: Ray) -> tuple[Optic | None, Event, float]:
    """Return what a ray meets first, what becomes of it there by geometry alone, and how far ahead that is [mm]; None
    where it leaves the table."""
    length = _to_edge(table, ray)
    found = [(far, o.name, o, event) for o in optics if (hit := _hit(ray, o)) for far, event in [hit] if far <= length]
    if not found:
        return None, "left", length
    far, _, optic, event = min(found, key=lambda f: f[:2])
    return optic, event, far


def beside_the_edge(optic: Optic, ray: Ray, within: float) -> Event | None:
    """Return what becomes of light around a ray that meets the plane of an optic no further than `within` [mm] beside
    its clear aperture; None where there is none, or the ray is further off."""
    if optic.center is None or _through(ray, replace(optic, radius=optic.radius + within)) is None:
        return None
    return geometry_of(optic.element).event


def staged(kind: ComponentType, values: Mapping[str, Any]) -> tuple[float, float]:
    """Return by how much stages have moved the optic of a component, seen from above: ahead and to the left [mm]."""
    return shift(kind, values, "stage_x"), shift(kind, values, "stage_y")


def shift(kind: ComponentType, values: Mapping[str, Any], key: str) -> float:
    """Return by how much a stage has moved an optic along an axis of the component [mm]."""
    return _in(kind, values, key, "mm")


def _in(kind: ComponentType, values: Mapping[str, Any], key: str, unit: str) -> float:
    """Return a tunable in a unit; 0 where it is not known, there is none, or it is of another kind."""
    value, tunable = values.get(key), kind.tunables.get(key)
    if tunable is None or isinstance(value, bool) or not isinstance(value, int | float):
        return 0.0
    own = tunable.unit or unit
    try:
        return float(value) * (_RADIANS[own] if unit == "rad" and own in _RADIANS else convert(f"1 {own}", unit))
    except QuantityError:
        return 0.0


def _leg(table: tuple[float, float], optics: list[Optic], ray: Ray) -> tuple[Leg, Optic | None]:
    """Return the leg that a ray runs, and what bends or divides it at its end."""
    length = _to_edge(table, ray)
    found = sorted((far, o.name, o, event) for o in optics if (hit := _hit(ray, o)) for far, event in [hit])
    met: list[Meeting] = []
    for far, name, optic, event in found:
        if far > length:
            break
        met.append(Meeting(name, event, _along(ray, far), ray.begun + far))
        if event != "passed":
            return Leg(ray.at, ray.begun, tuple(met), ray.before), optic
    met.append(Meeting("", "left", _along(ray, length), ray.begun + length))
    return Leg(ray.at, ray.begun, tuple(met), ray.before), None


def _hit(ray: Ray, optic: Optic) -> tuple[float, Event] | None:
    """Return how far ahead a ray meets a component [mm], and what becomes of it; None where it misses it."""
    if optic.name == ray.leaves:
        return None
    if optic.center is not None and (far := _through(ray, optic)) is not None:
        return far, geometry_of(optic.element).event
    housing = _housing(ray, optic)
    return None if housing is None else (housing, "blocked")


def _through(ray: Ray, optic: Optic) -> float | None:
    """Return where a ray meets the plane of an optic within its clear aperture [mm ahead], None where it does not.

    A splitter is as open on each side of its cube, so there the distance to the ray counts, too, and the coating is as
    long as that takes; mirrors and detectors are seen from their face only.
    """
    assert optic.center is not None
    facing = _dot(ray.towards, optic.normal)
    does = geometry_of(optic.element)
    if abs(facing) < 1e-6 or (does.face is not None and facing * does.face < 0):
        return None
    offset = _minus(optic.center, ray.at)
    far = _dot(offset, optic.normal) / facing
    aside = _minus(_along(ray, far), optic.center)
    square, across = _dot(aside, aside), _dot(aside, ray.towards)
    if does.cube:
        square = max(square - across**2, square / 2)
    return far if far > _NEAR and square <= optic.radius**2 else None


def _housing(ray: Ray, optic: Optic) -> float | None:
    """Return where a ray comes above the outline of a component, lower than its top [mm ahead], or None."""
    entered = _entry(ray, optic.shape)
    if entered is None or not 0.0 <= _along(ray, entered)[2] <= optic.height:
        return None
    return entered


def _entry(ray: Ray, shape: Shape) -> float | None:
    """Return where a ray, seen from above, enters a disc or a convex polygon [mm ahead, along the ray in space]."""
    (px, py, _), (dx, dy, _) = ray.at, ray.towards
    if not shape.vertices:
        a = dx * dx + dy * dy
        b = (px - shape.x) * dx + (py - shape.y) * dy
        root = b * b - a * ((px - shape.x) ** 2 + (py - shape.y) ** 2 - shape.radius**2)
        if a == 0.0 or root < 0 or -b + math.sqrt(root) <= _NEAR * a:
            return None
        return max(0.0, (-b - math.sqrt(root)) / a)
    first, last = 0.0, math.inf
    corners = shape.vertices
    for (ax, ay), (bx, by) in zip(corners, (*corners[1:], corners[0]), strict=True):
        inward, ahead = (bx - ax) * (py - ay) - (by - ay) * (px - ax), (bx - ax) * dy - (by - ay) * dx
        if ahead > 0:
            first = max(first, -inward / ahead)
        elif ahead < 0:
            last = min(last, inward / -ahead)
        elif inward < 0:
            return None
    return first if last > max(first, _NEAR) else None


def _onward(ray: Ray, leg: Leg, optic: Optic | None, number: int) -> list[Ray]:
    """Return the rays that go on from the end of a leg."""
    last = leg.met[-1]
    if optic is None or last.event not in ("reflected", "divided"):
        return []
    assert optic.center is not None
    struck = Struck(last.at, ray.towards, optic.center, optic.normal, optic.left, ray.wavelength, optic.kicks)
    ways = geometry_of(optic.element).ways(struck)
    return [Ray(at, way, last.length, optic.name, number, ray.wavelength) for at, way in ways]


def _to_edge(table: tuple[float, float], ray: Ray) -> float:
    """Return how far ahead a ray leaves the space over the table: over its edge, or into its top [mm]."""
    ways = [
        ((size if step > 0 else 0.0) - at) / step
        for at, step, size in zip(ray.at[:2], ray.towards[:2], table, strict=True)
        if abs(step) > 1e-12
    ]
    if ray.towards[2] < 0:
        ways.append(ray.at[2] / -ray.towards[2])
    return max(0.0, min(ways, default=0.0))


def _along(ray: Ray, far: float) -> Vector:
    x, y, z = (p + far * d for p, d in zip(ray.at, ray.towards, strict=True))
    return x, y, z


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _sum(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _times(a: Vector, by: float) -> Vector:
    return a[0] * by, a[1] * by, a[2] * by

"""How far two things on the bench are from each other: between points, between surfaces, along a beam. mm, table frame.

An end is a component (`p2`: its optical center; `p2:base`: where its origin stands; `p2:hole`: the hole nearest to it),
a slot (`storage/a1`), a point (`520,420`) or a hole (`hole:12,7`, column and row; the front-left one is 1,1).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.drawing.beams import Place, standing
from pico.drawing.dimensions import Dimension
from pico.drawing.picture import placed, posed_model
from pico.model.pose import Pose, short
from pico.model.setup import Setup
from pico.motion.types import Joints
from pico.optics.axis import Values
from pico.twin.placement import Placement

if TYPE_CHECKING:
    from pico.optics.light import Light

Vector = tuple[float, float, float]
SNAPS = ("optical", "base", "hole")
_FARTHEST = 20.0  # m, at which two surfaces are still looked for


@dataclass(frozen=True, slots=True)
class End:
    """One end of a ruler: as asked for, the point [mm] and what is there; `component` where it is one."""

    name: str
    at: Vector
    what: str
    component: str = ""


@dataclass(frozen=True, slots=True)
class Span:
    """From one point to another [mm]."""

    start: Vector
    end: Vector

    @property
    def delta(self) -> Vector:
        """dx, dy, dz [mm]."""
        x, y, z = (b - a for a, b in zip(self.start, self.end, strict=True))
        return x, y, z

    @property
    def length(self) -> float:
        """The distance [mm]."""
        return math.hypot(*self.delta)

    @property
    def angle(self) -> float:
        """The direction seen from above, from x counter-clockwise [deg]; 0 for one straight up."""
        dx, dy, _ = self.delta
        return math.degrees(math.atan2(dy, dx)) if math.hypot(dx, dy) > 1e-9 else 0.0


@dataclass(frozen=True, slots=True)
class NearestFaces:
    """The nearest faces of two components: where, the `gap` between them [mm], below zero where they overlap, and
    which parts of the housings they belong to."""

    span: Span
    gap: float
    a: str
    b: str


@dataclass(frozen=True, slots=True)
class AlongBeam:
    """The second end seen along the axis of a component: how far `ahead` of the first, to its `left`, and `above` it
    [mm]; `turned`: how much a second component faces elsewhere [deg]."""

    axis: str
    ahead: float
    left: float
    above: float
    turned: float | None = None


@dataclass(frozen=True, slots=True)
class ByLight:
    """A way that the beam of `source` takes from one end to the other, `over` which mirrors and splitters, and how long
    it is [mm], from optic to optic."""

    source: str
    over: tuple[str, ...]
    length: float


@dataclass(frozen=True, slots=True)
class Measured:
    """What a ruler shows; `surfaces` between two components only, `beam` where one end is a component, `ways` of light
    from one component to the other, the shortest first."""

    a: End
    b: End
    centers: Span
    surfaces: NearestFaces | None = None
    beam: AlongBeam | None = None
    ways: tuple[ByLight, ...] = ()

    @property
    def dimensions(self) -> tuple[Dimension, ...]:
        """What a picture of it shows."""
        flat = [Dimension(self.centers.start[:2], self.centers.end[:2], f"{short(self.centers.length)} mm")]
        if self.surfaces and self.surfaces.gap > 0:
            span = self.surfaces.span
            flat.append(Dimension(span.start[:2], span.end[:2], f"{short(self.surfaces.gap)} mm", surfaces=True))
        return tuple(flat)


def measure(
    setup: Setup, poses: Mapping[str, Place], joints: Mapping[str, Joints], first: str, second: str,
    values: Values | None = None,
) -> Measured:  # fmt: skip
    """Return how far the ends named `first` and `second` are apart; `values` of mirrors and irises count along a beam.
    Raises PicoError naming each that is not there."""
    places = placed(poses)
    problems: list[Diagnostic] = []
    ends = []
    for word in (first, second):
        try:
            ends.append(end_of(setup, places, word))
        except PicoError as exc:
            problems += exc.diagnostics
    if problems:
        raise PicoError(problems)
    a, b = ends
    if not (a.component and b.component and a.component != b.component):
        return Measured(a, b, Span(a.at, b.at), None, _along(places, a, b))
    between = _surfaces(setup, places, joints, a.component, b.component)
    light = _light(setup, standing(poses), values or {})
    ways = [*_ways(light, a.component, b.component), *_ways(light, b.component, a.component)]
    shortest = tuple(sorted(ways, key=lambda way: way.length))
    return Measured(a, b, Span(a.at, b.at), between, _along(places, a, b), shortest)


def _light(setup: Setup, poses: Mapping[str, Pose], values: Values) -> Light:
    """Return the light with all shutters open."""
    from pico.optics.light import light_of

    opened = {name: {k: v for k, v in own.items() if k != "shutter"} for name, own in values.items()}
    return light_of(setup, poses, opened, lit=lambda _: True)


def _ways(light: Light, first: str, then: str) -> Iterator[ByLight]:
    """Yield each way of a beam from one component to another."""
    known = set()
    for number, crossing in enumerate(light.crossings):
        if crossing.component != then or crossing.event == "blocked" or crossing.beam.ghost:
            continue
        way = light.way(number)
        starts = [n for n, met in enumerate(way[:-1]) if met.component == first]
        if not starts and crossing.beam.source != first:
            continue
        after, begun = (starts[-1] + 1, way[starts[-1]].beam.length) if starts else (0, 0.0)
        over = tuple(met.component for met in way[after:-1] if met.event != "passed")
        if (over, crossing.beam.length - begun) not in known:
            known.add((over, crossing.beam.length - begun))
            yield ByLight(crossing.beam.source, over, crossing.beam.length - begun)


def end_of(setup: Setup, places: Mapping[str, Placement], word: str) -> End:
    """Return the end that `word` names; raises PicoError."""
    name, _, snap = word.partition(":")
    if name == "hole":
        return _hole(setup, word, snap)
    if numbers := _numbers(word):
        if len(numbers) not in (2, 3):
            raise _wrong(word, "a point is x,y or x,y,z in mm, for example `520,420`")
        x, y, z = (*numbers, 0.0)[:3]
        return End(word, (x, y, z), "point")
    if word in setup.lab.slots:
        slot = setup.lab.slots[word]
        return End(word, (slot.x, slot.y, 0.0), "middle of the slot")
    if name not in setup.lab.inventory:
        known = [*setup.lab.inventory, *setup.lab.slots]
        near = did_you_mean(name, known)
        hint = (
            f"{near}; or a point `520,420`, a hole `hole:12,7`" if near else "a point is `520,420`, a hole `hole:12,7`"
        )
        raise PicoError(error("unknown-component", f"there is neither a component nor a slot `{name}`", hint=hint))
    if name not in places:
        raise PicoError(error("not-seen", f"{name} is not on the table", hint="`pico status` says where parts are"))
    return _component(setup, places[name], name, word, snap or "optical")


def _component(setup: Setup, place: Placement, name: str, word: str, snap: str) -> End:
    if snap not in SNAPS:
        raise _wrong(word, did_you_mean(snap, SNAPS))
    if snap == "optical":
        return End(word, _in_table(place, setup.type_of(name).frames.optical), "optical center", name)
    base = _in_table(place, (0.0, 0.0, 0.0))
    if snap == "base":
        return End(word, base, "base", name)
    holes = setup.lab.table.holes
    column, row = (round((base[i] - holes.first[i]) / holes.pitch) + 1 for i in (0, 1))
    return replace(_hole(setup, word, f"{column},{row}"), name=word)


def _hole(setup: Setup, word: str, text: str) -> End:
    numbers = _numbers(text)
    holes, size = setup.lab.table.holes, setup.lab.table.size
    most = [int((size[i] - holes.first[i]) / holes.pitch) + 1 for i in (0, 1)]
    if len(numbers) != 2 or any(n != int(n) for n in numbers):
        raise _wrong(word, "a hole is `hole:COLUMN,ROW`, for example `hole:12,7`")
    if not all(1 <= n <= m for n, m in zip(numbers, most, strict=True)):
        raise _wrong(word, f"the table has {most[0]} columns and {most[1]} rows of holes, counted from 1")
    column, row = (int(n) for n in numbers)
    x, y = (holes.first[i] + (n - 1) * holes.pitch for i, n in enumerate((column, row)))
    return End(word, (x, y, 0.0), f"{holes.thread} hole, column {column}, row {row}")


def _numbers(text: str) -> tuple[float, ...]:
    words = [w.strip() for w in text.strip("() ").split(",")]
    if len(words) < 2 or not all(re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)", w) for w in words):
        return ()
    return tuple(float(w) for w in words)


def _wrong(word: str, hint: str) -> PicoError:
    return PicoError(error("usage", f"`{word}` is no end of a ruler", hint=hint))


def _in_table(place: Placement, local: Vector) -> Vector:
    """A point of a component [mm, its own frame] in the table frame [mm]."""
    w, x, y, z = place.quaternion
    px, py, pz = local
    # q p q*, written out with t = 2 (q x p)
    tx, ty, tz = 2 * (y * pz - z * py), 2 * (z * px - x * pz), 2 * (x * py - y * px)
    turned = (
        px + w * tx + y * tz - z * ty,
        py + w * ty + z * tx - x * tz,
        pz + w * tz + x * ty - y * tx,
    )
    a, b, c = (1000 * p + t for p, t in zip(place.position, turned, strict=True))
    return a, b, c


def _along(places: Mapping[str, Placement], a: End, b: End) -> AlongBeam | None:
    """The second end along the beam axis, the local x, of the first one that is a component."""
    if not (a.component or b.component):
        return None
    axis = a.component or b.component
    yaw = math.radians(places[axis].pose.yaw)
    dx, dy, dz = Span(a.at, b.at).delta
    turned = None
    if a.component and b.component:
        turned = (places[b.component].pose.yaw - places[a.component].pose.yaw + 180) % 360 - 180
    c, s = math.cos(yaw), math.sin(yaw)
    return AlongBeam(axis, c * dx + s * dy, c * dy - s * dx, dz, turned)


def _surfaces(
    setup: Setup, places: Mapping[str, Placement], joints: Mapping[str, Joints], first: str, second: str
) -> NearestFaces:
    """The nearest faces of two components' housings, by MuJoCo's distance between convex shapes."""
    import mujoco
    import numpy as np

    model, data = posed_model(setup, {n: places[n] for n in (first, second)}, joints)
    geoms = [_geoms(model, name) for name in (first, second)]
    best: NearestFaces | None = None
    for i in geoms[0]:
        for j in geoms[1]:
            points = np.zeros(6)
            gap = mujoco.mj_geomDistance(model, data, i, j, _FARTHEST, points) * 1000
            if best is None or gap < best.gap - 1e-6:
                start, end = (tuple(float(v) * 1000 for v in points[k : k + 3]) for k in (0, 3))
                names = [model.geom(g).name.rpartition("/")[2] for g in (i, j)]
                best = NearestFaces(Span(start, end), float(gap), *names)  # type: ignore[arg-type]
    assert best is not None  # a component has at least one shape
    return best


def _geoms(model: object, name: str) -> list[int]:
    body = model.body(name)  # type: ignore[attr-defined]
    return list(range(int(body.geomadr[0]), int(body.geomadr[0]) + int(body.geomnum[0])))

"""Random layouts of a source, mirrors and splitters, and an independent reference for where its beam goes.

The reference knows nothing of rays and planes: a beam is a line of shapely, a component the shapes that it shows to the
light, and what is met is the nearest crossing; a mirror is a reflection of complex numbers.
"""

from __future__ import annotations

import cmath
import math
import random
from collections.abc import Iterator
from dataclasses import dataclass

from shapely import LineString, Point, Polygon

from pico.model.pose import Pose
from pico.model.setup import Setup

KINDS = ("mirror", "beam_splitter", "lens", "detector", "block")
WEIGHTS = (10, 4, 3, 1, 1)


def layout(setup: Setup, names: dict[str, list[str]], seed: int) -> dict[str, Pose]:
    """Return poses of a source and of optics that are put, one after the other, where a beam runs (with an error), or
    anywhere; `names`: components by element."""
    rng = random.Random(seed)
    width, depth = setup.lab.table.size
    poses = {names["source"][0]: Pose(rng.uniform(60, width - 60), rng.uniform(60, depth - 60), rng.uniform(-180, 180))}
    free = {kind: list(names[kind]) for kind in KINDS}
    for kind in rng.choices(KINDS, WEIGHTS, k=rng.randint(2, 12)):
        if not free[kind]:
            continue
        name = free[kind].pop()
        legs = list(reference(setup, poses))
        leg = rng.choice(legs)
        where = leg.start + (leg.end - leg.start) * rng.uniform(0.2, 0.9) + complex(rng.gauss(0, 4), rng.gauss(0, 4))
        where = where if rng.random() < 0.9 else complex(rng.uniform(0, width), rng.uniform(0, depth))
        poses[name] = Pose(
            where.real, where.imag, math.degrees(cmath.phase(leg.end - leg.start)) + rng.uniform(-70, 70)
        )
    return poses


@dataclass(frozen=True)
class Stretch:
    """A straight piece in the plane, what ends it ("" for the table's edge) and how, and the way from the source."""

    start: complex
    end: complex
    name: str
    event: str
    length: float


def reference(setup: Setup, poses: dict[str, Pose], most: int = 256) -> Iterator[Stretch]:
    """Yield the pieces of the beam of the one source, in the order in which they branch."""
    source = next(name for name in poses if setup.type_of(name).optics.element == "source")
    waiting = [(at(poses[source], *setup.type_of(source).frames.optical[:2]), turned(poses[source]), 0.0, source)]
    while waiting and most:
        start, way, length, left = waiting.pop(0)
        most -= 1
        far, name, event, ways = nearest(setup, poses, start, way, left)
        yield Stretch(start, start + far * way, name, event, length + far)
        waiting += [(start + far * way, onward, length + far, name) for onward in ways]


def nearest(setup, poses, start, way, left):  # type: ignore[no-untyped-def]
    line = LineString([(start.real, start.imag), ((start + 9000 * way).real, (start + 9000 * way).imag)])
    width, depth = setup.lab.table.size
    edge = Polygon([(0, 0), (width, 0), (width, depth), (0, depth)]).exterior
    found = [(Point(start.real, start.imag).distance(line.intersection(edge)), "", "left", [])]
    for name, pose in poses.items():
        if name != left:
            found += met(setup, name, pose, line, start, way)
    return min(found, key=lambda one: (one[0], one[1]))


def met(setup, name, pose, line, start, way):  # type: ignore[no-untyped-def]
    kind = setup.type_of(name)
    element, here = kind.optics.element, Point(start.real, start.imag)
    aperture = kind.geometry.clear_aperture
    if aperture and element not in ("block", "source"):
        center, r, axis = at(pose, *aperture.center[:2]), aperture.diameter / 2, turned(pose)
        if element == "beam_splitter":
            coating = axis * cmath.exp(1j * math.pi / 4)
            face, reach = coating, r * math.sqrt(2)
        else:
            coating = face = axis * 1j
            reach = r
        ends = [center - reach * face, center + reach * face]
        crossing = line.intersection(LineString([(e.real, e.imag) for e in ends]))
        if not crossing.is_empty:
            aside = abs(((complex(crossing.x, crossing.y) - center) / way).imag)
            ahead = (way / axis).real > 0
            if element == "lens":
                return []
            if element == "beam_splitter" and aside <= r:
                return [(here.distance(crossing), name, "divided", [way, (way / coating).conjugate() * coating])]
            if element == "mirror" and ahead:
                return [(here.distance(crossing), name, "reflected", [(way / coating).conjugate() * coating])]
            if element == "detector" and ahead:
                return [(here.distance(crossing), name, "detected", [])]
    outline = kind.geometry.footprint
    shape = Point(pose.x, pose.y).buffer(outline.disc, 4096) if outline.disc else Polygon(
        [(at(pose, *corner).real, at(pose, *corner).imag) for corner in outline.vertices]
    )  # fmt: skip
    crossing = line.intersection(shape)
    return [] if crossing.is_empty else [(here.distance(crossing), name, "blocked", [])]


def at(pose: Pose, x: float, y: float) -> complex:
    return complex(pose.x, pose.y) + complex(x, y) * turned(pose)


def turned(pose: Pose) -> complex:
    return cmath.exp(1j * math.radians(pose.yaw))

"""A beam expander: a telescope as one element."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam, level, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.polarization import carried, joined, product, split

_PARAXIAL = math.cos(math.radians(5))


def meet(part: Part, beam: Beam) -> Met:
    """Widen a beam that comes along local +x by `magnification` m, narrow one that comes the other way. It takes what
    it finds at its first lens, `length` / 2 before its center, to its last: (offset, slope) to (m offset + L slope,
    slope / m), a Galilean telescope; so distances r from the axis become m r, and M / (m^2 + m L M) follows. Its edge
    is that of its first lens, of the diameter of its clear aperture, or m times wider at its wide end."""
    along, left, up = part.axes
    length, large = part.number("length", "mm", 0.0), part.number("magnification", "", 1.0)
    side = 1.0 if beam.along @ along > 0 else -1.0
    by = large if side > 0 else 1 / large
    axis = side * along
    first, last = part.center - length / 2 * axis, part.center + length / 2 * axis
    came = arrived(part, beam, at=first)
    passed, lost = clipped(part, came, part.optic.radius * (1.0 if side > 0 else large), center=first)
    facing = float(came.along @ axis)
    plane = np.stack([left, up])
    slope, offset = plane @ came.along / facing, plane @ (came.at - first)
    at = last + (by * offset + length * slope) @ plane
    towards = axis + (slope / by) @ plane
    towards = towards / np.linalg.norm(towards)
    across = level(towards, came.across)
    frame = np.stack([across, product(towards, across)]) @ plane.T
    turn = frame @ np.linalg.inv(came.frame @ plane.T)
    stretch = by * np.eye(2) + length * passed.curvature
    curvature = turn @ (passed.curvature / by @ np.linalg.inv(stretch)) @ turn.T
    s = product(came.along, towards)
    size = float(np.linalg.norm(s))
    s = s / size if size > 1e-12 else came.across
    # Hamilton's characteristic of a paraxial system: by how much the way of this ray is longer than that on the axis
    longer = float(plane @ (at - last) @ (slope / by) - offset @ slope) / 2
    unknown = passed.unknown
    if facing < _PARAXIAL and not unknown:
        unknown = f"{part.name} is met aslant, where its lenses, which are not known one by one, do not focus as one"
    share = math.sqrt(part.number("transmission", "", 1.0))
    waves = tuple(
        replace(
            w, field=joined(*split(w.field, came.along, s), towards, s),
            shift=turn @ (np.linalg.inv(stretch) @ w.shift),
        )
        for w in passed.waves
    )  # fmt: skip
    sent = replace(
        passed, at=at, along=towards, across=level(towards, carried(came.across, came.along, towards, s)),
        curvature=(curvature + curvature.T) / 2, waves=waves, path=came.path + length + longer,
        length=came.length + length, unknown=unknown,
    )  # fmt: skip
    return Met(came, (scaled(sent, share),), lost)

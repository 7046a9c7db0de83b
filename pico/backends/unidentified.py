"""What stands on a bench and nobody identified, as obstacles. For every backend."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.backends.last_seen import SWAPPED, LastSeen
from pico.diagnostics import Diagnostic, warning
from pico.model.catalog import Footprint
from pico.model.observation import Observation, ObservedComponent, UnknownObject
from pico.model.pose import Pose
from pico.model.setup import Setup

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.camera import CameraModel
    from pico.vision.frame import Frame

    Array = NDArray[np.float64]


_APART = 20.0  # mm that a part is at least elsewhere
_SAME = 2.0  # mm
_SWAP_HINT = "put the markers back; if it is the parts that were exchanged, push one of them by a few millimetres"


def with_unidentified(
    setup: Setup, seen: Observation, frames: Sequence[Frame], cameras: Mapping[str, CameraModel]
) -> Observation:
    """Return the observation with what `frames` show on the table and it does not have: obstacles, each told once."""
    from pico.vision.leftovers import leftovers

    tall = max([100.0, *(setup.type_of(n).geometry.height for n in setup.lab.inventory if setup.movable(n))])
    missing = sorted(n for n, part in seen.components.items() if part.presence == "missing")
    lying = [(p.pose, setup.type_of(n).geometry.height) for n, p in seen.components.items() if p.presence == "toppled"]
    maybe = f"; it may be {' or '.join(missing)}" if missing else ""
    unknown, problems = dict(seen.unknown), list(seen.problems)
    for number, thing in enumerate(leftovers(setup, frames, cameras, list(_solids(setup, seen))), 1):
        name, size = f"unknown/thing_{number}", math.ceil(thing.radius)
        pose = Pose(round(thing.x, 1), round(thing.y, 1))
        unknown[name] = UnknownObject(pose=pose, footprint=Footprint(disc=size), height=tall)
        if any(at and at.distance(pose) < size + height for at, height in lying):
            continue  # it has been told that this part lies there
        text = f"something without a marker stands or lies at ({pose.x:.0f}, {pose.y:.0f}), within {size} mm{maybe}"
        hint = "take it off the table, or stand it upright; until then nothing goes near it"
        problems.append(warning("unidentified", text, hint=hint, address=name))
    return replace(seen, unknown=unknown, problems=tuple(problems))


def swapped(components: Mapping[str, ObservedComponent], last: Mapping[str, LastSeen]) -> Iterator[Diagnostic]:
    """Yield a warning for each part that stands exactly where another one was at the last look, if that one, or who
    took its place, and so on, stands where the first was. Nobody puts parts down so exactly; markers are exchanged so.
    """
    now = {n: p.pose for n, p in components.items() if p.pose and p.presence == "seen" and n in last}
    moved = [n for n, pose in now.items() if pose.distance(last[n].pose) > _APART]
    taken = {a: b for a in moved for b in moved if a != b and now[a].distance(last[b].pose) < _SAME}
    for name, other in sorted(taken.items()):
        ring = [name]
        while ring[-1] in taken and len(ring) <= len(taken):
            ring.append(taken[ring[-1]])
            if ring[-1] == name:
                text = (
                    f"{name} stands where {other} stood at the last look, to the millimetre: is its marker on {other}?"
                )
                yield warning(SWAPPED, text, hint=_SWAP_HINT, address=name)
                break


def _solids(setup: Setup, seen: Observation) -> Iterator[Array]:
    """Everything that is known to stand on the table or to hang over it, by the points of convex hulls [mm]."""
    import numpy as np

    from pico.drawing.picture import posed_model
    from pico.twin.placement import upright

    places = {n: upright(p.pose) for n, p in seen.components.items() if p.pose and p.presence == "seen"}
    model, data = posed_model(setup, places, {name: robot.joints for name, robot in seen.robots.items()})
    for geom in range(model.ngeom):
        if model.geom_bodyid[geom] != 0:
            middle, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
            corners = middle + half * np.array(_CORNERS)
            yield (corners @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]) * 1000
    for name, part in seen.components.items():
        if part.pose is not None and part.presence == "held":
            yield _prism(part.pose, setup.type_of(name).geometry.footprint.radius, 400.0)
    for name, thing in seen.unknown.items():
        if name.startswith("unknown/unread"):  # a marker that was half seen: how large its body is nobody knows
            continue
        yield _prism(thing.pose, thing.footprint.radius, thing.height)


def _prism(pose: Pose, radius: float, height: float) -> Array:
    import numpy as np

    angles = np.linspace(0.0, 2 * math.pi, 12, endpoint=False)
    rim = np.column_stack((pose.x + radius * np.cos(angles), pose.y + radius * np.sin(angles)))
    return np.array([(x, y, z) for z in (0.0, height) for x, y in rim])


_CORNERS = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]

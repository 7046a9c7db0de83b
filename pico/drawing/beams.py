"""Where beams run in a picture: straight on from each source, for the eye only; light itself is traced elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pico.model.lab import Setup
from pico.model.pose import Pose
from pico.twin.placement import Placement

Place = Pose | Placement
_STOPS = ("detector", "block", "mirror")


def flat(poses: Mapping[str, Place]) -> dict[str, Pose]:
    """Return poses seen from above."""
    return {name: at.pose if isinstance(at, Placement) else at for name, at in poses.items()}


def beam_paths(
    setup: Setup, poses: Mapping[str, Place]
) -> Sequence[tuple[str, tuple[float, float], tuple[float, float]]]:
    """Return (source, start, end) [mm] of straight beams seen from above, each up to the first detector, block or
    mirror that it meets, or the table's edge."""
    places = flat(poses)
    found = []
    for name, pose in sorted(places.items()):
        kind = setup.type_of(name)
        if kind.optics.element != "source":
            continue
        start = Pose(*pose.apply(*kind.frames.optical[:2]), pose.yaw)
        length = min([_to_edge(setup, start), *_stops(setup, places, name, start)])
        found.append((name, (start.x, start.y), start.apply(length, 0.0)))
    return found


def _stops(setup: Setup, poses: Mapping[str, Pose], source: str, axis: Pose) -> list[float]:
    """Distances from the source to the optics that stop its beam [mm]."""
    found = []
    for name, pose in poses.items():
        kind = setup.type_of(name)
        if name == source or kind.optics.element not in _STOPS:
            continue
        aperture = kind.geometry.clear_aperture
        center = aperture.center if aperture else kind.frames.optical
        local = axis.inverse().compose(Pose(*pose.apply(center[0], center[1])))
        if local.x > 0 and abs(local.y) < (aperture.diameter / 2 if aperture else 12.0):
            found.append(local.x)
    return found


def _to_edge(setup: Setup, axis: Pose) -> float:
    ahead = axis.apply(1.0, 0.0)
    ways = [
        ((size if step > 0 else 0.0) - at) / step
        for at, step, size in zip(
            (axis.x, axis.y), (ahead[0] - axis.x, ahead[1] - axis.y), setup.lab.table.size, strict=True
        )
        if abs(step) > 1e-9
    ]
    return max(0.0, min(ways))

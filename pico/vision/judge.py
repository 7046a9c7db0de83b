"""From the views of one marker to its pose, or to what is wrong with it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pico.model.catalog import MarkerPlate
from pico.model.observation import Uncertainty
from pico.vision.calibration import Accuracy
from pico.vision.poses import (
    Estimate,
    MarkerView,
    edge,
    flat_start,
    free,
    from_rays,
    meet,
    on_plane,
    plane_points,
    triangulated,
)
from pico.vision.sighting import How, Kind

UPRIGHT = 3.0
"""A marker whose normal is farther off the vertical [deg] is on a part that leans or lies."""
_HEIGHT = 2.0  # mm that a marker may be off the height that its type has
_SIZE = 0.03  # share that a marker may be larger or smaller than its type has it
_SIGMAS = 4.0


@dataclass(frozen=True, eq=False)
class Verdict:
    """What became of a marker: an estimate to trust with how it was made, or the `kind` of what is wrong, in words."""

    estimate: Estimate | None
    how: How
    kind: Kind | None = None
    text: str = ""


def judged(views: Sequence[MarkerView], plate: MarkerPlate, accuracy: Accuracy, in_hand: bool) -> Verdict:
    """Return the pose of the marker that `views` show, if they agree that it stands upright on its type's height."""
    if len(views) > 1:
        return _by_rays(views, plate, accuracy, "in hand" if in_hand else "stereo")
    return _by_height(views[0], plate, accuracy, "in hand" if in_hand else "known height")


def _by_rays(views: Sequence[MarkerView], plate: MarkerPlate, accuracy: Accuracy, how: How) -> Verdict:
    if not meet(views):
        return Verdict(None, how, "conflict", _apart(views, plate.at[2]))
    size = edge(triangulated(views))
    true_size = abs(size / plate.size - 1) < _SIZE + _SIGMAS * size_sigma(views, accuracy) / plate.size
    estimate = from_rays(views, plate.size if true_size else size)
    limit = _SIGMAS * math.hypot(accuracy.pixels, max(v.marker.noise for v in views))
    if not estimate.residual <= limit or estimate.height < -50:  # not a number where it lies behind a camera
        return Verdict(None, how, "conflict", _apart(views, plate.at[2]))
    wrong = _leaning(estimate) or _height(estimate, plate.at[2], accuracy)
    if wrong:
        return Verdict(None, how, *wrong)
    if not true_size:
        return Verdict(estimate, how, "size", f"measures {size:.1f} mm, its type has {plate.size:g} mm")
    return Verdict(estimate, how)


def _by_height(view: MarkerView, plate: MarkerPlate, accuracy: Accuracy, how: How) -> Verdict:
    """One camera: the picture must fit a marker that stands upright at its height, and no leaning one much better."""
    estimate = on_plane([view], plate.size, plate.at[2], accuracy.height, accuracy.upright)
    loose = free(view, plate.size, estimate.pose)
    wrong = _leaning(loose) or _height(loose, plate.at[2], accuracy)
    if wrong:
        return Verdict(None, how, *wrong)
    if estimate.residual > _SIGMAS * math.hypot(accuracy.pixels / 3, view.marker.noise):
        side = edge(plane_points(view, plate.at[2]))
        text = f"does not fit an upright marker of {plate.size:g} mm at {plate.at[2]:g} mm: it measures {side:.1f} mm"
        return Verdict(None, how, "height", text)
    return Verdict(estimate, how)


def _leaning(estimate: Estimate) -> tuple[Kind, str] | None:
    if estimate.tilt <= UPRIGHT + _SIGMAS * estimate.tilt_sigma:
        return None
    return "tilted", f"is tilted by {estimate.tilt:.0f} deg"


def _height(estimate: Estimate, height: float, accuracy: Accuracy) -> tuple[Kind, str] | None:
    limit = max(_HEIGHT, _SIGMAS * math.hypot(estimate.height_sigma, accuracy.height))
    if abs(estimate.height - height) <= limit:
        return None
    return "height", f"is {estimate.height:.1f} mm above the table, its type has it at {height:g} mm: the wrong plate?"


def size_sigma(views: Sequence[MarkerView], accuracy: Accuracy) -> float:
    """Return one standard deviation of a triangulated edge [mm]: corner noise over the pixels of an edge."""
    noise = max(view.marker.noise for view in views)
    return noise / math.sqrt(2) * max(24.0 / edge(view.marker.corners) for view in views)


def _apart(views: Sequence[MarkerView], height: float) -> str:
    places = []
    for view in views:
        x, y = flat_start(view, 24.0, height)[:2, 3]
        places.append(f"at ({x:.0f}, {y:.0f}) by `{view.camera.name}`")
    return "is seen " + " and ".join(places) + ", which can't be one marker"


def combined(
    estimate: Estimate, accuracy: Accuracy, point: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> Uncertainty:
    """Return one standard deviation of a pose, or of where a `point` of the marker's frame is [mm]: noise of the
    corners, and what the calibration adds."""
    noise = estimate.known_at(point)
    return Uncertainty(position=math.hypot(noise.position, accuracy.position), yaw=math.hypot(noise.yaw, accuracy.yaw))

"""Poses of markers from what cameras saw: from several at once, or from one and a height that is known. mm."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from pico.model.observation import Uncertainty
from pico.vision.camera import CameraModel
from pico.vision.least_squares import solve
from pico.vision.markers import CELLS, Marker
from pico.vision.rigid import best_motion, motion, moved, square, tilt

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_STEPS = (1e-3,) * 3 + (1e-5,) * 3  # mm and rad, for derivatives


@dataclass(frozen=True, eq=False)
class MarkerView:
    """A marker as one camera saw it; the camera stands in the table's frame."""

    camera: CameraModel
    marker: Marker


@dataclass(frozen=True, eq=False)
class Estimate:
    """The pose (4, 4) of a marker [mm] and its covariance (6, 6): of x, y, z [mm] and of turns about them [rad].

    `residual`: root mean square distance of the corners from where the pose has them [pixels].
    """

    pose: Array
    covariance: Array
    residual: float

    @property
    def height(self) -> float:
        """The height of the marker's center above the table [mm]."""
        return float(self.pose[2, 3])

    @property
    def height_sigma(self) -> float:
        """One standard deviation of the height [mm]."""
        return math.sqrt(max(0.0, float(self.covariance[2, 2])))

    @property
    def tilt(self) -> float:
        """The angle between the marker's normal and the vertical [deg]."""
        return tilt(self.pose)

    @property
    def tilt_sigma(self) -> float:
        """One standard deviation of the tilt, in its worse direction [deg]."""
        import numpy as np

        return math.degrees(math.sqrt(max(0.0, float(np.linalg.eigvalsh(self.covariance[3:5, 3:5])[-1]))))

    @property
    def uncertainty(self) -> Uncertainty:
        """One standard deviation of its middle, see `known_at`."""
        return self.known_at((0.0, 0.0, 0.0))

    def known_at(self, point: tuple[float, float, float]) -> Uncertainty:
        """Return one standard deviation, from the noise of the corners, of where a `point` of the marker's frame is
        [mm], in its worse direction, and of yaw. A tilt moves what is below."""
        import numpy as np

        arm = self.pose[:3, :3] @ np.array(point)
        lever = np.array(((0.0, arm[2], -arm[1]), (-arm[2], 0.0, arm[0])))  # of turns about x, y, z: turn x arm
        jacobian = np.column_stack((np.eye(2, 3), lever))
        covariance = jacobian @ self.covariance @ jacobian.T
        position = math.sqrt(max(0.0, float(np.linalg.eigvalsh(covariance)[-1])))
        return Uncertainty(position=position, yaw=math.degrees(math.sqrt(max(0.0, float(self.covariance[5, 5])))))


def triangulated(views: Sequence[MarkerView]) -> Array:
    """Return the points (4, 3) that are nearest to the rays behind the corners, seen by two cameras or more."""
    import numpy as np

    normal, right = np.zeros((4, 3, 3)), np.zeros((4, 3))
    for view in views:
        origin, along = view.camera.rays(view.marker.corners)
        across = np.eye(3) - along[:, :, None] * along[:, None, :]
        normal, right = normal + across, right + across @ origin
    points: Array = np.asarray(np.linalg.solve(normal, right[:, :, None])[:, :, 0], np.float64)
    return points


def meet(views: Sequence[MarkerView]) -> bool:
    """Return whether the rays behind the corners come nearest to one another in front of every camera."""
    import numpy as np

    points = triangulated(views)
    return all(bool(np.isfinite(view.camera.project(points)).all()) for view in views)


def edge(corners: Array) -> float:
    """Return the mean length of the edges of a square with `corners` (4, n)."""
    import numpy as np

    return float(np.mean(np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)))


def from_rays(views: Sequence[MarkerView], size: float) -> Estimate:
    """Return the pose of a marker with edges of `size` [mm] that two cameras or more saw.

    The corners are triangulated and the square laid into them (Kabsch); then the pose is moved to where the corners
    in all pictures fit best.
    """
    return _fitted(views, size, best_motion(square(size), triangulated(views)))


def on_plane(
    views: Sequence[MarkerView], size: float, height: float, height_sigma: float, tilt_sigma: float
) -> Estimate:
    """Return the pose of a marker that stands upright, its center `height` above the table [mm].

    One camera is enough. `height_sigma` [mm] and `tilt_sigma` [deg]: how well it is known that it does.
    """
    return leaning_as(views, size, flat_start(views[0], size, height), height_sigma, tilt_sigma)


def leaning_as(
    views: Sequence[MarkerView], size: float, there: Array, height_sigma: float, tilt_sigma: float
) -> Estimate:
    """Return the pose of a marker that is as high and leans as one at `there` (4, 4), near which it is.

    `height_sigma` [mm] and `tilt_sigma` [deg]: how well it is known that it does.
    """
    import numpy as np

    sigma = np.array([height_sigma, math.radians(tilt_sigma), math.radians(tilt_sigma)])
    return _fitted(views, size, there, (there, sigma))


def flat_start(view: MarkerView, size: float, height: float) -> Array:
    """Return the upright pose (4, 4) at `height` [mm] whose square is nearest to where the corners' rays end there."""
    import numpy as np

    seen = plane_points(view, height)
    flat = best_motion(square(size), seen)
    yaw = math.atan2(flat[1, 0], flat[0, 0])
    c, s = math.cos(yaw), math.sin(yaw)
    return motion(np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]), np.append(seen[:, :2].mean(axis=0), height))


def plane_points(view: MarkerView, height: float) -> Array:
    """Return where the rays behind the corners meet the plane `height` above the table (4, 3) [mm]."""
    origin, along = view.camera.rays(view.marker.corners)
    points: Array = origin + along * ((height - origin[2]) / along[:, 2])[:, None]
    return points


def free(view: MarkerView, size: float, start: Array) -> Estimate:
    """Return the pose that fits one picture best with nothing known but the `size` [mm], near `start` (4, 4)."""
    return _fitted([view], size, start)


def straightened(view: MarkerView, size: float, pose: Array) -> MarkerView:
    """Return a view with its corners where the lens shows them.

    They were found by laying a plane's picture (a homography) through the whole marker. A lens bends that picture, so
    that the corners of the fit are off those of the marker: by 0.06 pixels for 150 pixels of marker and k1 = -0.05.
    How far off follows from the camera; the marker's `size` and where it is, about `pose` (4, 4), are enough for that.
    """
    import cv2
    import numpy as np

    if not view.camera.distortion.any():
        return view
    lines = np.linspace(-0.5, 0.5, CELLS + 1) * size
    grid = np.array([(x, y, 0.0) for y in lines[::-1] for x in lines])
    seen = view.camera.project(grid @ pose[:3, :3].T + pose[:3, 3])
    if not np.isfinite(seen).all():
        return view
    laid, _ = cv2.findHomography(grid[:, :2], seen)
    fitted = cv2.perspectiveTransform(square(size)[:, None, :2], laid)[:, 0]
    corners = view.camera.project(square(size) @ pose[:3, :3].T + pose[:3, 3])
    return replace(view, marker=replace(view.marker, corners=view.marker.corners - (fitted - corners)))


def _fitted(
    views: Sequence[MarkerView], size: float, start: Array, known: tuple[Array, Array] | None = None
) -> Estimate:
    """Return the pose near `start` that fits all pictures; `known`: a pose whose height and tilt hold within sigmas."""
    import numpy as np

    corners = square(size)
    views = [straightened(view, size, start) for view in views]
    whitening = [np.linalg.inv(np.linalg.cholesky(view.marker.covariance)) for view in views]

    def residuals(change: Array) -> Array:
        pose = moved(start, change)
        points = corners @ pose[:3, :3].T + pose[:3, 3]
        off = [(v.camera.project(points) - v.marker.corners).ravel() for v in views]
        left = [white @ one for white, one in zip(whitening, off, strict=True)]
        if known is not None:
            there, sigma = known
            apart = pose - there
            left.append(np.array([apart[2, 3], apart[1, 2], apart[0, 2]]) / sigma)
        return np.concatenate(left)

    solution = solve(residuals, np.zeros(6), np.array(_STEPS), rounds=12)
    pose = moved(start, solution.parameters)
    off = [v.camera.project(corners @ pose[:3, :3].T + pose[:3, 3]) - v.marker.corners for v in views]
    return Estimate(pose, solution.covariance, float(np.sqrt(2 * np.mean(np.square(off)))))

"""The lens of one camera by pictures of the board, and where the camera then stands, with uncertainties. mm, pixels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.model.setup import Setup
from pico.vision.camera import CameraModel
from pico.vision.charuco import BoardView
from pico.vision.datums import SeenDatums, datum_corners
from pico.vision.least_squares import noise_by_group, solve
from pico.vision.rigid import motion, moved, rotation

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

LENS = 9
"""Numbers of a lens: fx, fy, cx, cy, k1, k2, p1, p2, k3."""
LENS_STEPS = (1e-2, 1e-2, 1e-2, 1e-2, 1e-5, 1e-5, 1e-6, 1e-6, 1e-5)
POSE_STEPS = (1e-2,) * 3 + (1e-5,) * 3  # mm, rad
CORNER_NOISE = 0.025
"""One standard deviation of a corner [pixels], until a fit shows the noise of each picture."""
FINEST = 0.002
"""No corner counts as seen better than this [pixels]."""
MISFIT = 1.0
"""Corners that are farther off than this at the end [pixels, root mean square] were not seen by one lens."""

LEAST = 6
"""Pictures of the board that a camera needs."""

EVERY = 4
"""Every so many pictures one is held out of the fit that is tried on it."""
LOOSER = 1.5
"""By how much the numbers of a lens are let go further than each is known alone: their errors go together."""


@dataclass(frozen=True, eq=False)
class FoundLens:
    """A camera with its lens, its pose as it was before."""

    camera: CameraModel
    sigmas: Array
    """One standard deviation of the nine numbers of the lens."""
    residual: float
    """What is left of the corners, root mean square [pixels]."""
    held_out: float
    """The same of pictures that a fit to the others did not use."""


@dataclass(frozen=True, eq=False)
class FoundPlace:
    """A camera where it stands."""

    camera: CameraModel
    sigmas: Array
    """One standard deviation of each number of its lens, of its place [mm] and its turn [rad]."""
    residual: float
    """What is left of the datums' corners, root mean square [pixels]."""
    position: float
    """One standard deviation of a position over the table that the camera sees [mm]."""


def lens(camera: CameraModel) -> Array:
    """Return the numbers of a camera's lens: fx, fy, cx, cy and its distortion."""
    import numpy as np

    k = camera.matrix
    return np.array([k[0, 0], k[1, 1], k[0, 2], k[1, 2], *camera.distortion])


def with_lens(camera: CameraModel, numbers: Array) -> CameraModel:
    """Return the camera with another lens."""
    import numpy as np

    fx, fy, cx, cy = numbers[:4]
    matrix: Any = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])
    return replace(camera, matrix=matrix, distortion=np.array(list(numbers[4:]), np.float64))


def intrinsics(views: Sequence[BoardView], camera: CameraModel) -> tuple[CameraModel, list[Array]]:
    """Return the camera with the lens that fits pictures of the board best (Zhang, PAMI 22, 1330 (2000)), and the pose
    (4, 4) of the board in the camera's frame for each. Starts from the lens that `camera` has."""
    import cv2
    import numpy as np

    points = [view.corners.astype(np.float32) for view in views]
    pixels = [view.pixels.astype(np.float32).reshape(-1, 1, 2) for view in views]
    start = camera.matrix.copy(), camera.distortion.copy()
    _, matrix, distortion, turns, shifts = cv2.calibrateCamera(
        points, pixels, camera.pixels, *start, flags=cv2.CALIB_USE_INTRINSIC_GUESS
    )
    poses = [motion(rotation(np.ravel(r)), np.ravel(t)) for r, t in zip(turns, shifts, strict=True)]
    numbers = np.asarray(np.ravel(distortion)[:5], np.float64)
    found = replace(camera, matrix=np.asarray(matrix, np.float64), distortion=numbers)
    return found, poses


def lens_of(views: Sequence[BoardView], start: CameraModel) -> FoundLens:
    """Return the lens of a camera by pictures of the board; raises PicoError if these are too few, or no lens explains
    them."""

    if len(views) < LEAST:
        text = f"camera `{start.name}` sees the board in {len(views)} pictures; {LEAST} is the least"
        hint = "show the board at more places and tilts, all of it in the picture"
        raise PicoError(error("calibration-board", text, hint=hint, address=start.name))
    camera, poses = intrinsics(views, start)
    left = _left(views, camera, poses)
    if not left < MISFIT:
        text = f"no lens explains what camera `{start.name}` saw: corners are {left:.3g} pixels off"
        hint = "show the board again, flat, printed to scale and all of it in the pictures"
        raise PicoError(error("calibration-fit", text, hint=hint, address=start.name))
    kept, out = _split(views)
    apart = held_out(out, intrinsics(kept, camera)[0]) if len(kept) >= LEAST and out else float("nan")
    return FoundLens(camera, _sigmas(views, camera, poses, left), left, apart)


def held_out(views: Sequence[BoardView], camera: CameraModel) -> float:
    """Return how far corners are from where a camera has them that was fitted without these pictures, root mean square
    [pixels]; where the board was is fitted to each."""
    return _left(views, camera, [_board_pose(view, camera) for view in views])


def _split(views: Sequence[BoardView]) -> tuple[list[BoardView], list[BoardView]]:
    kept = [view for i, view in enumerate(views) if i % EVERY != EVERY - 1]
    return kept, [view for i, view in enumerate(views) if i % EVERY == EVERY - 1]


def _board_pose(view: BoardView, camera: CameraModel) -> Array:
    """The pose (4, 4) of the board in the camera's frame."""
    import cv2
    import numpy as np

    _, turn, shift = cv2.solvePnP(view.corners, view.pixels, camera.matrix, camera.distortion)
    return motion(rotation(np.ravel(turn)), np.ravel(shift))


def _off(view: BoardView, camera: CameraModel, pose: Array) -> Array:
    import numpy as np

    alone = replace(camera, pose=np.eye(4))
    return alone.project(view.corners @ pose[:3, :3].T + pose[:3, 3]) - view.pixels


def _left(views: Sequence[BoardView], camera: CameraModel, poses: Sequence[Array]) -> float:
    import numpy as np

    off = np.concatenate([_off(view, camera, pose) for view, pose in zip(views, poses, strict=True)])
    return float(np.sqrt(np.mean(np.sum(off**2, axis=1))))


def _sigmas(views: Sequence[BoardView], camera: CameraModel, poses: Sequence[Array], left: float) -> Array:
    """One standard deviation of each number of the lens (9,), the poses of the board unknown: the Schur complement of
    the normal equations."""
    import numpy as np

    numbers, normal = lens(camera), np.zeros((LENS, LENS))
    for view, pose in zip(views, poses, strict=True):
        at = _off(view, camera, pose)
        of_lens = np.stack([(_off(view, with_lens(camera, numbers + step), pose) - at).ravel() / size
                            for step, size in zip(np.diag(LENS_STEPS), LENS_STEPS, strict=True)], axis=1)  # fmt: skip
        of_pose = np.stack([(_off(view, camera, moved(pose, step)) - at).ravel() / size
                            for step, size in zip(np.diag(POSE_STEPS), POSE_STEPS, strict=True)], axis=1)  # fmt: skip
        cross = of_lens.T @ of_pose
        normal += of_lens.T @ of_lens - cross @ np.linalg.pinv(of_pose.T @ of_pose) @ cross.T
    count = 2 * sum(len(view.corners) for view in views)
    variance = left**2 / 2 * count / max(1, count - LENS - 6 * len(views))  # of one coordinate of a corner
    return np.sqrt(np.maximum(np.diag(np.linalg.pinv(normal)), 0.0) * variance)


def place_of(setup: Setup, datums: SeenDatums, start: CameraModel, lens_sigmas: Array) -> FoundPlace:
    """Return where a camera stands that sees `datums`. Its lens is known to `lens_sigmas` (n,), and is fitted within
    these, so that the place is no more certain than the lens lets it be."""
    import numpy as np

    numbers, sure = lens(start), np.maximum(np.asarray(lens_sigmas, np.float64) * LOOSER, 1e-12)

    many, groups = len(numbers), np.zeros(2 * len(datums.corners), int)
    noise: Array = np.ones(1)

    def at(change: Array) -> CameraModel:
        return with_lens(replace(start, pose=moved(start.pose, change[many:])), numbers + change[:many] * sure)

    def off(change: Array) -> Array:
        return np.nan_to_num(at(change).project(datums.corners) - datums.pixels, nan=1e4)

    def residuals(change: Array) -> Array:
        return np.concatenate([datums.whitened(off(change)) / noise, change[:many]])

    steps = np.array((1e-2,) * many + POSE_STEPS)
    found = solve(residuals, np.zeros(many + 6), steps)
    noise = np.maximum(noise_by_group(found, noise, groups, np.zeros(1, int)), FINEST / CORNER_NOISE)
    found = solve(residuals, found.parameters, steps)
    left = float(np.sqrt(np.mean(np.sum(off(found.parameters) ** 2, axis=1))))
    sigmas = np.sqrt(np.maximum(np.diag(found.covariance), 0.0))
    camera, near = at(found.parameters), [at(found.parameters + step) for step in np.diag(steps)]
    position = unsure(setup, camera, near, steps, found.covariance)
    return FoundPlace(camera, np.concatenate([sigmas[:many] * sure, sigmas[many:]]), left, position)


def unsure(
    setup: Setup, camera: CameraModel, near: Sequence[CameraModel], steps: Array, covariance: Array
) -> float:  # fmt: skip
    """Return one standard deviation [mm] of a position over the table by a camera with numbers of a `covariance` (n,
    n): where the datums are, and as high above them as the highest marker of a part, the worse of both. From straight
    above, datums tell little of where a camera stands, which shows higher up.

    `near`: the camera with each of its numbers changed by its step (n,).
    """
    import numpy as np

    plates = [setup.type_of(name).geometry.marker for name in setup.lab.inventory]
    datums, worst = np.concatenate([datum_corners(datum) for datum in setup.lab.datums.values()]), 0.0
    for height in (0.0, max((plate.at[2] for plate in plates if plate), default=0.0)):
        points = datums + np.array((0.0, 0.0, height))
        there = camera.project(points)
        inside = np.isfinite(there).all(axis=1)
        columns = [(one.project(points) - there)[inside].ravel() / step for one, step in zip(near, steps, strict=True)]
        jacobian = np.stack(columns, axis=1)
        pixels = float(np.sqrt(np.einsum("ij,jk,ik->", jacobian, covariance, jacobian) / max(1, inside.sum())))
        distance = float(np.mean(np.linalg.norm(points - camera.pose[:3, 3], axis=1)))
        worst = max(worst, pixels * distance / float(camera.matrix[0, 0]))
    return worst


def unsure_above(
    points: Array,
    cameras: Sequence[CameraModel],
    near: Sequence[Sequence[CameraModel]],
    steps: Array,
    covariance: Array,
) -> float:
    """Return one standard deviation [mm], in each direction, of where several cameras see one of `points` (n, 3) [mm]
    together; `near`: each camera with each of its numbers changed by its step, `covariance`: of all their numbers."""
    import numpy as np

    pixels = [camera.project(points) for camera in cameras]
    columns = []
    for i, changed in enumerate(near):
        for one, step in zip(changed, steps, strict=True):
            columns.append((_met([*cameras[:i], one, *cameras[i + 1 :]], pixels) - points).ravel() / step)
    jacobian = np.stack(columns, axis=1)
    return float(np.sqrt(np.einsum("ij,jk,ik->", jacobian, covariance, jacobian) / points.size))


def _met(cameras: Sequence[CameraModel], pixels: Sequence[Array]) -> Array:
    """The points (n, 3) [mm] that are nearest to the rays behind `pixels` (n, 2) of each camera."""
    import numpy as np

    normal, right = np.zeros((len(pixels[0]), 3, 3)), np.zeros((len(pixels[0]), 3))
    for camera, seen in zip(cameras, pixels, strict=True):
        origin, ways = camera.rays(seen)
        across = np.eye(3) - ways[:, :, None] * ways[:, None, :]
        normal, right = normal + across, right + across @ origin
    return np.asarray(np.linalg.solve(normal, right[..., None])[..., 0], np.float64)


def board_in(views: Sequence[BoardView], cameras: Sequence[CameraModel]) -> tuple[Array, float]:
    """Return the pose (4, 4) on the table of a board that calibrated `cameras` see at one instant, each in one of
    `views`, and what is left of its corners, root mean square [pixels]."""
    import numpy as np

    first = max(range(len(views)), key=lambda i: len(views[i].corners))
    start = cameras[first].pose @ _board_pose(views[first], replace(cameras[first], pose=np.eye(4)))

    def off(change: Array) -> Array:
        pose = moved(start, change)
        seen = [camera.project(view.corners @ pose[:3, :3].T + pose[:3, 3]) - view.pixels
                for view, camera in zip(views, cameras, strict=True)]  # fmt: skip
        return np.nan_to_num(np.concatenate(seen), nan=1e3).ravel()

    found = solve(off, np.zeros(6), np.array(POSE_STEPS))
    return moved(start, found.parameters), found.rms * 2**0.5

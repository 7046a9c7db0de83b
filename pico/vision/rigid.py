"""Rigid motions in space as (4, 4) matrices, mm and rad, and the one that fits points best."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from pico.model.pose import Pose, wrap

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def rotation(vector: Array) -> Array:
    """Return the rotation (3, 3) about `vector` (3,) by its length [rad] (Rodrigues' formula)."""
    import numpy as np

    x, y, z = (float(v) for v in vector)
    angle = math.sqrt(x * x + y * y + z * z)
    s, c = (math.sin(angle) / angle, (1 - math.cos(angle)) / angle**2) if angle > 1e-9 else (1.0, 0.5)
    return np.array((
        (1 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y),
        (c * x * y + s * z, 1 - c * (x * x + z * z), c * y * z - s * x),
        (c * x * z - s * y, c * y * z + s * x, 1 - c * (x * x + y * y)),
    ))  # fmt: skip


def rotation_vector(matrix: Array) -> Array:
    """Return the vector (3,) about which `matrix` (3, 3) turns, as long as the angle [rad]."""
    import cv2
    import numpy as np

    turn = np.asarray(matrix, np.float64)
    sine = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / 2
    if float(np.linalg.norm(sine)) < 1e-4 and np.trace(turn) > 0:
        return sine  # OpenCV has no turn at all for the smallest ones
    vector, _ = cv2.Rodrigues(turn)
    return np.asarray(vector, np.float64).ravel()


def motion(turn: Array, shift: Array) -> Array:
    """Return the motion (4, 4) that turns by the rotation `turn` (3, 3), then shifts by `shift` (3,) [mm]."""
    import numpy as np

    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, shift
    return matrix


def moved(pose: Array, change: Array) -> Array:
    """Return `pose` (4, 4) shifted by change[:3] [mm] and turned in place by change[3:] [rad], axes of the frame."""
    return motion(rotation(change[3:]) @ pose[:3, :3], pose[:3, 3] + change[:3])


def apart(a: Array, b: Array) -> tuple[float, float]:
    """Return how far two poses (4, 4) are apart: distance of the origins [mm], and angle [deg]."""
    import numpy as np

    turned = rotation_vector(a[:3, :3].T @ b[:3, :3])
    return float(np.linalg.norm(a[:3, 3] - b[:3, 3])), math.degrees(float(np.linalg.norm(turned)))


def best_motion(points: Array, seen: Array) -> Array:
    """Return the motion (4, 4) that brings `points` (n, 3) closest to `seen` (n, 3) [mm].

    W. Kabsch, Acta Cryst. A32, 922 (1976).
    """
    import numpy as np

    a, b = points.mean(axis=0), seen.mean(axis=0)
    u, _, vt = np.linalg.svd((seen - b).T @ (points - a))
    turn = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    return motion(turn, b - turn @ a)


def square(size: float) -> Array:
    """Return the corners (4, 3) [mm] of a marker with edges of `size`, in its own frame and in the order of `Marker`:
    clockwise seen from above, from the upper left."""
    import numpy as np

    half = size / 2
    return np.array([(-half, half, 0), (half, half, 0), (half, -half, 0), (-half, -half, 0)])


def upright(pose: Pose, z: float) -> Array:
    """Return the pose (4, 4) of something that stands upright at `pose`, `z` [mm] above the table."""
    import numpy as np

    return motion(rotation(np.array([0, 0, math.radians(pose.yaw)])), np.array([pose.x, pose.y, z]))


def planar(matrix: Array) -> Pose:
    """Return where a pose (4, 4) is seen from above."""
    yaw = math.degrees(math.atan2(matrix[1, 0], matrix[0, 0]))
    return Pose(float(matrix[0, 3]), float(matrix[1, 3]), wrap(yaw))


def tilt(matrix: Array) -> float:
    """Return the angle between the z axis of a pose (4, 4) and the vertical [deg]."""
    return math.degrees(math.acos(max(-1.0, min(1.0, float(matrix[2, 2])))))

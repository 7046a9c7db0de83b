"""A calibrated camera: where a point of the table is seen, and the ray behind a pixel. mm and pixels."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CameraModel:
    """Intrinsics and extrinsics of a camera.

    `pixels`: width and height. `matrix` (3, 3): focal lengths and principal point [pixels]; the center of the first
    pixel is (0, 0), so that an ideal camera has its principal point at ((w - 1) / 2, (h - 1) / 2). `distortion` (5,):
    k1, k2, p1, p2, k3 (Brown-Conrady, as OpenCV has them); (8,): k4, k5, k6, too (its rational model); (4,): k1 to k4
    of a `fisheye` lens (J. Kannala and S. Brandt, PAMI 28, 1335 (2006)). `pose` (4, 4): of the camera in its `parent`
    [mm], x right, y down, z into the scene; the parent is the table, or for an eye in the hand the tool (the robot's
    name in `robot`).
    """

    name: str
    pixels: tuple[int, int]
    matrix: Array
    distortion: Array
    pose: Array
    robot: str | None = None
    depth: bool = field(default=False)
    fisheye: bool = False

    def placed(self, parent: Array) -> CameraModel:
        """Return the camera in the frame in which its parent has the pose `parent` (4, 4) [mm]."""
        from dataclasses import replace

        return replace(self, pose=parent @ self.pose, robot=None)

    def project(self, points: Array) -> Array:
        """Return the pixels (n, 2) at which `points` (n, 3) [mm] of the parent's frame appear; NaN behind it."""
        import cv2
        import numpy as np

        local = (points - self.pose[:3, 3]) @ self.pose[:3, :3]
        project = cv2.fisheye.projectPoints if self.fisheye else cv2.projectPoints
        seen, _ = project(local.reshape(-1, 1, 3), np.zeros(3), np.zeros(3), self.matrix, self.distortion)
        pixels = np.asarray(seen, np.float64).reshape(-1, 2)
        pixels[local[:, 2] <= 0] = np.nan
        return pixels

    def rays(self, pixels: Array) -> tuple[Array, Array]:
        """Return origin (3,) [mm] and directions (n, 3) of the rays behind `pixels` (n, 2), in the parent's frame."""
        import cv2
        import numpy as np

        undistort = cv2.fisheye.undistortPoints if self.fisheye else cv2.undistortPoints
        flat = undistort(np.asarray(pixels, np.float64).reshape(-1, 1, 2), self.matrix, self.distortion)
        directions = np.column_stack((np.asarray(flat).reshape(-1, 2), np.ones(len(pixels)))) @ self.pose[:3, :3].T
        return self.pose[:3, 3].copy(), directions / np.linalg.norm(directions, axis=1, keepdims=True)

"""A pinhole camera: pixels to rays, points to pixels, and where to stand so that everything is in the picture.

Pixel (0, 0) is the center of the upper left one; u runs right, v down. Metres, table frame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Viewpoint:
    """A camera at `eye`; the rows of `axes` (3, 3) are right, up and forward; `focal` in pixels.

    `offset`: where the upper left pixel of this picture is in the whole picture that it was cut out of, and `whole` how
    wide and high that is; without them it is whole itself.
    """

    eye: Array
    axes: Array
    focal: float
    width: int
    height: int
    offset: tuple[int, int] = (0, 0)
    whole: tuple[int, int] | None = None

    @property
    def middle(self) -> tuple[float, float]:
        """The pixel (u, v) that the camera looks along."""
        width, height = self.whole or (self.width, self.height)
        return (width - 1) / 2 - self.offset[0], (height - 1) / 2 - self.offset[1]

    def cut(self, left: int, top: int, right: int, bottom: int) -> Viewpoint:
        """Return the camera that sees only the pixels from (left, top) up to before (right, bottom)."""
        whole = self.whole or (self.width, self.height)
        at = (self.offset[0] + left, self.offset[1] + top)
        return replace(self, width=right - left, height=bottom - top, offset=at, whole=whole)

    def rays(self, u: Array, v: Array) -> Array:
        """Return the unit directions (n, 3) through the pixels `u`, `v` (n,)."""
        import numpy as np

        x, y = (u - self.middle[0]) / self.focal, (self.middle[1] - v) / self.focal
        directions: Array = x[:, None] * self.axes[0] + y[:, None] * self.axes[1] + self.axes[2]
        lengths: Array = np.sqrt(np.einsum("ij,ij->i", directions, directions))
        return directions / lengths[:, None]

    def project(self, points: Array) -> Array:
        """Return u, v [pixels] and the depth [m] along the optical axis of `points` (n, 3), as (n, 3)."""
        import numpy as np

        right, up, depth = ((points - self.eye) @ self.axes.T).T
        u = self.middle[0] + self.focal * right / depth
        return np.column_stack((u, self.middle[1] - self.focal * up / depth, depth))


def look(eye: Array, target: Array, field_of_view: float, width: int, height: int) -> Viewpoint:
    """Return the camera at `eye` that looks at `target` [m], upright; `field_of_view` is vertical [deg]."""
    import numpy as np

    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    focal = height / 2 / math.tan(math.radians(field_of_view) / 2)
    return Viewpoint(eye, np.array((right, np.cross(right, forward), forward)), focal, width, height)


def framing(
    points: Array, azimuth: float, elevation: float, field_of_view: float, width: int, height: int, margin: float = 0.05
) -> Viewpoint:
    """Return the camera that sees all `points` (n, 3) as large as the picture allows.

    It stands in the direction `azimuth` (from x, counter-clockwise), `elevation` [deg] as seen from the points;
    `margin` is left free on each side, as a share of the picture.
    """
    import numpy as np

    a, e = math.radians(azimuth), math.radians(elevation)
    towards = np.array((math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)))
    target, distance = points.mean(axis=0), 10.0
    for _ in range(12):  # alternately center and approach; it converges as perspective changes little
        view = look(target + distance * towards, target, field_of_view, width, height)
        u, v, depth = view.project(points).T
        low, high = np.array((u.min(), v.min())), np.array((u.max(), v.max()))
        offset = (low + high) / 2 - np.array(((width - 1) / 2, (height - 1) / 2))
        scale = np.average(depth) / view.focal
        target = target + scale * (offset[0] * view.axes[0] - offset[1] * view.axes[1])
        fill = max((high - low) / np.array((width, height))) / (1 - 2 * margin)
        distance *= float(fill)
    return look(target + distance * towards, target, field_of_view, width, height)


def trimmed(view: Viewpoint, points: Array, margin: float) -> Viewpoint:
    """Return the camera without what is above and below `points` (n, 3) but a margin, a share of the width."""
    v, spare = view.project(points)[:, 1], margin * view.width
    return view.cut(0, max(0, int(v.min() - spare)), view.width, min(view.height, int(v.max() + spare) + 1))

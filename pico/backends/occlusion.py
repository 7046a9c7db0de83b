"""What hides a place from the cameras, as far as one knows what stands there: arms, parts, edges of the pictures."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.types import Joints
from pico.vision.rigid import square, upright

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.camera import CameraModel

    Array = NDArray[np.float64]

_OWN = 2.0  # mm that a ray may end short of the marker and still have reached it


class Occluders:
    """The bench as it was just seen: components at `places`, arms at `joints`, `cameras` over the table."""

    def __init__(
        self,
        setup: Setup,
        places: Mapping[str, Pose],
        joints: Mapping[str, Joints],
        cameras: Mapping[str, CameraModel],
        dark: Collection[str] = (),
    ) -> None:
        self._setup, self._places, self._joints = setup, places, joints
        self._cameras = [c for name, c in sorted(cameras.items()) if c.robot is None and name not in dark]

    def hides(self, name: str, pose: Pose) -> str | None:
        """Return what hides the marker of component `name` if it stands at `pose`: a robot, a component, or the edge of
        the pictures; None where a camera has the whole of it in plain view."""
        import numpy as np

        plate = self._setup.type_of(name).geometry.marker
        if plate is None:
            return None
        at = upright(pose, 0.0)
        grid = np.concatenate([square(plate.size) * share for share in (1.15, 0.6, 0.0)]) + plate.at
        points = grid @ at[:3, :3].T + at[:3, 3]
        found = [self._between(camera, points) for camera in self._cameras]
        return None if None in found else next((f for f in found if f), "nothing known")

    def _between(self, camera: CameraModel, points: Array) -> str | None:
        import numpy as np

        pixels = camera.project(points)
        width, height = camera.pixels
        if not (np.isfinite(pixels).all() and (pixels > 0).all() and (pixels < (width - 1, height - 1)).all()):
            return "the edge of the pictures"
        from pico.twin.raycast import cast

        model, data = self._scene
        origin = camera.pose[:3, 3]
        ways = points - origin
        far = np.linalg.norm(ways, axis=1)
        hits = cast(model, data, origin / 1000, ways / far[:, None], (1, 2))
        before = hits.geom[hits.distance * 1000 < far - _OWN]
        return self._owner(model, int(before[0])) if len(before) else None

    @cached_property
    def _scene(self) -> tuple[Any, Any]:
        from pico.drawing.picture import posed_model
        from pico.twin.placement import upright as standing

        return posed_model(self._setup, {n: standing(p) for n, p in self._places.items()}, self._joints)

    @staticmethod
    def _owner(model: Any, geom: int) -> str:
        name = str(model.body(int(model.geom_bodyid[geom])).name)
        return name.partition("/")[0] if name != "world" else "the table"

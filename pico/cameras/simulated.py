"""The cameras of the simulated bench: pictures and depth as they would be delivered, noise and all.

`Eyes` is made once for a scene and then takes pictures of it as it moves. Pixels; millimetres; gray levels of 255.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pico.cameras.bad_light import lit_badly
from pico.cameras.board import Sheet, draw_sheet
from pico.cameras.errors import true_cameras
from pico.cameras.markers import draw_markers
from pico.cameras.stickers import Sticker, stickers
from pico.cameras.view import CameraView, photograph, table_paint
from pico.model.setup import Setup
from pico.model.simulated import SimErrors
from pico.vision.camera import CameraModel
from pico.vision.frame import Frame, Region

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    from pico.cameras.egl import OpenGL

    Array = NDArray[np.float64]
    Gray = NDArray[np.float32]

_DARK = 3.0
"""Mean gray level of a frame in which nothing was exposed."""


class Eyes:
    """Cameras that look at a scene. `cameras`: as they really are; with the lab's errors by `seed` where None.

    `markers`: what bodies carry instead of what the inventory says (None: nothing); `extra`: markers besides.
    `renderer`: what draws, the lab's where None; raises PicoError for `egl` where there is none. The same seed and the
    same calls give the same pictures.
    """

    def __init__(
        self,
        setup: Setup,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        cameras: Mapping[str, CameraModel] | None = None,
        *,
        errors: SimErrors | None = None,
        seed: int | None = None,
        markers: Mapping[str, int | None] | None = None,
        extra: Sequence[Sticker] = (),
        renderer: str | None = None,
    ) -> None:
        import numpy as np

        self.setup, self.model, self.data = setup, model, data
        self.errors = setup.lab.sim.errors if errors is None else errors
        seed = setup.lab.sim.seed if seed is None else seed
        self.cameras = dict(true_cameras(setup, self.errors, seed) if cameras is None else cameras)
        self._seed, self._random = seed, np.random.default_rng((seed, 1))
        heights = np.random.default_rng((seed, 2))
        plain = (*stickers(setup, model, markers), *extra)
        sigma = self.errors.marker_height
        self.stickers = tuple(s.raised(float(heights.normal(0.0, sigma))) if sigma else s for s in plain)
        self._opengl: OpenGL | None = None
        if (renderer or setup.lab.sim.renderer) == "egl":
            from pico.cameras.egl import OpenGL

            largest = max(n for camera in self.cameras.values() for n in camera.pixels)
            self._opengl = OpenGL(model, self.stickers, largest)

    def placed(self, name: str) -> CameraModel:
        """Return a camera as it really is and stands now, in the table's frame. Raises KeyError."""
        camera = self.cameras[name]
        return camera if camera.robot is None else camera.placed(tool_pose(self.model, self.data, camera.robot))

    def light(self, name: str) -> Gray:
        """Return what light brings to the whole sensor of the camera `name` now, see `frame`. Raises KeyError."""
        return self._exposed(self._view(name, None))

    def frame(
        self, name: str, region: Region | None = None, *, light: Gray | None = None, sheets: Sequence[Sheet] = ()
    ) -> Frame:
        """Return what the camera `name` delivers now, of the whole sensor or of a `region` of it. Raises KeyError.

        A region is clipped to the sensor. A lost frame is black. `light`: what `light` returned of the same scene, to
        be taken again; `sheets`: prints that somebody holds before the camera, of a whole sensor alone.
        """
        import cv2
        import numpy as np

        view = self._view(name, region)
        _, _, width, height = view.region
        settings = self.setup.lab.cameras[name]
        picture: Any
        if self._random.random() < self.errors.lost_frames:
            picture = np.full((height, width), _DARK, np.float32)
        else:
            picture = self._exposed(view) if light is None else light.copy()
            for sheet in sheets:
                draw_sheet(picture, view.camera, sheet)
            blur = settings.blur
            if bad := self.errors.light:
                picture, blur = lit_badly(picture, view, bad, self._seed), math.hypot(blur, bad.defocus)
            if blur > 0:
                picture = cv2.GaussianBlur(picture, (0, 0), blur)
        noise = self._noise(picture.shape, settings.noise * self.errors.noise)
        gray: Any = cv2.add(picture, noise, dtype=cv2.CV_8U)
        return Frame(gray, view.region[:2], name, float(self.data.time))

    def depth(self, name: str, region: Region | None = None) -> Gray:
        """Return the depth along the optical axis (h, w) [mm] that the camera `name` measures, NaN out of its range.

        Raises KeyError for no such camera, ValueError for one that measures no depth.
        """
        from pico.cameras.depth import measure

        sensor = self.setup.lab.cameras[name].depth
        if sensor is None:
            raise ValueError(f"{name} measures no depth")
        exact = measure(self._view(name, region), sensor.range)
        return exact * (1 + self._noise(exact.shape, sensor.noise * self.errors.noise))

    def _exposed(self, view: CameraView) -> Gray:
        """What light brings to the sensor, before lens and noise."""
        if self._opengl is not None:
            return self._opengl.photograph(view)
        picture = photograph(view, table_paint(self.setup))
        draw_markers(view, picture, self.stickers)
        return picture

    def _view(self, name: str, region: Region | None) -> CameraView:
        camera = self.placed(name)
        return CameraView(self.model, self.data, camera, clipped(region, camera.pixels))

    def _noise(self, shape: Any, sigma: float) -> Gray:
        import numpy as np

        if sigma <= 0:
            return np.zeros(shape, np.float32)
        noise: Gray = self._random.standard_normal(shape, np.float32)
        noise *= np.float32(sigma)
        return noise


def clipped(region: Region | None, pixels: tuple[int, int]) -> Region:
    """Return the part of `region` that a sensor of `pixels` (width, height) has; the whole sensor for None.

    Raises ValueError where nothing is left.
    """
    if region is None:
        return 0, 0, *pixels
    u, v = max(0, region[0]), max(0, region[1])
    right, bottom = min(pixels[0], region[0] + region[2]), min(pixels[1], region[1] + region[3])
    if right <= u or bottom <= v:
        raise ValueError(f"the region {region} is off a sensor of {pixels[0]} x {pixels[1]} pixels")
    return u, v, right - u, bottom - v


def tool_pose(model: mujoco.MjModel, data: mujoco.MjData, robot: str) -> Array:
    """Return the pose (4, 4) of the tool of `robot` in the table's frame [mm]; raises KeyError for one without arm."""
    import numpy as np

    site = model.site(f"{robot}/tcp").id
    pose = np.eye(4)
    pose[:3, :3] = data.site_xmat[site].reshape(3, 3)
    pose[:3, 3] = data.site_xpos[site] * 1000
    return pose

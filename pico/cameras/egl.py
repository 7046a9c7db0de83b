"""The pictures of simulated cameras drawn by OpenGL through EGL, where a machine has it. Metres; gray levels of 255.

The scene is copied into a model of its own in which markers are textured plates, so that nothing is added to the
physics. OpenGL knows no lens distortion: a picture without it is drawn, wide enough, and then bent.
"""

from __future__ import annotations

import atexit
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.cameras.markers import pose_in_table
from pico.cameras.stickers import MODULES, QUIET, Sticker, paper
from pico.cameras.view import CameraView
from pico.diagnostics import PicoError, error
from pico.twin.scene import OPAQUE_GROUP

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Gray = NDArray[np.float32]

_SEEN = (OPAQUE_GROUP, 2)  # bodies and arms
_TEXELS = 16  # a module of a marker
_ABOVE = 5e-6  # m, that a paper lies above its plate, so that one of the two is in front
_THICK = 2e-5  # m, half of a paper
_WIDER = 1.2  # how much larger a picture without distortion may be than the sensor
_RIM = 4  # pixels around a region, for bending it
_NEAR, _FAR = 0.03, 8.0  # m


@dataclass(frozen=True, eq=False)
class _Frustum:
    """A picture without distortion: its upper left and its size [pixels], as the camera's matrix has them."""

    left: float
    top: float
    width: int
    height: int


class OpenGL:
    """Draws the scene of `model` with `stickers` on it, for sensors of at most `pixels` along an edge.

    Raises PicoError where there is no EGL.
    """

    def __init__(self, model: mujoco.MjModel, stickers: Sequence[Sticker], pixels: int) -> None:
        import mujoco
        import numpy as np

        self._stickers = tuple(stickers)
        self._geoms = np.flatnonzero(np.isin(model.geom_group, _SEEN))
        self._largest = int(_WIDER * pixels)
        self._model = _copied(model, self._geoms, self._stickers, self._largest).compile()
        self._data = mujoco.MjData(self._model)
        self._context = _context()
        self._drawing = mujoco.MjrContext(self._model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._drawing)
        self._scene = mujoco.MjvScene(self._model, maxgeom=self._model.ngeom + 10)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
        self._scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0
        atexit.register(self.close)

    def close(self) -> None:
        """Give the context back."""
        if self._context is not None:
            self._drawing.free()
            self._context.free()
            self._context = None

    def photograph(self, view: CameraView) -> Gray:
        """Return the gray levels (h, w) of the view's region, markers included."""
        import cv2

        self._arrange(view)
        maps, frustum = _bent(view, self._largest)
        flat = self._draw(view, frustum)
        bent: Any = cv2.remap(flat, *maps, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
        return bent  # type: ignore[no-any-return]

    def _arrange(self, view: CameraView) -> None:
        """Bring the copies to where the bodies and their papers are now."""
        count = len(self._geoms)
        self._data.geom_xpos[:count] = view.data.geom_xpos[self._geoms]
        self._data.geom_xmat[:count] = view.data.geom_xmat[self._geoms]
        for number, sticker in enumerate(self._stickers, count):
            _, pose = pose_in_table(view, sticker)
            self._data.geom_xmat[number] = pose[:3, :3].reshape(-1)
            self._data.geom_xpos[number] = pose[:3, 3] / 1000 + (_ABOVE - _THICK) * pose[:3, 2]

    def _draw(self, view: CameraView, frustum: _Frustum) -> Gray:
        import mujoco
        import numpy as np

        self._context.make_current()
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(
            self._model, self._data, mujoco.MjvOption(), None, mujoco.MjvCamera(), everything, self._scene
        )
        for camera in self._scene.camera:
            _aim(camera, view, frustum)
        rectangle = mujoco.MjrRect(0, 0, frustum.width, frustum.height)
        mujoco.mjr_render(rectangle, self._scene, self._drawing)
        color = np.empty((frustum.height, frustum.width, 3), np.uint8)
        mujoco.mjr_readPixels(color, None, rectangle, self._drawing)
        return (color[::-1] @ np.array((0.299, 0.587, 0.114), np.float32)).astype(np.float32)


def _context() -> Any:
    try:
        from mujoco.egl import GLContext

        context = GLContext(64, 64)  # what is drawn goes to MuJoCo's own buffer
        context.make_current()
    except Exception as exc:  # PyOpenGL raises AttributeError where the library is missing
        text = "this machine has no EGL, which the renderer `egl` draws with"
        hint = "set `sim: {renderer: raycast}` in the lab, or install it (Debian: libegl1 and libgl1-mesa-dri)"
        raise PicoError(error("no-opengl", text, hint=hint)) from exc
    return context


def _copied(model: mujoco.MjModel, geoms: Any, stickers: Sequence[Sticker], pixels: int) -> mujoco.MjSpec:
    """A scene of which every shape stands by itself, the papers behind the others."""
    import mujoco

    spec = mujoco.MjSpec()
    visual = spec.visual
    visual.global_.offwidth = visual.global_.offheight = pixels
    visual.quality.offsamples = 4
    visual.headlight.ambient, visual.headlight.diffuse = [0.6] * 3, [0.35] * 3
    visual.headlight.specular = [0.0] * 3
    spec.compiler.degree = False
    for geom in geoms:
        _copy(spec, model, int(geom))
    for number, sticker in enumerate(stickers):
        _add_paper(spec, number, sticker)
    return spec


def _copy(spec: Any, model: mujoco.MjModel, geom: int) -> None:
    import mujoco
    import numpy as np

    kind, size = int(model.geom_type[geom]), list(model.geom_size[geom])
    options = {"rgba": list(model.geom_rgba[geom]), "contype": 0, "conaffinity": 0}
    if kind != mujoco.mjtGeom.mjGEOM_MESH:
        spec.worldbody.add_geom(type=mujoco.mjtGeom(kind), size=size, **options)
        return
    mesh = int(model.geom_dataid[geom])
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    corners = np.asarray(model.mesh_vert[first : first + count], np.float64)
    spec.add_mesh(name=f"mesh{geom}", uservert=corners.reshape(-1).tolist())
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=f"mesh{geom}", **options)


def _add_paper(spec: Any, number: int, sticker: Sticker) -> None:
    import mujoco
    import numpy as np

    print_ = paper(sticker.marker, _TEXELS)[1:-1, 1:-1, 0]
    side = (MODULES + 2 * QUIET) * _TEXELS
    pixels = np.repeat(np.rint(print_ * 255).astype(np.uint8)[:, :, None], 3, axis=2)
    texture = spec.add_texture(
        name=f"paper{number}", type=mujoco.mjtTexture.mjTEXTURE_2D, width=side, height=side, nchannel=3
    )
    texture.data = pixels.tobytes()
    material = spec.add_material(name=f"paper{number}")
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = f"paper{number}"
    half = sticker.edge / 2000
    box = mujoco.mjtGeom.mjGEOM_BOX
    spec.worldbody.add_geom(type=box, size=[half, half, _THICK], material=f"paper{number}", contype=0, conaffinity=0)


def _aim(camera: Any, view: CameraView, frustum: _Frustum) -> None:
    """Let a camera of OpenGL see what the pixels of `frustum` see. The edge of a picture is half a pixel out."""
    matrix, pose = view.camera.matrix, view.camera.pose
    focal, cx, cy = matrix[0, 0], matrix[0, 2], matrix[1, 2]
    camera.pos[:] = pose[:3, 3] / 1000
    camera.forward[:], camera.up[:] = pose[:3, 2], -pose[:3, 1]
    scale = _NEAR / focal
    camera.frustum_near, camera.frustum_far = _NEAR, _FAR
    camera.frustum_center = (frustum.left - 0.5 + frustum.width / 2 - cx) * scale
    camera.frustum_width = frustum.width / 2 * scale
    camera.frustum_top = (cy - frustum.top + 0.5) * scale
    camera.frustum_bottom = (cy - frustum.top + 0.5 - frustum.height) * scale


def _bent(view: CameraView, largest: int) -> tuple[tuple[Gray, Gray], _Frustum]:
    """Where in a picture without distortion each pixel of the region lies, and how large that picture is."""
    import numpy as np

    u, v, width, height = view.region
    columns, rows = np.meshgrid(u + np.arange(width), v + np.arange(height))
    rays = view.rays(columns.reshape(-1).astype(np.float64), rows.reshape(-1).astype(np.float64))
    matrix = view.camera.matrix
    x = rays[:, 0] * matrix[0, 0] + matrix[0, 2]
    y = rays[:, 1] * matrix[1, 1] + matrix[1, 2]
    left, top = np.floor((x.min(), y.min())) - _RIM
    across, down = int(np.ceil(x.max()) + _RIM + 1 - left), int(np.ceil(y.max()) + _RIM + 1 - top)
    frustum = _Frustum(float(left), float(top), min(across, largest), min(down, largest))
    maps = [np.ascontiguousarray((a - b).reshape(rows.shape), np.float32) for a, b in ((x, left), (y, top))]
    return (maps[0], maps[1]), frustum

"""MuJoCo, imported for the first time, and a component's geometry as its shapes. Nothing of PICO needs OpenGL, but
MuJoCo looks for it where the environment names a way to it (`MUJOCO_GL`), and fails with whatever error its search
ends in."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.body import Body
from pico.model.catalog import Geometry

if TYPE_CHECKING:
    import mujoco

_ALONG = {"x": (math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0), "y": (math.sqrt(0.5), -math.sqrt(0.5), 0.0, 0.0)}
_PACKAGES = {"egl": "libegl1 and libgl1-mesa-dri", "osmesa": "libosmesa6"}
"""Debian packages that bring what a value of `MUJOCO_GL` needs."""


def require_mujoco() -> None:
    """Import MuJoCo; call it before the first model is built. Raises PicoError where `MUJOCO_GL` keeps it from it."""
    try:
        import mujoco  # noqa: F401
    except Exception as exc:  # OpenGL's own errors: AttributeError where a library is missing
        asked = os.environ.get("MUJOCO_GL", "")
        if not asked or (isinstance(exc, ImportError) and "mujoco" in str(exc.name or "")):
            raise
        raise PicoError(no_gl(asked)) from exc


def no_gl(asked: str) -> Diagnostic:
    """Return the diagnostic of an environment that asks for OpenGL in a way that this machine does not have."""
    packages = _PACKAGES.get(asked.lower())
    text = f"MUJOCO_GL is `{asked}`, and this machine has no OpenGL of that kind"
    other = f", or install it (Debian: {packages})" if packages else ""
    hint = f"`unset MUJOCO_GL`: PICO draws without OpenGL{other}"
    return error("no-opengl", text, hint=hint)


def add_solids(spec: mujoco.MjSpec, body: Any, geometry: Geometry, **properties: Any) -> None:
    """Add the shapes of `geometry` to `body`, whose origin is the component's (z = 0 on the table), in metres.

    `properties` are set on every geom. A footprint that is a polygon without bodies becomes a convex mesh.
    """
    import mujoco

    for part in geometry.bodies:
        kind = mujoco.mjtGeom.mjGEOM_BOX if part.shape == "box" else mujoco.mjtGeom.mjGEOM_CYLINDER
        body.add_geom(type=kind, size=_half(part), pos=_metres(part.at), quat=_quat(part), **properties)
    if not geometry.bodies:
        _add_extruded(spec, body, geometry, properties)


def _add_extruded(spec: Any, body: Any, geometry: Geometry, properties: dict[str, Any]) -> None:
    import mujoco

    footprint, height = geometry.footprint, geometry.height / 1000
    middle = [0.0, 0.0, height / 2]
    if footprint.disc is not None:
        size = [footprint.disc / 1000, height / 2, 0]
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=size, pos=middle, **properties)
    elif footprint.box is not None:
        size = [footprint.box[0] / 2000, footprint.box[1] / 2000, height / 2]
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=size, pos=middle, **properties)
    else:
        name = f"{body.name}_outline"
        corners = [(x / 1000, y / 1000, z) for z in (0.0, height) for x, y in footprint.vertices]
        spec.add_mesh(name=name, uservert=[value for corner in corners for value in corner])
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, **properties)


def _half(part: Body) -> list[float]:
    if part.shape == "box":
        return [v / 2000 for v in part.size]
    return [part.size[0] / 2000, part.size[1] / 2000, 0.0]


def _metres(point: tuple[float, float, float]) -> list[float]:
    return [v / 1000 for v in point]


def _quat(part: Body) -> list[float]:
    """The quaternion (w, x, y, z) of the part's yaw after a cylinder's z axis was laid along `axis`."""
    half = math.radians(part.yaw) / 2
    c, s = math.cos(half), math.sin(half)
    w, x, y, z = _ALONG.get(part.axis, (1.0, 0.0, 0.0, 0.0)) if part.shape == "cylinder" else (1.0, 0.0, 0.0, 0.0)
    return [c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w]

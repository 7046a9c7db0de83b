"""The bench as a camera sees it: rays, light and shadow, smooth edges. No OpenGL."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.drawing.lighting import KEY, key_points, share_seen, sky_points
from pico.twin.raycast import FAR, Hits, cast, visible
from pico.twin.scene import CLEAR_GROUP, OPAQUE_GROUP, TABLE_THICKNESS
from pico.twin.surfaces import Surfaces, linear

if TYPE_CHECKING:
    import mujoco
    import numpy as np
    from numpy.typing import NDArray

    from pico.drawing.viewpoint import Viewpoint

    Array = NDArray[np.float64]

_SOLID = (OPAQUE_GROUP, 2)  # 2: arms
FOOT = 0.06
"""How high the table stands above the floor [m]."""
FLOOR = -TABLE_THICKNESS - FOOT
_PAPER = (0.925, 0.937, 0.950)  # the floor and, far away, what is behind everything
_PAPER_FROM, _PAPER_OVER = (
    1.0,
    0.8,
)  # from where on, and over what stretch, the floor fades; half diagonals of the table
_KEY_LIGHT, _SKY_LIGHT, _BOUNCE = 0.62, 0.60, 0.16
_SUBPIXELS = ((-0.125, -0.375), (0.375, -0.125), (0.125, 0.375), (-0.375, 0.125))
_EDGE = 10.0  # difference of neighboring pixels, of 255, from which on a pixel is looked at more closely
_GLOSS, _SHINE = 0.10, 40.0


@dataclass(frozen=True, eq=False)
class Beam:
    """A stretch of visible light from `start` to `end` (3,) [m]."""

    start: Array
    end: Array


@dataclass(frozen=True, eq=False)
class Stage:
    """What is photographed: the scene, its paint, beams, and the middle of it all (3,)."""

    model: mujoco.MjModel
    data: mujoco.MjData
    paint: Surfaces
    beams: tuple[Beam, ...]
    middle: Array


@dataclass(frozen=True, eq=False)
class Exposure:
    """What the pixels of the first pass saw: (h, w) each, vectors (h, w, 3)."""

    point: Array
    normal: Array
    geom: NDArray[np.int32]
    key: Array
    sky: Array


def photograph(stage: Stage, view: Viewpoint) -> NDArray[np.uint8]:
    """Return the picture (h, w, 3) that `view` takes of `stage`, in sRGB."""
    import numpy as np

    h, w = view.height, view.width
    v, u = (a.reshape(-1).astype(float) for a in np.mgrid[0:h, 0:w])
    rays = view.rays(u, v)
    hits = _see(stage, view, rays)
    exposure = _expose(stage, hits, (h, w))
    light = exposure.key.reshape(-1), exposure.sky.reshape(-1)
    picture = _develop(_color(stage, view, hits, rays, *light)).reshape(h, w, 3)
    smooth = (exposure.geom < 0) | (exposure.geom == stage.model.geom("table").id)
    edge = _edges(picture, exposure.geom, smooth)
    picture[edge] = _closer(stage, view, exposure, *np.nonzero(edge))
    return np.clip(np.round(picture), 0, 255).astype(np.uint8)


def _see(stage: Stage, view: Viewpoint, rays: Array) -> Hits:
    """What rays hit first; those that miss everything end on the floor, as geom -1."""
    import numpy as np

    hits = cast(stage.model, stage.data, view.eye, rays, _SOLID)
    missed = (hits.geom < 0) & (rays[:, 2] < -1e-3)
    hits.distance[missed] = np.minimum((FLOOR - view.eye[2]) / rays[missed, 2], FAR)
    hits.point[missed] = view.eye + hits.distance[missed, None] * rays[missed]
    hits.normal[missed] = (0.0, 0.0, 1.0)
    return hits


def _expose(stage: Stage, hits: Hits, shape: tuple[int, int]) -> Exposure:
    point, normal = hits.point.reshape(*shape, 3), hits.normal.reshape(*shape, 3)
    mask = ((hits.geom >= 0) | (_away(stage, hits.point) < _PAPER_FROM + _PAPER_OVER)).reshape(shape)

    def sees(light: Array, points: Array) -> Any:
        return visible(stage.model, stage.data, light, points, _SOLID)

    key = share_seen(key_points(stage.middle), point, normal, mask, sees)
    sky = share_seen(sky_points(stage.middle), point, normal, mask, sees)
    return Exposure(point, normal, hits.geom.reshape(shape), key, sky)


def _color(stage: Stage, view: Viewpoint, hits: Hits, rays: Array, key: Array, sky: Array) -> Array:
    """Linear color (n, 3) of what rays hit, with clear optics and beams in front of it."""
    import numpy as np

    normal = hits.normal
    towards = np.array(KEY) / np.linalg.norm(KEY)
    pixel = hits.distance / view.focal * 1000 / np.maximum(0.15, np.sqrt(np.abs(np.einsum("ij,ij->i", rays, normal))))
    albedo = stage.paint.albedo(stage.data, hits.point, normal, hits.geom, pixel)
    albedo[hits.geom < 0] = linear(_PAPER)
    color = _shade(albedo, normal, rays, towards, key, sky)
    _fade(stage, hits, color)
    _add_clear(stage, view, hits, rays, color, towards)
    for beam in stage.beams:
        _add_beam(beam, view, hits, rays, color)
    return color


def _shade(albedo: Array, normal: Array, rays: Array, towards: Array, key: Array, sky: Array) -> Array:
    import numpy as np

    facing = np.maximum(0.0, normal @ towards)
    light = _KEY_LIGHT * key * facing + _SKY_LIGHT * sky + _BOUNCE * (0.75 - 0.5 * normal[:, 2])
    half = towards - rays
    half /= np.linalg.norm(half, axis=1)[:, None]
    shine = _GLOSS * key * np.maximum(0.0, np.einsum("ij,ij->i", normal, half)) ** _SHINE * (facing > 0)
    return albedo * light[:, None] + shine[:, None]  # type: ignore[no-any-return]


def _fade(stage: Stage, hits: Hits, color: Array) -> None:
    """Let the floor run out into plain paper."""
    import numpy as np

    floor = hits.geom < 0
    share = np.clip((_away(stage, hits.point[floor]) - _PAPER_FROM) / _PAPER_OVER, 0, 1)[:, None]
    share = share * share * (3 - 2 * share)
    color[floor] = color[floor] * (1 - share) + linear(_PAPER) * share


def _away(stage: Stage, point: Array) -> Array:
    """How far points are from the middle of the table, in half diagonals of it."""
    import numpy as np

    away = point[:, :2] - stage.middle[:2]
    return np.hypot(away[:, 0], away[:, 1]) / np.hypot(*stage.middle[:2])  # type: ignore[no-any-return]


def _add_clear(stage: Stage, view: Viewpoint, hits: Hits, rays: Array, color: Array, towards: Array) -> None:
    """Lay the nearest clear geom over what stands behind it."""
    import numpy as np

    clear = cast(stage.model, stage.data, view.eye, rays, (CLEAR_GROUP,))
    front = np.flatnonzero((clear.geom >= 0) & (clear.distance < hits.distance))
    if not len(front):
        return
    normal, rgba = clear.normal[front], stage.model.geom_rgba[clear.geom[front]]
    one = np.ones(len(front))
    glass = _shade(linear(rgba[:, :3]), normal, rays[front], towards, one, 0.7 * one)
    alpha = rgba[:, 3:4]
    color[front] = alpha * glass + (1 - alpha) * color[front]


def _add_beam(beam: Beam, view: Viewpoint, hits: Hits, rays: Array, color: Array) -> None:
    """Add the glow of a beam where it passes in front of what the ray hits."""
    import numpy as np

    line = beam.end - beam.start
    length = float(np.linalg.norm(line))
    line = line / length
    # the point on the beam nearest to each ray
    across = rays @ line
    offset = beam.start - view.eye
    denominator = np.maximum(1e-9, 1 - across**2)
    along = np.clip((across * (rays @ offset) - offset @ line) / denominator, 0, length)
    near = beam.start + along[:, None] * line - view.eye
    depth = np.einsum("ij,ij->i", near, rays)
    gap = np.linalg.norm(near - depth[:, None] * rays, axis=1)
    pixel = depth / view.focal
    glow = np.exp(-((gap / np.maximum(0.0011, 0.7 * pixel)) ** 2)) + 0.16 * np.exp(-((gap / 0.006) ** 2))
    glow = np.where(depth < hits.distance + 0.001, glow, 0.0)[:, None]
    color *= 1 - np.minimum(0.9, glow)
    color += glow * np.array((1.0, 0.03, 0.02))


def _develop(color: Array) -> Array:
    """Linear light to sRGB, 0 to 255, highlights compressed."""
    import numpy as np

    soft = np.where(color > 0.8, 0.8 + 0.2 * np.tanh((color - 0.8) / 0.2), np.maximum(color, 0.0))
    return 255.0 * soft ** (1 / 2.2)


def _edges(picture: Array, geom: Any, smooth: Any) -> Any:
    """(h, w) where a pixel differs from one of its neighbors; within `smooth` surfaces the paint has soft edges."""
    import numpy as np

    edge = np.zeros(geom.shape, bool)
    for axis in (0, 1):
        low, high = [slice(None)] * 2, [slice(None)] * 2
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        rough = ~smooth[tuple(low)]
        step = (np.abs(np.diff(picture, axis=axis)).max(axis=2) > _EDGE) & rough | (np.diff(geom, axis=axis) != 0)
        edge[tuple(low)] |= step
        edge[tuple(high)] |= step
    return edge


def _closer(stage: Stage, view: Viewpoint, exposure: Exposure, rows: Any, columns: Any) -> Array:
    """The mean color (n, 3) of several rays through each of the pixels."""
    import numpy as np

    total = np.zeros((len(rows), 3))
    for du, dv in _SUBPIXELS:
        rays = view.rays(columns + du, rows + dv)
        hits = _see(stage, view, rays)
        key, sky = _borrowed(exposure, hits, rows, columns)
        total += _develop(_color(stage, view, hits, rays, key, sky))
    return total / len(_SUBPIXELS)


def _borrowed(exposure: Exposure, hits: Hits, rows: Any, columns: Any) -> tuple[Array, Array]:
    """Key and sky light at `hits`, from the pixel around that saw the most similar surface."""
    import numpy as np

    height, width = exposure.geom.shape
    best = np.full(len(rows), np.inf)
    key, sky = np.ones(len(rows)), np.ones(len(rows))
    for dy, dx in ((0, 0), (0, -1), (0, 1), (-1, 0), (1, 0)):
        y, x = np.clip(rows + dy, 0, height - 1), np.clip(columns + dx, 0, width - 1)
        unlike = 10.0 * (exposure.geom[y, x] != hits.geom)
        unlike = unlike + 1 - np.einsum("ij,ij->i", exposure.normal[y, x], hits.normal)
        unlike += 50 * np.abs(exposure.point[y, x] - hits.point).sum(axis=1)
        better = unlike < best
        best[better] = unlike[better]
        key[better], sky[better] = exposure.key[y, x][better], exposure.sky[y, x][better]
    return key, sky

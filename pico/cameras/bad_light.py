"""Pictures in bad light: too little of it, spots of scattered laser light, reflections of lamps. Pixels."""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from pico.cameras.view import CameraView
from pico.model.simulated import BadLight

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Gray = NDArray[np.float32]

_SPOT = 12.0
"""Sigma of a spot of scattered light [mm]."""
_SCATTERED = 200.0
"""Mean gray level in the middle of such a spot; speckle goes from none to several times that."""
_COARSE = 8
"""Pixels between the rays that tell what a spot falls on."""
_GRAIN = 3.0
"""Size of a speckle [pixels]."""
_TILE = 256
_LAMP = 45.0
"""Radius of a lamp's reflection [pixels]."""
_GLARE = 400.0
"""Gray level in its middle, far over saturation."""


def lit_badly(picture: Gray, view: CameraView, light: BadLight, seed: int) -> Gray:
    """Return a picture (h, w) as it would be in bad light; the same seed gives the same spots.

    Scattered light falls on the table or on what is over it, where all cameras see it; what reflects a lamp depends on
    where a camera stands, so that each has its own.
    """
    import numpy as np

    picture = picture * np.float32(light.dim)
    if light.scatter:
        speckle = _speckle(seed, zlib.crc32(view.camera.name.encode()))
        for bright in _spots(view, light.scatter, seed):
            picture += _SCATTERED * _windowed(speckle, view) * bright
    for center in _lamps(view, light.glare, seed):
        picture += np.float32(_GLARE) * np.exp(-((_squares(view, center) / _LAMP**2) ** 2))
    return picture


def _spots(view: CameraView, count: int, seed: int) -> Iterator[Gray]:
    """Yield how bright (h, w) each spot makes what it falls on, from 0 to 1: the table, or what is over it there."""
    import numpy as np

    size = 1000 * 2 * view.model.geom("table").size[:2]
    below = _below(view)
    for place in np.random.default_rng((seed, 3)).uniform(0, 1, (count, 2)) * size:
        yield np.exp(-((below - place.astype(np.float32)) ** 2).sum(axis=2) / (2 * _SPOT**2))


def _below(view: CameraView) -> Gray:
    """Where on the table (h, w, 2) [mm] what is seen in each pixel is, or above which place; to a few pixels."""
    import cv2
    import numpy as np

    _, _, width, height = view.region
    columns, rows = view.lattice(_COARSE)
    local = view.rays(*(a.reshape(-1) for a in np.meshgrid(columns, rows)))
    points = view.hit(local).point[:, :2] * 1000
    grid = points.reshape(len(rows), len(columns), 2).astype(np.float32)
    size = (len(columns) * _COARSE, len(rows) * _COARSE)
    whole: Any = cv2.resize(grid, size, interpolation=cv2.INTER_LINEAR)
    below: Gray = whole[:height, :width]
    return below


def _lamps(view: CameraView, count: int, seed: int) -> Any:
    """The middles (count, 2) of what reflects lamps into a camera."""
    import numpy as np

    random = np.random.default_rng((seed, 4, zlib.crc32(view.camera.name.encode())))
    return random.uniform(0, 1, (count, 2)) * view.camera.pixels


def _squares(view: CameraView, center: Any) -> Gray:
    """The squared distance (h, w) of the pixels of a region from a pixel of the sensor."""
    import numpy as np

    u, v, width, height = view.region
    across, down = (np.arange(n, dtype=np.float32) for n in (width, height))
    squares: Gray = ((across + np.float32(u - center[0])) ** 2)[None] + ((down + np.float32(v - center[1])) ** 2)[
        :, None
    ]
    return squares


@lru_cache(maxsize=8)
def _speckle(seed: int, camera: int) -> Gray:
    """Fully developed speckle: the intensity of a field of random phases is exponentially distributed (Goodman, Speckle
    Phenomena in Optics, 2007, chapter 3). Mean 1; repeats after `_TILE` pixels."""
    import numpy as np

    random = np.random.default_rng((seed, 5, camera))
    waves = np.fft.fftfreq(_TILE)
    pupil = np.hypot(waves[None], waves[:, None]) < 1 / (2 * _GRAIN)
    field = np.fft.ifft2(pupil * np.exp(2j * np.pi * random.random((_TILE, _TILE))))
    intensity = np.abs(field) ** 2
    speckle: Gray = (intensity / intensity.mean()).astype(np.float32)
    return speckle


def _windowed(tile: Gray, view: CameraView) -> Gray:
    """The part of a pattern that repeats which lies on a region of the sensor."""
    import numpy as np

    u, v, width, height = view.region
    window: Gray = tile[np.ix_(np.arange(v, v + height) % _TILE, np.arange(u, u + width) % _TILE)]
    return window

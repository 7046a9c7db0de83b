"""The corners of a marker to a few hundredths of a pixel: its whole picture is fitted, not only its corners.

Once its number is known, everything about how a marker should look is known but eight numbers of the homography that
its plane is seen through, two gray levels, and the blur. They are fitted to all pixels of the marker at once
(Gauss-Newton), so that every edge between black and white counts, inner ones too. Corner refinement by gradients
(OpenCV's SUBPIX) pulls corners inward by some tenths of a pixel where cells are few pixels wide.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Picture = NDArray[np.uint8]

_FINE = 16  # samples across a cell of the drawn marker
_CELLS, _AROUND = 6, 2  # cells across a marker, and of plate that are drawn around it
_REACH = 0.45  # cells beyond the border that are fitted: less than the plate has
_ROUNDS = 12
_STILL = 4e-4  # cells: about what a drawn marker is sampled to, so that no further round tells more
_MOST = 12_000  # pixels of one marker that are fitted
_OVER = 0.12
"""What of a picture differs by more than this share of the contrast is no part of the marker."""
_TRACE = 0.035
"""The same for a spot of it, on the average."""
_BINS = 24  # across a marker, by which pixels around a spoilt one are left out
_LEAST = 0.4  # share of a marker that must be clean
_STAINED = 5.0  # what shines on a marker or covers it leaves traces that no noise would
_FLOOR = 0.01  # pixels: what no fit of one picture is better than


@dataclass(frozen=True, eq=False)
class Fit:
    """Corners (4, 2) [pixels] with the covariance (8, 8) of u0, v0, u1, ... [pixels^2].

    `misfit`: root mean square of what is left, as a share of the contrast; `blur`: sigma of the picture [pixels];
    `clean`: share of the pixels that counted at last.
    """

    corners: Array
    covariance: Array
    misfit: float
    blur: float
    clean: float = 1.0


@dataclass(frozen=True, eq=False)
class _Patch:
    """The pixels of a marker: gray levels (n,), and where they are from its middle, scaled, (n, 2)."""

    gray: Array
    at: Array
    center: Array
    scale: float


def refine(picture: Picture, corners: Array, cells: Array, blur: float = 0.8) -> Fit | None:
    """Return the corners of the marker that looks like `cells` (8, 8), near `corners` (4, 2); None where none fits.

    `cells`: 0 black, 1 white, with one cell of the plate around; see `pico.vision.markers.cells`.
    """
    import numpy as np

    patch = _patch(picture, corners)
    if patch is None:
        return None
    start = _homography((corners - patch.center) / patch.scale)
    side = float(np.linalg.norm(corners[0] - corners[2])) / 2**0.5 / _CELLS
    parameters: Any = np.append(start.ravel()[:8], blur / side)
    drawn: Any = np.kron(np.pad(cells, 1, constant_values=1.0), np.ones((_FINE, _FINE))).astype(np.float32)
    counted, still = np.ones(len(patch.gray), bool), False
    for number in range(_ROUNDS):
        design, left, contrast = _linear(patch, drawn, parameters, counted)
        # once it fits, what lies over the plate or shines on it is left out: it would pull the edges beside it
        counted = np.abs(left) < (_OVER * contrast if number > 1 else np.inf)
        if still and (around := counted & _clean(patch, left, contrast)).mean() > _LEAST:
            counted = around
        design = design[:, counted]
        normal = design @ design.T
        try:
            change = np.linalg.solve(normal, design @ left[counted])
        except np.linalg.LinAlgError:
            return None
        parameters = parameters + change[:9]
        parameters[8] = min(max(parameters[8], 0.02), 0.6)
        if number > 2 and np.max(np.abs(change[:8])) < _STILL:
            if still or counted.all():
                break
            still = True
    if not np.all(np.isfinite(parameters)) or contrast < 1:
        return None
    spread = np.asarray(np.linalg.pinv(normal), np.float64)
    return _result(patch, parameters, spread, left, left[counted], contrast, side)


def _clean(patch: _Patch, left: Array, contrast: float) -> Any:
    """Which pixels (n,) to count at last: nothing around what lies over the plate or shines on it, which still reaches
    there."""
    import cv2
    import numpy as np

    off = np.abs(left)
    sigma = 1.48 * float(np.median(off))
    wrong = off > max(_OVER * contrast, 5 * sigma)
    across, down = np.clip(((patch.at / 1.2 + 1) / 2 * _BINS).astype(int), 0, _BINS - 1).T
    bins = down * _BINS + across
    spoilt = np.bincount(bins, wrong, _BINS**2) > 0
    mean = np.bincount(bins, off, _BINS**2) / np.maximum(np.bincount(bins, None, _BINS**2), 1)
    spoilt |= mean > max(_TRACE * contrast, 2 * sigma, 3 * float(np.median(mean)))
    grown = cv2.dilate(spoilt.astype(np.uint8).reshape(_BINS, _BINS), np.ones((5, 5), np.uint8))
    return grown.ravel()[bins] == 0


def _result(
    patch: _Patch, parameters: Array, spread: Array, left: Array, inner: Array, contrast: float, side: float
) -> Fit | None:
    import numpy as np

    corners = _corners(parameters[:8])
    noise = max(float(inner @ inner) / max(len(inner) - 11, 1), 0.3)  # never less than rounding to gray levels
    noise *= _STAINED**2 if len(inner) < len(left) else 1.0
    steps = np.diag(np.full(8, 1e-6))
    jacobian = np.column_stack([(_corners(parameters[:8] + step) - corners).ravel() / 1e-6 for step in steps])
    covariance = jacobian @ spread[:8, :8] @ jacobian.T * noise * patch.scale**2 + np.eye(8) * _FLOOR**2
    clean = len(inner) / len(left)
    misfit = float(np.sqrt(np.mean(left**2))) / contrast
    return Fit(corners * patch.scale + patch.center, covariance, misfit, float(parameters[8]) * side, clean)


def _patch(picture: Picture, corners: Array) -> _Patch | None:
    import cv2
    import numpy as np

    center = np.asarray(corners.mean(axis=0), np.float64)
    scale = float(np.abs(corners - center).max())
    grown = center + (corners - center) * (1 + 2 * _REACH / _CELLS)
    height, width = picture.shape
    low = np.maximum(np.floor(grown.min(axis=0)).astype(int), 0)
    high = np.minimum(np.ceil(grown.max(axis=0)).astype(int) + 1, (width, height))
    if np.any(high - low < 8):
        return None
    mask = np.zeros((high[1] - low[1], high[0] - low[0]), np.uint8)
    cv2.fillConvexPoly(mask, np.round((grown - low) * 16).astype(np.int32), 1, cv2.LINE_8, 4)
    v, u = np.nonzero(mask)
    every = -(-len(u) // _MOST)
    u, v = u[::every] + low[0], v[::every] + low[1]
    at = (np.column_stack((u, v)) - center) / scale
    return _Patch(picture[v, u].astype(np.float64), at, center, scale)


def _linear(patch: _Patch, drawn: Array, parameters: Array, counted: Any) -> tuple[Array, Array, float]:
    """Return the derivatives (11, n) of the picture by homography, blur and levels, what is left (n,), the contrast."""
    import cv2
    import numpy as np

    x, y = patch.at.T
    g = parameters
    depth = g[6] * x + g[7] * y + 1
    u, v = (g[0] * x + g[1] * y + g[2]) / depth, (g[3] * x + g[4] * y + g[5]) / depth  # cells from the corner
    image = cv2.GaussianBlur(drawn, (0, 0), g[8] * _FINE, borderType=cv2.BORDER_REPLICATE)
    slopes = (cv2.Sobel(image, cv2.CV_32F, dx, 1 - dx, ksize=1, scale=_FINE / 2) for dx in (1, 0))
    layers = cv2.merge((image, *slopes, cv2.Laplacian(image, cv2.CV_32F, scale=g[8] * _FINE**2)))
    across = ((u + _AROUND) * _FINE - 0.5).astype(np.float32).reshape(-1, 1)
    down = ((v + _AROUND) * _FINE - 0.5).astype(np.float32).reshape(-1, 1)
    read: Any = cv2.remap(layers, across, down, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    value, du, dv, ds = read[:, 0].T.astype(np.float64)
    contrast, black = _levels(value[counted], patch.gray[counted])
    du, dv = du * contrast / depth, dv * contrast / depth
    bent = -(u * du + v * dv)
    design = np.stack(
        (du * x, du * y, du, dv * x, dv * y, dv, bent * x, bent * y, ds * contrast, value, np.ones(len(value)))
    )
    return design, patch.gray - contrast * value - black, contrast


def _levels(value: Array, gray: Array) -> tuple[float, float]:
    """Return contrast and black level of the straight line that takes `value` (n,) to `gray` (n,)."""
    middle = float(value.mean())
    off = value - middle
    contrast = float(off @ gray) / max(float(off @ off), 1e-9)
    return contrast, float(gray.mean()) - contrast * middle


def _homography(corners: Array) -> Array:
    """Return the homography (3, 3) from the picture to cells, 0 to 6 from corner to corner."""
    import cv2
    import numpy as np

    matrix = cv2.getPerspectiveTransform(corners.astype(np.float32), _cell_corners().astype(np.float32))
    homography: Array = np.asarray(matrix, np.float64) / matrix[2, 2]
    return homography


def _corners(parameters: Array) -> Array:
    import numpy as np

    inverse = np.linalg.inv(np.append(parameters, 1.0).reshape(3, 3))
    points = np.column_stack((_cell_corners(), np.ones(4))) @ inverse.T
    return np.asarray(points[:, :2] / points[:, 2:], np.float64)


def _cell_corners() -> Array:
    import numpy as np

    return np.array([(0, 0), (_CELLS, 0), (_CELLS, _CELLS), (0, _CELLS)], np.float64)

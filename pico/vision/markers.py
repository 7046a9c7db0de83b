"""Which markers a picture shows, and where their corners are. What can't be read is never guessed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any

from pico.vision.refine import refine

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.frame import Frame

    Array = NDArray[np.float64]
    Picture = NDArray[np.uint8]

DICTIONARY = "DICT_4X4_1000"
CELLS = 6
"""Across a marker: four bits and the black border on both sides."""
_CLEAR = 0.2  # a cell is black or white where it is off the middle by this share of the contrast
_MISFIT = 0.15  # of the contrast, that a picture may differ from the marker it is said to show
_CLEAN = 0.4  # share of a marker that light must have left as it is
_CONTRAST = 24.0  # least difference of white and black [gray levels]
_SMALLEST = 24.0  # pixels around a marker, less of which can't be read
_SMALLEST_SHARE = 0.03  # of the longer edge of a picture


@dataclass(frozen=True, eq=False)
class Marker:
    """A marker in one picture: its number, and its corners (4, 2) [pixels of the whole sensor].

    The corners run clockwise as one looks at the marker, from the one at its own upper left. `covariance` (8, 8): of
    u0, v0, u1, ... [pixels^2].
    """

    number: int
    corners: Array
    camera: str
    covariance: Array

    @property
    def noise(self) -> float:
        """One standard deviation of a coordinate [pixels], the mean of all eight."""
        import numpy as np

        return float(np.sqrt(np.trace(self.covariance) / 8))


def read_marker(number: int, corners: Array, camera: str, noise: float = 0.05) -> Marker:
    """Return a marker whose corners are known to `noise` [pixels] each."""
    import numpy as np

    return Marker(number, corners, camera, np.eye(8) * noise**2)


@dataclass(frozen=True, eq=False)
class Fragment:
    """Something square that looks like a marker and can't be read: covered in part, cut, or too blurred."""

    corners: Array
    camera: str


@dataclass(frozen=True, eq=False)
class Markers:
    """What one picture shows. A number that stands in `markers` more than once is a duplicate."""

    camera: str
    markers: tuple[Marker, ...]
    fragments: tuple[Fragment, ...] = ()

    @property
    def duplicates(self) -> frozenset[int]:
        """The numbers that this picture shows more than once."""
        numbers = [marker.number for marker in self.markers]
        return frozenset(n for n in numbers if numbers.count(n) > 1)


def detect(frame: Frame) -> Markers:
    """Return the markers and the unreadable squares that a picture shows.

    A number counts only where all of its bits and its whole border are there: the dictionary has so many markers
    that to mend a bit would be to guess.
    """
    import numpy as np

    picture = np.ascontiguousarray(frame.gray)
    offset = np.array(frame.offset, np.float64)
    quads, numbers, rejected = _detector(max(_SMALLEST / max(picture.shape), _SMALLEST_SHARE)).detectMarkers(picture)
    read: list[Marker] = []
    doubtful = [np.asarray(quad, np.float64).reshape(4, 2) for quad in rejected]
    for quad, number in zip(quads, () if numbers is None else np.ravel(numbers), strict=True):
        corners = np.asarray(quad, np.float64).reshape(4, 2)
        fit = refine(picture, corners, cells(int(number))) if clear(picture, corners, int(number)) else None
        if fit is not None and fit.misfit < _MISFIT and _near(fit.corners, corners):
            read.append(Marker(int(number), fit.corners + offset, frame.camera, fit.covariance))
        else:
            doubtful.append(corners)
    centers = np.array([m.corners.mean(axis=0) - offset for m in read]).reshape(-1, 2)
    fragments = [quad for quad in doubtful if _alone(quad, centers) and _framed(picture, quad)]
    return Markers(frame.camera, tuple(read), tuple(Fragment(q + offset, frame.camera) for q in _distinct(fragments)))


def stained(frame: Frame, number: int, corners: Array) -> Marker | None:
    """Return a marker that light shines on, known to be about at `corners` (4, 2) [pixels of the whole sensor],
    to within a cell; None where the picture speaks against it.

    Light can make black cells bright and never white ones dark: one that is dark is of another marker, or covered.
    """
    import numpy as np

    picture, offset = np.ascontiguousarray(frame.gray), np.array(frame.offset, np.float64)
    near = _matched(picture, corners - offset, number)
    fit = None if near is None else refine(picture, near, cells(number))
    if fit is None or near is None or fit.clean < _CLEAN or not _near(fit.corners, near):
        return None
    seen, wanted = _levels(picture, fit.corners), cells(number)
    white, black = np.median(seen[wanted > 0.5]), np.median(seen[wanted < 0.5])
    if white - black < _CONTRAST:
        return None
    share = (seen - (white + black) / 2) / (white - black)
    bright, dark = share[1:-1, 1:-1][wanted[1:-1, 1:-1] > 0.5], share[wanted < 0.5]
    if np.any(bright < _CLEAR) or np.mean(dark < -_CLEAR) < _CLEAN:
        return None
    return Marker(number, fit.corners + offset, frame.camera, fit.covariance)


def _matched(picture: Picture, corners: Array, number: int) -> Array | None:
    """Return the corners (4, 2) moved, by a cell at most, to where the picture looks most like the marker."""
    import cv2
    import numpy as np

    cell = float(np.linalg.norm(corners[0] - corners[2])) / 2**0.5 / CELLS
    low, high = np.floor(corners.min(axis=0)).astype(int), np.ceil(corners.max(axis=0)).astype(int)
    room = int(np.ceil(cell))
    window = picture[max(low[1] - room, 0) : high[1] + room, max(low[0] - room, 0) : high[0] + room]
    width, height = (int(n) for n in high - low)
    if cell < 2 or window.shape[0] < height or window.shape[1] < width or np.any(low < room):
        return None
    to_cells = cv2.getPerspectiveTransform((corners - low).astype(np.float32), _unit() + np.float32(0.5))
    drawn = np.asarray(cells(number), np.float32)
    flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
    look: Any = cv2.warpPerspective(drawn, to_cells, (width, height), flags=flags, borderMode=cv2.BORDER_REPLICATE)
    like: Any = cv2.matchTemplate(window.astype(np.float32), look, cv2.TM_CCOEFF_NORMED)
    _, _, _, (across, down) = cv2.minMaxLoc(like)
    found: Array = corners + (np.array((across, down)) - room)
    return found


def _near(refined: Array, found: Array) -> bool:
    import numpy as np

    side = float(np.linalg.norm(found[0] - found[2])) / 2**0.5
    return bool(np.max(np.abs(refined - found)) < max(1.5, side / CELLS))


@lru_cache(maxsize=64)
def _detector(smallest: float) -> Any:
    """The detector of squares whose outline is at least a share `smallest` of the longer edge of a picture."""
    import cv2

    parameters = cv2.aruco.DetectorParameters()
    parameters.minMarkerPerimeterRate = smallest
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    parameters.errorCorrectionRate = 0.0
    parameters.maxErroneousBitsInBorderRate = 0.05
    return cv2.aruco.ArucoDetector(dictionary(), parameters)


@cache
def dictionary() -> Any:
    """Return OpenCV's dictionary of the markers that PICO uses."""
    import cv2

    return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, DICTIONARY))


@cache
def cells(number: int) -> NDArray[np.float64]:
    """Return the marker as (8, 8) cells, 0 black and 1 white: the bits, the border, and the plate around them."""
    import numpy as np

    image = dictionary().generateImageMarker(number, CELLS, borderBits=1)
    return np.pad(np.asarray(image, np.float64) / 255, 1, constant_values=1.0)


def clear(picture: Picture, corners: Array, number: int) -> bool:
    """Return whether each cell of marker `number` is plainly black or plainly white, as it should be."""
    import numpy as np

    seen, wanted = _levels(picture, corners), cells(number)
    white, black = np.median(seen[wanted > 0.5]), np.median(seen[wanted < 0.5])
    if white - black < _CONTRAST:
        return False
    share = (seen - (white + black) / 2) / (white - black)
    inside = np.s_[1:-1, 1:-1]
    return bool(np.all((share * np.sign(wanted - 0.5))[inside] > _CLEAR))


def _levels(picture: Picture, corners: Array, points: int = 3) -> Array:
    """Return the mean gray level (8, 8) of the middle of each cell, the plate around the marker included."""
    import cv2
    import numpy as np

    inner = (np.arange(points) + 0.5) / points * 0.5 + 0.25
    along = (np.arange(CELLS + 2)[:, None] + inner).ravel() - 1
    u, v = np.meshgrid(along, along)
    homography = cv2.getPerspectiveTransform(_unit(), corners.astype(np.float32))
    at = cv2.perspectiveTransform(np.stack([u, v], -1).reshape(-1, 1, 2), homography).astype(np.float32)
    level = cv2.remap(picture, at[:, :, 0], at[:, :, 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    blocks = level.reshape(CELLS + 2, points, CELLS + 2, points).astype(np.float64)
    return blocks.mean(axis=(1, 3))  # type: ignore[no-any-return]


def _unit() -> NDArray[np.float32]:
    import numpy as np

    return np.array([(0, 0), (CELLS, 0), (CELLS, CELLS), (0, CELLS)], np.float32)


def _framed(picture: Picture, corners: Array) -> bool:
    """Return whether a square has a marker's look: most of its border black and most of the plate around it white."""
    import numpy as np

    level = _levels(picture, corners)
    border, plate = np.ones((CELLS, CELLS), bool), np.ones((CELLS + 2, CELLS + 2), bool)
    border[1:-1, 1:-1], plate[1:-1, 1:-1] = False, False
    ring, around, bits = level[1:-1, 1:-1][border], level[plate], level[2:-2, 2:-2]
    dark, bright = np.median(ring), np.median(around)
    return bool(
        bright - dark > 2 * _CONTRAST
        and np.mean(ring < (dark + bright) / 2) > 0.7
        and np.ptp(bits) > 0.5 * (bright - dark)
    )


def _alone(quad: Array, centers: Array) -> bool:
    """Return whether no marker that was read has its center in the square."""
    import cv2
    import numpy as np

    shape = quad.astype(np.float32).reshape(-1, 1, 2)
    return not any(cv2.pointPolygonTest(shape, (float(x), float(y)), False) >= 0 for x, y in centers)


def _distinct(quads: list[Array]) -> list[Array]:
    """Return one of the squares that were found at the same place, for thresholds find a square several times."""
    import numpy as np

    kept: list[Array] = []
    for quad in quads:
        center, size = quad.mean(axis=0), np.linalg.norm(quad[0] - quad[2])
        if all(np.linalg.norm(other.mean(axis=0) - center) > size / 3 for other in kept):
            kept.append(quad)
    return kept

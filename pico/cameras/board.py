"""Pictures of the calibration board and of the datums, as the simulated cameras take them. mm, pixels.

No bodies, no arms: a board is held up in front of an empty table, which is how a bench is calibrated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from pico.model.lab import Camera
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.twin.surfaces import marker_image
from pico.vision.camera import CameraModel
from pico.vision.charuco import BOARD, Board, board_image
from pico.vision.frame import Frame
from pico.vision.rigid import upright

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_TABLE, _PAPER, _INK = 120.0, 225.0, 15.0  # gray levels
_FINE = 3  # points along an edge of a pixel
_EVERY = 4  # pixels between points at which the map to the paper is computed
_TEXELS = 8.0  # a mm of the board


@dataclass(frozen=True, eq=False)
class Sheet:
    """A flat print: gray levels (h, w), its width and height [mm], and the pose (4, 4) of its middle [mm]."""

    print: NDArray[np.float32]
    size: tuple[float, float]
    pose: Array


def board_sheet(pose: Array, board: Board = BOARD, margin: float = 10.0) -> Sheet:
    """Return the board at `pose` (4, 4) on paper with a white `margin` around it [mm]."""
    width, height = board.size
    return Sheet(_board_print(board, margin), (width + 2 * margin, height + 2 * margin), pose)


@cache
def _board_print(board: Board, margin: float) -> NDArray[np.float32]:
    import numpy as np

    image = np.pad(board_image(board, _TEXELS), round(margin * _TEXELS), constant_values=255)
    return _inked(image)


def marker_sheet(number: int, size: float, pose: Array) -> Sheet:
    """Return a marker with edges of `size` [mm], its middle at `pose` (4, 4), with a white rim of a sixth of that."""
    edge = size * 8 / 6
    return Sheet(_marker_print(number), (edge, edge), pose)


@cache
def _marker_print(number: int) -> NDArray[np.float32]:
    import numpy as np

    return _inked(np.kron(np.pad(marker_image(number, 6), 1, constant_values=255), np.ones((24, 24))))


def datum_sheets(setup: Setup) -> list[Sheet]:
    """Return the datum markers of a lab."""
    return [
        marker_sheet(datum.marker, datum.size, upright(Pose(datum.x, datum.y, datum.yaw), 0.0))
        for datum in setup.lab.datums.values()
    ]


def _inked(image: Any) -> NDArray[np.float32]:
    import numpy as np

    return np.asarray(_INK + (_PAPER - _INK) / 255.0 * image, np.float32)


def photograph_sheets(camera: CameraModel, sheets: Sequence[Sheet], settings: Camera, random: Any) -> Frame:
    """Return what a camera that stands in the table's frame sees of flat prints, those later over those before.

    `settings`: blur and noise of the camera; `random`: a numpy generator.
    """
    import cv2
    import numpy as np

    width, height = camera.pixels
    picture: Any = np.full((height, width), _TABLE, np.float32)
    for sheet in sheets:
        draw_sheet(picture, camera, sheet)
    if settings.blur > 0:
        picture = cv2.GaussianBlur(picture, (0, 0), settings.blur)
    noise = random.standard_normal(picture.shape, np.float32) * np.float32(settings.noise)
    gray: Any = cv2.add(picture, noise, dtype=cv2.CV_8U)
    return Frame(gray, (0, 0), camera.name, 0.0)


def draw_sheet(picture: Any, camera: CameraModel, sheet: Sheet) -> None:
    """Draw a flat print into the whole picture (rows, columns) of a camera that stands in the table's frame."""
    import cv2
    import numpy as np

    box = _box(camera, sheet)
    if box is None:
        return
    left, top, right, bottom = box
    where = _on_paper(camera, sheet, box)
    rows, columns = sheet.print.shape
    texels = columns / sheet.size[0]
    across = (where[..., 0] * texels + (columns - 1) / 2).astype(np.float32)
    down = ((rows - 1) / 2 - where[..., 1] * texels).astype(np.float32)
    ink: Any = cv2.remap(sheet.print, across, down, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    on = ((np.abs(where[..., 0]) < sheet.size[0] / 2) & (np.abs(where[..., 1]) < sheet.size[1] / 2)).astype(np.float32)
    shape = (right - left, bottom - top)
    cover, value = (cv2.resize(a, shape, interpolation=cv2.INTER_AREA) for a in (on, ink * on))
    patch = picture[top:bottom, left:right]
    patch *= 1 - cover
    patch += value


def _box(camera: CameraModel, sheet: Sheet) -> tuple[int, int, int, int] | None:
    """The pixels [left, top, right, bottom) that a sheet may cover; None where it shows its back or is not in view."""
    import numpy as np

    x, y = np.meshgrid(np.linspace(-0.5, 0.5, 9) * sheet.size[0], np.linspace(-0.5, 0.5, 9) * sheet.size[1])
    rim = np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size)))
    pixels = camera.project(rim @ sheet.pose[:3, :3].T + sheet.pose[:3, 3])
    toward = sheet.pose[:3, 2] @ (camera.pose[:3, 3] - sheet.pose[:3, 3])
    if toward <= 0 or not np.isfinite(pixels).all():
        return None
    low, high = np.floor(pixels.min(axis=0)) - 2, np.ceil(pixels.max(axis=0)) + 3
    left, top = (max(int(a), 0) for a in low)
    right, bottom = (min(int(a), b) for a, b in zip(high, camera.pixels, strict=True))
    return (left, top, right, bottom) if right - left > 1 and bottom - top > 1 else None


def _on_paper(camera: CameraModel, sheet: Sheet, box: tuple[int, int, int, int]) -> Any:
    """Where on the paper [mm] the points within the pixels of `box` lie (rows, columns, 2)."""
    import numpy as np

    left, top, right, bottom = box
    columns, rows = _knots(left, right), _knots(top, bottom)
    u, v = np.meshgrid(columns, rows)
    origin, along = camera.rays(np.column_stack((u.ravel(), v.ravel())))
    turn, middle = sheet.pose[:3, :3], sheet.pose[:3, 3]
    start, way = (origin - middle) @ turn, along @ turn
    place = (start + way * (-start[2] / way[:, 2])[:, None])[:, :2].reshape(*u.shape, 2)
    across = _between(place.swapaxes(0, 1), right - left).swapaxes(0, 1)
    return _between(across, bottom - top)


def _knots(low: int, high: int) -> Array:
    """Pixels between which the map to the paper is linear."""
    import numpy as np

    return np.linspace(low - 0.5, high - 0.5, (high - low) // _EVERY + 2)


def _between(values: Any, pixels: int) -> Any:
    """Return `values` (k, ...) at knots over `pixels` at all points within them, linear in between."""
    import numpy as np

    at = (np.arange(pixels * _FINE) + 0.5) / _FINE * (len(values) - 1) / pixels
    first = np.minimum(at.astype(int), len(values) - 2)
    share = (at - first).astype(np.float32).reshape(-1, 1, 1)
    low, high = (values[i].astype(np.float32) for i in (first, first + 1))
    return low + (high - low) * share

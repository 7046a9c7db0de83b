"""The calibration board: a chessboard with markers in its white squares (ChArUco), and its corners in a picture."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from pico.vision.markers import dictionary

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.frame import Frame

    Array = NDArray[np.float64]


@dataclass(frozen=True)
class Board:
    """A board of `columns` by `rows` squares with edges of `square`, markers with edges of `marker` [mm] in the white
    ones, numbered from `first`. It fits on A4 and on letter."""

    columns: int = 7
    rows: int = 5
    square: float = 36.0
    marker: float = 27.0
    first: int = 960

    @property
    def size(self) -> tuple[float, float]:
        """Width and height [mm]."""
        return self.columns * self.square, self.rows * self.square

    @property
    def numbers(self) -> range:
        """The numbers of its markers."""
        return range(self.first, self.first + self.columns * self.rows // 2)


BOARD = Board()


@dataclass(frozen=True, eq=False)
class BoardView:
    """The board in one picture: inner corners (n, 3) [mm] of the board's frame, and where they are seen (n, 2) [pixels
    of the whole sensor]. The frame has its origin at the middle, x right and y up on the print, z out of it."""

    camera: str
    corners: Array
    pixels: Array


@cache
def charuco(board: Board) -> Any:
    """Return OpenCV's board."""
    import cv2
    import numpy as np

    size = (board.columns, board.rows)
    return cv2.aruco.CharucoBoard(size, board.square, board.marker, dictionary(), np.array(board.numbers))


def find_board(frame: Frame, board: Board = BOARD) -> BoardView | None:
    """Return the inner corners of the board that a picture shows, or None where it shows fewer than six, or only ones
    that lie nearly in one line, which do not tell how the board leans."""
    import cv2
    import numpy as np

    corners, numbers, _, _ = cv2.aruco.CharucoDetector(charuco(board)).detectBoard(frame.gray)
    if numbers is None or len(numbers) < 6:
        return None
    pixels: Any = np.asarray(corners, np.float32).reshape(-1, 1, 2)
    points = np.asarray(charuco(board).getChessboardCorners(), np.float64)[np.ravel(numbers)]
    if np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[1] < board.square:
        return None
    side = _pixels_a_mm(points, pixels.reshape(-1, 2), board.square) * (board.square - board.marker) / 2
    half = int(max(2, min(10, side * 0.8)))  # no more than the white between marker and corner
    done = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 60, 1e-4)
    pixels = cv2.cornerSubPix(frame.gray, pixels.copy(), (half, half), (-1, -1), done)
    width, height = board.size
    return BoardView(
        frame.camera,
        (points - (width / 2, height / 2, 0)) * (1, -1, 1),
        np.asarray(pixels, np.float64).reshape(-1, 2) + frame.offset,
    )


def _pixels_a_mm(points: Array, pixels: Any, square: float) -> float:
    """The least scale of the picture between neighboring corners: a leaning board is foreshortened one way."""
    import numpy as np

    apart = np.linalg.norm(points[:, None, :2] - points[None, :, :2], axis=2)
    seen = np.linalg.norm(pixels[:, None] - pixels[None], axis=2)
    return float(seen[(apart > 0) & (apart < 1.1 * square)].min(initial=np.inf) / square)


def board_image(board: Board, pixels_a_mm: float) -> NDArray[np.uint8]:
    """Return the print of the board (h, w), 0 black, 255 white, without margin."""
    import numpy as np

    width, height = board.size
    size = (round(width * pixels_a_mm), round(height * pixels_a_mm))
    return np.asarray(charuco(board).generateImage(size, marginSize=0, borderBits=1), np.uint8)

"""Names of components in a picture: pills above them, moved up or aside until none hides another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.twin.lettering import extent, write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.drawing.viewpoint import Viewpoint

Box = tuple[float, float, float, float]

_INK = (34, 40, 49)
_PILL = (255, 255, 255)
_WEIGHT = 500


@dataclass(frozen=True, slots=True)
class Anchor:
    """A name and the point that it belongs to [m]."""

    name: str
    at: tuple[float, float, float]


def label(image: NDArray[np.uint8], view: Viewpoint, anchors: Sequence[Anchor]) -> None:
    """Write names into `image` (h, w, 3) above their anchors, with a line where one had to move away."""
    import numpy as np

    if not anchors:
        return
    size = max(11.0, image.shape[0] / 52)
    spots = view.project(np.array([a.at for a in anchors]))
    boxes: dict[int, Box] = {}
    for index in sorted(range(len(anchors)), key=lambda i: spots[i][1], reverse=True):  # the lowest first
        u, v, _ = (float(x) for x in spots[index])
        name = anchors[index].name
        width = extent(name, size, _WEIGHT)[0] + 0.9 * size
        boxes[index] = _free(u, v, width, 1.4 * size, list(boxes.values()), image.shape[1])
        _line(image, (u, v), boxes[index], size)
    for index, box in boxes.items():
        _pill(image, box)
        _, rise, _ = extent("x", size, _WEIGHT)
        foot = ((box[0] + box[2]) / 2, (box[1] + box[3] + rise) / 2 - 0.5)
        write(image, anchors[index].name, foot, size, _INK, align="center", weight=_WEIGHT)


def _free(u: float, v: float, width: float, height: float, taken: list[Box], limit: int) -> Box:
    """The nearest place over (u, v) for a pill that meets no other."""
    gap = 0.45 * height
    for rise in range(12):
        for aside in (0.0, -0.3, 0.3, -0.55, 0.55):
            left = min(max(u - width / 2 + aside * width, 3.0), limit - width - 3.0)
            top = max(3.0, v - gap - height - rise * 0.5 * height)
            box = (left, top, left + width, top + height)
            if not any(_meet(box, other) for other in taken):
                return box
    return box


def _meet(a: Box, b: Box) -> bool:
    return a[0] < b[2] + 4 and b[0] < a[2] + 4 and a[1] < b[3] + 4 and b[1] < a[3] + 4


def _line(image: NDArray[np.uint8], anchor: tuple[float, float], box: Box, size: float) -> None:
    import cv2

    left, _, right, bottom = box
    foot = (round(anchor[0] * 16), round((anchor[1] - 0.15 * size) * 16))
    start = (round(min(max(anchor[0], left + size / 2), right - size / 2) * 16), round(bottom * 16))
    cv2.line(image, start, foot, _PILL, 2, cv2.LINE_AA, 4)
    cv2.line(image, start, foot, _INK, 1, cv2.LINE_AA, 4)


def _pill(image: NDArray[np.uint8], box: Box) -> None:
    """A white pill, nearly opaque, with a faint rim."""
    import cv2
    import numpy as np

    left, top, right, bottom = box
    y0, y1, x0, x1 = int(top) - 2, int(bottom) + 3, int(left) - 2, int(right) + 3
    y0, x0 = max(0, y0), max(0, x0)
    part = image[y0:y1, x0:x1]
    radius = (bottom - top) / 2
    for grow, color, strength in ((1.0, (120, 128, 138), 0.55), (0.0, _PILL, 0.93)):
        mask = np.zeros(part.shape[:2], np.uint8)
        ends = [(round((x - x0) * 16), round(((top + bottom) / 2 - y0) * 16)) for x in (left + radius, right - radius)]
        for end in ends:
            cv2.circle(mask, end, round((radius + grow) * 16), 255, -1, cv2.LINE_AA, 4)
        low = (ends[0][0], round((top - grow - y0) * 16))
        high = (ends[1][0], round((bottom + grow - y0) * 16))
        cv2.rectangle(mask, low, high, 255, -1, cv2.LINE_AA, 4)
        share = mask[:, :, None] / 255.0 * strength
        part[:] = np.round(part * (1 - share) + np.array(color) * share).astype(np.uint8)

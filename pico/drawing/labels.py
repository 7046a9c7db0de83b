"""Names of components in a picture: pills at the nearest free place, so that none hides another or a component."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.drawing.label_places import ABOVE, Box, along, free_place, leader, nearest, overlap
from pico.twin.lettering import extent, write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.drawing.viewpoint import Viewpoint

_INK = (34, 40, 49)
_PILL = (255, 255, 255)
_WEIGHT = 500


@dataclass(frozen=True, slots=True)
class Anchor:
    """A name and the point that it belongs to [m]."""

    name: str
    at: tuple[float, float, float]


def label(
    image: NDArray[np.uint8], view: Viewpoint, anchors: Sequence[Anchor], things: Sequence[tuple[str, Box]] = ()
) -> Mapping[str, Box]:
    """Write names into `image` (h, w, 3) at the nearest free place above their anchors, with a line to them.

    `things`: what is not to be covered [pixels], with whose it is; a line crosses things of others only where there is
    no other way. Returns where each name is; one that finds no room is left out.
    """
    import numpy as np

    if not anchors:
        return {}
    size = max(11.0, image.shape[0] / 52)
    spots = view.project(np.array([a.at for a in anchors]))
    within = (3.0, 3.0, image.shape[1] - 3.0, image.shape[0] - 3.0)
    boxes: dict[int, Box] = {}
    lines: list[Box] = []
    for index in sorted(range(len(anchors)), key=lambda i: (spots[i][1], spots[i][0])):  # the highest first
        u, v, _ = (float(x) for x in spots[index])
        width, height = extent(anchors[index].name, size, _WEIGHT)[0] + 0.9 * size, 1.4 * size
        around = (u - 2.0, v - 0.3 * height, u + 2.0, v)
        done = [*boxes.values(), *lines]
        crossed = [*(box for name, box in things if name != anchors[index].name), *done]
        found = free_place(around, width, height, [*(box for _, box in things), *done], within, (ABOVE,), crossed)
        if found is not None:
            boxes[index] = found[0]
            lines += along(*leader(around, found[0]))
            _line(image, (u, v), found[0])
    for index, box in boxes.items():
        _pill(image, box)
        _, rise, _ = extent("x", size, _WEIGHT)
        foot = ((box[0] + box[2]) / 2, (box[1] + box[3] + rise) / 2 - 0.5)
        write(image, anchors[index].name, foot, size, _INK, align="center", weight=_WEIGHT)
    return {anchors[index].name: box for index, box in boxes.items()}


def engrave(image: NDArray[np.uint8], view: Viewpoint, anchors: Sequence[Anchor], taken: Sequence[Box]) -> None:
    """Write names of places flat into `image` (h, w, 3), where nothing stands in front and no other name is."""
    import numpy as np

    size, done = max(9.0, image.shape[0] / 68), list(taken)
    for anchor, (u, v, _) in zip(anchors, view.project(np.array([a.at for a in anchors]).reshape(-1, 3)), strict=True):
        width, rise, _ = extent(anchor.name, size, _WEIGHT)
        box = (u - width / 2 - 1, v - rise / 2 - 1, u + width / 2 + 1, v + rise / 2 + 1)
        if not any(overlap(box, other) for other in done):
            write(image, anchor.name, (u, v + rise / 2), size, _INK, align="center", weight=_WEIGHT)
            done.append(box)


def _line(image: NDArray[np.uint8], anchor: tuple[float, float], box: Box) -> None:
    import cv2

    foot, start = (tuple(round(x * 16) for x in at) for at in (anchor, nearest(box, anchor)))
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

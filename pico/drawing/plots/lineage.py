"""Commits as a graph, from left to right: a line for each branch, and the ways that the bench went back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from pico.drawing.plots.axes import COLORS, FAINT, INK, PAPER, paper
from pico.twin.lettering import extent, write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_LEFT, _TOP, _ROW, _COLUMN, _RADIUS, _TIP = 60, 96, 104, 96, 7, 8


@dataclass(frozen=True)
class Node:
    """A commit: its id, the ids of its parents (those that are not drawn count for nothing), and what to call it, in
    one or more lines."""

    id: str
    parents: tuple[str, ...]
    label: tuple[str, ...]


def picture(
    title: str, nodes: Sequence[Node], back: Sequence[tuple[str, str]] = (), notes: Sequence[str] = ()
) -> NDArray[np.uint8]:  # fmt: skip
    """Return the graph (h, w, 3), sRGB. `nodes`: parents before children. `back`: from which commit the bench went back
    to which."""
    import cv2

    rows = _rows(nodes)
    places = {one.id: (_LEFT + n * _COLUMN, _TOP + rows[one.id] * _ROW) for n, one in enumerate(nodes)}
    width = max(640, _LEFT + len(nodes) * _COLUMN)
    image = paper(title, width, _TOP + (max(rows.values()) + 1) * _ROW, notes)
    for one in nodes:
        for parent in (p for p in one.parents if p in places):
            _joined(image, places[parent], places[one.id], COLORS[rows[one.id] % len(COLORS)])
    for begin, end in (pair for pair in back if set(pair) <= places.keys()):
        _went_back(image, places[begin], places[end])
    for one in nodes:
        (u, v), color = places[one.id], COLORS[rows[one.id] % len(COLORS)]
        cv2.circle(image, (u, v), _RADIUS, PAPER, -1, cv2.LINE_AA)
        cv2.circle(image, (u, v), _RADIUS, color, 2, cv2.LINE_AA)
        for n, line in enumerate(one.label):
            at = (u, v + 24 + 15 * n)
            write(image, _short(line), at, 12, FAINT if n else INK, align="center", weight=500)
    return image


def _rows(nodes: Sequence[Node]) -> dict[str, int]:
    """Return the row of each commit by id: the first child of a commit is in its row, any other begins a new one."""
    found: dict[str, int] = {}
    followed: set[str] = set()
    for one in nodes:
        parent = next((p for p in one.parents if p in found), None)
        if parent is not None and parent not in followed:
            followed.add(parent)
            found[one.id] = found[parent]
        else:
            found[one.id] = max(found.values(), default=-1) + 1
    return found


def _joined(image: NDArray[np.uint8], a: tuple[int, int], b: tuple[int, int], color: tuple[int, int, int]) -> None:
    import cv2

    between = a[0] + _COLUMN // 2  # two columns' labels have room for a line there
    for start, end in pairwise((a, (between, a[1]), (between, b[1]), b)):
        cv2.line(image, start, end, color, 2, cv2.LINE_AA)


def _went_back(image: NDArray[np.uint8], a: tuple[int, int], b: tuple[int, int]) -> None:
    """Draw a dashed arc above both, with a head at its end."""
    import cv2
    import numpy as np

    count = 2 * max(4, round(math.dist(a, b) / 10))
    t = np.linspace(0.0, 1.0, count + 1)[:, None]
    top = np.array([(a[0] + b[0]) / 2, min(a[1], b[1]) - 46.0])
    start, end = np.array([a[0], a[1] - _RADIUS]), np.array([b[0], b[1] - _RADIUS])
    arc = np.round((1 - t) ** 2 * start + 2 * t * (1 - t) * top + t**2 * end).astype(int)
    for n in range(0, count, 2):
        cv2.line(image, arc[n].tolist(), arc[n + 1].tolist(), FAINT, 1, cv2.LINE_AA)
    before, last = arc[-3].tolist(), arc[-1].tolist()
    cv2.arrowedLine(image, before, last, FAINT, 1, cv2.LINE_AA, tipLength=_TIP / max(1.0, math.dist(before, last)))


def _short(text: str) -> str:
    while extent(text, 12, 500)[0] > _COLUMN - 6 and len(text) > 4:
        text = f"{text.rstrip('…')[:-1]}…"
    return text

"""A trace as a picture: what was done when, a lane for each kind of work."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.drawing.plots.axes import COLORS, FAINT, INK, RULE, paper, ticks
from pico.twin.lettering import write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_LEFT, _RIGHT, _TOP, _LANE, _FOOT = 110, 30, 96, 40, 52


@dataclass(frozen=True)
class Span:
    """Work of a kind (`lane`) from `start` to `end` [s]."""

    lane: str
    start: float
    end: float


def picture(
    title: str, spans: Sequence[Span], marks: Mapping[float, str], notes: Sequence[str] = (), *, width: int = 1200
) -> NDArray[np.uint8]:  # fmt: skip
    """Return the plot (h, width, 3), sRGB: a lane for each kind in the order in which they first come, with its seconds
    in all; `marks`: what came at which time [s]. With at least one span."""
    lanes = [*dict.fromkeys(span.lane for span in spans)]
    last = max((*(span.end for span in spans), *marks, 1.0))
    foot = _TOP + len(lanes) * _LANE
    image = paper(title, width, foot + _FOOT, notes)

    def column(t: float) -> int:
        return round(_LEFT + (width - _LEFT - _RIGHT) * t / last)

    taken: list[int] = [-100, -100]  # where the label before ends, in each of two lines
    for t, label in sorted(marks.items()):
        u = column(t)
        image[_TOP - 6 : foot, u] = RULE
        line = 0 if u - taken[0] > 46 else 1
        if u - taken[line] > 46:
            write(image, label, (u, _TOP - 12 - 16 * line), 11, INK, align="center", weight=500)
            taken[line] = u
    for n, lane in enumerate(lanes):
        top = _TOP + n * _LANE
        mine = [span for span in spans if span.lane == lane]
        for span in mine:
            image[top + 6 : top + _LANE - 8, column(span.start) : max(column(span.end), column(span.start) + 1)] = (
                COLORS[n % len(COLORS)]
            )
        write(image, lane, (16, top + 20), 12, INK, weight=500)
        write(image, f"{sum(s.end - s.start for s in mine):.0f} s", (16, top + 35), 11, FAINT, weight=500)
    image[foot, _LEFT : width - _RIGHT] = RULE
    for t in ticks(0.0, last):
        image[foot : foot + 5, column(t)] = RULE
        write(image, f"{t:.6g}", (column(t), foot + 19), 12, FAINT, align="center", weight=500)
    write(image, "seconds of the bench", (width - _RIGHT, foot + 40), 13, INK, align="right", weight=500)
    return image

"""A film of a run, by ray casting: of each picture only what moved since the last one is looked at again."""

from __future__ import annotations

import glob
from bisect import bisect_right
from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.disk import beside, removed, sweep, writing
from pico.drawing.film.camerawork import Set, build_set
from pico.drawing.film.movie_file import open_movie, require_kind
from pico.model.setup import Setup
from pico.twin.snapshot import Snapshot, at

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Image = NDArray[np.uint8]

SIZE = (640, 360)
FPS = 12.0
_HOLD = 1.0  # s that the last picture stays
_INK, _FAINT, _PAPER = (34, 40, 49), (96, 105, 118), (252, 252, 253)


@dataclass(frozen=True, slots=True)
class Caption:
    """What is written under a film from `time` [s] on, and the component whose name is shown where it is."""

    time: float
    text: str
    component: str = ""


def write_film(
    setup: Setup,
    snapshots: Sequence[Snapshot],
    path: Path,
    *,
    captions: Sequence[Caption] = (),
    fps: float = FPS,
    size: tuple[int, int] = SIZE,
) -> Generator[tuple[int, int], None, None]:
    """Write a film of `snapshots` (one or more) to `path`, .mp4 or .gif, in simulated time.

    Yields (pictures done, of how many) after each picture; ended early, the film is what was done until then. Raises
    PicoError where it can't be written; `path` is then as it was, as it is where not even one picture was done.
    """
    require_kind(path)
    fresh, done = beside(path).with_suffix(f".tmp{path.suffix}"), 0
    with writing(path, what=f"cannot write the film {path}"), removed(fresh):
        sweep(path.parent, glob.escape(path.name))
        try:
            for done, count in _shot(setup, snapshots, fresh, captions, fps, size):
                yield done, count
        except (KeyboardInterrupt, GeneratorExit):
            if done:
                fresh.replace(path)
            raise
        fresh.replace(path)


def _shot(
    setup: Setup, snapshots: Sequence[Snapshot], path: Path, captions: Sequence[Caption], fps: float,
    size: tuple[int, int],
) -> Generator[tuple[int, int], None, None]:  # fmt: skip
    first, last = snapshots[0].time, snapshots[-1].time
    step = 1 / fps
    count = int((last - first) / step + 1e-9) + 2  # the end is always shown
    movie = open_movie(path, fps, size)
    picture: Any = None
    try:
        stage = build_set(setup, snapshots, (size[0], size[1] - _strip(size[1])))
        for number in range(count):
            now = replace(at(snapshots, min(last, first + number * step)), time=min(last, first + number * step))
            picture = _titled(stage.shoot(now), stage, now, _current(captions, now.time), now.time - first, size[1])
            movie.add(picture)
            yield number + 1, count
    finally:
        for _ in range(round(_HOLD * fps) if picture is not None else 0):
            movie.add(picture)
        movie.close()


def _current(captions: Sequence[Caption], time: float) -> Caption:
    i = bisect_right(captions, time, key=lambda c: c.time)
    return captions[i - 1] if i else Caption(time, "")


def _titled(image: Image, stage: Set, now: Snapshot, caption: Caption, elapsed: float, height: int) -> Image:
    """Return the picture with a line below: what is being done, and for how long it has been going on."""
    import numpy as np

    from pico.drawing.labels import Anchor, label
    from pico.twin.lettering import write

    if caption.component in now.places:
        anchor = Anchor(caption.component, stage.top(caption.component, now))
        grip = [("", box) for _, box in stage.grip(caption.component)]  # its line keeps off the component, too
        label(image, stage.view, [anchor], grip)
    width, size = image.shape[1], _letters(height)
    whole = np.full((height, width, 3), _PAPER, np.uint8)
    whole[: image.shape[0]] = image
    foot = height - 0.62 * size
    write(whole, caption.text, (size, foot), size, _INK, weight=500)
    write(whole, f"{elapsed:.1f} s", (width - size, foot), size, _FAINT, align="right", weight=500)
    return whole


def _letters(height: int) -> float:
    return max(10.0, height / 26)


def _strip(height: int) -> int:
    """How many pixels of a film's height the line below takes."""
    return round(1.9 * _letters(height))

"""A camera's own picture with what was made of it drawn in: outlines, names, what could not be told."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.drawing.outlines import outline
from pico.model.observation import Observation, ObservedComponent, doubtful
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.twin.lettering import Color, extent, write
from pico.vision.sighting import Sighting

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.camera import CameraModel
    from pico.vision.frame import Frame

    Image = NDArray[np.uint8]

_SEEN, _DOUBT, _WRONG = (40, 210, 120), (255, 190, 40), (255, 70, 60)
_HALF = 160.0  # mm around a component that a picture of it shows
_WIDTH = 1224  # pixels of a picture
_LETTERS = 17.0  # pixels
_LYING = 20.0  # mm, radius of the ring around what can't be told


def annotated(
    setup: Setup,
    frames: Sequence[Frame],
    cameras: Mapping[str, CameraModel],
    seen: Observation,
    sighting: Sighting,
    component: str | None = None,
) -> Image:
    """Return the first picture that is not black (h, w, 3) with what was seen drawn in, about 1200 pixels wide.

    `component`: only what is around it. Raises PicoError where all pictures are black, or nobody sees the component.
    """
    import cv2
    import numpy as np

    frame = next((f for f in frames if not f.black), None)
    if frame is None:
        raise PicoError(error("marker-dark", "every picture is black: there is nothing to draw on"))
    camera = cameras[frame.camera]
    left, top, width, height = _window(setup, camera, seen, component)
    scale = _WIDTH / width
    cut = np.asarray(frame.gray[top : top + height, left : left + width])
    gray: Any = cv2.resize(
        cut, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    )
    image: Image = np.ascontiguousarray(np.repeat(gray[:, :, None], 3, axis=2))

    def pixels(points: Sequence[tuple[float, float, float]]) -> Any:
        return (camera.project(np.array(points, np.float64)) - (left, top)) * scale

    for name, part in sorted(seen.components.items()):
        if part.pose is not None and part.presence != "held" and name in setup.lab.inventory:
            _draw_part(image, setup, name, part, pixels)
    for name, thing in sorted(seen.unknown.items()):
        corners = outline(thing.footprint, thing.pose)
        _ring(image, pixels([(x, y, 0.0) for x, y in corners]), _WRONG, name)
    for finding in sighting.findings:
        for x, y in finding.at if finding.kind not in ("unknown", "duplicate") else ():
            around = [(x + a * _LYING, y + b * _LYING, 100.0) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            _ring(image, pixels(around), _WRONG, f"{finding.component or ''} {finding.kind}".strip())
    return image


def _window(setup: Setup, camera: CameraModel, seen: Observation, component: str | None) -> tuple[int, int, int, int]:
    """The part of the sensor that is shown: left, top, width, height [pixels]."""
    import numpy as np

    width, height = camera.pixels
    if component is None:
        return 0, 0, width, height
    part = seen.components.get(component)
    if part is None or part.pose is None:
        raise PicoError(error("missing", f"nobody sees {component}, so there is no picture of it", address=component))
    x, y, half = part.pose.x, part.pose.y, _HALF
    corners = np.array([(x + a * half, y + b * half, 70.0) for a in (-1, 1) for b in (-1, 1)])
    at = camera.project(corners)
    low = np.clip(np.floor(at.min(axis=0)), 0, (width - 32, height - 32)).astype(int)
    high = np.clip(np.ceil(at.max(axis=0)), low + 32, (width, height)).astype(int)
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])


def _draw_part(image: Image, setup: Setup, name: str, part: ObservedComponent, pixels: Any) -> None:
    assert part.pose is not None
    geometry = setup.type_of(name).geometry
    unsure = part.presence != "seen" or part.how in ("remembered", "placed") or doubtful(setup, name, part)
    color = _DOUBT if unsure else _SEEN
    corners = outline(geometry.footprint, part.pose)
    _ring(image, pixels([(x, y, 0.0) for x, y in corners]), color, name)
    if geometry.marker is not None and part.how not in ("fixed", ""):
        _draw_plate(image, part.pose, geometry.marker.at, geometry.marker.size / 2, color, pixels)


def _draw_plate(
    image: Image, pose: Pose, at: tuple[float, float, float], half: float, color: Color, pixels: Any
) -> None:
    import cv2
    import numpy as np

    ring = [pose.apply(at[0] + a * half, at[1] + b * half) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    seen = np.round(pixels([(x, y, at[2]) for x, y in ring])).astype(np.int32)
    cv2.polylines(image, [seen], True, color, 2, cv2.LINE_AA)


def _ring(image: Image, points: Any, color: Color, text: str) -> None:
    """An outline with a name below it, on a dark ground, so that it is read on anything."""
    import cv2
    import numpy as np

    if not np.isfinite(points).all():
        return
    cv2.polylines(image, [np.round(points).astype(np.int32)], True, color, 1, cv2.LINE_AA)
    width, above, below = extent(text, _LETTERS)
    middle, bottom = float(points[:, 0].mean()), float(points[:, 1].max()) + above + 4
    left, top = round(middle - width / 2) - 3, round(bottom) - above - 3
    cv2.rectangle(image, (left, top), (left + width + 6, round(bottom) + below + 2), (20, 24, 30), -1)
    write(image, text, (middle, bottom), _LETTERS, color, align="center")

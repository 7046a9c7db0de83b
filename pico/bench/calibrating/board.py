"""The step `intrinsics`: a person holds the calibration board up, and the cameras over the table look at it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.bench.calibrating.at_table import AtTable, Stopped
from pico.bench.calibrating.pictured import corners_drawn
from pico.bench.calibrating.progress import Progress, Shot
from pico.bench.calibrating.table import of_lens
from pico.diagnostics import PicoError, error
from pico.model.setup import Setup
from pico.vision.camera import CameraModel
from pico.vision.charuco import Board, BoardView, find_board
from pico.vision.lens import LEAST, lens, lens_of
from pico.vision.markers import detect
from pico.vision.nominal import camera_models
from pico.vision.rigid import motion, rotation

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.frame import Frame

    Array = NDArray[np.float64]

PROCEDURE = "intrinsics/1"
STILL = 0.6
"""How far corners may be apart between the first and the last picture of one place [pixels, root mean square]."""
TRIES = 3
"""How often the board is asked for at one place before the next one is."""
_INSIDE = 30.0  # pixels from a picture's edge


def intrinsics(at: AtTable, cameras: Sequence[str]) -> tuple[str, ...]:
    """Find the lenses of `cameras`, and keep them until these have a place; return one line for each. Raises PicoError,
    Stopped if the person leaves off."""
    if at.progress.board not in (None, at.board):
        at.asks.say("The pictures so far are of another board: they are taken again.")
        at.keep(Progress(lenses=at.progress.lenses, sigmas=at.progress.sigmas, provenance=at.progress.provenance))
    if len(at.progress.shots) >= at.shots and all(name in at.progress.lenses for name in cameras):
        at.keep(replace(at.progress, shots=()))  # an earlier calibration: it is made anew
    if not at.progress.shots:
        at.hands.away()
        at.keep(replace(at.progress, board=at.board, datums={name: _datums(at, name) for name in cameras}))
    places = board_places(at.device.setup, cameras, at.shots, at.board)
    try:
        for number in range(len(at.progress.shots), len(places)):
            _shown(at, cameras, places[number], number)
    finally:
        at.hands.away()
    return tuple(_lens(at, name) for name in cameras)


def board_places(setup: Setup, cameras: Sequence[str], count: int, board: Board) -> list[Array]:
    """Return poses (4, 4) at which the board is to be held: all of it seen by each camera in turn, and by another one
    if there is such a place, as the lab has the cameras; near and far, leaning every way."""
    import numpy as np

    random, nominal = np.random.default_rng(7), camera_models(setup)
    found: list[Array] = []
    width, depth = setup.lab.table.size
    for number in range(count):
        first, best = nominal[cameras[number % len(cameras)]], None
        for _ in range(400):
            around, lean = random.uniform(0, 2 * math.pi), random.uniform(0.25, 0.6)
            turn = rotation(np.array([math.cos(around), math.sin(around), 0.0]) * lean)
            turn = turn @ rotation(np.array([0.0, 0.0, random.uniform(-0.5, 0.5)]))
            place = random.uniform((0, 0, 60.0), (width, depth, 500.0))
            pose = motion(turn, place)
            if not _sees(first, pose, board):
                continue
            best = pose if best is None else best
            if len(cameras) < 2 or sum(_sees(nominal[name], pose, board) for name in cameras) > 1:
                best = pose
                break
        if best is None:
            text = f"there is no place over the table at which camera `{first.name}` would see all of the board"
            hint = "see `cameras` of the lab, or take a smaller board (`--square`)"
            raise PicoError(error("calibration-board", text, hint=hint, address=first.name))
        found.append(best)
    return found


def _sees(camera: CameraModel, pose: Array, board: Board) -> bool:
    import numpy as np

    half = np.array(board.size) / 2
    rim = np.array([(sx * half[0], sy * half[1], 0.0) for sx in (-1, 1) for sy in (-1, 1)])
    pixels = camera.project(rim @ pose[:3, :3].T + pose[:3, 3])
    toward = pose[:3, 2] @ (camera.pose[:3, 3] - pose[:3, 3]) / np.linalg.norm(camera.pose[:3, 3] - pose[:3, 3])
    return bool(toward > 0.6 and np.all((pixels > _INSIDE) & (pixels < np.array(camera.pixels) - _INSIDE)))


def request(pose: Array) -> str:
    """Return in words where the board is to be held."""
    x, y, z = pose[:3, 3]
    normal = pose[:3, 2]
    lean = math.degrees(math.acos(max(-1.0, min(1.0, float(normal[2])))))
    side = ("to the right", "away from you", "to the left", "toward you")
    way = side[round(math.atan2(normal[1], normal[0]) / (math.pi / 2)) % 4]
    place = f"its middle near x = {x:.0f}, y = {y:.0f} mm, {z:.0f} mm above the table"
    return f"{place}, facing {way} by about {lean:.0f} deg"


def _shown(at: AtTable, cameras: Sequence[str], pose: Array, number: int) -> None:
    """Have the board held at one place, and keep how the cameras see it."""
    text = f"Picture {number + 1} of {at.shots}: hold the board still, {request(pose)}"
    for _ in range(TRIES):
        if not at.hands.show(pose, at.board, text):
            raise Stopped
        frames = {name: at.wait(at.device.picture(name)) for name in cameras}
        views = {name: view for name, frame in frames.items() if (view := find_board(frame, at.board)) is not None}
        if not views:
            at.asks.say("  no camera sees the board: hold it so that all of it is in the picture")
            continue
        if len(cameras) > 1 and (moved := _moved(at, views)) > STILL:
            at.asks.say(f"  the board moved by {moved:.1f} pixels meanwhile: lean it against something")
            continue
        _taken(at, frames, views, number)
        return
    _taken(at, {}, {}, number)


def _moved(at: AtTable, views: Shot) -> float:
    """How far the board moved while the cameras took their pictures, as the first that sees it tells [pixels]."""
    import numpy as np

    name = next(iter(views))
    again = find_board(at.wait(at.device.picture(name)), at.board)
    if again is None:
        return float("inf")
    before = zip(views[name].corners.round(3), views[name].pixels, strict=True)
    first = {tuple(corner): pixel for corner, pixel in before}
    off = [pixel - first[key] for corner, pixel in zip(again.corners.round(3), again.pixels, strict=True)
           if (key := tuple(corner)) in first]  # fmt: skip
    return float(np.sqrt(np.mean(np.sum(np.square(off), axis=1)))) if off else float("inf")


def _taken(at: AtTable, frames: Mapping[str, Frame], views: Shot, number: int) -> None:
    at.keep(replace(at.progress, shots=(*at.progress.shots, dict(views))))
    for name, frame in frames.items():
        seen = [shot[name] for shot in at.progress.shots if name in shot]
        corners_drawn(frame.gray, [view.pixels for view in seen], at.pictures / f"intrinsics-{name}.png")
    seen_by = {name: sum(name in shot for shot in at.progress.shots) for name in at.device.setup.lab.cameras}
    counts = ", ".join(f"{name} {count}" for name, count in seen_by.items() if count)
    by = f"seen by {', '.join(sorted(views))}" if views else "seen by no camera"
    at.asks.say(f"  {number + 1}/{at.shots}: {by}; pictures so far: {counts or 'none'}")


def _datums(at: AtTable, camera: str) -> dict[int, Array]:
    found = detect(at.wait(at.device.picture(camera)))
    known = {datum.marker for datum in at.device.setup.lab.datums.values()}
    return {marker.number: marker.corners for marker in found.markers if marker.number in known}


def _lens(at: AtTable, name: str) -> str:
    """Find the lens of one camera, keep it, and return it in words."""
    views: list[BoardView] = [shot[name] for shot in at.progress.shots if name in shot]
    if len(views) < LEAST:  # what is kept would be too little the next time, too
        at.keep(replace(at.progress, shots=()))
    found = lens_of(views, camera_models(at.device.setup)[name])
    how = at.provenance(
        PROCEDURE, at.devices_of(name), residual=found.residual, held_out=found.held_out, unit="px",
        uncertainty=of_lens(found.camera, found.sigmas),
    )  # fmt: skip
    at.keep(replace(
        at.progress, lenses={**at.progress.lenses, name: found.camera},
        sigmas={**at.progress.sigmas, name: tuple(float(v) for v in found.sigmas)},
        provenance={**at.progress.provenance, f"intrinsics/{name}": how},
    ))  # fmt: skip
    fx, sigma = lens(found.camera)[0], found.sigmas[0]
    held = f"{found.held_out:.3f} px of pictures held out"
    fitted = f"{found.residual:.3f} px are left, {held}"
    return f"{name}: focal length {fx:.2f} ± {sigma:.2f} px by {len(views)} pictures, {fitted}"

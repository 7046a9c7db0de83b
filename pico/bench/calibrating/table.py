"""The step `extrinsics`: where the cameras over the table stand, by the datums, which are the frame of the table."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.bench.calibrating.at_table import AtTable
from pico.bench.calibrating.pictured import corners_drawn
from pico.diagnostics import PicoError, error
from pico.model.calibration.results import Provenance
from pico.vision.bundle import bundle
from pico.vision.camera import CameraModel
from pico.vision.datums import ENOUGH, SeenDatums, datum_corners, datums_in
from pico.vision.lens import LENS, lens, place_of
from pico.vision.markers import Markers, detect

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.frame import Frame

    Array = NDArray[np.float64]

PROCEDURE = "extrinsics/1"
ABOVE = "above_mm"
"""What the uncertainty of where all cameras together see the board that is held up is called."""
STILL = 0.5
"""How far datums may be seen apart since the board was shown [pixels]: beyond that, a camera was moved."""
LOOSE = {"f": 5.0, "c": 5.0, "k": 0.01, "p": 1e-3}
"""One standard deviation of the numbers of a lens of which none is said: focal lengths and principal point [pixels],
and coefficients of the distortion, by their first letter."""


@dataclass(frozen=True, eq=False)
class FoundCameras:
    """Cameras with lens and place, how each was found (`intrinsics/NAME`, `extrinsics/NAME`), what is left of corners
    by camera [pixels], how well a position on the table is known [mm], and one line for each camera."""

    cameras: Mapping[str, CameraModel]
    provenance: Mapping[str, Provenance]
    residuals: Mapping[str, float]
    position: float
    lines: tuple[str, ...]


def extrinsics(
    at: AtTable, cameras: Sequence[str], known: Mapping[str, tuple[CameraModel, Provenance]]
) -> FoundCameras:
    """Find where `cameras` stand. `known`: those whose lens is known, with how it was found. Raises PicoError."""
    frames = {name: at.wait(at.device.picture(name)) for name in cameras}
    seen = {name: detect(frame) for name, frame in frames.items()}
    without = [name for name in cameras if name not in known]
    if without:
        text = f"the lens of {', '.join(without)} is unknown"
        raise PicoError(error("calibration-lens", text, hint="do the step `intrinsics` first"))
    fresh = all(name in at.progress.lenses for name in cameras) and len(at.progress.shots) > 0
    if fresh and all(_stood(at, name, seen[name]) for name in cameras):
        found = _together(at, cameras, seen, known)
    else:
        at.asks.say("The cameras are placed by the datums alone: the board was not shown since they stand as they do.")
        found = _alone(at, cameras, seen, known)
    for name in cameras:
        _drawn(at, frames[name], seen[name], found.cameras[name])
    return found


def _stood(at: AtTable, name: str, now: Markers) -> bool:
    """Whether a camera sees the datums where it saw them when the board was shown."""
    import numpy as np

    before, after = at.progress.datums.get(name, {}), {marker.number: marker.corners for marker in now.markers}
    both = before.keys() & after.keys()
    return len(both) >= ENOUGH and max(float(np.abs(before[n] - after[n]).max()) for n in both) <= STILL


def _together(
    at: AtTable,
    cameras: Sequence[str],
    seen: Mapping[str, Markers],
    known: Mapping[str, tuple[CameraModel, Provenance]],
) -> FoundCameras:
    """By datums and board at once: the board ties the cameras to one another."""
    start = {name: known[name][0] for name in cameras}
    found = bundle(at.device.setup, at.progress.shots, seen, start)
    provenance, lines = dict[str, Provenance](), list[str]()
    for name in cameras:
        left, sigmas = found.residuals[name], found.sigmas[name]
        provenance[f"intrinsics/{name}"] = at.provenance(
            known[name][1].procedure, at.devices_of(name), residual=left, held_out=known[name][1].held_out, unit="px",
            uncertainty=of_lens(found.cameras[name], sigmas[:LENS]),
        )  # fmt: skip
        out = _held_out(at, seen[name], found.cameras[name], sigmas)
        provenance[f"extrinsics/{name}"] = at.provenance(
            PROCEDURE, at.devices_of(name), residual=left, held_out=out, unit="px",
            uncertainty=of_pose(sigmas[LENS:]) | ({ABOVE: found.above} if found.above else {}),
        )  # fmt: skip
        lines.append(_line(found.cameras[name], sigmas, left, out))
    return FoundCameras(found.cameras, provenance, found.residuals, found.position, tuple(lines))


def _alone(
    at: AtTable,
    cameras: Sequence[str],
    seen: Mapping[str, Markers],
    known: Mapping[str, tuple[CameraModel, Provenance]],
) -> FoundCameras:
    """Each camera by the datums that it sees, with the lens that it has."""
    placed, provenance, residuals, lines, worst = {}, dict[str, Provenance](), {}, list[str](), 0.0
    for name in cameras:
        camera, how = known[name]
        datums = _require_datums(at, name, seen[name], camera)
        found = place_of(at.device.setup, datums, camera, _sigmas_of(camera, how))
        out = _held_out(at, seen[name], found.camera, found.sigmas)
        placed[name], residuals[name] = found.camera, round(found.residual, 4)
        provenance[f"intrinsics/{name}"] = how
        provenance[f"extrinsics/{name}"] = at.provenance(
            PROCEDURE, at.devices_of(name), residual=found.residual, held_out=out, unit="px",
            uncertainty=of_pose(found.sigmas[-6:]),
        )  # fmt: skip
        worst = max(worst, found.position)
        lines.append(_line(found.camera, found.sigmas, found.residual, out))
    return FoundCameras(placed, provenance, residuals, worst, tuple(lines))


def _require_datums(at: AtTable, name: str, picture: Markers, camera: CameraModel) -> SeenDatums:
    datums = datums_in(at.device.setup, picture, camera)
    if len(datums.corners) < 4 * ENOUGH:
        text = f"camera `{name}` sees {len(datums.corners) // 4} datums; {ENOUGH} is the least"
        hint = f"the lab needs {ENOUGH} datums or more that every camera sees (`datums` of the Lab)"
        raise PicoError(error("calibration-datums", text, hint=hint, address=name))
    return datums


def _held_out(at: AtTable, picture: Markers, camera: CameraModel, sigmas: Array) -> float | None:
    """How far each datum is from where a camera has it that was placed by the others, root mean square [pixels]; None
    if too few would be left."""
    import numpy as np

    datums = datums_in(at.device.setup, picture, camera)
    if len(datums.corners) < 4 * (ENOUGH + 1):
        return None
    squares = []
    for i in range(len(datums.corners) // 4):
        placed, own = place_of(at.device.setup, datums.without(i), camera, sigmas[:-6]).camera, slice(4 * i, 4 * i + 4)
        squares.append(np.sum((placed.project(datums.corners[own]) - datums.pixels[own]) ** 2, axis=1))
    return float(np.sqrt(np.mean(squares)))


def names_of(camera: CameraModel) -> tuple[str, ...]:
    """Return what the numbers of a lens are called."""
    own = ("k1", "k2", "k3", "k4") if camera.fisheye else ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")
    return ("fx_px", "fy_px", "cx_px", "cy_px", *own[: len(camera.distortion)])


def of_lens(camera: CameraModel, sigmas: Array) -> dict[str, float]:
    """Return the uncertainties of the numbers of a lens by name."""
    return dict(zip(names_of(camera), (float(v) for v in sigmas), strict=True))


def _sigmas_of(camera: CameraModel, how: Provenance) -> Array:
    """One standard deviation of each number of a lens, as it was found; loose if that is not said."""
    import numpy as np

    return np.array([how.uncertainty.get(name, LOOSE[name[:1]]) for name in names_of(camera)])


def of_pose(sigmas: Array) -> dict[str, float]:
    """Return the uncertainties of place [mm] and turn [deg] of a camera by name; `sigmas` (6,): mm, rad."""
    names = ("x_mm", "y_mm", "z_mm", "turn_x_deg", "turn_y_deg", "turn_z_deg")
    return {
        name: float(v) * (1.0 if name.endswith("mm") else 180 / math.pi) for name, v in zip(names, sigmas, strict=True)
    }


def _line(camera: CameraModel, sigmas: Array, left: float, out: float | None) -> str:
    x, y, z = camera.pose[:3, 3]
    sx, sy, sz = sigmas[-6:-3]
    held = "" if out is None else f", {out:.3f} px of datums held out"
    return (f"{camera.name}: at ({x:.2f} ± {sx:.2f}, {y:.2f} ± {sy:.2f}, {z:.2f} ± {sz:.2f}) mm, focal length "
            f"{lens(camera)[0]:.2f} ± {sigmas[0]:.2f} px, {left:.3f} px are left{held}")  # fmt: skip


def _drawn(at: AtTable, frame: Frame, seen: Markers, camera: CameraModel) -> None:
    import numpy as np

    points = np.concatenate([datum_corners(datum) for datum in at.device.setup.lab.datums.values()])
    there = camera.project(points)
    pixels = [marker.corners for marker in seen.markers]
    corners_drawn(frame.gray, pixels, at.pictures / f"extrinsics-{camera.name}.png", [there[np.isfinite(there).all(1)]])

"""Cameras fixed above the table: lenses and places from pictures of the board and of the datums, all at once. mm.

Each picture of the board is taken by all cameras at one instant. The unknowns are nine numbers of each lens, six of
each camera and six of each pose of the board; the board ties cameras to one another, the datums tie them to the table.

How well corners are seen is not taken for known, but found from what the fit leaves: of each picture of the board
apart, as a board that leans or is far away is seen worse, and of the datums of each camera.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, error
from pico.model.setup import Setup
from pico.vision.camera import CameraModel
from pico.vision.charuco import BoardView
from pico.vision.datums import ENOUGH, SeenDatums, datums_in, resection
from pico.vision.least_squares import Solution, noise_by_group, solve
from pico.vision.lens import (
    CORNER_NOISE,
    FINEST,
    LEAST,
    LENS,
    LENS_STEPS,
    MISFIT,
    POSE_STEPS,
    intrinsics,
    lens,
    unsure,
    unsure_above,
    with_lens,
)
from pico.vision.markers import Markers
from pico.vision.rigid import moved

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_OUTLIER = 4.0  # times the median distance in its picture, from which a corner is left out
Shot = Mapping[str, BoardView]
"""The board as the cameras saw it at one instant, by camera."""


@dataclass(frozen=True, eq=False)
class Bundle:
    """Calibrated cameras; what is left of board and datum corners, by camera [pixels, root mean square]; what a camera
    being off by one standard deviation does to a position on the table [mm]; the board's pose (4, 4) on the table, by
    the number of the shot."""

    cameras: Mapping[str, CameraModel]
    residuals: Mapping[str, float]
    position: float
    boards: Mapping[int, Array]
    sigmas: Mapping[str, Array]
    """One standard deviation of each number of a camera (15,): nine of its lens, its place [mm], its turn [rad]."""
    above: float
    """One standard deviation [mm], in each direction, of where all cameras see the boards that were held up highest."""


def bundle(
    setup: Setup, shots: Sequence[Shot], datums: Mapping[str, Markers], start: Mapping[str, CameraModel]
) -> Bundle:
    """Return the cameras of `start` (as the lab says they are) as pictures of the board and of the datums have them.

    `datums`: a picture of the table by each camera. Raises PicoError where a camera saw too little.
    """
    import numpy as np

    seen = {name: datums_in(setup, datums[name], start[name]) for name in start}
    _refuse(shots, seen)
    cameras: dict[str, CameraModel] = {}
    boards: dict[int, Array] = {}
    for name, camera in start.items():
        numbers = [i for i, shot in enumerate(shots) if name in shot]
        ready, poses = intrinsics([shots[i][name] for i in numbers], camera)
        cameras[name] = replace(ready, pose=resection(seen[name].corners, seen[name].pixels, ready).pose)
        seen[name] = datums_in(setup, datums[name], cameras[name])
        boards.update({i: cameras[name].pose @ p for i, p in zip(numbers, poses, strict=True) if i not in boards})
    problem = _Problem(cameras, boards, shots, seen, _groups(cameras, boards, shots, seen))
    steps = [*(LENS_STEPS + POSE_STEPS) * len(cameras), *POSE_STEPS * len(boards)]
    found = solve(problem.residuals, np.zeros(len(steps)), np.array(steps), rounds=30)
    problem = problem.without_outliers(found)
    found = solve(problem.residuals, found.parameters, np.array(steps), rounds=30)
    problem = problem.with_noise(found)
    found = solve(problem.residuals, found.parameters, np.array(steps), rounds=30)
    fitted, held = problem.at(found.parameters)
    residuals = problem.left(found)
    _refuse_misfit(residuals)
    return Bundle(
        fitted, residuals, _position(setup, fitted, found), held, _sigmas(fitted, found), _above(fitted, held, found)
    )


def _refuse_misfit(residuals: Mapping[str, float]) -> None:
    hint = "make the calibration again, with the board flat, printed to scale and all of it in the pictures"
    wrong = [
        error("calibration-fit", f"no lens explains what camera `{name}` saw: corners are {left:.3g} pixels off",
              hint=hint, address=name)
        for name, left in residuals.items()
        if not left < MISFIT
    ]  # fmt: skip
    if wrong:
        raise PicoError(wrong)


@dataclass(frozen=True, eq=False)
class _Groups:
    """What is seen equally well: by camera the group (2 n,) of each number that `_Problem._seen` returns; the kind of
    each group, 0 of datums and 1 of the board; its noise, of the board [pixels], of datums as a share of what is said
    of them."""

    of: Mapping[str, Array]
    kinds: Array
    noise: Array


def _groups(
    cameras: Mapping[str, CameraModel],
    boards: Mapping[int, Array],
    shots: Sequence[Shot],
    seen: Mapping[str, SeenDatums],
) -> _Groups:
    """Group 0 are the middles of all datums, of which there are few; the shapes of those of each camera are one, and so
    is each picture of the board."""
    import numpy as np

    of: dict[str, Array] = {}
    kinds = [0]
    for name in cameras:
        rows = [np.tile((0, 0, *(len(kinds),) * 6), len(seen[name].corners) // 4)]
        kinds.append(0)
        for number in boards:
            if name in shots[number]:
                rows.append(np.full(2 * len(shots[number][name].corners), len(kinds)))
                kinds.append(1)
        of[name] = np.concatenate(rows)
    return _Groups(of, np.array(kinds), np.where(np.array(kinds) == 0, 1.0, CORNER_NOISE))


@dataclass(frozen=True, eq=False)
class _Problem:
    cameras: Mapping[str, CameraModel]
    boards: Mapping[int, Array]
    shots: Sequence[Shot]
    datums: Mapping[str, SeenDatums]
    groups: _Groups
    weights: Mapping[str, Array] = field(default_factory=dict)
    """By camera 1 for each corner (n,) that counts, 0 for the others; all of them without."""

    def at(self, change: Array) -> tuple[dict[str, CameraModel], dict[int, Array]]:
        """Return cameras and poses of the board, changed by the parameters."""
        each, cameras = LENS + 6, {}
        for i, (name, camera) in enumerate(self.cameras.items()):
            part = change[i * each : (i + 1) * each]
            placed = replace(camera, pose=moved(camera.pose, part[LENS:]))
            cameras[name] = with_lens(placed, lens(camera) + part[:LENS])
        rest = change[len(cameras) * each :].reshape(-1, 6)
        return cameras, {n: moved(pose, part) for (n, pose), part in zip(self.boards.items(), rest, strict=True)}

    def residuals(self, change: Array) -> Array:
        import numpy as np

        cameras, boards = self.at(change)
        return np.concatenate([self._seen(camera, boards) for camera in cameras.values()])

    def _seen(self, camera: CameraModel, boards: Mapping[int, Array]) -> Array:
        """How far (2 n,) corners are off by their noise."""
        import numpy as np

        off, datums = self._off(camera, boards), self.datums[camera.name]
        if camera.name in self.weights:
            off = off * self.weights[camera.name][:, None]
        count = len(datums.corners)
        every = np.concatenate([datums.whitened(off[:count]), off[count:].ravel()])
        scaled: Array = every / self.groups.noise[self.groups.of[camera.name]]
        return scaled

    def without_outliers(self, found: Solution) -> _Problem:
        """Return the problem with corners left out that are far off: covered in part, or cut by the picture's edge; a
        datum as a whole."""
        import numpy as np

        cameras, boards = self.at(found.parameters)
        weights = {}
        for name, camera in cameras.items():
            off, count = np.linalg.norm(self._off(camera, boards), axis=1), len(self.datums[name].corners)
            good, group = np.ones(len(off), bool), self.groups.of[name][::2].copy()
            group[:count] = -1  # all datums are one picture
            for one in np.unique(group):
                here = group == one
                good[here] = off[here] < _OUTLIER * max(float(np.median(off[here])), 0.01)
            good[:count] = np.repeat(good[:count].reshape(-1, 4).all(axis=1), 4)
            weights[name] = good.astype(np.float64)
        return replace(self, weights=weights)

    def with_noise(self, found: Solution) -> _Problem:
        """Return the problem with the noise that the residuals of a fit show."""
        import numpy as np

        every = np.concatenate([self.groups.of[name] for name in self.cameras])
        noise = noise_by_group(found, self.groups.noise, every, self.groups.kinds)
        noise = np.maximum(noise, np.where(self.groups.kinds == 0, FINEST / CORNER_NOISE, FINEST))
        return replace(self, groups=replace(self.groups, noise=noise))

    def _off(self, camera: CameraModel, boards: Mapping[int, Array]) -> Array:
        """How far (n, 2) [pixels] the corners of datums and boards are from where they should be."""
        import numpy as np

        points, pixels = [self.datums[camera.name].corners], [self.datums[camera.name].pixels]
        for number, pose in boards.items():
            view = self.shots[number].get(camera.name)
            if view is not None:
                points.append(view.corners @ pose[:3, :3].T + pose[:3, 3])
                pixels.append(view.pixels)
        off = camera.project(np.concatenate(points)) - np.concatenate(pixels)
        return np.nan_to_num(off, nan=1e3)

    def left(self, found: Solution) -> dict[str, float]:
        import numpy as np

        cameras, boards = self.at(found.parameters)
        squares = {name: np.sum(self._off(camera, boards) ** 2, axis=1) for name, camera in cameras.items()}
        return {
            name: round(float(np.sqrt(np.average(each, weights=self.weights.get(name)))), 4)
            for name, each in squares.items()
        }


def _sigmas(cameras: Mapping[str, CameraModel], found: Solution) -> dict[str, Array]:
    import numpy as np

    each = (LENS + 6) * len(cameras)
    sigmas = np.sqrt(np.maximum(np.diag(found.covariance)[:each], 0.0))
    return dict(zip(cameras, sigmas.reshape(len(cameras), LENS + 6), strict=True))


def _position(setup: Setup, cameras: Mapping[str, CameraModel], found: Solution) -> float:
    """Return what the uncertainty of lens and pose does to a position over the table [mm], by the worst camera."""
    import numpy as np

    worst, each, steps = 0.0, LENS + 6, np.array(LENS_STEPS + POSE_STEPS)
    for i, camera in enumerate(cameras.values()):
        block = found.covariance[i * each : (i + 1) * each, i * each : (i + 1) * each]
        near = [_shifted(camera, step) for step in np.diag(steps)]
        worst = max(worst, unsure(setup, camera, near, steps, block))
    return worst


def _above(cameras: Mapping[str, CameraModel], boards: Mapping[int, Array], found: Solution) -> float:
    import numpy as np

    every, steps = list(cameras.values()), np.array(LENS_STEPS + POSE_STEPS)
    near = [[_shifted(camera, step) for step in np.diag(steps)] for camera in every]
    points = np.array([board[:3, 3] for board in boards.values()])
    points = points[points[:, 2] >= np.median(points[:, 2])]  # as high as arms hold the board
    if len(every) < 2:  # along its ray a single camera knows a board by its size
        return 0.0
    block = found.covariance[: len(steps) * len(every), : len(steps) * len(every)]
    return unsure_above(points, every, near, steps, block)


def _shifted(camera: CameraModel, change: Array) -> CameraModel:
    return with_lens(replace(camera, pose=moved(camera.pose, change[LENS:])), lens(camera) + change[:LENS])


def _refuse(shots: Sequence[Shot], seen: Mapping[str, SeenDatums]) -> None:
    wrong = []
    for name, datums in seen.items():
        count = sum(name in shot for shot in shots)
        if count < LEAST:
            hint = "show the board at more places and tilts, all of it in the picture"
            summary = f"camera `{name}` sees the board in {count} pictures; {LEAST} is the least"
            wrong.append(error("calibration-board", summary, hint=hint, address=name))
        if len(datums.corners) < 4 * ENOUGH:
            hint = f"the lab needs {ENOUGH} datums or more that every camera sees (`datums` of the Lab)"
            summary = f"camera `{name}` sees {len(datums.corners) // 4} datums; {ENOUGH} is the least"
            wrong.append(error("calibration-datums", summary, hint=hint, address=name))
    if wrong:
        raise PicoError(wrong)

"""Where a camera sits in a robot's hand: hand-eye calibration. mm, rad.

The board lies still while the hand looks at it from several poses T_i (of the tool in the table's frame). With the
camera at X in the tool's frame and the board at C_i in the camera's, T_i X C_i is the same for all i, so that for two
of them A X = X B with A = T_j^-1 T_i, B = C_j C_i^-1. Rotations first, then shifts: F. C. Park and B. J. Martin, IEEE
Trans. Robotics and Automation 10, 717 (1994); then what the pictures show is fitted itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, error
from pico.vision.camera import CameraModel
from pico.vision.charuco import BoardView
from pico.vision.least_squares import solve
from pico.vision.lens import CORNER_NOISE, LEAST, LENS, LENS_STEPS, POSE_STEPS, intrinsics, lens, with_lens
from pico.vision.rigid import best_motion, motion, moved, rotation_vector

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_TURN = 0.15  # rad: pairs of poses that are turned less say little


@dataclass(frozen=True, eq=False)
class HandEye:
    """The camera, its pose in the tool's frame; the board's pose (4, 4) on the table [mm]; what is left [pixels]."""

    camera: CameraModel
    board: Array
    residual: float


def park_martin(tools: Sequence[Array], boards: Sequence[Array]) -> Array:
    """Return the pose (4, 4) of the camera in the tool's frame [mm].

    `tools`: poses of the tool (4, 4) in the table's frame; `boards`: of the board in the camera's frame. Raises
    PicoError where the hand turned about fewer than two axes.
    """
    import numpy as np

    inverse = np.linalg.inv
    pairs = [
        (inverse(tools[j]) @ tools[i], boards[j] @ inverse(boards[i])) for i, j in combinations(range(len(tools)), 2)
    ]
    vectors = [(a, b, rotation_vector(a[:3, :3]), rotation_vector(b[:3, :3])) for a, b in pairs]
    turned = [(a, b, u, v) for a, b, u, v in vectors if np.linalg.norm(u) > _TURN]
    axes = np.array([u for _, _, u, _ in turned]).reshape(-1, 3)
    if len(turned) < 2 or np.linalg.svd(axes, compute_uv=False)[1] < 0.2 * len(axes) ** 0.5:
        hint = "look at the board from poses that are turned about two axes, by 10 deg and more"
        raise PicoError(error("calibration-hand", "the hand turned too little to tell where its camera is", hint=hint))
    both = np.concatenate([axes, -axes]), np.concatenate([[v for *_, v in turned], [-v for *_, v in turned]])
    turn = best_motion(both[1], both[0])[:3, :3]
    left = np.concatenate([a[:3, :3] - np.eye(3) for a, *_ in turned])
    right = np.concatenate([turn @ b[:3, 3] - a[:3, 3] for a, b, *_ in turned])
    return motion(turn, np.linalg.lstsq(left, right, rcond=None)[0])


def hand_eye(
    views: Sequence[BoardView], tools: Sequence[Array], start: CameraModel, lies: Array | None = None
) -> HandEye:
    """Return the camera in the hand as pictures of a board that lies still have it.

    `tools`: pose (4, 4) of the tool in the table's frame [mm] for each picture; `start`: the camera as the lab says;
    `lies`: where the board lies, as cameras over the table see it. Without that it is found, too, much less surely: it
    is told from where the camera sits only by how the hand turns. Raises PicoError where there are too few pictures, or
    the hand turned too little.
    """
    import numpy as np

    if len(views) < LEAST:
        summary = f"camera `{start.name}` sees the board in {len(views)} pictures; {LEAST} is the least"
        raise PicoError(error("calibration-board", summary, hint="look at it from more poses", address=start.name))
    ready, boards = intrinsics(views, start)
    mount = park_martin(tools, boards)
    there = tools[0] @ mount @ boards[0] if lies is None else lies

    def parts(change: Array) -> tuple[CameraModel, Array]:
        camera = replace(with_lens(ready, lens(ready) + change[:LENS]), pose=moved(mount, change[LENS : LENS + 6]))
        return camera, moved(there, change[LENS + 6 :]) if lies is None else there

    def residuals(change: Array) -> Array:
        camera, board = parts(change)
        off = [
            replace(camera, pose=tool @ camera.pose).project(view.corners @ board[:3, :3].T + board[:3, 3])
            - view.pixels
            for view, tool in zip(views, tools, strict=True)
        ]
        return np.nan_to_num(np.concatenate(off), nan=1e3).ravel() / CORNER_NOISE

    steps = np.array(LENS_STEPS + POSE_STEPS + (POSE_STEPS if lies is None else ()))
    found = solve(residuals, np.zeros(len(steps)), steps)
    camera, board = parts(found.parameters)
    return HandEye(camera, board, found.rms * CORNER_NOISE * 2**0.5)


PARTS = 8
"""Into how many parts pictures are divided, each of which is left out once."""


def scattered(
    views: Sequence[BoardView], tools: Sequence[Array], start: CameraModel, lies: Array | None, found: HandEye
) -> tuple[Array, float]:
    """Return one standard deviation of each number of a camera in a hand (15,), nine of its lens, its place [mm] and
    its turn [rad], and how far corners are off in pictures that a fit did not use, root mean square [pixels].

    What is off is off in a whole picture, with the arm that took it there; so pictures are left out, not corners
    (jackknife of groups: R. G. Miller, Biometrika 61, 1 (1974)). Arguments as of `hand_eye`, which `found` it.
    """
    import numpy as np

    numbers: list[Array] = []
    squares: list[Array] = []
    parts = min(PARTS, len(views) // 2)
    for part in range(parts):
        kept = [i for i in range(len(views)) if i % parts != part]
        one = hand_eye([views[i] for i in kept], [tools[i] for i in kept], start, lies)
        turn = rotation_vector(one.camera.pose[:3, :3] @ found.camera.pose[:3, :3].T)
        numbers.append(np.concatenate([lens(one.camera), one.camera.pose[:3, 3], turn]))
        for i in range(part, len(views), parts):
            points = views[i].corners @ one.board[:3, :3].T + one.board[:3, 3]
            off = replace(one.camera, pose=tools[i] @ one.camera.pose).project(points) - views[i].pixels
            squares.append(np.sum(off**2, axis=1))
    spread = np.var(np.array(numbers), axis=0) * (parts - 1)
    return np.sqrt(spread), float(np.sqrt(np.mean(np.concatenate(squares))))

"""The pictures that a calibration needs, by the simulated cameras: the board held up, and lying under the hand."""

from __future__ import annotations

import math
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from pico.cameras.board import board_sheet, datum_sheets, photograph_sheets
from pico.model.lab import Setup
from pico.model.pose import Pose
from pico.vision.bundle import bundle
from pico.vision.calibration import Accuracy, Calibration
from pico.vision.camera import CameraModel
from pico.vision.charuco import BoardView, find_board
from pico.vision.hand_eye import hand_eye
from pico.vision.markers import detect
from pico.vision.nominal import camera_models, looking
from pico.vision.rigid import motion, rotation, upright

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SHOTS = 56
"""Poses of the board before the fixed cameras."""
GLANCES = 14
"""Poses from which a hand looks at the board."""


def calibrate(setup: Setup, true: Mapping[str, CameraModel], seed: int) -> Calibration:
    """Return what calibration finds of the cameras `true` of a simulated bench, from pictures of board and datums.

    Raises PicoError where the lab lacks datums, or a camera sees too little.
    """
    import numpy as np

    random = np.random.default_rng((seed, 3))
    nominal = camera_models(setup)
    fixed = {name: camera for name, camera in nominal.items() if camera.robot is None}
    cameras: dict[str, CameraModel] = {}
    residuals: dict[str, float] = {}
    position = 0.0
    if fixed:
        views = [_shot(setup, {n: true[n] for n in fixed}, random) for _ in range(SHOTS)]
        table = {n: detect(_photo(setup, true[n], None, random)) for n in fixed}
        found = bundle(setup, views, table, fixed)
        cameras.update(found.cameras)
        residuals.update(found.residuals)
        position = found.position
    for name in sorted(nominal.keys() - fixed.keys()):
        seen, tools = _glances(setup, true[name], random)
        eye = hand_eye(seen, tools, nominal[name])
        cameras[name], residuals[name] = eye.camera, eye.residual
    made = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    accuracy = Accuracy(position=max(0.02, round(position, 3)))
    return Calibration(cameras, accuracy, residuals, made)


def _photo(setup: Setup, camera: CameraModel, board: Array | None, random: Any) -> Any:
    sheets = [*datum_sheets(setup), *([board_sheet(board)] if board is not None else [])]
    return photograph_sheets(camera, sheets, setup.lab.cameras[camera.name], random)


def _shot(setup: Setup, cameras: Mapping[str, CameraModel], random: Any) -> dict[str, BoardView]:
    """The board at a random place above the table, turned and tilted, as all fixed cameras see it."""
    import numpy as np

    width, depth = setup.lab.table.size
    around, lean = random.uniform(0, 2 * math.pi), random.uniform(0.4, 0.85)
    turn = rotation(np.array([math.cos(around), math.sin(around), 0.0]) * lean)
    turn = turn @ rotation(np.array([0.0, 0.0, random.uniform(0, 2 * math.pi)]))
    across, along, above = random.uniform(0.15, 0.85), random.uniform(0.15, 0.85), random.uniform(100, 700)
    pose = motion(turn, np.array([across * width, along * depth, above]))
    views = {name: find_board(_photo(setup, camera, pose, random)) for name, camera in cameras.items()}
    return {name: view for name, view in views.items() if view is not None}


def _glances(setup: Setup, camera: CameraModel, random: Any) -> tuple[list[BoardView], list[Array]]:
    """The board on the table as a hand sees it from several poses, and the pose of the tool for each."""
    import numpy as np

    width, depth = setup.lab.table.size
    middle = np.array([width / 2, depth / 2, 0.0])
    board = upright(Pose(width / 2, depth / 2, 20.0), 0.0)
    views, tools = [], []
    for _ in range(GLANCES):
        eye = middle + random.uniform((-150, -150, 260), (150, 150, 420))
        target = middle + random.uniform((-20, -20, 0), (20, 20, 0))
        tool = looking(eye, target, random.uniform(-40, 40)) @ np.linalg.inv(camera.pose)
        view = find_board(_photo(setup, camera.placed(tool), board, random))
        if view is not None:
            views.append(view)
            tools.append(tool)
    return views, tools

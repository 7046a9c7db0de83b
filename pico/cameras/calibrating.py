"""The pictures that a calibration needs, by the simulated cameras: the board held up by a person and by arms, and lying
under the hands' eyes. Joints are read from encoders."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from pico.base import clock
from pico.cameras.board import board_sheet, datum_sheets, photograph_sheets
from pico.cameras.postures import Rests, postures, rests, seen_by
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.built.fitting import SLACK, fitted, grip
from pico.motion.built.poses import reached
from pico.twin.arms import TwinArm, arms_of
from pico.vision.arm import NOMINAL, ArmOffsets, FoundArm
from pico.vision.bundle import bundle
from pico.vision.calibration import Accuracy, Calibration
from pico.vision.camera import CameraModel
from pico.vision.charuco import BoardView, find_board
from pico.vision.hand_eye import hand_eye
from pico.vision.markers import detect
from pico.vision.nominal import camera_models
from pico.vision.rigid import motion, moved, rotation, upright

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SHOTS = 56
"""Poses of the board before the fixed cameras."""
HELD = 24
"""Those of them in which an arm holds it; each arm, of several."""
TAKES = 3
"""How often an arm takes it in these: what the board sits askew in the hand is another each time."""
GLANCES = 24
"""Poses from which a hand looks at the board."""
_AWAY = 330.0
"""How far from an arm's base the board lies that its hand looks at [mm]."""


def calibrate(
    setup: Setup, true: Mapping[str, CameraModel], seed: int, built: Mapping[str, ArmOffsets] | None = None
) -> Calibration:
    """Return what calibration finds of the cameras `true` of a simulated bench and of its arms, from pictures of board
    and datums and from encoders. `built`: how these arms differ from the lab's; by its errors and `seed` where None.

    Raises PicoError where the lab lacks datums, or a camera sees too little.
    """
    import numpy as np

    random = np.random.default_rng((seed, 3))
    arms = {n: replace(a, built=(built or {}).get(n, a.built)) for n, a in arms_of(setup, seed).items()}
    nominal = camera_models(setup)
    over = {name: camera for name, camera in nominal.items() if camera.robot is None}
    lying = {camera.robot: _lying(setup, camera.robot) for camera in nominal.values() if camera.robot}
    found = _from_above(setup, over, true, arms, lying, random) if over else _FromAbove()
    cameras, residuals = dict(found.cameras), dict(found.residuals)
    for name in sorted(nominal.keys() - over.keys()):
        robot = nominal[name].robot or ""
        offsets = found.arms[robot].offsets if robot in found.arms else NOMINAL
        views, tools = _glances(setup, arms[robot], robot, (nominal[name], true[name]), offsets, random)
        eye = hand_eye(views, tools, nominal[name], found.lying.get(robot))
        cameras[name], residuals[name] = eye.camera, eye.residual
    made = clock.now()
    accuracy = Accuracy(position=max(0.02, round(found.position, 3)))
    return Calibration(cameras, accuracy, residuals, made, found.arms)


@dataclass(frozen=True, eq=False)
class _FromAbove:
    """What cameras over the table tell: themselves, how surely [mm], the arms, and where the boards lie (4, 4) at which
    hands look, by robot."""

    cameras: Mapping[str, CameraModel] = field(default_factory=dict)
    residuals: Mapping[str, float] = field(default_factory=dict)
    position: float = 0.0
    arms: Mapping[str, FoundArm] = field(default_factory=dict)
    lying: Mapping[str, Array] = field(default_factory=dict)


def _from_above(
    setup: Setup,
    over: Mapping[str, CameraModel],
    true: Mapping[str, CameraModel],
    arms: Mapping[str, TwinArm],
    lying: Mapping[str, Array],
    random: Any,
) -> _FromAbove:
    held = {name: _held(setup, name, arm, list(over.values()), random) for name, arm in arms.items()}
    boards = [*lying.values(), *(pose for rest in held.values() for pose in rest.tools @ _taken(random)[_takes(rest)])]
    boards += [_by_person(setup, random) for _ in range(max(HELD, SHOTS - len(boards)))]
    views = [_shot(setup, {n: true[n] for n in over}, board, random) for board in boards]
    table = {n: detect(_photo(setup, true[n], None, random)) for n in over}
    seen = bundle(setup, views, table, over)
    first, found = len(lying), {}
    for name, rest in held.items():
        found[name] = _arm(setup, name, rest, {i: seen.boards.get(first + i) for i in range(len(rest.read))})
        first += len(rest.read)
    lies = {robot: seen.boards[i] for i, robot in enumerate(lying) if i in seen.boards}
    return _FromAbove(seen.cameras, seen.residuals, seen.position, found, lies)


def _arm(setup: Setup, name: str, rest: Rests, boards: Mapping[int, Array | None]) -> FoundArm:
    """An arm by the boards in its hand, as the cameras see these in each posture, if they do."""
    import numpy as np

    shown = [i for i, board in boards.items() if board is not None]
    there = np.array([boards[i] for i in shown]).reshape(-1, 4, 4)
    return fitted(name, setup.lab.robots[name], rest.read[shown], there, [_takes(rest)[i] for i in shown])


def _photo(setup: Setup, camera: CameraModel, board: Array | None, random: Any) -> Any:
    sheets = [*datum_sheets(setup), *([board_sheet(board)] if board is not None else [])]
    return photograph_sheets(camera, sheets, setup.lab.cameras[camera.name], random)


def _shot(setup: Setup, cameras: Mapping[str, CameraModel], board: Array, random: Any) -> dict[str, BoardView]:
    """The board at a pose (4, 4) as all fixed cameras see it."""
    views = {name: find_board(_photo(setup, camera, board, random)) for name, camera in cameras.items()}
    return {name: view for name, view in views.items() if view is not None}


def _by_person(setup: Setup, random: Any) -> Array:
    """The pose (4, 4) of the board at a random place above the table, turned and tilted."""
    import numpy as np

    width, depth = setup.lab.table.size
    around, lean = random.uniform(0, 2 * math.pi), random.uniform(0.4, 0.85)
    turn = rotation(np.array([math.cos(around), math.sin(around), 0.0]) * lean)
    turn = turn @ rotation(np.array([0.0, 0.0, random.uniform(0, 2 * math.pi)]))
    across, along, above = random.uniform(0.15, 0.85), random.uniform(0.15, 0.85), random.uniform(100, 700)
    return motion(turn, np.array([across * width, along * depth, above]))


def _held(setup: Setup, name: str, arm: TwinArm, cameras: Sequence[CameraModel], random: Any) -> Rests:
    """An arm that holds the board where two cameras see it, as far as the lab tells where they are."""
    least = min(2, len(cameras))
    joints = postures(setup, name, HELD, lambda tool: seen_by(cameras, tool @ grip()) >= least, random)
    return rests(arm, joints, random)


def _taken(random: Any) -> Array:
    """The pose (4, 4) of the board in the tool's frame, each time that a hand takes it."""
    import numpy as np

    sigmas = np.repeat((SLACK[0], math.radians(SLACK[1])), 3)
    return np.array([moved(np.eye(4), random.normal(0.0, sigmas)) @ grip() for _ in range(TAKES)])


def _takes(rest: Rests) -> list[int]:
    """How often the board had been taken again, by posture."""
    return [i * TAKES // len(rest.read) for i in range(len(rest.read))]


def _glances(
    setup: Setup,
    arm: TwinArm,
    name: str,
    eyes: tuple[CameraModel, CameraModel],
    offsets: ArmOffsets,
    random: Any,
) -> tuple[list[BoardView], list[Array]]:
    """The board on the table as a hand sees it from several poses, and the pose of the tool for each, as an arm with
    `offsets` has it. `eyes`: the camera in the hand as the lab has it, and as it is."""

    nominal, true = eyes
    board = _lying(setup, name)
    joints = postures(setup, name, GLANCES, lambda tool: seen_by([nominal.placed(tool)], board) == 1, random)
    rest = rests(arm, joints, random)
    views = [find_board(_photo(setup, true.placed(tool), board, random)) for tool in rest.tools]
    shown = [i for i, view in enumerate(views) if view is not None]
    tools = reached(setup.lab.robots[name], rest.read[shown], offsets).tools
    return [view for view in views if view is not None], list(tools)


def _lying(setup: Setup, robot: str) -> Array:
    """The pose (4, 4) of the board where it lies under an arm, towards the middle of the table."""
    (width, depth), mount = setup.lab.table.size, setup.lab.robots[robot].mount
    away = math.hypot(width / 2 - mount.x, depth / 2 - mount.y) or 1.0
    share = min(1.0, _AWAY / away)
    middle = mount.x + share * (width / 2 - mount.x), mount.y + share * (depth / 2 - mount.y)
    return upright(Pose(*middle, 20.0), 0.0)

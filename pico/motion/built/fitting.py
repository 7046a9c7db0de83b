"""How an arm is built, from where fixed cameras see the board in its hand. mm, rad.

In posture i its encoders read q_i and the cameras see the board at B_i. With T the tool's pose by the arm's offsets and
G the board's in the hand, T(q_i) G = B_i. Mount, joint zeros, tool and what G is off each time that the board is taken
are fitted at once. Some of them cannot be told apart (the mount's yaw and the zero of joint 1, the tool and the grip):
what each usually is off decides, and no pose of the tool depends on it but by what the grips are off on average.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.model.robot import Robot
from pico.motion.built.poses import reached
from pico.vision.arm import ArmOffsets, FoundArm
from pico.vision.least_squares import Solution, solve
from pico.vision.rigid import motion, rotation

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

GRIP = (-130.0, 0.0, 0.0)
"""Where the middle of the board is in the tool's frame [mm], away from the eye; it lies level, its print up, its upper
edge next to the hand."""
SLACK = (0.05, 0.05)
"""How well a hand takes the board by its block, one sigma of each of position [mm] and turn [deg]."""
LEAST = 12
"""Postures that it takes."""
MISFIT = 1.0
"""A board that is farther than this from where the arm has it [mm, root mean square] is held by no such arm."""
_USUAL = (3.0,) * 3 + (0.5,) * 3 + (0.3,) * 7 + (1.0,) * 3
"""One sigma of what is looked for: mount [mm, deg], zeros [deg], tool [mm]."""
_ARM = len(_USUAL)
_SEEN = (0.05, 0.01)
"""One sigma of the board's position [mm] and turn [deg] where an arm that rests holds it."""


def grip() -> Array:
    """Return the pose (4, 4) of the board in the tool's frame."""
    import numpy as np

    return motion(np.array(((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0))), np.array(GRIP))


def fitted(name: str, robot: Robot, joints: Array, boards: Array, takes: Sequence[int]) -> FoundArm:
    """Return how the arm `name` is built whose encoders read `joints` (n, 7) where cameras saw the board in its hand at
    `boards` (n, 4, 4), in the table's frame; `takes`: how often it had been set down and taken again by then.

    Raises PicoError where these are few, or fit no arm.
    """
    import numpy as np

    if len(joints) < LEAST:
        summary = f"the cameras see the board in {name}'s hand in {len(joints)} postures; {LEAST} is the least"
        raise PicoError(error("calibration-board", summary, hint="hold it where they see all of it", address=name))
    seen = 1 / np.repeat((_SEEN[0], math.radians(_SEEN[1])), 3)

    def off(numbers: Array) -> Array:
        """How far (n, 6) [mm, rad] boards are from where an arm has them."""
        grips = np.array([_moved(part) @ grip() for part in numbers[_ARM:].reshape(-1, 6)])
        here = reached(robot, joints, _offsets(numbers)).tools @ grips[list(takes)]
        spin = boards[:, :3, :3] @ here[:, :3, :3].swapaxes(1, 2)
        turn = np.stack((spin[:, 2, 1] - spin[:, 1, 2], spin[:, 0, 2] - spin[:, 2, 0], spin[:, 1, 0] - spin[:, 0, 1]))
        return np.concatenate((boards[:, :3, 3] - here[:, :3, 3], turn.T / 2), axis=1)

    usual = np.concatenate((_USUAL, np.tile(np.repeat(SLACK, 3), max(takes) + 1)))
    found = solve(lambda n: np.concatenate(((off(n) * seen).ravel(), n / usual)), 0 * usual, usual / 100)
    left = np.sqrt(np.mean(off(found.parameters) ** 2, axis=0))
    away = float(np.linalg.norm(left[:3]))
    if not away < MISFIT:
        text = f"no mount, zeros and tool explain where {name} held the board: {away:.3g} mm are left"
        hint = "see that its block sits in the fingers as it should, and make the calibration again"
        raise PicoError(error("calibration-fit", text, hint=hint, address=name))
    unsure = _unsure(robot, joints, found)
    position, turn = (float(np.sqrt(np.mean(left[part] ** 2 + unsure[part]))) for part in (slice(3), slice(3, 6)))
    offsets = _offsets(found.parameters, 6)
    return FoundArm(offsets=offsets, position=round(position, 3), turn=round(math.degrees(turn), 4))


def _unsure(robot: Robot, joints: Array, found: Solution) -> Array:
    """The variance (6,) of the tool's pose [mm2, rad2] by that of what was found, over the postures."""
    import numpy as np

    def poses(numbers: Array) -> Array:
        return reached(robot, joints, _offsets(numbers)).tools

    here, columns = poses(found.parameters), []
    for step in np.diag(np.array(_USUAL) / 100):
        there = poses(found.parameters[:_ARM] + step)
        spin = there[:, :3, :3] @ here[:, :3, :3].swapaxes(1, 2)
        turn = np.stack((spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]), axis=1)
        columns.append(np.concatenate((there[:, :3, 3] - here[:, :3, 3], turn), axis=1) / step.sum())
    jacobian = np.stack(columns, axis=-1)  # (n, 6, parameters)
    covariance = found.covariance[:_ARM, :_ARM] * max(1.0, found.rms) ** 2
    return np.einsum("nij,jk,nik->i", jacobian, covariance, jacobian) / len(joints)  # type: ignore[no-any-return]


def _moved(numbers: Array) -> Array:
    """The motion (4, 4) by a shift [mm] and a rotation vector [deg]."""
    import numpy as np

    return motion(rotation(np.radians(numbers[3:])), numbers[:3])


def _offsets(numbers: Array, digits: int | None = None) -> ArmOffsets:
    plain: Any = tuple(float(n) if digits is None else round(float(n), digits) for n in numbers)
    return ArmOffsets(shift=plain[:3], turn=plain[3:6], zeros=plain[6:13], tool=plain[13:16])

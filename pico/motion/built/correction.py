"""What the joints of an arm are told so that its tool goes where a nominal arm would have it. rad.

Plans, and all that reads joints, know the arm as the lab describes it: its inverse kinematics has a closed form, and
plans stay what they are when the arm is calibrated again. Only where joints are told to a motor or read from an encoder
is the arm put right: by the least change of all seven joints that brings the tool to the same pose (damped least
squares: Y. Nakamura and H. Hanafusa, J. Dyn. Sys. Meas. Control 108, 163 (1986)).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pico.model.robot import Robot
from pico.motion.built.poses import reached
from pico.motion.xarm7 import LIMITS
from pico.vision.arm import ArmOffsets

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_ROUNDS = 5
_CLOSE = 1e-7  # rad, and shares of _ARM, to which a tool is brought
_ARM = 300.0  # mm that count as much as a radian
_DAMPING = 0.01


def told(robot: Robot, offsets: ArmOffsets, joints: Array) -> Array:
    """Return the joints (n, 7) that bring the tool of an arm with `offsets` to where a nominal arm's is with `joints`
    (n, 7), within its limits."""
    import numpy as np

    goal, found = reached(robot, joints).tools, np.array(joints, np.float64)
    for _ in range(_ROUNDS):
        here = reached(robot, found, offsets)
        shift = (goal[:, :3, 3] - here.tools[:, :3, 3]) / _ARM
        spin = goal[:, :3, :3] @ here.tools[:, :3, :3].swapaxes(1, 2)
        turn = np.stack((spin[:, 2, 1] - spin[:, 1, 2], spin[:, 0, 2] - spin[:, 2, 0], spin[:, 1, 0] - spin[:, 0, 1]))
        off = np.concatenate((shift, turn.T / 2), axis=1)[:, :, None]
        if np.abs(off).max() < _CLOSE:
            break
        jacobians = here.jacobians() / np.array((_ARM, _ARM, _ARM, 1.0, 1.0, 1.0))[:, None]
        across = jacobians.swapaxes(1, 2)
        found += (across @ np.linalg.solve(jacobians @ across + _DAMPING**2 * np.eye(6), off))[:, :, 0]
    low, high = np.array(LIMITS).T
    return np.clip(found, low, high)


def taken(robot: Robot, offsets: ArmOffsets, joints: Array) -> Array:
    """Return the joints (n, 7) of a nominal arm whose tool is where that of an arm with `offsets` is, whose encoders
    read `joints` (n, 7): what `told` makes of them are these."""
    import numpy as np

    found = np.array(joints, np.float64)
    for _ in range(_ROUNDS):
        off = joints - told(robot, offsets, found)
        found += off
        if np.abs(off).max() < _CLOSE:
            break
    return found

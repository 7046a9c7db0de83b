"""Forward kinematics of xArm7s that are not quite as the lab says, for many postures at once. mm, rad."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.model.lab import Robot
from pico.model.pose import Pose
from pico.motion.xarm7 import ORIGINS, ROLLS
from pico.vision.arm import NOMINAL, ArmOffsets
from pico.vision.rigid import motion, moved, rotation, upright

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Reached:
    """Poses (n, 4, 4) of a tool in the table's frame, and the joints' axes (n, 7, 3) and origins (n, 7, 3) [mm]."""

    tools: Array
    axes: Array
    origins: Array

    def jacobians(self) -> Array:
        """Return what a joint that turns does to the tool (n, 6, 7): shift [mm/rad], and turn."""
        import numpy as np

        shifts = np.cross(self.axes, self.tools[:, None, :3, 3] - self.origins)
        return np.concatenate((shifts, self.axes), axis=2).swapaxes(1, 2)


def reached(robot: Robot, joints: Array, offsets: ArmOffsets = NOMINAL) -> Reached:
    """Return where an arm with `offsets` is whose encoders read `joints` (n, 7) [rad]."""
    import numpy as np

    mount = upright(Pose(robot.mount.x, robot.mount.y, robot.mount.yaw), robot.mount.z)
    base = moved(mount, np.concatenate((offsets.shift, np.radians(offsets.turn))))
    turned = joints + np.radians(offsets.zeros)
    cosines, sines = np.cos(turned), np.sin(turned)
    pose, axes, origins = np.broadcast_to(base, (len(joints), 4, 4)), [], []
    for i, (origin, roll) in enumerate(zip(ORIGINS, ROLLS, strict=True)):
        link = motion(rotation(np.array((math.radians(roll), 0.0, 0.0))), np.array(origin))
        turn = np.tile(np.eye(4), (len(joints), 1, 1))
        turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1] = (
            cosines[:, i], -sines[:, i], sines[:, i], cosines[:, i],
        )  # fmt: skip
        pose = pose @ link @ turn
        axes.append(pose[:, :3, 2])
        origins.append(pose[:, :3, 3])
    x, y, z = offsets.tool
    flange = motion(np.diag((-1.0, -1.0, 1.0)), np.zeros(3))  # the gripper is mounted half a turn about its axis
    tools = pose @ (flange @ motion(np.eye(3), np.array((x, y, robot.gripper.tool + z))))
    return Reached(tools, np.stack(axes, axis=1), np.stack(origins, axis=1))

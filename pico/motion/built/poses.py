"""Forward kinematics of xArm7s that are not quite as the lab says, for many postures at once. mm, rad."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING

from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
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

        a, b, c = self.axes.transpose(2, 0, 1)
        x, y, z = (self.tools[:, None, :3, 3] - self.origins).transpose(2, 0, 1)
        return np.stack(
            (b * z - c * y, c * x - a * z, a * y - b * x, a, b, c), axis=1
        )  # np.cross takes ten times as long


def reached(robot: Robot, joints: Array, offsets: ArmOffsets = NOMINAL) -> Reached:
    """Return where an arm with `offsets` is whose encoders read `joints` (n, 7) [rad]."""
    import numpy as np

    turned = joints + np.radians(offsets.zeros)
    turns = np.zeros((7, len(joints), 4, 4))
    turns[:, :, 0, 0] = turns[:, :, 1, 1] = np.cos(turned).T
    turns[:, :, 1, 0] = np.sin(turned).T
    turns[:, :, 0, 1] = -turns[:, :, 1, 0]
    turns[:, :, 2, 2] = turns[:, :, 3, 3] = 1.0
    pose, tool = _ends(robot.mount, robot.gripper.tool, offsets)
    poses = np.empty_like(turns)
    for i, link in enumerate(_links()):
        pose = poses[i] = pose @ link @ turns[i]
    return Reached(pose @ tool, poses[:, :, :3, 2].swapaxes(0, 1), poses[:, :, :3, 3].swapaxes(0, 1))


@lru_cache(maxsize=16)
def _ends(mount: Mount, tool: float, offsets: ArmOffsets) -> tuple[Array, Array]:
    """The pose (4, 4) of an arm's base, and that of its tool `tool` [mm] before its flange, in the frame of this."""
    import numpy as np

    nominal = upright(Pose(mount.x, mount.y, mount.yaw), mount.z)
    x, y, z = offsets.tool
    flange = motion(np.diag((-1.0, -1.0, 1.0)), np.zeros(3))  # the gripper is mounted half a turn about its axis
    base = moved(nominal, np.concatenate((offsets.shift, np.radians(offsets.turn))))
    return base, flange @ motion(np.eye(3), np.array((x, y, tool + z)))


@cache
def _links() -> tuple[Array, ...]:
    """The motions (4, 4) from one joint to the next."""
    import numpy as np

    rolled = (rotation(np.array((math.radians(roll), 0.0, 0.0))) for roll in ROLLS)
    return tuple(motion(turn, np.array(origin)) for turn, origin in zip(rolled, ORIGINS, strict=True))

"""A sight from pictures: the eye in the hand sees the plate of a held part, and overhead cameras say how wrong it is.

The eye rides on the hand, so it sees the plate at every carry yaw, past the fingers and under the palm, where cameras
over the table see the palm only. Its calibration to the hand is not perfect, and that error would be in every
placement. So before the fingers close, the eye looks at the part while it still stands, where the overhead cameras,
put right by the datum markers in their pictures, have seen it too. What the eye has wrong is the difference; it is the
same for every part and every yaw, hence averaged over all picks. What remains comes from the overhead cameras, the
same that judge later where the part stands. A picture that was lost is taken again. Millimetres, radians; matrices
(4, 4) are poses.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from pico.cameras.simulated import Eyes
from pico.model.catalog import MarkerPlate
from pico.model.lab import Setup
from pico.model.observation import Uncertainty
from pico.model.pose import Pose
from pico.motion.kinematics import fk
from pico.twin.physics import Twin
from pico.twin.sight import InHand
from pico.vision.anchor import Drifting
from pico.vision.arm import UNKNOWN, FoundArm
from pico.vision.calibration import Accuracy
from pico.vision.camera import CameraModel
from pico.vision.close import plate_pose, region_about
from pico.vision.frame import Frame, exposed
from pico.vision.judge import combined
from pico.vision.markers import CELLS, Marker, detect
from pico.vision.poses import Estimate, MarkerView, edge, free
from pico.vision.rigid import best_motion, motion, moved, planar, rotation, rotation_vector, square, upright

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_CELL = 10
"""Pixels that a cell of a marker is wide when its picture is read."""
_MEMORY = 30
"""Picks over which what an eye has wrong is averaged."""
_SAME = 0.5
"""What an eye has wrong at two picks is one thing where it differs by less [mm]."""


class EyeInHand:
    """Sees parts in hands through `eyes`; implements `HandSight`. `cameras`: as they are calibrated, to `accuracy`,
    which is not quite as they are; `arms`: as they were found, those that were."""

    def __init__(
        self,
        setup: Setup,
        twin: Twin,
        eyes: Eyes,
        cameras: Mapping[str, CameraModel],
        accuracy: Accuracy | None = None,
        arms: Mapping[str, FoundArm] | None = None,
    ) -> None:
        self._setup, self._twin, self._eyes, self._accuracy = setup, twin, eyes, accuracy or Accuracy()
        self._arms = arms or {}
        self._hands = {n: c for n, c in cameras.items() if c.robot is not None}
        self._wrong: dict[str, deque[Array]] = {}

    def refer(self, robot: str, component: str, stands: Pose | None) -> bool:
        """Look at a part that stands, the open hand around it: what the eye has wrong is learned from it."""
        import numpy as np

        seen, marked = self._in_tool(robot, component), self._marked(component)
        if seen is None or marked is None:
            return False
        if stands is not None:
            there = np.linalg.inv(self._tool(robot)) @ upright(stands, 0.0) @ plate_pose(marked[1])
            turn = rotation_vector(there[:3, :3] @ seen.pose[:3, :3].T)
            wrong = np.concatenate((there[:3, 3] - seen.pose[:3, 3], turn))
            self._wrong.setdefault(robot, deque(maxlen=_MEMORY)).append(wrong)
        return True

    def pose_in_hand(self, robot: str, component: str) -> InHand | None:
        """Return where a held part is, or None where its eye does not see it."""
        import numpy as np

        seen, marked = self._in_tool(robot, component), self._marked(component)
        if seen is None or marked is None:
            return None
        learned = self._learned(robot)
        plate = moved(seen.pose, np.mean(learned, axis=0)) if learned else seen.pose
        base = self._tool(robot) @ plate @ np.linalg.inv(plate_pose(marked[1]))
        return InHand(planar(base), float(base[2, 3]), self._known(robot, seen))

    def _learned(self, robot: str) -> list[Array]:
        """What the eye had wrong at the last pick, and at those before that agree with it: an arm that is off by more
        than the eye is off by another way elsewhere."""
        import numpy as np

        wrong = self._wrong.get(robot, deque())
        return [w for w in wrong if np.linalg.norm(w[:3] - wrong[-1][:3]) < _SAME]

    def _known(self, robot: str, seen: Estimate) -> Uncertainty:
        """How well a pose is known: what the cameras over the table leave, and the arm. One that nobody calibrated is
        off elsewhere by as much as at its picks."""
        import numpy as np

        sigma, mount, wrong = combined(seen, self._accuracy), Drifting(), self._wrong.get(robot)
        position, yaw = mount.position, mount.turn
        if wrong:
            off = np.sqrt(np.mean(np.array(wrong) ** 2, axis=0))
            position, yaw = math.hypot(off[0], off[1]), math.degrees(off[5])
        known = self._arms.get(robot)
        if known is not None or not wrong:
            arm = known or UNKNOWN
            position, yaw = math.hypot(position, arm.position), math.hypot(yaw, arm.turn)
        return Uncertainty(position=math.hypot(sigma.position, position), yaw=math.hypot(sigma.yaw, yaw))

    def _in_tool(self, robot: str, component: str) -> Estimate | None:
        """The plate of the part in or around which a hand is, in the tool's frame, as an eye on that hand sees it."""
        import numpy as np

        marked, grasp = self._marked(component), self._setup.type_of(component).geometry.grasp
        if marked is None or grasp is None:
            return None
        number, plate = marked
        at = motion(np.diag((1.0, -1.0, -1.0)), np.array((0.0, 0.0, grasp.height - plate.at[2])))
        for camera in self._hands.values():
            view = self._view(camera, at, number, plate.size) if camera.robot == robot else None
            if view is not None:
                return free(view, plate.size, _facing(at, view, plate.size))
        return None

    def _view(self, camera: CameraModel, at: Array, number: int, size: float) -> MarkerView | None:
        """The marker `number` as a camera sees it around where a plate at `at` (4, 4) should be, in its parent's
        frame."""
        region = region_about(camera, at, size)
        if region is None:
            return None
        frame = exposed(partial(self._eyes.frame, camera.name, region))
        wide = edge(camera.project(square(size) @ at[:3, :3].T + at[:3, 3]))
        found = [] if frame.black else [m for m in _markers(frame, wide) if m.number == number]
        return MarkerView(replace(camera, robot=None), found[0]) if len(found) == 1 else None

    def _tool(self, robot: str) -> Array:
        """The pose of the tool as the joints say it is."""
        import numpy as np

        settings = self._setup.lab.robots[robot]
        point, turn = fk(self._twin.read(robot), settings.gripper.tool)
        mount = upright(Pose(settings.mount.x, settings.mount.y, settings.mount.yaw), settings.mount.z)
        return mount @ motion(np.array(turn), np.array(point))

    def _marked(self, component: str) -> tuple[int, MarkerPlate] | None:
        """The number and the plate of a part's marker."""
        number, plate = self._setup.lab.inventory[component].marker, self._setup.type_of(component).geometry.marker
        return (number, plate) if number is not None and plate is not None else None


def _markers(frame: Frame, size: float) -> tuple[Marker, ...]:
    """The markers in a picture, in which they are about `size` pixels large.

    Pixels of a close picture are binned: a marker is read best where its cells are about ten pixels wide.
    """
    import cv2
    import numpy as np

    share = int(size / CELLS / _CELL)
    if share < 2:
        return detect(frame).markers
    height, width = (n // share * share for n in frame.gray.shape)
    soft = cv2.GaussianBlur(frame.gray[:height, :width], (0, 0), 0.8 * share)
    small = cv2.resize(soft, None, fx=1 / share, fy=1 / share, interpolation=cv2.INTER_AREA)
    binned = detect(replace(frame, gray=np.asarray(small, np.uint8), offset=(0, 0))).markers
    first = np.array(frame.offset)
    return tuple(
        replace(m, corners=(m.corners + 0.5) * share - 0.5 + first, covariance=m.covariance * share**2) for m in binned
    )


def _facing(at: Array, view: MarkerView, size: float) -> Array:
    """The pose near which a held plate is: as high as `at` in the tool's frame, level, turned as its corners say."""
    import numpy as np

    origin, along = view.camera.rays(view.marker.corners)
    points = origin + along * ((at[2, 3] - origin[2]) / along[:, 2])[:, None]
    found: Array = best_motion(square(size), points)
    return motion(rotation(rotation_vector(found[:3, :3])), np.append(found[:2, 3], at[2, 3]))

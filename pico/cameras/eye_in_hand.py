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
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from pico.cameras.simulated import Eyes
from pico.model.catalog import MarkerPlate
from pico.model.observation import Uncertainty
from pico.model.pose import Pose
from pico.model.setup import Setup
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
from pico.vision.markers import CELLS, Marker, detect, stained
from pico.vision.poses import Estimate, MarkerView, edge, free, leaning_as
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
_SUNK, _LEANT = 0.5, 0.3
"""By how much a part may sink and lean in the hand from one look to the next [mm, deg]."""
_SHARP, _FAINT = 0.2, 0.5
"""One standard deviation [mm] of where a part is, from which nothing is learned of the eye, and from which the part
counts as not seen: light spoils its marker."""


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
        self._sharp: set[str] = set()
        self._was: dict[str, Array] = {}

    def refer(self, robot: str, component: str, stands: Pose | None) -> bool:
        """Look at a part that stands, the open hand around it: what the eye has wrong is learned from it."""
        import numpy as np

        marked = self._marked(component)
        if marked is None:
            return False
        self._was.pop(robot, None)
        if stands is not None:
            there = np.linalg.inv(self._tool(robot)) @ upright(stands, 0.0) @ plate_pose(marked[1])
            self._was[robot] = there
        seen = self._in_tool(robot, component)
        if seen is None:
            return False
        if stands is not None:
            turn = rotation_vector(there[:3, :3] @ seen.pose[:3, :3].T)
            wrong = np.concatenate((there[:3, 3] - seen.pose[:3, 3], turn))
            self._learn(robot, wrong, _noise(seen, marked[1]) < _SHARP)
        return True

    def _learn(self, robot: str, wrong: Array, sharp: bool) -> None:
        """Remember what an eye has wrong; what light spoils counts only as long as nothing was seen sharply."""
        if sharp and robot not in self._sharp:
            self._sharp.add(robot)
            self._wrong.pop(robot, None)
        if sharp or robot not in self._sharp:
            self._wrong.setdefault(robot, deque(maxlen=_MEMORY)).append(wrong)

    def pose_in_hand(self, robot: str, component: str) -> InHand | None:
        """Return where a held part is, or None where its eye does not see it."""
        import numpy as np

        seen, marked = self._in_tool(robot, component), self._marked(component)
        if seen is None or marked is None:
            return None
        learned = self._learned(robot)
        plate = moved(seen.pose, np.mean(learned, axis=0)) if learned else seen.pose
        base = self._tool(robot) @ plate @ np.linalg.inv(plate_pose(marked[1]))
        return InHand(planar(base), float(base[2, 3]), self._known(robot, seen, marked[1]))

    def _learned(self, robot: str) -> list[Array]:
        """What the eye had wrong at the last pick, and at those before that agree with it: an arm that is off by more
        than the eye is off by another way elsewhere."""
        import numpy as np

        wrong = self._wrong.get(robot, deque())
        return [w for w in wrong if np.linalg.norm(w[:3] - wrong[-1][:3]) < _SAME]

    def _known(self, robot: str, seen: Estimate, plate: MarkerPlate) -> Uncertainty:
        """How well the pose of a part is known, by its plate: what the cameras over the table leave, and the arm. One
        that nobody calibrated is off elsewhere by as much as at its picks."""
        import numpy as np

        sigma, mount, wrong = combined(seen, self._accuracy, _foot(plate)), Drifting(), self._wrong.get(robot)
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
            was = self._was.get(robot)
            view = self._view(camera, at, number, plate.size, was) if camera.robot == robot else None
            if view is not None:
                found = (
                    free(view, plate.size, _facing(at, view, plate.size)) if was is None
                    else leaning_as([view], plate.size, was, _SUNK, _LEANT)
                )  # fmt: skip
                if _noise(found, plate) < _FAINT:
                    self._was[robot] = found.pose
                    return found
        return None

    def _view(self, camera: CameraModel, at: Array, number: int, size: float, was: Array | None) -> MarkerView | None:
        """The marker `number` as a camera sees it around where a plate at `at` (4, 4) should be, in its parent's
        frame; where light spoils it, about where it `was`."""
        region = region_about(camera, at, size)
        if region is None:
            return None
        frame = exposed(partial(self._eyes.frame, camera.name, region))
        wide = edge(camera.project(square(size) @ at[:3, :3].T + at[:3, 3]))
        close = _Close.of(frame, wide)
        found = [] if frame.black else [m for m in detect(close.frame).markers if m.number == number]
        if not (found or frame.black or was is None):
            corners = close.seen(camera.project(square(size) @ was[:3, :3].T + was[:3, 3]))
            found = [m for m in (stained(close.frame, number, corners),) if m is not None]
        return MarkerView(replace(camera, robot=None), close.whole(found[0])) if len(found) == 1 else None

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


@dataclass(frozen=True, eq=False)
class _Close:
    """A close picture with `share` by `share` pixels binned into one; `first`: where it begins on the sensor.

    A marker is read best where its cells are about ten pixels wide.
    """

    frame: Frame
    share: int
    first: Array

    @classmethod
    def of(cls, frame: Frame, size: float) -> _Close:
        """Bin a picture in which a marker is about `size` pixels large."""
        import cv2
        import numpy as np

        share = int(size / CELLS / _CELL)
        if share < 2:
            return cls(frame, 1, np.zeros(2))
        height, width = (n // share * share for n in frame.gray.shape)
        soft = cv2.GaussianBlur(frame.gray[:height, :width], (0, 0), 0.8 * share)
        small = cv2.resize(soft, None, fx=1 / share, fy=1 / share, interpolation=cv2.INTER_AREA)
        return cls(replace(frame, gray=np.asarray(small, np.uint8), offset=(0, 0)), share, np.array(frame.offset))

    def seen(self, pixels: Array) -> Array:
        """Return where pixels (n, 2) of the sensor are in the binned picture."""
        found: Array = (pixels - self.first + 0.5) / self.share - 0.5
        return found

    def whole(self, marker: Marker) -> Marker:
        """Return a marker of the binned picture in pixels of the sensor."""
        corners = (marker.corners + 0.5) * self.share - 0.5 + self.first
        return replace(marker, corners=corners, covariance=marker.covariance * self.share**2)


def _foot(plate: MarkerPlate) -> tuple[float, float, float]:
    """Where the middle of a part's base is, in the frame of its plate [mm]."""
    x, y, z = plate.at
    return -x, -y, -z


def _noise(seen: Estimate, plate: MarkerPlate) -> float:
    """One standard deviation of where the base of a part is, from the noise of its plate's corners [mm]."""
    return seen.known_at(_foot(plate)).position


def _facing(at: Array, view: MarkerView, size: float) -> Array:
    """The pose near which a held plate is: as high as `at` in the tool's frame, level, turned as its corners say."""
    import numpy as np

    origin, along = view.camera.rays(view.marker.corners)
    points = origin + along * ((at[2, 3] - origin[2]) / along[:, 2])[:, None]
    found: Array = best_motion(square(size), points)
    return motion(rotation(rotation_vector(found[:3, :3])), np.append(found[:2, 3], at[2, 3]))

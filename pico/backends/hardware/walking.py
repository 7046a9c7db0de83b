"""An arm on its way along a path: leg by leg, its hand opened and closed where the path says so."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING

from pico.backends import checks
from pico.backends.attempt import Failed
from pico.backends.hardware.failing import failed
from pico.backends.hardware.reading import held
from pico.diagnostics import PicoError, error
from pico.drivers.protocols import Arm, Clamp, Gripper
from pico.model.operation import Operation
from pico.model.setup import Setup
from pico.motion.reach import grasp_height
from pico.motion.types import MovePath, Segment, SegmentName, Stage
from pico.twin.arms import TwinArm

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SQUEEZE = 4.0
"""By how much the fingers are to come closer than the width of a part [mm], so that they press on it."""
NOWHERE = 1e-6
"""A joint that turns by less [rad] in no time does not turn."""
FIRST_SPEED = 50.0
"""The greatest speed of the tool while a driver was never tried on a device [mm/s]."""


def speed_of(setup: Setup, path: MovePath) -> float:
    """Return how fast the tool of an arm is at the fastest along a path as it is timed [mm/s]."""
    import numpy as np

    from pico.motion.kinematics import tool_point

    fastest = 0.0
    for segment in path.segments:
        at = np.array([tool_point(setup.lab.robots[path.robot], joints) for joints in segment.joints])
        gone, took = np.linalg.norm(np.diff(at, axis=0), axis=1), np.diff(np.array(segment.times))
        fastest = max(fastest, *(gone[took > 0] / took[took > 0]), 0.0)
    return float(fastest)


class Way:
    """The way of one arm. `asked` is asked before each leg, and ends the way there by what it raises."""

    def __init__(
        self, setup: Setup, operation: Operation, path: MovePath, arm: Arm, gripper: Gripper | None, built: TwinArm,
        asked: Callable[[Stage], Awaitable[None]], slow: float = 1.0,
    ) -> None:  # fmt: skip
        """`built`: as calibration knows the arm. `slow`: so many times longer than planned it takes."""
        self._setup, self._operation, self._path = setup, operation, path
        self._arm, self._gripper, self._built, self._asked, self._slow = arm, gripper, built, asked, slow
        self.stage = Stage(path.segments[0].name)
        self.part = path.component or operation.component
        self.carries = not any(segment.name == "grip" for segment in path.segments) and path.component is not None

    async def walk(self) -> None:
        """Go it to its end; raises Failed, naming component, operation and leg."""
        if self.carries:
            await self._load("lift")
        for segment in self._path.segments:
            self.stage = Stage(segment.name)
            await self._asked(self.stage)
            try:
                await self._leg(segment)
            except PicoError as exc:
                raise failed(self._operation, exc, segment.name) from exc

    async def _leg(self, segment: Segment) -> None:
        if segment.name == "grip":
            await self._grip()
            await self._load(segment.name)
        elif segment.name == "release":
            await self._open(segment.opening)
            self.carries = False
            await self._load(segment.name)
        else:
            if segment.name in ("approach", "descend"):
                await self._open(segment.opening)
            times, joints = self._told(segment)
            if len(times) > 1:
                doing = f"{self._operation.id}: {self._operation.primitive} {self._operation.component}"
                await self._arm.follow(times, joints, doing=doing)
            if self.carries:
                await self._require_held()

    def _told(self, segment: Segment) -> tuple[Array, Array]:
        """The leg as the motors are told: times [s], and joints [rad] put right by what calibration knows; one that
        ends where it begins, in no time, is a single posture."""
        import numpy as np

        times, joints = np.array(segment.times), np.array(segment.joints)
        goes = (np.diff(times) > 0) | (np.abs(np.diff(joints, axis=0)).max(axis=1) > NOWHERE)
        kept = np.concatenate(([True], goes))
        return times[kept] * self._slow, self._built.told(joints[kept])

    async def _load(self, leg: SegmentName) -> None:
        """Let the arm reckon with what its hand holds now, which hangs from its tool."""
        robot, geometry = self._setup.lab.robots[self._path.robot], self._setup.type_of(self.part).geometry
        below = robot.gripper.tool + grasp_height(robot, geometry) - geometry.height / 2
        try:
            await self._arm.carry(geometry.mass if self.carries else 0.0, (0.0, 0.0, below))
        except PicoError as exc:
            raise failed(self._operation, exc, leg) from exc

    async def _open(self, width: float) -> None:
        if self._gripper is not None:
            found = await (
                self._gripper.hold(False) if isinstance(self._gripper, Clamp) else self._gripper.move_to(width)
            )
            narrow = found.width is not None and found.width < width - SQUEEZE
            if found.holds or narrow:
                text = f"the hand of {self._path.robot} does not let go"
                if found.width is not None:
                    text = f"the fingers of {self._path.robot} open to {found.width:.1f} mm only, not to {width:.1f} mm"
                raise PicoError(error("gripper", text, address=self._path.robot))

    async def _grip(self) -> None:
        """Close on the part; raises Failed where nothing of its width is between the fingers."""
        self.carries = True
        grasp = self._setup.type_of(self.part).geometry.grasp
        if self._gripper is None or grasp is None:
            return
        if isinstance(self._gripper, Clamp):
            found = await self._gripper.hold(True)
        else:
            found = await self._gripper.move_to(max(0.0, grasp.width - SQUEEZE))
        if not held(found, grasp) or found.holds is False:
            self.carries = False
            robot, name = self._path.robot, self.part
            text = f"{robot} missed {name}: its hand holds nothing"
            if found.width is not None:
                fingers = f"its fingers closed to {found.width:.1f} mm, and the part is {grasp.width:g} mm"
                text = f"{robot} missed {name}: {fingers}"
            raise Failed(error("missed-grasp", text, address=name))

    async def _require_held(self) -> None:
        """Raise Failed where the part is between the fingers no more."""
        grasp = self._setup.type_of(self.part).geometry.grasp
        if self._gripper is None or grasp is None:
            return
        found = await self._gripper.grip()
        if not held(found, grasp):  # whether it presses on something a hand forgets that had no power
            self.carries = False
            raise Failed(checks.dropped(self._path.robot, self.part))

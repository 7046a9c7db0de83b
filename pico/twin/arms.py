"""The arms of the twin as they are: built not quite as the lab says, read through encoders, put right as far as they
are calibrated. Joints in radians.

All else knows the nominal arm: what its joints would be. Here these become what motors are told, and back.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.model.simulated import ArmErrors
from pico.motion.types import Joints
from pico.vision.arm import NOMINAL, ArmOffsets

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

READS = 16
"""How often encoders are read for one angle, the mean of that: as often as an arm that comes to rest has time for."""


@dataclass(frozen=True)
class TwinArm:
    """One arm: as it is `built`, and as calibration says that it is (`known`). `play`: backlash of each joint [rad];
    `noise`: one sigma of a joint that is read once [rad], by `seed`."""

    robot: Robot
    built: ArmOffsets = NOMINAL
    known: ArmOffsets = NOMINAL
    play: float = 0.0
    noise: float = 0.0
    seed: tuple[int, ...] = (0,)

    @property
    def perfect(self) -> bool:
        """Whether its tool is where its joints say, always."""
        return self.built == self.known == NOMINAL and not self.play

    def told(self, joints: Array) -> Array:
        """Return what motors are told (n, 7) for the nominal `joints` (n, 7)."""
        from pico.motion.built.correction import told

        return joints if self.known == NOMINAL else told(self.robot, self.known, joints)

    def taken(self, motors: Array) -> Joints:
        """Return the nominal joints for angles of the motors (7,)."""
        from pico.motion.built.correction import taken

        found = motors if self.known == NOMINAL else taken(self.robot, self.known, motors[None])[0]
        return tuple(float(q) for q in found)

    def followed(self, motors: Array, links: Array) -> Array:
        """Return where joints come (n, 7) that were at `links` (7,) while motors go through `motors` (n, 7)."""
        import numpy as np

        if not self.play:
            return motors
        found, half = np.empty_like(motors), self.play / 2
        for i, motor in enumerate(motors):
            found[i] = links = np.asarray(np.clip(links, motor - half, motor + half), np.float64)
        return found

    def slack(self, before: Joints, joints: Joints, slack: Array | None) -> Array:
        """Return by how much motors are ahead of joints (7,) after a way straight from `before`, where it was `slack`
        (nothing where None), to `joints`, both nominal."""
        import numpy as np

        first, last = self.told(np.array((before, joints)))
        return last - self.followed(last[None], first if slack is None else first - slack)[0]  # type: ignore[no-any-return]

    def tool(self, joints: Joints, slack: Array | None) -> Pose:
        """Return where the tool really is for nominal `joints`, seen from above."""
        pose = self.tool_in_space(joints, slack)
        return Pose(float(pose[0, 3]), float(pose[1, 3]), math.degrees(math.atan2(pose[1, 1], pose[0, 1])))

    def tool_in_space(self, joints: Joints, slack: Array | None) -> Array:
        """Return the pose (4, 4) that the tool really has for nominal `joints` [mm]."""
        import numpy as np

        from pico.motion.built.poses import reached

        motors = self.told(np.array([joints]))
        return reached(self.robot, motors if slack is None else motors - slack, self.built).tools[0]  # type: ignore[no-any-return]

    def error(self, instant: int) -> Array:
        """Return what encoders read too much (7,) at an instant, the same whenever it is asked for."""
        import numpy as np

        return self.misread(np.random.default_rng((*self.seed, instant)), 1)[0]  # type: ignore[no-any-return]

    def misread(self, random: Any, count: int) -> Array:
        """Return what encoders read too much (count, 7) on average over READS, by a numpy generator."""
        return self.noise / math.sqrt(READS) * random.standard_normal((count, 7))  # type: ignore[no-any-return]


def arms_of(setup: Setup, seed: int, known: Mapping[str, ArmOffsets] | None = None) -> dict[str, TwinArm]:
    """Return the xArms of a lab as they really are: wrong by the lab's errors and `seed`, put right by what is `known`.

    Same seed, same arms; one arm does not depend on which others there are.
    """
    wrong = setup.lab.sim.errors.arm or ArmErrors()
    found = {}
    for name, robot in setup.lab.robots.items():
        if robot.model == "xarm7":
            own = (seed, zlib.crc32(name.encode()))
            built, believed = _built(wrong, own), (known or {}).get(name, NOMINAL)
            play, noise = math.radians(wrong.backlash), math.radians(wrong.encoder_noise)
            found[name] = TwinArm(robot, built, believed, play, noise, own)
    return found


def motors(arms: Mapping[str, TwinArm], joints: Mapping[str, Joints]) -> dict[str, Joints]:
    """Return what the motors of robots are told for nominal `joints`; those that are no `arms` keep theirs."""
    import numpy as np

    told = {name: arms[name].told(np.array([joints[name]]))[0] for name in arms.keys() & joints.keys()}
    return {**joints, **{name: tuple(float(q) for q in found) for name, found in told.items()}}


def _built(wrong: ArmErrors, seed: tuple[int, ...]) -> ArmOffsets:
    import numpy as np

    random = np.random.default_rng(seed)
    return ArmOffsets(
        shift=_vector(wrong.mount_position, random),
        turn=_vector(wrong.mount_rotation, random),
        zeros=tuple(float(wrong.joint_zero * sign) for sign in random.choice((-1.0, 1.0), 7)),
        tool=_vector(wrong.tool_position, random),
    )


def _vector(length: float, random: Any) -> tuple[float, float, float]:
    x, y, z = (float(v) + 0.0 for v in length * direction(random))
    return x, y, z


def direction(random: Any) -> Array:
    """Return a vector (3,) of length 1 in a random direction, by a numpy generator."""
    import numpy as np

    way = random.normal(size=3)
    return way / np.linalg.norm(way)  # type: ignore[no-any-return]

"""Bodies and arms in motion: gravity, contacts, friction, servos. Nothing is welded, and nothing teleports but by the
fraction of a millimetre by which a seat pulls what is put on it.

Joints in radians, openings of a gripper in mm, times in seconds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from pico.model.setup import Setup
from pico.motion.engine import require_mujoco
from pico.motion.types import Joints, Stage
from pico.twin.arms import TwinArm, arms_of
from pico.twin.placement import Placement, placement_of
from pico.twin.scene import TIMESTEP, SceneBody, build_scene, lull

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_CONTROL_STEPS = 2
"""Steps of the simulation between two set-points of the servos."""
_PRESSING_STEPS = 50
"""Steps of the simulation in which pads come to press on what they hold: some time constants of contact and finger."""
_MAGNET_FORCE, _MAGNET_REACH = 10.0, 1e-3
"""What a magnet in the base of a part keeps it down with, and how near the table [N, m]."""
_WAKES = 1e-6
"""A speed that wakes what sleeps, and moves nothing [m/s]."""
_BEARING = 20.0
"""What the trim of a servo grows by in each of these steps, as a multiple of what its joint gave way by in the step."""


@dataclass(frozen=True, eq=False)
class _Arm:
    """Where an arm's numbers are in the model: addresses of joints, servos, fingers and how fast they slide; ids of
    pads; its servos' lag."""

    qpos: Array
    servos: Array
    fingers: Array
    slides: Array
    gripper: int | None
    pads: tuple[int, ...]
    lag: Array


@dataclass(eq=False)
class _Drive:
    """What an arm's motors are told: angles (n, 7) over times from `begun`, plus `trim` (7,). `slack` (7,): by how much
    they are ahead of the joints."""

    begun: float
    times: tuple[float, ...]
    motors: Array
    trim: Array
    slack: Array


class Twin:
    """A bench in motion, with `things` by name, arms at `joints` (parked where missing) and the pads of grippers
    `openings` apart (all the way where missing).

    Joints are those of the nominal arms; `arms`: as they really are, with the lab's errors and nothing known of these
    where None. `holding`: what a gripper is closed on, by robot. `handles`: the component that a robot last was told to
    take. `magnets`: the components that a magnet keeps on the table until they are lifted. `stages`: how far a robot is
    on the path that it was last told to take. `after_step` is called after every step where it is set.
    """

    def __init__(
        self,
        setup: Setup,
        things: Mapping[str, SceneBody],
        joints: Mapping[str, Joints],
        openings: Mapping[str, float] | None = None,
        *,
        holding: Mapping[str, str] | None = None,
        pad_friction: float | None = None,
        arms: Mapping[str, TwinArm] | None = None,
        magnets: Collection[str] = (),
    ) -> None:
        require_mujoco()
        import mujoco

        self._real = arms_of(setup, setup.lab.sim.seed) if arms is None else arms
        self.model = build_scene(setup, things, pad_friction=pad_friction, arms=self._real).compile()
        lull(self.model, things)
        self.data = mujoco.MjData(self.model)
        self._body = {name: self.model.body(name).id for name in things}
        self._name = {number: name for name, number in self._body.items()}
        self._arms = {n: _arm(self.model, n) for n, robot in setup.lab.robots.items() if robot.model == "xarm7"}
        self._drives: dict[str, _Drive] = {}
        self._taken: dict[str, tuple[Array, Joints]] = {}  # joints for the angles that motors had last
        self._time = 0.0
        self.handles = dict(holding or {})
        self.stages: dict[str, Stage] = {}
        self._stuck = set(magnets)
        self.after_step: Callable[[], None] | None = None
        closed = []
        for name in self._arms:
            robot = setup.lab.robots[name]
            parked, stroke = tuple(math.radians(angle) for angle in robot.park), robot.gripper.stroke
            width = self._width(things, (holding or {}).get(name))
            opening = min(stroke, (openings or {}).get(name, stroke)) if width is None else width
            self._start(name, joints.get(name) or parked, opening)
            if width is not None:
                self.grip(name)
                closed.append(name)
        self._press(closed)
        mujoco.mj_forward(self.model, self.data)

    @staticmethod
    def _width(things: Mapping[str, SceneBody], held: str | None) -> float | None:
        grasp = things[held].geometry.grasp if held else None
        return grasp.width if grasp else None

    def _start(self, name: str, joints: Joints, opening: float) -> None:
        import numpy as np

        arm, motors = self._arms[name], self._real[name].told(np.array([joints]))
        self.data.qpos[arm.qpos] = motors[0]
        self.data.qpos[arm.fingers] = opening / 2000
        self._drives[name] = _Drive(0.0, (0.0,), motors, np.zeros(7), np.zeros(7))
        self.data.ctrl[arm.servos] = motors[0]
        if arm.gripper is not None:
            self.data.ctrl[arm.gripper] = opening / 2000

    def _press(self, closed: list[str]) -> None:
        """Let the pads of these robots press on what they hold, and their arms bear it, before time begins: all but the
        fingers keeps still.

        What is stored of a grip is where arm and part are, not the forces between them: without these a part falls
        until the pads have come together again, and the arm sinks by what it bears.
        """
        import mujoco

        fingers = [int(i) for name in closed for i in self._arms[name].fingers]
        slides = [int(i) for name in closed for i in self._arms[name].slides]
        still = self.data.qpos.copy()
        for _ in range(_PRESSING_STEPS if fingers else 0):
            mujoco.mj_step(self.model, self.data)
            for arm, drive in ((self._arms[name], self._drives[name]) for name in closed):
                drive.trim += _BEARING * (still[arm.qpos] - self.data.qpos[arm.qpos])
                self.data.ctrl[arm.servos] = still[arm.qpos] + drive.trim
            still[fingers], speeds = self.data.qpos[fingers], self.data.qvel[slides]
            self.data.qpos[:], self.data.qvel[:] = still, 0.0
            self.data.qvel[slides] = speeds
        self.data.time = 0.0

    @property
    def arms(self) -> tuple[str, ...]:
        """The robots that the twin has a model of."""
        return tuple(self._arms)

    def advance(self, seconds: float) -> None:
        """Let `seconds` pass; what is less than a step is kept for the next time."""
        import mujoco

        self._time += seconds
        steps = round((self._time - self.data.time) / TIMESTEP)
        plans = [(arm.servos, self._setpoints(name, steps)) for name, arm in self._arms.items()]
        for number in range(0, steps, _CONTROL_STEPS):
            for servos, plan in plans:
                self.data.ctrl[servos] = plan[number // _CONTROL_STEPS]
            for name in self._stuck.intersection(self.handles.values()):
                lifted = self._height(name) > _MAGNET_REACH
                self.data.xfrc_applied[self._body[name], 2] = 0.0 if lifted else -_MAGNET_FORCE
                if lifted:
                    self._stuck.remove(name)
            count = min(_CONTROL_STEPS, steps - number)
            if self.after_step is None:
                mujoco.mj_step(self.model, self.data, count)
                continue
            for _ in range(count):
                mujoco.mj_step(self.model, self.data)
                self.after_step()

    def _setpoints(self, name: str, steps: int) -> Array:
        """Set-points (n, 7) of an arm's servos from now on. A servo lags behind, so it hears early where to be."""
        import numpy as np

        drive, arm = self._drives[name], self._arms[name]
        elapsed = self.data.time - drive.begun + TIMESTEP * np.arange(0, max(steps, 1), _CONTROL_STEPS)
        columns = [np.interp(elapsed + arm.lag[i], drive.times, drive.motors[:, i]) for i in range(7)]
        motors = np.column_stack(columns)
        links = self._real[name].followed(motors, motors[0] - drive.slack)
        drive.slack = motors[-1] - links[-1]
        return links + drive.trim

    def drive(self, robot: str, times: tuple[float, ...], joints: tuple[Joints, ...]) -> None:
        """Start an arm along `joints` at `times` from now; it keeps to the last of them."""
        import numpy as np

        self._go(robot, times, self._real[robot].told(np.array(joints)))

    def _go(self, robot: str, times: tuple[float, ...], motors: Array) -> None:
        drive = self._drives[robot]
        self._drives[robot] = replace(drive, begun=self.data.time, times=times, motors=motors)

    def hold(self, robot: str) -> None:
        """Stop an arm where it is."""
        self._drives[robot].trim[:] = 0.0
        self._go(robot, (0.0,), self._motors(robot)[None])

    def _motors(self, robot: str) -> Array:
        """The angles (7,) of an arm's motors [rad]."""
        return self.data.qpos[self._arms[robot].qpos] + self._drives[robot].slack  # type: ignore[no-any-return]

    def trim(self, robot: str) -> float:
        """Correct the set-points by what the arm is off its last target; return the greatest of it [rad]."""
        import numpy as np

        drive = self._drives[robot]
        off = drive.motors[-1] - self._motors(robot)
        drive.trim += off
        return float(np.abs(off).max())

    def joints(self, robot: str) -> Joints:
        """Return the angles that an arm's joints have [rad]."""
        motors = self._motors(robot)
        before, joints = self._taken.get(robot, (None, ()))
        if before is None or (motors != before).any():
            joints = self._real[robot].taken(motors)
            self._taken[robot] = motors, joints
        return joints

    def read(self, robot: str) -> Joints:
        """Return the angles of an arm's joints as its encoders read them now [rad]."""
        real, joints = self._real[robot], self.joints(robot)
        if not real.noise:
            return joints
        return tuple(q + float(e) for q, e in zip(joints, real.error(round(self.data.time / TIMESTEP)), strict=True))

    def grip(self, robot: str, opening: float | None = None) -> None:
        """Move the fingers to `opening` [mm] between the pads; None closes with the gripper's force."""
        actuator = self._arms[robot].gripper
        if actuator is not None:
            self.data.ctrl[actuator] = 0.0 if opening is None else opening / 2000

    def opening(self, robot: str) -> float:
        """Return how far the pads of an arm's gripper are apart [mm]; zero where it has none."""
        return float(self.data.qpos[self._arms[robot].fingers].sum()) * 1000

    def gripped(self, robot: str) -> str | None:
        """Return the component that both pads touch, or None."""
        touched: list[set[str]] = []
        for pad in self._arms[robot].pads:
            pairs = self.data.contact.geom[(self.data.contact.geom == pad).any(axis=1)]
            bodies = {int(self.model.geom_bodyid[geom]) for geom in pairs.reshape(-1)}
            touched.append({self._name[b] for b in bodies if b in self._name})
        both = set.intersection(*touched) if touched else set()
        return min(both, default=None)

    def placement(self, name: str) -> Placement:
        """Return where a component is, at the same instant as `joints`: MuJoCo's own `xpos` is a step older."""
        address = int(self.model.body(name).jntadr[0])
        if address < 0:
            return placement_of(self.data.xpos[self._body[name]], self.data.xquat[self._body[name]])
        first = int(self.model.jnt_qposadr[address])
        return placement_of(self.data.qpos[first : first + 3], self.data.qpos[first + 3 : first + 7])

    def _height(self, name: str) -> float:
        """How high the base of a component is above the table [m]."""
        address = int(self.model.body(name).jntadr[0])
        return float(self.data.qpos[int(self.model.jnt_qposadr[address]) + 2]) if address >= 0 else 0.0

    def pull(self, name: str, dx: float, dy: float, dyaw: float) -> None:
        """Shift a free component by (dx, dy) [mm] and turn it about the vertical by dyaw [deg], as its seat does when
        it takes hold of it."""
        import mujoco

        address = int(self.model.body(name).jntadr[0])
        if address < 0:
            return
        first, half = int(self.model.jnt_qposadr[address]), math.radians(dyaw) / 2
        self.data.qpos[first : first + 2] += (dx / 1000, dy / 1000)
        turn = self.data.qpos[first + 3 : first + 7]
        mujoco.mju_mulQuat(turn, (math.cos(half), 0.0, 0.0, math.sin(half)), turn.copy())
        self.data.qvel[int(self.model.jnt_dofadr[address])] += _WAKES  # what sleeps would be seen where it was
        mujoco.mj_kinematics(self.model, self.data)


def _arm(model: Any, name: str) -> _Arm:
    import mujoco
    import numpy as np

    def address(joint: str) -> int:
        return int(model.joint(f"{name}/{joint}").qposadr[0])

    def find(kind: Any, thing: str) -> int:
        return int(mujoco.mj_name2id(model, kind, f"{name}/{thing}"))

    servos = np.array([model.actuator(f"{name}/joint{i}").id for i in range(1, 8)])
    gripper = find(mujoco.mjtObj.mjOBJ_ACTUATOR, "gripper")
    sides = ("left", "right") if gripper >= 0 else ()
    return _Arm(
        qpos=np.array([address(f"joint{i}") for i in range(1, 8)]),
        servos=servos,
        fingers=np.array([address(f"{side}_slide") for side in sides], dtype=int),
        slides=np.array([model.joint(f"{name}/{side}_slide").dofadr[0] for side in sides], dtype=int),
        gripper=gripper if gripper >= 0 else None,
        pads=tuple(find(mujoco.mjtObj.mjOBJ_GEOM, f"{side}_pad") for side in sides),
        lag=model.actuator_biasprm[servos, 2] / model.actuator_biasprm[servos, 1],
    )

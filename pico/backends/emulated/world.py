"""The simulated world behind emulated devices: arms that stand where their controllers say, parts between fingers,
axes, light. Kept as `world.json` in the folder of the bench."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

from pico.backends.emulated.contact import ABNORMAL_CURRENT, LOAD_ERROR, Contacts
from pico.backends.hardware.settings import Settings
from pico.backends.sim.store import load_world, save_world
from pico.backends.sim.world import World, put_down
from pico.base.state_files import DEVICES
from pico.diagnostics import PicoError
from pico.geometry.seat import PlacementError, injected
from pico.model.instruments.emulation import Visitor
from pico.model.observation import ObservedValue
from pico.model.pose import Pose, angle_between
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.motion.kinematics import tool_of, tool_point, tool_pose
from pico.motion.reach import grasp_height
from pico.motion.shapes import FINGER_MASS, PALM_MASS
from pico.motion.types import Joints
from pico.places.bench import BenchPlace
from pico.twin.arms import arms_of
from pico.twin.learned import read_learned
from pico.vision.calibration_files import accepted_arms

if TYPE_CHECKING:
    from pico.cameras.board import Sheet

FOLDER = "emulated"
GRIPPER_MASS = PALM_MASS + 2 * FINGER_MASS
"""Of the hand without a part [kg]."""
BETWEEN = 15.0
"""How far a part may be from the middle of the fingers across the table, and in height, to be between them [mm]."""
ALONG = 10.0
"""By how much the faces that pads close on may be turned to them [deg]."""
DROP = 3.0
"""From how high [mm] a part that fingers let go of does not come to stand any more."""
KEPT = 0.05
"""Seconds of wall time after which the world is stored again while something moves."""

NEVER: Mapping[str, tuple[float, float]] = MappingProxyType({})


class EmulatedWorld:
    """The world of the bench at `place`. Its clock runs `pace` times as fast as the wall clock. On it `people`
    come and go, and safety inputs (by device) read `unsafe` from one time until another [s]. Called from any thread."""

    def __init__(
        self, setup: Setup, place: BenchPlace, pace: float = 1.0, wall: Callable[[], float] = time.monotonic,
        people: Collection[Visitor] = (), unsafe: Mapping[str, tuple[float, float]] = NEVER,
    ) -> None:  # fmt: skip
        """Raises PicoError where its file can't be read."""
        self.setup, self.place, self.pace = setup, place, pace
        self._wall, self._began = wall, wall()
        self._world, self.diagnostics = load_world(setup, place)
        self._since = self._world.clock
        self._lock, self._kept, self._stored = threading.RLock(), 0.0, self._world
        self._devices = Settings(place, DEVICES)
        self._pulled: set[str] = set()
        self.shown: Sheet | None = None
        """The print that somebody holds up before the cameras."""
        self.in_hand: tuple[str, Sheet] | None = None
        """The print that a robot holds, where it is in the tool's frame."""
        self._contacts: Contacts | None = None
        self._people, self._unsafe = people, unsafe
        known = accepted_arms(place.root, place.name)
        self._arms, self._learned = arms_of(setup, self._world.seed, known), read_learned(place.root)
        self._held = {robot: self._from_tool(robot, now.joints, self._world.components[now.holding].pose or Pose(0, 0))
                      for robot, now in self._world.robots.items() if now.holding}  # fmt: skip

    def now(self) -> float:
        """Return the world's clock [s]."""
        return self._since + (self._wall() - self._began) * self.pace

    def world(self) -> World:
        """Return the table as it is at this moment."""
        with self._lock:
            return replace(self._world, clock=self.now())

    def change(self, how: Callable[[World], World]) -> None:
        """Change the table as a hand would, and store it."""
        with self._lock:
            self._world = how(self.world())
            self.store(durable=True)

    def store(self, *, durable: bool = False) -> None:
        """Store the table where it is another than when it was stored last; raises PicoError where that can't be."""
        with self._lock:
            self._kept = self._wall()
            if self._world == self._stored and not durable:
                return
            self._stored = self._world
            save_world(self.place, self.world(), durable=durable)

    # what devices do to it

    def moved(self, robot: str, joints: Joints) -> None:
        """Let an arm stand at these nominal joints [rad], with what it holds."""
        with self._lock:
            self._stands(robot, joints)
            if self._wall() - self._kept > KEPT:
                with suppress(PicoError):  # what comes next says so
                    self.store()

    def way(self, robot: str, before: Joints, after: Joints, load: float) -> tuple[float, int]:
        """Return which share (0 to 1) of a step between nominal joints [rad] an arm can move, and the controller error
        that ends it or 0; `load`: of tool and part, as the control box reckons with it [kg]."""
        with self._lock:
            if self._contacts is None:
                self._contacts = Contacts(self.setup, self._people)
            arm, world = self.setup.lab.robots[robot], self._world
            holding = world.robots[robot].holding
            lifts = holding and tool_pose(arm, after)[2] > tool_pose(arm, before)[2]
            if holding and lifts and abs(load - GRIPPER_MASS - self.setup.type_of(holding).geometry.mass) > LOAD_ERROR:
                return 0.0, ABNORMAL_CURRENT
            return self._contacts.free_share(world, robot, before, after, self.present())

    def fingers(self, robot: str, joints: Joints, wanted: float, now: float) -> float:
        """Return how far apart [mm] the fingers of a robot come to rest that are at `now` and go to `wanted`: at the
        part between them, which they then hold; what they open for is let go of."""
        with self._lock:
            self._stands(robot, joints)
            holding = self._world.robots[robot].holding
            between = self._between(robot, joints, now) if holding is None and wanted < now else None
            if between is not None and wanted <= self._width(between):
                self._take(robot, joints, holding := between)
            elif holding is not None and wanted > self._width(holding):
                self._let_go(robot, joints, holding)
                holding = None
            reached = max(wanted, self._width(holding)) if holding else wanted
            self._world = replace(self._world, openings={**self._world.openings, robot: reached})
            self.store()
            return reached

    def hold(self, robot: str, on: bool) -> None:
        """Let a hand that knows no width hold what is there, or let go of what it holds."""
        with self._lock:
            now = self._world.robots[robot]
            if on and now.holding is None and (there := self._between(robot, now.joints, math.inf)) is not None:
                self._take(robot, now.joints, there)
            elif not on and now.holding is not None:
                self._let_go(robot, now.joints, now.holding)
            self.store()

    def drive(self, robot: str, joint: int, value: float) -> None:
        """Let one joint of a robot be at a value [m, rad], with what it holds."""
        with self._lock:
            joints = list(self._world.robots[robot].joints)
            joints[joint] = value
            self.moved(robot, tuple(joints))

    def holding(self, robot: str) -> str | None:
        """Return the part in the hand of a robot."""
        with self._lock:
            return self._world.robots[robot].holding

    def sheet(self) -> Sheet | None:
        """Return the print that cameras see now, where it is."""
        with self._lock:
            if self.in_hand is None:
                return self.shown
            robot, print_ = self.in_hand
            tool = self._arms[robot].tool_in_space(self._world.robots[robot].joints, None)
            return replace(print_, pose=tool @ print_.pose)

    def width(self, robot: str) -> float:
        """Return how far apart the fingers of a robot are [mm]."""
        with self._lock:
            holding = self._world.robots[robot].holding
            stroke = self.setup.lab.robots[robot].gripper.stroke
            return self._world.openings.get(robot, self._width(holding) if holding else stroke)

    def joints(self, robot: str) -> Joints:
        """Return the nominal joints of an arm [rad]."""
        with self._lock:
            return self._world.robots[robot].joints

    def motors(self, robot: str) -> Joints:
        """Return the joints of an arm as its motors have them [rad]."""
        import numpy as np

        arm, joints = self._arms[robot], self.joints(robot)
        return tuple(float(q) for q in arm.told(np.array([joints]))[0])

    def nominal(self, robot: str, motors: Joints) -> Joints:
        """Return the nominal joints of an arm whose motors are at `motors` [rad]."""
        import numpy as np

        return self._arms[robot].taken(np.array(motors))

    def value(self, component: str, tunable: str) -> Value | None:
        """Return what a tunable truly reads; None where nobody knows, as before an axis was homed."""
        with self._lock:
            return self._world.components[component].values[tunable].value

    def set_value(self, component: str, tunable: str, value: Value) -> None:
        """Let a tunable be at a value."""
        with self._lock:
            if self._world.components[component].values[tunable] == ObservedValue(value=value):
                return
            self._world = self._world.with_value(component, tunable, ObservedValue(value=value))
            self.store()

    def stuck(self, component: str, tunable: str) -> bool:
        """Return whether no motor moves an axis any more."""
        with self._lock:
            return f"{component}.{tunable}" in self._world.stuck

    def pull(self, device: str, pulled: bool) -> None:
        """Pull a safety input by the device that reads it, or put it back; not kept."""
        (self._pulled.add if pulled else self._pulled.discard)(device)

    def present(self) -> tuple[Visitor, ...]:
        """Return the people of the scenario who are at the bench now."""
        return tuple(one for one in self._people if one.is_there(self._seconds()))

    def _seconds(self) -> float:
        """How long it has been there by its clock [s]."""
        return (self._wall() - self._began) * self.pace

    def safe(self, device: str) -> bool:
        """Return whether a safety input is as it should be: no person is at the table, none pulled it, and the scenario
        has it safe now. Of the people of the scenario only curtains know."""
        if device in self._unsafe and self._unsafe[device][0] <= self._seconds() < self._unsafe[device][1]:
            return False
        inputs = self.setup.wiring.safety_inputs.values() if self.setup.wiring else ()
        notices = any(one.kind == "curtain" and one.device == device for one in inputs)
        return not (self._world.person or device in self._pulled or (notices and self.present()))

    def recalled(self, device: str, what: str) -> Value | None:
        """Return what a device keeps of itself, as over a loss of its link; None where it was told nothing."""
        return self._devices.get(f"{device}.{what}", "") or None

    def remember(self, device: str, what: str, value: Value) -> None:
        """Let a device keep something of itself: it has power for as long as the world is there."""
        self._devices.put(f"{device}.{what}", value)

    # parts and hands

    def _stands(self, robot: str, joints: Joints) -> None:
        self._world = replace(
            self._world,
            robots={**self._world.robots, robot: replace(self._world.robots[robot], joints=tuple(joints))},
        )
        holding = self._world.robots[robot].holding
        if holding:
            pose = self._tool(robot, joints).compose(self._held[robot])
            self._world = self._world.with_body(holding, presence="held", pose=pose, free=None)

    def _between(self, robot: str, joints: Joints, opening: float) -> str | None:
        """Return the part that stands between the fingers of a robot; None where none does."""
        arm, tool = self.setup.lab.robots[robot], self._tool(robot, joints)
        height = tool_point(arm, joints)[2]
        for name, body in self._world.components.items():
            if name not in self.setup.lab.inventory or body.presence != "seen" or body.pose is None:
                continue
            geometry = self.setup.type_of(name).geometry
            if geometry.grasp is None or geometry.grasp.width > opening:
                continue
            off = abs(grasp_height(arm, geometry) - height)
            jaws = (angle_between(body.pose.yaw + yaw, tool.yaw) for yaw in geometry.grasp.yaws)
            along = min(min(abs(turn), 180 - abs(turn)) for turn in jaws)
            turned = along > ALONG and arm.gripper.fingers != "none"
            if tool.distance(body.pose) <= BETWEEN and off <= BETWEEN and not turned:
                return name
        return None

    def _take(self, robot: str, joints: Joints, name: str) -> None:
        pose = self._world.components[name].pose
        assert pose is not None  # it stands
        self._held[robot] = self._from_tool(robot, joints, pose)
        now = replace(self._world.robots[robot], holding=name)
        self._world = replace(self._world.with_body(name, presence="held"), robots={**self._world.robots, robot: now})

    def _let_go(self, robot: str, joints: Joints, name: str) -> None:
        """Let a part stand where the hand is, or lie there where that is too high above the table."""
        arm, geometry = self.setup.lab.robots[robot], self.setup.type_of(name).geometry
        pose = self._tool(robot, joints).compose(self._held.pop(robot))
        high = tool_point(arm, joints)[2] - grasp_height(arm, geometry) > DROP
        errs = injected(self.setup, name, self._learned, 0.0)
        at, seat = put_down(self.setup, self._world, name, pose, errs)
        self._world = self._world.with_body(
            name, presence="toppled" if high else "seen", pose=at, free=None,
            seat=seat if errs != PlacementError() or self._world.components[name].seat else None,
        )  # fmt: skip
        now = replace(self._world.robots[robot], holding=None)
        self._world = replace(self._world, robots={**self._world.robots, robot: now})

    def _width(self, name: str) -> float:
        grasp = self.setup.type_of(name).geometry.grasp
        return grasp.width if grasp else 0.0

    def _tool(self, robot: str, joints: Joints) -> Pose:
        """Where the tool of an arm truly is, seen from above."""
        arm = self._arms.get(robot)
        return arm.tool(joints, None) if arm else tool_of(self.setup.lab.robots[robot], joints)

    def _from_tool(self, robot: str, joints: Joints, pose: Pose) -> Pose:
        return self._tool(robot, joints).inverse().compose(pose)

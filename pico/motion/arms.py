"""The arms of a bench as the planner asks them: implements `pico.motion.types.Motion` for every robot of a lab.

`reach` is plain Python. MuJoCo is imported and a scene compiled when a motion is first asked for; a scene is compiled
again only when more components of a type stand within reach than ever before.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.geometry.tethers import turn_between
from pico.model.catalog import Geometry
from pico.model.observation import slot_at
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion import gantry
from pico.motion.reach import check_grip, check_height, check_reach, check_table, check_tether
from pico.motion.stability import check_stability
from pico.motion.travel import Travel
from pico.motion.types import Blocked, Joints, MovePath, StandingObject, Waypoint

if TYPE_CHECKING:
    from pico.motion.moves import Move
    from pico.motion.recheck import Recheck, Task
    from pico.motion.scene import Scene

ARM_REACH = 850.0
"""No part of an arm or its gripper comes farther from the base's axis than this [mm]."""
SMALL_LAB = 60
"""Up to so many parts the whole inventory is compiled at once."""


class ArmMotion:
    """The arms of `setup`. Not thread-safe: scenes are rearranged for each question."""

    def __init__(self, setup: Setup, *, second_check: bool = True) -> None:
        """`second_check`: look at every path that is found a second time, with other kinematics and collision code."""
        self.setup, self.second_check = setup, second_check
        self._scenes: dict[str, Scene] = {}
        self._rechecks: dict[str, Recheck] = {}
        self._travels: dict[str, Travel] = {}
        self._steady: dict[str, Blocked | None] = {}

    def reach(self, robot: str, component: str, pose: Pose, grasp_yaw: float) -> Blocked | None:
        """See `Motion.reach`. Raises KeyError for a robot or component that the lab does not have.

        Joint 7 turns twice around, so `grasp_yaw` decides nothing here; fingers and neighbors are the move's matter.
        """
        arm, geometry = self.setup.lab.robots[robot], self.setup.type_of(component).geometry
        found = (
            check_grip(robot, arm, component, geometry)
            or check_height(self.setup.lab, robot, component, geometry)
            or self._on_table(component, geometry, pose)
            or check_tether(self.setup, component, pose)
            or self._stability(component, geometry)
        )
        if found or arm.model == "gantry":
            return found
        return check_reach(robot, arm, component, geometry, pose)

    def move(
        self,
        robot: str,
        component: str,
        start: Pose,
        goal: Pose,
        grasp_yaw: float,
        standing: Mapping[str, StandingObject],
        joints: Joints | None = None,
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:
        """See `Motion.move`."""
        found = self.reach(robot, component, start, grasp_yaw) or self.reach(robot, component, goal, grasp_yaw)
        if found:
            return found
        arm, geometry = self.setup.lab.robots[robot], self.setup.type_of(component).geometry
        now = joints or self.park_joints(robot)
        if arm.model == "gantry":
            turn = turn_between(self.setup, component, start, goal)
            goal = goal if turn is None else replace(goal, yaw=start.yaw + turn)
            return gantry.move(self.setup.lab, robot, component, geometry, start, goal, grasp_yaw, standing, now)
        from pico.motion.moves import Move
        from pico.motion.recheck import Task

        near = self._near(robot, standing, geometry)
        elsewhere = self._others(robot, others)
        scene = self._scene(robot, near | {component: StandingObject(start, geometry)})
        scene.place_robots(elsewhere)
        path = Move(scene, component, geometry, start, goal, grasp_yaw, near, now).find()
        return self._twice(path, Task(component, geometry, start, goal, grasp_yaw), near, elsewhere)

    def set_down(
        self,
        robot: str,
        component: str,
        held: Pose,
        goal: Pose,
        standing: Mapping[str, StandingObject],
        joints: Joints,
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:
        """See `Motion.set_down`."""
        from pico.motion.kinematics import tool_of
        from pico.motion.setdown import SetDown, gantry_set_down

        arm, geometry = self.setup.lab.robots[robot], self.setup.type_of(component).geometry
        found = check_grip(robot, arm, component, geometry) or self.reach(robot, component, goal, 0.0)
        if found:
            return found
        if arm.model == "gantry":
            return gantry_set_down(robot, arm, component, geometry, held, goal, standing, joints)
        from pico.motion.recheck import Task

        near = {n: t for n, t in self._near(robot, standing, geometry).items() if n != component}
        elsewhere, jaws = self._others(robot, others), tool_of(arm, joints).yaw - held.yaw
        scene = self._scene(robot, near | {component: StandingObject(goal, geometry)})
        scene.place_robots(elsewhere)
        path = SetDown(scene, component, geometry, held, goal, jaws, near, joints).find()
        return self._twice(path, Task(component, geometry, held, goal, jaws), near, elsewhere)

    def take(
        self, robot: str, component: str, start: Pose, grasp_yaw: float, standing: Mapping[str, StandingObject],
        joints: Joints | None = None, others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.take`."""
        from pico.motion.setdown import Taking

        now = joints or self.park_joints(robot)
        return self._steered(Taking, robot, component, start, start, grasp_yaw, standing, now, others)

    def shift(
        self, robot: str, component: str, held: Pose, goal: Pose, standing: Mapping[str, StandingObject],
        joints: Joints, others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.shift`."""
        from pico.motion.setdown import Shifting

        return self._steered(Shifting, robot, component, held, goal, None, standing, joints, others)

    def let_go(
        self, robot: str, component: str, held: Pose, standing: Mapping[str, StandingObject], joints: Joints,
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:  # fmt: skip
        """See `Motion.let_go`."""
        from pico.motion.setdown import LettingGo

        return self._steered(LettingGo, robot, component, held, held, None, standing, joints, others)

    def _steered(
        self, kind: type[Move], robot: str, component: str, start: Pose, goal: Pose, grasp_yaw: float | None,
        standing: Mapping[str, StandingObject], joints: Joints, others: Mapping[str, Joints] | None,
    ) -> MovePath | Blocked:  # fmt: skip
        """What a person steers, checked twice; `grasp_yaw` None: as the hand at `joints` holds the part."""
        from pico.motion.kinematics import tool_of
        from pico.motion.recheck import Task

        arm, geometry = self.setup.lab.robots[robot], self.setup.type_of(component).geometry
        found = self.reach(robot, component, goal, 0.0)
        if found or arm.model == "gantry":
            return found or Blocked("reach", f"{robot} is a gantry, which nobody steers by hand yet")
        jaws = tool_of(arm, joints).yaw - start.yaw if grasp_yaw is None else grasp_yaw
        near = self._near(robot, standing, geometry)
        near = {n: t for n, t in near.items() if n != component or grasp_yaw is not None}
        elsewhere = self._others(robot, others)
        scene = self._scene(robot, near | {component: StandingObject(goal, geometry)})
        scene.place_robots(elsewhere)
        path = kind(scene, component, geometry, start, goal, jaws, near, joints).find()
        return self._twice(path, Task(component, geometry, start, goal, jaws), near, elsewhere)

    def use(
        self, robot: str, tool: str, start: Pose, points: Sequence[Waypoint], standing: Mapping[str, StandingObject],
        joints: Joints | None = None, others: Mapping[str, Joints] | None = None,
    ) -> tuple[MovePath, ...] | Blocked:  # fmt: skip
        """See `Motion.use`."""
        found, arm = self.reach(robot, tool, start, 0.0), self.setup.lab.robots[robot]
        if found or arm.model == "gantry":
            return found or Blocked("reach", f"{robot} is a gantry, which uses no tools yet")
        from pico.motion.recheck import Task
        from pico.motion.using import Using

        geometry = self.setup.type_of(tool).geometry
        assert geometry.grasp is not None  # `reach` asked
        near, elsewhere = self._near(robot, standing, geometry), self._others(robot, others)
        scene = self._scene(robot, near | {tool: StandingObject(start, geometry)})
        scene.place_robots(elsewhere)
        why: Blocked | None = None
        for yaw in geometry.grasp.yaws:
            now = joints or self.park_joints(robot)
            ways = Using(scene, tool, geometry, start, start, yaw, near, now, points=points).ways()
            if not isinstance(ways, Blocked):
                checked = (self._twice(w, Task(tool, geometry, start, start, yaw), near, elsewhere) for w in ways)
                return next((w for w in checked if isinstance(w, Blocked)), ways)
            why = why or ways
        return why or Blocked("reach", f"{tool} has nothing to hold it by")

    def park(
        self,
        robot: str,
        joints: Joints,
        standing: Mapping[str, StandingObject],
        others: Mapping[str, Joints] | None = None,
    ) -> MovePath | Blocked:
        """See `Motion.park`; no `joints` at all means that the arm is parked already."""
        arm = self.setup.lab.robots[robot]
        now = joints or self.park_joints(robot)
        if arm.model == "gantry":
            return gantry.park(self.setup.lab, robot, now, standing)
        from pico.motion.moves import find_park
        from pico.motion.recheck import Task

        near, elsewhere = self._near(robot, standing, None), self._others(robot, others)
        scene = self._scene(robot, near)
        scene.place_robots(elsewhere)
        return self._twice(find_park(scene, now, near), Task(), near, elsewhere)

    def park_joints(self, robot: str) -> Joints:
        """Return the joints of the robot's park pose [rad]; of a gantry [m, rad]."""
        return self._travel(robot).parked

    def travel(
        self,
        robot: str,
        start: Pose | Joints | None,
        goal: Pose | None,
        start_yaw: float = 0.0,
        goal_yaw: float = 0.0,
    ) -> float:
        """See `Motion.travel`."""
        return self._travel(robot).empty(start, goal, start_yaw, goal_yaw)

    def carry(self, robot: str, component: str, start: Pose, goal: Pose, grasp_yaw: float) -> float:
        """See `Motion.carry`."""
        return self._travel(robot).carry(component, start, goal, grasp_yaw)

    def _travel(self, robot: str) -> Travel:
        if robot not in self._travels:
            self._travels[robot] = Travel(self.setup, robot)
        return self._travels[robot]

    def _on_table(self, component: str, geometry: Geometry, pose: Pose) -> Blocked | None:
        found = check_table(self.setup.lab, component, geometry, pose)
        beside = found and found.kind == "table_edge" and self.setup.lab.beside_table(slot_at(self.setup, pose))
        return None if beside else found

    def _stability(self, component: str, geometry: Geometry) -> Blocked | None:
        if component not in self._steady:
            self._steady[component] = check_stability(component, geometry)
        return self._steady[component]

    def _others(self, robot: str, others: Mapping[str, Joints] | None) -> dict[str, Joints]:
        """The joints of the other arms that a path must keep clear of."""
        arms = [name for name, arm in self.setup.lab.robots.items() if name != robot and arm.model == "xarm7"]
        return {name: tuple((others or {}).get(name) or self.park_joints(name)) for name in arms}

    def _twice(
        self, path: MovePath | Blocked, task: Task, near: Mapping[str, StandingObject], others: Mapping[str, Joints]
    ) -> MovePath | Blocked:
        """Return `path` as it is where the second check agrees, else why it is refused."""
        if isinstance(path, Blocked) or not self.second_check:
            return path
        from pico.motion.recheck import Recheck

        if path.robot not in self._rechecks:
            self._rechecks[path.robot] = Recheck(self.setup, path.robot)
        return self._rechecks[path.robot].check(path, task, near, others) or path

    def _near(
        self, robot: str, standing: Mapping[str, StandingObject], held: Geometry | None
    ) -> dict[str, StandingObject]:
        from pico.motion.scene import within_reach

        return within_reach(self.setup, robot, standing, ARM_REACH + (held.footprint.radius if held else 0.0))

    def _scene(self, robot: str, standing: Mapping[str, StandingObject]) -> Scene:
        """Return the robot's scene, with a place for everything in `standing`."""
        from pico.motion.scene import Scene

        scene = self._scenes.get(robot)
        if scene is None:
            scene = self._scenes[robot] = Scene(self.setup, robot, self._pool(standing))
        lacking = scene.lacks(standing.values())
        if lacking:
            pool = scene.pool | {geometry: count + count // 2 for geometry, count in lacking.items()}
            scene = self._scenes[robot] = Scene(self.setup, robot, pool)
        return scene

    def _pool(self, standing: Mapping[str, StandingObject]) -> dict[Geometry, int]:
        """How many places of each geometry a new scene gets."""
        pool = Counter(thing.geometry for thing in standing.values())
        if len(self.setup.lab.inventory) <= SMALL_LAB:
            pool |= Counter(self.setup.type_of(name).geometry for name in self.setup.lab.inventory)
        return dict(pool)

"""What an emulated arm touches on its way: table, parts, strange objects, other arms and itself, by the shapes of
PICO's model at the joints where the arm is. It knows no plan, no margin and no keep-out zone."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from pico.backends.sim.world import World
from pico.model.catalog import Footprint, Geometry
from pico.model.instruments.emulation import Visitor
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.kinematics import tool_pose
from pico.motion.reach import grasp_height
from pico.motion.types import Joints, StandingObject

if TYPE_CHECKING:
    from pico.motion.scene import Scene

TOUCH = 1.0
"""How deep shapes overlap [mm] when the arm notices a collision; less is what parts and pads give."""
ABNORMAL_CURRENT, SELF_COLLISION = 31, 22
"""Controller errors C31 and C22 of the vendor's manual."""
LOAD_ERROR = 1.0
"""By how much the load that was set may differ from the true one [kg] before lifting it is taken for a collision."""
_REACH = 1000.0
"""No point of the arm or of what it carries moves farther than this for a radian of one joint [mm]."""
_STEP = 1.0
"""How far any point of the arm moves between two looks [mm], when it is close to something."""
_ROUNDING = 0.05
"""By how much a depth [mm] must grow to count as deeper."""


@dataclass
class Contacts:
    """The surroundings of the arms of one bench."""

    setup: Setup
    people: Collection[Visitor] = ()
    """The persons who are at the bench at one time or another."""
    _scenes: dict[str, Scene] = field(default_factory=dict)

    def free_share(
        self, world: World, robot: str, before: Joints, after: Joints, present: Collection[Visitor] = ()
    ) -> tuple[float, int]:
        """Return which share (0 to 1) of the straight way in joint space from `before` to `after` [rad] the arm can
        move, and the controller error that ends it: 31, 22 for a collision with itself, or 0 at the end of the way;
        `present`: who is there now.

        An arm that overlaps with something already, as after a collision, may move so that it gets no deeper."""
        way = _REACH * sum(abs(b - a) for a, b in zip(before, after, strict=True))
        if way < 1e-9:
            return 1.0, 0
        scene = self._arranged(world, robot, present)
        slack, _ = self._look(scene, world, robot, before)
        deepest, gone = _allowed(slack), 0.0
        while gone < way:
            there = min(way, gone + max(_STEP, slack))
            share = there / way
            joints = tuple(a + share * (b - a) for a, b in zip(before, after, strict=True))
            slack, fault = self._look(scene, world, robot, joints)
            if -slack > deepest:
                return gone / way, fault
            deepest, gone = min(deepest, _allowed(slack)), there
        return 1.0, 0

    def _look(self, scene: Scene, world: World, robot: str, joints: Joints) -> tuple[float, int]:
        """Return how far the arm is from touching anything [mm], negative by how deep it is in it; and what that is."""
        slack, hit = scene.look(joints)
        fault = SELF_COLLISION if hit and hit.kind == "self" else ABNORMAL_CURRENT
        holding = world.robots[robot].holding
        if holding:  # the scene leaves out what a hand carries over the table
            arm, geometry = self.setup.lab.robots[robot], self.setup.type_of(holding).geometry
            above = tool_pose(arm, joints)[2] - grasp_height(arm, geometry)
            if above < slack:
                return above, ABNORMAL_CURRENT
        return slack, fault

    def _arranged(self, world: World, robot: str, present: Collection[Visitor]) -> Scene:
        """Return the scene of an arm as the table is now, with who is there."""
        standing = self._standing(world)
        standing |= {f"person/{n}": StandingObject(Pose(one.x, one.y), _shape(one)) for n, one in enumerate(present)}
        scene = self._scenes.get(robot)
        if scene is None or scene.lacks(standing.values()):
            scene = self._scenes[robot] = self._scene(robot, standing)
        now = world.robots[robot]
        scene.arrange(standing)
        geometry = self.setup.type_of(now.holding).geometry if now.holding else None
        scene.hold(geometry, self._grasp_yaw(world, robot) if now.holding else 0.0)
        stroke = self.setup.lab.robots[robot].gripper.stroke
        width = geometry.grasp.width if geometry and geometry.grasp else stroke
        scene.open(world.openings.get(robot, width))
        scene.place_robots({name: arm.joints for name, arm in world.robots.items() if name != robot})
        return scene

    def _standing(self, world: World) -> dict[str, StandingObject]:
        """Return what stands on the table; how a toppled part lies is unknown, so it is left out."""
        found = {
            name: StandingObject(body.pose, self.setup.type_of(name).geometry)
            for name, body in world.components.items()
            if body.pose is not None and body.presence == "seen" and name in self.setup.lab.inventory
        }
        for name, thing in world.unknown.items():
            found[name] = StandingObject(thing.pose, Geometry(footprint=thing.footprint, height=thing.height, mass=0.0))
        return found

    def _scene(self, robot: str, standing: dict[str, StandingObject]) -> Scene:
        from pico.motion.scene import Scene

        lab = self.setup.lab
        bare = replace(lab, keep_out={}, margins=replace(lab.margins, body=0.0, fingers=0.0))
        pool = Counter(thing.geometry for thing in standing.values())
        pool |= Counter(self.setup.type_of(name).geometry for name in lab.inventory)
        pool |= Counter(_shape(one) for one in self.people)
        return Scene(replace(self.setup, lab=bare), robot, pool)

    def _grasp_yaw(self, world: World, robot: str) -> float:
        """Return along which of its directions the part in a hand is gripped [deg]: the nearest to how it is turned."""
        now = world.robots[robot]
        assert now.holding
        grasp, pose = self.setup.type_of(now.holding).geometry.grasp, world.components[now.holding].pose
        if grasp is None or pose is None:
            return 0.0
        tool = tool_pose(self.setup.lab.robots[robot], now.joints)[3]
        return min(grasp.yaws, key=lambda yaw: abs(math.remainder(pose.yaw + yaw - tool, 180.0)))


def _shape(person: Visitor) -> Geometry:
    """Return a person as a cylinder that stands on the level of the table."""
    return Geometry(footprint=Footprint(disc=person.radius), height=person.height, mass=0.0)


def _allowed(slack: float) -> float:
    """Return how deep [mm] an arm may be next that has this `slack` now."""
    return TOUCH if -slack <= TOUCH else -slack + _ROUNDING

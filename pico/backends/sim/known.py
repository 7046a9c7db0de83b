"""What a run knows of the simulated table: all of it exactly, or what a bench with cameras would know and no more."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from pico.backends.last_seen import Taken, recall_hands, remember_hands, repeated
from pico.backends.sim.mover import MoveFailed, WorldMover
from pico.backends.sim.senses import sensed
from pico.backends.sim.world import World, observe
from pico.model.observation import Observation, ObservedComponent
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.kinematics import tool_of
from pico.motion.types import MovePath

if TYPE_CHECKING:
    from pico.backends.sight import Look


class Known(Protocol):
    """What is known of the table while it moves. `corrections`: how often a part is set right that was put down
    wrongly."""

    corrections: int

    def seen(self) -> Observation:
        """Return the table as it is known now; raises MoveFailed where nothing can be seen."""
        ...

    def survey(self, component: str) -> Pose | None:
        """Look at a part before it is picked; return where it was seen, None where it was not."""
        ...

    def takes(self, component: str, path: MovePath) -> None:
        """Be told that a hand goes along `path` to take a part."""
        ...

    def confirm(self, component: str, near: Pose) -> ObservedComponent:
        """Look at a part that was put down near a pose, or lost, and return it."""
        ...


class Exactly:
    """The table itself."""

    corrections = 0

    def __init__(self, world: Callable[[], World]) -> None:
        self._world = world

    def seen(self) -> Observation:
        """Return the table as it is."""
        return observe(self._world(), "sim", "")

    def survey(self, component: str) -> Pose | None:
        """See it, always."""
        return self.seen().components[component].pose

    def takes(self, component: str, path: MovePath) -> None:
        """Know it anyway."""

    def confirm(self, component: str, near: Pose) -> ObservedComponent:
        """Return the part as it is."""
        return self.seen().components[component]


class BySight:
    """What frames, joints and pads tell. `look` looks at the whole table; between two of its looks only what was moved
    is looked at, in the regions of the pictures where it should be."""

    corrections = 2

    def __init__(
        self, setup: Setup, root: Path, world: Callable[[], World], mover: WorldMover, look: Callable[[], Look]
    ) -> None:
        self._setup, self._root, self._world, self._mover, self._look = setup, root, world, mover, look
        self._looked: Look | None = None
        self._parts: dict[str, ObservedComponent] = {}
        self._taken = recall_hands(root)

    def seen(self) -> Observation:
        """Return the table as it was last seen, with joints and hands as they are now; looks where it never did."""
        base = self._once().observation
        now = sensed(self._setup, self._world(), self._taken, base.backend, base.observed_at)
        parts = {
            name: felt if felt.presence == "held" else replace(self._parts[name], values=felt.values)
            for name, felt in now.components.items()
        }
        return replace(base, time=now.time, components=parts, robots=now.robots)

    def survey(self, component: str) -> Pose | None:
        """Look at a part from above; at the whole table where it is not where it was."""
        self._once()
        before = self._parts[component]
        if before.pose is None or before.presence != "seen":
            return None
        again = self._again(component, before.pose)
        if again is None and not self._hidden(component, before.pose):
            self._look_at_all()
        elif again is not None:
            self._parts[component] = again
        now = self._parts[component]
        return now.pose if now.how in ("stereo", "known height") else None

    def takes(self, component: str, path: MovePath) -> None:
        """Remember what a hand takes, and how, also for who comes after."""
        grip = next((s for s in path.segments if s.name == "grip"), None)
        stands = self._parts[component].pose
        if grip is not None and stands is not None:
            tool = tool_of(self._setup.lab.robots[path.robot], grip.joints[-1])
            self._taken[path.robot] = Taken(component=component, pose=tool.inverse().compose(stands))
            remember_hands(self._root, self._taken)

    def confirm(self, component: str, near: Pose) -> ObservedComponent:
        """Look at a part from above; where the arm hides it, the eye in the hand has seen it when it let go of it."""
        seen = self.seen()
        if any(robot.holding == component for robot in seen.robots.values()):
            return seen.components[component]
        found = self._again(component, near) or self._let_go(component)
        if found is None and self._hidden(component, near):
            found = ObservedComponent(pose=near, uncertainty=repeated(self._setup, component), how="placed")
        if found is None:
            self._look_at_all()
        else:
            self._parts[component] = found
        return self.seen().components[component]

    def _once(self) -> Look:
        if self._looked is None:
            self._looked = self._look_at_all()
        return self._looked

    def _look_at_all(self) -> Look:
        from pico.backends.sight import BLIND

        self._looked = self._look()
        seen = self._looked.observation
        blind = [problem for problem in seen.problems if problem.code in BLIND]
        if blind:
            raise MoveFailed(blind[0])
        self._parts = dict(seen.components)
        return self._looked

    def _again(self, component: str, near: Pose) -> ObservedComponent | None:
        from pico.backends.look_again import look_again

        return look_again(self._setup, component, near, self._mover.eyes(self._world()).frame, self._once().calibration)

    def _let_go(self, component: str) -> ObservedComponent | None:
        """The part as the eye in the hand saw it when its fingers opened."""
        seen = self._mover.left(component)
        return ObservedComponent(pose=seen.pose, uncertainty=seen.uncertainty, how="in hand") if seen else None

    def _hidden(self, component: str, near: Pose) -> bool:
        """Whether something that is known hides a place from all cameras over the table."""
        from pico.backends.occlusion import Occluders

        places = {n: p.pose for n, p in self._parts.items() if p.pose is not None and n != component}
        joints = {name: robot.joints for name, robot in self._world().robots.items()}
        cameras = self._once().calibration.cameras
        return Occluders(self._setup, places, joints, cameras).hides(component, near) is not None

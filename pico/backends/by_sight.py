"""What a run knows of a bench that is seen by cameras, and no more. For every backend."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.backends.attempt import Failed
from pico.backends.last_seen import LastSeen, Taken, recall, recall_hands, remember, remember_hands, repeated
from pico.model.observation import Observation, ObservedComponent
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.kinematics import tool_of
from pico.motion.types import MovePath
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.backends.look_again import Take
    from pico.backends.sight import Look
    from pico.twin.sight import InHand


SHOWN = ("stereo", "known height", "in hand")
"""How a part is known that a camera shows."""


class BySight:
    """What frames, joints and pads tell. `look` looks at the whole table; between two of its looks only what was moved
    is looked at, in the regions of the pictures (`take`) where it should be.

    `felt`: what is known without looking, given what hands took; `left`: where an eye in a hand saw a component when
    the hand let go of it. `place`: whose memory of hands this is, see `pico.backends.last_seen`. `corrections`: how
    often a part is set right that was put down wrongly.
    """

    corrections = 2

    def __init__(
        self, setup: Setup, place: BenchPlace, felt: Callable[[Mapping[str, Taken]], Observation],
        look: Callable[[], Look], take: Take, left: Callable[[str], InHand | None] = lambda component: None,
    ) -> None:  # fmt: skip
        self._setup, self._place, self._felt, self._look = setup, place, felt, look
        self._take, self._left = take, left
        self._looked: Look | None = None
        self._parts: dict[str, ObservedComponent] = {}
        self._taken = recall_hands(place)

    def seen(self) -> Observation:
        """Return the table as it was last seen, with joints and hands as they are now; looks where it never did.

        Raises Failed where nothing can be seen.
        """
        base = self._once().observation
        now = self._felt(self._taken)
        parts = {
            name: felt if felt.presence == "held" else replace(self._parts[name], values=felt.values)
            for name, felt in now.components.items()
        }
        return replace(base, time=now.time, components=parts, robots=now.robots)

    def survey(self, component: str) -> Pose | None:
        """Look at a part from above before it is picked, at the whole table where it is not where it was; return where
        it was seen, None where it was not."""
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
        """Remember what a hand goes along `path` to take, and how, also for who comes after."""
        grip = next((s for s in path.segments if s.name == "grip"), None)
        stands = self._parts[component].pose
        if grip is not None and stands is not None:
            tool = tool_of(self._setup.lab.robots[path.robot], grip.joints[-1])
            self._taken[path.robot] = Taken(component=component, pose=tool.inverse().compose(stands))
            remember_hands(self._place, self._taken)

    def lets_go(self, component: str, path: MovePath, now: float) -> None:
        """Remember where a hand on `path` is about to let go of a component, for who comes after: where this process is
        killed while the arm stands over it, no camera sees it. `now`: on the bench's clock [s]."""
        release = next((s for s in path.segments if s.name == "release"), None)
        taken = self._taken.get(path.robot)
        if release is not None and taken is not None and taken.component == component:
            pose = tool_of(self._setup.lab.robots[path.robot], release.joints[-1]).compose(taken.pose)
            there = LastSeen(pose=pose, uncertainty=repeated(self._setup, component), time=now, placed=True)
            remember(self._place, {**recall(self._place), component: there})

    def confirm(self, component: str, near: Pose) -> ObservedComponent:
        """Look from above at a part that was put down near a pose, and return it; where the arm hides it, the eye in
        the hand has seen it when it let go of it."""
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

    def find(self, component: str) -> ObservedComponent:
        """Look at the whole table for a part that was lost, and for those that it may have pushed; return it, `missing`
        if no camera shows it: a place that is hidden proves nothing of it."""
        if any(robot.holding == component for robot in self.seen().robots.values()):
            return self.seen().components[component]
        self._look_at_all()
        found = self.seen().components[component]
        if found.presence == "seen" and found.how not in SHOWN:
            self._parts[component] = found = ObservedComponent(presence="missing", values=found.values)
        return found

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
            raise Failed(blind[0])
        self._parts = dict(seen.components)
        return self._looked

    def _again(self, component: str, near: Pose) -> ObservedComponent | None:
        from pico.backends.look_again import look_again

        return look_again(self._setup, component, near, self._take, self._once().calibration)

    def _let_go(self, component: str) -> ObservedComponent | None:
        """The part as the eye in the hand saw it when its fingers opened."""
        seen = self._left(component)
        return ObservedComponent(pose=seen.pose, uncertainty=seen.uncertainty, how="in hand") if seen else None

    def _hidden(self, component: str, near: Pose) -> bool:
        """Whether something that is known hides a place from all cameras over the table."""
        from pico.backends.occlusion import Occluders

        places = {n: p.pose for n, p in self._parts.items() if p.pose is not None and n != component}
        joints = {name: robot.joints for name, robot in self._felt(self._taken).robots.items()}
        cameras = self._once().calibration.cameras
        return Occluders(self._setup, places, joints, cameras).hides(component, near) is not None

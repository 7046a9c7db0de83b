"""How a real bench is shown live: as it is known without looking, for that would light lamps and take its time."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import replace

from pico.backends.hardware.instruments import Instruments
from pico.backends.last_seen import recall, recall_hands
from pico.diagnostics import PicoError
from pico.model.observation import Observation, ObservedComponent, ObservedRobot
from pico.model.setup import Setup
from pico.motion.kinematics import tool_of, tool_point
from pico.motion.reach import grasp_height
from pico.motion.types import Joints
from pico.places.bench import BenchPlace
from pico.twin.arms import TwinArm
from pico.twin.moment import Moment, moment_of
from pico.twin.placement import Placement, upright


class Shown:
    """What is known of the bench at `place`: what was seen when somebody looked last, else
    where parts were last, and what became of operations since."""

    def __init__(self, setup: Setup, place: BenchPlace) -> None:
        self._setup, self._place = setup, place
        self._seen: Observation | None = None

    def looked(self, seen: Observation) -> None:
        """Hear what was seen."""
        self._seen = seen

    def became(self, name: str, after: ObservedComponent | None) -> None:
        """Hear how a component stands after an operation."""
        if after is not None and self._seen is not None:
            self._seen = replace(self._seen, components={**self._seen.components, name: after})

    async def moment(
        self, time: float, instruments: Instruments | None, built: Mapping[str, TwinArm], carried: Mapping[str, str]
    ) -> Moment:
        """Return the bench at its `time` [s]: arms as they report themselves over the links that are open, and what
        they have `carried` until now, by robot, in their hands."""
        seen = self._seen or self._recalled()
        joints = await _joints(instruments, built) if instruments is not None else {}
        holding = {name: one.holding for name, one in seen.robots.items() if one.holding} | dict(carried)
        robots = {
            name: replace(seen.robots.get(name) or ObservedRobot(joints=()), joints=at, holding=holding.get(name))
            for name, at in joints.items()
        }
        found = moment_of(replace(seen, time=time, robots={**seen.robots, **robots}))
        return self._with_hands(found, {name: part for name, part in holding.items() if name in joints})

    def _with_hands(self, found: Moment, holding: Mapping[str, str]) -> Moment:
        if not holding:
            return found
        places, components = dict(found.places), dict(found.seen.components)
        hands = recall_hands(self._place)
        for name, part in holding.items():
            taken, grasp = hands.get(name), self._setup.type_of(part).geometry.grasp
            if taken is None or taken.component != part or grasp is None:
                continue
            robot, joints = self._setup.lab.robots[name], found.seen.robots[name].joints
            pose = tool_of(robot, joints).compose(taken.pose)
            places[part] = _in_hand(
                upright(pose), tool_point(robot, joints)[2] - grasp_height(robot, self._setup.type_of(part).geometry)
            )
            before = components.get(part, ObservedComponent())
            components[part] = replace(before, presence="held", pose=pose, how="gripper")
        return replace(found, seen=replace(found.seen, components=components), places=places)

    def _recalled(self) -> Observation:
        """What is known where nobody has looked yet: parts where they were last, and where the lab fixes them."""
        fixed = {
            name: ObservedComponent(pose=part.pose, how="fixed")
            for name, part in self._setup.lab.inventory.items()
            if part.pose is not None
        }
        last = {
            name: ObservedComponent(pose=was.pose, uncertainty=was.uncertainty, how=was.kept)
            for name, was in recall(self._place).items()
            if name in self._setup.lab.inventory
        }
        return Observation(backend=self._place.name, components={**fixed, **last})


def _in_hand(place: Placement, height: float) -> Placement:
    x, y, _ = place.position
    return Placement((x, y, height / 1000), place.quaternion)


async def _joints(instruments: Instruments, built: Mapping[str, TwinArm]) -> dict[str, Joints]:
    """The joints of arms as they last reported them [rad]; without those of which the link is lost."""
    import numpy as np

    names = list(instruments.arms)
    states = await asyncio.gather(*(instruments.arms[name].state() for name in names), return_exceptions=True)
    found: dict[str, Joints] = {}
    for name, state in zip(names, states, strict=True):
        if isinstance(state, PicoError):
            continue
        if isinstance(state, BaseException):
            raise state
        motors = np.array(state.joints)
        found[name] = built[name].taken(motors) if name in built else tuple(state.joints)
    return found

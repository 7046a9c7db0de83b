"""The step that asks how far arms come, and what keeps them from going farther."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from pico.bench.commissioning.standing import AtBench, Found
from pico.diagnostics import PicoError, error
from pico.model.commissioning import CODE
from pico.model.robot import Robot
from pico.motion.deferred import DeferredMotion
from pico.motion.kinematics import tool_pose

Box = Mapping[str, tuple[float, float]]
"""Least and greatest of x, y, z in the frame of an arm's base [mm], of those axes that are limited."""


def reach(at: AtBench) -> Found:
    """Arms take their limits, and these are read back; parts can be fetched from where they are stowed; the fence of
    each arm, where the lab's files have one, has its park pose and the slots inside. Raises PicoError."""
    setup, motion = at.edge.setup, DeferredMotion(at.edge.setup)
    at.bench.wait(_taken(at))
    parts = [name for name in sorted(setup.lab.inventory) if setup.movable(name)]
    wrong, out, fences = [], {}, {}
    for name in parts:
        slots = {home} if (home := setup.lab.inventory[name].home) else set(setup.lab.slots)
        for slot in sorted(slots & setup.lab.slots.keys()):
            said = [motion.reach(robot, name, setup.lab.slots[slot].pose, 0.0) for robot in sorted(setup.lab.robots)]
            if all(said) and said[0] is not None:
                wrong.append(error(CODE, f"no arm reaches {name} at its home {slot}: {said[0].text}", address=name))
    for robot, arm in sorted(setup.lab.robots.items()):
        fence = fence_of(at, robot)
        fences[robot] = {axis: list(pair) for axis, pair in fence.items()}
        out[robot] = [slot for slot, place in setup.lab.slots.items()
                      if parts and motion.reach(robot, parts[0], place.pose, 0.0) is not None]  # fmt: skip
        wrong += [error(CODE, text, address=robot) for text in outside(robot, arm, fence)]
        if not fence:
            at.require(
                f"{robot} has no fence (`limits: {{x: ..., y: ..., z: ...}}` of its device): its tool goes as far "
                "as it reaches. Is nothing there that it could hit, and nobody?", by_person=True,
            )  # fmt: skip
    if wrong:
        raise PicoError(wrong)
    free = [robot for robot, box in fences.items() if not box]
    told = f"{len(parts)} parts are in reach where they are stowed, limits are read back"
    told += f"; no fence: {', '.join(free)}" if free else ""
    return Found(told=told, data={"fences": fences, "slots_out_of_reach": out})


def fence_of(at: AtBench, robot: str) -> Box:
    """Return where the lab's files let the tool of an arm be."""
    for name, entry in at.device.links.entries.items():
        if (entry.of or name) == robot and at.device.links.about().all[name] in at.device.links.about().arms.values():
            return {axis: entry.limits[axis] for axis in "xyz" if axis in entry.limits}
    return {}


def outside(robot: str, arm: Robot, fence: Box) -> Iterator[str]:
    """Yield where the tool of an arm parks outside of its fence, in words."""
    if arm.model != "xarm7":
        return
    x, y, z, _ = tool_pose(arm, arm.park_joints)
    turn = math.radians(-arm.mount.yaw)
    dx, dy = x - arm.mount.x, y - arm.mount.y
    own = {
        "x": dx * math.cos(turn) - dy * math.sin(turn), "y": dx * math.sin(turn) + dy * math.cos(turn),
        "z": z - arm.mount.z,
    }  # fmt: skip
    for axis, (low, high) in fence.items():
        if not low <= own[axis] <= high:
            yield f"{robot} parks outside of its fence: {axis} is {own[axis]:.0f} mm, of {low:g} to {high:g} mm"


async def _taken(at: AtBench) -> None:
    """Take the bench and give it back: what arms may do is told them, and read back."""
    await at.edge.release(await at.edge.acquire("pico commission"))

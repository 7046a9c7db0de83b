"""Moves in the physical twin that stop dead: `python benchmarks/taken_up.py [--moves 500] [--lab labs/shel]`.

Each random move is cut at a random instant, in mid-motion as a kill cuts it. The table is built again from what is
stored, as the next process finds it, and the part put back where it stood: set down out of the hand, or picked anew.
Wrong is a part that is missed, dropped, toppled or loose in the hand, one that ends beyond its tolerance, and any other
part that moved. Prints the counts by where the moves were cut; the exit code is 1 where anything is wrong.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from pick_and_place import ROOT, Run

from pico.backends.attempt import Failed
from pico.backends.checks import standing
from pico.backends.sim.mover import InProgress
from pico.backends.sim.physics import PhysicsWorld
from pico.backends.sim.store import world_from_json
from pico.backends.sim.world import World, new_world
from pico.manifest.load import load_folder
from pico.model.operation import Operation
from pico.model.pose import Pose, angle_between
from pico.model.record import as_json
from pico.motion.kinematics import tool_pose
from pico.motion.types import Blocked, MovePath

LATE = 1.15
"""Moves are cut up to this share of the time that was planned: corrections and waits come to that."""
STILL = 0.01
"""A part that nobody takes moves by no more [mm]."""
SLIP = (0.5, 0.2, 0.1)
"""Within half a second a part moves by no more in a hand that was taken up again: along the jaws, where the fingers
give way to a heavy one, across them, and down [mm]."""


def passed(physics: PhysicsWorld, work: InProgress, seconds: float = float("inf")) -> str:
    """Let `work` go on for so long or to its end; return why it failed where it did."""
    spent = 0.0
    try:
        while spent < seconds:
            wait = min(next(work), seconds - spent)
            physics.advance(wait)
            spent += wait
    except StopIteration:
        pass
    except Failed as exc:
        return exc.diagnostic.summary
    return ""


def back(run: Run, world: World, name: str, yaw: float, start: Pose) -> MovePath | Blocked:
    """Return the way that takes a part back to where it stood, out of the hand that holds it or from the table."""
    pose, things, robot = world.components[name].pose, standing(run.setup, world), world.robots[run.robot]
    if pose is None:
        return Blocked("reach", f"{name} is not there")
    if robot.holding == name:
        return run.motion.set_down(run.robot, name, pose, start, things, robot.joints)
    return run.motion.move(run.robot, name, pose, start, yaw, things, robot.joints)


def cut(run: Run, draw: random.Random, count: Counter[str]) -> Iterator[str]:
    """Make a move, cut it, take the table up again and put the part back; yield what is wrong."""
    run.world = before = run.physics.world(run.world)
    found = run.draw()
    if found is None:
        run.world, run.physics = fresh(run)
        return
    arguments, path = found
    operation = Operation(id="op", primitive="move", robot=run.robot, **arguments)
    name, start = operation.component, Pose(**operation.arguments["from"]["pose"])
    work = run.physics.move(operation, path)
    why = passed(run.physics, work, draw.uniform(0.0, LATE * path.seconds))
    left = world_from_json(json.loads(json.dumps(as_json(run.physics.world(before)))))
    held = left.robots[run.robot].holding
    where = f"{run.physics.stage(run.robot).segment}{', held' if held else ''}"
    count[where] += 1
    if why:
        yield f"{where}: {why}"
    run.physics = PhysicsWorld(run.setup, left)
    if held:
        yield from (f"{where}: {text}" for text in loosened(run, left, name))
    again = replace(operation, arguments={**operation.arguments, "to": {"pose": as_json(start)}})
    way = back(run, left, name, float(operation.arguments["grasp_yaw"]), start)
    why = way.text if isinstance(way, Blocked) else passed(run.physics, run.physics.move(again, way))
    run.world = run.physics.world(left)
    wrong = [why] if why else list(elsewhere(run, before, name, start))
    if wrong:
        run.world, run.physics = fresh(run)
    yield from (f"{where}: {text}" for text in wrong)


def fresh(run: Run) -> tuple[World, PhysicsWorld]:
    """Return the bench with every part at home."""
    world = new_world(run.setup)
    return world, PhysicsWorld(run.setup, world)


def loosened(run: Run, left: World, name: str) -> Iterator[str]:
    """Yield what becomes of a held part in half a second in which nothing is done."""
    physics = PhysicsWorld(run.setup, left)
    before = in_hand(run, physics, name)
    physics.advance(0.5)
    now, held = in_hand(run, physics, name), physics.twin.gripped(run.robot) == name
    if not held or any(abs(a - b) > most for a, b, most in zip(before, now, SLIP, strict=True)):
        yield f"{name} is{'' if held else ' not'} held after half a second, at {now} from the tool, not at {before}"


def in_hand(run: Run, physics: PhysicsWorld, name: str) -> tuple[float, float, float]:
    """Return where the base of a part is, seen from the tool [mm]."""
    x, y, z, yaw = tool_pose(run.setup.lab.robots[run.robot], physics.twin.joints(run.robot))
    place = physics.twin.placement(name)
    seen = Pose(x, y, yaw).inverse().compose(place.pose)
    return round(seen.x, 3), round(seen.y, 3), round(place.position[2] * 1000 - z, 3)


def elsewhere(run: Run, before: World, name: str, start: Pose) -> Iterator[str]:
    """Yield what does not stand where it stood before the move."""
    tolerance = run.setup.type_of(name).pose.tolerance
    for other, body in run.world.components.items():
        was = start if other == name else before.components[other].pose
        if body.pose is None or was is None or body.presence != "seen":
            yield f"{other} is {body.presence}"
            continue
        away, turned = body.pose.distance(was), abs(angle_between(was.yaw, body.pose.yaw))
        if away > (tolerance.position if other == name else STILL) or turned > tolerance.yaw:
            yield f"{other} is {away:.3f} mm and {turned:.3f} deg from where it was"


def main() -> int:
    """Cut moves, and take up what they leave."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=500)
    parser.add_argument("--lab", type=Path, default=ROOT / "labs" / "shel")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    run = Run(load_folder(given.lab).require()[0], given.seed)
    count, wrong, draw = Counter[str](), 0, random.Random(given.seed)
    for number in range(given.moves):
        for text in cut(run, draw, count):
            wrong += 1
            print(f"move {number}: {text}", flush=True)
    told = ", ".join(f"{phase} {n}" for phase, n in sorted(count.items()))
    print(f"{sum(count.values())} moves cut in {run.setup.lab.name}: {told}; {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

"""Random picks and places in the physical twin: how far from its goal a part comes to rest, and how long it takes.

    python benchmarks/pick_and_place.py [--moves 40] [--lab labs/shel] [--friction 1.0] [--seed 1]

Each move takes a random component from where the last one left it to a random pose within reach, at any yaw, along the
path that the planner finds. Gravity, contacts and friction are real; the pose in the hand is measured exactly, so
these are errors of the mechanics alone.
"""

from __future__ import annotations

import argparse
import random
import statistics
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from pico.backends.sim.judge import standing  # noqa: E402
from pico.backends.sim.mover import MoveFailed  # noqa: E402
from pico.backends.sim.physics import PhysicsWorld  # noqa: E402
from pico.backends.sim.world import World, new_world  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402
from pico.model.lab import Setup  # noqa: E402
from pico.model.operation import Operation, Reason  # noqa: E402
from pico.model.pose import Pose  # noqa: E402
from pico.model.record import as_json  # noqa: E402
from pico.motion.arms import ArmMotion  # noqa: E402
from pico.motion.types import Blocked, MovePath  # noqa: E402

APART = 100.0
"""Least distance of a goal from any other part's origin [mm]."""


@dataclass(frozen=True)
class Trial:
    """One move: what it returned or why it failed, the seconds predicted, simulated, and spent here."""

    data: dict[str, float]
    failure: str
    predicted: float
    simulated: float
    wall: float


def trials(setup: Setup, count: int, seed: int, friction: float | None) -> Iterator[Trial]:
    """Move random components one after the other, as the table is left by each."""
    rnd, motion, robot = random.Random(seed), ArmMotion(setup), next(iter(setup.lab.robots))
    world = new_world(setup)
    physics = PhysicsWorld(setup, world, friction=friction)
    for number in range(count):
        world = physics.world(world)
        found = draw(setup, world, rnd, motion, robot)
        if found is None:
            return
        operation, path = found
        yield run(physics, Operation(id=f"op{number}", primitive="move", robot=robot, **operation), path)


def draw(setup: Setup, world: World, rnd: random.Random, motion: ArmMotion, robot: str) -> tuple[dict, MovePath] | None:
    """Return a move that has a path, or None where no component can be moved any more."""
    names = [n for n, body in sorted(world.components.items()) if setup.movable(n) and body.presence == "seen"]
    width, depth = setup.lab.table.size
    for _ in range(500 if names else 0):
        name = rnd.choice(names)
        start, grasp = world.components[name].pose, setup.type_of(name).geometry.grasp
        goal = Pose(rnd.uniform(60, width - 60), rnd.uniform(60, depth - 60), rnd.uniform(-180, 180))
        others = [b.pose for n, b in world.components.items() if n != name and b.pose]
        if start is None or grasp is None or any(goal.distance(pose) < APART for pose in others):
            continue
        yaw = rnd.choice(grasp.yaws)
        path = motion.move(robot, name, start, goal, yaw, standing(setup, world), world.robots[robot].joints)
        if not isinstance(path, Blocked):
            arguments = {"from": {"pose": as_json(start)}, "to": {"pose": as_json(goal)}, "grasp_yaw": yaw}
            return {"component": name, "arguments": arguments, "reason": Reason(kind="asked")}, path
    return None


def run(physics: PhysicsWorld, operation: Operation, path: MovePath) -> Trial:
    """Execute one move to its end."""
    began, simulated, data, failure = time.perf_counter(), 0.0, {}, ""
    work = physics.move(operation, path)
    try:
        while True:
            seconds = next(work)
            physics.advance(seconds)
            simulated += seconds
    except StopIteration as stop:
        data = stop.value
    except MoveFailed as exc:
        failure = exc.diagnostic.summary
    return Trial(data, failure, path.seconds, simulated, time.perf_counter() - began)


def spread(values: list[float], unit: str) -> str:
    """Return median, 95th percentile and greatest of `values`."""
    ordered = sorted(values)
    p95 = ordered[min(len(ordered) - 1, round(0.95 * (len(ordered) - 1)))]
    return f"median {statistics.median(ordered):.4f}, p95 {p95:.4f}, max {ordered[-1]:.4f} {unit}"


def main() -> int:
    """Run the moves and print the figures; the exit code is 1 where a part was lost."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=40)
    parser.add_argument("--lab", type=Path, default=ROOT / "labs" / "shel")
    parser.add_argument("--friction", type=float, default=None, help="of the pads; the lab's where not given")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    setup, _ = load_folder(given.lab).require()
    done = list(trials(setup, given.moves, given.seed, given.friction))
    good = [trial for trial in done if not trial.failure]
    for trial in done:
        if trial.failure:
            print(f"failed: {trial.failure}")
    print(f"{len(done)} moves, {len(done) - len(good)} lost")
    if good:
        for key, unit in (("error_mm", "mm"), ("error_deg", "deg"), ("correction_mm", "mm"), ("correction_deg", "deg")):
            print(f"{key:15s} {spread([t.data[key] for t in good], unit)}")
        wall, simulated = [t.wall for t in good], sum(t.simulated for t in good)
        print(f"{'wall':15s} {spread(wall, 's a move')}")
        predicted = sum(t.predicted for t in good) / len(good)
        print(f"{'simulated':15s} {simulated / len(good):.1f} s a move (path {predicted:.1f} s)")
        print(f"{'real time':15s} x {simulated / sum(wall):.0f}")
    return int(len(good) < len(done))


if __name__ == "__main__":
    sys.exit(main())

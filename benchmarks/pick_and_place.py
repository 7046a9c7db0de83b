"""Random picks and places in the physical twin: how far from its goal a part comes to rest, and how long it takes.

    python benchmarks/pick_and_place.py [--moves 200] [--lab labs/shel] [--sight pixels none] [--seed 1]

Each move takes a random component from where the last one left it to a random pose within reach, at any yaw, along the
path that the planner finds. Gravity, contacts and friction are real. The hand goes to where the part is believed to be,
which is wrong by `--pick-error` (one sigma in x, y and yaw). What sees the part in the hand then:

    pixels  the eye in the hand, in rendered pictures; every camera is wrong by --camera-error (position [mm], turn
            [deg], focal length [%]) in a random direction, and nothing that looks through it knows
    exact   the simulated truth: the errors of the mechanics alone
    none    nothing: parts are placed as if they were in the hand where the path means them to be

Arms and what they carry are looked at in every step of the simulation; what they touch is printed.
"""

from __future__ import annotations

import argparse
import random
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from oracles.penetration import Watch  # noqa: E402

from pico.backends.attempt import Failed  # noqa: E402
from pico.backends.checks import standing  # noqa: E402
from pico.backends.sim.physics import PhysicsWorld  # noqa: E402
from pico.backends.sim.world import new_world  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402
from pico.model.operation import Operation, Reason  # noqa: E402
from pico.model.pose import Pose, angle_between  # noqa: E402
from pico.model.record import as_json  # noqa: E402
from pico.model.setup import Setup  # noqa: E402
from pico.model.simulated import SimErrors  # noqa: E402
from pico.motion.arms import ArmMotion  # noqa: E402
from pico.motion.types import Blocked, MovePath, StandingObject  # noqa: E402
from pico.twin.physics import Twin  # noqa: E402
from pico.twin.sight import Exact, HandSight  # noqa: E402

APART = 100.0
"""Least distance of a goal from any other part's origin [mm]."""

Seeing = Callable[[Twin], HandSight] | None


@dataclass(frozen=True)
class Trial:
    """One move: what it returned or why it failed, the seconds predicted, simulated, spent
    here, and of CPU for its path."""

    data: dict[str, float]
    failure: str
    predicted: float
    simulated: float
    wall: float
    cpu: float
    path: float = 0.0


@dataclass
class Run:
    """Moves of random components one after the other, as the table is left by each.

    `off`: by how much the hand misjudges where a part stands, sigma in x and y [mm] and yaw [deg].
    """

    setup: Setup
    seed: int
    friction: float | None = None
    sight: Seeing = Exact
    off: tuple[float, float] = (0.0, 0.0)
    apart: float = APART
    watched: bool = False

    def __post_init__(self) -> None:
        self.random, self.motion = random.Random(self.seed), ArmMotion(self.setup)
        self.robot = next(iter(self.setup.lab.robots))
        self.world = new_world(self.setup)
        self.physics = PhysicsWorld(self.setup, self.world, friction=self.friction, sight=self.sight)
        self.watch = Watch(self.physics.twin) if self.watched else None

    def trials(self, count: int) -> Iterator[Trial]:
        """Yield the moves as they are made."""
        for number in range(count):
            self.world = self.physics.world(self.world)
            found = self.draw()
            if found is None:
                return
            operation, path = found
            yield self._run(Operation(id=f"op{number}", primitive="move", robot=self.robot, **operation), path)

    def draw(self) -> tuple[dict, MovePath] | None:
        """Return a move that has a path, or None where no component can be moved any more."""
        rnd, setup, world = self.random, self.setup, self.world
        names = [n for n, body in sorted(world.components.items()) if setup.movable(n) and body.presence == "seen"]
        width, depth = setup.lab.table.size
        for _ in range(5000 if names else 0):
            name = rnd.choice(names)
            start, geometry = world.components[name].pose, setup.type_of(name).geometry
            goal = Pose(rnd.uniform(60, width - 60), rnd.uniform(60, depth - 60), rnd.uniform(-180, 180))
            others = [b.pose for n, b in world.components.items() if n != name and b.pose]
            if start is None or geometry.grasp is None or any(goal.distance(pose) < self.apart for pose in others):
                continue
            yaw, believed = rnd.choice(geometry.grasp.yaws), self._misjudged(start)
            things = standing(setup, world) | {name: StandingObject(believed, geometry)}
            cpu = time.process_time()
            path = self.motion.move(self.robot, name, believed, goal, yaw, things, world.robots[self.robot].joints)
            self.path_cpu = time.process_time() - cpu
            if not isinstance(path, Blocked):
                arguments = {"from": {"pose": as_json(believed)}, "to": {"pose": as_json(goal)}, "grasp_yaw": yaw}
                return {"component": name, "arguments": arguments, "reason": Reason(kind="asked")}, path
        return None

    def _misjudged(self, pose: Pose) -> Pose:
        position, yaw = self.off
        dx, dy, turn = (self.random.gauss(0.0, sigma) for sigma in (position, position, yaw))
        return Pose(pose.x + dx, pose.y + dy, pose.yaw + turn)

    def _run(self, operation: Operation, path: MovePath) -> Trial:
        """Execute one move to its end."""
        began, cpu, simulated = time.perf_counter(), time.process_time(), 0.0
        data, failure = {}, ""
        work = self.physics.move(operation, path)
        try:
            while True:
                seconds = next(work)
                self.physics.advance(seconds)
                simulated += seconds
        except StopIteration as stop:
            data = {**stop.value, **self._off(operation)}
        except Failed as exc:
            failure = exc.diagnostic.summary
        spent = time.perf_counter() - began, time.process_time() - cpu
        return Trial(data, failure, path.seconds, simulated, *spent, self.path_cpu)

    def _off(self, operation: Operation) -> dict[str, float]:
        """How far from its goal the part really stands."""
        goal = Pose(**operation.arguments["to"]["pose"])
        pose = self.physics.world(self.world).components[operation.component].pose
        assert pose is not None  # else the move has failed
        return {"error_mm": pose.distance(goal), "error_deg": abs(angle_between(goal.yaw, pose.yaw))}


def pixels(setup: Setup, seed: int) -> Callable[[Twin], HandSight]:
    """Return what makes the sight from rendered pictures, with the lab's errors of cameras drawn by `seed`."""
    from pico.cameras.eye_in_hand import EyeInHand
    from pico.cameras.simulated import Eyes
    from pico.vision.nominal import camera_models

    return lambda twin: EyeInHand(setup, twin, Eyes(setup, twin.model, twin.data, seed=seed), camera_models(setup))


def erring(setup: Setup, position: float, turn: float, percent: float) -> Setup:
    """Return the bench with what is wrong with its cameras."""
    errors = SimErrors(camera_position=position, camera_rotation=turn, focal_length=percent / 100)
    return replace(setup, lab=replace(setup.lab, sim=replace(setup.lab.sim, errors=errors)))


def spread(values: list[float], digits: int = 3) -> str:
    """Return median, 95th percentile and greatest of `values`."""
    ordered = sorted(values)
    p95 = ordered[min(len(ordered) - 1, round(0.95 * (len(ordered) - 1)))]
    return " / ".join(f"{v:.{digits}f}" for v in (statistics.median(ordered), p95, ordered[-1]))


def report(name: str, run: Run, done: list[Trial]) -> bool:
    """Print the figures of a run; return whether nothing was lost and nothing hit."""
    good = [trial for trial in done if not trial.failure]
    for trial in done:
        if trial.failure:
            print(f"failed: {trial.failure}")
    keys = ("error_mm", "error_deg", "correction_mm") if good else ()
    columns = [spread([t.data[key] for t in good]) for key in keys]
    cpu, wall = sum(t.cpu for t in done) / len(done), sum(t.wall for t in done) / len(done)
    print(f"{name:12s} {len(done):5d} {len(done) - len(good):5d}  " + "  ".join(f"{c:21s}" for c in columns)
          + f"  {cpu:5.2f} {wall:5.2f}  x{sum(t.simulated for t in done) / sum(t.wall for t in done):.0f}")  # fmt: skip
    if run.watch is None:
        return len(good) == len(done)
    print(f"{'':12s} {run.watch.steps} steps looked at, deepest overlap {run.watch.deepest:.3f} mm")
    for touch in run.watch.touches.values():
        print(f"touched: {touch.first} and {touch.second} by {touch.depth:.2f} mm at {touch.time:.2f} s")
    return len(good) == len(done) and not run.watch.touches


def main() -> int:
    """Run the moves and print the figures; the exit code is 1 where a part was lost or anything was touched."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=200)
    parser.add_argument("--lab", type=Path, default=ROOT / "labs" / "shel")
    parser.add_argument("--sight", nargs="+", choices=("pixels", "exact", "none"), default=("pixels", "none"))
    parser.add_argument("--pick-error", nargs=2, type=float, default=(2.0, 2.0), metavar=("MM", "DEG"))
    parser.add_argument("--camera-error", nargs=3, type=float, default=(0.2, 0.05, 0.5), metavar=("MM", "DEG", "%"))
    parser.add_argument("--friction", type=float, default=None, help="of the pads; the lab's where not given")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    setup = erring(load_folder(given.lab).require()[0], *given.camera_error)
    seeing: dict[str, Seeing] = {"pixels": pixels(setup, given.seed), "exact": Exact, "none": None}
    print(f"pick error {given.pick_error[0]:g} mm, {given.pick_error[1]:g} deg; cameras wrong by {given.camera_error}")
    print("median / p95 / max                error [mm]             error [deg]            in hand off by [mm]    "
          "cpu   wall [s]  real time")  # fmt: skip
    well = True
    for name in given.sight:
        run = Run(setup, given.seed, given.friction, seeing[name], tuple(given.pick_error), watched=True)
        well = report(name, run, list(run.trials(given.moves))) and well
    return int(not well)


if __name__ == "__main__":
    sys.exit(main())

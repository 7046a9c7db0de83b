"""Random picks and places among twenty parts: how long a path takes to find, and whether the checks agree on it.

    python benchmarks/motion.py [--moves 200] [--parts 20] [--spacing 90] [--seed 1]

Parts of four shapes stand at random, two of them taller than the transit height, on a table of 1200 mm x 900 mm. Each
move takes one more part from a random place to another, at any yaw. Times are of whole moves (reached, searched, looked
at and timed) and of the processor, so that what else the machine does is left out. Every accepted path is then looked
at by MuJoCo again at a quarter of the step, in a scene compiled for it, and by the second check.
"""

from __future__ import annotations

import argparse
import math
import random
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "motion")]

from benchtop import DISC, PART, TALL, TRIANGLE, bench, collisions  # noqa: E402

from pico.model.catalog import Geometry  # noqa: E402
from pico.model.pose import Pose  # noqa: E402
from pico.motion.arms import ARM_REACH, ArmMotion  # noqa: E402
from pico.motion.paths import STEP  # noqa: E402
from pico.motion.recheck import Recheck, Task  # noqa: E402
from pico.motion.scene import within_reach  # noqa: E402
from pico.motion.types import MovePath, StandingObject  # noqa: E402

BAR = 15.0
"""What the median of a whole move may take without the second check [ms]."""
STANDING = (PART, DISC, PART, TRIANGLE)
HELD = {"a": PART, "disc": DISC}


@dataclass(frozen=True)
class Question:
    """One move to plan."""

    component: str
    start: Pose
    goal: Pose
    grasp_yaw: float
    standing: dict[str, StandingObject]

    @property
    def geometry(self) -> Geometry:
        """Of the part that is moved."""
        return HELD[self.component]


def questions(parts: int, spacing: float, seed: int) -> Iterator[Question]:
    """Draw tables of `parts` parts, no two origins nearer than `spacing` [mm]."""
    rnd = random.Random(seed)
    while True:
        poses: list[Pose] = []
        for _ in range(2000):
            pose = Pose(rnd.uniform(100, 860), rnd.uniform(100, 560), rnd.uniform(-180, 180))
            free = all(pose.distance(other) > spacing for other in poses)
            if free and 260 < math.hypot(pose.x - 480, pose.y - 760) < 660:
                poses.append(pose)
            if len(poses) == parts + 2:
                break
        else:
            continue
        standing = {
            f"t{i}": StandingObject(pose, TALL if i < 2 else STANDING[i % 4]) for i, pose in enumerate(poses[2:])
        }  # fmt: skip
        yield Question(rnd.choice(sorted(HELD)), poses[0], poses[1], rnd.choice((0.0, 90.0)), standing)


def timed(work: Callable[[], object]) -> tuple[object, float]:
    """Return what `work` returns, and how long it took [ms]."""
    began = time.process_time()
    found = work()
    return found, 1000 * (time.process_time() - began)


def spread(values: list[float]) -> str:
    """Return median and 95th percentile of times [ms]."""
    ordered = sorted(values)
    return f"median {statistics.median(ordered):6.1f} ms, p95 {ordered[round(0.95 * (len(ordered) - 1))]:6.1f} ms"


@dataclass
class Figures:
    """What was measured: milliseconds without, with and of the second check; of refusals; and what went wrong."""

    plain: list[float]
    twice: list[float]
    second: list[float]
    refusals: list[float]
    failed: int = 0
    disagreed: int = 0


def measure(count: int, parts: int, spacing: float, seed: int) -> Figures:
    """Plan until `count` moves have a path."""
    setup = bench()
    once, twice, check = ArmMotion(setup, second_check=False), ArmMotion(setup), Recheck(setup, "arm1")
    figures = Figures([], [], [], [])
    for question in questions(parts, spacing, seed):
        q = question
        ask = ("arm1", q.component, q.start, q.goal, q.grasp_yaw, q.standing)
        path, milliseconds = timed(lambda ask=ask: once.move(*ask))
        if not isinstance(path, MovePath):
            figures.refusals.append(milliseconds)
            continue
        figures.plain.append(milliseconds)
        answer, milliseconds = timed(lambda ask=ask: twice.move(*ask))
        figures.twice.append(milliseconds)
        task = Task(q.component, q.geometry, q.start, q.goal, q.grasp_yaw)
        near = within_reach(setup, "arm1", q.standing, ARM_REACH + 50)
        disagreement, milliseconds = timed(lambda p=path, t=task, n=near: check.check(p, t, n, {}))
        figures.second.append(milliseconds)
        figures.disagreed += disagreement is not None or answer != path
        found = collisions(once, path, q.geometry, q.start, q.goal, q.grasp_yaw, q.standing, STEP / 4)
        figures.failed += bool(found)
        for line in {*found, *([disagreement.text] if disagreement else [])}:
            print(f"  {line}")
        if len(figures.plain) == count:
            return figures
    raise AssertionError("questions never end")


def times(count: int, seed: int) -> str:
    """Return how long the times of empty ways take to compute, first and repeated."""
    rnd, motion = random.Random(seed), ArmMotion(bench())
    poses = [Pose(rnd.uniform(150, 810), rnd.uniform(150, 500), rnd.uniform(-180, 180)) for _ in range(count)]
    pairs = [(a, b) for a in poses for b in poses]
    costs = [timed(lambda: [motion.travel("arm1", a, b) for a, b in pairs])[1] for _ in range(2)]
    first, again = (1000 * cost / len(pairs) for cost in costs)
    return f"{count} x {count} travel times: {first:.0f} us each, {again:.1f} us when asked again"


def main() -> int:
    """Print the figures; the exit code is 1 where a check fails, 3 where only the median is over its limit."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=200)
    parser.add_argument("--parts", type=int, default=20)
    parser.add_argument("--spacing", type=float, default=90.0, help="least distance of two parts' origins [mm]")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    figures = measure(given.moves, given.parts, given.spacing, given.seed)
    median = statistics.median(figures.plain)
    print(f"{given.moves} moves among {given.parts} parts, {len(figures.refusals)} refused")
    print(f"planned and timed            {spread(figures.plain)}   (bar: median {BAR:.0f} ms)")
    print(f"with the second check        {spread(figures.twice)}")
    print(f"the second check by itself   {spread(figures.second)}")
    if figures.refusals:
        print(f"refusals                     {spread(figures.refusals)}")
    print(f"fail at a quarter of the step  {figures.failed}   (bar: 0)")
    print(f"second check disagrees         {figures.disagreed}   (bar: 0)")
    print(times(60, given.seed))
    return 1 if figures.failed or figures.disagreed else 3 if median > BAR else 0


if __name__ == "__main__":
    sys.exit(main())

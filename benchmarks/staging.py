"""Fewest staging moves, counted and timed: `python benchmarks/staging.py rearrangement_instances.json`.

First the classical problem on the instances of a file: discs, no fingers, storage off the table. `greedy` breaks the
first cycle that it comes across, again and again. Then random tables with a gripper: 22 x 14 mm fingers that open
10 mm, discs with four grasp yaws, boxes with two. `bodies` is what would be staged if fingers needed no room. Seconds
are those of the solver alone.

`--plan`: make a lab of each instance of the file instead, a gantry without fingers and slots beside the table, and take
the whole way: target, order, slots, paths of the gantry, schedule. Seconds are those of the plan; each is walked by the
tests' independent checker. In the file discs are in one another's way strictly below two radii, on our tables where
they touch as well: no pair of its places touches, which is checked.
"""

from __future__ import annotations

import argparse
import json
import math
import random
import statistics
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "planning"), str(ROOT / "tests" / "staging")]

from feedback_cases import all_to_move  # noqa: E402

from pico.geometry import Shape, conflict, finger_zones, placed  # noqa: E402
from pico.model.catalog import Footprint, Grasp  # noqa: E402
from pico.model.pose import Pose  # noqa: E402
from pico.model.robot import Gripper  # noqa: E402
from pico.staging.feedback import (  # noqa: E402
    Arc,
    Component,
    Option,
    PartEvent,
    StagingAnswer,
    StagingProblem,
    arrives,
    leaves,
    solve,
)

TABLES = [
    (kind, n, density)
    for kind in ("discs", "mixed")
    for n, density in ((20, 0.2), (20, 0.3), (50, 0.2), (50, 0.3), (100, 0.2))
]


def main() -> int:
    """Print both tables; the exit code is 1 where a count differs from the known optimum."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("instances", type=Path, help="JSON with discs, starts, goals and known optima")
    parser.add_argument("--tables", type=int, default=10, help="random tables of each kind")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--plan", action="store_true", help="plan the instances as labs, from end to end")
    given = parser.parse_args()
    solve(StagingProblem((Component((), (Option(0),), (Option(0),)), Component((Option(0),)))))  # imports are not timed
    instances = json.loads(given.instances.read_text())["instances"]
    if given.plan:
        return int(planned(instances) > 0)
    wrong = classical(instances)
    print()
    with_fingers(given.tables, given.seed)
    return int(wrong > 0)


def timed(work: Callable[[], Any]) -> tuple[Any, float]:
    began = time.perf_counter()
    return work(), time.perf_counter() - began


def classical(instances: Sequence[dict[str, Any]]) -> int:
    """Print a row for each density and size; returns how many counts are not the optimum."""
    print(f"{'density':>7} {'n':>4} {'greedy':>7} {'staged':>7} {'optimum':>8} {'equal':>6} {'proven':>7} "
          f"{'median s':>9} {'max s':>7}")  # fmt: skip
    wrong = 0
    for density, n in sorted({(i["density"], i["n"]) for i in instances}):
        cell = [i for i in instances if (i["density"], i["n"]) == (density, n)]
        graphs = [depends(i) for i in cell]
        answers = [timed(lambda g=g: solve(all_to_move(g))) for g in graphs]
        known = [(i["min_staging"], a.count) for i, (a, _) in zip(cell, answers, strict=True)
                 if i["min_staging"] is not None]  # fmt: skip
        wrong += sum(best != count for best, count in known)
        seconds = [s for _, s in answers]
        print(f"{density:7} {n:4} {mean(map(first_cycle, graphs)):7.2f} {mean(a.count for a, _ in answers):7.2f} "
              f"{mean(best for best, _ in known):8.2f} {sum(b == c for b, c in known):3}/{len(known):<2} "
              f"{sum(a.proven for a, _ in answers):4}/{len(answers):<2} {statistics.median(seconds):9.3f} "
              f"{max(seconds):7.3f}")  # fmt: skip
    return wrong


def planned(instances: Sequence[dict[str, Any]]) -> int:
    """Print a row for each density and size of labs planned; returns how many are not the optimum, not proven to be,
    or have a fault."""
    from checker import check
    from disc_labs import disc_case

    from pico.motion.arms import ArmMotion
    from pico.planning import PlanGoal, Planner

    print(f"{'density':>7} {'n':>4} {'staged':>7} {'optimum':>8} {'equal':>6} {'proven':>7} {'faults':>7} "
          f"{'moves':>6} {'median s':>9} {'max s':>7}")  # fmt: skip
    wrong = 0
    for density, n in sorted({(i["density"], i["n"]) for i in instances}):
        cell = [i for i in instances if (i["density"], i["n"]) == (density, n)]
        cases = [disc_case(i["radius"], 1000.0, i["start"], i["goal"]) for i in cell]
        made = [timed(lambda c=c: Planner(c.setup, ArmMotion(c.setup), c.seen).plan(PlanGoal(c.wanted))) for c in cases]
        staging, seconds = [p.staging for p, _ in made], [s for _, s in made]
        best = [i["min_staging"] for i in cell]
        equal = [s.count == b for s, b in zip(staging, best, strict=True)]
        faults = [bool(p.errored or check(c.setup, c.seen, c.wanted, p, extensions=2))
                  for c, (p, _) in zip(cases, made, strict=True)]  # fmt: skip
        wrong += sum(not (e and s.proven) or f for e, s, f in zip(equal, staging, faults, strict=True))
        moves = [sum(o.primitive in ("move", "stow") for o in p.operations) for p, _ in made]
        count = mean(s.count for s in staging)
        print(f"{density:7} {n:4} {count:7.2f} {mean(best):8.2f} {sum(equal):3}/{len(cell):<2} "
              f"{sum(s.proven for s in staging):4}/{len(cell):<2} {sum(faults):7} {mean(moves):6.1f} "
              f"{statistics.median(seconds):9.3f} {max(seconds):7.3f}", flush=True)  # fmt: skip
    return wrong


def mean(values: Iterable[float]) -> float:
    listed = list(values)
    return sum(listed) / max(1, len(listed))


def depends(instance: dict[str, Any]) -> list[list[int]]:
    """Return for each disc those that must wait until it has left: their goals overlap its start."""
    starts, goals, apart = instance["start"], instance["goal"], 2 * instance["radius"]
    every = range(instance["n"])
    return [[i for i in every if i != j and math.dist(starts[j], goals[i]) < apart] for j in every]


def first_cycle(successors: Sequence[Sequence[int]]) -> int:
    """Return how many vertices go if the first of each cycle found goes, as simple planners do."""
    gone: set[int] = set()
    while (v := _on_a_cycle(successors, gone)) is not None:
        gone.add(v)
    return len(gone)


def _on_a_cycle(successors: Sequence[Sequence[int]], gone: set[int]) -> int | None:
    done = set(gone)
    for root in range(len(successors)):
        trail, work = [root], [iter(successors[root])]
        if root in done:
            continue
        while work:
            following = next((w for w in work[-1] if w not in done), None)
            if following is None:
                done.add(trail.pop())
                work.pop()
            elif following in trail:
                return following
            else:
                trail.append(following)
                work.append(iter(successors[following]))
    return None


@dataclass(frozen=True)
class Thing:
    """A component: its outline, and how it is held, by yaw of the jaws [deg]."""

    footprint: Footprint
    grasps: dict[float, Grasp]


@dataclass(frozen=True)
class Standing:
    """A component somewhere on the table."""

    pose: Pose
    shape: Shape


def random_thing(rng: random.Random, kind: str) -> Thing:
    """Return a disc of 60 to 80 mm, or for half of the mixed ones a box of 40 to 80 by 40 to 60 mm."""
    if kind == "discs" or rng.random() < 0.5:
        r = rng.uniform(30, 40)
        return Thing(Footprint(disc=r), {yaw: Grasp(height=60, width=2 * r) for yaw in (0.0, 45.0, 90.0, 135.0)})
    a, b = rng.uniform(40, 80), rng.uniform(40, 60)
    return Thing(Footprint(box=(a, b)), {0.0: Grasp(height=60, width=a), 90.0: Grasp(height=60, width=b)})


def arrangement(rng: random.Random, things: Sequence[Thing], side: float) -> list[Standing]:
    """Return random places on a square table where no two bodies overlap."""
    while True:
        found: list[Standing] = []
        for thing in things:
            for _ in range(3000):
                edge = thing.footprint.disc or max(thing.footprint.box or ()) / 2
                x, y = rng.uniform(edge, side - edge), rng.uniform(edge, side - edge)
                pose = Pose(x, y, rng.uniform(-180, 180))
                shape = placed(thing.footprint, pose)
                if not any(conflict(shape, other.shape) for other in found):
                    found.append(Standing(pose, shape))
                    break
            else:
                break
        else:
            return found


def random_table(rng: random.Random, kind: str, n: int, density: float) -> StagingProblem:
    """Return the problem of bringing `n` things from one random arrangement to another."""
    things = [random_thing(rng, kind) for _ in range(n)]
    area = sum(math.pi * f.disc**2 if f.disc else math.prod(f.box or ()) for f in (t.footprint for t in things))
    side = math.sqrt(area / density)
    return problem(things, arrangement(rng, things, side), arrangement(rng, things, side))


def problem(things: Sequence[Thing], starts: Sequence[Standing], goals: Sequence[Standing]) -> StagingProblem:
    """Return what must come before what: bodies always, fingers for the grasp that they belong to."""
    every = range(len(things))
    bodies = [Arc(leaves(j), arrives(i), "body") for i in every for j in every
              if i != j and conflict(goals[i].shape, starts[j].shape)]  # fmt: skip

    def fingers(i: int, yaw: float, here: Standing, mine: PartEvent) -> tuple[Arc, ...]:
        zones = finger_zones(things[i].grasps[yaw], Gripper(), yaw, here.pose)
        others = [j for j in every if j != i]
        before = [Arc(leaves(j), mine, "finger") for j in others if any(conflict(z, starts[j].shape) for z in zones)]
        after = [Arc(mine, arrives(j), "finger") for j in others if any(conflict(z, goals[j].shape) for z in zones)]
        return (*before, *after)

    parts = []
    for i in every:
        pick = [Option(yaw, fingers(i, yaw, starts[i], leaves(i))) for yaw in things[i].grasps]
        place = [Option(yaw, fingers(i, yaw, goals[i], arrives(i))) for yaw in things[i].grasps]
        direct = [Option(a.name, a.arcs + b.arcs) for a, b in zip(pick, place, strict=True)]
        parts.append(Component(tuple(direct), tuple(pick), tuple(place)))
    return StagingProblem(tuple(parts), tuple(bodies))


def with_fingers(tables: int, seed: int) -> None:
    """Print a row for each kind of random table."""
    print(f"{'shapes':>7} {'n':>4} {'density':>8} {'bodies':>7} {'staged':>7} {'refused':>8} {'proven':>7} "
          f"{'median s':>9} {'max s':>7}")  # fmt: skip
    for kind, n, density in TABLES:
        drawn = [random_table(random.Random(f"{seed} {kind} {n} {density} {k}"), kind, n, density)
                 for k in range(tables)]  # fmt: skip
        answers: list[tuple[StagingAnswer, float]] = [timed(lambda p=p: solve(p)) for p in drawn]
        solved = [(p, a) for p, (a, _) in zip(drawn, answers, strict=True) if a.options is not None]
        seconds = [s for _, s in answers]
        print(f"{kind:>7} {n:4} {density:8} {mean(bodies_only(p) for p, _ in solved):7.2f} "
              f"{mean(a.count for _, a in solved):7.2f} {len(answers) - len(solved):8} "
              f"{sum(a.proven for a, _ in answers):4}/{len(answers):<2} {statistics.median(seconds):9.3f} "
              f"{max(seconds):7.3f}", flush=True)  # fmt: skip


def bodies_only(problem: StagingProblem) -> int:
    """Return how many would be staged if fingers needed no room."""
    graph: list[list[int]] = [[] for _ in problem.components]
    for arc in problem.arcs:
        graph[arc.before.component].append(arc.after.component)
    return solve(all_to_move(graph)).count


if __name__ == "__main__":
    sys.exit(main())

"""What the solvers answer to random problems, kept as text: see `kept`. The same problem has the same answer."""

from __future__ import annotations

import random
import sys
from pathlib import Path

from kept import differs
from test_together import orders, some_work

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "staging"))

from feedback_cases import random_problem  # noqa: E402
from sequencing_cases import instance  # noqa: E402

from pico.planning.ordering.arm_times import least, soonest, timed  # noqa: E402
from pico.staging.feedback import Limit, solve  # noqa: E402
from pico.staging.sequencing.assignment import assign  # noqa: E402
from pico.staging.sequencing.cuts import cut_bound  # noqa: E402
from pico.staging.sequencing.nearest import nearest_order  # noqa: E402
from pico.staging.sequencing.problem import Effort, Tour  # noqa: E402
from pico.staging.sequencing.solve import best_order  # noqa: E402

LIMITS = (Limit(), Limit(solves=0))


def test_fewest_stagings_are_the_ones_kept() -> None:
    lines = []
    for seed in range(2000, 2080):
        problem = random_problem(random.Random(seed))
        for limit in LIMITS if seed % 4 == 0 else LIMITS[:1]:
            answer = solve(problem, limit)
            lines += [f"{seed}: {answer.staged} {answer.weight:g} {answer.lower_bound:.6g} {answer.proven}"]
            lines += [f"  {answer.options}", f"  {answer.order}", *(f"  {cycle}" for cycle in answer.cycles)]
    assert not differs("solved_stagings.txt", "\n".join(lines) + "\n")


def near_and_bound(tour: Tour) -> str:
    near = nearest_order(tour)
    return f"{near} {cut_bound(tour, near, assign(tour), Effort(rounds=4)):.6g}"


def test_cheapest_orders_are_the_ones_kept() -> None:
    lines = []
    for count, density in ((1, 0.0), (5, 0.2), (9, 0.1), (14, 0.3), (24, 0.15)):
        for seed in range(3):
            case = instance(count, density, seed + 50)
            for limit in (Effort(moves=3000, steps=200_000), Effort(moves=50, steps=20)):
                found = best_order(case.start, case.between, case.end, case.before, limit=limit)
                lines.append(f"{count} {seed}: {found.order} {found.cost:g} {found.lower_bound:.6g} {found.proven}")
            lines.append(f"  {near_and_bound(case.tour)}" if count > 1 else "  alone")
    assert not differs("solved_orders.txt", "\n".join(lines) + "\n")


def test_arms_at_work_end_when_they_ended() -> None:
    lines = []
    for seed in range(100, 112):
        work = some_work(seed, 5 + seed % 3)
        first = tuple(range(len(work.arm)))
        order = soonest(work, first, 30)
        end, total = timed(work, order)
        free = {0: 2.5} if seed % 2 else {}
        lines.append(
            f"{seed}: {timed(work, first)[0]:.4f} {order} {end:.4f} {total:.4f} {least(work, [3.0], free):.4f}"
        )
    assert not differs("solved_arms.txt", "\n".join(lines) + "\n")


def test_bounds_and_times_of_arms_at_work_are_the_ones_kept() -> None:
    """In every tenth order that keeps what comes before, and with moves that another arm may make as well."""
    lines = []
    for seed in range(200, 260):
        work = some_work(seed, 3 + seed % 3)
        times = [f"{end:.4f} {total:.4f}" for end, total in (timed(work, order) for order in orders(work)[::10])]
        frees = ({}, {0: 2.5}, {0: 1.0, 1: 4.0}, dict.fromkeys(range(len(work.arm)), 0.1))
        bounds = [f"{least(work, tours, free):.4f}" for tours in ([], [9.0, 30.0]) for free in frees]
        lines.append(f"{seed}: {', '.join(times)}; at least {' '.join(bounds)}")
    assert not differs("arms_at_work.txt", "\n".join(lines) + "\n")

"""How much work plans take, kept as text: see `kept`. Counts of what costs, never seconds: configurations looked at,
integer programs, orders timed, swings checked. A plan that comes out the same for more work is worse."""

from __future__ import annotations

import random
import sys
from pathlib import Path

import pytest
from effort import counting, line
from fuzzing import plan_case
from kept import differs
from random_labs import random_case
from test_together import some_work

sys.path.append(str(Path(__file__).resolve().parent.parent / "staging"))

from feedback_cases import random_problem
from sequencing_cases import instance

from pico.planning.ordering.arm_times import soonest
from pico.staging.feedback import Limit, solve
from pico.staging.sequencing.problem import Effort
from pico.staging.sequencing.solve import best_order

COUNTED = {
    "planning/ordering/search.py": (
        "_Search.moves", "_Search.direct", "_Search._harmless", "_Search._in_the_way", "_Search._hindering",
        "_Search._stagings", "ranked_storage",
    ),
    "planning/ordering/conflicts.py": (
        "Conflicts._find_ways", "Conflicts._body", "Conflicts._fingers", "Conflicts._meeting", "Conflicts.held",
    ),
    "planning/ordering/fewest_stagings.py": ("_searched", "_core"),
    "planning/ordering/realize.py": ("_act", "_roomiest", "_arriving", "_sorted", "_Replay._ways"),
    "planning/ordering/relaxed.py": ("_meanwhile", "_shared", "relaxation", "_arcs", "_undominated", "_least"),
    "planning/ordering/order.py": ("precedence",),
    "planning/ordering/arm_times.py": ("timed", "_shifts", "_handover"),
    "planning/ordering/shorten.py": ("_shorter", "valid"),
    "planning/ordering/travel.py": ("nearer", "_close"),
    "planning/parts/movers.py": ("turned", "with_storage"),
    "staging/feedback/clauses.py": ("Cover.solve",),
    "staging/feedback/literals.py": ("Literals.groups", "Literals.components"),
    "staging/feedback/shrink.py": (
        "_dominated", "_take_away", "strongest", "living", "living_clauses", "successors", "led_past", "_joined",
        "_put", "never_better",
    ),
    "staging/feedback/lazy.py": ("solve_region", "short_cycles", "_threes", "_closed"),
    "staging/feedback/walk.py": ("walk", "left_cycles", "cost", "turned"),
    "staging/feedback/certificate.py": ("_simple", "_enough", "_contradict"),
    "staging/feedback/digraph.py": ("some_cycle", "shortest_cycle"),
    "staging/sequencing/assignment.py": ("assign",),
    "staging/sequencing/cuts.py": ("violated", "_members"),
    "staging/sequencing/program.py": ("CutProgram._priced", "CutProgram._add_rows"),
    "staging/sequencing/exact.py": ("_next_layer", "improved"),
    "staging/sequencing/exchange.py": ("exchangeable", "_places"),
    "staging/sequencing/flow.py": ("Network._search",),
    "staging/sequencing/stretches.py": ("_cheaper", "stretch"),
}  # fmt: skip
"""The functions whose calls are counted, by file."""
SEARCHED = (2000, 2001, 2002, 2004, 2007, 2021, 2043, 2048, 2070, 2073, 2088, 2099, 2103, 2134, 2150, 2151, 2154)
"""Seeds of random labs, most of which are planned by search."""


def test_solvers_take_as_much_work_as_they_took() -> None:
    lines = []
    for seed in range(3000, 3040):
        with counting(COUNTED) as calls:
            solve(random_problem(random.Random(seed)), Limit(solves=3) if seed % 5 == 0 else Limit())
        lines.append(line(seed, calls))
    for count, density, moves in ((6, 0.2, 3000), (12, 0.3, 3000), (20, 0.15, 200)):
        case = instance(count, density, count)
        with counting(COUNTED) as calls:
            best_order(case.start, case.between, case.end, case.before, limit=Effort(moves=moves, steps=20_000))
        lines.append(line(count, calls))
    for seed in range(300, 306):
        work = some_work(seed, 6)
        with counting(COUNTED) as calls:
            soonest(work, tuple(range(len(work.arm))), 30)
        lines.append(line(seed, calls))
    assert not differs("effort_of_solvers.txt", "\n".join(lines) + "\n")


@pytest.mark.parametrize("part", range(3))
def test_plans_take_as_much_work_as_they_took(part: int) -> None:
    lines = []
    for seed in SEARCHED[part::3]:
        case = random_case(seed, least=4, most=8)
        with counting(COUNTED) as calls:
            made = plan_case(case)
        lines.append(line(f"{seed}, {len(made.operations)} operations", calls))
    assert not differs(f"effort_of_plans_{part}.txt", "\n".join(lines) + "\n")

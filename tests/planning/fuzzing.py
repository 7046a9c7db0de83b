"""Plans random cases, and has each plan or refusal judged from outside."""

from __future__ import annotations

from dataclasses import dataclass

from checker import check
from exhaustive import Undecided, least_moves
from random_labs import Case, random_case

from pico.model.plan import Plan
from pico.motion.types import Motion
from pico.planning import PlanGoal, Planner

SMALL = 7
"""Up to so many components the exhaustive search decides about a refusal."""


@dataclass(frozen=True)
class Verdict:
    """What became of a case. `fewest`: proven that no plan stages less. `wrong`: what the checker found, or
    a refusal of something solvable."""

    seed: int
    components: int
    moves: int
    staged: int
    fewest: bool
    asides: int
    refused: str
    proven: bool
    undecided: bool
    wrong: tuple[str, ...]


def plan_case(case: Case, motion: Motion | None = None) -> Plan:
    """Return the plan of a case, without motion where none is given."""
    return Planner(case.setup, motion, case.seen).plan(PlanGoal(case.wanted))


def judge(seed: int, *, least: int = 5, most: int = 30) -> Verdict:
    """Plan the case of a seed, and judge it."""
    case = random_case(seed, least=least, most=most)
    made = plan_case(case)
    count = len(case.setup.lab.inventory)
    moves = [
        o
        for o in made.operations
        if o.primitive in ("move", "stow") or ("from" in o.arguments and o.primitive == "operator")
    ]
    asides = len({o.component for o in made.operations if o.reason.kind == "in_the_way"})
    errors = [d for d in made.diagnostics if d.severity == "error"]
    wrong: list[str] = []
    undecided = False
    if not errors:
        wrong = check(case.setup, case.seen, case.wanted, made, seed=seed, extensions=3)
    elif count <= SMALL:
        try:
            least_number = least_moves(case)
            wrong = (
                [f"refused, but {least_number} moves do it: {errors[0].summary}"] if least_number is not None else []
            )
        except Undecided:
            undecided = True
    refused = f"{errors[0].code}: {errors[0].summary}" if errors else ""
    return Verdict(
        seed,
        count,
        len(moves),
        made.staging.count,
        made.staging.proven,
        asides,
        refused,
        "within the limit" not in refused,
        undecided,
        tuple(wrong),
    )

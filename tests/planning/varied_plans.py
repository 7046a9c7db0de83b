"""Varied plans, and the bytes that each is saved as: every step of the packaged labs' histories with their arms, and
random labs. `python tests/planning/varied_plans.py` prints a line for each: its name, digest and SHA-256.

Needs nothing but what PICO itself needs and shapely, so that any interpreter which has these can be asked.
"""

from __future__ import annotations

import hashlib
import random
import sys
import tempfile
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent.parent), str(HERE.parent), str(HERE)]

from disc_labs import disc_case, random_places  # noqa: E402
from random_labs import Case, random_case  # noqa: E402

from pico.history.examples.example import example_names, make_example  # noqa: E402
from pico.history.lab.folder import LabFolder  # noqa: E402
from pico.model.observation import Observation, ObservedComponent, ObservedValue  # noqa: E402
from pico.model.plan import Plan  # noqa: E402
from pico.model.setup import Setup  # noqa: E402
from pico.model.state import LabState, place_of  # noqa: E402
from pico.motion.arms import ArmMotion  # noqa: E402
from pico.motion.types import Motion  # noqa: E402
from pico.planning import PlanGoal, Planner  # noqa: E402

RANDOM, DISCS = 12, 3


def varied(kinds: Sequence[str] = ()) -> Iterator[tuple[str, Plan]]:
    """Yield plans by name, of these kinds where any are named: a packaged lab, `random`, `discs`."""
    kinds = kinds or (*example_names(), "random", "discs")
    for lab in example_names():
        yield from _steps(lab) if lab in kinds else ()
    for seed in range(RANDOM if "random" in kinds else 0):
        yield f"random {seed}", _planned(random_case(seed, least=5, most=22), None)
    for seed in range(DISCS if "discs" in kinds else 0):
        rng = random.Random(seed)
        case = disc_case(40.0, 900.0, random_places(rng, 50, 40.0, 900.0), random_places(rng, 50, 40.0, 900.0))
        yield f"discs {seed}", _planned(case, ArmMotion(case.setup))


def _steps(lab: str) -> Iterator[tuple[str, Plan]]:
    """Yield the plans from each commit of a lab's history to the next, and from the last to the first."""
    with tempfile.TemporaryDirectory() as name:
        make_example(lab, Path(name) / lab)
        folder = LabFolder(Path(name) / lab)
        motion = ArmMotion(folder.setup)
        repository = folder.history()
        commits = list(repository.log(repository.tips(), folder=folder.root))[::-1]
        states = {c.id: folder.state_at(c.id) for c in commits}
        for n, (a, b) in enumerate(pairwise([*commits, commits[0]]), 1):
            case = Case(folder.setup, as_seen(folder.setup, states[a.id]), states[b.id])
            yield f"{lab} {n}: to `{b.message.strip()}`", _planned(case, motion)


def as_seen(setup: Setup, state: LabState) -> Observation:
    """Return the bench as it is seen where it equals a state."""
    components = {}
    for name in setup.lab.inventory:
        part = state.components.get(name)
        values = {t: ObservedValue(value=v) for t, v in (part.values if part else {}).items()}
        components[name] = ObservedComponent(pose=place_of(setup, state, name)[1], values=values)
    return Observation(backend="sim", components=components)


def _planned(case: Case, motion: Motion | None) -> Plan:
    return Planner(case.setup, motion, case.seen).plan(PlanGoal(case.wanted))


def line(name: str, made: Plan) -> str:
    """Return what is compared of a plan: its digest, and that of every byte of it."""
    return f"{name}\t{made.digest}\t{hashlib.sha256(made.to_json().encode()).hexdigest()}"


if __name__ == "__main__":
    for name, made in varied(sys.argv[1:]):
        sys.stdout.write(f"{line(name, made)}\n")
        sys.stdout.flush()

"""The column of reasons of a plan is never empty: over all shipped labs, and the history of the case study."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
import yaml
from pico_cli.views import plan as view
from pico_cli.views.style import plain

from pico.history.lab.folder import LabFolder
from pico.manifest.load import load_folder
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.plan import Plan, Target
from pico.model.setup import Setup
from pico.model.state import LabState, home_state, place_of
from pico.planning import PlanGoal, Planner
from pico.resources import labs_dir

LABS = sorted(path.parent for path in labs_dir().rglob("lab.yaml"))


def at(setup: Setup, state: LabState) -> Observation:
    """Return the bench as it stands when it is as a state."""
    parts = {}
    for name in setup.lab.inventory:
        own = state.components.get(name)
        values = {t: ObservedValue(value=v) for t, v in (own.values if own else {}).items() if not isinstance(v, dict)}
        kinds = setup.type_of(name).tunables
        values |= {t: ObservedValue(value=None, status="unknown") for t in kinds.keys() - values.keys()}
        parts[name] = ObservedComponent(pose=place_of(setup, state, name)[1], values=values)
    return Observation(backend="sim", components=parts)


def planned(setup: Setup, a: LabState, b: LabState, revision: str | None = None) -> Plan:
    return Planner(setup, None, at(setup, a)).plan(PlanGoal(b, Target(revision=revision)))


def histories(case_study: Path) -> Iterator[tuple[Setup, LabState, LabState, str]]:
    folder = LabFolder(case_study, history=True)
    tags = [c["tag"] for c in yaml.safe_load((labs_dir() / "shel" / "history.yaml").read_text())["commits"]]
    states = [folder.state_at(tag) for tag in tags]
    for (a, b), tag in zip(pairwise(states), tags[1:], strict=True):
        yield folder.setup, a, b, tag


@pytest.mark.parametrize("lab", LABS, ids=lambda path: path.name)
def test_every_operation_says_why_from_home_to_the_state_of_a_shipped_lab(lab: Path) -> None:
    setup, state = load_folder(lab).require()
    there, back = planned(setup, home_state(setup), state), planned(setup, state, home_state(setup))
    assert there.operations
    for plan in (there, back):
        assert all(view.reasons(plan)), [op.address for op in plan.operations]


def test_every_operation_says_why_along_the_history_of_the_case_study(case_study: Path) -> None:
    plans = [planned(*one) for one in histories(case_study)]
    assert sum(len(plan.operations) for plan in plans) > 20
    for plan in plans:
        assert all(view.reasons(plan))
        lines = plain("\n".join(view.operations(plan)))
        assert f"as {plan.target.revision} says" in lines or "stowed" in str(plan.operations)

"""A planner makes plans of states and of operations, and seals each once."""

from __future__ import annotations

from dataclasses import replace

import pytest
from drafts import HERE, LIT, lit
from planning_benches import see, want

from pico.model.plan import Plan, Target
from pico.planning import PlanGoal, Planner, set_values


def planner() -> Planner:
    setup = lit()
    return Planner(setup, None, see(setup, HERE, LIT), "sim", "physics", commit="c1")


def test_a_plan_says_where_it_begins_and_where_it_leads() -> None:
    wanted = want({**HERE, "a": (400, 300)})
    made = planner().plan(PlanGoal(wanted, Target(title="there")))
    assert (made.backend, made.fidelity, made.base.commit, made.target.title) == ("sim", "physics", "c1", "there")
    assert made.target.state == wanted.as_json() and made.base.state["a"]["pose"]["x"] == 300
    assert [o.id for o in made.operations] == [f"op{n + 1}" for n in range(len(made.operations))]


def test_operations_that_are_asked_for_are_done_whatever_else_differs() -> None:
    asked = set_values(planner(), "a", {"angle": 30.0})
    made = planner().plan(asked)
    assert [(o.id, o.primitive, o.component) for o in made.operations] == [("op1", "set", "a")]
    assert made.target.state["a"]["angle"] == 30.0 and made.target.cause == "single"
    assert planner().plan(replace(asked, operations=(), changes=())).operations == ()


def test_the_same_goal_makes_the_same_plan_and_each_is_sealed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    sealed: list[Plan] = []
    seal = Plan.sealed

    def counted(plan: Plan) -> Plan:
        sealed.append(plan)
        return seal(plan)

    monkeypatch.setattr(Plan, "sealed", counted)
    goals = [PlanGoal(want({**HERE, "a": (500, 300), "b": (300, 300)})), set_values(planner(), "a", {"angle": 30.0})]
    made = [planner().plan(goal) for goal in goals]
    assert len(sealed) == 2
    assert [planner().plan(goal).digest for goal in goals] == [plan.digest for plan in made]

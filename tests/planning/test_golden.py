"""Plans of a few hand-made cases, kept as canonical JSON in tests/golden, and of random ones as text: see `kept`."""

from __future__ import annotations

import json

import pytest
from checker import check
from fuzzing import plan_case
from kept import differs, kept
from planning_benches import Places, bench, part, planned, see, want
from random_labs import random_case

from pico.model.plan import Plan
from pico.model.record import canonical
from pico.model.setup import Setup

CASES: dict[str, tuple[Setup, Places, Places]] = {
    "swap_of_two": (
        bench({"a": "block", "b": "block"}),
        {"a": (300, 300), "b": (500, 300)},
        {"a": (500, 300), "b": (300, 300)},
    ),
    "ring_of_three": (
        bench({"a": "block", "b": part(stage="avoid"), "c": "block"}),
        {"a": (300, 300), "b": (500, 300), "c": (400, 420)},
        {"a": (500, 300), "b": (400, 420), "c": (300, 300)},
    ),
    "fingers_force_the_order": (
        bench({"a": part("low"), "b": part("tall_one_way")}),
        {"a": (200, 400), "b": (600, 400)},
        {"a": (300, 300), "b": (364, 300)},
    ),
    "stow": (
        bench({"a": part(home="s1"), "b": part(home="s2"), "c": "block"}),
        {"a": (300, 300), "b": (500, 300), "c": (600, 400)},
        {"b": "s2", "c": (600, 400)},
    ),
    "rotate_in_place": (bench({"a": "block"}), {"a": (300, 300)}, {"a": (300, 300, 30)}),
}


def content(made: Plan) -> str:
    """The plan as canonical JSON, indented to be read, without digests: those follow from the rest and the lab."""
    data = json.loads(canonical(made))
    del data["digest"], data["lab"]["digest"]
    return json.dumps(data, indent=1, sort_keys=True, ensure_ascii=False) + "\n"


@pytest.mark.parametrize("name", CASES)
def test_the_plan_is_the_one_kept(name: str) -> None:
    setup, start, goal = CASES[name]
    seen, wanted = see(setup, start), want(goal)
    made = planned(setup, seen, wanted)
    assert check(setup, seen, wanted, made) == []
    assert content(made) == kept(f"{name}.json", content(made))


def told(made: Plan) -> list[str]:
    """A plan as lines of text: what moves where, why and after what, what is said about it."""
    said = [f"  {d.severity} {d.code}: {d.summary} | {d.detail} | {d.hint}" for d in made.diagnostics]
    count = made.staging
    done = [
        f"  {o.id} {o.primitive} {o.component} {o.arguments.get('to')} yaw {o.arguments.get('grasp_yaw')}"
        f" {o.start:g}+{o.seconds:g} after {','.join(o.after)}: {o.reason.kind}, {o.reason.text}"
        for o in made.operations
    ]
    return [f"  staged {count.count} of at least {count.lower_bound}, {made.makespan:g} s", *said, *done]


@pytest.mark.parametrize(("name", "seeds", "most"), [("small", range(60), 7), ("large", range(100, 110), 20)])
def test_plans_of_random_labs_are_the_ones_kept(name: str, seeds: range, most: int) -> None:
    lines: list[str] = []
    for seed in seeds:
        lines += [f"seed {seed}", *told(plan_case(random_case(seed, least=3, most=most)))]
    assert not differs(f"random_{name}.txt", "\n".join(lines) + "\n")

"""Plans of a few hand-made cases, kept as canonical JSON in tests/golden.

Where a change of the planner is meant to change them, write them again and look at the difference:

    PICO_UPDATE_GOLDEN=1 python -m pytest tests/planning/test_golden.py && git diff tests/golden
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from checker import check
from planning_benches import Places, bench, part, planned, see, want

from pico.model.lab import Setup
from pico.model.plan import Plan
from pico.model.record import canonical

GOLDEN = Path(__file__).resolve().parent.parent / "golden"

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
    path = GOLDEN / f"{name}.json"
    if os.environ.get("PICO_UPDATE_GOLDEN"):
        path.write_text(content(made))
    assert content(made) == path.read_text()

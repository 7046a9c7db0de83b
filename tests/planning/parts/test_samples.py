"""Parts that hold a sample: no plan to a state moves one that nobody named."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from pico.bench.bench import Bench
from pico.model.plan import Plan
from pico.recipes.recipes import Recipes

IN_PLACE = (290.0, 310.0)  # storage/a3


@pytest.fixture
def bench(case_study: Path, tmp_path: Path) -> Iterator[Bench]:
    """The case study, its first lens the sample."""
    shutil.copytree(case_study, tmp_path / "shel")
    lab = tmp_path / "shel" / "lab.yaml"
    lab.write_text(lab.read_text().replace("    home: storage/a3\n", "    home: storage/a3\n    sample: WSe2-041\n"))
    with Bench.open(tmp_path / "shel") as opened:
        yield opened


def moved(plan: Plan) -> set[str]:
    return {op.component for op in plan.operations if op.kind.carries}


def stands(bench: Bench) -> tuple[float, float]:
    pose = bench.observe().components["lx_125"].pose
    assert pose is not None
    return pose.x, pose.y


def test_a_plan_to_a_state_leaves_it_says_so_and_does_not_claim_to_reach_the_state(bench: Bench) -> None:
    plan = bench.plan("e1")
    assert not plan.errored and moved(plan) == {"p1", "p2", "ly_150"} and plan.target.scope == "without lx_125.pose"
    (said,) = [d for d in plan.diagnostics if d.code == "sample"]
    assert "WSe2-041" in said.summary and "-- lx_125" in said.hint
    report = bench.apply(plan)
    assert report.outcome == "done" and report.scope == "without lx_125.pose" and "lx_125" in report.left
    assert stands(bench) == IN_PLACE and not bench.plan("e1").operations


def test_who_names_it_moves_it_and_takes_that_back(bench: Bench) -> None:
    assert moved(bench.plan("e1", targets=["lx_125"])) == {"lx_125"}
    bench.apply(bench.single("lx_125", "move", x=395, y=420))
    assert stands(bench) == (395.0, 420.0)
    bench.apply(bench.recovery.undo_plan())
    assert stands(bench) == IN_PLACE


def test_a_state_that_does_not_speak_of_it_does_not_send_it_home(bench: Bench) -> None:
    bench.apply(bench.single("lx_125", "move", x=395, y=420))
    state = bench.root / "state" / "table.yaml"
    state.write_text(state.read_text().replace("  lx_125:\n    slot: storage/a3\n", ""))
    bench.folder.reload()
    assert "lx_125" not in moved(bench.plan())


def test_it_is_not_put_aside_for_another_part(bench: Bench) -> None:
    bench.apply(bench.single("lx_125", "move", x=395, y=420))
    state = bench.root / "state" / "table.yaml"
    text = state.read_text().replace("  lx_125:\n    slot: storage/a3\n", "")
    state.write_text(
        text.replace("  lx_100:\n    slot: storage/a1\n", "  lx_100:\n    pose: {x: 400, y: 420, yaw: 0}\n")
    )
    bench.folder.reload()
    plan = bench.plan()
    assert "lx_125" not in moved(plan) and "lx_100" not in moved(plan)
    assert any(d.address == "lx_100" and "lx_125" in d.summary for d in plan.diagnostics)


def test_a_recipe_leaves_it_where_it_applies_and_moves_it_where_it_says_so(bench: Bench) -> None:
    path = bench.root.parent / "it.yaml"
    head = "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: it, lab: shel}\nsteps:\n"
    recipes = Recipes(bench)
    for steps, where in (("  - apply: e1\n", IN_PLACE), ("  - move: {lx_125: {x: 395, y: 420}}\n", (395.0, 420.0))):
        path.write_text(head + steps)
        recipe = recipes.read(str(path))
        assert recipes.run(recipe, recipes.begin(recipe, {})).outcome == "done"
        assert stands(bench) == where

"""The questions that are put to a change, and what becomes of them."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest
from bench_at import bench_at
from changing import Lab

from pico.bench.bench import Bench
from pico.bench.checking import CheckReport, check
from pico.diagnostics import PicoError
from pico.edge.lease import BenchLock

TILTED = ("x: 520\n      y: 420\n      yaw: 0", "x: 520\n      y: 420\n      yaw: 30")


def checked(lab: Lab, revision: str | None = None, **options: object) -> CheckReport:
    return check(lab.root, revision, environment={}, **options)  # type: ignore[arg-type]


def verdicts(found: CheckReport) -> Mapping[str, str]:
    return {c.question: c.verdict for c in found.labs[0].checks}


def test_a_change_that_can_be_built_passes_and_says_what_moves(lab: Lab) -> None:
    lab.edit(*TILTED)
    lab.expect("p2.pose.yaw == 30.0", "distance(p1, p2) > 200")
    found = checked(lab)
    (one,) = found.labs
    assert found.exit_code == 0 and set(verdicts(found).values()) == {"passed"}
    assert [(c.component, c.text) for c in one.changes] == [("p2", "turned +30°")]
    assert one.plan is not None and [o.component for o in one.plan.operations if o.primitive == "move"] == ["p2"]
    assert [e.holds for e in one.expectations] == [True, True]
    assert len(one.rules) == 3 and found.what == "C3 with edits"


def test_invalid_manifests_end_with_1_and_every_place_and_skip_the_rest(lab: Lab) -> None:
    lab.edit("exposure: 10", "exposure: 2 kg")
    lab.edit("angle: 22.75", "angel: 22.75")
    found = checked(lab)
    assert found.exit_code == 1
    assert list(verdicts(found).values()) == ["failed", "passed", "skipped", "skipped", "skipped", "skipped"]
    assert [d.source.start.line for d in found.labs[0].diagnostics if d.source] == [10, 16]


def test_another_layout_is_advised_and_no_reason_to_refuse(lab: Lab) -> None:
    lab.edit("exposure: 10", "exposure:    10")
    found = checked(lab)
    assert found.exit_code == 0 and verdicts(found)["formatted"] == "advised"


def test_parts_without_room_end_with_3_and_name_both(lab: Lab) -> None:
    lab.edit("x: 520", "x: 320")
    found = checked(lab)
    assert found.exit_code == 3 and verdicts(found)["stands"] == "failed"
    assert [verdicts(found)[q] for q in ("feasible", "expectations", "policy")] == ["skipped"] * 3
    assert all(name in found.labs[0].diagnostics[0].summary for name in ("p1", "p2"))


def test_a_place_that_no_arm_reaches_ends_with_3(lab: Lab) -> None:
    lab.edit("x: 520\n      y: 420", "x: 1150\n      y: 60")
    found = checked(lab)
    assert found.exit_code == 3 and (verdicts(found)["stands"], verdicts(found)["feasible"]) == ("passed", "failed")
    assert "p2" in found.labs[0].diagnostics[0].summary


@pytest.mark.parametrize(
    ("that", "word"), [("distance(p1, p2) > 2000.0", "fails"), ("inside(p2, p1.slot)", "can't be told")]
)
def test_an_expectation_that_fails_or_is_unknown_ends_with_6_and_says_where(lab: Lab, that: str, word: str) -> None:
    lab.edit(*TILTED)
    lab.expect("p2.pose.yaw == 30.0", that)
    found = checked(lab)
    (wrong,) = found.labs[0].diagnostics
    assert found.exit_code == 6 and that in wrong.summary and word in wrong.summary
    assert wrong.source is not None and that in wrong.source.snippet


def test_an_expectation_on_what_nobody_measured_is_told_and_fails_nothing(lab: Lab) -> None:
    lab.edit(*TILTED)
    lab.expect("p2.pose.yaw == 30.0", "cam.peak > 3.0")
    found = checked(lab)
    (asked,) = [c for c in found.labs[0].checks if c.question == "expectations"]
    assert (found.exit_code, asked.verdict) == (0, "passed")
    assert asked.text.startswith("1 of 2 hold, 1 not assured")


def test_expectations_are_asked_where_nothing_moves(lab: Lab) -> None:
    lab.expect("p2.pose.yaw > 20.0")
    assert checked(lab).exit_code == 6


def test_a_mandatory_rule_ends_with_7_and_an_expectation_counts_first(lab: Lab) -> None:
    lab.edit(*TILTED)
    lab.edit("o.mass <= 1.5)\n      level: advisory", "o.mass <= 0.1)\n      level: mandatory", "lab.yaml")
    found = checked(lab)
    assert (
        found.exit_code == 7 and verdicts(found)["policy"] == "failed" and verdicts(found)["expectations"] == "passed"
    )
    assert found.labs[0].bench == ("policy.rules",)
    lab.expect("p2.pose.yaw > 40.0")
    assert checked(lab).exit_code == 6


def test_an_advisory_rule_is_only_said(lab: Lab) -> None:
    lab.edit(*TILTED)
    lab.edit("o.mass <= 1.5", "o.mass <= 0.1", "lab.yaml")
    found = checked(lab)
    assert found.exit_code == 0 and verdicts(found)["policy"] == "advised"


def test_what_only_a_person_can_move_is_moved_by_hand_in_the_simulator(lab: Lab) -> None:
    lab.edit("home: storage/b2", "home: storage/b2\n    seating: bolted", "lab.yaml")
    lab.edit("x: 520", "x: 560")
    lab.expect("p2.pose.x == 560.0")
    found = checked(lab)
    assert found.exit_code == 0 and [e.holds for e in found.labs[0].expectations] == [True]
    assert "by hand" in found.labs[0].diagnostics[0].summary


def test_the_bench_its_journal_and_its_lock_are_not_touched(lab: Lab) -> None:
    lab.edit(*TILTED)
    assert checked(lab).exit_code == 0
    assert not (lab.root / ".pico").exists()
    with Bench.open(lab.root) as bench:
        bench.sim.nudge("lx_100", dx=3)
    before = {p: p.read_bytes() for p in (lab.root / ".pico").rglob("*") if p.is_file()}
    with BenchLock(bench_at(lab.root)).held("somebody's apply"):
        held = {p: p.read_bytes() for p in (lab.root / ".pico").rglob("*") if p.is_file()}
        assert checked(lab).exit_code == 0
        assert {p: p.read_bytes() for p in (lab.root / ".pico").rglob("*") if p.is_file()} == held
    assert before.keys() <= held.keys()


def test_random_faults_of_the_lab_do_not_count(lab: Lab) -> None:
    lab.edit("  seed: 1", "  seed: 1\n  faults: {drop: 1.0, timeout: 1.0}", "lab.yaml")
    lab.edit(*TILTED)
    assert checked(lab).exit_code == 0


def test_a_simulator_that_does_not_get_there_ends_with_1_and_says_what_went_wrong(lab: Lab) -> None:
    lab.edit("  seed: 1", "  seed: 1\n  pad_friction: 0.01", "lab.yaml")
    lab.edit("x: 520", "x: 560")
    lab.expect("p2.pose.x < 0.0")
    found = checked(lab, fidelity="physics")
    assert found.exit_code == 1 and verdicts(found)["expectations"] == "failed"
    assert [d.code for d in found.labs[0].diagnostics] == ["dropped", "not-reached"]
    assert "p2 moved" in found.labs[0].diagnostics[1].detail and checked(lab).exit_code == 6


def test_a_lab_that_the_base_does_not_have_starts_from_home(lab: Lab) -> None:
    lab.git("checkout", "-q", "--orphan", "fresh")
    lab.git("rm", "-q", "-r", "--cached", ".")
    other = lab.root / "README.md"
    lab.git("add", str(other))
    lab.git("commit", "-q", "-m", "a repository without a lab")
    lab.git("branch", "-f", "main")
    found = checked(lab, "main")
    assert found.exit_code == 0 and "the lab is new" in found.labs[0].notes[0]
    assert {c.component for c in found.labs[0].changes} >= {"p1", "p2"}


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [("x: 520", "x: 320", "itself can't stand"), ("exposure: 10", "exposure: 2 kg", "not valid at")],
)
def test_what_repairs_a_broken_base_passes(lab: Lab, before: str, after: str, said: str) -> None:
    lab.edit(before, after)
    lab.commit("broken")
    lab.git("branch", "-f", "main")
    lab.edit(after, before)
    found = checked(lab)
    assert found.exit_code == 0 and said in found.labs[0].notes[0]


def test_a_lab_without_git_is_checked_from_home(lab: Lab) -> None:
    (lab.root / ".git").rename(lab.root.parent / "history")
    found = checked(lab)
    assert found.exit_code == 0 and found.base.commit is None
    with pytest.raises(PicoError, match="no Git repository"):
        checked(lab, "main")


def test_above_labs_those_that_differ_are_checked(lab: Lab) -> None:
    for name in ("one", "two", "three"):
        shutil.copytree(lab.root / "state", lab.root / "labs" / name / "state")
        shutil.copy(lab.root / "lab.yaml", lab.root / "labs" / name)
    lab.git("rm", "-q", "-r", "lab.yaml", "state")
    lab.commit()
    lab.edit("x: 520", "x: 320", "labs/two/state/table.yaml")
    lab.edit("x: 520", "x: 530", "labs/three/state/table.yaml")
    found = check(lab.root, "HEAD", environment={}, pictures=lab.root.parent / "out")
    assert [(one.folder, int(one.exit_code)) for one in found.labs] == [("labs/three", 0), ("labs/two", 3)]
    assert found.alike == ("labs/one",) and found.exit_code == 3
    assert len({p.path for one in found.labs for p in one.pictures}) == 4
    assert {c.component for one in found.labs for c in one.changes} == {"p2"}
    assert check(lab.root, environment={}, merging="HEAD").alike == ("labs/one", "labs/three", "labs/two")


def test_a_merge_is_checked_without_being_made(lab: Lab) -> None:
    lab.git("checkout", "-q", "-b", "left")
    lab.edit("x: 290", "x: 400")
    lab.commit()
    lab.git("checkout", "-q", "change")
    lab.edit("x: 520", "x: 420")
    head = lab.commit()
    assert checked(lab).exit_code == 0
    found = checked(lab, merging="left")
    assert found.exit_code == 3 and found.base.name == "left"
    assert lab.git("rev-parse", "HEAD") == head and not lab.git("status", "--porcelain")
    lab.edit("x: 290", "x: 300")
    lab.commit()
    with pytest.raises(PicoError, match=r"p1\.pose\.x"):
        checked(lab, merging="left")


def test_pictures_show_the_table_before_and_after(lab: Lab, tmp_path: Path) -> None:
    lab.edit(*TILTED)
    found = checked(lab, pictures=tmp_path / "deep" / "out")
    assert [Path(p.path).name for p in found.labs[0].pictures] == ["shel-before.png", "shel-after.png"]
    assert all(Path(p.path).read_bytes().startswith(b"\x89PNG") for p in found.labs[0].pictures)
    lab.git("checkout", "-q", "--", ".")
    assert checked(lab, "HEAD", pictures=tmp_path / "none").labs[0].pictures == ()


def test_a_picture_does_not_follow_a_link_that_a_branch_put_there(lab: Lab, tmp_path: Path) -> None:
    precious = tmp_path / "precious"
    precious.write_text("precious")
    (tmp_path / "shel-after.png").symlink_to(precious)
    lab.edit(*TILTED)
    checked(lab, pictures=tmp_path)
    assert precious.read_text() == "precious"


def test_there_is_no_such_fidelity(lab: Lab) -> None:
    with pytest.raises(PicoError, match="physic"):
        checked(lab, fidelity="physic")


def test_a_recipe_that_can_not_run_is_refused_with_file_and_line(lab: Lab) -> None:
    """With the revisions of the lab, and those that only `origin` has in a fresh clone."""
    from pico.recipes.reading import check_recipes

    folder = lab.root / "recipes"
    shutil.rmtree(folder)
    folder.mkdir()
    head = "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: one}\nsteps:\n"
    (folder / "one.yaml").write_text(f"{head}- apply: e1\n- call: two\n")
    (folder / "two.yaml").write_text(f"{head}- set: {{p1.angle: 3}}\n")
    lab.git("checkout", "-q", "--detach")
    lab.git("remote", "add", "origin", "elsewhere")
    lab.git("update-ref", "refs/remotes/origin/e1", "e1")
    lab.git("branch", "-q", "-D", "e1")
    fine = checked(lab, recipes=check_recipes)
    assert fine.exit_code == 0 and fine.labs[0].checks[-1].text == "2 recipes"
    (folder / "broken.yaml").write_text(f"{head}- move: {{p9: {{x: 10}}}}\n- set: {{p1.angel: 900}}\n- apply: e9\n")
    found = checked(lab, recipes=check_recipes)
    assert found.exit_code == 1 and verdicts(found)["recipes"] == "failed"
    wrong = found.labs[0].checks[-1].diagnostics
    assert [(d.source.path, d.source.start.line) for d in wrong if d.source] == [
        ("recipes/broken.yaml", line) for line in (5, 6, 7)
    ]
    lab.edit("exposure: 10", "exposure: 2 kg")
    assert verdicts(checked(lab, recipes=check_recipes))["recipes"] == "skipped"

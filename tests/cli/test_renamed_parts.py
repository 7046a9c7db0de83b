"""A part that has another name now (`formerly:`): its history, its values and what speaks of it stay its own."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest
import yaml
from commanding import Brought, Pico, edit

YES = "--auto-approve"


def git(folder: Path, *words: str) -> str:
    return subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=True).stdout.strip()


def rename(folder: Path, *, formerly: bool = True) -> None:
    """Call p2 pol_out in lab.yaml and in the state."""
    for name in ("lab.yaml", "state/table.yaml"):
        edit(folder / name, "\n  p2:\n", "\n  pol_out:\n")
    if formerly:
        edit(folder / "lab.yaml", "\n  pol_out:\n", "\n  pol_out:\n    formerly: [p2]\n")


def applied(folder: Path) -> None:
    """The bench stands as C3 says, by a run that a commit carries; there is a note on p2."""
    from pico_cli.main import main

    assert main(("apply", YES)) == 0
    assert main(("note", "p2", "scratched")) == 0
    assert main(("commit", "-m", "base")) == 0


def turned(folder: Path) -> None:
    """After that p2 was turned by a command, and committed."""
    from pico_cli.main import main

    applied(folder)
    assert main(("set", "p2", "angle=12", YES)) == 0
    assert main(("commit", "--capture", "-m", "turned")) == 0


def renamed(folder: Path) -> None:
    """After that p2 is called pol_out, the bench has adopted it, and it is committed."""
    from pico_cli.main import main

    applied(folder)
    rename(folder)
    assert main(("bench", "update", YES)) == 0
    git(folder, "commit", "-q", "-a", "-m", "p2 is pol_out")


@pytest.fixture
def lab(brought: Brought, shel: Path) -> Path:
    brought(renamed)
    return shel


def test_the_bench_keeps_the_values_of_a_renamed_part(lab: Path, pico: Pico) -> None:
    assert pico("plan").code == 0 and "Nothing to do" in pico("plan").out


def test_the_update_says_what_is_renamed(brought: Brought, shel: Path, pico: Pico) -> None:
    brought(applied)
    rename(shel)
    assert "p2 is now called pol_out" in pico("bench", "update", "--dry-run").out


def test_without_formerly_the_update_suggests_it(brought: Brought, shel: Path, pico: Pico) -> None:
    brought(applied)
    rename(shel, formerly=False)
    told = pico("bench", "update", "--dry-run").err
    assert "warning[renamed]" in told and "formerly: [p2]" in told and "pol_out" in told


def test_an_old_commit_is_planned_applied_and_undone_by_the_present_name(lab: Path, pico: Pico) -> None:
    plan = pico("plan", "E1-3", "--json").data
    moved = {op["component"] for op in plan["operations"]}
    assert "pol_out" in moved and "p2" not in moved
    assert pico("apply", "E1-3", YES).code == 0
    assert pico("undo", YES).code == 0 and "Nothing to do" in pico("plan").out


def test_a_run_before_the_rename_is_undone_after_it(lab: Path, pico: Pico) -> None:
    assert pico("undo", YES).code == 0
    assert "storage/b2 →" in next(line for line in pico("plan").out.splitlines() if "pol_out " in line)


@pytest.mark.parametrize("word", ["pol_out", "p2", "pol_out.angle", "p2.angle"])
def test_blame_goes_through_the_rename(word: str, lab: Path, pico: Pico) -> None:
    leaves = {leaf["tunable"]: leaf for leaf in pico("blame", word, "--json").data["leaves"]}
    assert leaves["angle"]["component"] == "pol_out" and leaves["angle"]["last"]["name"] == "C1"
    if "." not in word:
        assert leaves["pose"]["last"]["name"] == "C3"


def test_blame_says_which_run_set_what_is_renamed_since(brought: Brought, shel: Path, pico: Pico) -> None:
    def kinds(word: str) -> dict[str, tuple[str, str | None]]:
        leaves = pico("blame", word, "--json").data["leaves"]
        return {leaf["tunable"]: (leaf["last"]["how"]["kind"], leaf["last"]["how"].get("cause")) for leaf in leaves}

    brought(turned)
    before = kinds("p2")
    assert before["angle"] == ("run", "single")
    rename(shel)
    git(shel, "commit", "-q", "-a", "-m", "p2 is pol_out")
    assert kinds("pol_out") == kinds("p2") == before


@pytest.mark.parametrize("word", ["pol_out", "p2"])
def test_the_log_goes_through_the_rename(word: str, lab: Path, pico: Pico) -> None:
    answer = pico("log", "--oneline", "--", word)
    assert answer.code == 0 and "C3" in answer.out and "C1" in answer.out and "scratched" in pico("log", "--", word).out


def test_a_diff_across_the_rename_shows_what_moved_alone(lab: Path, pico: Pico) -> None:
    assert pico("diff", "HEAD~1", "HEAD", "--json").data["changes"] == []
    for ends in (("E1-3", "HEAD"), ("HEAD", "E1-3")):
        pose = [c for c in pico("diff", *ends, "--json").data["changes"] if c["tunable"] == "pose"]
        assert {c["component"] for c in pose} & {"p2", "pol_out"} and not any(c["before"] is None for c in pose)


def test_the_renamed_state_is_still_proven_by_the_run_before(lab: Path, pico: Pico) -> None:
    assert "is verified" in pico("verify").out


def test_notes_on_the_old_name_are_shown_and_new_ones_go_to_the_new(lab: Path, pico: Pico) -> None:
    assert pico("note", "p2", "cleaned").code == 0
    assert "cleaned" in (lab / "notes/pol_out.md").read_text()
    told = pico("blame", "pol_out").out
    assert "scratched" in told and "cleaned" in told


@pytest.mark.slow
@pytest.mark.parametrize("name", ["pol_out", "p2"])
def test_bisect_finds_it_by_either_name(name: str, lab: Path, pico: Pico) -> None:
    answer = pico("bisect", "run", "e2", "C1", "--expect", f"{name}.pose.yaw < 20.0", YES)
    assert answer.code == 0, answer.err


def test_a_recipe_with_the_old_name_runs_and_says_so(lab: Path, pico: Pico) -> None:
    recipe = lab / "recipes" / "turn.yaml"
    steps = '  - set: {p2.angle: "p2.angle - 5"}\n  - measure: p2.angle\n'
    recipe.write_text(f"apiVersion: pico/v1\nkind: Recipe\nmetadata: {{name: turn}}\nsteps:\n{steps}")
    answer = pico("run", "turn", YES)
    assert answer.code == 0, answer.err
    assert "p2 is now called pol_out" in answer.err
    assert "85" in pico("get", "pol_out.angle").out


def test_capture_writes_the_present_name(lab: Path, pico: Pico) -> None:
    edit(lab / "state/table.yaml", "\n  pol_out:\n", "\n  p2:\n")
    assert "p2 is now called pol_out" in pico("validate").err
    assert pico("set", "pol_out", "angle=80", "--yes").code == 0
    assert pico("capture").code == 0
    text = (lab / "state/table.yaml").read_text()
    assert "\n  pol_out:\n" in text and "p2:" not in text and "angle: 80" in text


def test_capture_keeps_the_old_name_where_the_lab_of_the_files_has_it(lab: Path, pico: Pico) -> None:
    assert pico("checkout", "main~1", "--files-only").code == 0
    assert pico("set", "pol_out", "angle=80", "--yes").code == 0
    assert pico("capture").code == 0
    text = (lab / "state/table.yaml").read_text()
    assert "\n  p2:\n" in text and "pol_out" not in text and "angle: 80" in text


def test_two_names_of_one_part_in_a_state_are_refused(lab: Path, pico: Pico) -> None:
    edit(lab / "state/table.yaml", "\n  pol_out:\n", "\n  p2: {slot: storage/b2}\n  pol_out:\n")
    answer = pico("validate")
    assert answer.code == 1 and "p2 and pol_out are one part" in answer.err


@pytest.mark.parametrize(
    ("formerly", "said"),
    [("[p1]", "but p1 is a part of this lab"), ("[P2]", "is not a name"), ("[pol, pol]", "is there twice")],
)
def test_a_former_name_is_a_name_of_one_part(formerly: str, said: str, shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "\n  p2:\n", f"\n  p2:\n    formerly: {formerly}\n")
    answer = pico("validate")
    assert answer.code == 1 and said in answer.err and "lab.yaml:" in answer.err


def test_a_former_name_is_claimed_once(shel: Path, pico: Pico) -> None:
    for name in ("p1", "p2"):
        edit(shel / "lab.yaml", f"\n  {name}:\n", f"\n  {name}:\n    formerly: [pol]\n")
    assert "p1 and p2 both claim the former name pol" in pico("validate").err.replace("p2 and p1", "p1 and p2")


def test_a_part_that_the_bench_lacks_is_left_out_by_exclude(brought: Brought, shel: Path, pico: Pico) -> None:
    brought(applied)
    rename(shel, formerly=False)
    assert pico("bench", "update", YES).code == 0
    refused = pico("plan", "E1-3")
    assert refused.code == 1 and "--exclude p2" in refused.err and "formerly: [p2]" in refused.err
    plan = pico("plan", "E1-3", "--exclude", "p2")
    assert plan.code == 0 and "lx_125" in plan.out and "left out as asked" in plan.err
    saved = pico("plan", "E1-3", "--exclude", "p2", "--exclude", "pol_out", "--out", "a.plan")
    assert saved.code == 0 and "~ pol_out" not in saved.out
    assert pico("apply", "./a.plan", YES).code == 0
    unknown = pico("plan", "E1-3", "--exclude", "p2", "--exclude", "p7")
    assert unknown.code == 1 and "p7" in unknown.err


def test_a_merge_of_an_edit_under_the_old_name_is_not_lost(lab: Path, pico: Pico) -> None:
    git(lab, "checkout", "-q", "-b", "edited", "main~1")
    edit(lab / "state/table.yaml", "\n  p2:\n", "\n  p2:\n    # turned by hand\n")
    text = (lab / "state/table.yaml").read_text()
    at = text.index("# turned by hand")
    (lab / "state/table.yaml").write_text(text[:at] + text[at:].replace("angle: 90", "angle: 70", 1))
    git(lab, "commit", "-q", "-a", "-m", "p2 turned")
    git(lab, "checkout", "-q", "main")
    answer = pico("merge", "edited")
    if answer.code == 0:
        assert "angle: 70" in (lab / "state/table.yaml").read_text()
    else:
        assert "p2" in answer.err and "conflict" in answer.err
        assert git(lab, "status", "--porcelain") == ""


def test_the_present_names_of_a_chain_and_of_expressions() -> None:
    from pico.model.address import renamed_expression

    names = {"p2": "pol_out", "cam": "camera"}
    text = "p2.pose.x > 3 && cam.peak > p22.x && lx.p2.y && 'p2.x' == \"cam.peak\""
    wanted = "pol_out.pose.x > 3 && camera.peak > p22.x && lx.p2.y && 'p2.x' == \"cam.peak\""
    assert renamed_expression(names, text) == wanted


def test_plans_as_json_name_what_was_renamed(lab: Path, pico: Pico) -> None:
    told = json.dumps(pico("plan", "E1-3", "--json").data["diagnostics"])
    assert "p2 is now called pol_out" in told and "inventory.p2 removed" not in told


def other(lab: Path) -> None:
    """A branch `other` from before the renaming, on which p2 is turned."""
    git(lab, "switch", "-q", "-c", "other", "HEAD~1")
    table = lab / "state/table.yaml"
    head, p2, rest = table.read_text().partition("\n  p2:\n")
    assert "angle: 90" in rest
    table.write_text(head + p2 + re.sub(r"angle: 90(\.0)?", "angle: 45", rest, count=1))
    git(lab, "commit", "-q", "-a", "-m", "p2 at 45")


@pytest.mark.parametrize("onto", ["main", "other"])
def test_a_merge_carries_a_change_over_to_the_new_name_of_a_part(lab: Path, pico: Pico, onto: str) -> None:
    other(lab)
    git(lab, "switch", "-q", onto)
    answer = pico("merge", "other" if onto == "main" else "main", "-m", "both")
    assert answer.code == 0, answer.err + answer.out
    parts = yaml.safe_load((lab / "state/table.yaml").read_text())["components"]
    assert "p2" not in parts and parts["pol_out"]["angle"] == 45
    inventory = yaml.safe_load((lab / "lab.yaml").read_text())["inventory"]
    assert "p2" not in inventory and inventory["pol_out"]["formerly"] == ["p2"]


def test_a_change_of_both_sides_is_a_conflict_of_the_new_name(lab: Path, pico: Pico) -> None:
    other(lab)
    git(lab, "switch", "-q", "main")
    head, name, rest = (lab / "state/table.yaml").read_text().partition("\n  pol_out:\n")
    (lab / "state/table.yaml").write_text(head + name + re.sub(r"angle: 90(\.0)?", "angle: 30", rest, count=1))
    git(lab, "commit", "-q", "-a", "-m", "pol_out at 30")
    refused = pico("merge", "other")
    assert refused.code != 0 and "pol_out.angle" in refused.err and refused.err.count("error[") == 1
    assert git(lab, "status", "--porcelain") == ""


def test_a_revert_of_an_older_change_reaches_the_part_by_its_new_name_and_of_the_renaming_takes_it_back(
    brought: Brought, shel: Path, pico: Pico
) -> None:
    brought(turned)
    rename(shel)
    assert pico("bench", "update", YES).code == 0
    git(shel, "commit", "-q", "-a", "-m", "p2 is pol_out")
    assert pico("revert", "HEAD~1").code == 0
    parts = yaml.safe_load((shel / "state/table.yaml").read_text())["components"]
    assert "p2" not in parts and parts["pol_out"]["angle"] == 90
    answer = pico("revert", "HEAD~1")
    parts = yaml.safe_load((shel / "state/table.yaml").read_text())["components"]
    assert answer.code == 0 and "pol_out" not in parts and parts["p2"]["angle"] == 90, answer.err

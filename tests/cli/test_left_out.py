"""A manifest that git or the file system keeps away: what commands say, and that none of them moves or writes."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from commanding import Pico, edit

MORE = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents:\n"


@pytest.fixture
def split(shel: Path) -> Path:
    """The example with p2 in a file of its own, committed."""
    table, more = shel / "state" / "table.yaml", shel / "more" / "p2.yaml"
    before, p2, after = _parted(table.read_text(), "p2")
    table.write_text(before + after)
    more.parent.mkdir()
    more.write_text(MORE + p2)
    _git("add", "-A")
    _git("commit", "-qm", "p2 in a file of its own")
    return shel


def _parted(text: str, part: str) -> tuple[str, str, str]:
    lines = text.splitlines(keepends=True)
    first = lines.index(f"  {part}:\n")
    last = next((i for i in range(first + 1, len(lines)) if not lines[i].startswith("    ")), len(lines))
    return "".join(lines[:first]), "".join(lines[first:last]), "".join(lines[last:])


def _git(*words: str) -> None:
    subprocess.run(["git", *words], check=True, capture_output=True)


REFUSING = (
    ("plan",), ("apply", "--auto-approve"), ("capture",), ("commit", "-m", "x"), ("status",), ("drift",), ("verify",),
    ("check",), ("validate",), ("diff",), ("doctor",),
)  # fmt: skip


def test_what_sparse_checkout_leaves_out_is_named_by_every_command_that_reads_the_manifests(
    split: Path, pico: Pico
) -> None:
    assert pico("apply", "--auto-approve").code == 0
    _git("sparse-checkout", "set", "state")
    assert not (split / "more").exists()
    for words in REFUSING:
        said = pico(*words)
        assert said.code == 1, words
        assert "more/p2.yaml: HEAD has it, and sparse checkout leaves it out" in said.err + said.out, words
    assert pico("log").code == pico("show").code == 0
    _git("sparse-checkout", "disable")
    assert pico("plan", "--detailed-exitcode").code == 0


def test_a_state_that_is_a_link_says_why_nothing_was_read(shel: Path, pico: Pico, tmp_path: Path) -> None:
    (shel / "state").rename(tmp_path / "elsewhere")
    (shel / "state").symlink_to(tmp_path / "elsewhere")
    said = pico("plan")
    assert said.code == 1
    assert "state: a link, and links are not followed: table.yaml behind it is not read" in said.err
    assert "--> state\n" in said.err  # a link has no lines


def test_a_plan_says_which_deleted_file_sends_parts_home(split: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    (split / "more" / "p2.yaml").unlink()
    said = pico("plan", "--detailed-exitcode")
    assert said.code == 2
    assert "more/p2.yaml: deleted since HEAD, and no other file names p2" in said.err


def test_a_state_that_git_renamed_is_an_error_of_plan_and_validate_once_it_is_committed(
    split: Path, pico: Pico
) -> None:
    assert pico("apply", "--auto-approve").code == 0
    _git("mv", "more/p2.yaml", "more/p2.yaml.bak")
    _git("commit", "-qm", "bak")
    for words in (("plan",), ("plan", "HEAD"), ("validate",), ("apply", "--auto-approve")):
        said = pico(*words)
        assert said.code == 1 and "error[name]" in said.err + said.out, words
        assert "more/p2.yaml.bak: a state with p2 that is not read" in said.err + said.out, words
    assert pico("log").code == 0
    _git("mv", "more/p2.yaml.bak", "more/p2.yaml")
    assert pico("plan", "--detailed-exitcode").code == 0


def test_a_plan_says_which_state_without_parts_sends_parts_home(split: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    (split / "more" / "p2.yaml").write_text(MORE)
    said = pico("plan", "--detailed-exitcode")
    assert said.code == 2
    assert "more/p2.yaml: no part is left since HEAD, and no other file names p2" in said.err
    _git("commit", "-qam", "cut off")
    assert "more/p2.yaml" not in pico("plan").err
    said = pico("plan", "HEAD")
    assert "HEAD:more/p2.yaml: no part is left in this commit, and no other file names p2" in said.err


def test_a_lab_under_another_extension_is_named(shel: Path, pico: Pico) -> None:
    (shel / "lab.yaml").rename(shel / "lab.yml")
    said = pico("plan")
    assert said.code == 1 and "lab.yml: a manifest that is not read" in said.err


def test_a_part_that_gits_merge_kept_is_told_by_status_and_validate_as_by_plan(shel: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    table, more = shel / "state" / "table.yaml", shel / "state" / "more.yaml"
    before, p2, after = _parted(table.read_text(), "p2")
    for branch, moved in (("takes", ""), ("moves", MORE + p2)):
        _git("checkout", "-q", "-b", branch, "main")
        table.write_text(before + after)
        if moved:
            more.write_text(moved)
        _git("add", "-A")
        _git("commit", "-qm", branch)
    assert pico("validate").code == 0 and "warning" not in pico("status").err
    _git("-c", "merge.pico.driver=false", "merge", "-q", "-m", "merge", "takes")
    for words, code in ((("plan",), 1), (("status",), 0), (("validate",), 1)):
        said = pico(*words)
        assert said.code == code and "error[merge-conflict]" in said.err, words
        assert "git's merge" in said.err, words


def test_stop_asks_no_manifest(shel: Path, pico: Pico) -> None:
    edit(shel / "state" / "table.yaml", "components:", "component:")
    assert pico("plan").code == 1
    assert pico("stop").code == 0


def test_a_simulated_table_that_is_gone_is_never_taken_for_one_with_every_part_at_home(shel: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    (shel / ".pico/benches/sim" / "world.json").unlink()
    before = (shel / "state" / "table.yaml").read_text()
    for command in ("status", "plan", "capture", "commit --capture -m x", "apply --auto-approve"):
        said = pico(*command.split())
        assert said.code == 1 and "error[world-file]" in said.err and "pico sim reset" in said.err, command
    assert (shel / "state" / "table.yaml").read_text() == before
    assert pico("sim", "reset").code == 0
    assert pico("plan", "--detailed-exitcode").code == 2


def test_an_emptied_file_is_restored_before_anything_else(shel: Path, pico: Pico) -> None:
    state = next(path for path in sorted((shel / "state").glob("*.yaml")))
    name = str(state.relative_to(shel))
    for path, text in ((name, ""), ("lab.yaml", ""), (name, "# nothing but comments\n")):
        whole = (shel / path).read_text()
        (shel / path).write_text(text)
        said = " ".join(pico("status").err.split())
        assert f"if a commit has it, `git restore {path}` brings it back" in said, said
        (shel / path).write_text(whole)
    for one in (shel / "state").glob("*.yaml"):
        one.unlink()
    assert "`git restore FILE` brings it back" in " ".join(pico("status").err.split())

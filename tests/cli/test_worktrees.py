"""Several worktrees of one repository: one has the bench, the others look at it and plan."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from bench_at import bench_at
from commanding import Pico

from pico.diagnostics import PicoError
from pico.edge.lease import BenchLock
from pico.places.attachment import require_attached
from pico.places.lab import lab_place
from pico.places.record import attached


def git(folder: Path, *words: str) -> str:
    done = subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.fixture
def other(shel: Path) -> Path:
    """A second worktree, at e1."""
    folder = shel.parent / "other"
    git(shel, "worktree", "add", "-q", str(folder), "-b", "second", "e1")
    return folder


def at(pico: Pico, folder: Path, *words: str, code: int = 0) -> str:
    answer = pico("-C", str(folder), *words)
    assert answer.code == code, (words, answer.out, answer.err)
    return answer.out + answer.err


def test_a_branch_and_a_tag_are_made_as_git_makes_them(shel: Path, pico: Pico) -> None:
    here = git(shel, "rev-parse", "HEAD")
    assert "The branch tilted is at" in at(pico, shel, "git", "branch", "tilted", "e1")
    assert (
        pico("-C", str(shel), "--json", "git", "tag", "E1-9").data["commit"] == here == git(shel, "rev-parse", "E1-9")
    )
    assert (git(shel, "rev-parse", "tilted"), git(shel, "rev-parse", "HEAD")) == (git(shel, "rev-parse", "e1"), here)
    assert "`nowhere` is no revision" in at(pico, shel, "git", "branch", "x", "nowhere", code=1)
    assert "already exists" in at(pico, shel, "git", "tag", "E1-9", code=1)
    assert "not a valid" in at(pico, shel, "git", "branch", "a..b", code=1)


def test_the_first_that_moves_has_the_bench_and_the_other_one_plans_against_it(
    shel: Path, other: Path, pico: Pico
) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    assert "Nothing to do" in at(pico, other, "plan", "e1")
    assert not (other / ".pico/benches/sim").exists()
    at(pico, other, "status")
    at(pico, other, "drift", "--detailed-exitcode")
    at(pico, other, "plan", "e2", "--detailed-exitcode", code=2)
    assert lab_place(shel).record.is_file()
    assert attached(lab_place(other), "sim") == shel


@pytest.mark.parametrize(
    "words",
    [
        ("apply", "e2", "--auto-approve"), ("checkout", "e2", "--auto-approve"), ("set", "cam", "exposure=3"),
        ("move", "p2", "home", "-y"), ("sim", "reset"), ("sim", "nudge", "p2", "--dx", "5"),
        ("sim", "faults", "drop=0.5"),
        ("sim", "person", "here"),
    ],
)  # fmt: skip
def test_what_would_move_the_bench_is_refused_in_another_worktree_which_stays_as_it_is(
    shel: Path, other: Path, pico: Pico, words: tuple[str, ...]
) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    before = (shel / ".pico/benches/sim/world.json").read_text()
    said = " ".join(at(pico, other, *words, code=5).split())  # however wide the terminal is
    assert f"only plans on `sim`: that bench is attached to {shel}" in said and f"`pico -C {other} git attach`" in said
    assert (shel / ".pico/benches/sim/world.json").read_text() == before
    assert not (shel / ".pico/benches/sim/faults.json").exists()
    assert git(other, "rev-parse", "HEAD") == git(shel, "rev-parse", "e1^0")


def test_files_of_another_worktree_go_elsewhere_without_the_bench(shel: Path, other: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    at(pico, other, "checkout", "e2", "--files-only")
    assert git(other, "rev-parse", "HEAD") == git(shel, "rev-parse", "e2^0")


def test_another_worktree_captures_and_commits_what_the_bench_shows(shel: Path, other: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e2", "--auto-approve")
    at(pico, other, "commit", "--capture", "-m", "the bench as it stands")
    assert "Nothing to do" in at(pico, other, "plan")


def test_the_bench_moves_to_the_worktree_that_is_attached(shel: Path, other: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    world = (shel / ".pico/benches/sim/world.json").read_bytes()
    answer = pico("-C", str(other), "git", "attach", "--json")
    assert answer.code == 0 and answer.data == {
        "schema": "pico.attached/v1", "bench": "sim", "folder": str(other), "before": str(shel),
    }  # fmt: skip
    assert (other / ".pico/benches/sim/world.json").read_bytes() == world
    assert not (shel / ".pico/benches/sim/world.json").exists()
    assert "Nothing to do" in at(pico, shel, "plan", "e1")
    at(pico, other, "apply", "e2", "--auto-approve")
    at(pico, shel, "apply", "e1", "--auto-approve", code=5)
    at(pico, other, "undo", "--auto-approve")  # the journal came along
    assert "Nothing to do" in at(pico, shel, "plan", "e1")


def test_what_a_worktree_had_of_its_own_before_is_set_aside(shel: Path, other: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    (other / ".pico/benches/sim").mkdir(parents=True)
    (other / ".pico/benches/sim/world.json").write_text("of an older PICO")
    at(pico, other, "git", "attach")
    assert (other / ".pico/benches/sim/replaced/world.json").read_text() == "of an older PICO"


def test_a_bench_in_use_is_not_taken_away(shel: Path, other: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    with BenchLock(bench_at(shel)).held("somebody's apply"):
        assert "somebody's apply" in at(pico, other, "git", "attach", code=5)
    assert attached(lab_place(other), "sim") == shel


def test_a_bench_whose_worktree_is_gone_is_free_and_that_is_said(shel: Path, other: Path, pico: Pico) -> None:
    at(pico, other, "apply", "e1", "--auto-approve")
    git(shel, "worktree", "remove", "--force", str(other))
    said = at(pico, shel, "apply", "e1", "--auto-approve", code=5)
    assert f"attached to {other}, which is gone, with its state and journal" in said
    at(pico, shel, "git", "attach")
    at(pico, shel, "apply", "e1", "--auto-approve")


def test_a_bench_whose_worktree_was_deleted_is_never_captured_and_every_look_warns(
    shel: Path, other: Path, pico: Pico
) -> None:
    at(pico, other, "apply", "e1", "--auto-approve")
    shutil.rmtree(other)
    for words in (("status",), ("drift",), ("verify",), ("bench",), ("plan",)):
        answer = pico(*words)
        assert f"attached to {other}, which is gone" in " ".join(answer.err.split()), (words, answer)
    head, table = git(shel, "rev-parse", "HEAD"), (shel / "state/table.yaml").read_text()
    for words in (("commit", "--capture", "-m", "x"), ("capture",), ("commit", "-m", "x", "--allow-empty")):
        assert "which is gone" in at(pico, shel, *words, code=5)
    assert (git(shel, "rev-parse", "HEAD"), (shel / "state/table.yaml").read_text()) == (head, table)
    at(pico, shel, "commit", "--planned", "--allow-empty", "-m", "x")
    assert "Pico-Evidence: planned" in git(shel, "log", "-1", "--format=%B")


def test_a_bench_that_git_clean_deleted_is_not_captured(shel: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    shutil.rmtree(shel / ".pico")
    for words in (("commit", "--capture", "-m", "x"), ("capture",)):
        assert "what PICO kept of the bench `sim` is gone" in " ".join(at(pico, shel, *words, code=5).split())
    assert not git(shel, "status", "--porcelain", "state")


@pytest.mark.parametrize("here", [True, False])
def test_a_worktree_that_git_moved_keeps_its_bench(shel: Path, other: Path, pico: Pico, here: bool) -> None:
    at(pico, other, "apply", "e1", "--auto-approve")
    new = shel.parent / "new"
    git(shel, "worktree", "move", str(other), str(new))
    place = new if here else shel
    refused = " ".join(at(pico, place, "set", "cam", "exposure=3", "-y", code=5).split())
    assert f"its state and journal are in {new}/.pico/benches/sim" in refused, refused
    assert f"`pico -C {place} --bench sim git attach` continues with them" in refused
    at(pico, place, "--bench", "sim", "git", "attach")
    assert "Nothing to do" in at(pico, place, "plan", "e1")
    at(pico, place, "undo", "-y")


def test_a_repository_that_was_moved_or_copied_keeps_its_bench(shel: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    copy = shel.parent / "copy"
    shutil.copytree(shel, copy)
    assert bench_at(copy).folder == copy / ".pico/benches/sim"
    at(pico, copy, "apply", "e2", "--auto-approve")
    assert "Nothing to do" in at(pico, shel, "plan", "e1")


def test_clones_have_a_bench_each(shel: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    git(shel.parent, "clone", "-q", str(shel), "clone")
    at(pico, shel.parent / "clone", "apply", "--auto-approve")
    assert "Nothing to do" in at(pico, shel, "plan", "e1")


def test_two_labs_of_one_repository_are_two_benches(shel: Path, pico: Pico) -> None:
    inner = shel.parent / "two"
    git(shel.parent, "init", "-q", "two")
    for name in ("a", "b"):
        shutil.copytree(shel, inner / name, ignore=shutil.ignore_patterns(".git", ".pico"))
    at(pico, inner / "a", "apply", "--auto-approve")
    assert json.loads((inner / ".git/pico/bench.json").read_text())["a"] == {"sim": "../a"}
    assert not (inner / "b" / ".pico/benches/sim").exists()
    at(pico, inner / "b", "apply", "--auto-approve")
    assert bench_at(inner / "b").folder == inner / "b" / ".pico/benches/sim"


def test_a_lab_outside_git_has_its_bench_beside_it(shel: Path, pico: Pico) -> None:
    shutil.rmtree(shel / ".git")
    at(pico, shel, "apply", "--auto-approve")
    assert bench_at(shel).folder == shel / ".pico/benches/sim"
    at(pico, shel, "git", "attach", code=1)


def test_looking_attaches_nobody_and_scratch_folders_are_no_lab(shel: Path, other: Path, pico: Pico) -> None:
    for words in (("status",), ("plan", "e2"), ("log",), ("check",)):
        pico("-C", str(other), *words)
    (shel / "scratch").mkdir()
    require_attached(bench_at(shel / "scratch"))
    assert not lab_place(shel).record.exists()


def test_a_bench_from_before_worktrees_belongs_to_the_main_one(shel: Path, other: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    lab_place(shel).record.unlink()
    at(pico, other, "apply", "e1", "--auto-approve", code=0)  # nothing to do there
    at(pico, other, "move", "p2", "home", "-y", code=5)


def test_a_record_that_is_damaged_names_nobody(shel: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    for text in ('{".": 3}', '{".": "../../../../../../etc"}'):
        lab_place(shel).record.write_text(text)
        assert bench_at(shel).folder == shel / ".pico/benches/sim"
    for text in ("", "[]", "\0"):  # it may have named another worktree
        lab_place(shel).record.write_text(text)
        refused = at(pico, shel, "apply", "--auto-approve", code=1)
        assert "bench.json cannot be read" in refused and "git attach` in the worktree" in refused


def test_a_stop_from_another_worktree_reaches_the_bench(shel: Path, other: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    assert "othing" in at(pico, other, "stop")


def test_a_bench_that_is_taken_meanwhile_is_not_moved_by_who_waited(shel: Path, other: Path, pico: Pico) -> None:
    at(pico, shel, "apply", "e1", "--auto-approve")
    waiting = BenchLock(bench_at(shel))
    at(pico, other, "git", "attach")
    with pytest.raises(PicoError) as caught:
        waiting.acquire("pico apply e2")
    assert caught.value.diagnostics[0].code == "not-attached"


def _dead_link(shel: Path) -> None:
    shel.rename(shel.parent / "moved")


def _no_head(shel: Path) -> None:
    (shel / ".git/worktrees/other/HEAD").unlink()


def _no_objects(shel: Path) -> None:
    (shel / ".git/objects").rename(shel / ".git/none")


@pytest.mark.parametrize("breaks", [_dead_link, _no_head, _no_objects])
@pytest.mark.parametrize(
    "words",
    [
        ("set", "cam", "exposure=3", "-y"), ("--bench", "emulated", "set", "cam", "exposure=3", "-y"),
        ("apply", "--auto-approve"), ("commit", "-m", "x"), ("git", "attach"), ("sim", "reset"),
    ],
)  # fmt: skip
def test_a_git_folder_that_cannot_be_read_is_not_taken_for_none(
    shel: Path, other: Path, pico: Pico, breaks: Callable[[Path], None], words: tuple[str, ...]
) -> None:
    breaks(shel)
    said = " ".join(at(pico, other, *words, code=1).split())
    assert "git-unreadable" in said and f"`git worktree repair {other}`" in said
    assert not (other / ".pico").exists()


def test_a_dead_link_below_another_repository_is_not_passed_over(shel: Path, pico: Pico) -> None:
    inner = shel / "inner"
    shutil.copytree(shel, inner, ignore=shutil.ignore_patterns(".git", "inner"))
    (inner / ".git").write_text("gitdir: ../gone/.git/worktrees/inner\n")
    assert "git-unreadable" in at(pico, inner, "set", "cam", "exposure=3", "-y", code=1)
    assert not (inner / ".pico").exists()

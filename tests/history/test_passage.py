"""Merge, revert and cherry-pick killed at any instant: whole or not at all, and nothing blocked."""

from __future__ import annotations

import shutil
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from commit_steps import EVERY, forked, guards_ended, kill_at

from pico.diagnostics import PicoError
from pico.history.examples.example import make_example
from pico.history.lab.folder import LabFolder
from pico.history.merge.checked import merge
from pico.history.repository.repository import Repository
from pico.history.restoring.checked import cherry_pick, revert
from pico.history.restoring.stash import Stash
from pico.history.writing import guard, index_lock, worktree

TABLE = "state/table.yaml"


@pytest.fixture(scope="module")
def origin(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example on a branch `ours`, with a branch `theirs` that can be merged, and `ahead` to be gone on to."""
    root = make_example("shel", tmp_path_factory.mktemp("passing") / "shel").root
    branches = (("theirs", "main", "520", "530"), ("ours", "main", "290", "300"), ("ahead", "ours", "300", "310"))
    for branch, start, before, after in branches:
        git_in(root, "checkout", "-q", "-b", branch, start)
        table = root / TABLE
        table.write_text(table.read_text().replace(f"x: {before}", f"x: {after}"))
        (root / f"{branch}.txt").write_text(branch)
        git_in(root, "add", "-A")
        git_in(root, "commit", "-q", "-m", branch)
    git_in(root, "checkout", "-q", "ours")
    return root


@pytest.fixture
def lab(origin: Path, tmp_path: Path) -> Path:
    return fresh(origin, tmp_path / "repo")


def fresh(origin: Path, root: Path) -> Path:
    """A copy with what must never be lost: an untracked file, and one of git's that is staged."""
    shutil.rmtree(root, ignore_errors=True)
    shutil.copytree(origin, root)
    (root / "mine.txt").write_text("not git's\n")
    return root


def git_in(root: Path, *words: str) -> str:
    who = ["-c", "user.name=A", "-c", "user.email=a@localhost"]
    return subprocess.run(["git", *who, *words], cwd=root, check=True, capture_output=True, text=True).stdout


Way = Callable[[Path], object]
WAYS: dict[str, Way] = {
    "merge": lambda root: merge(LabFolder(root), "theirs", "both"),
    "fast-forward": lambda root: merge(LabFolder(root), "ahead"),
    "revert": lambda root: revert(LabFolder(root), "HEAD"),
    "cherry-pick": lambda root: cherry_pick(LabFolder(root), ["theirs", "ahead"]),
    "checkout": lambda root: LabFolder(root).history().checkout("theirs"),
    "stash": lambda root: Stash(LabFolder(root)).push(),
    "stash pop": lambda root: Stash(LabFolder(root)).pop(),
    "no-commit": lambda root: revert(LabFolder(root), "HEAD", commit=False),
}


def files(root: Path) -> dict[str, str]:
    return {p.name: p.read_text() for p in (*root.glob("state/*"), *root.glob("*.txt"))}


def shelved(root: Path) -> str:
    return git_in(root, "stash", "list", "--format=%gs %T")


Looks = tuple[str, str, str, dict[str, str]]


def look(root: Path) -> Looks:
    """Return HEAD's tree, what git finds edited, the stash, and the files; demand that git is not blocked."""
    git_in(root, "fsck", "--strict", "--no-dangling")
    assert not (root / ".git" / "MERGE_HEAD").exists() and not (root / ".git" / "index.lock").exists()
    left = [p.name for p in root.rglob("*") if p.suffix == ".tmp" or p.name in (".merge_file", "files")]
    assert not left
    return git_in(root, "rev-parse", "HEAD^{tree}"), git_in(root, "status", "--porcelain"), shelved(root), files(root)


def ends(origin: Path, root: Path, way: Way) -> list[Looks]:
    """Return what a repository looks like before, and after, something was done."""
    prepared(origin, root, way)
    before = look(root)
    way(root)
    return [before, look(root)]


def prepared(origin: Path, root: Path, way: Way) -> Path:
    """A copy, with what there is to shelve or shelved where that is what is to be done."""
    fresh(origin, root)
    if way in (WAYS["stash"], WAYS["stash pop"]):
        (root / TABLE).write_text((root / TABLE).read_text().replace("x: 300", "x: 305"))
        (root / "state" / "new.yaml").write_text("apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\n")
    if way is WAYS["stash pop"]:
        WAYS["stash"](root)
    return root


@pytest.mark.slow
@pytest.mark.parametrize("guarding", [True, False], ids=["guarded", "power"])
@pytest.mark.parametrize("name", WAYS)
def test_killed_at_many_steps_it_is_whole_or_not_at_all(
    origin: Path, tmp_path: Path, name: str, guarding: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not guarding:
        monkeypatch.setattr(guard, "_WAITING", "")
    root, way = tmp_path / "repo", WAYS[name]
    allowed, seen = ends(origin, root, way), set()
    step, ended = 0, False
    while not ended:
        step += 7  # `benchmarks/kills.py --git` does every one
        prepared(origin, root, way)

        def work(step: int = step) -> None:
            kill_at(step, after=bool(step % 2), watched=EVERY)
            way(root)

        ended = forked(work)
        if guarding:
            guards_ended(root / ".git")
        else:
            git_in(root, "gc", "--quiet", "--prune=now")
            repository = Repository.discover(root)
            assert repository is not None
            with repository.writing("the next command"):
                pass
        now = look(root)
        assert now in allowed, (step, now)
        seen.add(allowed.index(now))
        assert step < 300
    assert seen == {0, 1}


def hook(root: Path, name: str, script: str) -> None:
    path = root / ".git" / "hooks" / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)


@pytest.mark.parametrize("name", ["merge", "revert", "cherry-pick"])
def test_killed_in_its_hooks_nothing_is_half_written_and_the_next_command_says_so(lab: Path, name: str) -> None:
    before = look(lab)
    hook(lab, "commit-msg", "kill -9 0")
    assert not forked(lambda: WAYS[name](lab))
    guards_ended(lab / ".git")
    assert look(lab) == before
    (lab / ".git" / "hooks" / "commit-msg").unlink()
    (said,) = LabFolder(lab).recovered
    assert f"took back what was half written by `pico {name}" in said.summary and not LabFolder(lab).recovered
    WAYS[name](lab)
    assert look(lab)[0] != before[0]


SLOW = pytest.mark.slow


@pytest.mark.parametrize(
    "name", ["merge", *(pytest.param(name, marks=SLOW) for name in ("cherry-pick", "fast-forward", "revert"))]
)
def test_killed_while_head_moves_it_is_finished_and_done_again_there_is_nothing_to_do(
    origin: Path, lab: Path, name: str
) -> None:
    wanted = ends(origin, lab, WAYS[name])[1]
    fresh(origin, lab)
    hook(lab, "reference-transaction", "kill -9 0")
    assert not forked(lambda: WAYS[name](lab))
    (lab / ".git" / "hooks" / "reference-transaction").unlink()
    guards_ended(lab / ".git")
    folder = LabFolder(lab)
    assert any("finished `pico" in d.summary for d in folder.recovered)
    assert look(lab) == wanted
    head = git_in(lab, "rev-parse", "HEAD")
    if name != "revert":  # that of HEAD is another one then
        WAYS[name](lab)
        assert git_in(lab, "rev-parse", "HEAD") == head


def test_without_its_guard_git_is_kept_out_until_the_next_command(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard, "_WAITING", "")
    before = look(lab)
    hook(lab, "commit-msg", "kill -9 0")
    assert not forked(lambda: WAYS["merge"](lab))
    with pytest.raises(subprocess.CalledProcessError):
        git_in(lab, "commit", "-a", "-m", "half a merge")
    assert LabFolder(lab).recovered and look(lab) == before


@pytest.mark.parametrize("linked", [False, True])
@pytest.mark.parametrize("name", ["merge", "stash pop"])
def test_what_git_clears_up_after_a_power_cut_is_not_what_the_claim_names(
    origin: Path, lab: Path, monkeypatch: pytest.MonkeyPatch, name: str, linked: bool
) -> None:
    root = lab.with_name("worktree") if linked else lab
    prepared(origin, lab, WAYS[name])
    if linked:
        git_in(lab, "reset", "-q", "--hard")
        git_in(lab, "worktree", "add", "-q", "-b", "here", str(root), "ours")
    monkeypatch.setattr(guard, "_WAITING", "")
    assert not forked(lambda: (kill_at(1, after=True, watched=[(worktree, "_put")]), WAYS[name](root)))
    git_in(lab, "gc", "--quiet", "--prune=now")
    (said,) = LabFolder(root).recovered
    assert ("took back" if name == "merge" else "finished") in said.summary
    look(lab)
    assert not git_in(root, "status", "--porcelain", "--untracked-files=no") or name == "stash pop"
    assert not git_in(lab, "for-each-ref", "refs/pico")


def test_a_claim_whose_objects_are_gone_is_given_up(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard, "_WAITING", "")
    assert not forked(lambda: (kill_at(1, after=True, watched=[(worktree, "_put")]), WAYS["merge"](lab)))
    shutil.rmtree(lab / ".git" / "refs" / "pico")
    git_in(lab, "gc", "--quiet", "--prune=now")
    (said,) = LabFolder(lab).recovered
    assert "git has lost objects of `pico merge" in said.summary and not LabFolder(lab).recovered


@pytest.mark.parametrize("at", ["commit-msg", "reference-transaction"])
@pytest.mark.parametrize("name", ["merge", "revert"])
def test_what_somebody_committed_in_between_by_git_is_not_taken_back(
    lab: Path, monkeypatch: pytest.MonkeyPatch, at: str, name: str
) -> None:
    monkeypatch.setattr(guard, "_WAITING", "")
    hook(lab, at, "kill -9 0")
    assert not forked(lambda: WAYS[name](lab))
    (lab / ".git" / "hooks" / at).unlink()
    for lock in (lab / ".git").rglob("*.lock"):
        if lock.name != "write.lock":
            lock.unlink()  # by hand, as after a power cut
    git_in(lab, "commit", "-q", "--allow-empty", "-a", "-m", "by hand")
    before, branch = look(lab), git_in(lab, "symbolic-ref", "HEAD")
    said = [d.summary for d in LabFolder(lab).recovered]
    assert any("gave that up" in line for line in said)
    assert look(lab) == before and git_in(lab, "symbolic-ref", "HEAD") == branch
    assert not (lab / ".git" / "pico" / "index.claim").exists() and not LabFolder(lab).recovered


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_other_signals_are_no_worse(lab: Path, by: signal.Signals) -> None:
    before = look(lab)
    hook(lab, "pre-merge-commit", f"kill -{by} $PPID; sleep 0.1")
    forked(lambda: WAYS["merge"](lab))
    guards_ended(lab / ".git")
    assert look(lab) == before


def test_what_somebody_edits_in_between_is_kept_and_told(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard, "_WAITING", "")
    hook(lab, "commit-msg", f"echo '# by hand' >> {TABLE}; kill -9 0")
    assert not forked(lambda: WAYS["merge"](lab))
    said = " ".join(d.summary for d in LabFolder(lab, history=True).recovered)
    assert TABLE in said and "left as edited" in said and "# by hand" in (lab / TABLE).read_text()
    assert not (lab / "theirs.txt").exists()


def test_a_hook_sees_the_merged_files_and_what_it_makes_of_them_is_committed(lab: Path) -> None:
    hook(lab, "pre-commit", f"grep -q 'x: 530' {TABLE} || exit 1; echo '# formatted' >> {TABLE}; git add {TABLE}")
    WAYS["merge"](lab)
    assert git_in(lab, "show", f"HEAD:{TABLE}") == (lab / TABLE).read_text()
    assert "# formatted" in (lab / TABLE).read_text() and git_in(lab, "status", "--porcelain") == "?? mine.txt\n"
    assert git_in(lab, "show", "-s", "--format=%P").split()[1:] == git_in(lab, "rev-parse", "theirs").split()


def test_what_git_does_not_keep_is_not_overwritten(lab: Path) -> None:
    (lab / "theirs.txt").write_text("mine\n")
    with pytest.raises(PicoError, match="would be overwritten"):
        WAYS["merge"](lab)
    assert (lab / "theirs.txt").read_text() == "mine\n" and not (lab / ".git" / "index.lock").exists()


def test_what_else_is_staged_stays_staged(lab: Path) -> None:
    (lab / "mine.txt").write_text("staged\n")
    git_in(lab, "add", "mine.txt")
    WAYS["revert"](lab)
    assert git_in(lab, "status", "--porcelain") == "A  mine.txt\n"
    assert "mine.txt" not in git_in(lab, "ls-tree", "-r", "--name-only", "HEAD")


def test_a_branch_that_somebody_moved_is_not_moved_and_all_is_as_before(
    lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    hook(lab, "commit-msg", "git update-ref refs/heads/ours ours~1")
    before = files(lab)
    with pytest.raises(PicoError):
        WAYS["merge"](lab)
    assert files(lab) == before and not (lab / ".git" / "index.lock").exists()
    assert git_in(lab, "rev-parse", "HEAD") == git_in(lab, "rev-parse", "main")


def test_a_lock_of_somebody_else_is_named(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(index_lock, "WAIT", 0.05)
    lock = lab / ".git" / "index.lock"
    lock.touch()
    for name in ("merge", "fast-forward", "revert", "cherry-pick", "no-commit", "checkout"):
        way = WAYS[name]
        with pytest.raises(PicoError) as caught:
            way(lab)
        (said,) = caught.value.diagnostics
        assert said.code == "git-locked" and str(lock) in said.summary and f"rm {lock}" in said.hint
    assert lock.exists()


def test_a_lock_that_nobody_is_seen_to_hold_is_not_waited_for_long(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(index_lock, "ALONE", 0.05)
    (lab / ".git" / "index.lock").touch()
    with pytest.raises(PicoError, match=r"waited for 0\.05 s, and nothing was written"):
        WAYS["merge"](lab)


def test_filters_line_ends_and_modes_are_those_of_git(lab: Path) -> None:
    git_in(lab, "checkout", "-q", "-b", "odd", "ours")
    (lab / ".gitattributes").write_text((lab / ".gitattributes").read_text() + "*.crlf text eol=crlf\n")
    (lab / "a.crlf").write_bytes(b"one\r\ntwo\r\n")
    (lab / "run.sh").write_text("#!/bin/sh\n")
    (lab / "run.sh").chmod(0o755)
    (lab / "link").symlink_to("run.sh")
    (lab / "new \n name").mkdir()
    (lab / "new \n name" / "é\tx").write_text("odd\n")
    git_in(lab, "add", ".gitattributes", "a.crlf", "run.sh", "link", "new \n name")
    git_in(lab, "commit", "-q", "-m", "odd")
    git_in(lab, "checkout", "-q", "ours")
    merge(LabFolder(lab), "odd")
    assert (lab / "a.crlf").read_bytes() == b"one\r\ntwo\r\n" and (lab / "link").readlink() == Path("run.sh")
    assert (lab / "run.sh").stat().st_mode & 0o111 and (lab / "new \n name" / "é\tx").read_text() == "odd\n"
    assert git_in(lab, "status", "--porcelain") == "?? mine.txt\n"
    git_in(lab, "checkout", "-q", "-b", "back")
    (lab / "link").unlink()
    (lab / "link").mkdir()
    (lab / "link" / "inside").write_text("a folder now\n")
    git_in(lab, "add", "link")
    git_in(lab, "commit", "-q", "-m", "a folder")
    git_in(lab, "checkout", "-q", "odd")
    merge(LabFolder(lab), "back")
    assert (lab / "link" / "inside").read_text() == "a folder now\n"
    assert git_in(lab, "status", "--porcelain") == "?? mine.txt\n"


def test_the_stash_is_that_of_git_both_ways(origin: Path, lab: Path) -> None:
    before = look(prepared(origin, lab, WAYS["stash"]))
    WAYS["stash"](lab)
    assert git_in(lab, "status", "--porcelain") == "?? mine.txt\n" and "x: 305" not in (lab / TABLE).read_text()
    git_in(lab, "stash", "pop", "--quiet")
    assert look(lab) == before
    git_in(lab, "stash", "push", "--quiet", "--include-untracked", "--", "state")
    WAYS["stash pop"](lab)
    assert look(lab) == before


def test_a_shelf_is_not_taken_down_over_edits(origin: Path, lab: Path) -> None:
    prepared(origin, lab, WAYS["stash pop"])
    (lab / TABLE).write_text((lab / TABLE).read_text() + "# later\n")
    with pytest.raises(PicoError, match="would be lost"):
        WAYS["stash pop"](lab)
    assert shelved(lab) and (lab / TABLE).read_text().endswith("# later\n")


def test_a_checkout_is_as_that_of_git(lab: Path) -> None:
    folder = LabFolder(lab)
    folder.history().checkout("theirs")
    assert git_in(lab, "reflog", "-1", "--format=%gs") == "checkout: moving from ours to theirs\n"
    assert folder.history().checkout("-").branch == "ours"
    assert folder.history().checkout("theirs~1").branch is None
    git_in(lab, "checkout", "-q", "-")
    assert git_in(lab, "symbolic-ref", "--short", "HEAD") == "ours\n" and look(lab)[1] == "?? mine.txt\n"


def test_a_branch_of_a_remote_is_made_and_one_of_another_worktree_is_not_taken(lab: Path) -> None:
    git_in(lab, "clone", "-q", ".", "../clone")
    clone = LabFolder(lab.parent / "clone").history()
    assert clone.checkout("theirs").branch == "theirs"
    assert git_in(clone.root, "rev-parse", "--abbrev-ref", "theirs@{upstream}") == "origin/theirs\n"
    git_in(lab, "worktree", "add", "-q", "../other", "theirs")
    with pytest.raises(PicoError, match="other"):
        LabFolder(lab).history().checkout("theirs")

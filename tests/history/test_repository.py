"""Reading a repository without checking it out, and what is said where that is not possible."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from pico.diagnostics import Diagnostic, PicoError
from pico.history.repository.repository import Repository

Git = Callable[..., str]


def opened(root: Path) -> Repository:
    repository = Repository.discover(root)
    assert repository is not None
    return repository


def test_discovery_finds_the_repository_around_a_folder(repo: Path) -> None:
    assert opened(repo / "state").root == repo


def test_a_folder_without_a_repository_has_none(tmp_path: Path) -> None:
    assert Repository.discover(tmp_path) is None


@pytest.mark.parametrize("cause", ["sha256", "bare", "reftable", "foreign"])
def test_what_cannot_be_read_is_named(cause: str, git: Git, tmp_path: Path) -> None:
    root = tmp_path / "repo"
    git("init", "-q", *{"sha256": ["--object-format=sha256"], "bare": ["--bare"]}.get(cause, []))
    if cause == "reftable":
        git("config", "core.repositoryFormatVersion", "1")
        git("config", "extensions.refStorage", "reftable")
    if cause == "foreign":
        if os.geteuid() != 0:
            pytest.skip("only root can give a folder away")
        subprocess.run(["chown", "-R", "4321", str(root)], check=True)
    with pytest.raises(PicoError) as caught:
        Repository.discover(root)
    (said,) = caught.value.diagnostics
    word = {"sha256": "SHA-256", "foreign": "another user"}.get(cause, cause)
    assert word in said.summary and str(root) in said.summary and said.hint


def test_head_is_a_branch_a_tag_or_nothing_yet(repo: Path, git: Git) -> None:
    repository = opened(repo)
    assert (repository.head().branch, repository.head().label) == ("main", "main")
    git("checkout", "-q", "first")
    assert (repository.head().branch, repository.head().label) == (None, "first")
    git("checkout", "-q", "--orphan", "new")
    assert (repository.head().commit, repository.head().branch) == (None, "new")


def test_revisions_of_every_form_resolve(repo: Path, git: Git) -> None:
    repository = opened(repo)
    first = git("rev-parse", "first").strip()
    for revision in (
        "first",
        "HEAD~1",
        "main^",
        first,
        first[:7],
        "main@{1}",
        "side~2",
        ":/commit 0",
        "refs/tags/first",
    ):
        assert repository.resolve(revision).id == first, revision
    assert repository.resolve("side").summary == "commit 2"
    assert repository.resolve("first").refs == ("first",)


def test_an_annotated_tag_is_its_commit(repo: Path, git: Git) -> None:
    git("tag", "-a", "-m", "measured", "noted", "side")
    commit = opened(repo).resolve("noted")
    assert commit.summary == "commit 2" and commit.refs == ("noted", "side")


@pytest.mark.parametrize(
    ("wrong", "hint"), [("mian", "main"), ("fisrt", "first"), ("HEAD~9", ""), ("-x", ""), ("", "leave the word out")]
)
def test_an_unknown_revision_is_named_with_the_nearest(repo: Path, wrong: str, hint: str) -> None:
    with pytest.raises(PicoError) as caught:
        opened(repo).resolve(wrong)
    (said,) = caught.value.diagnostics
    assert (f"`{wrong}`" if wrong else "an empty word") in said.summary and hint in said.hint


def test_a_clone_resolves_branches_that_only_its_remote_has(repo: Path, git: Git, tmp_path: Path) -> None:
    git("clone", "-q", "repo", "copy", at=".")
    copy = opened(tmp_path / "copy")
    assert copy.resolve("side").summary == "commit 2"
    assert copy.checkout("side").branch == "side"


def test_a_shallow_clone_says_how_to_get_the_rest(repo: Path, git: Git, tmp_path: Path) -> None:
    git("clone", "-q", "--depth=1", repo.as_uri(), "copy", at=".")
    shallow = opened(tmp_path / "copy")
    assert [c.summary for c in shallow.log()] == ["commit 1"]
    with pytest.raises(PicoError) as caught:
        shallow.resolve("HEAD~1")
    assert "--unshallow" in caught.value.diagnostics[0].hint


def test_files_are_read_without_a_checkout(repo: Path) -> None:
    repository = opened(repo)
    assert repository.files("side") == {"lab.yaml": b"kind: Lab\n", "state/table.yaml": b"x: 2\n"}
    assert repository.files("first", "state") == {"table.yaml": b"x: 0\n"}
    assert (repo / "state" / "table.yaml").read_text() == "x: 1\n"


def test_dot_folders_runs_and_links_are_not_read(repo: Path, git: Git) -> None:
    for folder in (".pico", "runs/2026"):
        (repo / folder).mkdir(parents=True)
        (repo / folder / "world.yaml").write_text("a: 1\n")
    (repo / "linked.yaml").symlink_to("/etc/passwd")
    git("add", "-A")
    git("commit", "-q", "-m", "more")
    found: list[Diagnostic] = []
    assert set(opened(repo).files("HEAD", diagnostics=found)) == {"lab.yaml", "state/table.yaml"}
    assert [d.severity for d in found] == ["error"] and "linked.yaml" in found[0].summary
    with pytest.raises(PicoError, match=r"linked\.yaml"):
        opened(repo).files("HEAD")


def test_a_folder_that_the_revision_lacks_is_an_error(repo: Path) -> None:
    (repo / "lab").mkdir()
    with pytest.raises(PicoError, match="`first` has no folder lab"):
        opened(repo).files("first", "lab")


def test_changed_lists_edited_new_and_removed_manifests(repo: Path) -> None:
    repository = opened(repo)
    assert repository.changed() == ()
    (repo / "state" / "table.yaml").write_text("x: 7\n")
    (repo / "state" / "new file.yaml").write_text("y: 7\n")
    (repo / "notes.txt").write_text("not a manifest")
    (repo / "lab.yaml").unlink()
    assert repository.changed() == ("lab.yaml", "state/new file.yaml", "state/table.yaml")
    assert repository.changed("state") == ("state/new file.yaml", "state/table.yaml")


def test_log_runs_from_the_newest_to_the_first_with_refs(repo: Path) -> None:
    repository = opened(repo)
    log = list(repository.log(repository.tips()))
    assert [(c.summary, c.refs) for c in log] == [
        ("commit 2", ("side",)),
        ("commit 1", ("main",)),
        ("commit 0", ("first",)),
    ]
    assert log[0].parents == (log[1].id,) and log[0].time.isoformat() == "2026-01-03T12:00:00+01:00"
    assert log[0].author == "A Physicist <physicist@localhost>"
    assert [c.summary for c in repository.log(["HEAD"], limit=1)] == ["commit 1"]


def test_log_of_a_folder_leaves_out_what_did_not_change_it(repo: Path, git: Git) -> None:
    (repo / "lab").mkdir()
    (repo / "lab" / "lab.yaml").write_text("a: 1\n")
    for number in range(3):
        (repo / "lab" / "lab.yaml").write_text(f"a: {number}\n")
        git("add", "-A")
        git("commit", "-q", "-m", f"lab {number}")
        (repo / "elsewhere.txt").write_text(str(number))
        git("add", "-A")
        git("commit", "-q", "-m", "elsewhere")
    log = list(opened(repo).log(folder="lab"))
    assert [c.summary for c in log] == ["lab 2", "lab 1", "lab 0"]
    assert [c.parents for c in log] == [(log[1].id,), (log[2].id,), ()]


def test_a_lab_may_lie_in_a_folder_of_a_larger_repository(git: Git, tmp_path: Path) -> None:
    git("init", "-q", "-b", "main")
    lab = tmp_path / "repo" / "labs" / "shel"
    lab.mkdir(parents=True)
    (lab / "lab.yaml").write_text("a: 1\n")
    (tmp_path / "repo" / "other.yaml").write_text("b: 1\n")
    repository = opened(lab)
    assert repository.changed(lab) == ("labs/shel/lab.yaml",)
    commit = repository.commit([lab], "the lab alone")
    assert repository.files(commit.id, lab) == {"lab.yaml": b"a: 1\n"}
    assert repository.changed() == ("other.yaml",)


def test_an_empty_repository_has_no_history_and_says_so(git: Git, tmp_path: Path) -> None:
    git("init", "-q", "-b", "main")
    repository = opened(tmp_path / "repo")
    assert list(repository.log()) == [] and repository.tips() == ()
    with pytest.raises(PicoError) as caught:
        repository.resolve("HEAD")
    assert "pico commit" in caught.value.diagnostics[0].hint


def test_a_linked_worktree_is_read_as_its_own(repo: Path, git: Git, tmp_path: Path) -> None:
    git("worktree", "add", "-q", "../second", "side")
    second = opened(tmp_path / "second")
    assert second.root == tmp_path / "second" and second.head().branch == "side"


def test_the_environment_of_a_hook_does_not_confuse_it(repo: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(repo)
    monkeypatch.setenv("GIT_DIR", ".git")
    repository = opened(repo)
    assert repository.root == repo and repository.changed() == ()


def test_a_lab_elsewhere_is_not_taken_for_the_repository_of_a_hook(
    repo: Path, git: Git, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    git("clone", "-q", "repo", "copy", at=".")
    monkeypatch.chdir(repo)
    monkeypatch.setenv("GIT_DIR", ".git")
    monkeypatch.setenv("GIT_INDEX_FILE", ".git/index")
    copy = opened(tmp_path / "copy")
    (copy.root / "lab.yaml").write_text("kind: Edited\n")
    assert copy.root == tmp_path / "copy" and copy.changed() == ("lab.yaml",)
    assert opened(repo).changed() == ()


def test_importing_history_does_not_import_libgit2() -> None:
    code = "import sys, pico.history.repository.repository, pico.history.git.lanes; sys.exit('pygit2' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

"""A manifest that was committed and is not read is an error that names it: its parts never go home in silence."""

from __future__ import annotations

import random
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from omission_cases import AT_REVISION, DELETING, IN_FOLDER, UNITS, WORKING, Box, at_revision, in_folder, read_lab

from pico.diagnostics import PicoError
from pico.history.blame.blamed import blame
from pico.history.diff.commits import CommitDiffs
from pico.history.lab.folder import LabFolder

ALL = frozenset({"p0", "p1", "p2", "p3"})


@pytest.fixture(scope="module")
def box() -> Iterator[Box]:
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)
        yield Box(Path(folder).resolve())


def require_bound(box: Box, *kinds: str) -> None:
    if not box.binds and any(IN_FOLDER[kind].bound for kind in kinds):
        pytest.skip("permissions bind only who is not root, and nobody else may enter the temporary folder")


@pytest.mark.parametrize("kind", IN_FOLDER)
@pytest.mark.parametrize("seed", range(3))
def test_what_is_left_out_of_the_working_tree_is_an_error(box: Box, kind: str, seed: int) -> None:
    require_bound(box, kind)
    found = in_folder(box, seed, (kind,))
    assert found.state is None
    assert not found.silent, found


@pytest.mark.parametrize("kind", AT_REVISION)
@pytest.mark.parametrize("seed", range(3))
def test_what_is_left_out_of_a_revision_is_an_error(box: Box, kind: str, seed: int) -> None:
    found = at_revision(box, seed, (kind,))
    assert found.state is None
    assert not found.silent, found


@pytest.mark.parametrize("seed", range(6))
def test_several_are_all_named(box: Box, seed: int) -> None:
    kinds = random.Random(seed).sample([name for name, kind in IN_FOLDER.items() if not kind.modules], 2)
    require_bound(box, *kinds)
    found = in_folder(box, seed, tuple(kinds))
    assert found.state is None
    assert not found.silent, found


@pytest.mark.parametrize("work", WORKING, ids=lambda work: work.__name__)
@pytest.mark.parametrize("committed", [False, True])
def test_who_leaves_nothing_out_is_not_troubled(box: Box, work: Callable[[Box], None], committed: bool) -> None:
    box.begin(modules=False)
    work(box)
    if committed:
        box.commit()
        assert read_lab(box.lab, "HEAD").state == ALL
    found = read_lab(box.lab)
    assert (found.state, found.said) == (ALL, ())


@pytest.mark.parametrize("delete", DELETING, ids=lambda delete: delete.__name__)
def test_parts_of_a_deleted_file_go_home_and_a_note_says_so(box: Box, delete: Callable[[Box], None]) -> None:
    box.begin(modules=False)
    delete(box)
    found = read_lab(box.lab)
    assert found.state == ALL - {"p1"}
    (said,) = found.said
    assert said.severity == "note"
    assert "optics/lenses.yaml" in said.summary and "p1" in said.summary


@pytest.mark.parametrize("delete", DELETING, ids=lambda delete: delete.__name__)
def test_a_revision_that_deleted_or_emptied_a_file_says_which_parts_go_home_by_that(
    box: Box, delete: Callable[[Box], None]
) -> None:
    box.begin(modules=False)
    delete(box)
    box.commit()
    assert read_lab(box.lab).said == ()
    (said,) = read_lab(box.lab, "HEAD").said
    assert said.severity == "note" and said.code == "gone"
    assert "HEAD:optics/lenses.yaml" in said.summary and "p1" in said.summary
    (box.lab / "top.yaml").write_text((box.lab / "top.yaml").read_text() + "# as before\n")
    box.commit()
    assert read_lab(box.lab, "HEAD").said == ()


ASIDE = ("p1", ".p1.yaml", "p1.yaml~", "p1.bak", ".x/p1.yaml", ".p1.yml")


@pytest.mark.parametrize("name", ASIDE)
def test_a_state_set_aside_stays_an_error_once_it_is_committed(box: Box, name: str) -> None:
    box.begin(modules=False)
    path = box.lab / "optics" / name
    path.parent.mkdir(exist_ok=True)
    (box.lab / "optics" / "lenses.yaml").rename(path)
    box.commit()
    (box.lab / "top.yaml").write_text((box.lab / "top.yaml").read_text() + "# as before\n")
    for shown, found in (("optics", read_lab(box.lab)), ("HEAD:optics", read_lab(box.lab, "HEAD"))):
        (said,) = found.said
        assert (said.severity, said.code) == ("error", "name")
        assert f"{shown}/{name}: a state with p1 that is not read" in said.summary and "delete it" in said.hint
    path.rename(box.lab / "optics" / "p1.yaml")
    assert (read_lab(box.lab).state, read_lab(box.lab).said) == (ALL, ())


def test_where_an_error_names_the_file_nothing_is_said_of_parts_that_go_home(box: Box) -> None:
    box.begin(modules=False)
    path = box.lab / UNITS[1]
    path.rename(path.with_suffix(".yml"))
    (said,) = read_lab(box.lab).said
    assert said.severity == "error" and "lenses.yml: a manifest that is not read" in said.summary


def test_a_state_set_aside_is_named_with_its_parts_and_where_it_belongs(box: Box) -> None:
    box.begin(modules=False)
    (box.lab / "optics" / "lenses.yaml").rename(box.lab / "optics" / "lenses.yaml.bak")
    (said,) = read_lab(box.lab).said
    assert said.severity == "error" and "lenses.yaml.bak: a state with p1 that is not read" in said.summary
    assert "`mv optics/lenses.yaml.bak optics/lenses.yaml`" in said.hint and "delete it" in said.hint


def test_submodules_that_are_checked_out_are_read(box: Box) -> None:
    box.begin(modules=True)
    for found in (read_lab(box.lab), read_lab(box.lab, "HEAD")):
        assert (found.state, found.said) == (ALL, ())


@pytest.mark.parametrize("aside", ["deinit", "embedded", "worktree"])
def test_a_revision_is_read_with_the_commits_of_its_submodules_wherever_these_lie(box: Box, aside: str) -> None:
    box.begin(modules=True)
    (box.lab / "optics" / "up").symlink_to(".")  # leads to what is read
    box.commit(box.lab / "optics")
    box.commit()
    path = box.lab / "optics" / "lenses.yaml"
    path.write_text(path.read_text().replace("x: 400", "x: 410"))
    root = box.lab
    if aside == "deinit":
        box.git("submodule", "--quiet", "deinit", "--force", "optics")
    elif aside == "embedded":
        path.with_name(".git").unlink()
        shutil.move(box.lab / ".git" / "modules" / "optics", path.with_name(".git"))
        box.git("config", "-f", str(path.with_name(".git") / "config"), "--unset", "core.worktree")
    elif aside == "worktree":
        root = box.folder / "away" / "worktree"
        box.git("worktree", "add", "-q", "--detach", str(root))
    folder = LabFolder(root, history=True)
    pose = folder.state_at("HEAD").components["p1"].pose
    assert pose and pose.x == 400
    assert not folder.manifests_at("HEAD").diagnostics


def test_log_and_blame_name_the_commit_that_changed_a_part_in_a_submodule(box: Box) -> None:
    box.begin(modules=True)
    path = box.lab / "optics" / "lenses.yaml"
    path.write_text(path.read_text().replace("x: 400", "x: 410"))
    box.commit(path.parent)
    (edited,) = blame(box.lab, ["p1.pose"]).leaves
    assert edited.last.commit is None
    box.commit()
    folder, head = LabFolder(box.lab, history=True), box.git("rev-parse", "HEAD").strip()
    (change,) = CommitDiffs(folder).entry(folder.history().resolve("HEAD")).changes
    assert change.component == "p1"
    (leaf,) = blame(box.lab, ["p1.pose"], history=True).leaves
    assert leaf.last.commit == head and len(leaf.history or ()) == 4
    assert [row.last.commit is None for row in blame(box.lab).leaves] == [False] * 5


def test_where_every_part_is_named_elsewhere_what_nobody_can_look_at_is_a_warning(box: Box) -> None:
    box.begin(modules=False)
    table = box.lab / "top.yaml"
    table.write_text(table.read_text() + "  p4:\n    slot: s4\n")
    (box.lab / "data").symlink_to(box.folder / "not mounted")
    box.commit()
    for found in (read_lab(box.lab), read_lab(box.lab, "HEAD")):
        assert found.state == ALL | {"p4"}
        (said,) = found.said
        assert said.severity == "warning" and "data" in said.summary and "not mounted" in said.summary


def test_a_link_to_more_than_can_be_looked_at_is_told(
    box: Box, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    box.begin(modules=False)
    for number in range(12):
        (tmp_path / f"{number}.txt").touch()
    monkeypatch.setattr("pico.manifest.links.MOST", 10)
    (box.lab / "data").symlink_to(tmp_path)
    found = read_lab(box.lab)
    assert found.state == ALL
    assert [d.severity for d in found.said] == ["warning"] and "data" in found.said[0].summary


def test_two_files_that_differ_in_case_alone_where_case_does_not_count(
    box: Box, monkeypatch: pytest.MonkeyPatch
) -> None:
    box.begin(modules=False)
    (box.lab / "State").mkdir()
    (box.lab / "State" / "table.yaml").write_text((box.lab / "top.yaml").read_text().replace("p0", "p4"))
    box.commit()
    (box.lab / "State" / "table.yaml").unlink()
    (box.lab / "State").rmdir()
    (box.lab / "State").symlink_to("state")  # what a file system without case looks like
    found = read_lab(box.lab)
    assert found.state is None and "State/table.yaml" in str([d.summary for d in found.said])


def test_history_is_shown_of_commits_that_can_not_be_read(box: Box) -> None:
    box.begin(modules=False)
    (box.lab / "state").rename(box.folder / "away" / "state")
    (box.lab / "state").symlink_to(box.folder / "away" / "state")
    box.commit()
    folder = LabFolder(box.lab, history=True)
    assert folder.wrong is not None
    entry = folder.entry(folder.history().resolve("HEAD"))
    assert not entry.changes and "state: a link" in entry.unreadable
    with pytest.raises(PicoError, match="state: a link"):
        folder.state_at("HEAD")

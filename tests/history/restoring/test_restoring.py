"""Physical changes taken back and done again: value by value, manifests only, and only to what can stand."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pygit2
import pytest
from giving import Git
from hypothesis import given, settings
from hypothesis import strategies as st
from merging_cases import Case, Leaf, case
from merging_cases import state_of as state

from pico.diagnostics import ExitCode, PicoError
from pico.history.examples.example import make_example
from pico.history.lab.folder import LabFolder
from pico.history.merge.checked import merge
from pico.history.merge.markers import Labels
from pico.history.merge.trees import Union, opened, unite_trees
from pico.history.restoring.checked import cherry_pick, revert, select_parts
from pico.history.restoring.last_change import last_change
from pico.history.restoring.stash import Stash
from pico.history.restoring.transplant import Transplanted

State = dict[Leaf, float | str]


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> pygit2.Repository:
    return pygit2.init_repository(str(tmp_path_factory.mktemp("store")))


def tree(store: pygit2.Repository, text: str) -> str:
    index = pygit2.Index()
    index.add(pygit2.IndexEntry("table.yaml", store.create_blob(text.encode()), pygit2.enums.FileMode.BLOB))
    return str(index.write_tree(store))


def done_to(ours: State, before: State, after: State) -> tuple[State, set[Leaf]]:
    """Return `ours` with what leads from `before` to `after` done to it leaf by leaf, and the leaves that disagree."""
    changed = {leaf for leaf in before.keys() | after.keys() if before.get(leaf) != after.get(leaf)}
    clash = {leaf for leaf in changed if ours.get(leaf) not in (before.get(leaf), after.get(leaf))}
    result = {leaf: value for leaf, value in ours.items() if leaf not in changed}
    return result | {leaf: after[leaf] for leaf in changed if leaf in after}, clash


def carried(store: pygit2.Repository, before: str, onto: str, after: str) -> tuple[Union, str]:
    """Return what came of doing the change from `before` to `after` to `onto`, and the manifest then."""
    union = unite_trees(store, tree(store, before), tree(store, onto), tree(store, after), Labels())
    return union, store[union.tree]["table.yaml"].data.decode() if union.tree else ""


def clashes(union: Union) -> set[Leaf]:
    return {(c.path[2], ".".join(c.path[3:])) for _, c in union.conflicts}


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_a_change_done_to_another_branch_is_what_it_is_leaf_by_leaf(store: pygit2.Repository, seed: int) -> None:
    c: Case = case(seed)
    wanted, clash = done_to(state(c.ours), state(c.base), state(c.theirs))
    union, text = carried(store, c.base, c.ours, c.theirs)
    assert clashes(union) == clash
    if not clash:
        assert state(text) == wanted
        assert not [comment for comment in c.comments if comment not in text]


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_a_change_taken_back_leaves_the_later_ones_and_their_comments(store: pygit2.Repository, seed: int) -> None:
    c: Case = case(seed)
    union, later = carried(store, c.base, c.theirs, c.ours)  # first theirs is committed, then ours
    if union.conflicts:
        return
    wanted, clash = done_to(state(later), state(c.theirs), state(c.base))
    back, text = carried(store, c.theirs, later, c.base)
    assert clashes(back) == clash
    if not clash:
        assert state(text) == wanted
        assert not [comment for comment in c.comments if " by ours " in comment and comment not in text]


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_taken_back_at_once_a_change_leaves_the_file_as_it_was(store: pygit2.Repository, seed: int) -> None:
    c: Case = case(seed)
    assert carried(store, c.theirs, c.theirs, c.base)[1] == c.base


# A whole lab, in a real repository.


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_example("shel", tmp_path_factory.mktemp("restoring") / "shel").root


@pytest.fixture
def lab(example: Path, tmp_path: Path, git: Git) -> LabFolder:
    shutil.copytree(example, tmp_path / "repo", dirs_exist_ok=True)
    git("checkout", "-q", "e1")
    return LabFolder(tmp_path / "repo")


def edit(folder: LabFolder, git: Git, component: str, before: str, after: str, *, commit: str = "") -> None:
    path = folder.root / "state" / "table.yaml"
    head, name, tail = path.read_text().partition(f"\n  {component}:\n")
    assert name and before in tail
    path.write_text(head + name + tail.replace(before, after, 1))
    if commit:
        git("commit", "-q", "-a", "-m", commit)
    folder.reload()


def angle(folder: LabFolder, component: str) -> object:
    return folder.state.components[component].values["angle"]


def refused(folder: LabFolder, act: Callable[[], object]) -> PicoError:
    """Demand that something is refused and writes nothing; return why."""
    table = folder.root / "state" / "table.yaml"
    before = (folder.history().resolve("HEAD").id, table.read_text())
    with pytest.raises(PicoError) as caught:
        act()
    assert (folder.history().resolve("HEAD").id, table.read_text()) == before
    return caught.value


def said(found: PicoError) -> str:
    return "\n".join(f"{d.summary} {d.detail} {d.hint}" for d in found.diagnostics)


def changed(done: Transplanted) -> list[tuple[str, str]]:
    return [(c.component, c.tunable) for c in done.changes]


def test_a_revert_takes_back_one_commit_and_keeps_later_edits_and_comments(lab: LabFolder, git: Git) -> None:
    edit(lab, git, "p2", "angle: 90", "angle: 45  # crossed", commit="by hand")
    done = revert(lab, "E1-3")
    assert changed(done) == [("p1", "angle"), ("p2", "pose")]
    assert (angle(lab, "p1"), angle(lab, "p2")) == (90, 45)
    assert "angle: 45  # crossed" in (lab.root / "state" / "table.yaml").read_text()
    message = git("show", "-s", "--format=%B")
    assert message.startswith('Revert "tilt of p2, lens pair 125/150"\n\nThis reverts commit ')
    assert lab.history().resolve("E1-3").id in message and "Pico-Evidence: planned" in message
    assert lab.state.digest() in message and not git("status", "--porcelain")


def test_what_was_taken_back_can_be_taken_back(lab: LabFolder, git: Git) -> None:
    before = lab.state.digest()
    revert(lab, "HEAD", message="too steep")
    assert git("show", "-s", "--format=%s").strip() == "too steep"
    revert(lab, "HEAD")
    assert lab.state.digest() == before
    assert git("show", "-s", "--format=%s").strip() == 'Revert "too steep"'
    revert(lab, "HEAD")
    assert git("show", "-s", "--format=%s").strip() == 'Reapply "too steep"'


def test_runs_and_notes_of_the_commit_stay(lab: LabFolder, git: Git) -> None:
    kept = [lab.root / "runs" / "2026" / "01" / "a" / "run.json", lab.root / "notes" / "p2.md"]
    for path in kept:
        path.parent.mkdir(parents=True)
        path.write_text("{}\n")
    git("add", "-A")
    edit(lab, git, "p2", "angle: 90", "angle: 45", commit="a run")
    assert changed(revert(lab, "HEAD")) == [("p2", "angle")]
    assert all(path.exists() for path in kept) and not git("diff", "HEAD~2", "--", "state")
    edit(lab, git, "p2", "angle: 90", "angle: 45")
    git("checkout", "-q", "state")
    git("commit", "-q", "--allow-empty", "-m", "nothing on the table")
    lab.reload()
    assert revert(lab, "HEAD").commit is None


def test_a_tunable_changed_since_is_named_with_both_commits_and_values(lab: LabFolder, git: Git) -> None:
    edit(lab, git, "p1", "angle: 1", "angle: 7", commit="finer")
    edit(lab, git, "p2", "angle: 90", "angle: 45", commit="another one")
    found = refused(lab, lambda: revert(lab, "E1-3"))
    assert found.exit_code == ExitCode.ERROR and [d.address for d in found.diagnostics] == ["p1.angle"]
    finer = lab.history().resolve("HEAD~1").short
    for words in ("E1-3", f'{finer} "finer"', "made it 1,", "since then 7", "it was 90", "pico checkout"):
        assert words in said(found), words


def test_a_commit_is_picked_with_message_and_author_but_without_its_runs(lab: LabFolder, git: Git) -> None:
    run = lab.root / "runs" / "2026" / "01" / "a" / "run.json"
    run.parent.mkdir(parents=True)
    run.write_text("{}\n")
    git("add", "-A")
    path = lab.root / "state" / "table.yaml"
    path.write_text(path.read_text().replace("exposure: 10", "exposure: 20  # dim"))
    more = "Signed-off-by: A <a@b>\nPico-State: sha256:0\nPico-Run: a\nPico-Evidence: physics"
    git(
        "commit",
        "-q",
        "-a",
        "--author=Somebody <s@b>",
        "-m",
        f"longer\n\nIt was dim.\n\n{more}",
        date="2026-02-03T04:05:06+01:00",
    )
    picked = lab.history().resolve("HEAD")
    git("checkout", "-q", "e2")
    lab.reload()
    (done,) = cherry_pick(lab, [picked.id])
    assert changed(done) == [("cam", "exposure")] and not (lab.root / "runs").exists()
    assert "exposure: 20  # dim" in path.read_text()
    message = git("show", "-s", "--format=%B")
    assert message.startswith("longer\n\nIt was dim.\n\nSigned-off-by: A <a@b>\n(cherry picked from commit ")
    assert picked.id in message and "Pico-Run" not in message and "physics" not in message
    assert f"Pico-State: {lab.state.digest()}" in message and "Pico-Evidence: planned" in message
    assert git("show", "-s", "--format=%an %ai").strip() == "Somebody 2026-02-03 04:05:06 +0100"
    assert cherry_pick(lab, [picked.id])[0].commit is None


def test_several_are_picked_or_none(lab: LabFolder, git: Git) -> None:
    git("checkout", "-q", "main")
    lab.reload()
    done = cherry_pick(lab, ["C3..e1"])
    assert [d.summary for d in done] == ["first lens 125 mm", "second lens 150 mm", "tilt of p2, lens pair 125/150"]
    assert lab.state.digest() == lab.state_at("e1").digest()
    git("checkout", "-q", "-B", "again", "C3")
    edit(lab, git, "p1", "angle: 90", "angle: 7", commit="other")
    found = refused(lab, lambda: cherry_pick(lab, ["C3..e1"]))
    for words in ("p1.angle", "from 90 to 1", '"other" made it 7'):
        assert words in said(found), words


def test_what_can_not_stand_is_refused_with_the_pair(lab: LabFolder, git: Git) -> None:
    git("checkout", "-q", "main")
    edit(lab, git, "p1", "x: 290", "x: 400", commit="into the way of the lens")
    found = refused(lab, lambda: cherry_pick(lab, ["E1-1"]))
    assert found.exit_code == ExitCode.IMPOSSIBLE
    assert {"p1", "lx_125"} <= set(re.findall(r"\w+", found.diagnostics[0].summary))


def test_a_merge_that_made_the_state_impossible_can_be_taken_back(lab: LabFolder, git: Git) -> None:
    before = lab.state.digest()
    git("checkout", "-q", "-b", "right", "main")
    edit(lab, git, "p1", "x: 290", "x: 400", commit="p1 further right")
    git("checkout", "-q", "e1")
    git("merge", "-q", "--no-edit", "right")
    lab.reload()
    assert "--mainline 1" in said(refused(lab, lambda: revert(lab, "HEAD")))
    assert "no side 3" in said(refused(lab, lambda: revert(lab, "HEAD", mainline=3)))
    assert changed(revert(lab, "HEAD", mainline=1)) == [("p1", "pose")]
    assert lab.state.digest() == before
    assert "reversing\nchanges made to" in git("show", "-s", "--format=%B")
    assert merge(lab, "right").kind == "up-to-date"


def test_edits_that_are_not_committed_are_in_the_way_but_nothing_else_is(lab: LabFolder, git: Git) -> None:
    (lab.root / "notebook.txt").write_text("other work")
    git("add", "notebook.txt")
    edit(lab, git, "p2", "angle: 90", "angle: 45")
    assert refused(lab, lambda: revert(lab, "HEAD")).diagnostics[0].code == "edited"
    git("checkout", "-q", "state")
    lab.reload()
    revert(lab, "HEAD")
    assert git("status", "--porcelain") == "A  notebook.txt\n"


def test_what_git_has_begun_is_ended_first(lab: LabFolder, git: Git) -> None:
    git("checkout", "-q", "-b", "right", "main")
    edit(lab, git, "p1", "y: 420", "y: 421", commit="right")
    git("checkout", "-q", "e1")
    edit(lab, git, "p2", "angle: 90", "angle: 45")
    shelf = Stash(lab)
    shelf.push()
    git("merge", "-q", "--no-commit", "--no-ff", "right")
    lab.reload()
    assert "a merge is under way" in said(refused(lab, lambda: cherry_pick(lab, ["E2-1"])))
    for way in (shelf.push, shelf.pop, lambda: merge(lab, "main")):
        found = refused(lab, way)
        assert "a merge is under way" in said(found) and found.diagnostics[0].code == "git-merging"
    git("commit", "-q", "-m", "m")
    assert "y: 421" in git("show", "HEAD:state/table.yaml")


def test_what_was_edited_meanwhile_is_not_overwritten(lab: LabFolder, git: Git) -> None:
    found = select_parts(lab, "C3", ["p2"])
    edit(lab, git, "p1", "angle: 1", "angle: 7")
    assert "edited meanwhile" in said(refused(lab, lambda: found.write(lab)))


def test_written_and_not_committed_where_that_is_asked(lab: LabFolder, git: Git) -> None:
    done = revert(lab, "HEAD", commit=False)
    assert done.commit is None and done.files == ("state/table.yaml",) and changed(done)
    assert git("status", "--porcelain") == " M state/table.yaml\n" and angle(lab, "p1") == 90


def test_a_hook_that_refuses_leaves_the_files_as_they_were(lab: LabFolder, git: Git) -> None:
    hook = lab.root / ".git" / "hooks" / "commit-msg"
    hook.parent.mkdir(exist_ok=True)
    hook.write_text("#!/bin/sh\necho not today\nexit 1\n")
    hook.chmod(0o755)
    assert "not today" in said(refused(lab, lambda: revert(lab, "HEAD")))
    assert not git("status", "--porcelain", "-uno")


def test_a_hook_that_refuses_the_second_refuses_all_and_names_it(lab: LabFolder, git: Git) -> None:
    git("checkout", "-q", "main")
    lab.reload()
    hook = lab.root / ".git" / "hooks" / "commit-msg"
    hook.parent.mkdir(exist_ok=True)
    hook.write_text('#!/bin/sh\n! grep -q second "$1"\n')
    hook.chmod(0o755)
    with pytest.raises(PicoError) as caught:
        cherry_pick(lab, ["E1-1", "E1-2"])
    assert "git did not commit E1-2" in said(caught.value)
    assert git("rev-parse", "HEAD") == git("rev-parse", "main") and not git("status", "--porcelain")
    assert not (lab.root / ".git" / "index.lock").exists()


def test_what_stands_in_the_way_may_have_been_picked_just_before(lab: LabFolder, git: Git) -> None:
    git("checkout", "-q", "-b", "side", "main")
    edit(lab, git, "p1", "angle: 90", "angle: 7", commit="seven")
    git("checkout", "-q", "main")
    lab.reload()
    found = refused(lab, lambda: cherry_pick(lab, ["side", "E1-3"]))
    assert "but here what was carried before it made it 7" in said(found)


def test_a_lab_that_was_elsewhere_then_is_told(lab: LabFolder, git: Git) -> None:
    (lab.root / "other").mkdir()
    for name in ("lab.yaml", "state"):
        git("mv", name, f"other/{name}")
    git("commit", "-q", "-m", "moved")
    inner = LabFolder(lab.root / "other")
    for name, words in (("HEAD", "is the first commit of this lab"), ("E1-3", "E1-3 has no lab in other")):
        with pytest.raises(PicoError) as caught:
            revert(inner, name)
        assert words in said(caught.value)


def test_the_first_commit_can_not_be_taken_back(lab: LabFolder) -> None:
    assert "C1 is the first commit" in said(refused(lab, lambda: revert(lab, "C1")))


def test_a_component_in_a_file_of_its_own_comes_and_goes_with_the_file(lab: LabFolder, git: Git) -> None:
    extra = lab.root / "state" / "extra.yaml"
    table = lab.root / "state" / "table.yaml"
    head, name, tail = table.read_text().partition("  hwp:\n")
    part, _, rest = tail.partition("  laser:\n")
    table.write_text(head + "  laser:\n" + rest)
    extra.write_text(f"apiVersion: pico/v1\nkind: LabState\nmetadata: {{lab: shel}}\ncomponents:\n{name}{part}")
    git("add", "-A")
    git("commit", "-q", "-m", "split")
    lab.reload()
    assert revert(lab, "HEAD").files == ("state/extra.yaml", "state/table.yaml")
    assert not extra.exists() and "  hwp:\n" in table.read_text() and not git("status", "--porcelain")


def test_only_the_lab_in_its_folder_changes(lab: LabFolder, git: Git) -> None:
    (lab.root / "other").mkdir()
    for name in ("lab.yaml", "state"):
        git("mv", name, f"other/{name}")
    (lab.root / "second.yaml").write_text("1\n")
    git("add", "-A")
    git("commit", "-q", "-m", "moved")
    inner = LabFolder(lab.root / "other")
    edit(inner, git, "p2", "angle: 90", "angle: 45")
    (lab.root / "second.yaml").write_text("2\n")
    git("commit", "-q", "-a", "-m", "both")
    assert changed(revert(inner, "HEAD")) == [("p2", "angle")]
    assert (lab.root / "second.yaml").read_text() == "2\n"


def test_a_first_commit_can_be_picked(lab: LabFolder, git: Git) -> None:
    git("checkout", "-q", "--orphan", "anew")
    git("commit", "-q", "-m", "anew")
    git("checkout", "-q", "e1")
    assert cherry_pick(lab, ["anew"])[0].commit is None
    edit(lab, git, "p1", "angle: 1", "angle: 7", commit="finer")
    assert "p1.angle" in said(refused(lab, lambda: cherry_pick(lab, ["anew"])))


def test_the_last_change_of_a_value_is_found_across_branches(lab: LabFolder, git: Git) -> None:
    handle, history = opened(lab.root), lab.history()
    leaf = ("0", "components", "p1", "angle")
    edit(lab, git, "p2", "angle: 90", "angle: 45", commit="another one")
    assert last_change(handle, history.resolve("HEAD").id, "state/table.yaml", leaf) == history.resolve("E1-3").id
    first = last_change(handle, history.resolve("C3").id, "state/table.yaml", leaf)
    assert first == history.resolve("C1").id

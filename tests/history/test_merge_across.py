"""Merges in which parts change files: a part is its name, wherever it stands."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from giving import Git
from moving_cases import LAB, Files, mistakes, moved_case

from pico.bench.bench import Bench
from pico.bench.checking import check
from pico.diagnostics import PicoError
from pico.history.lab.folder import LabFolder
from pico.history.merge.checked import merge
from pico.history.merge.markers import Labels
from pico.history.merge.trees import contents, opened, unite_trees
from pico.history.repository.repository import Repository
from pico.history.restoring.stash import Stash
from pico.history.restoring.transplant import cherry_pick, revert
from pico.manifest.folders import check_folder

TABLE, OTHER, THIRD = "state/table.yaml", "state/other.yaml", "state/third.yaml"
HEAD = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents:\n"
Edit = Callable[[Path], None]


@pytest.fixture
def branches(lab: Path, git: Git) -> Callable[[Edit, Edit], LabFolder]:
    """Return a function that commits edits on two branches, `ours` (checked out) and `theirs`."""

    def make(ours: Edit, theirs: Edit) -> LabFolder:
        for branch, edit in (("theirs", theirs), ("ours", ours)):
            git("checkout", "-q", "-b", branch, "main")
            edit(lab)
            git("add", "-A")
            git("commit", "-q", "-m", branch)
        return LabFolder(lab)

    return make


Branches = Callable[[Edit, Edit], LabFolder]


def entry(root: Path, name: str, path: str = TABLE) -> tuple[str, str]:
    """Return a manifest without a component, and the lines of that."""
    before, _, rest = (root / path).read_text().partition(f"  {name}:\n")
    lines = rest.splitlines(keepends=True)
    end = next((i for i, line in enumerate(lines) if not line.startswith("    ")), len(lines))
    return before + "".join(lines[end:]), f"  {name}:\n" + "".join(lines[:end])


def taken_out(name: str) -> Edit:
    def edit(root: Path) -> None:
        (root / TABLE).write_text(entry(root, name)[0])

    return edit


def moved(name: str, path: str = OTHER, before: str = "", after: str = "") -> Edit:
    def edit(root: Path) -> None:
        left, lines = entry(root, name)
        (root / TABLE).write_text(left)
        (root / path).write_text(HEAD + lines.replace(before, after, 1))

    return edit


def changed(name: str, before: str, after: str) -> Edit:
    def edit(root: Path) -> None:
        lines = entry(root, name)[1]
        assert before in lines
        (root / TABLE).write_text((root / TABLE).read_text().replace(lines, lines.replace(before, after, 1)))

    return edit


def renamed(root: Path) -> None:
    (root / TABLE).rename(root / OTHER)


def refused(folder: LabFolder) -> PicoError:
    before = folder.history().resolve("HEAD").id
    with pytest.raises(PicoError) as caught:
        merge(folder, "theirs")
    assert folder.history().resolve("HEAD").id == before and not folder.history().changed(folder.root)
    return caught.value


@pytest.mark.parametrize("swapped", [False, True])
def test_a_part_moved_on_one_side_and_changed_on_the_other_is_there_once_with_the_new_value(
    branches: Branches, swapped: bool
) -> None:
    sides = (moved("p1"), changed("p1", "angle: 90", "angle: 80  # by hand"))
    folder = branches(*(sides[::-1] if swapped else sides))
    merge(folder, "theirs")
    assert folder.state.components["p1"].values["angle"] == 80
    assert "angle: 80  # by hand" in (folder.root / OTHER).read_text()
    assert "p1:" not in (folder.root / TABLE).read_text()


@pytest.mark.parametrize("swapped", [False, True])
def test_a_part_taken_out_here_and_moved_there_is_a_conflict_that_names_both_files(
    branches: Branches, swapped: bool
) -> None:
    sides = (moved("p1"), taken_out("p1"))
    found = refused(branches(*(sides[::-1] if swapped else sides))).diagnostics
    assert [d.address for d in found] == ["p1"]
    for word in ("taken out", f"moved to {OTHER}"):
        assert word in found[0].summary
    assert TABLE in (found[0].detail or "") and "git merge --no-commit theirs" in (found[0].hint or "")


def test_a_part_that_each_side_moved_elsewhere_is_a_conflict(branches: Branches) -> None:
    found = refused(branches(moved("p1"), moved("p1", THIRD))).diagnostics
    assert [d.address for d in found] == ["p1"] and OTHER in found[0].summary and THIRD in found[0].summary


def test_a_renamed_file_takes_along_what_the_other_side_did_to_it(branches: Branches) -> None:
    def more(root: Path) -> None:
        taken_out("lx_100")(root)
        changed("p1", "angle: 90", "angle: 80")(root)
        text = (root / TABLE).read_text()
        (root / TABLE).write_text(f"# measured twice\n{text}")

    folder = branches(renamed, more)
    merge(folder, "theirs")
    assert not (folder.root / TABLE).exists() and (folder.root / OTHER).read_text().startswith("# measured twice\n")
    assert folder.state.components["p1"].values["angle"] == 80 and "lx_100" not in folder.state.components


def test_the_parts_of_another_lab_have_names_of_their_own(tmp_path: Path) -> None:
    repository = Repository.init(tmp_path)
    part = HEAD + "  p1:\n    slot: storage/a1\n  p2:\n    slot: storage/a2\n"
    base = {f"{name}/lab.yaml": LAB for name in "ab"} | {"a/table.yaml": part}
    ours = base | {"b/table.yaml": part}
    theirs = base | {"a/table.yaml": part.replace("  p1:\n    slot: storage/a1\n", "")}
    united = unite(repository, *(tree_of(repository.handle, files) for files in (base, ours, theirs)))
    assert united and united["b/table.yaml"] == part and "p1" not in united["a/table.yaml"]


def test_revert_cherry_pick_and_stash_follow_a_part_into_its_file_and_refuse_one_that_was_taken_out(
    branches: Branches, git: Git
) -> None:
    folder = branches(moved("p1"), changed("p1", "angle: 90", "angle: 80"))
    nothing = lambda *_: ()  # noqa: E731
    (picked,) = cherry_pick(folder, ["theirs"], nothing)
    assert picked.files == (OTHER,) and folder.state.components["p1"].values["angle"] == 80
    revert(folder, "HEAD", nothing)
    assert folder.state.components["p1"].values["angle"] == 90
    git("checkout", "-q", "-b", "out", "main")
    taken_out("p1")(folder.root)
    git("commit", "-qam", "out")
    folder.reload()
    with pytest.raises(PicoError) as caught:
        cherry_pick(folder, ["ours~2"], nothing)
    assert caught.value.diagnostics[0].address == "p1" and OTHER in caught.value.diagnostics[0].summary
    git("checkout", "-q", "main")
    moved("p1")(folder.root)
    git("stash", "-q", "-u")
    git("checkout", "-q", "out")
    folder.reload()
    with pytest.raises(PicoError) as caught:
        Stash(folder).pop()
    assert caught.value.diagnostics[0].address == "p1"


def test_plan_and_check_tell_of_a_part_that_gits_merge_kept_until_somebody_has_looked(
    branches: Branches, git: Git
) -> None:
    folder = branches(taken_out("p1"), moved("p1"))
    git("merge", "-q", "-m", "merge", "theirs")
    told = planned(folder.root)
    assert [d.address for d in told] == ["p1"] and OTHER in told[0].summary
    merge_commit, took = git("rev-parse", "HEAD").strip(), git("rev-parse", "HEAD^1").strip()
    assert f"{took[:7]} took it out" in told[0].summary and f"git's merge {merge_commit[:7]} kept it" in told[0].summary
    assert "git commit --allow-empty" in str(told[0].hint)
    assert "p1" in str(check(folder.root, None, environment={}).labs[0].diagnostics)
    assert [d.address for d in planned(folder.root, "ours")] == ["p1"]
    assert not planned(folder.root, targets=["p2"])
    left = entry(folder.root, "p1", OTHER)[0]
    (folder.root / OTHER).write_text(left)
    assert not planned(folder.root)
    git("checkout", "-q", ".")
    git("branch", "again")
    git("commit", "-q", "--allow-empty", "-m", "p1 stays")
    assert not planned(folder.root) and not planned(folder.root, "again")


def test_plan_tells_while_a_merge_is_under_way_and_not_once_pico_has_ended_it(branches: Branches, git: Git) -> None:
    folder = branches(moved("p1"), taken_out("p1"))
    git("merge", "-q", "--no-commit", "theirs")
    (told,) = planned(folder.root)
    assert told.summary.endswith("and git's merge kept it")
    moved_it = git("rev-parse", "HEAD").strip()
    assert told.address == "p1" and f"{moved_it[:7]} moved it to {OTHER}" in told.summary
    assert "`pico commit`, which ends the merge" in str(told.hint)
    with Bench.open(folder.root) as bench:
        bench.commit("p1 stays", "planned")
    assert len(git("show", "-s", "--format=%P").split()) == 2 and not planned(folder.root)


def test_validate_tells_of_a_part_that_gits_merge_left_in_two_files(branches: Branches, git: Git) -> None:
    folder = branches(moved("p1"), moved("p1", THIRD))
    git("merge", "-q", "-m", "merge", "theirs")
    assert any("p1 is in two files" in d.summary for d in check_folder(folder.root).diagnostics)


def test_what_git_kept_is_told_beside_a_part_in_two_files_and_after_that_is_mended(
    branches: Branches, git: Git
) -> None:
    def also(edit: Edit, path: str) -> Edit:
        def both(root: Path) -> None:
            edit(root)
            moved("p2", path)(root)

        return both

    folder = branches(also(moved("p1"), THIRD), also(taken_out("p1"), "state/fourth.yaml"))
    git("merge", "-q", "-m", "merge", "theirs")
    said = [d.summary for d in check(folder.root, None, environment={}).labs[0].diagnostics]
    assert any("p2 is in two files" in s for s in said) and any("took it out" in s for s in said)
    (folder.root / THIRD).unlink()
    assert [d.address for d in planned(folder.root)] == ["p1"]


def planned(root: Path, revision: str | None = None, targets: list[str] | None = None) -> list:
    """Return what keeps a bench from being planned for."""
    with Bench.open(root) as bench:
        try:
            bench.plan(revision, targets=targets or ())
        except PicoError as exc:
            return list(exc.diagnostics)
    return []


@pytest.mark.parametrize("cases", [15, pytest.param(40, marks=pytest.mark.slow)])
def test_random_moves_between_files_are_united_or_told(tmp_path: Path, cases: int) -> None:
    repository = Repository.init(tmp_path)
    handle = opened(tmp_path)
    united = 0
    for c in map(moved_case, range(cases)):
        base, ours, theirs = (tree_of(handle, files) for files in (c.base, c.ours, c.theirs))
        there, back = (unite(repository, base, a, b) for a, b in ((ours, theirs), (theirs, ours)))
        assert there == back
        if there is not None:
            assert mistakes(c, there) == []
            united += 1
        else:
            assert not c.free
    assert united > cases / 2


def unite(repository: Repository, base: str, ours: str, theirs: str) -> Files | None:
    union = unite_trees(repository.handle, base, ours, theirs, Labels())
    tree = repository.handle[union.tree] if union.tree else None
    return {p: data.decode() for p, data in contents(repository.handle, tree).items()} if tree else None


def tree_of(handle, files: Files) -> str:
    import pygit2

    index = pygit2.Index()
    for path, text in files.items():
        index.add(pygit2.IndexEntry(path, handle.create_blob(text.encode()), pygit2.enums.FileMode.BLOB))
    return str(index.write_tree(handle))

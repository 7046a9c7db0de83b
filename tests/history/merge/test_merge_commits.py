"""Merging a branch: what both sides did, checked before anything is written, committed by git."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from giving import Git

from pico.diagnostics import ExitCode, PicoError
from pico.history.lab.folder import LabFolder
from pico.history.merge.checked import merge

Edit = tuple[str, str, str]
"""A component, and a line of it before and after."""


@pytest.fixture
def branches(lab: Path, git: Callable[..., str]) -> Callable[[list[Edit], list[Edit]], LabFolder]:
    """Return a function that commits edits on two branches, `ours` (checked out) and `theirs`."""

    def make(ours: list[Edit], theirs: list[Edit]) -> LabFolder:
        for branch, edits in (("theirs", theirs), ("ours", ours)):
            git("checkout", "-q", "-b", branch, "main")
            for edit in edits:
                change(lab, *edit)
            git("commit", "-q", "-a", "-m", branch)
        return LabFolder(lab)

    return make


def change(lab: Path, component: str, before: str, after: str) -> None:
    path = lab / "state" / "table.yaml"
    head, name, tail = path.read_text().partition(f"\n  {component}:\n")
    assert name and before in tail
    path.write_text(head + name + tail.replace(before, after, 1))


def refused(folder: LabFolder, revision: str = "theirs") -> PicoError:
    history = folder.history()
    before = (history.resolve("HEAD").id, (folder.root / "state" / "table.yaml").read_text())
    with pytest.raises(PicoError) as caught:
        merge(folder, revision)
    assert (history.resolve("HEAD").id, (folder.root / "state" / "table.yaml").read_text()) == before
    return caught.value


Branches = Callable[[list[Edit], list[Edit]], LabFolder]


def test_both_edits_are_in_one_commit_that_says_it_was_never_realized(branches: Branches, git: Git) -> None:
    folder = branches([("p1", "angle: 90", "angle: 80")], [("p2", "angle: 90", "angle: 45  # by hand")])
    made = merge(folder, "theirs", "both polarizers")
    assert [(c.component, c.tunable, c.after) for c in made.changes] == [("p2", "angle", 45)]
    components = folder.state.components
    assert (components["p1"].values["angle"], components["p2"].values["angle"]) == (80, 45)
    message = git("show", "-s", "--format=%B")
    assert message.startswith("both polarizers\n\nPico-State: sha256:") and "Pico-Evidence: planned" in message
    assert len(git("show", "-s", "--format=%P").split()) == 2 and not git("status", "--porcelain", "-uno")
    assert merge(folder, "theirs").kind == "up-to-date"


def test_what_is_only_ahead_is_gone_on_to(branches: Branches, git: Git) -> None:
    folder = branches([("p1", "angle: 90", "angle: 80")], [("p2", "angle: 90", "angle: 45")])
    git("checkout", "-q", "main")
    folder.reload()
    assert merge(folder, "ours").kind == "fast-forward"
    assert git("rev-parse", "HEAD") == git("rev-parse", "ours")


def test_the_same_tunable_is_refused_with_component_and_both_commits(branches: Branches) -> None:
    folder = branches([("p1", "angle: 90", "angle: 80")], [("p1", "angle: 90", "angle: 45")])
    found = refused(folder)
    assert found.exit_code == ExitCode.ERROR
    history = folder.history()
    for word in ("p1.angle", "80 (-10)", "45 (-45)", *(history.resolve(n).short for n in ("ours", "theirs"))):
        assert word in found.diagnostics[0].summary
    assert found.diagnostics[0].address == "p1.angle"


@pytest.mark.parametrize(
    ("ours", "theirs", "named"),
    [
        (("p1", "x: 290", "x: 400"), ("p2", "x: 520", "x: 430"), {"p1", "p2"}),
        (("p1", "x: 290", "x: 1000"), ("cam", "x: 1060", "x: 1060  # fixed"), {"p1", "cam"}),
    ],
)
def test_what_can_not_stand_is_refused_with_the_pair(
    branches: Branches, ours: Edit, theirs: Edit, named: set[str]
) -> None:
    found = refused(branches([ours], [theirs]))
    assert found.exit_code == ExitCode.IMPOSSIBLE
    assert named <= set(re.findall(r"\w+", found.diagnostics[0].summary))


def test_two_parts_in_one_slot_are_refused(branches: Branches) -> None:
    pose = "pose:\n      x: {}\n      y: 420\n      yaw: 0"
    parts = [[(name, pose.format(x), "slot: storage/c1")] for name, x in (("p1", 290), ("p2", 520))]
    found = refused(branches(parts[0], parts[1]))
    said = " ".join(d.summary + d.detail for d in found.diagnostics)
    assert "p1" in said and "p2" in said and "storage/c1" in said


def test_edits_that_would_be_lost_are_refused(branches: Branches) -> None:
    folder = branches([("p1", "angle: 90", "angle: 80")], [("p2", "angle: 90", "angle: 45")])
    change(folder.root, "p1", "angle: 80", "angle: 81")
    assert refused(folder).diagnostics[0].code == "edited"


def test_edits_of_other_files_stand_in_the_way_only_where_the_merge_changes_them(branches: Branches, git: Git) -> None:
    folder = branches([("p1", "angle: 90", "angle: 80")], [("p2", "angle: 90", "angle: 45")])
    other = folder.root / "README.txt"
    other.write_text("ours\n")
    git("add", "README.txt")
    git("commit", "-qm", "a file of somebody else")
    other.write_text("edited\n")
    merge(folder, "theirs")
    assert other.read_text() == "edited\n" and git("status", "--porcelain").strip() == "M README.txt"
    git("checkout", "-q", "--force", "-b", "more", "HEAD~1")
    other.write_text("theirs\n")
    git("commit", "-qam", "more")
    git("checkout", "-q", "-")
    other.write_text("edited again\n")
    found = refused(folder, "more")
    assert (
        "README.txt" in found.diagnostics[0].summary + str(found.diagnostics[0].detail)
        and other.read_text() == "edited again\n"
    )


def test_a_hook_that_refuses_leaves_everything_as_it_was(branches: Branches, git: Git) -> None:
    folder = branches([("p1", "angle: 90", "angle: 80")], [("p2", "angle: 90", "angle: 45")])
    hook = folder.root / ".git" / "hooks" / "commit-msg"
    hook.parent.mkdir(exist_ok=True)
    hook.write_text("#!/bin/sh\necho not today\nexit 1\n")
    hook.chmod(0o755)
    assert "not today" in refused(folder).diagnostics[0].detail
    assert not git("status", "--porcelain", "-uno") and not (folder.root / ".git" / "MERGE_HEAD").exists()


def test_a_part_moved_to_another_file_here_and_set_there_is_not_lost(branches: Branches, git: Git) -> None:
    folder = branches([("p1", "angle: 90", "angle: 80")], [("p2", "angle: 90", "angle: 45")])
    git("mv", "state/table.yaml", "state/beam.yaml")
    git("commit", "-q", "-m", "another name")
    folder.reload()
    assert merge(folder, "theirs").kind == "merged"
    assert {n: folder.state.components[n].values["angle"] for n in ("p1", "p2")} == {"p1": 80, "p2": 45}

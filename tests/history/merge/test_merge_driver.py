"""The merge driver under git's own commands, and what is left where it is missing, fails or is killed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from pico.history.git.attributes import GITATTRIBUTES, checkup, install, uninstall, wire, wiring
from pico.history.git.merge_fallback import merge_lines
from pico.history.merge.driver import CLEAN, CONFLICT, drive
from pico.history.merge.groups import groups_near, groups_of

BASE = """apiVersion: pico/v1
kind: LabState
metadata: {lab: bench}
components:
  m1:
    pose:
      x: 10
      y: 20
      yaw: 0
    tip: 1.0  # mrad
    tilt: 2
"""
OURS, THEIRS = BASE.replace("tip: 1.0", "tip: 1.5"), BASE.replace("tilt: 2", "tilt: 3  # by hand")
BOTH = OURS.replace("tilt: 2", "tilt: 3  # by hand")
CLASH = BASE.replace("tip: 1.0", "tip: 0.5")


class Sandbox:
    """A repository with BASE on main (tag `base`), OURS on top, THEIRS on branch `side`, CLASH on branch `clash`."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.file = folder, folder / "table.yaml"
        self.git("init", "-q", "-b", "main")
        (folder / ".gitattributes").write_text(GITATTRIBUTES)
        self.commit(BASE)
        self.git("tag", "base")
        for branch, text in (("side", THEIRS), ("clash", CLASH)):
            self.git("checkout", "-q", "-b", branch, "base")
            self.commit(text)
        self.git("checkout", "-q", "main")
        self.commit(OURS)

    def git(self, *arguments: str, code: int | None = 0) -> str:
        done = subprocess.run(["git", *arguments], cwd=self.folder, capture_output=True, text=True, check=False)
        assert code is None or done.returncode == code, done.stdout + done.stderr
        return done.stdout + done.stderr

    def commit(self, text: str) -> None:
        self.file.write_text(text)
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "edit")


@pytest.fixture
def sandbox(tmp_path: Path) -> Sandbox:
    (tmp_path / "repo").mkdir()
    made = Sandbox(tmp_path / "repo")
    assert wire(made.folder)
    return made


@pytest.mark.parametrize(
    "commands",
    [
        ["merge -q --no-edit side"],
        ["rebase -q side"],
        ["cherry-pick side"],
        ["checkout -q side", "stash -q", "cherry-pick main"],
    ],
)
def test_different_tunables_unite_under_every_command(sandbox: Sandbox, commands: list[str]) -> None:
    for command in commands:
        sandbox.git(*command.split())
    assert sandbox.file.read_text() == BOTH
    assert not list(sandbox.folder.glob("*.pico"))


def test_stash_pop_and_revert_unite_too(sandbox: Sandbox) -> None:
    sandbox.git("checkout", "-q", "side")
    sandbox.file.write_text(THEIRS.replace("y: 20", "y: 25"))
    sandbox.git("stash", "-q")
    sandbox.commit(THEIRS.replace("x: 10", "x: 11"))
    sandbox.git("stash", "pop", "-q")
    assert sandbox.file.read_text() == THEIRS.replace("x: 10", "x: 11").replace("y: 20", "y: 25")
    sandbox.commit(sandbox.file.read_text())
    sandbox.git("revert", "--no-edit", "HEAD~2")
    assert yaml.safe_load(sandbox.file.read_text())["components"]["m1"] == {
        "pose": {"x": 11, "y": 25, "yaw": 0}, "tip": 1.0, "tilt": 2
    }  # fmt: skip


def test_the_same_tunable_conflicts_and_git_says_what_each_side_did(sandbox: Sandbox) -> None:
    said = sandbox.git("merge", "clash", code=1)
    assert "pico: table.yaml: m1.tip: base 1 | ours 1.5 (+0.5) | theirs 0.5 (-0.5)" in said
    assert "`git merge --abort` takes it back; then `pico merge clash`" in said
    assert sandbox.file.read_text().count("<<<<<<< ours: m1.tip 1.5 (+0.5)\n") == 1
    assert sandbox.git("ls-files", "-u").count("table.yaml") == 3


def _fail(sandbox: Sandbox, how: str) -> None:
    known = sandbox.git("config", "merge.pico.driver").strip()
    python = known.split(" ", 1)[0]
    if how == "never set":
        sandbox.git("config", "--remove-section", "merge.pico")
        return
    stand_in = sandbox.folder.parent / "stand-in"
    scripts = {
        "killed": "kill -9 $$", "killed while it writes": "echo half > $5; kill -9 $$",
        "another program": "exit 0", "an error": "exit 1",
    }  # fmt: skip
    if how in scripts:
        stand_in.write_text(f"#!/bin/sh\n{scripts[how]}\n")
        stand_in.chmod(0o755)
    sandbox.git("config", "merge.pico.driver", known.replace(python, str(stand_in)))


@pytest.mark.parametrize(
    "how", ["never set", "missing", "killed", "killed while it writes", "another program", "an error"]
)
def test_whatever_becomes_of_the_driver_both_sides_are_in_the_file(sandbox: Sandbox, how: str) -> None:
    _fail(sandbox, how)
    sandbox.git("merge", "clash", code=1)
    text = sandbox.file.read_text()
    assert "<<<<<<<" in text and ">>>>>>>" in text and "tip: 1.5" in text and "tip: 0.5" in text
    assert not list(sandbox.folder.glob(".merge_file*"))


def test_without_python_an_edit_never_ends_up_in_a_part_that_the_other_side_put_beside_it(sandbox: Sandbox) -> None:
    """Lines alone look alike: git would give the edited yaw of m1 to m2, without a word."""
    _fail(sandbox, "missing")
    sandbox.git("checkout", "-q", "-B", "ours", "base")
    first, rest = BASE.split("    tip")
    moved = first.replace("y: 20", "y: 25")
    sandbox.commit(f"{moved}  m2:\n    pose:\n      x: 1800\n      y: 20\n      yaw: 0\n    tip{rest}")
    sandbox.git("checkout", "-q", "-B", "theirs", "base")
    sandbox.commit(BASE.replace("yaw: 0", "yaw: 53"))
    sandbox.git("merge", "-q", "--no-edit", "ours", code=None)
    text = sandbox.file.read_text()
    if "<<<<<<<" not in text:
        parts = yaml.safe_load(text)["components"]
        assert (parts["m1"]["pose"]["yaw"], parts["m2"]["pose"]["yaw"]) == (53, 0)
    assert "53" in text and "\037" not in text


@pytest.mark.parametrize("text", [b"", b"no newline", b"a\r\nb\r\n", "# µ 45° \x1f\n  x:\n".encode(), b"\xff\xfe\0\n"])
def test_the_merge_of_lines_leaves_alone_what_nobody_changed(tmp_path: Path, text: bytes) -> None:
    text = b"apiVersion: pico/v1\n" + text
    for name in ("A", "O", "B"):
        (tmp_path / name).write_bytes(text)
    command = merge_lines().replace("%L", "7")
    for name in ("A", "O", "B"):
        command = command.replace(f"%{name}", name)
    done = subprocess.run(["sh", "-c", command], cwd=tmp_path, capture_output=True, check=False)
    assert (tmp_path / "A").read_bytes() == text and sorted(p.name for p in tmp_path.iterdir()) == ["A", "B", "O"]
    assert done.returncode == 0 or b"\0" in text


def test_nothing_of_the_repository_is_run_as_the_driver(sandbox: Sandbox) -> None:
    (sandbox.folder / "pico").mkdir()
    (sandbox.folder / "pico" / "__init__.py").write_text("raise SystemExit(40)")
    (sandbox.folder / "yaml.py").write_text("raise SystemExit(40)")
    sandbox.git("merge", "-q", "--no-edit", "side")
    assert sandbox.file.read_text() == BOTH


def test_it_is_set_once_refused_where_taken_out_and_set_again_when_asked(sandbox: Sandbox) -> None:
    assert not wire(sandbox.folder) and checkup(sandbox.folder) == ()
    uninstall(sandbox.folder)
    assert "merge.pico" not in sandbox.git("config", "--list", "--local")
    assert not wire(sandbox.folder) and [d.code for d in checkup(sandbox.folder)] == ["git-driver"]
    install(sandbox.folder)
    found = wiring(sandbox.folder)
    assert found and found.current and not found.refused


def test_only_where_the_attributes_ask_for_it(tmp_path: Path) -> None:
    assert wiring(tmp_path) is None and not wire(tmp_path)
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    assert not wire(tmp_path)
    assert [d.code for d in checkup(tmp_path)] == ["git-attributes", "git-driver"]


def test_a_worktree_shares_the_configuration(sandbox: Sandbox) -> None:
    sandbox.git("worktree", "add", "-q", "../other", "side")
    found = wiring(sandbox.folder.parent / "other")
    assert found and found.current and found.attributed


LAB = b"apiVersion: pico/v1\nkind: Lab\nmetadata: {name: bench}\ninventory:\n  m1: {type: mirror_tip_tilt, home: a}\n"


def test_groups_come_from_the_catalog_and_from_the_labs_own_types(tmp_path: Path) -> None:
    own = b"apiVersion: pico/v1\nkind: ComponentType\nmetadata: {name: own}\ncoupled: [[a, b], [c, d]]\n"
    lab = LAB + b"  o: {type: own, home: b}\npolicy: {merge: strict}\n"
    assert groups_of([("lab.yaml", lab), ("types/own.yaml", own)]) == (
        {"m1": (("tip", "tilt"),), "o": (("a", "b"), ("c", "d"))}, True
    )  # fmt: skip
    (tmp_path / "lab.yaml").write_bytes(LAB)
    assert groups_near(tmp_path / "state" / "table.yaml") == ({"m1": (("tip", "tilt"),)}, False)
    assert groups_near(Path("/nowhere/table.yaml")) == ({}, False)


@pytest.mark.parametrize(("policy", "code"), [(b"", CLEAN), (b"policy: {merge: strict}\n", CONFLICT)])
def test_a_steering_pair_split_by_a_merge_warns_or_conflicts(tmp_path: Path, policy: bytes, code: int) -> None:
    (tmp_path / "lab.yaml").write_bytes(LAB + policy)
    for name, text in (("base", BASE), ("ours", OURS), ("theirs", THEIRS)):
        (tmp_path / name).write_text(text)
    files = [str(tmp_path / name) for name in ("ours", "out", "base", "theirs")]
    done, said = drive([*files, "7", str(tmp_path / "table.yaml"), "%S", "%X", "%Y"])
    assert done == code
    assert ("they belong together" in said) == (code == CLEAN)


def test_the_driver_loads_nothing_heavy() -> None:
    program = "import sys, pico.history.merge.driver; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, env=os.environ)
    assert not {"pygit2", "numpy", "typer", "rich", "pint"} & set(done.stdout.split())


def test_branches_that_merged_each_other_before_merge_again(sandbox: Sandbox) -> None:
    sandbox.git("checkout", "-q", "-b", "other", "side")
    sandbox.git("merge", "-q", "--no-edit", "clash")
    sandbox.git("checkout", "-q", "-b", "crossed", "clash")
    sandbox.git("merge", "-q", "--no-edit", "side")
    sandbox.commit(sandbox.file.read_text().replace("x: 10", "x: 11"))
    sandbox.git("checkout", "-q", "other")
    sandbox.commit(sandbox.file.read_text().replace("yaw: 0", "yaw: 9"))
    sandbox.git("merge", "-q", "--no-edit", "crossed")
    text = sandbox.file.read_text()
    assert all(line in text for line in ("x: 11", "yaw: 9", "tip: 0.5", "tilt: 3  # by hand"))

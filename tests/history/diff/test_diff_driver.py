"""`git diff`, `git show` and `git log -p` of manifests: what moved is said first, and nothing is taken away."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pico.history.diff.driver import FAILED, drive
from pico.history.diff.manifests import diff_files
from pico.history.git.attributes import GITATTRIBUTES, checkup, install, uninstall, wire, wiring
from pico.history.git.diff_wrapper import ALONE, SUMMARY

LAB = """apiVersion: pico/v1
kind: Lab
metadata: {name: bench}
inventory:
  m1: {type: mirror_tip_tilt, home: storage/a1}
  p2: {type: linear_polarizer, home: storage/a2}
"""
STATE = """# what stands where
apiVersion: pico/v1
kind: LabState
metadata: {lab: bench}
components:
  m1:
    pose:
      x: 100
      y: 20
      yaw: 45
    tip: 1.0  # mrad
  p2:
    slot: storage/a2
    angle: 90
"""
MOVED = STATE.replace("x: 100", "x: 112.5").replace("angle: 90", "angle: 1")
ACTION = "on: push\njobs:\n  test: {runs-on: linux}\n  lint: {runs-on: linux}\n"
SAID = """\
state/table.yaml: 2 tunables of 2 components
  ~ m1        moved 12.5 mm (dx +12.5)
  ~ p2.angle  90 → 1 deg
"""

NEW = """\
state/new.yaml: 4 tunables of 2 components
  + m7        added: at (100, 20, 45°)
  ~ m7.tip    set to 1
  + p7        added: in storage/a2
  ~ p7.angle  set to 90
"""


class Lab:
    """A repository with a lab (tag `base`), PICO wired in; `edit` changes its files in the working tree."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        (folder / "state").mkdir(parents=True)
        self.git("init", "-q", "-b", "main")
        self.write("lab.yaml", LAB)
        self.write("state/table.yaml", STATE)
        self.write("ci.yaml", ACTION)
        self.write(".gitattributes", GITATTRIBUTES)
        self.commit("base")
        self.git("tag", "base")
        assert wire(folder)

    def git(self, *arguments: str, code: int | None = 0, env: dict[str, str] | None = None, stdin: str = "") -> str:
        done = subprocess.run(
            ["git", *arguments], cwd=self.folder, env=os.environ | (env or {}), input=stdin, capture_output=True,
            text=True, check=False,
        )  # fmt: skip
        assert code is None or done.returncode == code, done.stdout + done.stderr
        return done.stdout

    def write(self, path: str, text: str) -> None:
        (self.folder / path).write_bytes(text.encode())

    def commit(self, message: str) -> None:
        self.git("add", "-A")
        self.git("commit", "-q", "-m", message)

    def ordinary(self, *arguments: str) -> str:
        return self.git("diff", "--no-ext-diff", "--no-textconv", *arguments)

    def without_summary(self, *arguments: str) -> str:
        """Return `git diff` from the first line on that git itself would print."""
        said = self.git("diff", *arguments)
        return said[said.index("diff --git") :] if "diff --git" in said else said


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    return Lab(tmp_path / "repo")


def test_what_moved_is_said_before_the_lines(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    assert lab.git("diff") == f"{SAID}\n{lab.ordinary()}"
    lab.commit("moved")
    for command in (["diff", "base", "HEAD"], ["show", "--ext-diff", "--format="], ["log", "-1", "-p", "--ext-diff"]):
        assert SAID in lab.git(*command)
    assert "~ m1        moved 12.5 mm (dx -12.5)" in lab.git("diff", "-R", "base", "HEAD")


def test_the_redirected_diff_is_a_patch_that_applies(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    lab.write("lab.yaml", LAB.replace("a1", "a3"))
    patch = lab.git("diff")
    lab.git("checkout", "-q", ".")
    lab.git("apply", stdin=patch)
    assert (lab.folder / "state/table.yaml").read_text() == MOVED


def test_show_and_log_spell_out_the_address_of_each_line(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    lab.commit("moved")
    for command in (["show"], ["log", "-1", "-p"]):
        lines = lab.git(*command).splitlines()
        changed = [line for line in lines if line.startswith(("+", "-")) and line[:3] not in ("+++", "---")]
        assert changed == ["-m1.pose.x: 100", "+m1.pose.x: 112.5", "-p2.angle: 90", "+p2.angle: 1"]


def test_blame_names_the_same_lines_as_ever(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    lab.commit("moved")
    blamed = [line.split(")")[0].split()[0] for line in lab.git("blame", "-s", "state/table.yaml").splitlines()]
    first = blamed[0]
    assert [i for i, commit in enumerate(blamed) if commit != first] == [7, 13]


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["-U0"],
        ["-w"],
        ["--word-diff"],
        ["--color=always"],
        ["--full-index"],
        ["--no-prefix"],
        ["HEAD"],
        ["--", "."],
    ],
)
def test_other_yaml_shows_its_ordinary_diff_byte_for_byte(lab: Lab, options: list[str]) -> None:
    lab.write("ci.yaml", ACTION.replace("  test: {", "  test:   {").replace("lint", "format"))
    assert lab.git("diff", *options) == lab.ordinary(*options) != ""


@pytest.mark.parametrize("content", [b"\0\1\2", b"a: \xff\n", b"a: 1", b"", b"a: 1\r\n", b"- [" * 50_000])
def test_odd_files_show_their_ordinary_diff(lab: Lab, content: bytes) -> None:
    for path in ("ci.yaml", "state/table.yaml"):
        (lab.folder / path).write_bytes(content)
    said, ordinary = (
        subprocess.run(["git", "diff", *options], cwd=lab.folder, capture_output=True, check=True).stdout
        for options in ([], ["--no-ext-diff", "--no-textconv"])
    )
    assert ordinary and _lines_of_git(said.decode(errors="replace")) == ordinary.decode(errors="replace")


@pytest.mark.slow
def test_every_kind_of_change_looks_as_git_shows_it(lab: Lab) -> None:
    git, folder = lab.git, lab.folder
    git("mv", "state/table.yaml", "state/other name.yaml")
    lab.write("state/other name.yaml", MOVED)
    (folder / "ci.yaml").chmod(0o755)
    lab.write("new ä.yaml", ACTION)
    (folder / "lab.yaml").unlink()
    (folder / "lab.yaml").symlink_to("ci.yaml")
    git("add", "-A")
    for options in (["--cached"], ["--cached", "-M"], ["--cached", "-C", "--find-copies-harder"], ["-M", "HEAD"]):
        assert _lines_of_git(git("diff", *options)) == lab.ordinary(*options)
    assert "~ m1        moved 12.5 mm" in git("diff", "--cached", "-M")
    assert git("diff", "--cached", "--stat") == lab.ordinary("--cached", "--stat")
    assert git("diff", "--cached", "--exit-code", code=1)


def _lines_of_git(text: str) -> str:
    """Return a diff without its summaries: a headline, indented lines, an empty line before `diff --git`."""
    lines = text.splitlines(keepends=True)
    for at in [i for i, line in enumerate(lines) if line.startswith("diff --git")]:
        above = at - 1
        if above >= 0 and lines[above] == "\n":
            while above >= 0 and (lines[above] == "\n" or lines[above].startswith("  ") or "component" in lines[above]):
                lines[above] = ""
                above -= 1
            if above >= 0 and lines[above].endswith(("values\n", "text\n")):
                lines[above] = ""
    return "".join(lines)


def test_unmerged_files_and_new_labs(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    lab.commit("here")
    lab.git("checkout", "-q", "-b", "side", "base")
    lab.write("state/table.yaml", STATE.replace("x: 100", "x: 90"))
    lab.commit("there")
    lab.git("merge", "main", code=1)
    assert "* Unmerged path state/table.yaml" in lab.git("diff", "--cached")
    assert "++<<<<<<<" in lab.git("diff")
    lab.git("merge", "--abort")
    lab.write("state/new.yaml", STATE.replace("m1", "m7").replace("p2", "p7"))
    lab.git("add", "-N", "state/new.yaml")
    assert lab.git("diff").startswith(NEW)


def test_every_other_command_of_git_does_its_work(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    lab.git("stash", "-q")
    assert lab.git("stash", "show", "-p", "--no-ext-diff", "--no-textconv").count("\n+") == 3
    lab.git("stash", "pop", "-q")
    lab.git("add", "-p", stdin="s\ny\nn\n", env={"GIT_EDITOR": "true"})
    assert lab.git("diff", "--cached", "--no-ext-diff", "--numstat").startswith("1\t1\t")
    lab.git("reset", "-q")
    lab.git("stash", "push", "-q", "-p", stdin="a\n")
    assert (lab.folder / "state/table.yaml").read_text() == STATE
    lab.git("stash", "pop", "-q")
    lab.commit("moved")
    lab.write("state/table.yaml", STATE)
    lab.git("checkout", "-q", "-p", stdin="a\n")
    assert (lab.folder / "state/table.yaml").read_text() == MOVED
    patch = lab.git("format-patch", "--stdout", "-1")
    lab.git("checkout", "-q", "-b", "other", "base")
    lab.git("am", "-q", stdin=patch)
    assert (lab.folder / "state/table.yaml").read_text() == MOVED
    lab.write("state/table.yaml", MOVED.replace("y: 20", "y: 25"))
    lab.commit("again")
    lab.git("rebase", "-q", "main")
    assert "y: 25" in (lab.folder / "state/table.yaml").read_text()


@pytest.mark.parametrize("how", ["missing", "killed", "killed while it writes", "another program", "removed"])
def test_whatever_becomes_of_pico_the_ordinary_diff_is_there(lab: Lab, how: str) -> None:
    known = lab.git("config", "diff.pico.command").rstrip("\n")
    stand_in = lab.folder.parent / "python"
    script = {"killed": "kill -9 $$", "killed while it writes": "echo half; kill -9 $$", "another program": "echo hi"}
    stand_in.write_text(f"#!/bin/sh\n{script.get(how, '')}\n")
    stand_in.chmod(0o755)
    lab.git("config", "diff.pico.command", known.replace(sys.executable, str(stand_in) + "x" * (how == "missing")))
    if how == "removed":
        uninstall(lab.folder)
    lab.write("state/table.yaml", MOVED)
    assert lab.git("diff") == lab.ordinary() != ""


def test_no_room_for_its_work_is_no_reason_to_show_nothing(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    failing = lab.folder.parent / "bin" / "mktemp"
    failing.parent.mkdir()
    failing.write_text("#!/bin/sh\nexit 1\n")
    failing.chmod(0o755)
    said = lab.git("diff", env={"PATH": f"{failing.parent}:{os.environ['PATH']}"}, code=None)
    assert "-    angle: 90\n+    angle: 1\n" in said


def test_the_summary_alone_or_the_lines_alone_where_somebody_prefers_that(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    assert lab.git("-c", "pico.diff=summary", "diff") == SAID
    assert lab.git("-c", "pico.diff=lines", "diff") == lab.ordinary()
    lab.write("state/table.yaml", STATE.replace("# mrad", "# by hand"))
    assert lab.git("-c", "pico.diff=summary", "diff") == "state/table.yaml: the same values, other text\n"


def test_another_diff_program_that_was_asked_for_is_obeyed(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    assert lab.git("diff", env={"GIT_EXTERNAL_DIFF": "echo mine"}).startswith("mine state/table.yaml")
    assert f"{SAID}\nmine state/table.yaml" in lab.git("-c", "diff.external=echo mine", "diff")


@pytest.mark.parametrize("name", ["-w.yaml", "x=1.yaml", 'a "b" $(c).yaml', "two\nlines.yaml", "--.yaml", "µ.yaml"])
def test_odd_names_are_names(lab: Lab, name: str) -> None:
    lab.write(name, STATE)
    lab.commit("odd")
    lab.write(name, MOVED)
    assert _lines_of_git(lab.git("diff")) == lab.ordinary() != ""
    assert "~ p2.angle  90 → 1 deg" in lab.git("diff")
    lab.commit("moved")
    assert "+p2.angle: 1" in lab.git("show") and "p2.angle: 1" in lab.git("blame", "--", name)


def test_files_that_git_does_not_keep_are_compared_as_ever(lab: Lab) -> None:
    outside = lab.folder.parent / "other.yaml"
    outside.write_text(MOVED)
    for other in (str(outside), "../other.yaml", "state/new.yaml"):
        lab.write("state/new.yaml", MOVED)
        asked = ["--no-index", "state/table.yaml", other]
        ordinary = lab.git("diff", "--no-ext-diff", "--no-textconv", *asked, code=1)
        assert lab.git("diff", *asked, code=None).endswith(ordinary)


def test_color_only_where_git_would_use_it(lab: Lab) -> None:
    lab.write("state/table.yaml", MOVED)
    assert "\x1b" not in lab.git("diff")
    for asked in (["-c", "color.ui=always", "diff"], ["diff", "--color"], ["-c", "color.diff=always", "diff"]):
        said = lab.git(*asked)
        assert "\x1b[33m~ m1" in said and "\x1b[32m+    angle: 1" in said.replace("\x1b[m\x1b[32m", "")
    assert "\x1b[33m~ m1" in lab.git("diff", env={"GIT_PAGER_IN_USE": "true", "TERM": "xterm"})
    assert "\x1b" not in lab.git("-c", "color.ui=always", "diff", "--no-color")


def test_a_lab_of_before_keeps_working_and_doctor_says_how_to_add_the_diff(lab: Lab) -> None:
    lab.write(".gitattributes", "*.yaml merge=pico\n")
    found = wiring(lab.folder)
    assert found and found.attributed and not found.shown and found.current
    assert ["diff=pico" in d.hint for d in checkup(lab.folder)] == [True]
    lab.git("config", "--remove-section", "diff.pico")
    assert "as another PICO set them" in checkup(lab.folder)[1].summary
    assert not wire(lab.folder) and "pico_diff" in lab.git("config", "diff.pico.command")


def test_doctor_names_the_lines_that_notes_and_runs_need(lab: Lab) -> None:
    (lab.folder / "notes").mkdir()
    (lab.folder / "runs").mkdir()
    assert checkup(lab.folder) == ()
    lab.write(".gitattributes", "*.yaml merge=pico diff=pico\n")
    assert [d.hint.split("'")[1].split()[0] for d in checkup(lab.folder)] == ["notes/*.md", "runs/**"]


def test_uninstall_takes_both_out_and_remembers_beside_other_settings(lab: Lab) -> None:
    lab.git("config", "pico.diff", "summary")
    uninstall(lab.folder)
    config = lab.git("config", "--list", "--local")
    assert "merge.pico" not in config and "diff.pico" not in config
    assert not wire(lab.folder) and "diff.pico" not in lab.git("config", "--list", "--local")
    install(lab.folder)
    found = wiring(lab.folder)
    assert found and found.current and not found.refused


def test_lines_that_two_branches_append_to_a_note_both_stay(lab: Lab) -> None:
    (lab.folder / "notes").mkdir()
    for branch in ("left", "right"):
        lab.git("checkout", "-q", "-b", branch, "base")
        (lab.folder / "notes").mkdir(exist_ok=True)
        lab.write("notes/m1.md", f"- {branch}\n")
        lab.commit(branch)
    lab.git("merge", "-q", "--no-edit", "left")
    assert sorted((lab.folder / "notes/m1.md").read_text().split()) == ["-", "-", "left", "right"]


def _said(old: str, new: str, path: str = "table.yaml") -> list[tuple[str, str, str]]:
    found = diff_files(old.encode(), new.encode(), Path("/nowhere") / path)
    assert found is not None
    return [(c.component, c.tunable, c.text) for c in found.changes] + list(found.others)


def test_what_changes_in_every_way(lab: Lab) -> None:
    def said(before: str, after: str) -> list[tuple[str, str, str]]:
        lab.write("new", STATE.replace(before, after))
        path = lab.folder / "state" / "table.yaml"
        found = diff_files(STATE.encode(), (lab.folder / "new").read_bytes(), path)
        assert found is not None
        return [(c.component, c.tunable, c.text) for c in found.changes] + list(found.others)

    assert said("  p2:\n    slot: storage/a2\n    angle: 90\n", "") == [
        ("p2", "pose", "taken out of this file (its home: storage/a2)")
    ]
    assert said("slot: storage/a2", "pose: {x: 1, y: 2}") == [("p2", "pose", "placed at (1, 2, 0°)")]
    assert said("angle: 90", "angle: 1.5707963267948966 rad") == []
    assert said("angle: 90", "angle: 90.0   # exactly") == []
    assert said("    angle: 90\n", "") == [("p2", "angle", "not given any more (was 90)")]
    assert said("tip: 1.0", "tip: 1.5\n    tilt: 2") == [("m1", "tilt", "set to 2 mrad"), ("m1", "tip", "1 → 1.5 mrad")]
    assert said("yaw: 45", "yaw: 405") == [("m1", "pose", "yaw 45 → 405°, the same direction")]
    assert said("x: 100", "x: 100.001") == [("m1", "pose", "moved 0.001 mm")]
    assert said("x: 100", "x: far away")[0][2].endswith('→ pose {x: "far away", y: 20, yaw: 45}')
    assert said("\ncomponents", '\nexpect:\n  - that: "m1.tip > 0"\ncomponents') == [("+", "expects", "m1.tip > 0")]
    assert said("{lab: bench}", "{lab: other}") == [("~", "metadata.lab", "bench → other")]


def test_the_bench_itself_is_shown_by_its_values() -> None:
    assert _said(LAB, LAB.replace("storage/a1", "storage/b1"), "lab.yaml") == [
        ("~", "inventory.m1.home", "storage/a1 → storage/b1")
    ]


@pytest.mark.parametrize("bad", ["[" * 9999, "a: &x 1", "a: 1\na: 2", "<<<<<<< ours\n", "kind: Pod\napiVersion: v1\n"])
def test_what_is_no_manifest_is_left_to_git(bad: str) -> None:
    assert diff_files(STATE.encode(), bad.encode(), Path("/nowhere/t.yaml")) is None


VALUES = st.one_of(st.integers(-3, 3), st.floats(-2, 2, width=16), st.booleans(), st.sampled_from(["open", "closed"]))
PLACES = st.one_of(
    st.fixed_dictionaries({"slot": st.sampled_from(["a", "b"])}),
    st.fixed_dictionaries({"pose": st.fixed_dictionaries({k: st.integers(0, 2) for k in ("x", "y", "yaw")})}),
)
COMPONENTS = st.builds(lambda place, values: place | values, PLACES, st.dictionaries(st.sampled_from("pqr"), VALUES))
STATES = st.dictionaries(st.sampled_from(["m1", "m2", "m3"]), COMPONENTS)


@given(STATES, STATES)
def test_exactly_what_differs_is_listed(old: dict[str, Any], new: dict[str, Any]) -> None:
    def manifest(components: dict[str, Any]) -> str:
        head = {"apiVersion": "pico/v1", "kind": "LabState", "metadata": {"lab": "bench"}}
        return yaml.safe_dump(head | {"components": components}, sort_keys=False)

    def leaves(components: dict[str, Any]) -> dict[tuple[str, str], str]:
        found = {}
        for name, part in components.items():
            found[name, "pose"] = repr((part.get("slot"), sorted(part.get("pose", {}).items())))
            for key in part.keys() - {"slot", "pose"}:
                value = part[key]
                found[name, key] = repr(float(value) + 0.0) if type(value) in (int, float) else repr(value)
        return found

    a, b = leaves(old), leaves(new)
    gone = {name for name in old if name not in new}
    wanted = {k for k in a.keys() | b.keys() if a.get(k) != b.get(k) and not (k[0] in gone and k[1] != "pose")}
    said = _said(manifest(old), manifest(new))
    assert {(component, tunable) for component, tunable, _ in said} == wanted
    assert all(text for _, _, text in said)


def test_lines_are_short_and_move_no_cursor(tmp_path: Path) -> None:
    (tmp_path / "old").write_text(STATE)
    (tmp_path / "new").write_text(STATE.replace("angle: 90", 'angle: "\\e[2Jgone"'))
    files = [str(tmp_path / "old"), "1", "100644", str(tmp_path / "new"), "2", "100644"]
    code, said = drive(["false", "", str(tmp_path / "table.yaml"), *files])
    assert code == SUMMARY and "\x1b" not in said and "?[2Jgone" in said
    assert drive(["false", "summary", "table.yaml", *files])[0] == ALONE
    (tmp_path / "new").write_text("a: 1\n")
    assert drive(["false", "", "table.yaml", *files])[0] == FAILED


def test_the_driver_loads_nothing_heavy() -> None:
    program = "import sys, pico.history.diff.driver; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert not {"pygit2", "numpy", "typer", "rich", "pint", "pydantic"} & set(done.stdout.split())

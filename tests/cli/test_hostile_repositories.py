"""What somebody else's repository can do to who looks at it: nothing. And to who works in it: what git does."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
from pathlib import Path

import pytest
from commanding import Pico
from pico_cli.at_once.complete import candidates
from pico_cli.session import Session
from pico_cli.terminal.paging import _pager

from pico.history.git import trees
from pico.history.repository.repository import Repository

LOOKING = (
    ("status",), ("plan", "e2"), ("drift",), ("log",), ("log", "--graph", "--all"), ("diff", "e1", "e2"), ("diff",),
    ("show", "e2"), ("blame",), ("verify",), ("validate",), ("check",), ("check", "e1"), ("runs", "list"),
    ("catalog", "parts"),
    ("get", "p2"), ("data", "status"), ("doctor",), ("stash", "list"), ("capture", "--dry-run"),
    ("plan", "e2", "--explain"),
    ("merge-driver",), ("fmt", "--check"), ("checkout", "e2"), ("bisect", "status"),
    ("runs", "export", "--out", "crate"),
)  # fmt: skip
STEERS = "\x1b[2J\x1b]0;owned\x07\x9b31m\r\x08\u202e"


def git(folder: Path, *words: str, stdin: str = "") -> str:
    done = subprocess.run(["git", *words], cwd=folder, input=stdin, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.fixture
def trap(tmp_path: Path) -> Path:
    """A program that says by which name it was called."""
    path = tmp_path / "trap"
    path.write_text(f'#!/bin/sh\necho "$0 $*" >> {tmp_path}/sprung\ncat >/dev/null 2>&1 </dev/null\n')
    path.chmod(0o755)
    return path


@pytest.fixture
def hostile(shel: Path, trap: Path) -> Path:
    """The example, with every setting of git that names a program set to the trap, and every hook."""
    (shel / ".gitattributes").write_text("*.yaml filter=evil diff=evil merge=evil\n*.md filter=e=v.il\n")
    settings = {
        "core.fsmonitor": trap, "core.hooksPath": trap.parent / "hooks", "core.pager": trap, "pager.log": trap,
        "core.editor": trap, "sequence.editor": trap, "core.askPass": trap, "core.sshCommand": trap,
        "core.gitProxy": trap, "core.alternateRefsCommand": trap, "diff.external": trap, "diff.evil.command": trap,
        "diff.evil.textconv": trap, "merge.evil.driver": trap, "filter.evil.clean": trap, "filter.evil.smudge": trap,
        "filter.evil.required": "true", "filter.e=v.il.clean": trap, "interactive.diffFilter": trap,
        "gpg.program": trap, "log.showSignature": "true", "credential.helper": f"!{trap}", "alias.status": f"!{trap}",
        "alias.rev-list": f"!{trap}", "uploadpack.packObjectsHook": trap, "remote.origin.url": f"ext::{trap}",
        "remote.origin.promisor": "true", "remote.origin.uploadpack": trap, "protocol.ext.allow": "always",
        "protocol.allow": "always", "trailer.x.command": trap, "man.viewer": trap, "browser.x.cmd": trap,
    }  # fmt: skip
    more = shel / ".git" / "more"
    for name, value in settings.items():
        git(shel, "config", "--file", str(more), name, str(value))
    git(shel, "config", "include.path", "more")
    hooks = trap.parent / "hooks"
    hooks.mkdir()
    for name in ("post-checkout", "post-index-change", "reference-transaction", "pre-commit", "fsmonitor-watchman"):
        (hooks / name).symlink_to(trap)
    os.utime(shel / "state/table.yaml")
    os.utime(shel / "lab.yaml")
    return shel


def test_looking_runs_nothing_that_a_repository_names(hostile: Path, tmp_path: Path, pico: Pico) -> None:
    sprung = tmp_path / "sprung"
    for words in LOOKING:
        with contextlib.suppress(SystemExit):
            pico(*words)
        assert not sprung.exists(), (words, sprung.read_text())
    with contextlib.chdir(hostile):
        candidates(["checkout", ""])
        assert str(tmp_path / "trap") not in _pager(Session(folder=hostile))
    assert not sprung.exists()
    subprocess.run(["git", "status"], cwd=hostile, capture_output=True, check=False)
    assert sprung.exists(), "the trap itself does not work"


def test_a_pager_of_the_user_s_own_counts(hostile: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = tmp_path / "own"
    own.write_text("[core]\n\tpager = less -S\n")
    monkeypatch.delenv("GIT_PAGER", raising=False)
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(own))
    assert _pager(Session(folder=hostile)) == "less -S"


def test_filters_of_the_user_s_own_count_when_looking(
    shel: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (shel / ".git/info/attributes").write_text("*.yaml filter=mine\n")
    own = tmp_path / "own"
    own.write_text('[filter "mine"]\n\tclean = sed s/COMPONENTS/components/\n')
    table = shel / "state/table.yaml"
    table.write_text(table.read_text().replace("components:", "COMPONENTS:"))  # as long as it was
    repository = Repository.discover(shel)
    assert repository is not None and repository.changed(shel) == ("state/table.yaml",)
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(own))
    assert repository.changed(shel) == ()


def test_names_messages_and_notes_never_steer_the_terminal(shel: Path, pico: Pico) -> None:
    state = (shel / "state/table.yaml").read_text()
    git(shel, "checkout", "-q", "-b", "b\u202ead")
    (shel / "notes").mkdir()
    (shel / "notes/p2.md").write_text(f"- 2026-01-02 {STEERS}: {STEERS}\n")
    (shel / "state/table.yaml").write_text(state + f"# {STEERS}\n")
    (shel / f"x{STEERS}\n.yaml").write_text(f"apiVersion: pico/v1\nkind: '{STEERS}'\n")
    git(shel, "add", "-A")
    git(
        shel, "commit", "-q", "-F", "-", f"--author={STEERS} <{STEERS}@x>", stdin=f"{STEERS} subject\n\nbody {STEERS}\n"
    )
    places = shel / "runs/2026/01" / f"r{STEERS}"
    places.mkdir(parents=True)
    (places / "run.json").write_text(json.dumps({"schema": STEERS, "id": STEERS}))
    (shel / "runs/2026/01/20260101T000000Z-aaaaaa").mkdir()
    (shel / "runs/2026/01/20260101T000000Z-aaaaaa/run.json").write_text(STEERS)
    git(shel, "add", "-f", "-A")
    git(shel, "commit", "-q", "-m", f"run {STEERS}")
    git(shel, "stash", "push", "-q", "-m", STEERS) if git(shel, "status", "--porcelain") else None
    for words in (*LOOKING, ("note", "p2", STEERS), ("show", "HEAD:p2"), ("runs", "show", STEERS), ("plan", STEERS)):
        for form in ((), ("--json",)):
            answer = pico(*words, *form)
            raw = [c for c in answer.out + answer.err if c in STEERS and c.isprintable() is False]
            assert not raw, (words, form, answer.out + answer.err)
            assert "PICO itself failed" not in answer.out + answer.err, words


def test_a_json_answer_still_says_what_it_says(shel: Path, pico: Pico) -> None:
    git(shel, "commit", "-q", "--allow-empty", "-m", f"a{STEERS}b")
    entries = [json.loads(line) for line in pico("log", "--json", "-n", "1").out.splitlines()]
    assert "\u202e" in json.dumps(entries, ensure_ascii=False)


@pytest.mark.parametrize("name", ["a$(touch x)", "a`touch`", "a;b", "a|b", "a&b", "a'b"])
def test_completion_offers_nothing_that_a_shell_would_run(shel: Path, name: str) -> None:
    done = subprocess.run(["git", "branch", name], cwd=shel, capture_output=True, check=False)
    assert done.returncode in (0, 128)
    (shel / f"{name}.plan").touch()
    assert "e1" in candidates(["apply", ""])
    assert not [c for c in candidates(["apply", ""]) if name[:2] in c and name[1] in c]


def test_completion_reads_no_pipe_and_no_link(shel: Path) -> None:
    os.mkfifo(shel / "pipe.yaml")
    (shel / "link.yaml").symlink_to("/dev/zero")
    assert "p2" in candidates(["get", ""])


@pytest.mark.parametrize(
    "name",
    [
        ".pico",
        ".pico/benches",
        ".pico/benches/sim",
        ".pico/benches/sim/lock",
        ".pico/sim",
        ".pico/journal.sqlite",
        ".pico/write.tmp",
    ],
)
def test_what_pico_keeps_is_not_written_through_a_link(shel: Path, tmp_path: Path, pico: Pico, name: str) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    victim = outside / "victim"
    victim.write_text("mine")
    (shel / name).parent.mkdir(parents=True, exist_ok=True)
    (shel / name).symlink_to(outside if name.endswith((".pico", "benches", "sim")) else victim)
    for words in (
        ("apply", "e2", "--auto-approve"),
        ("move", "p2", "home", "-y"),
        ("sim", "reset"),
        ("capture",),
        ("plan",),
    ):
        answer = pico(*words)
        assert answer.code == 1 and "symbolic link" in answer.err, (words, answer.err)
    assert victim.read_text() == "mine" and list(outside.iterdir()) == [victim]


@pytest.mark.parametrize("name", ["notes", "state"])
def test_manifests_and_notes_are_not_written_through_a_link(shel: Path, tmp_path: Path, pico: Pico, name: str) -> None:
    pico("apply", "e2", "--auto-approve")
    outside = tmp_path / "outside"
    outside.mkdir()
    if (shel / name).exists():
        (shel / name).rename(shel / f"{name}.real")
    (shel / name).symlink_to(outside)
    assert pico("note", "p2", "scratched").code == (1 if name == "notes" else 0)
    pico("capture")
    pico("revert", "HEAD")
    pico("checkout", "e2", "--", "p2")
    assert list(outside.iterdir()) == []


def test_runs_are_not_written_through_a_link(shel: Path, tmp_path: Path, pico: Pico) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    pico("apply", "e2", "--auto-approve")
    (shel / "runs").symlink_to(outside)
    answer = pico("commit", "--capture", "-m", "with its run")
    assert answer.code == 1 and "no place for a file of a run" in answer.err
    assert list(outside.iterdir()) == []


def test_a_manifest_that_is_a_link_is_not_read(shel: Path, pico: Pico) -> None:
    (shel / "state/table.yaml").unlink()
    (shel / "state/table.yaml").symlink_to("/etc/passwd")
    answer = pico("plan")
    assert answer.code == 1 and "symbolic link" in answer.err and "root" not in answer.err
    git(shel, "add", "-A")
    git(shel, "commit", "-q", "-m", "a link")
    answer = pico("show", "HEAD")
    assert "root:" not in answer.out + answer.err


def test_a_repository_among_the_files_is_not_taken_for_the_lab_s(
    shel: Path, trap: Path, tmp_path: Path, pico: Pico
) -> None:
    bare = shel / "state" / "inner"
    git(shel, "init", "-q", "--bare", str(bare))
    for name, value in (("core.fsmonitor", trap), ("core.worktree", shel), ("core.bare", "false")):
        git(shel, "config", "--file", str(bare / "config"), name, str(value))
    for words in (("status",), ("log",), ("check",), ("commit", "-m", "x", "--capture")):
        answer = pico("-C", str(bare), *words)
        assert answer.code == 0 or "bare repository" in answer.err, answer.err
    assert not (tmp_path / "sprung").exists()


def test_a_working_tree_elsewhere_is_not_written(shel: Path, tmp_path: Path, pico: Pico) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    git(shel, "config", "core.worktree", str(elsewhere))
    for words in (("checkout", "e2", "--files-only"), ("commit", "-m", "x"), ("log",), ("merge", "e2"), ("stash",)):
        answer = pico(*words)
        assert answer.code == 1 and "says that its files are in" in answer.err, (words, answer.err)
    assert list(elsewhere.iterdir()) == []


BOMBS = {
    "brackets": b"apiVersion: pico/v1\nx: " + b"[" * 50_000,
    "braces": b"apiVersion: pico/v1\nx: " + b"{a: " * 50_000,
    "aliases": b"apiVersion: pico/v1\na: &a [x,x]\nb: &b [*a,*a]\nc: [*b,*b]\n",
    "tags": b"apiVersion: pico/v1\nx: !!python/object/apply:os.system [touch /tmp/x]\n",
    "large": b"apiVersion: pico/v1\n" + b"# filler\n" * 300_000,
    "keys": b"apiVersion: pico/v1\nkind: LabState\n" + b"".join(b"k%d: 1\n" % i for i in range(60_000)),
    "number": b"apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents:\n  p2: {angle: 1e999999}\n",
    "digits": b"apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents: {p2: {angle: %d}}" % 9**4000,
    "text": b"apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: '" + b"x" * 1_000_000 + b"'}\n",
    "nul": b"apiVersion: pico/v1\n\0\0",
}  # fmt: skip


@pytest.mark.parametrize("bomb", [pytest.param(b, marks=pytest.mark.slow) if b == "keys" else b for b in BOMBS])
def test_a_manifest_that_is_a_bomb_is_named_in_the_files_and_at_a_revision(shel: Path, pico: Pico, bomb: str) -> None:
    (shel / "state/bomb.yaml").write_bytes(BOMBS[bomb])
    git(shel, "add", "-A")
    git(shel, "commit", "-q", "-m", bomb)
    for words in (("plan",), ("plan", "HEAD"), ("validate",), ("check", "HEAD~1")):
        answer = pico(*words)
        assert answer.code == 1 and "bomb.yaml" in answer.err + answer.out, (words, answer.out[:500], answer.err[:500])
        assert "PICO itself failed" not in answer.err, answer.err
        assert len(answer.err) < 20_000
    for words in (("fmt",), ("show", "HEAD"), ("log", "-n", "3"), ("blame",), ("diff", "HEAD~1", "HEAD")):
        assert "PICO itself failed" not in pico(*words).err, words
    git(shel, "reset", "-q", "--hard", "HEAD~1")
    assert pico("plan", "e1").code == 0


def test_trees_of_any_depth_and_size_are_named(shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trees, "MAX_ENTRIES", 3000)
    blob = git(shel, "hash-object", "-w", "--stdin", stdin="x: 1\n")
    deep = git(shel, "mktree", stdin=f"100644 blob {blob}\tx.yaml\n")
    wide = deep
    for _ in range(100):
        deep = git(shel, "mktree", stdin=f"040000 tree {deep}\td\n")
    for _ in range(10):
        wide = git(shel, "mktree", stdin="".join(f"040000 tree {wide}\td{i}\n" for i in range(10)))
    for name, tree, said in (("deep", deep, "nested deeper"), ("wide", wide, "more than 3000 files")):
        top = git(shel, "ls-tree", "e1") + f"\n040000 tree {tree}\tzz\n"
        commit = git(shel, "commit-tree", "-p", "e1", "-m", name, git(shel, "mktree", stdin=top))
        answer = pico("plan", commit)
        assert answer.code == 1 and said in answer.err, answer.err
        answer = pico("show", commit)
        assert "PICO itself failed" not in answer.err and said in answer.out + answer.err


def test_folders_nested_without_end_are_named(shel: Path, pico: Pico) -> None:
    with contextlib.chdir(shel):
        for _ in range(400):
            Path("d").mkdir()
            os.chdir("d")
    answer = pico("plan")
    assert answer.code == 1 and "nested deeper than 64" in answer.err


EXPRESSIONS = (
    "x." * 400 + "y > 1", "(" * 3000 + "1" + ")" * 3000, "[1,2,3].map(x, [1,2,3].map(y, x)) > 1",
    "'" + "a" * 5000 + "!'.matches('(a+)+$')", "1 > " * 2000 + "1",
)  # fmt: skip


@pytest.mark.parametrize("that", EXPRESSIONS)
def test_an_expectation_that_blows_up_is_refused(shel: Path, pico: Pico, that: str) -> None:
    path = shel / "state/table.yaml"
    path.write_text(path.read_text() + f'expect:\n  - {{that: "{that}", message: x}}\n')
    for words in (("validate",), ("check", "e1"), ("verify",)):
        answer = pico(*words)
        assert "PICO itself failed" not in answer.err, answer.err
    assert answer.code != 0


def test_a_run_that_lies_about_its_names_gets_nowhere(shel: Path, tmp_path: Path, pico: Pico) -> None:
    name = "20260101T000000Z-aaaaaa"
    place = shel / "runs/2026/01" / name
    place.mkdir(parents=True)
    lies = {"../../../../evil": {"sha256": "0" * 64, "size": 1}, "/etc/passwd": {"sha256": "0" * 64, "size": 1}}
    artifact = {"name": "../../evil", "sha256": "../../../x", "size": 1, "media_type": "x"}
    document = {"schema": "pico.run/v1", "id": name, "files": lies, "artifacts": [artifact]}
    (place / "run.json").write_text(json.dumps(document))
    git(shel, "add", "-A", "-f", "runs")
    git(shel, "commit", "-q", "-m", "lies")
    crate, data = str(tmp_path / "crate"), str(tmp_path / "data")
    for words in (
        ("runs", "list"), ("runs", "show", name), ("runs", "export", "--out", crate), ("data", "status"), ("log",),
        ("data", "push", data), ("data", "pull", data), ("show", "HEAD"), ("verify",), ("data", "pointers", name),
    ):  # fmt: skip
        answer = pico(*words)
        assert "PICO itself failed" not in answer.err, (words, answer.err)
    assert not list(tmp_path.rglob("*evil*"))


def test_the_rules_are_those_of_the_bench_as_it_is_now(shel: Path, pico: Pico) -> None:
    lab = shel / "lab.yaml"
    head, found, rest = lab.read_text().partition("  rules:")
    line, _, more = rest.partition("\n")
    assert found
    closed = '    - {name: closed, that: "false", message: the bench is closed}'
    lab.write_text(f"{head}{found}{line}\n{closed}\n{more}")
    answer = pico("plan", "e2")
    assert "the bench is closed" in answer.out + answer.err
    assert pico("apply", "e2", "--auto-approve").code == 7


def test_a_note_that_is_a_link_is_nobody_s_note(shel: Path, tmp_path: Path, pico: Pico) -> None:
    secret = tmp_path / "secret"
    secret.write_text("the key\n")
    (shel / "notes").mkdir()
    (shel / "notes/p2.md").symlink_to(secret)
    said = pico("log", "--", "p2").out + pico("blame", "p2").out + pico("show", "HEAD:p2").out
    assert pico("note", "p2", "scratched").code == 0
    assert "the key" not in said + (shel / "notes/p2.md").read_text()
    assert secret.read_text() == "the key\n"

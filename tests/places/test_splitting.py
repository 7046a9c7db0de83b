"""What an earlier version kept of all benches of a lab in one folder is split into a folder for each."""

from __future__ import annotations

import fcntl
import json
import os
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from commanding import Pico

from pico.base import state_file
from pico.diagnostics import ExitCode, PicoError
from pico.places import layout, old_journal, old_records, sorting
from pico.places.bench import local_benches
from pico.runs.journal import Journal

EACH = {"r1": "sim", "r2": "emulated", "r3": "hardware", "r4": "sim", "r5": None, "r6": "emulated"}
"""The runs of the old journal, and the bench of each."""


def begun(journal: Journal, run: str, *backends: str) -> None:
    about = [{"environment": {"backend": one}, "evidence": "kinematic" if one == "sim" else one} for one in backends]
    journal.begin_run(run, f"sha256:{run}", "pico apply", document="{}", about=about[0])
    for more in about[1:]:
        journal.resume_run(run, more)
    journal.end_run(run, "done", {})


@pytest.fixture
def old(tmp_path: Path) -> Path:
    """A lab as an earlier version left it: runs of three benches, one of which was taken up again on another."""
    root = tmp_path / "lab"
    folder = root / ".pico"
    for name in ("sim", "emulated", "hardware", "points", "recipes", "armed"):
        (folder / name).mkdir(parents=True)
    (root / "lab.yaml").write_text("kind: Lab\n")
    with closing(Journal(folder / "journal.sqlite")) as journal:
        for run, bench in EACH.items():
            begun(journal, run, *([bench] if bench else ["emulated", "sim"]))
        journal._db.execute("UPDATE runs SET finished_at = NULL, checksum = NULL WHERE run = 'r6'")
        journal.fence(7)
    (folder / "changes").unlink()  # which no earlier version writes
    (folder / "run").write_text("r6\n")
    (folder / "lock").write_bytes(b"%-31d\n" % 7)
    files = {
        "lab.json": '{"files": {}}', "sim/world.json": '"sim"', "emulated/world.json": '"emulated"',
        "hardware/settings.json": "{}", "seen.json": "{}", "dose.json": "{}", "points/r2-op1-1.jsonl": "",
        "recipes/a.jsonl": '{"run": "r3"}\n', "recipes/a.out": "said", "armed/laser.json": '{"backend": "hardware"}',
        "mornings.json": '{"schema": "x", "references": [{"run": "r1"}, {"run": "r3"}]}', "audit.json": "{}",
    }  # fmt: skip
    for name, text in files.items():
        (folder / name).write_text(text)
    return root


def runs_in(path: Path) -> list[str]:
    with closing(Journal(path)) as journal:
        return [run.run for run in journal.runs()]


def judge(root: Path) -> None:
    """Require that each bench has what is its own, and that nothing else is left."""
    benches = root / ".pico/benches"
    for name in ("sim", "emulated", "hardware"):
        own = [run for run, bench in EACH.items() if bench == name]
        assert runs_in(bench_at(root, name).folder / "journal.sqlite") == own
        assert (benches / name / "lab.json").exists() and (benches / name / "dose.json").exists()
        assert (benches / name / "lock").read_bytes().startswith(b"7")
    assert runs_in(root / ".pico/unsorted/journal.sqlite") == ["r5"]
    assert json.loads((benches / "sim/world.json").read_text()) == "sim"
    assert json.loads((benches / "emulated/world.json").read_text()) == "emulated"
    assert (benches / "sim/seen.json").exists() and (benches / "emulated/points/r2-op1-1.jsonl").exists()
    assert {path.name for path in (benches / "hardware/recipes").iterdir()} == {"a.jsonl", "a.out"}
    assert (benches / "hardware/armed/laser.json").exists() and (benches / "emulated/run").read_text() == "r6\n"
    for name, run in (("sim", "r1"), ("hardware", "r3")):
        assert json.loads((benches / name / "mornings.json").read_text())["references"] == [{"run": run}]
    left = {path.name for path in (root / ".pico").iterdir()}
    assert left == {"benches", "unsorted", "audit.json", "split.lock", ".gitignore"}


def test_each_bench_gets_its_runs_and_an_unclear_one_is_reported_once(old: Path) -> None:
    judge(old)
    (found,) = layout.take_report(old)
    assert "r5" in found.summary and ".pico/unsorted/journal.sqlite" in str(found.hint)
    assert layout.take_report(old) == ()
    assert [place.name for place in local_benches(old)] == ["emulated", "hardware", "sim"]


def killed(act: Callable[[], object], at: int) -> bool:
    """Do something in a child that dies at the `at`-th change of a file; return whether it died."""
    child = os.fork()
    if child == 0:
        left = [at]

        def dying(how: Callable[..., Any]) -> Callable[..., Any]:
            def change(*args: Any, **options: Any) -> Any:
                if not left[0]:
                    os._exit(9)
                left[0] -= 1
                return how(*args, **options)

            return change

        shutil.copy2 = dying(shutil.copy2)  # type: ignore[assignment]
        shutil.rmtree = dying(shutil.rmtree)  # type: ignore[assignment]
        for name in ("rename", "rmdir", "unlink", "mkdir"):
            setattr(Path, name, dying(getattr(Path, name)))
        for module, name in (
            (old_journal, "copy_runs"),
            (sorting, "write_whole"),
            (state_file, "write_whole"),
            (old_records, "write_seals"),
        ):
            setattr(module, name, dying(getattr(module, name)))
        act()
        os._exit(0)
    return os.waitpid(child, 0)[1] != 0


def killed_at_each_moment(old: Path, folder: Path) -> None:
    """Kill the splitting at each of its changes in turn, then once more, and require that it is made whole."""
    at, again = 0, 0
    while True:
        root = Path(shutil.copytree(old, folder / f"at{at}"))
        if not killed(lambda root=root: bench_at(root).folder, at):  # type: ignore[misc]
            break
        killed(lambda root=root: bench_at(root).folder, at // 2)  # type: ignore[misc]
        again += layout.read_layout(root) is None
        judge(root)
        shutil.rmtree(root)
        at += 1
    assert at > 40 and again > 10, "kills before and after the new layout counted"


def test_killed_at_any_moment_it_leaves_the_old_layout_or_the_new_one(old: Path, tmp_path: Path) -> None:
    # in a process that is small, as each of 160 forks of this one would take a twentieth of a second
    program = (
        "from test_splitting import Path, killed_at_each_moment, sys\nkilled_at_each_moment(*map(Path, sys.argv[1:]))"
    )
    path = os.pathsep.join([str(Path(__file__).parent), str(Path(__file__).parents[1])])
    done = subprocess.run(
        [sys.executable, "-c", program, str(old), str(tmp_path)], env=os.environ | {"PYTHONPATH": path}, check=False,
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_what_a_repository_knows_of_the_benches_is_lifted(old: Path) -> None:
    for name in ("objects", "refs"):
        (old / ".git" / name).mkdir(parents=True)
    (old / ".git/HEAD").touch()
    known = old / ".git/pico"
    (known / "armed").mkdir(parents=True)
    (known / "bench.json").write_text('{".": ".."}')
    (known / "labs.json").write_text('{".": ["aa"]}')
    (known / "armed" / old_records._name("./laser")).write_text("bb")
    judge(old)
    names = ["emulated", "hardware", "sim"]
    record, seals = (json.loads((known / name).read_text())["."] for name in ("bench.json", "labs.json"))
    assert sorted(record) == sorted(seals) == names and set(record.values()) == {".."}
    assert (known / "armed" / old_records._name("./hardware/laser")).read_text() == "bb"
    assert bench_at(old, "other").attached == bench_at(old, "other"), "no worktree has a bench that nobody used"


def test_while_an_earlier_version_moves_a_bench_nothing_is_split(old: Path) -> None:
    before = sorted(old.rglob("*"))
    with (old / ".pico/lock").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with pytest.raises(PicoError, match="an earlier PICO moves or serves a bench") as refused:
            _ = bench_at(old).folder
    assert refused.value.exit_code == ExitCode.LOCKED
    assert set(old.rglob("*")) - set(before) <= {old / ".pico/split.lock", old / ".pico/.gitignore"}
    judge(old)


def test_what_an_earlier_version_writes_after_the_split_is_set_aside_and_reported(old: Path) -> None:
    judge(old)
    layout.take_report(old)
    with closing(Journal(old / ".pico/journal.sqlite")) as journal:
        begun(journal, "r7", "sim")
    (old / ".pico/changes").unlink()
    assert runs_in(bench_at(old).folder / "journal.sqlite") == ["r1", "r4"]
    found = layout.take_report(old)
    assert any("earlier PICO" in one.summary and "earlier-1" in one.summary for one in found)
    assert runs_in(old / ".pico/earlier-1/journal.sqlite") == ["r7"]


def test_a_journal_that_can_not_be_read_is_said_with_a_way_on(old: Path) -> None:
    path = old / ".pico/journal.sqlite"
    for one in path.parent.glob("journal.sqlite-*"):
        one.unlink()
    path.write_bytes(b"this is no database " * 300)
    with pytest.raises(PicoError, match="can't be read, so its runs can't be sorted") as refused:
        _ = bench_at(old).folder
    assert f"mv {path}" in str(refused.value.diagnostics[0].hint)
    path.rename(path.with_suffix(".sqlite.broken"))
    assert bench_at(old).folder.is_dir() and (old / ".pico/journal.sqlite.broken").exists()


def test_a_disk_that_can_not_be_written_is_said(old: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opening = os.open

    def refusing(path: Any, flags: int, *more: Any, **options: Any) -> int:
        if flags & os.O_CREAT and "split.lock" in str(path):
            raise OSError(30, "Read-only file system", str(path))
        return opening(path, flags, *more, **options)

    monkeypatch.setattr(os, "open", refusing)
    with pytest.raises(PicoError, match=r"laid out as by an earlier PICO.*read-only") as refused:
        _ = bench_at(old).folder
    assert refused.value.diagnostics[0].hint


def test_a_journal_of_the_first_version_goes_by_the_plans_of_its_runs(tmp_path: Path) -> None:
    folder = tmp_path / ".pico"
    folder.mkdir()
    with closing(sqlite3.connect(folder / "journal.sqlite")) as journal:
        journal.executescript(
            "CREATE TABLE runs (number INTEGER PRIMARY KEY, run TEXT, plan TEXT, document TEXT);"
            "CREATE TABLE records (seq INTEGER PRIMARY KEY, run TEXT);"
            """INSERT INTO runs VALUES (1, 'a', 'p', '{"backend": "hardware"}'), (2, 'b', 'p', NULL);"""
            "INSERT INTO records VALUES (1, 'a'), (2, 'b');"
        )
    assert [path.name for path in bench_at(tmp_path).folder.parent.iterdir() if path.is_dir()] == ["hardware"]
    assert "b" in layout.take_report(tmp_path)[0].summary


def test_commands_say_what_could_not_be_sorted(
    case_study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico
) -> None:
    lab = Path(shutil.copytree(case_study, tmp_path / "shel"))
    monkeypatch.chdir(lab)
    (lab / ".pico").mkdir()
    with closing(Journal(lab / ".pico/journal.sqlite")) as journal:
        begun(journal, "20261123T120000Z-aaaaaa", "emulated", "sim")
    said = pico("runs", "list")
    assert said.code == 0 and "it is unclear on which bench these runs were: 20261123T120000Z-aaaaaa" in said.err
    assert "unclear" not in pico("runs", "list").err

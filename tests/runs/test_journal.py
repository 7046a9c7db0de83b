"""The journal: three records an operation, results of known keys, and diagnostics instead of tracebacks."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from oracles.unfinished import unfinished

from pico.diagnostics import ExitCode, PicoError, error
from pico.model.observation import ObservedComponent, ObservedValue
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.pose import Pose
from pico.runs.journal import Journal

MOVE = Operation(
    id="op1", primitive="move", component="p1", arguments={"to": {"pose": {"x": 1.0}}}, reason=Reason(kind="changed")
)
SEEN = ObservedComponent(pose=Pose(1 / 3, 2.0, 30.0), values={"angle": ObservedValue(value=90.0)})
DONE = OperationResult(key="r1/op1/1", outcome="done", before=SEEN, after=SEEN, seconds=9.5, data={"error_mm": 0.1 / 3})


@pytest.fixture
def journal(tmp_path: Path) -> Iterator[Journal]:
    journal = Journal(tmp_path / "journal.sqlite", clock=lambda: "2026-11-01T00:00:00Z")
    yield journal
    journal.close()


def test_an_operation_leaves_intent_start_and_end(journal: Journal) -> None:
    assert journal.intend("r1/op1/1", MOVE, token=7) is None
    journal.started("r1/op1/1", SEEN, token=7)
    journal.ended(DONE, token=7)
    records = journal.records(run="r1")
    assert [(r.kind, r.token) for r in records] == [("intent", 7), ("started", 7), ("done", 7)]
    assert records[0].data["arguments"] == {"to": {"pose": {"x": 1.0}}}
    assert records[1].data["pose"] == {"x": 1 / 3, "y": 2.0, "yaw": 30.0}


def test_a_known_key_returns_its_recorded_result(journal: Journal) -> None:
    failed = replace(DONE, outcome="failed", error=error("dropped", "p1 was dropped", address="p1"))
    for key, result in (("r1/op1/1", DONE), ("r1/op1/2", replace(failed, key="r1/op1/2"))):
        journal.intend(key, MOVE, token=1)
        journal.started(key, SEEN, token=1)
        journal.ended(result, token=1)
        assert journal.intend(key, MOVE, token=1) == result


def test_a_known_key_with_other_content_is_an_error(journal: Journal) -> None:
    journal.intend("r1/op1/1", MOVE, token=1)
    with pytest.raises(PicoError, match="other content"):
        journal.intend("r1/op1/1", replace(MOVE, component="p2"), token=1)


def test_what_never_started_may_be_executed_and_what_was_cut_short_is_unknown(tmp_path: Path) -> None:
    path = tmp_path / "journal.sqlite"
    first = Journal(path)
    first.intend("r1/op1/1", MOVE, token=1)
    first.intend("r1/op2/1", MOVE, token=1)
    first.started("r1/op2/1", SEEN, token=1)
    first.close()
    again = Journal(path)
    assert again.intend("r1/op1/1", MOVE, token=2) is None
    cut = again.intend("r1/op2/1", MOVE, token=2)
    assert cut is not None
    assert cut.outcome == "unknown"
    assert [r.key for r in unfinished(again)] == ["r1/op2/1"]


def test_an_end_is_recorded_once(journal: Journal) -> None:
    journal.intend("r1/op1/1", MOVE, token=1)
    journal.ended(DONE, token=1)
    with pytest.raises(PicoError, match="already"):
        journal.ended(replace(DONE, outcome="failed"), token=1)


def test_runs_are_listed_with_their_outcome_and_belong_to_one_plan(journal: Journal) -> None:
    journal.begin_run("r1", "sha256:a", "ann: apply")
    journal.end_run("r1", "failed", {"done": 1, "failed": 1})
    journal.begin_run("r2", "sha256:b", "ann: apply")
    assert [(r.run, r.outcome, r.tally) for r in journal.runs()] == [
        ("r1", "failed", {"done": 1, "failed": 1}),
        ("r2", None, None),
    ]
    with pytest.raises(PicoError, match="another plan"):
        journal.begin_run("r1", "sha256:c", "ann: apply")


def test_a_record_is_durable_and_ordered_before_the_call_returns(journal: Journal) -> None:
    journal.intend("r1/op1/1", MOVE, token=1)
    with sqlite3.connect(journal.path) as other:
        assert other.execute("SELECT kind FROM records").fetchall() == [("intent",)]
    assert journal._db.execute("PRAGMA synchronous").fetchone() == (2,)
    assert journal._db.execute("PRAGMA journal_mode").fetchone() == ("wal",)


@pytest.mark.parametrize(
    "content",
    [b"this is no database, but it is long enough to be looked at" * 20, b"SQLite format 3\0" + b"\xff" * 4000],
)
def test_a_damaged_database_is_a_diagnostic_that_says_what_to_do(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "journal.sqlite"
    path.write_bytes(content)
    with pytest.raises(PicoError) as caught:
        Journal(path).runs()
    (found,) = caught.value.diagnostics
    assert str(path) in found.summary
    assert found.code == "journal"


def test_a_locked_database_is_a_diagnostic(journal: Journal) -> None:
    journal._db.execute("PRAGMA busy_timeout=1")
    other = sqlite3.connect(journal.path, isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    with pytest.raises(PicoError, match="is locked"):
        journal.intend("r1/op1/1", MOVE, token=1)
    other.close()


def test_what_a_run_was_started_with_and_what_was_seen_afterwards_is_kept(journal: Journal) -> None:
    journal.begin_run("r1", "sha256:a", "ann: apply", about={"operator": "ann"})
    journal.saw("r1", {"reached": False})
    assert journal.about("r1") == (({"operator": "ann"},), {"reached": False})
    journal.resume_run("r1", {"operator": "bob"})
    assert journal.about("r1") == (({"operator": "ann"}, {"operator": "bob"}), None)


UNCOUNTED = (
    "DROP TRIGGER INSERT_records; DROP TRIGGER INSERT_runs; DROP TRIGGER UPDATE_runs;"
    "ALTER TABLE fence DROP COLUMN changes;"
)
"""Makes a journal one from before its changes were counted."""


def test_a_journal_of_version_2_goes_on(tmp_path: Path) -> None:
    path = tmp_path / "journal.sqlite"
    Journal(path).close()
    with sqlite3.connect(path) as db:
        db.executescript(
            f"{UNCOUNTED}"
            "ALTER TABLE runs DROP COLUMN about; ALTER TABLE runs DROP COLUMN seen;"
            "ALTER TABLE runs DROP COLUMN checksum;"
            "ALTER TABLE records DROP COLUMN checksum; PRAGMA user_version=2;"
            "INSERT INTO runs (run, plan, holder, started_at) VALUES ('r1', 'sha256:a', 'ann', '2026');"
        )
    journal = Journal(path)
    assert journal.about("r1") == ((), None)
    journal.resume_run("r1", {"operator": "bob"})
    assert journal.about("r1") == (({}, {"operator": "bob"}), None)
    journal.close()


def test_a_database_of_a_newer_pico_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "journal.sqlite"
    with sqlite3.connect(path) as db:
        db.execute("PRAGMA user_version=99")
    with pytest.raises(PicoError, match="newer PICO"):
        Journal(path)


def test_a_journal_on_a_disk_that_takes_nothing_is_read_all_the_same(tmp_path: Path) -> None:
    path = tmp_path / "journal.sqlite"
    journal = Journal(path)
    journal.begin_run("run-1", "sha256:1", "somebody")
    journal.close()
    for name in ("-wal", "-shm"):
        path.with_name(path.name + name).mkdir()  # as on a full disk: it can't make its files
    with pytest.raises(PicoError, match=r"journal\.sqlite-wal cannot be read: it is a folder"):
        Journal(path)
    read = Journal(path, looking=True)
    assert [run.run for run in read.runs()] == ["run-1"]
    read.close()


@pytest.mark.parametrize("fence", [0, 4, 5, 6])
@pytest.mark.parametrize("kind", ["intent", "started", "ended"])
def test_who_has_an_earlier_lease_than_the_fence_writes_nothing(journal: Journal, fence: int, kind: str) -> None:
    def write(token: int) -> None:
        if kind == "intent":
            journal.intend("r1/op1/1", MOVE, token=token)
        elif kind == "started":
            journal.started("r1/op1/1", SEEN, token=token)
        else:
            journal.ended(DONE, token=token)

    if kind != "intent":
        journal.intend("r1/op1/1", MOVE, token=0)
    if kind == "ended":
        journal.started("r1/op1/1", SEEN, token=0)
    before = journal.records(run="r1")
    journal.fence(fence)
    if fence <= 5:
        write(5)
        assert [r.token for r in journal.records(run="r1")[len(before) :]] == [5]
    else:
        with pytest.raises(PicoError, match="the lease 5 is not the current one") as caught:
            write(5)
        assert caught.value.exit_code == ExitCode.LOCKED and journal.records(run="r1") == before


def test_a_fence_only_rises(journal: Journal) -> None:
    journal.fence(5)
    journal.fence(5)
    with pytest.raises(PicoError, match="the lease 4 is not the current one") as caught:
        journal.fence(4)
    assert caught.value.exit_code == ExitCode.LOCKED
    with pytest.raises(PicoError, match="the lease 4"):
        journal.intend("r1/op1/1", MOVE, token=4)
    journal.fence(6)
    with pytest.raises(PicoError, match="the lease 5"):
        journal.intend("r1/op1/1", MOVE, token=5)


@pytest.mark.parametrize("looking", [False, True])
def test_a_journal_that_was_emptied_just_now_is_damaged_and_no_new_one(tmp_path: Path, looking: bool) -> None:
    path = tmp_path / "journal.sqlite"
    with closing(Journal(path)) as journal:
        journal.begin_run("r1", "", "somebody")
    for left in path.parent.glob("journal.sqlite*"):
        left.write_bytes(b"")
    with pytest.raises(PicoError, match="the file is empty") as caught:
        Journal(path, looking=looking)
    assert "`pico doctor --journal`" in caught.value.diagnostics[0].hint
    assert path.stat().st_size == 0, "nothing is written into it"


def test_a_journal_that_is_being_made_is_never_seen_empty_and_made_once(tmp_path: Path) -> None:
    path, sizes, done = tmp_path / "journal.sqlite", list[int](), threading.Event()

    def watch() -> None:
        while not done.is_set():
            if path.exists():
                sizes.append(path.stat().st_size)

    def begin(number: int) -> None:
        with closing(Journal(path)) as journal:
            journal.begin_run(f"r{number}", "", "somebody")

    with ThreadPoolExecutor(9) as pool:
        watching = pool.submit(watch)
        for made in [pool.submit(begin, number) for number in range(8)]:
            made.result()
        done.set()
        watching.result()
    assert sizes and min(sizes) > 0
    with closing(Journal(path)) as journal:
        assert {run.run for run in journal.runs()} == {f"r{number}" for number in range(8)}
    assert not list(tmp_path.glob(".*")), "nothing is left beside it"


def test_a_process_that_was_killed_while_it_made_a_journal_leaves_none(tmp_path: Path) -> None:
    path = tmp_path / "journal.sqlite"
    killed = "import os, pico.base.database as d; d.os.link = lambda *_: os.kill(os.getpid(), 9)"
    code = f"{killed}\nfrom pathlib import Path\nfrom pico.runs.journal import Journal\nJournal(Path({str(path)!r}))"
    assert subprocess.run([sys.executable, "-c", code], check=False, capture_output=True).returncode == -9
    assert not path.exists() and list(tmp_path.glob(".*"))
    Journal(path).close()
    assert not list(tmp_path.glob(".*")), "what it left is cleared"

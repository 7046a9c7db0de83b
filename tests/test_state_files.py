"""The registry of what PICO keeps on disk: it is complete, it is documented, and no damage of a file is silent."""

from __future__ import annotations

import json
import re
import runpy
import shutil
import sqlite3
import subprocess
from collections.abc import Callable, Iterator
from contextlib import closing
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico

from pico.base import state_files
from pico.base.formats import Format
from pico.base.plain_files import read_text
from pico.base.state_file import StateFile
from pico.base.state_files import ALL, entry_of, files_below
from pico.bench.mending.files import damaged_files
from pico.diagnostics import PicoError
from pico.edge import dose, stopping, terms_store
from pico.edge.lease import BenchLock
from pico.model.operation import Operation, Reason
from pico.places.bench import BenchPlace
from pico.places.record import read_record
from pico.recipes.log import About, Log
from pico.runs.damage import FromCommit
from pico.runs.journal import Journal
from pico.runs.salvage import Examined, Salvage, examine, salvage, write_journal
from pico.runs.storage.change_count import ChangeCount

ROOT = Path(__file__).resolve().parent.parent
JSON = [file for file in ALL if not file.text]
ELSEWHERE = {
    "benches/BENCH/dose.json": "samples", "benches/BENCH/unattended.json": "unattended runs",
    "benches/BENCH/unattended.lock": "unattended runs", "benches/BENCH/armed/LASER.json": "lasers that are armed",
    ".git/pico/armed/DIGEST": "lasers that are armed", "benches/BENCH/mornings.json": "light on a detector",
    "benches/BENCH/recipes/RUN.jsonl": "recipes", "benches/BENCH/recipes/RUN.out": "detached recipes",
    "benches/BENCH/recipes/RUN.lines": "recipes",
    "benches/BENCH/recipes/RUN.pid": "detached recipes", "benches/BENCH/points/KEY.jsonl": "searches under way",
    "benches/BENCH/run": "runs under way", "benches/BENCH/holder.json": "runs under way",
    "benches/BENCH/called.json": "runs under way", "benches/BENCH/seen.json": "cameras that look",
    "benches/BENCH/hands.json": "hands that are felt", "benches/BENCH/settings.json": "devices",
    "benches/BENCH/devices.json": "devices", "benches/BENCH/enrolment.json": "coordinators",
    "benches/BENCH/gate.sqlite": "coordinators", "benches/BENCH/edge.json": "served benches",
    "benches/HOST/LAB/BENCH/session": "coordinators", "benches/HOST/LAB/BENCH/runs": "coordinators",
    "benches/HOST/LAB/BENCH/detached": "coordinators", "benches/BENCH/replaced/**": "attachments",
    "benches/BENCH/incoming/**": "attachments", "claims.json": "claims", "benches/layout.json": "old layouts",
    "unsorted/**": "old layouts", "earlier-N/**": "old layouts", "splitting/**": "old layouts",
    "split.lock": "old layouts", "cas/**": "labs outside Git", "gui/**": "the page",
    ".git/pico/[LAB-]/remotes.json": "coordinators", ".git/pico/[LAB-]/gui.lock": "the page",
    ".git/pico/cas/**": "measurements", ".git/pico/COMMIT_EDITMSG": "editors", "benches/BENCH/stop.json": "stops",
    "benches/BENCH/calibrating.json": "calibrations", "benches/BENCH/calibrating/**": "calibrations",
    "benches/BENCH/guard.json": "lasers with devices", "benches/BENCH/table-lock.json": "people at the table",
}  # fmt: skip
"""Entries that the session below leaves no file of, each with what does."""


def session(pico: Pico) -> None:
    """Do what a day at the bench does."""
    for words in (
        "bench use sim", "apply --fidelity kinematic --auto-approve", "commit -m base", "sim faults drop=0.0",
        "set p1 angle=3 --yes", "undo --yes", "status", "drift", "runs list",
    ):  # fmt: skip
        answer = pico(*words.split())
        assert answer.code in (0, 2), (words, answer.err)


@pytest.fixture(scope="module")
def day(case_study: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The example after a day at its simulated bench, to be copied."""
    from contextlib import chdir, redirect_stderr, redirect_stdout
    from io import StringIO

    from commanding import Answer
    from pico_cli.main import main

    root = Path(shutil.copytree(case_study, tmp_path_factory.mktemp("day") / "shel"))

    def call(*words: str) -> Answer:
        with redirect_stdout(StringIO()) as out, redirect_stderr(StringIO()) as err:
            code = main(words)
        return Answer(int(code), out.getvalue(), err.getvalue())

    with pytest.MonkeyPatch.context() as patch, chdir(root):
        for who in ("AUTHOR", "COMMITTER"):
            patch.setenv(f"GIT_{who}_NAME", "A Physicist")
            patch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
        session(call)
    yield root


@pytest.fixture
def lab(day: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    root = Path(shutil.copytree(day, tmp_path / "shel"))
    monkeypatch.chdir(root)
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "A Physicist")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
    return root


# the registry


def test_every_file_of_a_day_at_the_bench_is_in_the_registry_and_every_entry_occurs_or_is_explained(lab: Path) -> None:
    found = {name: entry for _, name, entry in files_below(lab)}
    assert [name for name, entry in found.items() if entry is None] == []
    git = {p.relative_to(lab).as_posix() for p in (lab / ".git/pico").rglob("*") if p.is_file()}
    assert [name for name in git if entry_of(name) is None] == []
    seen = {entry.pattern for entry in found.values() if entry} | {e.pattern for n in git if (e := entry_of(n))}
    assert {file.pattern for file in ALL} - seen - ELSEWHERE.keys() == {"**.damaged**"}
    assert damaged_files(lab, Log.read) == ()


def test_what_is_written_of_a_file_that_no_session_leaves_is_by_its_entry() -> None:
    """So that an entry that occurs nowhere any more is noticed: its constant is used outside the registry."""
    library = "\n".join(
        path.read_text()
        for top in ("pico", "cli")
        for path in (ROOT / top).rglob("*.py")
        if path.name != "state_files.py"
    )
    constants = {name: one for name, one in vars(state_files).items() if isinstance(one, StateFile)}
    assert set(constants.values()) == set(ALL)
    plain = {name for name, one in constants.items() if not one.text}
    assert [name for name in sorted(plain) if not re.search(rf"\b{name}\b", library)] == []


def test_no_module_names_a_state_file_of_its_own() -> None:
    names = {file.name for file in JSON if "LASER" not in file.name}
    old = {"places/layout.py", "places/sorting.py", "places/splitting.py", "places/attachment.py"}
    own = [
        f"{path.relative_to(ROOT)}: {name}"
        for top in ("pico", "cli")
        for path in (ROOT / top).rglob("*.py")
        if path.name != "state_files.py" and not any(str(path).endswith(one) for one in old)
        for name in names
        if f'/ "{name}"' in path.read_text()
    ]
    assert own == [], "take the entry of pico/base/state_files.py"


def test_the_page_of_state_files_is_as_the_registry_has_it() -> None:
    made = runpy.run_path(str(ROOT / ".ci" / "state_files.py"))
    assert (ROOT / "docs/reference/state-files.md").read_text() == made["page"](), "run `make docs`"


def test_every_entry_says_what_is_lost_and_how_to_go_on() -> None:
    for file in ALL:
        assert file.holds and file.writer
        if file.kind in ("record", "safety"):
            assert file.lost or file is state_files.STOP, file.pattern
        if file.kind in ("record", "safety") and not file.text:
            assert "`" in file.remedy or "delete it" in file.remedy, file.pattern


# one file


@pytest.mark.parametrize("file", JSON, ids=lambda file: file.pattern)
def test_whatever_befalls_a_json_file_is_noticed(tmp_path: Path, file: StateFile) -> None:
    path = tmp_path / file.name
    document = {"a": 1.5, "b": ["x", {"c": None}], "größe": "µ"}
    file.write(path, document)
    assert file.read(path, dict) == document | ({"schema": file.schema} if file.format else {})
    whole = path.read_bytes()
    json.loads(whole)  # it stays JSON for whoever looks
    body = whole.index(b", ") + 2
    damages = [whole[:cut] for cut in range(0, len(whole) - 2, 7)]
    for at in range(body, len(whole) - 1):
        damages.append(whole[:at] + bytes([whole[at] ^ (1 << at % 8)]) + whole[at + 1 :])
    for data in damages:
        path.write_bytes(data)
        wrong = file.wrong(path)
        assert wrong is not None, data
        assert str(path) in wrong.summary and wrong.hint and wrong.detail
        if file.kind in ("record", "safety"):
            with pytest.raises(PicoError) as refused:
                file.read(path, dict)
            assert refused.value.diagnostics[0] == wrong
        else:
            assert file.read(path, dict) is None


def test_a_file_of_before_the_checksums_is_read_and_one_of_a_newer_version_is_refused(tmp_path: Path) -> None:
    file = StateFile("a.json", "record", "x", "y", "z", "`mv {path} b`", Format("pico.a"))
    path = tmp_path / "a.json"
    path.write_text('{"schema": "pico.a/v1", "n": 1}')
    assert file.read(path, lambda found: found["n"]) == 1
    path.write_text('{"n": 2, "schema": "pico.a/v1", "sha256": "carried along by an earlier version"}')
    assert file.read(path, dict) == {"schema": "pico.a/v1", "n": 2}
    plain = StateFile("b.json", "record", "x", "y", "z", "`mv {path} b`")
    for text in ("{}", '{"": 1}', '{"sha": 1}'):
        path.write_text(text)
        assert plain.read(path, dict) == json.loads(text)
    path.write_text('{"schema": "pico.a/v2"}')
    with pytest.raises(PicoError, match="newer PICO") as refused:
        file.read(path, dict)
    assert refused.value.diagnostics[0].hint.startswith("upgrade PICO")


def test_what_keeps_people_safe_is_never_read_as_nothing(tmp_path: Path) -> None:
    place = BenchPlace(tmp_path, "sim")
    place.own.mkdir(parents=True)
    (place.own / "dose.json").write_text("{")
    with pytest.raises(PicoError, match=r"dose\.json"):
        dose.read(place)
    (place.own / "unattended.json").write_text("{")
    terms = terms_store.read(place)
    assert terms is not None and set(terms.end) == {"shut", "lamps off"} and terms.left is None
    (place.own / "stop.json").write_text("{")
    assert stopping.asked_to_stop(place, 1) == "now"
    with BenchLock(place).held("test"):  # what lay there before a lease is not for it
        assert stopping.asked_to_stop(place, 1) is None


def test_the_token_of_a_damaged_lock_is_above_all_that_were_given(tmp_path: Path) -> None:
    place = BenchPlace(tmp_path, "sim")
    with BenchLock(place).held("one") as first:
        assert first.token == 1
    lock = place.own / "lock"
    whole = lock.read_bytes()
    for at in range(len(whole.partition(b"\n")[0].strip())):
        lock.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        assert BenchLock(place).last_token() > 1_000_000_000
    lock.write_bytes(b"%-31d\n" % 41)  # as an earlier version wrote it
    assert BenchLock(place).last_token() == 41


def test_a_damaged_record_of_worktrees_is_named_and_not_read_as_none(lab: Path) -> None:
    from pico.places.lab import lab_place

    place = lab_place(lab)
    assert place is not None and read_record(place)
    place.record.write_bytes(place.record.read_bytes()[:-9])
    with pytest.raises(PicoError, match=r"bench\.json") as refused:
        read_record(place)
    assert "git attach" in refused.value.diagnostics[0].hint


# a lab with a damaged file


def flipped(path: Path, share: float) -> None:
    data = bytearray(path.read_bytes())
    data[min(int(share * len(data)), len(data) - 1)] ^= 4
    path.write_bytes(data)


DAMAGES: dict[str, Callable[[Path], object]] = {
    "flip": lambda path: flipped(path, 0.6),
    "cut": lambda path: path.write_bytes(path.read_bytes()[: path.stat().st_size // 2]),
    "empty": lambda path: path.write_bytes(b""),
    "gone": lambda path: path.unlink(),
}
FILES = ("world.json", "lab.json", "faults.json", "journal.sqlite", "lock")


@pytest.mark.parametrize("how", DAMAGES)
@pytest.mark.parametrize("name", FILES)
def test_a_damaged_file_of_a_bench_is_named_with_a_way_on_or_harmless(
    lab: Path, pico: Pico, name: str, how: str
) -> None:
    path = lab / ".pico/benches/sim" / name
    DAMAGES[how](path)
    answer = pico("plan", "e1", "--json")
    assert "internal" not in answer.err and "Traceback" not in answer.err
    if answer.code not in (0, 2):
        found = json.loads(answer.out)["diagnostics"] if answer.out.startswith("{") else []
        said = answer.out + answer.err
        assert (name in said and "`pico " in said) or "`mv " in said, (found, said)
    doctor = pico("doctor")
    assert "internal" not in doctor.err
    if how in ("cut", "empty") and name != "lock":
        assert name in doctor.err and doctor.code == 1


@pytest.mark.parametrize("name", ["chosen.json", "audit.json"])
def test_a_damaged_file_of_a_lab_is_named_or_made_anew(lab: Path, pico: Pico, name: str) -> None:
    path = lab / ".pico" / name
    flipped(path, 0.8)
    answer = pico("plan", "e1")
    if name == "audit.json":
        assert answer.code in (0, 2)
        assert json.loads(path.read_text())["audit"], "the cache is made anew"
    else:
        assert answer.code == 1 and str(path) in answer.err and "`pico bench use sim`" in answer.err
        assert pico("bench", "use", "sim").code == 0 and pico("plan", "e1").code == 0


# the journal


def spoil(path: Path, sql: str) -> None:
    with closing(sqlite3.connect(path)) as db:
        db.execute(sql)
        db.commit()


@pytest.fixture
def committed(lab: Path, pico: Pico) -> Path:
    """The lab with all its runs in commits."""
    assert pico("commit", "-m", "all").code == 0
    with closing(sqlite3.connect(lab / ".pico/benches/sim/journal.sqlite")) as db:
        db.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    return lab


def test_a_flipped_bit_in_a_record_that_a_commit_has_stops_nothing(committed: Path, pico: Pico) -> None:
    path = committed / ".pico/benches/sim/journal.sqlite"
    with closing(Journal(path, looking=True)) as journal:
        before = journal.records()
        runs = journal.runs()
    data = bytearray(path.read_bytes())
    at = data.find(b'{"status', 20000)
    assert at > 0
    data[at + 1] ^= 1
    path.write_bytes(data)
    for words in ("plan e1", "drift", "set p1 angle=4 --yes", "undo --yes", "commit -m x --allow-empty"):
        answer = pico(*words.split())
        assert "internal" not in answer.err and answer.code in (0, 1, 2), (words, answer.err)
        assert "damaged" not in answer.err, words
    doctor = pico("doctor")
    assert "journal-record" in doctor.err and "reads the run from its commit" in doctor.err
    assert pico("doctor", "--journal").code == 2
    done = pico("doctor", "--journal", "--yes", "--json")
    assert done.code == 0 and done.data["lost"] == [] and len(done.data["from_commits"]) == 1
    assert Path(done.data["aside"]).exists()
    with closing(Journal(path, looking=True)) as journal:
        after = journal.records()[: len(before)]
        assert [run.run for run in journal.runs()][: len(runs)] == [run.run for run in runs]
    assert [(r.key, r.kind, r.component) for r in after] == [(r.key, r.kind, r.component) for r in before]
    assert pico("doctor").err.count("journal") == 0


@pytest.mark.parametrize("kind", ["intent", "started", "done"])
def test_each_kind_of_record_is_taken_from_its_commit(committed: Path, kind: str) -> None:
    path = committed / ".pico/benches/sim/journal.sqlite"
    with closing(Journal(path, looking=True)) as journal:
        before = journal.records()
    seq = next(r.seq for r in before if r.kind == kind)
    spoil(path, f"UPDATE records SET data = replace(data, '1', '7'), component = 'x' WHERE seq = {seq}")
    with closing(Journal(path)) as journal:
        after = journal.records()
    was, now = (next(r for r in rows if r.seq == seq) for rows in (before, after))
    leave: set[str] = {"ended"}  # of the bench's clock, which commits count from the first operation
    assert (now.key, now.kind, now.component, now.digest) == (was.key, was.kind, was.component, was.digest)
    assert {k: v for k, v in now.data.items() if k not in leave} == {
        k: v for k, v in was.data.items() if k not in leave
    }


def test_a_damaged_record_that_no_commit_has_stops_what_moves_and_is_named(lab: Path, pico: Pico) -> None:
    path = lab / ".pico/benches/sim/journal.sqlite"
    with closing(Journal(path, looking=True)) as journal:
        last = journal.runs()[-1].run
    spoil(path, f"UPDATE records SET data = replace(data, '3', '8') WHERE run = '{last}' AND phase = 0")
    for words in (("set", "p1", "angle=4", "--yes"), ("undo", "--yes"), ("commit", "-m", "x")):
        answer = pico(*words)
        assert answer.code != 0 and last in answer.err and "`pico doctor --journal`" in answer.err, answer.err
        assert "the bench sim" in answer.err and "internal" not in answer.err
    would = pico("doctor", "--journal")
    assert would.code == 2 and last in would.out and "lost" in would.out
    done: Any = pico("doctor", "--journal", "--yes", "--json").data
    assert [one["run"] for one in done["lost"]] == [last]
    assert pico("set", "p1", "angle=4", "--yes").code == 0


def test_a_damaged_plan_of_a_run_is_never_undone(committed: Path, pico: Pico) -> None:
    path = committed / ".pico/benches/sim/journal.sqlite"
    assert pico("set", "p1", "angle=5", "--yes").code == 0
    spoil(
        path, "UPDATE runs SET document = replace(document, '90', '80') WHERE number = (SELECT max(number) FROM runs)"
    )
    answer = pico("undo", "--yes")
    assert answer.code == 1 and "damaged" in answer.err and "`pico doctor --journal`" in answer.err


def test_a_journal_that_is_no_database_is_made_of_commits(committed: Path, pico: Pico) -> None:
    path = committed / ".pico/benches/sim/journal.sqlite"
    with closing(Journal(path, looking=True)) as journal:
        runs = [run.run for run in journal.runs() if run.run in journal.moving()]
    path.write_bytes(b"no database, " * 4000)
    answer = pico("plan", "e1")
    assert answer.code == 1 and "`pico doctor --journal`" in answer.err
    done = pico("doctor", "--journal", "--yes", "--json")
    assert done.code == 0 and set(done.data["from_commits"]) == set(runs)
    assert pico("plan", "e1").code == 0 and pico("undo", "--yes").code in (0, 1)
    with closing(Journal(path, looking=True)) as journal:
        assert [run.run for run in journal.runs()][: len(runs)] == runs


def test_a_damaged_file_of_another_bench_is_mended_by_what_is_printed(lab: Path, pico: Pico) -> None:
    """The chosen bench is the simulator; what doctor says of the emulated one must reach that one."""
    folder = lab / ".pico/benches/emulated"
    shutil.copytree(lab / ".pico/benches/sim", folder)
    (folder / "lab.json").write_text("{")
    (folder / "journal.sqlite").write_bytes(b"x" * 4096)
    said = pico("doctor")
    assert said.code == 1
    assert "`pico --bench emulated doctor --journal`" in said.err
    assert "`pico --bench emulated bench update`" in said.err
    mended = pico("--bench", "emulated", "doctor", "--journal", "--yes")
    assert mended.code == 0 and "journal" not in pico("doctor").err
    assert (folder / "journal.sqlite.damaged").exists()
    assert not (lab / ".pico/benches/sim/journal.sqlite.damaged").exists()


def test_a_journal_of_version_3_is_lifted_and_its_records_count_without_checksums(lab: Path, pico: Pico) -> None:
    path = lab / ".pico/benches/sim/journal.sqlite"
    with closing(sqlite3.connect(path)) as db:
        db.executescript(
            "DROP TRIGGER INSERT_records; DROP TRIGGER INSERT_runs; DROP TRIGGER UPDATE_runs;"
            "ALTER TABLE fence DROP COLUMN changes;"
            "ALTER TABLE runs DROP COLUMN checksum; ALTER TABLE records DROP COLUMN checksum; PRAGMA user_version=3;"
        )
    path.with_name("changes").unlink()
    assert pico("doctor").code == 0
    assert pico("undo", "--yes").code == 0 and pico("doctor").code == 0
    with closing(sqlite3.connect(path)) as db:
        assert db.execute("PRAGMA user_version").fetchone() == (5,)
        known = {row[0] is None for row in db.execute("SELECT checksum FROM records")}
    assert known == {True, False}


def test_a_journal_that_lacks_the_run_that_was_killed_stops_what_moves_until_it_is_salvaged(
    lab: Path, pico: Pico
) -> None:
    """SQLite passes over a log that is gone or cut off in silence."""
    path, run = lab / ".pico/benches/sim/journal.sqlite", "20261127T120000Z-aaaaaa"
    path.with_name("run").write_text(f"{run}\n")
    for words in ("plan e1", "set p1 angle=4 --yes", "undo --yes", "recover --yes"):
        answer = pico(*words.split())
        assert answer.code == 1 and run in answer.err and "`pico doctor --journal`" in answer.err, answer.err
        assert str(path) in answer.err
    assert run in pico("doctor").err
    done = pico("doctor", "--journal", "--yes", "--json")
    assert done.code == 0 and [one["run"] for one in done.data["lost"]] == [run]
    assert pico("doctor").code == 0 and pico("set", "p1", "angle=4", "--yes").code == 0


def test_a_deleted_journal_of_a_run_that_was_killed_is_made_of_commits(committed: Path, pico: Pico) -> None:
    path, run = committed / ".pico/benches/sim/journal.sqlite", "20261127T120000Z-aaaaaa"
    path.with_name("run").write_text(f"{run}\n")
    path.unlink()
    answer = pico("apply", "e1", "--yes")
    assert answer.code == 1 and run in answer.err and not path.exists()
    done = pico("doctor", "--journal", "--yes", "--json")
    assert done.code == 0 and [one["run"] for one in done.data["lost"]] == [run]
    assert done.data["from_commits"] and pico("apply", "e1", "--yes").code == 0


def test_a_deleted_journal_is_missed_whatever_is_asked(committed: Path, pico: Pico) -> None:
    path = committed / ".pico/benches/sim/journal.sqlite"
    path.unlink()
    for words in ("resume --yes", "undo --yes", "set p1 angle=4 --yes"):
        said = pico(*words.split())
        assert said.code == 1 and "the file is gone" in said.err and "`pico doctor --journal`" in said.err, said.err
    assert pico("doctor", "--journal", "--yes").code == 0 and pico("doctor").code == 0
    assert pico("set", "p1", "angle=4", "--yes").code == 0


def test_salvage_keeps_a_finished_run_that_no_commit_has_if_its_records_are_there(lab: Path, pico: Pico) -> None:
    path = lab / ".pico/benches/sim/journal.sqlite"
    assert pico("set", "p1", "angle=4", "--yes").code == 0 and pico("apply", "e1", "--yes").code == 0
    with closing(Journal(path, looking=True)) as journal:
        (*_, before, last) = journal.runs()
    assert "seconds" in last.tally
    count = ChangeCount(path)
    count.note(10**6, durable=True)  # as of a log that lost its end
    count.close()
    found = pico("doctor", "--journal", "--yes", "--json")
    assert found.code == 0 and not {before.run, last.run} & {one["run"] for one in found.data["lost"]}, found.out
    with closing(Journal(path, looking=True)) as journal:
        assert [one.run for one in journal.runs()][-2:] == [before.run, last.run]


def test_salvage_numbers_runs_anew_if_damaged_rows_share_a_number(tmp_path: Path) -> None:
    old, new = tmp_path / "old.sqlite", tmp_path / "new.sqlite"
    with closing(Journal(old)) as journal:
        for number in range(3):
            journal.begin_run(f"run{number}", "plan", "test")
    rows = examine(old).runs
    same = [(rows[1][0], *rows[0][1:]), rows[1], (None, *rows[2][1:])]
    write_journal(Salvage(same, [], 0, 3, (), ()), new)
    with closing(Journal(new)) as journal:
        assert [(one.number, one.run) for one in journal.runs()] == [(1, "run0"), (2, "run1"), (3, "run2")]


def test_salvage_takes_a_run_once_that_commits_hold_and_a_torn_journal_in_part(tmp_path: Path) -> None:
    with closing(Journal(tmp_path / "old.sqlite")) as journal:
        journal.begin_run("run0", "plan", "test")
    (row,) = examine(tmp_path / "old.sqlite").runs
    held = FromCommit(row[:9], (), None, ())
    record = (1, "run0/a/1", "run0", 0, "intent", "p1", "", 1, "now", "{}", None)
    torn = Examined([], [record], broken="torn")  # its row is gone, a record of it is not
    made = salvage(torn, lambda run: held, ["run0"])
    assert [one[1] for one in made.runs] == ["run0"] and made.from_commits == ("run0",) and made.intact == 0
    write_journal(made, tmp_path / "new.sqlite")


def test_salvage_keeps_a_record_once_that_a_torn_journal_holds_twice(tmp_path: Path) -> None:
    with closing(Journal(tmp_path / "old.sqlite")) as journal:
        journal.begin_run("run0", "plan", "test")
        operation = Operation(id="a", primitive="set", component="p1", reason=Reason(kind="changed"))
        journal.intend("run0/a/1", operation, 1)
    whole = examine(tmp_path / "old.sqlite")
    (row,) = whole.records
    head = whole.runs[0]
    torn = Examined([head], [row, (2, *row[1:])], broken="torn")
    made = salvage(torn, lambda run: FromCommit(head[:9], (), None, ()), [])
    assert [one[1] for one in made.runs] == ["run0"] and made.records == [row]
    write_journal(made, tmp_path / "new.sqlite")
    with closing(Journal(tmp_path / "new.sqlite")) as journal:
        assert [one.key for one in journal.records(run="run0")] == ["run0/a/1"]


def test_a_damaged_mark_of_a_run_that_has_not_ended_stops_nothing(tmp_path: Path) -> None:
    path = tmp_path / "journal.sqlite"
    with closing(Journal(path)) as journal:
        journal.begin_run("20261127T120000Z-aaaaaa", "plan", "test")
    path.with_name("run").write_text("20261127T120000Z-aaaaab\n")
    with closing(Journal(path)) as journal:
        assert len(journal.runs()) == 1


def test_a_damaged_log_beside_a_journal_is_noticed_and_one_that_was_cut_off_is_read(tmp_path: Path) -> None:
    log = tmp_path / "journal.sqlite-wal"
    with closing(Journal(tmp_path / "journal.sqlite")) as journal:
        for number in range(8):
            journal.begin_run(f"run{number}", "plan", "test")
        base, whole = journal.path.read_bytes(), log.read_bytes()

    count = (tmp_path / "changes").read_bytes()

    def runs(data: bytes, counted: bytes = b"") -> int:
        for path in tmp_path.iterdir():
            path.unlink()
        (tmp_path / "changes").write_bytes(counted)
        (tmp_path / "journal.sqlite").write_bytes(base)
        log.write_bytes(data)
        with closing(Journal(tmp_path / "journal.sqlite", looking=True)) as journal:
            return len(journal.runs())

    assert runs(whole) == 8
    assert runs(whole[:-5000]) < 8  # as after a power failure: no later record was on the disk
    assert runs(whole, count) == 8
    for less in (1, 5000, len(whole) // 2, len(whole)):
        with pytest.raises(PicoError, match=r"its last .* changes are missing") as refused:
            runs(whole[: len(whole) - less], count)
        assert "`pico doctor --journal`" in refused.value.diagnostics[0].hint
        assert "changes are missing" in examine(tmp_path / "journal.sqlite").broken
    assert runs(whole[:-5000], count[:3] + b"9" + count[4:]) < 8, "a damaged count counts for nothing"
    for at in (0, 20, 40, 100, len(whole) // 2, len(whole) - 40000):
        with pytest.raises(PicoError, match=r"write-ahead log is damaged.*journal\.sqlite") as refused:
            runs(whole[:at] + bytes([whole[at] ^ 8]) + whole[at + 1 :])
        assert "`pico doctor --journal`" in refused.value.diagnostics[0].hint
        assert "log is damaged" in examine(tmp_path / "journal.sqlite").broken


def test_a_flipped_bit_in_the_log_of_a_recipe_is_noticed_and_named_with_a_way_on(lab: Path, pico: Pico) -> None:
    log = Log.begin(BenchPlace(lab, "sim"), About("20261127T120000Z-aaaaaa", "x", "recipes/x.yaml", "d", {}, {}, "now"))
    log.begun("1", {"set": 12}, (None, None), "set")
    whole = log.path.read_bytes()
    assert set(Log.read(log.path).steps) == {"1"} and pico("doctor").code == 0
    log.path.write_bytes(whole[: whole.index(b"\n") + 1])  # a line is missing, and those that are left are sound
    with pytest.raises(PicoError, match="its last line is missing"):
        Log.read(log.path)
    assert str(log.path) in pico("doctor").err
    count = log.path.with_suffix(".lines")
    before = count.read_bytes()
    count.unlink()
    assert Log.read(log.path).steps == {}, "of a run of an earlier PICO nobody counted the lines"
    count.write_bytes(before)
    for at in (0, whole.index(b"recipes/x"), whole.index(b'"given": "') + 12, len(whole) - 20):
        log.path.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        with pytest.raises(PicoError, match=r"aaaaaa\.jsonl"):
            Log.read(log.path)
    log.path.write_bytes(b"")
    doctor = pico("doctor")
    assert doctor.code == 1 and f"`mv {log.path} {log.path}.damaged`" in doctor.err
    log.path.rename(f"{log.path}.damaged")
    assert pico("doctor").code == 0


def test_a_log_that_is_written_to_while_it_is_read_has_lost_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    about = About("20261127T120000Z-aaaaaa", "x", "recipes/x.yaml", "d", {}, {}, "now")
    log = Log.begin(BenchPlace(tmp_path, "sim"), about)

    def read_then_written(path: Path, encoding: str = "utf-8") -> str:
        text = read_text(path, encoding)
        if path == log.path:
            log.begun("1", {"set": 12}, (None, None), "set")
        return text

    monkeypatch.setattr("pico.recipes.log.read_text", read_then_written)
    assert Log.read(log.path).steps == {}


def test_git_has_nothing_of_it(lab: Path) -> None:
    said = subprocess.run(["git", "status", "--porcelain"], cwd=lab, capture_output=True, text=True, check=True)
    assert ".pico" not in said.stdout


@pytest.mark.slow
@pytest.mark.skipif(not (find_spec("xarm") and find_spec("ElliptecBus")), reason="the extras xarm and thorlabs")
def test_light_recipes_searches_and_devices_leave_only_files_of_the_registry(
    lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PICO_EMULATED_PACE", "10")
    shutil.copy(ROOT / "examples" / "devices.yaml", lab)
    (lab / "recipes" / "short.yaml").write_text(
        "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: short}\nsteps:\n  - set: {p1.angle: 5}\n"
    )
    for words in (
        "apply --fidelity kinematic --auto-approve", "measure cam.image", "measure cam.centroid", "run short --yes",
        "optimize null p2 cam --yes", "morning --yes --accept", "stop", "undo --yes",
        "--backend hardware --emulate set p1 angle=4 --yes", "--backend hardware --emulate look",
    ):  # fmt: skip
        answer = pico(*words.split())
        assert "internal" not in answer.err, (words, answer.err)
    strange = [name for _, name, entry in files_below(lab) if entry is None]
    git = {p.relative_to(lab).as_posix() for p in (lab / ".git/pico").rglob("*") if p.is_file()}
    assert strange == [] and [name for name in git if entry_of(name) is None] == []
    seen = {entry.pattern for _, _, entry in files_below(lab) if entry}
    assert {"benches/BENCH/recipes/RUN.jsonl", "benches/BENCH/seen.json"} <= seen
    assert damaged_files(lab, Log.read) == ()


def test_after_a_journal_that_was_gone_is_salvaged_new_runs_are_undone_and_nothing_is_resumed(
    committed: Path, pico: Pico
) -> None:
    (committed / ".pico/benches/sim/journal.sqlite").unlink()
    done = pico("doctor", "--journal", "--yes")
    assert done.code == 0 and ".damaged" not in done.out and "no old one to set aside" in done.out, done.out
    nothing = pico("resume", "--yes")
    assert nothing.code == 1 and "nothing-to-resume" in nothing.err, nothing.err
    assert pico("set", "p1", "angle=4", "--yes").code == 0
    resumed = pico("resume", "--yes")
    assert resumed.code == 1 and "nothing-to-resume" in resumed.err, resumed.err
    undone = pico("undo", "--yes")
    assert undone.code == 0 and "4 → " in undone.out, (undone.out, undone.err)
    assert pico("redo", "--yes").code == 0

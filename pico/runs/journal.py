"""The write-ahead record of operations: what was meant, what began, and what became of it.

SQLite in `.pico/journal.sqlite`, WAL with synchronous=FULL: a record is on the disk when its function returns, an
`intent` at the latest with the `started` that follows, for the log is written in order. Each
attempt at an operation has a key, `run id/operation id/attempt`, and at most four records: `intent` before anything,
`started` before motion, one of `done`, `failed` and `unknown` before anyone hears of it; after an `unknown` one
`resolved`, once an observation or a person says how it ended. Records are only added, in the order of their numbers:
times are for people, for a clock can be set back.
"""

from __future__ import annotations

import errno
import json
import os
import sqlite3
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal, cast

from pico.base.clock import now_ms
from pico.base.database import EMPTY, is_emptied, make_database
from pico.base.plain_files import other_than_file
from pico.base.state_files import JOURNAL
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.disk import refusing, unwritable
from pico.model.observation import ObservedComponent, observed_from_json
from pico.model.operation import Operation, OperationResult, Outcome, operation_from_json, result_from_json
from pico.model.record import as_json, digest, record
from pico.model.trace.run import RunOutcome
from pico.runs.damage import (
    PHASES,
    SALVAGE,
    FromCommit,
    checksum,
    damaged_row,
    from_commit,
    is_sound_head,
    is_sound_part,
    is_sound_record,
    lost_end,
    marked_run,
    sums_of_run,
)
from pico.runs.storage.change_count import ChangeCount
from pico.runs.storage.journal_tables import HEAD, ROW, SCRIPTS, VERSION
from pico.runs.storage.write_ahead import lost_transactions
from pico.version import upgrade_hint

RecordKind = Literal["intent", "started", "done", "failed", "unknown", "resolved"]

MEMORY = ":memory:"
"""The path of a journal that is kept nowhere."""
RECENT = 2000
"""So many records are checked before anything is written, and with them anything moves."""
SMALL = 1000
"""Pages of a journal up to which its indices are checked then, too."""


@record
class JournalRecord:
    """One record. `data`: the operation of an `intent`, the observed component of a `started`, the result of an end;
    of a `resolved`, `outcome`, `by` and the observed component (`after`)."""

    seq: int
    key: str
    kind: RecordKind
    component: str
    digest: str
    token: int
    at: str
    data: Mapping[str, Any]


@record
class RunRecord:
    """One run. `finished_at`, `outcome` and `tally` are None while it goes on, or where it was killed. `resumed`: how
    often it was taken up again. `number` counts the runs of the bench."""

    run: str
    plan: str
    holder: str
    started_at: str
    finished_at: str | None = None
    outcome: RunOutcome | None = None
    tally: Mapping[str, Any] | None = None
    resumed: int = 0
    number: int = 0


@record
class Unsettled:
    """An operation of which nobody knows how it ended: it began (`before`), and was cut short or answered nothing."""

    key: str
    operation: Operation
    ended: bool
    before: ObservedComponent | None = None


@record
class Success:
    """An operation that succeeded in a run, when, and its component as observed `after` it, where anybody looked;
    `last`: what a search measured last, its tunables among it, by address."""

    run: str
    operation: Operation
    at: str
    after: ObservedComponent | None = None
    last: Mapping[str, float] | None = None


def run_of(key: str) -> str:
    """Return the run id of a key; raises ValueError where it is not `run id/operation id/attempt`."""
    run, operation, attempt = key.split("/")
    if not (run and operation and attempt.isdigit()):
        raise ValueError(f"`{key}` is not `run id/operation id/attempt`")
    return run


PATIENCE = 5.0
"""How long a journal that another process writes is waited for [s]."""
_LOCKED = "is locked"


class Journal:
    """The journal of one bench. Every method raises PicoError where the database is locked, damaged or not writable."""

    def __init__(self, path: Path, clock: Callable[[], str] = now_ms, *, looking: bool = False) -> None:
        """Open or make it. `looking`: only to read what is there, also where the disk is full or read-only."""
        self.path = path
        self._clock, self._looking = clock, looking
        self._sums, self._counts = "checksum", True
        self._in_commits: dict[str, FromCommit | None] = {}
        self._count = ChangeCount(path)
        marked, least = marked_run(path), self._count.least()
        immutable = f"{path.absolute().as_uri()}?immutable=1"
        in_way = _in_way(path)
        if in_way and not (looking and in_way[0] != path):  # looking needs only the journal itself
            raise PicoError(JOURNAL.unreadable(*in_way))
        with self._guarded():
            if is_emptied(path):
                raise sqlite3.DatabaseError(EMPTY)
            if lost := lost_transactions(path):  # before it is opened: SQLite then drops them
                why = f"its write-ahead log is damaged, and {lost} transactions lie behind that"
                raise PicoError(lost_end(path, why))
            if (marked or least) and not path.exists():
                why = f"run {marked} has begun" if marked else f"it was written to {least} times"
                raise PicoError(lost_end(path, f"the file is gone, and {why}"))
            try:
                if not looking:
                    path.parent.mkdir(parents=True, exist_ok=True)
                if not path.exists() and str(path) != MEMORY:
                    make_database(path, _upgrade(0))
                self._open(immutable if in_way else str(path))
            except sqlite3.OperationalError:
                if not looking or _is_open(path):
                    raise
                self._open(immutable)
            if marked:
                self._require_run(marked)
            if self._counts and (missing := least - self._changes()) > 0:
                self._db.close()
                raise PicoError(lost_end(path, f"its last {missing} changes are missing"))

    def _changes(self) -> int:
        """Return how often the journal was written to."""
        return int(self._db.execute("SELECT changes FROM fence").fetchone()[0])

    def _counted(self, *, durable: bool = True) -> None:
        self._count.note(self._changes(), durable=durable)

    def _require_run(self, run: str) -> None:
        """Raise PicoError if a run is missing that has begun and not ended, and no other run has not ended: its mark
        may be damaged."""
        last = self._db.execute("SELECT finished_at FROM runs ORDER BY number DESC LIMIT 1").fetchone()
        known = self._db.execute("SELECT 1 FROM runs WHERE run = ?", (run,)).fetchone()
        if not known and (last is None or last[0] is not None):
            self._db.close()
            raise PicoError(lost_end(self.path, f"it does not hold run {run}, which has begun"))

    def _open(self, name: str) -> None:
        self._db = sqlite3.connect(
            name, timeout=PATIENCE, isolation_level=None, check_same_thread=False, uri=name.startswith("file:")
        )
        self._db.text_factory = _decoded
        try:
            self._prepare()
        except BaseException:
            self._db.close()
            raise

    def _prepare(self) -> None:
        self._db.execute("PRAGMA journal_mode=WAL")
        self._db.execute("PRAGMA synchronous=FULL")
        self._db.execute("PRAGMA fullfsync=ON")  # macOS; elsewhere it does nothing
        (version,) = self._db.execute("PRAGMA user_version").fetchone()
        if version == 0 and str(self.path) != MEMORY:
            raise sqlite3.DatabaseError("the file holds no tables")
        if version > VERSION:
            text = f"{self.path} is of a newer PICO (version {version})"
            raise PicoError(error("journal", text, hint=upgrade_hint()))
        if version < VERSION:
            try:
                self._db.executescript(_upgrade(version))
            except sqlite3.OperationalError:
                if not self._looking or version < 3:
                    raise
                with suppress(sqlite3.Error):
                    self._db.execute("ROLLBACK")
                self._counts = False  # on a disk that takes nothing, versions 3 and 4 are read as they are
                self._sums = "NULL" if version == 3 else self._sums
        if not self._looking:
            self._require_recent()

    @property
    def _row(self) -> str:
        return f"{ROW}, {self._sums}"

    def _require_recent(self) -> None:
        """Raise PicoError if one of the last records is damaged, and in no commit, or an index of a small journal is:
        a row that an index hides would not be missed."""
        if self._db.execute("PRAGMA page_count").fetchone()[0] <= SMALL:
            wrong = self._db.execute("PRAGMA integrity_check(1)").fetchone()[0]
            if wrong != "ok":
                raise sqlite3.DatabaseError(wrong)
        rows = self._db.execute(f"SELECT {self._row} FROM records ORDER BY seq DESC LIMIT {RECENT}").fetchall()
        for row in rows:
            if not is_sound_record(row):
                self._from_commit(row)

    def close(self) -> None:
        """Let go of the database."""
        self._db.close()
        self._count.close()

    def fence(self, token: int) -> None:
        """Let nobody with a lesser token write any more; raises PicoError (exit code LOCKED) where this one is late."""
        with self._guarded():
            self._db.execute("UPDATE fence SET token = ? WHERE token <= ?", (token, token))
            highest = self._db.execute("SELECT token FROM fence").fetchone()[0]
        if highest > token:
            raise PicoError(_late(token), ExitCode.LOCKED)

    # runs

    def begin_run(
        self, run: str, plan: str, holder: str, *, document: str | None = None, about: Mapping[str, Any] | None = None
    ) -> None:
        """Record that a run of the plan with digest `plan` begins, with the plan itself as JSON (`document`).

        `about`: what the plan does not say of it, see `pico.edge.about`.
        """
        row = (run, plan, holder, self._clock(), document, as_text([about or {}]))
        columns = "run, plan, holder, started_at, document, about"
        change = f"INSERT OR IGNORE INTO runs ({columns}) VALUES (?, ?, ?, ?, ?, ?)"
        known = self._changed(run, change, row)[2]
        if known != plan:
            raise PicoError(error("journal-key", f"run {run} is of another plan", hint="start the run under a new id"))

    def resume_run(self, run: str, about: Mapping[str, Any] | None = None) -> int:
        """Record that a run is taken up again, with a new plan to the same goal; return how often it now was."""
        change = (
            "UPDATE runs SET finished_at = NULL, outcome = NULL, tally = NULL, seen = NULL, resumed = resumed + 1,"
            " about = json_insert(coalesce(about, '[{}]'), '$[#]', json(?)) WHERE run = ?"
        )
        return int(self._changed(run, change, (as_text(about or {}), run))[8])

    def end_run(self, run: str, outcome: RunOutcome, tally: Mapping[str, Any]) -> None:
        """Record how a run ended: `tally` counts its operations."""
        row = (self._clock(), outcome, as_text(as_json(tally)), run)
        self._changed(run, "UPDATE runs SET finished_at = ?, outcome = ?, tally = ? WHERE run = ?", row)

    def saw(self, run: str, seen: Mapping[str, Any]) -> None:
        """Record how the bench was observed when a run was over, see `pico.edge.about`."""
        self._changed(run, "UPDATE runs SET seen = ? WHERE run = ?", (as_text(seen), run))

    def _changed(self, run: str, change: str, values: tuple[Any, ...]) -> tuple[Any, ...]:
        """Change the row of a run, and its checksums with it; return it as it then is. Raises PicoError if there is
        none, or if it is damaged: its checksums would then hide that."""
        whole = f"SELECT {HEAD}, document, about, seen, checksum FROM runs WHERE run = ?"
        with self._guarded():
            self._db.execute("BEGIN IMMEDIATE")
            try:
                before = self._db.execute(whole, (run,)).fetchone()
                if before and before[12] is not None and before[12] != sums_of_run(before[:12]):
                    raise PicoError(damaged_row(self.path, f"the run {run}"))
                self._db.execute(change, values)
                row: tuple[Any, ...] | None = self._db.execute(whole, (run,)).fetchone()
                if row is None:
                    raise PicoError(error("journal-key", f"the journal has no run {run}"))
                self._db.execute("UPDATE runs SET checksum = ? WHERE run = ?", (sums_of_run(row[:12]), run))
                self._db.execute("COMMIT")
                self._counted()
            except BaseException:
                with suppress(sqlite3.Error):
                    self._db.execute("ROLLBACK")
                raise
        return row

    def runs(self) -> tuple[RunRecord, ...]:
        """Return the runs in the order in which they began."""
        with self._guarded():
            rows = self._db.execute(f"SELECT {HEAD}, {self._sums} FROM runs ORDER BY number").fetchall()
        return tuple(self._run(row) for row in rows)

    def last(self) -> RunRecord | None:
        """Return the run that began last, None where none did."""
        with self._guarded():
            row = self._db.execute(f"SELECT {HEAD}, {self._sums} FROM runs ORDER BY number DESC LIMIT 1").fetchone()
        return self._run(row) if row else None

    def document(self, run: str) -> str | None:
        """Return the plan that a run began with, as JSON; None where it was not kept, or where it is
        damaged and a commit has the run."""
        with self._guarded():
            row = self._db.execute(f"SELECT document, {self._sums} FROM runs WHERE run = ?", (run,)).fetchone()
        if row and not is_sound_part(row[0], row[1], "document"):
            self._of_commit(run, f"the plan of run {run}")
            return None
        return row[0] if row else None

    def about(self, run: str) -> tuple[tuple[Mapping[str, Any], ...], Mapping[str, Any] | None]:
        """Return what was recorded of a run at its start and each time that it was taken up again, and how the bench
        was observed when it was over; None where nobody looked."""
        with self._guarded():
            row = self._db.execute(f"SELECT about, seen, {self._sums} FROM runs WHERE run = ?", (run,)).fetchone()
        about, seen, sums = row or (None, None, None)
        if row and not (is_sound_part(about, sums, "about") and is_sound_part(seen, sums, "seen")):
            known = self._of_commit(run, f"the beginning or end of run {run}")
            return known.about, known.seen
        return tuple(json.loads(about) if about else ()), json.loads(seen) if seen else None

    def moving(self) -> frozenset[str]:
        """Return the runs that began at least one operation."""
        with self._guarded():
            rows = self._db.execute("SELECT DISTINCT run FROM records WHERE phase = 1").fetchall()
        return frozenset(row[0] for row in rows)

    # operations

    def intend(self, key: str, operation: Operation, token: int) -> OperationResult | None:
        """Record the intent to execute `operation` under `key`, or return what is recorded of it.

        None: it may be executed. A result: it was, and must not be again; its outcome is `unknown` where it began and
        nobody knows how it ended. Raises PicoError where the key belongs to an operation with other content.
        """
        content = digest(operation)
        known = {r.kind: r for r in self.records(key=key)}
        if not known:
            self._add(key, "intent", operation.component, content, token, as_json(operation))
            return None
        first = next(iter(known.values()))
        if first.digest != content:
            text = f"{key} is recorded with other content: it was for {first.component}, now it is for another motion"
            raise PicoError(error("journal-key", text, hint="start the run under a new id"))
        ended = next((known[k] for k in ("done", "failed", "unknown") if k in known), None)
        if ended:
            result = result_from_json(ended.data)
            return replace(result, outcome=known["resolved"].data["outcome"]) if "resolved" in known else result
        return _cut_short(key, operation) if "started" in known else None

    def started(self, key: str, before: ObservedComponent | None, token: int) -> None:
        """Record that the operation under `key` begins now. Call it before anything moves."""
        intent = self.records(key=key)[0]
        self._add(key, "started", intent.component, intent.digest, token, as_json(before) if before else {})

    def ended(self, result: OperationResult, token: int) -> None:
        """Record how an operation ended. Call it before anyone hears of it."""
        intent = self.records(key=result.key)[0]
        self._add(result.key, result.outcome, intent.component, intent.digest, token, as_json(result))

    def records(self, *, run: str | None = None, key: str | None = None) -> tuple[JournalRecord, ...]:
        """Return the records of a run, of a key, or all, in the order in which they were written."""
        if key is not None:
            return self._select("WHERE key = ?", key)
        return self._select("WHERE run = ?", run) if run is not None else self._select("")

    def resolve(self, key: str, outcome: Outcome, by: str, after: ObservedComponent | None, token: int) -> None:
        """Record how an operation of which nobody knew it ended; `by`: `observation`, or who said so."""
        kinds = {r.kind: r for r in self.records(key=key)}
        data = {"outcome": outcome, "by": by} | ({"after": as_json(after)} if after else {})
        if "unknown" not in kinds:
            cut = _cut_short(key, operation_from_json(kinds["intent"].data))
            self._add(key, "unknown", kinds["intent"].component, kinds["intent"].digest, token, as_json(cut))
        if outcome != "unknown":
            self._add(key, "resolved", kinds["intent"].component, kinds["intent"].digest, token, data)

    def unsettled(self) -> tuple[Unsettled, ...]:
        """Return the operations that began and of which nobody knows how they ended, in the order of their start."""
        where = (
            "AS s WHERE phase = 1 AND NOT EXISTS (SELECT 1 FROM records AS e WHERE e.key = s.key AND"
            " (e.phase = 3 OR e.phase = 2 AND e.kind != 'unknown'))"
        )
        found = []
        for started in self._select(where):
            known = {r.kind: r for r in self.records(key=started.key)}
            operation = operation_from_json(known["intent"].data)
            before = observed_from_json(started.data or None)
            found.append(Unsettled(key=started.key, operation=operation, before=before, ended="unknown" in known))
        return tuple(found)

    def last_pick(self, robot: str) -> Operation | None:
        """Return the last move that a robot began from the table: what it may hold, and where that stood before."""
        begun = set[str]()
        for one in self._backwards("WHERE phase < 2"):
            begun |= {one.key} if one.kind == "started" else set()
            origin = one.data.get("arguments", {}).get("from") if one.kind == "intent" and one.key in begun else None
            if origin is not None and one.data.get("robot") == robot and origin.get("held") is None:
                return operation_from_json(one.data)
        return None

    def successes(self, components: Collection[str]) -> Iterator[Success]:
        """Yield the operations on some components that succeeded, the last one first."""
        ends, intents = (
            ", ".join(name if name == "NULL" else f"{table}.{name}" for name in self._row.split(", "))
            for table in ("e", "i")
        )
        joined = f"SELECT {ends}, {intents} FROM records AS e JOIN records AS i ON i.key = e.key AND i.phase = 0"
        with self._guarded():
            for row in self._db.execute(f"{joined} WHERE e.phase > 1 ORDER BY e.seq DESC"):
                end_row, intent_row = row[:11], row[11:]
                whole = is_sound_record(end_row) and is_sound_record(intent_row)
                # one search sets tunables of several components
                if whole and end_row[5] not in components and '"optimize"' not in intent_row[9]:
                    continue
                end, intent = self._mended((end_row, intent_row))
                if end.kind == "done" or (end.kind == "resolved" and end.data["outcome"] == "done"):
                    after, last = observed_from_json(end.data.get("after")), (end.data.get("data") or {}).get("last")
                    yield Success(
                        run=run_of(end.key), operation=operation_from_json(intent.data), after=after, at=end.at,
                        last=last,
                    )  # fmt: skip

    def _backwards(self, where: str) -> Iterator[JournalRecord]:
        """Yield records, the last one first."""
        with self._guarded():
            cursor = self._db.execute(f"SELECT {self._row} FROM records {where} ORDER BY seq DESC")
            while rows := cursor.fetchmany(64):
                yield from self._mended(rows)

    def _select(self, where: str, *values: str) -> tuple[JournalRecord, ...]:
        with self._guarded():
            rows = self._db.execute(f"SELECT {self._row} FROM records {where} ORDER BY seq", values).fetchall()
        return tuple(self._mended(rows))

    # what is damaged

    def _mended(self, rows: Sequence[tuple[Any, ...]]) -> Iterator[JournalRecord]:
        """Yield the records of some rows; one that is damaged is taken from the commit that has its run. Raises
        PicoError if none has."""
        for row in rows:
            yield _record(row) if is_sound_record(row) else self._from_commit(row)

    def _from_commit(self, row: tuple[Any, ...]) -> JournalRecord:
        """Return what a damaged row held: what the commit has of its run and no sound row of the run says."""
        seq, run = row[0], str(row[2])
        known = self._of_commit(run, f"record {seq} ({row[5]}) of run {run}")
        own = self._db.execute(f"SELECT {self._row} FROM records WHERE run = ? ORDER BY seq", (run,)).fetchall()
        sound = {(one[1], one[4]) for one in own if is_sound_record(one)}
        gone = [one[0] for one in own if not is_sound_record(one)]
        missing = [one for one in known.records if one[:2] not in sound]
        if len(gone) != len(missing) or seq not in gone:
            raise PicoError(damaged_row(self.path, f"record {seq} of run {run}"))
        key, kind, component, at, data = missing[gone.index(seq)]
        intent = next((one for one in known.records if one[:2] == (key, "intent")), None)
        content = digest(operation_from_json(intent[4])) if intent else ""
        return JournalRecord(
            seq=seq, key=key, kind=cast(RecordKind, kind), component=component, digest=content, token=0, at=at,
            data=data,
        )  # fmt: skip

    def _of_commit(self, run: str, what: str) -> FromCommit:
        if run not in self._in_commits:
            self._in_commits[run] = from_commit(self.path, run)
        known = self._in_commits[run]
        if known is None:
            raise PicoError(damaged_row(self.path, what))
        return known

    def _run(self, row: tuple[Any, ...]) -> RunRecord:
        *head, sums = row
        number, run, plan, holder, started, finished, outcome, tally, resumed = head
        if is_sound_head(head, sums):
            tally = json.loads(tally) if tally else None
        else:
            known = self._of_commit(str(run), f"run {run}")
            _, run, plan, holder, started, finished, outcome, tally, resumed = known.head
        return RunRecord(
            run=run, plan=plan, holder=holder, started_at=started, finished_at=finished, outcome=outcome, tally=tally,
            resumed=int(resumed or 0), number=int(number),
        )  # fmt: skip

    def _add(self, key: str, kind: RecordKind, component: str, content: str, token: int, data: Any) -> None:
        row = (key, run_of(key), PHASES[kind], kind, component, content, token, self._clock(), as_text(data))
        with self._guarded():
            if kind == "intent":
                self._db.execute("PRAGMA synchronous=NORMAL")
            written = self._db.execute(
                "INSERT INTO records (key, run, phase, kind, component, digest, token, at, data, checksum)"
                " SELECT ?, ?, ?, ?, ?, ?, ?, ?, ?, ? WHERE ? >= (SELECT token FROM fence)",
                (*row, checksum(*row), token),
            ).rowcount
            if kind == "intent":
                self._db.execute("PRAGMA synchronous=FULL")
            if written:
                self._counted(durable=kind != "intent")
        if not written:
            raise PicoError(_late(token), ExitCode.LOCKED)

    @contextmanager
    def _guarded(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.IntegrityError as exc:
            raise PicoError(error("journal-key", f"this is recorded in {self.path} already: {exc}")) from exc
        except (sqlite3.Error, OSError) as exc:
            raise PicoError(_trouble(self.path, exc)) from exc


def _upgrade(version: int) -> str:
    """Return what makes the tables of a version those of today, all or none; 0: a file that holds nothing yet."""
    return f"BEGIN EXCLUSIVE;{SCRIPTS[version]}PRAGMA user_version={VERSION};COMMIT;"


def _in_way(path: Path) -> tuple[Path, str] | tuple[()]:
    """Return which of a journal and what SQLite has beside it is no file, or may not be read by this user, and why:
    SQLite would only say that it cannot open or write its database."""
    for one in (path, path.with_name(f"{path.name}-wal"), path.with_name(f"{path.name}-shm")):
        if what := other_than_file(one):
            return one, f"it is {what}"
        if one.exists() and not os.access(one, os.R_OK):
            return one, os.strerror(errno.EACCES)
    return ()


def _is_open(path: Path) -> bool:
    """Whether a process writes a journal, or was killed while it did: not all records are in the file itself then."""
    log = path.with_name(f"{path.name}-wal")
    return log.is_file() and log.stat().st_size > 0


def _late(token: int) -> Diagnostic:
    return error("lease", f"the lease {token} is not the current one: somebody took the bench since", hint="plan again")


def is_locked(exc: PicoError) -> bool:
    """Return whether a journal could not be used because another process writes it."""
    return any(one.code == "journal" and one.summary.endswith(_LOCKED) for one in exc.diagnostics)


def as_text(data: Any) -> str:
    """Return JSON that keeps every digit, so that a recorded result is the result."""
    return json.dumps(data, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def _trouble(path: Path, exc: Exception) -> Diagnostic:
    text = str(exc)
    if "locked" in text:
        hint = "another process writes it; try again when that is done"
        return error("journal", f"the journal {path} {_LOCKED}", hint=hint)
    if isinstance(exc, sqlite3.DatabaseError) and not isinstance(exc, sqlite3.OperationalError):
        return error("journal", f"the journal {path} is damaged: {text}", hint=SALVAGE)
    if "readonly database" in text and path.exists() and not os.access(path, os.W_OK) and not refusing(path.parent):
        return JOURNAL.unreadable(path, os.strerror(errno.EACCES))
    return unwritable(path, refusing(path.parent) or exc, what=f"the journal {path} cannot be used", code="journal")


def _record(row: tuple[Any, ...]) -> JournalRecord:
    seq, key, _, _, kind, component, content, token, at, data, _ = row
    return JournalRecord(
        seq=seq, key=key, kind=kind, component=component, digest=content, token=token, at=at, data=json.loads(data)
    )


def _decoded(data: bytes) -> str:
    """Return a text of the database; a flipped bit must not keep the row from being read and named."""
    return data.decode("utf-8", "surrogateescape")


def _cut_short(key: str, operation: Operation) -> OperationResult:
    text = f"{operation.primitive} of {operation.component} began, and PICO was killed before it ended"
    hint = "plan again: it starts from what stands on the table now"
    found = error("unknown-outcome", text, hint=hint, address=operation.component)
    return OperationResult(key=key, outcome="unknown", error=found)

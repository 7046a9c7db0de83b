"""The write-ahead record of operations: what was meant, what began, and what became of it.

SQLite in `.pico/journal.sqlite`, WAL with synchronous=FULL: a record is on the disk when its function returns. Each
attempt at an operation has a key, `run id/operation id/attempt`, and at most three records: `intent` before anything,
`started` before motion, one of `done`, `failed` and `unknown` before anyone hears of it. Records are only added.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.observation import ObservedComponent, ObservedValue, Uncertainty
from pico.model.operation import Operation, OperationResult
from pico.model.pose import Pose
from pico.model.record import as_json, digest, record

RecordKind = Literal["intent", "started", "done", "failed", "unknown"]
RunOutcome = Literal["done", "failed", "interrupted"]

VERSION = 1
_PHASE: Mapping[str, int] = {"intent": 0, "started": 1, "done": 2, "failed": 2, "unknown": 2}
_TABLES = """
CREATE TABLE IF NOT EXISTS runs (
  run TEXT PRIMARY KEY, plan TEXT NOT NULL, holder TEXT NOT NULL, started_at TEXT NOT NULL,
  finished_at TEXT, outcome TEXT, tally TEXT
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS records (
  seq INTEGER PRIMARY KEY AUTOINCREMENT, key TEXT NOT NULL, run TEXT NOT NULL, phase INTEGER NOT NULL,
  kind TEXT NOT NULL, component TEXT NOT NULL, digest TEXT NOT NULL, token INTEGER NOT NULL, at TEXT NOT NULL,
  data TEXT NOT NULL, UNIQUE (key, phase)
);
CREATE INDEX IF NOT EXISTS records_of_run ON records (run);
"""


@record
class JournalRecord:
    """One record. `data`: the operation of an `intent`, the observed component of a `started`, the result of an end."""

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
    """One run. `finished_at`, `outcome` and `tally` are None while it goes on, or where it was killed."""

    run: str
    plan: str
    holder: str
    started_at: str
    finished_at: str | None = None
    outcome: RunOutcome | None = None
    tally: Mapping[str, Any] | None = None


def utc_now() -> str:
    """Return the time as ISO 8601, UTC, to the millisecond."""
    return datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def run_of(key: str) -> str:
    """Return the run id of a key; raises ValueError where it is not `run id/operation id/attempt`."""
    run, operation, attempt = key.split("/")
    if not (run and operation and attempt.isdigit()):
        raise ValueError(f"`{key}` is not `run id/operation id/attempt`")
    return run


class Journal:
    """The journal of one bench. Every method raises PicoError where the database is locked, damaged or not writable."""

    def __init__(self, path: Path, clock: Callable[[], str] = utc_now) -> None:
        self.path = path
        self._clock = clock
        with self._guarded():
            path.parent.mkdir(parents=True, exist_ok=True)
            self._db = sqlite3.connect(path, timeout=5.0, isolation_level=None, check_same_thread=False)
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
        if version > VERSION:
            raise PicoError(error("journal", f"{self.path} is of a newer PICO (version {version})", hint="update PICO"))
        if version == 0:
            self._db.executescript(f"BEGIN EXCLUSIVE;{_TABLES}PRAGMA user_version={VERSION};COMMIT;")

    def close(self) -> None:
        """Let go of the database."""
        self._db.close()

    # runs

    def begin_run(self, run: str, plan: str, holder: str) -> None:
        """Record that a run of the plan with digest `plan` begins; a run that is resumed goes on under its id."""
        row = (run, plan, holder, self._clock())
        with self._guarded():
            self._db.execute("INSERT OR IGNORE INTO runs (run, plan, holder, started_at) VALUES (?, ?, ?, ?)", row)
            known = self._db.execute("SELECT plan FROM runs WHERE run = ?", (run,)).fetchone()[0]
        if known != plan:
            raise PicoError(error("journal-key", f"run {run} is of another plan", hint="start the run under a new id"))

    def end_run(self, run: str, outcome: RunOutcome, tally: Mapping[str, Any]) -> None:
        """Record how a run ended: `tally` counts its operations."""
        row = (self._clock(), outcome, _text(as_json(tally)), run)
        with self._guarded():
            self._db.execute("UPDATE runs SET finished_at = ?, outcome = ?, tally = ? WHERE run = ?", row)

    def runs(self) -> tuple[RunRecord, ...]:
        """Return the runs, oldest first."""
        with self._guarded():
            rows = self._db.execute(
                "SELECT run, plan, holder, started_at, finished_at, outcome, tally FROM runs ORDER BY started_at, run"
            ).fetchall()
        return tuple(_run(row) for row in rows)

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
            return result_from_json(ended.data)
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

    def unfinished(self) -> tuple[JournalRecord, ...]:
        """Return the `started` records without an end: what was under way when a process was killed."""
        return self._select("WHERE phase = 1 AND key NOT IN (SELECT key FROM records WHERE phase = 2)")

    def _select(self, where: str, *values: str) -> tuple[JournalRecord, ...]:
        columns = "seq, key, kind, component, digest, token, at, data"
        with self._guarded():
            rows = self._db.execute(f"SELECT {columns} FROM records {where} ORDER BY seq", values).fetchall()
        names = columns.split(", ")[:-1]
        return tuple(JournalRecord(**dict(zip(names, row[:-1], strict=True)), data=json.loads(row[-1])) for row in rows)

    def _add(self, key: str, kind: RecordKind, component: str, content: str, token: int, data: Any) -> None:
        row = (key, run_of(key), _PHASE[kind], kind, component, content, token, self._clock(), _text(data))
        with self._guarded():
            self._db.execute(
                "INSERT INTO records (key, run, phase, kind, component, digest, token, at, data)"
                " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
                row,
            )

    @contextmanager
    def _guarded(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.IntegrityError as exc:
            raise PicoError(error("journal-key", f"this is recorded in {self.path} already: {exc}")) from exc
        except (sqlite3.Error, OSError) as exc:
            raise PicoError(_trouble(self.path, exc)) from exc


def _text(data: Any) -> str:
    """Return JSON that keeps every digit, so that a recorded result is the result."""
    return json.dumps(data, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def _trouble(path: Path, exc: Exception) -> Diagnostic:
    text = str(exc)
    if "locked" in text:
        hint = "another process writes it; try again when that is done"
        return error("journal", f"the journal {path} is locked", hint=hint)
    if isinstance(exc, sqlite3.DatabaseError) and not isinstance(exc, sqlite3.OperationalError):
        hint = f"move it away (`mv {path} {path}.broken`); runs in Git and the simulated table do not depend on it"
        return error("journal", f"the journal {path} is damaged: {text}", hint=hint)
    return error("journal", f"the journal {path} cannot be used: {text}")


def _run(row: tuple[Any, ...]) -> RunRecord:
    names = ("run", "plan", "holder", "started_at", "finished_at", "outcome")
    return RunRecord(**dict(zip(names, row[:6], strict=True)), tally=json.loads(row[6]) if row[6] else None)


def _cut_short(key: str, operation: Operation) -> OperationResult:
    text = f"{operation.primitive} of {operation.component} began, and PICO was killed before it ended"
    hint = "plan again: it starts from what stands on the table now"
    found = error("unknown-outcome", text, hint=hint, address=operation.component)
    return OperationResult(key=key, outcome="unknown", error=found)


def result_from_json(data: Mapping[str, Any]) -> OperationResult:
    """Return the result whose `as_json` gave `data`."""
    found = data.get("error")
    return OperationResult(
        key=data["key"],
        outcome=data["outcome"],
        error=Diagnostic(**{k: v for k, v in found.items() if k != "source"}) if found else None,
        before=_observed(data.get("before")),
        after=_observed(data.get("after")),
        seconds=float(data["seconds"]),
        ended=float(data["ended"]),
        data=data["data"],
    )


def _observed(data: Mapping[str, Any] | None) -> ObservedComponent | None:
    if data is None:
        return None
    return ObservedComponent(
        presence=data["presence"],
        pose=Pose(**data["pose"]) if "pose" in data else None,
        uncertainty=Uncertainty(**data["uncertainty"]),
        age=float(data["age"]),
        values={k: ObservedValue(value=v.get("value"), status=v["status"]) for k, v in data["values"].items()},
    )

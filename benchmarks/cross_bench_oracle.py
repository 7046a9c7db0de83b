"""What each bench of `cross_bench.py` holds at a moment, and what a command must not have changed.

A bench is compared by the bytes that its devices received (`hardware`), the files of its folder, and the rows of its
journal. The folders are read from the disk, never through PICO.
"""

from __future__ import annotations

import hashlib
import json
import re
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, suppress
from dataclasses import dataclass, field
from pathlib import Path

from cross_bench_labs import Traffic, git, read_traffic

BENCHES = ("sim", "emulated", "hardware", "remote")
LOCAL = BENCHES[:3]
RUN = re.compile(r"\d{8}T\d{6}Z-[0-9a-f]{6}")
IGNORED = re.compile(
    r"(^|/)(lock|[\w.]+\.lock|holder\.json|write\.tmp|[\w.]+-(wal|shm)|\.[\w.]+\.tmp|enrolment\.json|bench\d*/session)$"
)
"""Files that do not count: locks with their holder, scratch files (journals are compared by their rows), the
key of the remote bench at its coordinator, and the name under which a checkout is known there."""
OBSERVED = re.compile(r"/(seen|settings|audit)\.json$")
"""Files that a command may write when it only looks: where parts were last seen, settings that cannot be read from a
device, and the result of the beam audit."""


@dataclass
class BenchPrint:
    """A bench at a moment."""

    files: dict[str, str] = field(default_factory=dict)
    """Digests by path."""
    runs: dict[str, str] = field(default_factory=dict)
    """The rows of the journal, as text, by run."""
    traffic: Traffic = field(default_factory=Traffic)
    """What its devices received; empty except for `hardware`."""


def read_prints(trees: Mapping[str, Path], far: Path, wires: Path) -> dict[str, BenchPrint]:
    """Return all benches as they are now; `trees`: the worktrees of the checkout by name."""
    found = {bench: BenchPrint() for bench in BENCHES}
    for name, root in trees.items():
        _read_folder(found, name, root / ".pico")
    for path in _files(far / ".pico"):
        _add(found["remote"], f"far/{path.relative_to(far)}", path)
    found["hardware"].traffic = read_traffic(wires)
    return found


def _read_folder(found: Mapping[str, BenchPrint], tree: str, folder: Path) -> None:
    for path in _files(folder):
        parts = path.relative_to(folder).parts
        name = f"{tree}/{path.relative_to(folder.parent)}"
        if parts[0] == "benches" and len(parts) > 2:
            _add(found[parts[1] if parts[1] in LOCAL else "remote"], name, path)


def _files(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    return sorted(p for p in folder.rglob("*") if p.is_file() and not IGNORED.search(p.relative_to(folder).as_posix()))


def _add(bench: BenchPrint, name: str, path: Path) -> None:
    if path.suffix == ".sqlite":
        rows = _rows(path)
        bench.runs.update({run: text for run, text in rows.items() if run})
        bench.files[name] = _digest(repr(sorted(rows.items())).encode())
        return
    with suppress(FileNotFoundError):  # its bench has just renamed it
        bench.files[name] = _digest(path.read_bytes())


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:12]


def _rows(path: Path) -> dict[str, str]:
    """Return the rows of a database by run; those of no run under the empty name."""
    found: dict[str, str] = {}
    try:
        with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True, timeout=10)) as database:
            tables = database.execute("SELECT name FROM sqlite_master WHERE type='table' ORDER BY name").fetchall()
            for (table,) in tables:
                rows = database.execute(f'SELECT * FROM "{table}"')
                at = next((n for n, column in enumerate(rows.description) if column[0] == "run"), None)
                for row in rows:
                    run = str(row[at]) if at is not None else ""
                    found[run] = found.get(run, "") + f"{table} {row!r}\n"
    except sqlite3.Error as exc:
        found[""] = f"unreadable: {exc}"
    return found


def count_runs(journal: Path) -> int:
    """Return how many runs a journal holds; 0 if it cannot be read."""
    try:
        with closing(sqlite3.connect(f"file:{journal}?mode=ro", uri=True, timeout=10)) as database:
            return int(database.execute("SELECT count(*) FROM runs").fetchone()[0])
    except sqlite3.Error:
        return 0


def changes(before: BenchPrint, after: BenchPrint) -> list[str]:
    """Return what changed on a bench: files and runs."""
    files = [f"{'changed' if name in before.files else 'new'}: {name}" for name, digest in after.files.items()
             if before.files.get(name) != digest]  # fmt: skip
    files += [f"gone: {name}" for name in before.files.keys() - after.files.keys()]
    runs = [f"{'changed' if run in before.runs else 'new'}: run {run}" for run, text in after.runs.items()
            if before.runs.get(run) != text]  # fmt: skip
    return files + runs + [f"gone: run {run}" for run in before.runs.keys() - after.runs.keys()]


def received(before: BenchPrint, after: BenchPrint) -> tuple[int, list[str]]:
    """Return the number of bytes that the devices of a bench received, and the commands that make them act."""
    count = sum(after.traffic.bytes.values()) - sum(before.traffic.bytes.values())
    commands = [f"{driver}: {command}" for driver, all_ in after.traffic.mutating.items()
                for command in all_[len(before.traffic.mutating.get(driver, [])) :]]  # fmt: skip
    return count, commands


def check_others(
    before: Mapping[str, BenchPrint], after: Mapping[str, BenchPrint], meant: tuple[str | None, ...]
) -> Iterator[str]:
    """Yield what changed on benches that a command did not mean."""
    for bench in BENCHES:
        if bench in meant:
            continue
        count, commands = received(before[bench], after[bench])
        if count:
            yield f"the devices of {bench} received {count} bytes ({', '.join(commands[:4]) or 'queries only'})"
        if found := changes(before[bench], after[bench]):
            yield f"{bench} was changed: {', '.join(found[:6])}"


def check_look(before: BenchPrint, after: BenchPrint, bench: str) -> Iterator[str]:
    """Yield what a command that only looks changed on its bench."""
    _, commands = received(before, after)
    if commands:
        yield f"a look made devices of {bench} act: {', '.join(commands[:4])}"
    if found := [one for one in changes(before, after) if not OBSERVED.search(one)]:
        yield f"a look changed {bench}: {', '.join(found[:6])}"


def runs_of_others(bench: str, text: str, owners: Mapping[str, str]) -> list[str]:
    """Return the runs that a text names and that belong to another bench, each with that bench."""
    return sorted({f"{run} (of {owners[run]})" for run in RUN.findall(text) if owners.get(run, bench) != bench})


def runs_in(document: Path) -> set[str]:
    """Return the runs that the document of a committed run holds: its own, and those that are folded into it."""
    run = json.loads(document.read_text())
    return {run["id"], *RUN.findall(json.dumps(run.get("folded", [])))}


def check_commits(tree: Path, before: str, bench: str, owners: Mapping[str, str], name: str) -> Iterator[str]:
    """Yield the runs of other benches in the commits since `before`, which were made for `bench`; `name`: what a run
    calls that bench."""
    for path in git(tree, "diff", "--name-only", "--diff-filter=A", before, "HEAD").splitlines():
        if not path.endswith("/run.json"):
            continue
        for run in runs_in(tree / path):
            if owners.get(run, bench) != bench:
                yield f"a commit for {bench} holds run {run} of {owners[run]}"
        run, written = Path(path).parent.name, json.loads((tree / path).read_text()).get("bench")
        if name not in str(written):
            yield f"a commit for {bench} holds run {run}, which says bench {written!r}"

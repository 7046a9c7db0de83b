"""One command that is run at a desk: what it said so far, and how it ended."""

from __future__ import annotations

import asyncio
import json
import shutil
from collections.abc import AsyncIterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from pico.diagnostics import ExitCode, PicoError, error
from pico.disk import write_whole

LOOKS = 0.03
"""How often it is looked whether a command said more [s]."""
BESIDE = 1 << 16
"""Bytes of what a command said beside its answer that are handed on."""
LONGEST = 8 << 20
"""Bytes of one line that a command says."""
KEPT = 200
"""How many runs of a lab are kept."""


@dataclass(frozen=True)
class About:
    """What is run: `pico COMMAND WORDS...` of somebody at a desk, since then [s since 1970]. `exit`: with which code it
    ended, None meanwhile; `why`: what ended it where it did not do so itself; `branch`: where its commits are."""

    id: str
    lab: str
    bench: str
    who: str
    command: str
    words: tuple[str, ...]
    began_at: float
    commit: str = ""
    branch: str = ""
    ended_at: float | None = None
    exit: int | None = None
    why: str = ""
    runs: tuple[str, ...] = ()
    """The runs that it began at the bench."""


@dataclass(eq=False)
class Job:
    """A command in `folder`, where its output lies; `ended` is set once it has."""

    about: About
    folder: Path
    ended: asyncio.Event
    number: int = 0

    @property
    def said(self) -> tuple[Path, Path]:
        """The files of its answer, and of what it said beside that."""
        return self.folder / "said.ndjson", self.folder / "beside.txt"

    def note(self, **changes: object) -> None:
        """Note what is new about it."""
        self.about = replace(self.about, **changes)  # type: ignore[arg-type]
        write_whole(self.folder / "about.json", json.dumps(asdict(self.about)).encode())

    async def lines(self, since: int = 0) -> AsyncIterator[bytes]:
        """Yield what it says, each line a JSON document, after the first `since` of them; last how it ended. Raises
        PicoError for a line that is too long."""
        count, path = 0, self.said[0]
        rest, length = list[bytes](), 0
        file = None
        try:
            while True:
                over = self.ended.is_set()
                if file is None and path.exists():
                    file = path.open("rb")
                while file is not None and (piece := file.read(1 << 20)):
                    first, *lines = piece.split(b"\n")
                    rest.append(first)
                    length += len(first)
                    if length > LONGEST:
                        raise PicoError(error("too-long", self._too_long()))
                    if lines:
                        lines = [b"".join(rest), *lines]
                        rest, length = [lines[-1]], len(lines[-1])
                    for line in filter(None, lines[:-1]):
                        count += 1
                        if count > since:
                            yield _document(line)
                    await asyncio.sleep(0)
                if over:
                    break
                with suppress(TimeoutError):
                    async with asyncio.timeout(LOOKS):
                        await self.ended.wait()
        finally:
            if file is not None:
                file.close()
        if length:
            yield _document(b"".join(rest))
        yield self._last()

    def _too_long(self) -> str:
        return f"`pico {self.about.command}` said a line of more than {LONGEST >> 20} MiB"

    def _last(self) -> bytes:
        ends: dict[str, Any] = {"exit": self.about.exit}
        with suppress(OSError), self.said[1].open("rb") as file:
            file.seek(max(0, self.said[1].stat().st_size - BESIDE))
            if text := file.read().decode(errors="replace").strip():
                ends["beside"] = text
        return json.dumps(ends | ({"why": self.about.why} if self.about.why else {})).encode() + b"\n"


def code_of(status: int) -> int:
    """Return the exit code that a status of a process means: 130 where a signal ended it."""
    return status if status >= 0 else int(ExitCode.INTERRUPTED)


def read(folder: Path) -> Job | None:
    """Return a run that is kept in a folder; None where it can't be read. One that had no end has one now: whoever ran
    it is gone."""
    try:
        document = json.loads((folder / "about.json").read_bytes())
        about = About(**{**document, "words": tuple(document["words"]), "runs": tuple(document["runs"])})
    except (OSError, ValueError, TypeError, KeyError):
        return None
    job = Job(about, folder, asyncio.Event())
    job.ended.set()
    if about.exit is None:
        with suppress(PicoError):
            job.note(exit=int(ExitCode.INTERRUPTED), why="the coordinator ended meanwhile")
    return job


def forget_old(runs: Mapping[str, Job], lab: str) -> tuple[str, ...]:
    """Delete the oldest runs of a lab that have ended, beyond those that are kept; return their ids."""
    ended = [job for job in runs.values() if job.about.lab == lab and job.about.exit is not None]
    old = sorted(ended, key=lambda job: job.about.began_at)[:-KEPT]
    for job in old:
        shutil.rmtree(job.folder, ignore_errors=True)
    return tuple(job.about.id for job in old)


def _document(line: bytes) -> bytes:
    try:
        json.loads(line)
        return line + b"\n"
    except ValueError:
        return json.dumps({"text": line.decode(errors="replace")}).encode() + b"\n"

"""The process that has loaded what commands need, and forks a child for each: see `python -m` of the command line."""

from __future__ import annotations

import asyncio
import itertools
import json
import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from pico.diagnostics import PicoError, error

ENDS = 45.0
"""Seconds in which the process has ended that was told to."""


class Warm:
    """Starts commands by the process that `words` start, which is started when it is first needed, and anew where it
    was lost."""

    def __init__(self, words: Sequence[str]) -> None:
        self._words = tuple(words)
        self._process: asyncio.subprocess.Process | None = None
        self._reading: asyncio.Task[None] | None = None
        self._starting = asyncio.Lock()
        self._numbers = itertools.count(1)
        self._waiting: dict[int, asyncio.Future[int]] = {}

    async def run(
        self, words: Sequence[str], folder: Path, environment: Mapping[str, str], said: tuple[Path, Path],
        confined: Sequence[Path],
    ) -> tuple[int, asyncio.Future[int]]:  # fmt: skip
        """Begin a command whose output goes to two files; return its number, and its exit code once it has ended
        (negative: the signal that ended it). `confined`: the only folders that it opens, none: as its user may. Raises
        PicoError."""
        process = await self.started()
        number = next(self._numbers)
        ended = self._waiting[number] = asyncio.get_running_loop().create_future()
        out, err = map(str, said)
        self._tell(process, {
            "id": number, "words": [*words], "folder": str(folder), "environment": dict(environment), "out": out,
            "err": err, "confined": [str(one) for one in confined],
        })  # fmt: skip
        return number, ended

    def signal(self, number: int, signal: int) -> None:
        """Send a signal to a command that has not ended yet."""
        if number in self._waiting and self._process is not None:
            self._tell(self._process, {"id": number, "signal": signal})

    async def close(self) -> None:
        """End all commands as Ctrl-C does, and the process."""
        if self._process is None or self._reading is None:
            return
        assert self._process.stdin is not None
        self._process.stdin.close()
        with suppress(TimeoutError):
            async with asyncio.timeout(ENDS):
                await self._process.wait()
        if self._process.returncode is None:
            self._process.kill()
            await self._process.wait()
        await self._reading

    async def started(self) -> asyncio.subprocess.Process:
        """Return the process, ready; raises PicoError where it can't be started."""
        async with self._starting:
            if self._process is not None and self._process.returncode is None:
                return self._process
            if not self._words:
                raise PicoError(error("desk", "this coordinator has no desks"))
            pipe = asyncio.subprocess.PIPE
            process = await asyncio.create_subprocess_exec(
                *self._words, stdin=pipe, stdout=pipe, cwd="/", start_new_session=True,
                env={"PATH": os.environ.get("PATH", os.defpath), "HOME": os.devnull, "OPENBLAS_NUM_THREADS": "1"},
            )  # fmt: skip
            assert process.stdout is not None
            try:
                ready = await process.stdout.readline()
            except BaseException:
                process.kill()
                raise
            if not ready:
                await process.wait()
                raise PicoError(error("internal", "what runs the commands of desks could not be started"))
            self._process, self._reading = process, asyncio.create_task(self._read(process))
            return process

    def _tell(self, process: asyncio.subprocess.Process, document: Any) -> None:
        assert process.stdin is not None
        with suppress(ConnectionError):
            process.stdin.write(json.dumps(document).encode() + b"\n")

    async def _read(self, process: asyncio.subprocess.Process) -> None:
        assert process.stdout is not None
        while line := await process.stdout.readline():
            document = json.loads(line)
            ended = self._waiting.pop(document["id"], None)
            if ended is not None and not ended.done():
                ended.set_result(document["exit"])
        await process.wait()
        waiting, self._waiting = self._waiting, {}
        for ended in waiting.values():
            if not ended.done():
                ended.set_result(-9)

"""A command of `cross_bench.py` in a process of its own."""

from __future__ import annotations

import os
import shlex
import signal
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from cross_bench_labs import TIED
from cross_bench_plants import PLANTS

TIMEOUT = 120.0
"""The longest time that a command may take [s]."""


@dataclass(frozen=True)
class Answer:
    """What a command answered; the exit code of one that was killed is negative."""

    code: int
    out: str
    err: str
    seconds: float

    @property
    def text(self) -> str:
        """Standard output and standard error."""
        return self.out + self.err


class Child:
    """A command in a process that is forked from this one, which has already imported what commands need."""

    number = 0

    def __init__(
        self, words: tuple[str, ...], folder: Path, environment: dict[str, str], scratch: Path, typed: str, plant: str
    ) -> None:
        Child.number += 1
        self._out, self._err = (scratch / f"{Child.number}.{name}" for name in ("out", "err"))
        self._began = time.monotonic()
        self._code: int | None = None
        self.process = os.fork()
        if self.process == 0:
            try:
                self._become(words, folder, environment, typed, plant)
            except BaseException as exc:
                print(f"{shlex.join(words)}: {exc!r}", file=sys.stderr, flush=True)
            finally:
                os._exit(70)

    def _become(
        self, words: tuple[str, ...], folder: Path, environment: dict[str, str], typed: str, plant: str
    ) -> None:
        if typed:
            ours, stdin = os.openpty()
            os.write(ours, typed.encode())
        else:
            stdin = os.open(os.devnull, os.O_RDONLY)
        os.dup2(stdin, 0)
        sys.stdin = open(0, closefd=False)  # noqa: SIM115  # that of a worker of a pool is another file
        if words[0] != "pico":
            for path, stream in ((self._out, 1), (self._err, 2)):
                os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT, 0o600), stream)
            os.chdir(folder)
            os.execvpe(words[0], words, environment)
        from cli.warm import _become

        TIED[0] = False
        if plant:
            PLANTS[plant].plant()
        _become({"out": str(self._out), "err": str(self._err), "environment": environment, "folder": str(folder),
                 "words": list(words[1:]), "confined": None})  # fmt: skip

    def ended(self) -> bool:
        """Return whether the process has ended."""
        if self._code is None and (ended := os.waitpid(self.process, os.WNOHANG))[0]:
            self._code = os.waitstatus_to_exitcode(ended[1])
        return self._code is not None

    def wait(self) -> Answer:
        """Wait until the process has ended, at most `TIMEOUT`, and return its answer."""
        while not self.ended():
            if time.monotonic() - self._began > TIMEOUT:
                os.kill(self.process, signal.SIGKILL)
            time.sleep(0.005)
        texts = [path.read_text(errors="replace") if path.exists() else "" for path in (self._out, self._err)]
        for path in (self._out, self._err):
            path.unlink(missing_ok=True)
        return Answer(self._code or 0, texts[0], texts[1], time.monotonic() - self._began)

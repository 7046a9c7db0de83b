"""Programs as processes that are forked from this one: like `python -c`, with ids, streams and signals of their own and
to be killed, without the second that each would take to load the library."""

from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import traceback
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NoReturn

PICO = "import sys; from pico_cli.main import main; sys.exit(main())"


def started(
    program: str, *words: str, env: Mapping[str, str] | None = None, preexec_fn: Callable[[], object] | None = None,
    **options: Any,
) -> subprocess.Popen[str]:  # fmt: skip
    """Start the text of a program with words as its arguments; options are those of `subprocess.Popen`."""
    before = _open_files()

    def child() -> None:
        for number in _open_files() - before:  # one of them tells the parent that the program has begun
            with suppress(OSError):
                os.close(number)
        null = os.open(os.devnull, os.O_RDWR)
        for number in before:  # locks and pipes of the tests are not for it; no number gets free for another file
            os.dup2(null, number)
        if env is not None:
            os.environ.clear()
            os.environ.update(env)
        become(program, *words, first=preexec_fn)

    return subprocess.Popen(["pico"], preexec_fn=child, text=True, **options)  # noqa: PLW1509 - never a second thread


def ran(program: str, *words: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run the text of a program to its end; return its exit code and what it wrote."""
    process = started(program, *words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
    try:
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
    return subprocess.CompletedProcess(process.args, process.returncode, out, err)


def become(program: str, *words: str, first: Callable[[], object] | None = None) -> NoReturn:
    """Be the program from now on, in a process that was forked, and end with it; `first`: called before."""
    code = 1
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # as Python has it, and `subprocess` resets it
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        if first is not None:
            first()
        gc.freeze()
        gc.enable()
        sys.stdin, sys.stdout, sys.stderr = (open(n, "w" if n else "r", buffering=1, closefd=False) for n in range(3))  # noqa: SIM115
        sys.argv = ["-c", *words]
        exec(compile(program, "<string>", "exec"), {"__name__": "__main__"})
        code = 0
    except SystemExit as exc:
        code = exc.code if isinstance(exc.code, int) else exc.code is not None
    except BaseException:
        traceback.print_exc()
    finally:
        for stream in (sys.stdout, sys.stderr):
            with suppress(Exception):
                stream.flush()
        os._exit(code)


def _open_files() -> set[int]:
    return {int(path.name) for path in Path("/dev/fd").iterdir()} - {0, 1, 2}

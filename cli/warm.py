"""A process that has loaded what commands need, and has each command done by a child that is forked from it.

It reads one JSON document a line from standard input: `{"id", "words", "folder", "environment", "out", "err",
"confined"}` begins a command whose output goes to the files `out` and `err`, `{"id", "signal"}` tells it something. It
answers `{"ready": true}` once, then `{"id", "exit"}` for each command that has ended. At the end of its input it ends
the commands as Ctrl-C does, and itself.
"""

from __future__ import annotations

import gc
import json
import os
import pkgutil
import select
import shutil
import signal
import sys
import tempfile
import time
from contextlib import suppress
from importlib import import_module
from typing import Any

from .confined import confine

ROOMS = (
    "backends", "bench", "cameras", "content", "diagnosis", "edge", "execution", "expressions", "geometry", "history",
    "kernels", "manifest", "model", "motion", "optics", "optimize", "planning", "policy", "recipes", "runs", "staging",
    "twin", "vision",
)  # fmt: skip
LARGEST = 256 << 20
"""Bytes of a file that a command writes, what it says among them."""
WORDS = (sys.executable, "-P", "-m", __name__)
"""What starts it."""
ENDS = 20.0
"""Seconds in which commands end that were told to."""


def load() -> None:
    """Import what commands import while they work."""
    import pico

    from . import commands
    from .app import build

    build()
    names = [f"{commands.__name__}.{found.name}" for found in pkgutil.iter_modules(commands.__path__)]
    names += [
        found.name for room in ROOMS for found in pkgutil.walk_packages([f"{pico.__path__[0]}/{room}"], f"pico.{room}.")
    ]
    for name in (*names, "mujoco", "cv2", "networkx", "fcl", "ruckig", "PIL.Image", "websockets.sync.client"):
        with suppress(ImportError):
            import_module(name)
    _rehearse()


def _rehearse() -> None:
    """Do once what commands do, with an example: much of what they need is made when it is first used."""
    from pico.resources import labs_dir

    from .main import main as run

    with tempfile.TemporaryDirectory() as scratch:
        shutil.copytree(labs_dir() / "shel", f"{scratch}/lab")
        for words in (["validate"], ["status"], ["plan"]):
            run(["-C", f"{scratch}/lab", "--json", *words])


def main() -> None:
    """Serve standard input until its end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a terminal's Ctrl-C is for who started this
    asked, told = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDWR)
    os.dup2(nothing, 0)
    os.dup2(nothing, 1)
    load()
    gc.collect()
    gc.freeze()
    waking, waked = os.pipe()
    for end in (waking, waked):
        os.set_blocking(end, False)
    signal.set_wakeup_fd(waked, warn_on_full_buffer=False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.signal(signal.SIGTERM, lambda *_: os.close(asked))
    Warm(asked, told, waking).serve()


class Warm:
    """Commands by their number, each the process of a child."""

    def __init__(self, asked: int, told: int, waking: int) -> None:
        self._asked, self._told, self._waking = asked, told, waking
        self._children: dict[int, int] = {}

    def serve(self) -> None:
        """Begin what is asked for, and say what has ended."""
        self._tell({"ready": True})
        rest = b""
        while True:
            try:
                ready, _, _ = select.select([self._asked, self._waking], [], [])
                if self._waking in ready:
                    with suppress(BlockingIOError):
                        os.read(self._waking, 4096)
                    self._reap()
                if self._asked not in ready:
                    continue
                data = os.read(self._asked, 1 << 16)
            except OSError:  # told to end
                data = b""
            if not data:
                break
            *lines, rest = (rest + data).split(b"\n")
            for line in lines:
                self._do(json.loads(line))
        self._end()

    def _do(self, document: dict[str, Any]) -> None:
        if "signal" in document:
            for process, number in self._children.items():
                if number == document["id"]:
                    os.kill(process, document["signal"])
            return
        process = os.fork()
        if process == 0:
            for end in (self._asked, self._told, self._waking):
                os.close(end)
            _become(document)
        self._children[process] = document["id"]

    def _reap(self) -> None:
        while self._children:
            process, status = os.waitpid(-1, os.WNOHANG)
            if process == 0:
                return
            if (number := self._children.pop(process, None)) is not None:
                self._tell({"id": number, "exit": os.waitstatus_to_exitcode(status)})

    def _end(self) -> None:
        for number, until in ((signal.SIGTERM, time.monotonic() + ENDS), (signal.SIGKILL, time.monotonic() + 2 * ENDS)):
            for process in self._children:
                os.kill(process, number)
            while self._children and time.monotonic() < until:
                select.select([self._waking], [], [], 0.2)
                self._reap()

    def _tell(self, document: Any) -> None:
        with suppress(OSError):
            os.write(self._told, json.dumps(document).encode() + b"\n")


def _become(document: dict[str, Any]) -> None:
    """Be the command: never returns."""
    code = 1
    try:
        os.setsid()
        _end_with_parent()
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        for number in (signal.SIGCHLD, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)
        for name, standing in (("out", 1), ("err", 2)):
            file = os.open(document[name], os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
            os.dup2(file, standing)
            os.close(file)
        os.environ.clear()
        os.environ.update(document["environment"])
        os.chdir(document["folder"])
        sys.argv = ["pico", *document["words"]]
        _limit()
        if document["confined"]:
            confine(document["confined"])
        from .main import main as run

        code = run(document["words"])
    except BaseException as exc:
        with suppress(Exception):
            print(f"pico: {type(exc).__name__}: {exc}", file=sys.stderr)
    finally:
        with suppress(Exception):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code & 255)


def _end_with_parent() -> None:
    """Have the system end this process as Ctrl-C does when its parent is killed, where it can."""
    import ctypes

    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGTERM, 0, 0, 0)


def _limit() -> None:
    import resource

    for what, most in ((resource.RLIMIT_FSIZE, LARGEST), (resource.RLIMIT_CORE, 0)):
        hard = resource.getrlimit(what)[1]
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(what, (most, most))


if __name__ == "__main__":
    main()

"""One process of `mutants.py`: it imports PICO and collects the tests once, in a copy of the tree, and then forks for
each job that it reads, a line of JSON; a line of JSON answers each.

    map       run the tests of a file, and tell for each its CPU seconds and the lines of the product that it ran
    judge     plant a mutant and run tests by name until one fails

A mutant in a function changes the code of the function that is loaded already, so that nothing is imported or collected
again; one that acts at import takes a pytest of its own. What tests start as a process finds the mutant in the file.
"""

from __future__ import annotations

import gc
import importlib
import json
import os
import resource
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import pytest
from _pytest.runner import runtestprotocol
from mutating import Mutant

COPY = Path.cwd()
STARTS = 20.0
"""CPU seconds that fixtures and imports may take, beyond what the tests took when they were mapped."""
SLOWER = 4.0
"""How many times the CPU seconds of the map a test may take."""


class Worker:
    """Answers jobs in place of pytest's loop over the tests."""

    def __init__(self) -> None:
        self.jobs, self.answers = os.fdopen(os.dup(0)), os.dup(1)  # pytest takes the others for itself
        self.items: dict[str, pytest.Item] = {}
        self.functions: dict[tuple[str, str], list[FunctionType]] = {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        self.items = {item.nodeid: item for item in session.items}
        _import_all()
        for function in gc.get_objects():
            if isinstance(function, FunctionType) and function.__code__.co_filename.startswith(str(COPY)):
                key = function.__code__.co_filename, function.__code__.co_qualname
                self.functions.setdefault(key, []).append(function)
        gc.freeze()
        self.tell({"tests": list(self.items)})
        for line in self.jobs:
            job = json.loads(line)
            self.tell(self.judge(job) if "mutant" in job else self.map(job))
        return True

    def tell(self, answer: dict[str, Any]) -> None:
        _write_all(self.answers, (json.dumps(answer) + "\n").encode())

    def map(self, job: dict[str, Any]) -> dict[str, Any]:
        items = [item for nodeid, item in self.items.items() if nodeid.partition("::")[0] == job["file"]]
        return forked(lambda: mapped(items, job["files"]), 600.0) or {"tests": {}}

    def judge(self, job: dict[str, Any]) -> dict[str, Any]:
        mutant = Mutant(**job["mutant"])
        items = [self.items[nodeid] for nodeid in job["tests"]]
        seconds = STARTS + SLOWER * job["seconds"]
        file = COPY / mutant.file
        text = file.read_text()
        file.write_text(mutant.apply(text))
        before = _cpu_of_children()
        try:
            loaded = self.loaded(mutant, text) if mutant.function else None
            if loaded:
                answer = forked(lambda: first_failure(items, loaded), seconds)
            else:
                answer = anew([item.nodeid for item in items], seconds)
        finally:
            file.write_text(text)
        return (answer or {"outcome": "timed out"}) | {"cpu": _cpu_of_children() - before}

    def loaded(self, mutant: Mutant, text: str) -> Callable[[], None] | None:
        """Return what puts the mutant into the functions that are loaded; None where that can't be done."""
        path = str(COPY / mutant.file)
        right = _named(compile(text, path, "exec", dont_inherit=True), mutant.function)
        wrong = _named(compile(mutant.apply(text), path, "exec", dont_inherit=True), mutant.function)
        if right is None or wrong is None or right.co_freevars != wrong.co_freevars:
            return None
        live = [f for f in self.functions.get((path, mutant.function), ()) if f.__code__ == right]

        def plant() -> None:
            for function in live:
                function.__code__ = wrong

        return plant if live else None


def _cpu_of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _import_all() -> None:
    for file in sorted((COPY / "pico").rglob("*.py")):
        name = ".".join(file.relative_to(COPY).with_suffix("").parts).removesuffix(".__init__")
        if not name.endswith("__main__"):
            importlib.import_module(name)


def forked(work: Callable[[], dict[str, Any]], seconds: float) -> dict[str, Any] | None:
    """Return what a child answers; None where it takes more CPU seconds (or far more of the clock) than it may."""
    reads, writes = os.pipe()
    child = os.fork()
    if not child:
        os.setsid()
        quiet = os.open(os.devnull, os.O_RDWR)
        for fd in (0, 1, 2):
            os.dup2(quiet, fd)
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 5))
        try:
            answer = work()
        except BaseException as exc:
            answer = {"outcome": "killed", "by": f"the runner: {exc!r}"[:200]}
        _write_all(writes, json.dumps(answer).encode())
        os._exit(0)
    os.close(writes)
    data = _read_all(reads, time.monotonic() + 6 * seconds)
    with suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    if data:
        return dict(json.loads(data))
    died = os.WIFSIGNALED(status) and os.WTERMSIG(status) not in (signal.SIGXCPU, signal.SIGKILL)
    return {"outcome": "killed", "by": f"signal {os.WTERMSIG(status)}"} if died else None


def _write_all(fd: int, data: bytes) -> None:
    while data:
        data = data[os.write(fd, data) :]


def _read_all(fd: int, until: float) -> bytes:
    data = b""
    while select.select([fd], [], [], max(0.0, until - time.monotonic()))[0]:
        more = os.read(fd, 1 << 20)
        if not more:
            break
        data += more
    os.close(fd)
    return data


def first_failure(items: list[pytest.Item], plant: Callable[[], None]) -> dict[str, Any]:
    plant()
    for item, report in _run(items):
        if report.failed:
            return {"outcome": "killed", "by": item.nodeid}
    return {"outcome": "survived"}


def _run(items: list[pytest.Item]) -> Iterator[tuple[pytest.Item, pytest.TestReport]]:
    for item, following in zip(items, [*items[1:], None], strict=True):
        for report in runtestprotocol(item, nextitem=following, log=False):
            yield item, report


def mapped(items: list[pytest.Item], files: list[str]) -> dict[str, Any]:
    """Run tests, and return for each its CPU seconds and the lines that it ran, by file."""
    from coverage import Coverage

    cover = Coverage(data_file=None, config_file=False, include=[str(COPY / file) for file in files])
    seconds: dict[str, float] = {}
    cover.start()
    for item, following in zip(items, [*items[1:], None], strict=True):
        cover.switch_context(item.nodeid)
        start = time.process_time()
        reports = runtestprotocol(item, nextitem=following, log=False)
        if not any(report.failed or report.skipped for report in reports):
            seconds[item.nodeid] = round(time.process_time() - start, 3)
    cover.stop()
    found: dict[str, dict[str, Any]] = {n: {"seconds": s, "lines": {}} for n, s in seconds.items()}
    data = cover.get_data()
    for file in data.measured_files():
        name = Path(file).relative_to(COPY).as_posix()
        for line, contexts in data.contexts_by_lineno(file).items():
            for context in contexts:
                if context in found:
                    found[context]["lines"].setdefault(name, []).append(line)
    return {"tests": found}


def _named(code: CodeType, name: str) -> CodeType | None:
    found = [c for c in code.co_consts if isinstance(c, CodeType)]
    inside = [_named(c, name) for c in found if name.startswith(f"{c.co_qualname}.")]
    return next((c for c in (*found, *inside) if c and c.co_qualname == name), None)


def anew(nodeids: list[str], seconds: float) -> dict[str, Any] | None:
    """Run tests in a pytest of its own, until one fails."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-x",
        "-q",
        "-p",
        "no:cacheprovider",
        "--basetemp",
        str(COPY.parent / "anew"),
    ]
    child = subprocess.Popen(
        [*command, *nodeids], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True
    )
    try:
        out, _ = child.communicate(timeout=3 * seconds)
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()
        return None
    failed = [line for line in out.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return (
        {"outcome": "killed", "by": (failed or ["the import"])[-1][:200]}
        if child.returncode
        else {"outcome": "survived"}
    )


def main() -> None:
    """Work on the test files and folders that are named."""
    options = [
        "-q",
        "-m",
        "not slow",
        "-p",
        "no:cacheprovider",
        "-p",
        "no:xdist",
        f"--basetemp={COPY.parent / 'tests'}",
    ]
    sys.exit(pytest.main([*options, *sys.argv[1:]], plugins=[Worker()]))

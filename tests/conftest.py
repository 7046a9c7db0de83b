"""Properties draw the same examples in every CI run, and new ones on a developer's machine. The command line in
process: `pico("plan", "e1")` gives exit code, output and errors. An arm is asked once for a path: see `asked_once`."""

import ctypes
import gc
import os
import subprocess
import sys
from collections.abc import Generator
from pathlib import Path

os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # neither a process that a test starts compiles everything anew
os.environ.setdefault(
    "OPENBLAS_NUM_THREADS", "1"
)  # as the command has it: on a busy machine threads wait for one another

import pytest
from asked_once import ASKING, once
from commanding import Answer, Pico
from hypothesis import HealthCheck, settings

MEMORY = Path("/dev/shm")
ROOM = 4 << 30
"""Bytes that must be free in memory for the folders of tests to lie there."""


def _in_memory() -> bool:
    """Return whether the folders of tests can lie in memory, where making and removing their thousands of files costs
    half as much time: a file system with room, from which a hook of Git may be executed."""
    if "PYTEST_DEBUG_TEMPROOT" in os.environ or not os.access(MEMORY, os.W_OK | os.X_OK):
        return False
    found = os.statvfs(MEMORY)
    return found.f_bavail * found.f_frsize >= ROOM and not found.f_flag & os.ST_NOEXEC


sys.dont_write_bytecode = False  # nor does the next run of the tests
settings.register_profile(  # no test measures time: a busy machine fails none
    "ours", derandomize=bool(os.environ.get("CI")), deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("ours")


def pytest_configure(config: pytest.Config) -> None:
    """Let folders of tests lie in memory if they can; without slow tests, a property draws a third of its examples."""
    if _in_memory():
        os.environ["PYTEST_DEBUG_TEMPROOT"] = str(MEMORY)
    if config.getoption("markexpr") == "not slow":
        settings.register_profile("fast", settings(), max_examples=33)
        settings.load_profile("fast")


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Look for no garbage while the tests are imported, and never again among what they import: a test would do so in
    vain, and a process that it forks would get pages of its own for all of that. For the rest, look less often."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.collect()
        gc.freeze()
        gc.set_threshold(50_000, 20, 100)
        gc.enable()


def _resident() -> int:
    """Return the memory that this process holds, in bytes."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class _Trim:
    """Gives free memory back before a fork. A test may need a gigabyte for a moment; the C library keeps it, and from
    then on each fork copies the tables of all its pages: 60 ms instead of 15."""

    STEP = 64 << 20
    """Bytes of growth after which it is worth the while."""

    def __init__(self) -> None:
        self.trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform == "linux" else None
        self.least = 0

    def __call__(self) -> None:
        if self.trim is not None and _resident() > self.least + self.STEP:
            self.trim(0)
            self.least = _resident()


os.register_at_fork(before=_Trim())


@pytest.fixture
def pico(capsys: pytest.CaptureFixture[str]) -> Pico:
    from pico_cli.main import main

    def call(*words: str) -> Answer:
        capsys.readouterr()
        code = main(words)
        captured = capsys.readouterr()
        return Answer(int(code), captured.out, captured.err)

    return call


@pytest.fixture(scope="session")
def case_study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The case study in a repository, to be copied; its objects are in one pack, so that a copy has few files."""
    from pico.history.examples.example import make_example

    root = make_example("shel", tmp_path_factory.mktemp("case_study") / "shel").root
    subprocess.run(["git", "gc", "-q"], cwd=root, check=True)
    return root


@pytest.fixture(autouse=True)
def _asked_once(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where motion is not what is tested, no arm is asked again for a path that it has found before."""
    if not ASKING.isdisjoint(request.path.parts):
        once(monkeypatch)

"""What a command does not need it does not import. Times are measured by benchmarks/startup.py."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from pico.history.examples.example import make_example

HEAVY = (
    "rich", "pydantic", "numpy", "mujoco", "cv2", "networkx", "pygit2", "scipy", "typer", "yaml", "pint", "asyncio",
)  # fmt: skip
PROGRAM = """
import sys
from pico_cli.main import main
code = main(sys.argv[2:])
loaded = [name for name in sys.argv[1].split(",") if name in sys.modules]
print("loaded:", ",".join(loaded), "code:", code, file=sys.stderr)
"""


def loaded(words: list[str], folder: Path, names: tuple[str, ...] = HEAVY, **environment: str) -> set[str]:
    """Return which modules a fresh process has loaded after a command."""
    import os

    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, ",".join(names), *words],
        cwd=folder, capture_output=True, text=True, check=True, env=os.environ | environment,
    )  # fmt: skip
    line = done.stderr.strip().splitlines()[-1]
    assert line.startswith("loaded:") and line.endswith("code: 0"), done.stderr
    return set(line.removeprefix("loaded:").split(" code:")[0].strip().split(",")) - {""}


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("startup") / "shel"
    make_example("shel", folder)
    return folder


@pytest.mark.parametrize("words", [["--version"], ["--help"], []])
def test_version_and_help_import_nothing_heavy(words: list[str], tmp_path: Path) -> None:
    assert loaded(words, tmp_path) == set()


@pytest.mark.parametrize("words", [["pl"], ["move", "l"], ["plan", "E"]])
def test_completion_imports_nothing_heavy(words: list[str], bench: Path) -> None:
    assert loaded(words, bench, _PICO_COMPLETE="1") == set()


def test_a_plan_without_changes_loads_no_physics(bench: Path) -> None:
    assert loaded(["apply", "C3", "--auto-approve"], bench, ("rich",)) == set()
    unwanted = ("rich", "mujoco", "cv2", "networkx", "scipy", "numpy", "pint", "ruckig", "PIL")
    assert loaded(["plan", "--detailed-exitcode"], bench, unwanted) == set()
    assert loaded(["status"], bench, unwanted) == set()
    running = ("sqlite3", "pico.execution.walk", "pico.runs.journal", "pico.model.trace.run", "pico.model.trace.report")
    assert loaded(["plan"], bench, running) == set()
    assert loaded(["log", "--graph"], bench, ("networkx",)) == set()


def test_the_library_itself_is_light(tmp_path: Path) -> None:
    code = "import sys, pico; print([m for m in sys.argv[1].split(',') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code, ",".join(HEAVY)], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


COLLECTED = """
import gc
from pico_cli.main import main
main({words})
print(gc.isenabled(), gc.get_freeze_count() > 50_000)
"""


def collected(words: str, folder: Path, *arguments: str) -> str:
    """Return whether garbage is looked for after `main` was given some words, and whether much of it is left out."""
    command = [sys.executable, "-c", COLLECTED.replace("{words}", words), *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return done.stdout.splitlines()[-1]


def test_garbage_is_looked_for_once_all_is_loaded_and_never_among_that(bench: Path) -> None:
    assert collected("", bench, "plan") == "True True"
    assert collected("", bench, "log") == "True True"


def test_a_command_within_a_program_leaves_its_garbage_collector_alone(bench: Path) -> None:
    assert collected("['plan']", bench) == "True False"


def test_a_program_that_runs_several_commands_makes_each_once() -> None:
    from pico_cli.app import build

    assert build() is build() and build().get_command(None, "plan") is build().get_command(None, "plan")
    assert build().get_command(None, "plam") is None

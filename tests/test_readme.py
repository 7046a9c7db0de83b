"""What the README tells a newcomer to type works, in its order, in an empty folder."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text()


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


def environment(folder: Path) -> dict[str, str]:
    """Return an environment with the installed command and an author, and nothing of the user's git configuration."""
    scripts = sysconfig.get_path("scripts")
    author = {f"GIT_{who}_{what}": value for who in ("AUTHOR", "COMMITTER") for what, value in
              (("NAME", "A Physicist"), ("EMAIL", "physicist@localhost"))}  # fmt: skip
    null = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull, "HOME": str(folder)}
    return os.environ | author | null | {"PATH": scripts + os.pathsep + os.environ["PATH"]}


@pytest.mark.slow
def test_the_tour_runs_as_written(tmp_path: Path) -> None:
    commands = [line[2:] for block in blocks("console") for line in block.splitlines() if line.startswith("$ ")]
    assert len(commands) > 15
    (tmp_path / "pico").mkdir()  # the clone, in which it begins
    done = subprocess.run(
        ["bash", "-ex"], input="\n".join(commands), cwd=tmp_path / "pico", env=environment(tmp_path), text=True,
        capture_output=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert {"bench.png", "top.png"} <= {p.name for p in (tmp_path / "bench").iterdir()}
    (script,) = blocks("python")
    python = subprocess.run(
        [sys.executable, "-c", script],
        cwd=tmp_path / "bench",  # where the tour has led to
        env=environment(tmp_path),
        text=True,
        capture_output=True,
        check=False,
    )
    assert python.returncode == 0, python.stderr
    assert re.match(r"\d+ operations, \d+ s", python.stdout) and python.stdout.splitlines()[-1] == "0.5"


def test_every_file_the_readme_links_to_exists() -> None:
    for page in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")]:
        for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.relative_to(ROOT)} links to {target}, which is not there"


def test_the_command_reference_names_every_command() -> None:
    from pico_cli.commands import files

    page = (ROOT / "docs/reference/commands.md").read_text()
    assert files()
    assert not [name for name in files() if f"`{name}" not in page]

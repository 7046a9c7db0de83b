"""A relative path means what it means to the shell: from the folder where one works, or that of `-C`."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from commanding import Pico

WRITERS = {
    "render": ("render", "--view", "top", "--out", "../made.png"),
    "plan": ("plan", "e1", "--out", "../made.plan"),
    "graph": ("plan", "e1", "--graph", "--out", "../made.dot"),
    "diff": ("diff", "C3", "e1", "--picture", "../made.png"),
    "markers": ("calibrate", "markers", "--out", "../made.pdf"),
    "export": ("runs", "export", "--out", "../made.zip"),
    "init": ("init", "--example", "mach_zehnder", "../made"),
    "empty": ("init", "../made"),
}


@pytest.fixture(params=["cd", "-C"])
def way(request: pytest.FixtureRequest, shel: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[str, ...]:
    """How one works in the folder `state` of the lab: what comes before a command."""
    if request.param == "-C":
        return ("-C", "state")
    monkeypatch.chdir(shel / "state")
    return ()


@pytest.mark.parametrize("words", WRITERS.values(), ids=WRITERS)
def test_what_is_written_lies_where_the_shell_would_have_it(
    words: tuple[str, ...], way: tuple[str, ...], shel: Path, pico: Pico
) -> None:
    answer = pico(*way, *words)
    assert answer.code in (0, 2), answer.err
    made = [p for p in shel.parent.rglob("made*") if ".git" not in p.parts]
    assert made and {p.parent for p in made if "made" not in p.parent.name} == {shel}, made


READERS = {
    "diff": ("diff", "C3", "e1", "--", "table.yaml"),
    "log": ("log", "--oneline", "--", "./table.yaml"),
}


@pytest.mark.parametrize("words", READERS.values(), ids=READERS)
def test_what_is_read_is_found_where_the_shell_would_find_it(
    words: tuple[str, ...], way: tuple[str, ...], pico: Pico
) -> None:
    answer = pico(*way, *words)
    assert answer.code in (0, 2), answer.err


def test_a_plan_and_a_recipe_are_found_beside_the_folder(way: tuple[str, ...], shel: Path, pico: Pico) -> None:
    assert pico(*way, "plan", "e1", "--out", "../made.plan").code in (0, 2)
    assert "e1" in pico(*way, "plan", "../made.plan").out
    (shel.parent / "one.yaml").write_text(
        "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: one}\nsteps:\n  - set: {p1.angle: 3}\n", encoding="utf-8"
    )
    answer = pico(*way, "recipe", "check", "../../one.yaml")
    assert answer.code == 0, answer.err


def test_a_lab_beside_another_one_in_a_repository_is_made(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    subprocess.run(["git", "init", "-q"], cwd=shel.parent, check=True)
    monkeypatch.chdir(shel)
    answer = pico("init", "--example", "mach_zehnder", "../mz")
    assert answer.code == 0, answer.err
    assert (shel.parent / "mz/lab.yaml").is_file()

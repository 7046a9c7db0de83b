"""`pico test` of a recipe: in a clone that has what a fresh clone of the lab has, and an identity of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from pico.recipes.rehearsing import rehearse

HEAD = "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: one}\n"


@pytest.fixture
def fresh(case_study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A clone as a runner of continuous integration has it: the branches of `origin` alone, and no identity."""
    for name in [n for n in os.environ if n.startswith("GIT_")]:
        monkeypatch.delenv(name)
    for name in ("GIT_CONFIG_GLOBAL", "GIT_CONFIG_SYSTEM"):
        monkeypatch.setenv(name, os.devnull)
    monkeypatch.setenv("HOME", str(tmp_path))
    subprocess.run(["git", "clone", "-q", str(case_study), str(tmp_path / "fresh")], check=True)
    shutil.rmtree(tmp_path / "fresh" / "recipes")
    (tmp_path / "fresh" / "recipes").mkdir()
    return tmp_path / "fresh"


def tried(lab: Path, text: str) -> tuple[str, str]:
    (lab / "recipes" / "one.yaml").write_text(HEAD + text)
    found = rehearse(str(lab), "one", "kinematic")
    return found.outcome, " ".join([found.why, *(f"{d.summary} {d.detail}" for d in found.diagnostics)])


def test_a_branch_that_only_origin_has_is_found_as_git_checkout_finds_it(fresh: Path) -> None:
    local = subprocess.run(["git", "branch", "--list", "e1"], cwd=fresh, check=True, capture_output=True).stdout
    assert not local
    assert tried(fresh, "steps:\n- apply: e1\n- assert: p2.pose.yaw == 30\n") == ("done", "")


def test_who_has_no_git_identity_can_try_a_recipe_that_commits(fresh: Path) -> None:
    assert tried(fresh, "steps:\n- set: {p1.angle: 3}\n- capture:\n- commit: turned\n- note: {p1: seen}\n") == (
        "done",
        "",
    )


def test_a_mistake_is_told_of_the_file_of_the_lab_and_not_of_its_clone(fresh: Path) -> None:
    (fresh / "recipes" / "one.yaml").write_text(f"{HEAD}steps:\n- set: {{p1.angel: 3}}\n")
    (found,) = rehearse(str(fresh), "one", "kinematic").diagnostics
    assert found.source is not None and found.source.path == str(fresh / "recipes" / "one.yaml")


def test_a_recipe_that_wants_a_value_is_a_function_and_is_checked_and_not_run(fresh: Path) -> None:
    asks = "parameters: {angles: {kind: numbers, unit: deg}, tilt: 30}\n"
    outcome, why = tried(fresh, f"{asks}steps:\n- foreach: {{angle: angles}}\n  steps:\n  - set: {{p1.angle: angle}}\n")
    assert (outcome, why) == ("skipped", "a function: angles has no default")
    outcome, why = tried(fresh, f"{asks}steps:\n- set: {{p1.angel: 3}}\n")
    assert outcome == "failed" and "angel" in why

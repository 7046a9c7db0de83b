"""The fixtures that pytest has where PICO is installed."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RECIPE = """
apiVersion: pico/v1
kind: Recipe
metadata: {name: turn, title: Turn p1, lab: shel}
parameters:
  by: {unit: deg, default: 5}
steps:
  - set: {p1.angle: by}
  - {measure: p1.angle, as: seen}
returns: {angle: seen}
"""
TESTS = """
import pytest

pytestmark = pytest.mark.lab("shel")


def test_turns(bench):
    bench["p1"].angle = 10
    assert bench["p1"].angle.value == 10


def test_is_as_it_was(bench):
    assert bench["p1"].angle.value != 10 and bench.fidelity == "kinematic"


def test_recipe(recipe, bench):
    found = recipe("turn", by="7 deg")
    assert (found.outcome, found.returns["angle"]) == ("done", 7.0)
"""


def test_tests_of_a_lab_have_a_bench_and_its_recipes(case_study: Path, tmp_path: Path) -> None:
    subprocess.run(["git", "clone", "-q", str(case_study), str(tmp_path / "shel")], check=True)
    (tmp_path / "shel" / "recipes").mkdir(exist_ok=True)
    (tmp_path / "shel" / "recipes" / "turn.yaml").write_text(RECIPE)
    (tmp_path / "test_shel.py").write_text(TESTS)
    (tmp_path / "pytest.ini").write_text("[pytest]")
    words = ["-q", "--strict-markers", "-p", "pico.recipes.pytest_fixtures", "-p", "no:cacheprovider"]
    answer = subprocess.run(
        [sys.executable, "-m", "pytest", *words], check=False, cwd=tmp_path, capture_output=True, text=True,
        env={**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
    )  # fmt: skip
    assert "3 passed" in answer.stdout, answer.stdout
    assert not (tmp_path / "shel" / ".pico").exists()


def test_pytest_finds_them_where_pico_is_installed() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["entry-points"]["pytest11"] == {"pico": "pico.recipes.pytest_fixtures"}

"""Figures that a recipe declares: checked beforehand, and drawn of a run as it was, whatever the file says since."""

from __future__ import annotations

import csv
import io
import subprocess
from pathlib import Path

import pytest
from asking import read
from bench_at import bench_at
from commanding import Pico

from pico.bench.bench import Bench, new_lab
from pico.diagnostics import PicoError
from pico.recipes.figures.pictures import curves_of, pictures
from pico.recipes.figures.retold import retold
from pico.recipes.log import Log, logs
from pico.recipes.recipes import Recipes

TEXT = """apiVersion: pico/v1
kind: Recipe
metadata: {name: turned, title: Turned}
parameters: {angles: {unit: deg, default: [10, 20]}}
steps:
  - let: {seen: "[]", sure: "[]"}
  - foreach: {angle: angles}
    steps:
      - set: {p1.angle: angle}
      - {measure: p1.angle, as: read}
      - let: {seen: "seen + [read]", sure: "sure + [0.1]"}
  - commit: turned
  - tag: here
returns: {angles: angles, seen: seen, sure: sure, last: p1.angle, word: "'a'"}
figures:
  turned:
    title: What was seen
    x: angle [deg]
    y: seen [deg]
    series:
      each: {x: angles, y: seen, sigma: sure, theory: angles}
      last: {x: last, y: last}
notes: [the wind is inferred]
"""


@pytest.fixture
def shel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "A Physicist")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
    new_lab(tmp_path / "shel", "shel")
    (tmp_path / "turned.yaml").write_text(TEXT)
    return tmp_path / "shel"


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ("x: angels, y: seen", "returns no numbers called `angels`"),
        ("x: word, y: seen", "returns no numbers called `word`"),
        ("x: angles", "has no y"),
        ("x: angles, y: seen, sigmas: sure", "unknown key `sigmas`"),
    ],
)
def test_a_figure_of_what_is_not_returned_is_refused(wrong: str, said: str) -> None:
    body = TEXT[TEXT.index("parameters:") :]  # `read` puts the head before it
    _, found = read(body.replace("x: angles, y: seen, sigma: sure, theory: angles", wrong))
    assert any(said in one for one in found), found


def test_series_that_are_a_list_are_told_as_that(shel: Path) -> None:
    body = TEXT[TEXT.index("parameters:") :].replace("      each: {", "      - {")
    _, found = read(body.replace("      last: {x: last, y: last}\n", ""))
    assert any("`series` of the figure turned names no curve" in one for one in found), found


def test_a_run_is_drawn_as_it_was(shel: Path) -> None:
    """What it returned is told by its log alone; the file may be another since, or gone."""
    with Bench.open(shel) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(shel.parent / "turned.yaml"))
        outcome = recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, {})))
        assert outcome.outcome == "done", outcome
        (shel.parent / "turned.yaml").unlink()
        again, log = Recipes(bench).ran("turned")
        found = retold(again, log)
        assert found.returns == outcome.returns
        each, last = curves_of(again.figures["turned"], found.returns or {}, log.about.id)
        assert (each.x, each.theory, each.sigma, last.y) == ((10.0, 20.0), (10.0, 20.0), (0.1, 0.1), (20.0,))
        drawn = {name: draw() for name, draw in pictures(bench, again, log.about, found)}
        assert set(drawn) == {"commits", "trace", "turned"}
        with pytest.raises(PicoError, match="differ in length"):
            curves_of(again.figures["turned"], {**(found.returns or {}), "seen": [1.0]}, "r")
        with pytest.raises(PicoError, match="finite"):
            curves_of(again.figures["turned"], {**(found.returns or {}), "seen": [1.0, float("nan")]}, "r")
        with pytest.raises(PicoError, match="no recipe"):
            Recipes(bench).ran("other")
    subprocess.run(["git", "clone", "-q", str(shel), str(shel.parent / "clone")], check=True)
    with Bench.open(shel.parent / "clone") as elsewhere, pytest.raises(PicoError, match="log there") as caught:
        Recipes(elsewhere).ran("turned")
    assert f"`pico runs show {outcome.runs[0]}`" in str(caught.value)


def test_all_that_a_recipe_measured_is_one_table_whatever_runs_it_took(shel: Path, pico: Pico) -> None:
    shutting = TEXT.replace(
        "  - tag: here\n", "  - tag: here\n  - set: {p2.angle: 5}\n"
    )  # a run in which nothing is measured
    (shel.parent / "turned.yaml").write_text(shutting)
    assert pico("-C", str(shel), "run", str(shel.parent / "turned.yaml"), "-y").code == 0
    answer = pico("-C", str(shel), "runs", "export", "--as", "csv", "--recipe", "turned")
    rows = list(csv.DictReader(io.StringIO(answer.out)))
    assert [float(row["p1.angle"]) for row in rows] == [10.0, 20.0] and len({row["run"] for row in rows}) == 1
    last = pico("-C", str(shel), "runs", "export", "--as", "csv")
    assert last.code == 0 and "nothing was measured in" in last.err and "--recipe NAME" in last.err
    runs = [row["run"] for row in rows[:1]]
    alone = pico("-C", str(shel), "runs", "export", "--as", "csv", "--run", runs[0])
    assert alone.out.splitlines()[0].startswith("seq,t,at,measured") and len(alone.out.splitlines()) == 3
    listed = pico("-C", str(shel), "runs", "list").out
    assert "recipe turned" in listed, listed
    wrong = pico("-C", str(shel), "runs", "export", "--recipe", "turned")
    assert wrong.code == 1 and "--as csv --recipe NAME" in wrong.err


def test_what_was_cut_short_returned_nothing(shel: Path) -> None:
    """Its trace is told as far as it went."""
    with Bench.open(shel) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(shel.parent / "turned.yaml"))
        recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, {})))
        path = logs(bench_at(shel))[0]
        lines = path.read_text().splitlines(keepends=True)
        path.with_suffix(".lines").unlink()  # as of a run that was killed at each of these lines
        for cut in (1, len(lines) // 2, len(lines) - 3):
            path.write_text("".join(lines[:cut]))
            found = retold(recipe, Log.read(path))
            assert found.returns is None and "no end" in found.failed
            with pytest.raises(PicoError, match="returned nothing"):
                list(pictures(bench, recipe, Log.read(path).about, found))

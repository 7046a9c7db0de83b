"""Recipes made at random: what passes the check runs without a mistake of types, names or capabilities; a mistake in
one is told before anything moves."""

from __future__ import annotations

import random
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from generating import HELPER, MISTAKES, Maker, mistaken

from pico.bench.bench import Bench
from pico.recipes.recipes import Recipes
from pico.recipes.running import Outcome


@pytest.fixture(scope="module")
def bench(case_study: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    folder = tmp_path_factory.mktemp("generated") / "shel"
    with pytest.MonkeyPatch.context() as patched:
        for who in ("AUTHOR", "COMMITTER"):
            patched.setenv(f"GIT_{who}_NAME", "A Physicist")
            patched.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
        patched.setenv("GIT_CONFIG_GLOBAL", "/dev/null")
        shutil.copytree(case_study, folder)
        (folder / "recipes" / "helper.yaml").write_text(HELPER)
        with Bench.open(folder, fidelity="kinematic") as bench:
            yield bench


def ran(bench: Bench, text: str, name: str) -> Outcome:
    path = bench.root / "recipes" / f"{name}.yaml"
    path.write_text(text)
    recipes = Recipes(bench)
    recipe = recipes.read(str(path))
    return recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, {})))


@pytest.mark.parametrize("seed", [*range(6), *(pytest.param(n, marks=pytest.mark.slow) for n in range(6, 20))])
def test_what_passes_the_check_runs_without_a_mistake(bench: Bench, seed: int) -> None:
    found = ran(bench, Maker(seed, f"made{seed}").recipe(), f"made{seed}")
    assert not mistaken(found), found


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_at_its_line_and_nothing_moves(bench: Bench, mistake: str) -> None:
    journal, before = bench.root / ".pico/benches/sim" / "journal.sqlite", bench.observe().components
    known = journal.stat().st_size if journal.exists() else 0
    path = bench.root / "recipes" / "broken.yaml"
    path.write_text(Maker(random.Random(mistake).randrange(10_000), "broken").recipe(mistake))
    _, found = Recipes(bench).check(str(path))
    assert MISTAKES[mistake][0] in {d.code for d in found} and all(d.source for d in found), found
    assert bench.observe().components == before
    assert (journal.stat().st_size if journal.exists() else 0) == known

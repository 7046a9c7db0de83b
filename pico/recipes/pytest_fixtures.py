"""For pytest: `bench`, a copy of a lab in a simulator of its own, and `recipe`, which runs a recipe on it.

The lab is that around the test's file, or of the marker `lab("labs/shel", fidelity="physics")`, a path from where
pytest found its configuration. Nothing that a test does to it is there afterwards.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pico.recipes.running import Outcome
    from pico.scripting.bench import Bench


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known."""
    config.addinivalue_line("markers", "lab(path, fidelity='kinematic'): the lab that `bench` is a copy of")


@pytest.fixture
def bench(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Bench]:
    """A bench of its own: a clone of the lab with its history, in the simulator."""
    from pico.backends.devices import SIMULATOR
    from pico.manifest.load import find_lab
    from pico.recipes.rehearsing import clone
    from pico.scripting.bench import Bench

    marker = request.node.get_closest_marker("lab")
    asked = request.config.rootpath / str(marker.args[0]) if marker and marker.args else request.path.parent
    lab = clone(find_lab(asked), tmp_path / "lab")
    fidelity = marker.kwargs.get("fidelity", "kinematic") if marker else "kinematic"
    with Bench.open(lab, fidelity=fidelity, bench=SIMULATOR) as opened:
        yield opened


@pytest.fixture
def recipe(bench: Bench) -> Callable[..., Outcome]:
    """What runs a recipe of the lab by name, its parameters as a person writes them: `recipe("tilt_scan",
    tilts="[0, 30]")`, and returns how it went; raises PicoError for a recipe that is wrong."""
    from pico.recipes.recipes import Recipes

    recipes = Recipes(bench)

    def run(name: str, **given: object) -> Outcome:
        found = recipes.read(name)
        arguments = recipes.arguments(found, {key: str(value) for key, value in given.items()})
        return recipes.run(found, recipes.begin(found, arguments))

    return run

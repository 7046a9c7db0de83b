"""The recipes that example labs bring along come to their end in the simulator, and agree with theory."""

from __future__ import annotations

from pathlib import Path

import pytest

from pico.history.examples.example import make_example
from pico.recipes.rehearsing import rehearse_all
from pico.resources import labs_dir

LABS = sorted(path.parent.name for path in labs_dir().glob("*/recipes"))


@pytest.mark.slow
@pytest.mark.parametrize("lab", LABS)
def test_they_are_done_as_pico_test_does_them(lab: str, tmp_path: Path) -> None:
    make_example(lab, tmp_path / lab)
    names = [path.stem for path in (labs_dir() / lab / "recipes").glob("*.yaml")]
    found = rehearse_all(tmp_path / lab, names)
    assert found and all(one.passed for one in found), [(o.name, o.at, o.diagnostics) for o in found if not o.passed]
    for one in found:
        if one.name == "shel":
            for y, theory in zip(one.returns["e1_y"], one.returns["e1_theory"], strict=True):
                assert y == pytest.approx(theory, rel=0.005, abs=0.1)  # nothing stands wrong here: theory alone
            assert abs(one.returns["e2_y"]) < abs(one.returns["e3_y"])

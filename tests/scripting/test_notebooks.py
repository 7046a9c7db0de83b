"""The notebooks of the documentation give what they show."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from notebooks import executed, same, written

NOTEBOOKS = Path(__file__).resolve().parents[2] / "docs" / "notebooks"


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(p.stem for p in NOTEBOOKS.glob("*.ipynb")))
def test_a_notebook_gives_what_it_shows(name: str, tmp_path: Path) -> None:
    path = NOTEBOOKS / f"{name}.ipynb"
    notebook = json.loads(path.read_text(encoding="utf-8"))
    found = executed(notebook, tmp_path)
    if os.environ.get("PICO_UPDATE_GOLDEN"):
        written(found, path)
    assert same(found) == same(json.loads(path.read_text(encoding="utf-8")))

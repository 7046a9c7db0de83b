"""What a type says of its optics can't be nonsense: it is told with its line, and what would be right."""

from __future__ import annotations

import pytest

from pico.diagnostics import Diagnostic
from pico.manifest.catalog import read_type
from pico.manifest.files import decode
from pico.manifest.text.tree import parse
from pico.resources import catalog_dir


def told(name: str, old: str, new: str) -> list[Diagnostic]:
    """Return what is wrong with a type of the catalog in which a text is another."""
    text = (catalog_dir() / f"{name}.yaml").read_text()
    assert old in text
    source, found = decode("own.yaml", text.replace(old, new, 1).encode())
    assert source is not None and not found
    return list(read_type(parse(source)[0][0])[1])


CAM, SPLITTER = "beam_camera", "beam_splitter_50_50"


@pytest.mark.parametrize(
    ("name", "old", "new", "said", "hint"),
    [
        (CAM, "{value: 2448,", "{value: -3,", "`pixels_across` is -3 pixel, which can't be", "from 1 to 20000"),
        (CAM, "filter_density: {value: 1,", "filter_density: {value: dark,", "`dark`", "expected a number"),
        (CAM, "{value: 3.45, unit: um}", "{value: 3.45, unit: ms}", "`3.45` in ms", "a number [um]"),
        ("plano_convex_100", "focal_length: {value: 100,", "focal_length: {value: 0,", "is 0 mm", "other than 0"),
        ("linear_polarizer", "{value: film,", "{value: films,", "`films`", "did you mean `film`?"),
        ("linear_polarizer", "{value: 0.8,", "{value: 1.8,", "`transmission` is 1.8", "from 0 to 1"),
        ("hene_laser", "{value: 0.315,", "{value: -1,", "`waist_radius` is -1 mm", "from 0.0001 to 1000 mm"),
        (SPLITTER, "transmittance: {value: 0.", "transmittance: {value: 0.9", "more light leaves", "1 or less"),
    ],
)
def test_it_is_told_where_it_stands(name: str, old: str, new: str, said: str, hint: str) -> None:
    (found,) = told(name, old, new)
    assert found.severity == "error" and found.source is not None
    assert said in found.summary and hint in (found.hint or ""), found

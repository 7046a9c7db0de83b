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


CAM, SPLITTER, MODES = "beam_camera", "beam_splitter_50_50", "hene_laser_two_modes"


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
        ("room_lamp", "{value: 700,", "{value: -700,", "`stray_irradiance` is -700 nW/mm^2", "0 or more nW/mm^2"),
        ("room_lamp", "{value: 700,", "{value: bright,", "`stray_irradiance` is `bright`", "expected a number"),
        ("iris", "diameter: 11.5", "diameter: -12", "which can't be", "expected above 0 mm"),
        (MODES, "center: -250 MHz", "center: 3 kg", "line 1: `3 kg` is neither a frequency nor", "MHz from the"),
        (MODES, "center: -250 MHz", "center: -1 nm", "line 1: `-1 nm` is no wavelength", "or a wavelength, `633 nm`"),
        (MODES, "center: 250 MHz", "center: 900 THz", "the center of line 2 is `900 THz`, which can't be", "MHz"),
        (MODES, "width: 1 MHz", "width: -1", "the width of line 1 is `-1.0`, which can't be", "MHz, or a width"),
        (MODES, "width: 1 MHz", "width: wide", "the width of line 1: `wide` is not a quantity", "MHz, or a width"),
        (MODES, "shape: lorentzian", "shape: lorenzian", "`lorenzian`", "did you mean `lorentzian`?"),
        (MODES, "shape: lorentzian", "share: -0.5", "the share of line 1 is -0.5", "0 or more"),
        (
            "delay_stage",
            "element: roof_mirror",
            "element: roof_mirror\n  lines: []",
            "the spectrum of a source",
            "leave",
        ),
        ("white_light_source", "shape: gaussian", "share: 0", "share no power", "`share` above 0"),
        (CAM, "shutter: closed", "shutter: shut", "`dark` needs `shutter`, which is one of", "a value that it takes"),
        (
            CAM,
            "illumination: false",
            "illumination: 3",
            "`image` needs `illumination`, which is true",
            "a value that it takes",
        ),
        (CAM, "{illumination: false}", "{exposure: 5000}", "`image` needs `exposure`, which goes from", "it takes"),
    ],
)
def test_it_is_told_where_it_stands(name: str, old: str, new: str, said: str, hint: str) -> None:
    (found,) = told(name, old, new)
    assert found.severity == "error" and found.source is not None
    assert said in found.summary and hint in (found.hint or ""), found


def test_a_need_that_nothing_known_has_is_told() -> None:
    (found,) = told(CAM, "{shutter: closed,", "{shuter: closed,")
    assert found.severity == "warning" and "`shuter`" in found.summary and found.hint == "did you mean `shutter`?"

"""`pico catalog page`: each type once, with its drawing, in a file that needs nothing else; `pico catalog new`."""

from __future__ import annotations

import base64
import re
from pathlib import Path

import cv2
import numpy as np
import pytest
from commanding import Pico, edit

from pico.drawing.portrait import portrait
from pico.manifest.catalog import catalog_names, load_catalog


def test_a_portrait_shows_the_component_in_the_middle() -> None:
    seen = portrait(load_catalog()["power_meter"], 160, 140).astype(int)
    edge, middle = seen[:20, :20].reshape(-1, 3), seen[40:100, 60:100].reshape(-1, 3)
    assert seen.shape == (140, 160, 3) and middle.std() > 2 * edge.std()


@pytest.mark.slow
def test_the_page_has_a_drawing_of_each_type_and_loads_nothing(shel: Path, pico: Pico) -> None:
    assert pico("catalog", "new", "own_lens", "--from", "plano_convex", "--set", "focal_length=80").code == 0
    answer = pico("catalog", "page", "--out", "page.html")
    assert answer.code == 0 and "Wrote page.html" in answer.out
    html = (shel / "page.html").read_text()
    found = dict(re.findall(r'<article id="(\w+)"><img src="data:image/png;base64,([^"]+)"', html))
    assert found.keys() == {*catalog_names(), "own_lens"}
    assert not re.search(r"https?://|<script|<link", html)
    for name, picture in found.items():
        drawn = cv2.imdecode(np.frombuffer(base64.b64decode(picture), np.uint8), 1)
        assert drawn.shape == (280, 320, 3) and drawn.std() > 10, name


def test_a_type_is_begun_from_the_command_line(shel: Path, pico: Pico) -> None:
    answer = pico("catalog", "new", "own_lens", "--from", "plano_convex", "--set", "focal_length=80")
    assert answer.code == 0 and "Wrote types/own_lens.yaml" in answer.out
    assert "own_lens" in pico("catalog").out and pico("validate").code == 0
    line = answer.out.splitlines()[-1]
    edit(shel / "lab.yaml", "inventory:\n", f"inventory:\n{line}\n")
    said = pico("validate").err  # the only free slot of this lab lies in the beam
    assert set(re.findall(r"error\[(.*?)]", said)) <= {"beam-audit"}, said
    bolted = pico("catalog", "new", "own_laser", "--from", "hene_laser")
    assert bolted.code == 0 and "pose: {x: " in bolted.out and "marker" not in bolted.out
    assert "there is a type `own_lens` already" in pico("catalog", "new", "own_lens", "--from", "iris").err

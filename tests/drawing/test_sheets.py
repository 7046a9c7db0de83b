"""The drawing as SVG: valid, at true scale, every component named once, no name on another one."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physical import LABS, bench

from pico.drawing.label_places import free_place, overlap
from pico.drawing.sheet import sheet
from pico.drawing.svg import Box, text_box
from pico.manifest.load import load_folder
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import home_state, place_of

SVG = "{http://www.w3.org/2000/svg}"


def homes(setup: Setup) -> dict[str, Pose]:
    return {name: place_of(setup, home_state(setup), name)[1] for name in setup.lab.inventory}


def boxes(root: ET.Element) -> list[tuple[str, Box]]:
    """Return each text with the room that it takes."""
    found = []
    for text in root.iter(f"{SVG}text"):
        at, size = (float(text.get("x", "")), float(text.get("y", ""))), float(text.get("font-size", ""))
        box = text_box(text.text or "", at, size, text.get("text-anchor", ""), text.get("font-weight") == "bold")
        assert box[2] - box[0] == pytest.approx(float(text.get("textLength", "")), rel=1e-4)
        assert "stroke" not in text.attrib  # a viewer without `paint-order` draws it over the letters
        found.append((text.text or "", box))
    return found


@pytest.mark.parametrize("lab", ["shel", "minimal", "crowded", "two_arms"])
def test_no_name_lies_on_another_one_and_each_is_there(lab: str) -> None:
    setup, _ = load_folder(LABS / lab).require()
    root = ET.fromstring(sheet(setup, homes(setup)))
    texts = boxes(root)
    assert root.get("font-family", "").endswith(", sans-serif")  # where none of the named ones is installed
    for (a, box_a), (b, box_b) in combinations(texts, 2):
        assert not overlap(box_a, box_b), f"{a} lies on {b}"
    for name in setup.lab.inventory:
        assert sum(text == name for text, _ in texts) >= 2  # in the drawing and in the parts list
    _, _, width, height = (float(v) for v in root.get("viewBox", "").split())
    assert all(b[0] >= 0 and b[1] >= 0 and b[2] <= width and b[3] <= height for _, b in texts)


def test_a_unit_is_a_millimetre() -> None:
    setup = bench()
    root = ET.fromstring(sheet(setup, homes(setup)))
    _, _, width, height = root.get("viewBox", "").split()
    assert (root.get("width"), root.get("height")) == (f"{width}mm", f"{height}mm")
    corners = root.find(f"{SVG}g[@id='table']/{SVG}polygon").get("points")  # type: ignore[union-attr]
    xs, ys = zip(*((float(v) for v in pair.split(",")) for pair in (corners or "").split()), strict=True)
    assert (max(xs) - min(xs), max(ys) - min(ys)) == setup.lab.table.size
    holes = root.find(f"{SVG}g[@id='table']/{SVG}path").get("d")  # type: ignore[union-attr]
    assert len(re.findall("M", holes or "")) == 48 * 36


def test_what_xml_knows_is_escaped_and_what_is_gone_is_left_out() -> None:
    setup = bench()
    poses = homes(setup)
    del poses["cam"]
    root = ET.fromstring(sheet(setup, poses, subtitle="e1 <a & b>"))
    texts = [text for text, _ in boxes(root)]
    assert any("e1 <a & b>" in text for text in texts)
    assert "cam" not in texts
    assert "f = 125 mm" in next(t for t in texts if t.startswith("f = 125"))


names = st.tuples(st.floats(0, 900), st.floats(0, 900), st.floats(10, 120))


@settings(max_examples=40)
@given(st.lists(names, min_size=1, max_size=25))
def test_names_spread_until_each_has_room(wanted: list[tuple[float, float, float]]) -> None:
    taken: list[Box] = []
    for x, y, width in wanted:
        box, _ = free_place((x, y, x + 30, y + 30), width, 12, taken, (-500, -500, 1500, 1500))
        assert not any(overlap(box, other) for other in taken)
        taken.append(box)

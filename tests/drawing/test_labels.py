"""Names in pictures: every one is there, none lies on another one or on a part, in all views of all shipped labs."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from physical import LABS

from pico.bench.picturing.contents import standing
from pico.drawing.canvas import Canvas
from pico.drawing.dimensions import Dimension
from pico.drawing.label_places import Box, bounds, meets, overlap
from pico.drawing.labels import Anchor, label
from pico.drawing.outlines import outline
from pico.drawing.picture import placed, posed_model, scene_extent, shadows, top_of
from pico.drawing.standpoint import hidden, standpoint
from pico.drawing.steps import DrawnStep
from pico.drawing.topview import drawn, new_canvas
from pico.manifest.load import load_folder
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import LabState, home_state

SIZES = ((960, 785), (960, 720), (640, 480), (1600, 1000))


def lab_of(name: str) -> tuple[Setup, LabState]:
    return load_folder(LABS / name).require()


def crossing(words: list[tuple[str, Box]], things: dict[str, Box]) -> list[tuple[str, str]]:
    pairs = [(a, b) for (a, box), (b, other) in combinations(words, 2) if overlap(box, other)]
    return pairs + [(word, name) for word, box in words for name, thing in things.items() if overlap(box, thing)]


def parts_of(canvas: Canvas, setup: Setup, poses: dict[str, Pose]) -> dict[str, Box]:
    shapes = {name: outline(setup.type_of(name).geometry.footprint, pose) for name, pose in poses.items()}
    return {name: bounds([canvas.pixel(p) for p in shape]) for name, shape in shapes.items()}


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("goal", ["manifest", "home"])
@pytest.mark.parametrize("name", ["shel", "minimal", "crowded", "two_arms"])
def test_from_above_every_part_is_named_and_no_name_lies_on_anything(
    name: str, goal: str, size: tuple[int, int]
) -> None:
    setup, state = lab_of(name)
    poses = standing(setup, state if goal == "manifest" else home_state(setup))
    canvas = drawn(setup, poses, {}, width=size[0], height=size[1], ghosts={}, labels=True, beams=True)
    parts = parts_of(canvas, setup, poses)
    assert not crossing(canvas.words, parts)
    lines = [(part, start, end, [*parts.items(), *canvas.words]) for part, start, end in canvas.leaders]
    met = [part for part, start, end, all_ in lines if meets(start, end, [box for n, box in all_ if n != part])]
    assert len(met) <= 3 * (name == "crowded") or size < (960, 720), met  # its parts stand a finger apart
    if size >= (960, 720):
        assert set(poses) <= {word for word, _ in canvas.words}
    assert all(box[0] >= 0 and box[1] >= 0 for _, box in canvas.words)
    assert all(box[2] <= size[0] and box[3] <= size[1] for _, box in canvas.words)


def test_without_a_height_a_picture_is_as_high_as_the_table_and_what_stands_on_it() -> None:
    for name in ("shel", "two_arms"):  # 1200 x 900 and 2000 x 900 mm
        setup, state = lab_of(name)
        canvas = new_canvas(setup, 960, None)
        width, depth = setup.lab.table.size
        (left, foot), (right, top) = canvas.pixel((0.0, 0.0)), canvas.pixel((width, depth))
        assert left == pytest.approx(960 - right) and left < 0.04 * 960
        assert 0 < top < 70 and 0 < canvas.bounds[3] - foot < 70
        model, data = posed_model(setup, placed(standing(setup, state)), {})
        points = scene_extent(setup, model, data)
        view = standpoint(model, data, standing(setup, state), points, 960, None)
        u, v, _ = view.project(points).T
        assert 0 < v.min() < 60 and 0 < view.height - v.max() < 60 and u.min() > 0 and u.max() < 960
        assert u.max() - u.min() > 0.9 * 960  # nothing is made small for the sake of a band


@pytest.mark.parametrize("name", ["shel", "minimal", "crowded", "two_arms"])
def test_numbers_and_turns_of_steps_lie_on_no_name(name: str) -> None:
    setup, state = lab_of(name)
    before, after = standing(setup, home_state(setup)), standing(setup, state)
    moved = [part for part in before if before[part] != after[part]]
    steps = [
        DrawnStep(number=n, title=part, words="", component=part, start=before[part], goal=after[part])
        for n, part in enumerate(moved, 1)
    ]
    canvas = drawn(setup, before, {}, width=960, height=720, ghosts={}, labels=True, beams=True, steps=steps)
    assert {str(step.number) for step in steps} <= {word for word, _ in canvas.words}
    assert not crossing(canvas.words, {})


def test_measures_of_a_ruler_lie_on_no_name() -> None:
    setup, state = lab_of("shel")
    poses = standing(setup, state)
    lengths = [Dimension((120, 420), (520, 700), "487.9 mm"), Dimension((300, 420), (520, 420), "220 mm")]
    canvas = drawn(setup, poses, {}, width=960, height=720, ghosts={}, labels=True, beams=True, dimensions=lengths)
    assert {"487.9 mm", "220 mm", "dx +400", "dy +280"} <= {word for word, _ in canvas.words}
    assert not crossing(canvas.words, parts_of(canvas, setup, poses))


@pytest.mark.parametrize("goal", ["manifest", "home"])
@pytest.mark.parametrize("name", ["shel", "minimal", "crowded", "two_arms"])
def test_in_perspective_every_part_is_seen_and_named_and_no_name_lies_on_anything(name: str, goal: str) -> None:
    setup, state = lab_of(name)
    places = placed(standing(setup, state if goal == "manifest" else home_state(setup)))
    model, data = posed_model(setup, places, {})
    view = standpoint(model, data, places, scene_extent(setup, model, data), 960, None)
    assert not hidden(model, data, view, places)
    taken = shadows(view, model, data)
    tops = {n: (p.position[0], p.position[1], top_of(setup, n, p)) for n, p in places.items()}
    image = np.zeros((view.height, view.width, 3), np.uint8)
    boxes = label(image, view, [Anchor(n, at) for n, at in sorted(tops.items())], taken)
    assert boxes.keys() == places.keys()
    assert not crossing(sorted(boxes.items()), {str(n): box for n, (_, box) in enumerate(taken)})

"""Names in pictures: every one is there, none lies on another one or on a part, in all views of all shipped labs."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from physical import LABS

from pico.bench.picture_contents import standing
from pico.drawing.canvas import Canvas
from pico.drawing.dimensions import Dimension
from pico.drawing.label_places import Box, bounds, overlap
from pico.drawing.labels import Anchor, label
from pico.drawing.outlines import outline
from pico.drawing.picture import placed, posed_model, scene_extent, shadows, top_of, viewpoint
from pico.drawing.steps import DrawnStep
from pico.drawing.topview import drawn
from pico.manifest.load import load_folder
from pico.model.lab import Setup
from pico.model.pose import Pose
from pico.model.state import LabState, home_state

SIZES = ((960, 720), (640, 480), (1600, 1000))


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
    assert not crossing(canvas.words, parts_of(canvas, setup, poses))
    if size >= (960, 720):
        assert set(poses) <= {word for word, _ in canvas.words}
    assert all(box[0] >= 0 and box[1] >= 0 for _, box in canvas.words)
    assert all(box[2] <= size[0] and box[3] <= size[1] for _, box in canvas.words)


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


@pytest.mark.parametrize("name", ["shel", "minimal", "crowded", "two_arms"])
def test_in_perspective_every_part_is_named_and_no_name_lies_on_anything(name: str) -> None:
    setup, state = lab_of(name)
    places = placed(standing(setup, state))
    model, data = posed_model(setup, places, {})
    view = viewpoint(setup, scene_extent(setup, model, data), 960, 720)
    taken = shadows(view, model, data)
    tops = {n: (p.position[0], p.position[1], top_of(setup, n, p)) for n, p in places.items()}
    image = np.zeros((720, 960, 3), np.uint8)
    boxes = label(image, view, [Anchor(n, at) for n, at in sorted(tops.items())], taken)
    assert boxes.keys() == places.keys()
    assert not crossing(sorted(boxes.items()), {str(n): box for n, box in enumerate(taken)})

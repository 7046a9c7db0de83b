"""Which shutter on the table closes a beam: one that stands square in it before anything else, and stays there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest
from laser_lab import POSES, bench, carry, observed, set_to

from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.pose import Pose
from pico.planning.checks.beams import SQUARE, shutter_of

SETUP = bench()


def shutter(seen: Observation, operations: Sequence[Operation] = (), laser: str = "laser") -> str | None:
    return shutter_of(SETUP, seen, operations, laser)


def standing(**poses: Pose) -> Observation:
    seen = observed()
    parts = {n: replace(c, pose=poses.get(n, c.pose)) for n, c in seen.components.items()}
    return replace(seen, components=parts)


def test_the_first_thing_in_a_beam_closes_it_if_it_is_a_shutter() -> None:
    assert shutter(standing()) == "gate"
    assert shutter(standing(), laser="second") is None and shutter(standing(), laser="bare") is None
    assert shutter(standing(holder=Pose(220, 420, 0))) is None, "something stands before it"
    assert shutter(standing(gate=Pose(300, 500, 0))) is None
    assert shutter(standing(gate=Pose(700, 420, 0))) is None


@pytest.mark.parametrize("presence", ["missing", "held", "toppled"])
@pytest.mark.parametrize("who", ["laser", "gate"])
def test_laser_and_shutter_must_be_seen(presence: str, who: str) -> None:
    seen = standing()
    part = replace(seen.components[who], presence=presence)  # type: ignore[arg-type]
    assert shutter(replace(seen, components={**seen.components, who: part})) is None
    none = replace(seen.components[who], pose=None)
    assert shutter(replace(seen, components={**seen.components, who: none})) is None
    assert shutter(Observation(backend="sim")) is None


@pytest.mark.parametrize(("yaw", "square"), [
    (0, True), (SQUARE, True), (-SQUARE, True), (SQUARE + 1, False), (-SQUARE - 1, False), (180, True), (160, True),
    (200, True), (159, False), (90, False), (340, True),
])  # fmt: skip
def test_a_shutter_that_is_turned_out_of_the_beam_does_not_count(yaw: float, square: bool) -> None:
    assert shutter(standing(gate=Pose(300, 420, yaw))) == ("gate" if square else None)


@pytest.mark.parametrize(("op", "stays"), [
    (carry("gate", 300, 600), False), (carry("gate", 300, 420), False), (carry("laser", 100, 420), False),
    (carry("holder", 220, 420), False), (carry("holder", 700, 420), True), (carry("holder", 220, 600), True),
    (set_to("gate", "shutter", "closed"), True), (set_to("holder", "to", {"slot": "a"}), True),
])  # fmt: skip
def test_what_moves_it_or_comes_before_it_leaves_the_beam_open(op: Operation, stays: bool) -> None:
    assert shutter(standing(), [op]) == ("gate" if stays else None)
    assert shutter(standing(), [carry("cam", 1000, 100, "c"), op]) == ("gate" if stays else None)
    assert POSES["gate"] == Pose(300, 420, 0)

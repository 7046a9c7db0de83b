"""The arm alone brings a part to the light."""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest

import pico
from pico.bench.bench import new_lab
from pico.bench.placing import MET, Try, _over, across, next_place, shifted
from pico.diagnostics import PicoError
from pico.model.pose import Pose

DIM = """  grey:
    type: neutral_density_filter
    pose: {x: 340, y: 420, yaw: 0}
    parameters: {optical_density: 4.5}
"""


@pytest.fixture
def minimal(tmp_path: Path) -> Path:
    folder = tmp_path / "minimal"
    new_lab(folder, "minimal")
    lab = folder / "lab.yaml"
    lab.write_text(lab.read_text().replace("inventory:\n", f"sim: {{environment: none}}\ninventory:\n{DIM}", 1))
    return folder


def test_a_lens_that_a_hand_pushed_aside_is_put_back_into_the_light(minimal: Path) -> None:
    with pico.open(minimal) as bench:
        assert bench.apply().outcome == "done"
        bench.sim.nudge("lens", dy=0.6)
        heard: list[Try] = []
        found = bench.placing.center("lens", "camera", tell=heard.append)
        assert found.met and tuple(heard) == found.tries and len(found.tries) == 2
        assert found.slope == pytest.approx(1.0, abs=0.02)  # a focal length behind it the spot moves as the lens does
        assert found.tries[0].off == pytest.approx(0.6, abs=0.02) and found.tries[0].sent is None
        pose = bench.observe().components["lens"].pose
        assert pose is not None and pose.y == pytest.approx(420, abs=0.02)
        assert found.first.y == pytest.approx(420.6) and found.tries[1].run


def test_what_no_arm_moves_and_what_sees_nothing_is_refused(minimal: Path) -> None:
    with pico.open(minimal) as bench:
        for words, said in (
            (("laser", "camera"), "no arm may move"),
            (("lens", "laser"), "does not measure a centroid"),
        ):
            with pytest.raises(PicoError, match=said):
                bench.placing.center(*words)
        with pytest.raises(PicoError, match="lens is in storage"):
            bench.placing.center("lens", "camera")  # it is in storage


def test_where_it_stays_dark_it_ends_and_says_so(minimal: Path) -> None:
    with pico.open(minimal) as bench:
        bench.apply()
        bench.apply(bench.single("laser", "set", emission="false"))
        found = bench.placing.center("lens", "camera")
        assert not found.met and "light" in found.why and len(found.tries) == 1


def test_the_mean_of_what_the_tries_say_finds_the_place_whatever_the_arm_does_wrong() -> None:
    """An arm that puts parts 0.15 mm aside of where it is sent, and 0.1 mm (one standard deviation) more at random."""
    for seed in range(300):
        rng = random.Random(seed)
        place = rng.uniform(-0.4, 0.4)  # where the part would be right
        tries = [Try(None, rng.gauss(0.0, 0.3) - place)]
        while not (why := _over(tries, 0.1, 12)):
            sent = next_place(tries, 0.0)
            tries.append(Try(sent, sent + 0.15 + rng.gauss(0, 0.1) - place))
        assert why == MET and abs(tries[-1].off or 0.0) <= 0.1


def test_left_is_to_the_left_of_the_part() -> None:
    pose = Pose(100, 200, 90)
    assert shifted(pose, 2.0) == Pose(98, pytest.approx(200), 90)
    assert across(pose, shifted(pose, 2.0)) == pytest.approx(2.0) and math.isclose(across(pose, pose), 0.0)

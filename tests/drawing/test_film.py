"""A film shows the run as it went: what moved moves, what stood stands, and it can be played however early it ends."""

from __future__ import annotations

import resource
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from physical import bench

from pico.diagnostics import PicoError
from pico.drawing.film.camerawork import build_set
from pico.drawing.film.film import Caption, write_film
from pico.drawing.film.gif import GifWriter
from pico.drawing.label_places import overlap
from pico.drawing.labels import Anchor, label
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup
from pico.model.state import home_state, place_of
from pico.twin.placement import upright
from pico.twin.snapshot import Recording, Snapshot, at

SIZE = (224, 126)
LARGE = (288, 162)


@pytest.fixture(scope="module")
def setup() -> Setup:
    return bench()


@pytest.fixture(scope="module")
def run(setup: Setup) -> list[Snapshot]:
    """The camera of the bench slides over the table within a second, then everything stands for another."""
    places = {name: upright(place_of(setup, home_state(setup), name)[1]) for name in setup.lab.inventory}
    ends = [{**places, "cam": upright(Pose(x, 300.0, 0.0))} for x in (700.0, 1100.0, 1100.0)]
    return [Snapshot(float(t), place, dark=frozenset({"laser"})) for t, place in enumerate(ends)]


def pictures(path: Path) -> list[np.ndarray]:
    film, found = cv2.VideoCapture(str(path)), []
    while (answer := film.read())[0]:
        found.append(answer[1][:, :, ::-1])
    return found


def redness(image: np.ndarray) -> float:
    """The mean column of what is red: the camera's housing."""
    shown = image.astype(int)
    return float(np.nonzero((shown[:, :, 0] - np.maximum(shown[:, :, 1], shown[:, :, 2])) > 25)[1].mean())


@pytest.mark.parametrize("kind", [".mp4", ".gif"])
def test_what_moves_is_seen_to_move(setup: Setup, run: list[Snapshot], kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"run{kind}"
    steps = list(write_film(setup, run, path, captions=[Caption(0.0, "cam", "cam")], fps=4, size=LARGE))
    assert steps[-1] == (len(steps), len(steps))
    film = pictures(path)
    assert film[0].shape == (LARGE[1], LARGE[0], 3)
    across = [redness(image) for image in film[:5]]
    assert all(b > a for a, b in pairwise(across))
    assert np.abs(film[-1].astype(int) - film[-2]).max() < 40  # it stands in the end


def test_a_film_ended_early_can_be_played(setup: Setup, run: list[Snapshot], tmp_path: Path) -> None:
    for kind in (".mp4", ".gif"):
        going = write_film(setup, run, tmp_path / f"a{kind}", fps=4, size=SIZE)
        next(going)
        next(going)
        going.close()
        assert len(pictures(tmp_path / f"a{kind}")) >= 2


@pytest.mark.parametrize("kind", [".mp4", ".gif"])
@pytest.mark.parametrize("room", [40, 3000])
def test_a_film_for_which_there_is_no_room_leaves_the_one_before(
    setup: Setup, run: list[Snapshot], kind: str, room: int, tmp_path: Path
) -> None:
    path = tmp_path / f"a{kind}"
    path.write_text("the one before")
    allowed = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (room, allowed[1]))  # bytes of a file
        with pytest.raises(PicoError, match=f"cannot write the film {path}: file too large"):
            list(write_film(setup, run, path, fps=4, size=SIZE))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, allowed)
    assert path.read_text() == "the one before" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("kind", [".mp4", ".gif"])
def test_while_a_film_is_written_and_before_its_first_picture_the_one_before_stays(
    setup: Setup, run: list[Snapshot], kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / f"a{kind}"
    path.write_text("the one before")
    going = write_film(setup, run, path, fps=4, size=SIZE)
    next(going)
    assert path.read_text() == "the one before"
    going.close()
    assert path.read_bytes() != b"the one before" and list(tmp_path.iterdir()) == [path]
    path.write_text("the one before")
    monkeypatch.setattr("pico.drawing.film.film.build_set", interrupted)
    with pytest.raises(KeyboardInterrupt):
        next(write_film(setup, run, path, fps=4, size=SIZE))
    assert path.read_text() == "the one before" and list(tmp_path.iterdir()) == [path]


def interrupted(*_: object) -> None:
    raise KeyboardInterrupt


def test_looking_only_where_something_moved_shows_the_same(setup: Setup, run: list[Snapshot]) -> None:
    going = build_set(setup, run, SIZE)
    for moment in run[:2]:
        again = going.shoot(moment)
    anew = build_set(setup, run, SIZE).shoot(run[1])
    # the arm and the cut-out tiles sample light a little differently at their rims
    assert (np.abs(again.astype(int) - anew).max(axis=2) > 24).mean() < 0.002


def test_the_name_of_what_is_carried_lies_beside_the_grip(setup: Setup, run: list[Snapshot]) -> None:
    going = build_set(setup, run, SIZE)
    image = going.shoot(run[0])
    things = going.grip("cam")
    assert {body for body, _ in things} > {"cam"} and "laser" not in dict(things)
    (box,) = label(image, going.view, [Anchor("cam", going.top("cam", run[0]))], things).values()
    assert not any(overlap(box, thing) for _, thing in things)


def test_a_closed_shutter_lets_no_light_out(setup: Setup, run: list[Snapshot]) -> None:
    lit = build_set(setup, run, SIZE).shoot(replace(run[0], dark=frozenset())).astype(int)
    dark = build_set(setup, run, SIZE).shoot(run[0]).astype(int)
    changed = np.abs(lit - dark).max(axis=2) > 20
    assert changed.any()
    assert (lit[changed][:, 0] - lit[changed][:, 2]).mean() > (dark[changed][:, 0] - dark[changed][:, 2]).mean() + 30


@pytest.mark.parametrize("name", ["film.avi", "film", "no/such/folder.mp4"])
def test_what_is_no_film_is_refused_first(setup: Setup, run: list[Snapshot], name: str, tmp_path: Path) -> None:
    with pytest.raises(PicoError):
        next(write_film(setup, run, tmp_path / name))


@pytest.mark.parametrize("seed", range(3))
def test_a_gif_holds_what_was_put_into_it(seed: int, tmp_path: Path) -> None:
    random = np.random.default_rng(seed)
    colors = random.integers(0, 256, (200, 3)).astype(np.uint8) & 0xFC | 2
    shown = [colors[random.integers(0, 200, (90, 130))] for _ in range(2)]
    shown.append(shown[-1].copy())
    shown[-1][20:40, 30:60] = colors[0]
    reel = GifWriter(tmp_path / "noise.gif", 12)
    for image in shown:
        reel.add(image)
    reel.close()
    read = pictures(tmp_path / "noise.gif")
    assert len(read) == 3
    for image, wanted in zip(read, shown, strict=True):
        assert np.abs(image.astype(int) - wanted).max(axis=2).mean() < 4


def test_a_color_that_comes_later_is_in_a_gif_as_it_was(tmp_path: Path) -> None:
    gray = np.repeat(np.arange(250, dtype=np.uint8)[None, :, None], 60, axis=0).repeat(3, axis=2)
    lit = gray.copy()
    lit[30:32] = (230, 30, 20)
    reel = GifWriter(tmp_path / "beam.gif", 12)
    for image in (gray, gray, lit):
        reel.add(image)
    reel.close()
    read = pictures(tmp_path / "beam.gif")
    assert np.abs(read[2][30:32].astype(int) - (230, 30, 20)).max() < 12
    assert (read[0] == read[1]).all() and (read[0][40:] == read[2][40:]).all()  # what stands does not flicker


@given(st.floats(-1, 3), st.floats(-180, 180), st.floats(-170, 170))
def test_between_two_snapshots_everything_is_on_the_straight_way(t: float, yaw: float, turn: float) -> None:
    ends = [Snapshot(float(i), {"a": upright(Pose(100.0 * i, 0.0, yaw + i * turn))}, {"r": (i, -i)}) for i in (0, 1)]
    share = min(1.0, max(0.0, t))
    found = at(ends, t)
    assert found.joints["r"] == pytest.approx((share, -share))
    assert found.places["a"].position[0] == pytest.approx(share * 0.1)
    assert abs(angle_between(yaw + share * turn, found.places["a"].pose.yaw)) < 0.06 * abs(turn) + 1e-6


def test_of_two_looks_at_one_moment_the_later_holds() -> None:
    recording = Recording()
    for joints in ((0.0,), (1.0,)):
        recording.look(Snapshot(2.0, {}, {"r": joints}))
    assert recording.snapshots == [Snapshot(2.0, {}, {"r": (1.0,)})]

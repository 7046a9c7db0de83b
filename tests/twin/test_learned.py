"""What a twin learned is a file of the lab that comes back as it was written; anything else there is told."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path

import pytest

from pico.backends.attempt import Failed
from pico.backends.sim.stretching import stretched
from pico.diagnostics import PicoError, error
from pico.manifest.load import load_folder
from pico.model.trace.learned import Estimate, Learned, Scatter, work
from pico.resources import labs_dir
from pico.twin.learned import FILE, read_learned, with_noise, write_learned

ONE = Estimate(value=0.25, sigma=0.03, count=12, before=0.1)
LEARNED = Learned(
    made_at="2026-11-26T02:00:00Z", evidence="hardware", runs=("20261126T020000Z-aaaaaa",),
    types={"iris": Scatter(yaw=ONE)}, seatings={"magnet": Scatter(position=ONE, yaw=ONE)}, times={"move arm1": ONE},
    looks=Scatter(position=ONE), noise=1.5,
)  # fmt: skip


def test_what_is_written_comes_back(tmp_path: Path) -> None:
    assert read_learned(tmp_path) is None
    write_learned(tmp_path, LEARNED)
    assert read_learned(tmp_path) == LEARNED


@pytest.mark.parametrize(
    "text",
    ["no json", "[]", '{"schema": "pico.twin/v9"}', '{"schema": "pico.twin/v1", "noise": -1}',
     '{"schema": "pico.twin/v1", "times": {"move arm1": {"value": 0, "sigma": 0, "count": 1, "before": 1}}}',
     '{"schema": "pico.twin/v1", "types": {"iris": {"yaw": {"value": "0.1"}}}}'],
)  # fmt: skip
def test_a_file_that_no_twin_wrote_is_told_with_what_helps(tmp_path: Path, text: str) -> None:
    (tmp_path / FILE).write_text(text)
    with pytest.raises(PicoError) as caught:
        read_learned(tmp_path)
    (found,) = caught.value.diagnostics
    assert found.code == "twin-file" and FILE in found.summary and "pico calibrate twin" in found.hint


def test_cameras_are_as_noisy_as_was_learned_and_the_lab_stays_the_lab() -> None:
    setup, _ = load_folder(labs_dir() / "minimal").require()
    assert with_noise(setup, LEARNED).lab.sim.errors.noise == 1.5 and setup.lab.sim.errors.noise == 1.0
    assert with_noise(setup, None) is setup


@pytest.mark.parametrize(
    ("name", "component", "robot", "arguments", "found"),
    [
        ("move", "lens", "arm1", {}, "move arm1"), ("stow", "lens", "arm1", {}, "move arm1"),
        ("park", "arm1", "arm1", {}, "park arm1"),
        ("set", "camera", None, {"tunable": "exposure"}, "set beam_camera.exposure"),
        ("measure", "camera", None, {"measurable": "image"}, "measure beam_camera.image"),
        ("optimize", "camera", None, {}, None), ("operator", "lens", None, {}, None), ("set", "gone", None, {}, None),
    ],
)  # fmt: skip
def test_operations_of_a_kind_take_longer_alike(
    name: str, component: str, robot: str | None, arguments: dict[str, str], found: str | None
) -> None:
    setup, _ = load_folder(labs_dir() / "minimal").require()
    assert work(setup, name, component, robot, arguments) == found


def two_steps(heard: list[str]) -> Generator[float, None, str]:
    yield 1.0
    try:
        yield 2.0
    except Failed as exc:
        heard.append(exc.diagnostic.code)
        yield 0.5
        raise
    return "there"


def test_what_is_stretched_waits_longer_and_ends_alike() -> None:
    waits, work_of = [], stretched(two_steps([]), 1.5)
    with pytest.raises(StopIteration) as ended:
        while True:
            waits.append(next(work_of))
    assert (waits, ended.value.value) == ([1.5, 3.0], "there")


def test_what_is_raised_into_it_is_raised_into_the_work_that_then_comes_to_rest() -> None:
    heard: list[str] = []
    work_of = stretched(two_steps(heard), 2.0)
    next(work_of), next(work_of)
    assert work_of.throw(Failed(error("stopped", "stopped"))) == 1.0
    assert heard == ["stopped"]
    with pytest.raises(Failed):
        next(work_of)

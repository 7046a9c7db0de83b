"""The Mach-Zehnder interferometer as an example: its light in each state, and how the bench finds what darkened it."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico

from pico.bench.picturing.contents import standing, wanted
from pico.drawing.beams import beam_paths
from pico.drawing.beams import standing as upright
from pico.drawing.picture import carried
from pico.history.examples.example import make_example
from pico.manifest.load import load_files, load_folder
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.axis import axis_of
from pico.resources import labs_dir

State = tuple[Setup, Mapping[str, Pose], Mapping[str, Mapping[str, Any]]]
DARK = {"parked", "mirrors", "cubes", "cleaned", "bright_port", "half_way"}
"""States in which m1 has the beam on the block."""
STEEP = 15e-3
"""A beam in the table's plane rises or falls by no more than this [rad]."""


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_example("mach_zehnder", tmp_path_factory.mktemp("mach_zehnder")).root


@pytest.fixture(scope="module")
def states(tmp_path_factory: pytest.TempPathFactory) -> dict[str, State]:
    repository = make_example("mach_zehnder", tmp_path_factory.mktemp("mach_zehnder"))
    setup = load_folder(repository.root).require()[0]
    found = {}
    for commit in repository.log(repository.tips()):
        state = load_files(repository.files(commit.id), setup=setup).require()[1]
        found[commit.label] = setup, upright(standing(setup, state)), wanted(state)
    return found


def test_light_reaches_both_ports_by_both_arms_unless_m1_is_turned_away(states: dict[str, State]) -> None:
    for tag, (setup, poses, values) in states.items():
        beam = axis_of(setup, poses, "laser", values)
        ways = [len(beam.ways(port)) for port in ("cam", "meter")]
        assert ways == ([0, 0] if tag in DARK else [1, 1] if tag == "one_arm" else [2, 2]), tag
        assert beam.reaches("cam") == (tag not in DARK)


def test_every_beam_ends_on_a_detector_or_a_block(states: dict[str, State]) -> None:
    for tag, (setup, poses, values) in states.items():
        beam = axis_of(setup, poses, "laser", values)
        going = {leg.before for leg in beam.legs}
        ends = {leg.met[-1].component for n, leg in enumerate(beam.legs) if n not in going}
        assert ends and ends <= {"cam", "meter", "block", "stop"}, tag


def test_however_the_mirrors_are_turned_beams_stay_in_the_plane_of_the_table(states: dict[str, State]) -> None:
    setup, poses, values = states["aligned"]
    for tilts in itertools.product((-2, 0, 2), repeat=3):
        for tip in (-2, 2):
            turned = {
                n: {**values[n], "tilt": tilt, "tip": tip} for n, tilt in zip(("m1", "m2", "m3"), tilts, strict=True)
            }
            for leg in axis_of(setup, poses, "laser", {**values, **turned}).legs:
                rise, run = (
                    leg.end[2] - leg.start[2],
                    ((leg.end[0] - leg.start[0]) ** 2 + (leg.end[1] - leg.start[1]) ** 2),
                )
                assert abs(rise) <= STEEP * run**0.5


def test_pictures_show_the_carriage_where_it_is_and_the_beam_across_its_roof(states: dict[str, State]) -> None:
    setup, poses, values = states["revival"]
    bodies = [carried(setup, values).type_of("delay").geometry.bodies, setup.type_of("delay").geometry.bodies]
    moved = {one.name: one.at[0] - other.at[0] for one, other in zip(*bodies, strict=True)}
    assert moved["mirror_left"] == moved["carriage"] == 305 and moved["base"] == moved["motor"] == 0
    paths = [(start, end) for _, start, end in beam_paths(setup, poses, values)]
    assert any(start[:2] == pytest.approx((935, 320)) and end[:2] == pytest.approx((935, 370)) for start, end in paths)


def test_bisect_finds_the_commit_that_turned_the_mirror_away(
    bench: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(bench)
    answer = pico("bisect", "run", "finer", "fringes", "--expect", "reaches(laser, cam)", "--auto-approve")
    assert answer.code == 0, answer
    commit = subprocess.run(["git", "rev-parse", "--short=7", "cleaned"], capture_output=True, text=True, check=True)
    assert f"{commit.stdout.strip()} (cleaned) is the first bad commit" in answer.out
    assert "m1            turned +90°" in answer.out


@pytest.mark.slow
@pytest.mark.parametrize("fidelity", ["kinematic", "physics"])
def test_the_arm_builds_it_stops_an_arm_of_it_and_clears_it_away(fidelity: str, tmp_path: Path, pico: Pico) -> None:
    root = str(make_example("mach_zehnder", tmp_path / "bench").root)
    for state in ("fringes", "one_arm", "parked", "half_way"):
        assert pico("-C", root, "apply", state, "--auto-approve", "--fidelity", fidelity).code == 0
        assert pico("-C", root, "verify", state).code == 0


@pytest.mark.slow
def test_the_scan_of_its_readme_shows_fringes_that_go_and_come_back(tmp_path: Path, pico: Pico) -> None:
    readme = (labs_dir() / "mach_zehnder" / "README.md").read_text()
    (script,) = re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    assert len(script.splitlines()) <= 25
    root = make_example("mach_zehnder", tmp_path / "bench").root
    assert pico("-C", str(root), "apply", "--auto-approve").code == 0
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=root, capture_output=True, text=True, check=True, env={**os.environ}
    )
    rows = re.findall(r"^ *(\d+) mm +([\d.]+)", done.stdout, re.MULTILINE)
    seen = {int(path): float(visibility) for path, visibility in rows}
    assert min(seen, key=seen.__getitem__) in (280, 320) and seen[280] < 0.1
    assert seen[0] > 0.8 and seen[600] > 0.8 and seen[0] > seen[120] > seen[240]

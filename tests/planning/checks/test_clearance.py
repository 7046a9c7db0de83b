"""What a plan would put into a beam is told before it moves; what stood there before is not told again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest

from pico.manifest.load import load_folder
from pico.model.diff import diff_observed
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.pose import Pose
from pico.model.state import ComponentState, LabState
from pico.planning.checks.clearance import beams_in_the_way
from pico.resources import labs_dir

FOLDER = load_folder(labs_dir() / "shel")
SETUP = FOLDER.setup
AXIS = 420.0


def told(lens: Pose, *, now: Pose | None = None, **laser: Any) -> list[tuple[str, str | None]]:
    """Return the warnings of moving lx_125 to a place, where it stands in its slot or at `now`."""
    wanted = FOLDER.state.components | {"lx_125": ComponentState(pose=lens)}
    wanted["laser"] = replace(wanted["laser"], values={**wanted["laser"].values, **laser})
    state = LabState(lab="shel", components=wanted)
    seen = Observation(backend="sim", components={n: _seen(n, FOLDER.state.components[n]) for n in SETUP.lab.inventory})
    if now is not None:
        seen = replace(seen, components={**seen.components, "lx_125": ObservedComponent(pose=now)})
    changes = diff_observed(SETUP, seen, state)
    return [(d.code, d.address) for d in beams_in_the_way(SETUP, seen, state, changes)]


def _seen(name: str, part: ComponentState) -> ObservedComponent:
    pose = part.pose or SETUP.lab.slots[part.slot or ""].pose
    values: Mapping[str, ObservedValue] = {key: ObservedValue(value=value) for key, value in part.values.items()}
    return ObservedComponent(pose=pose, values=values)


@pytest.mark.parametrize(
    ("lens", "found"),
    [
        (Pose(395, AXIS, 0), []),
        (
            Pose(395, AXIS + 10.9, 0),
            [("clipped", "lx_125"), ("clipped", "p2"), ("beam", "laser")],
        ),  # it bends what passes
        (Pose(395, AXIS + 18, 0), [("beam", "lx_125")]),
        (Pose(395, AXIS, 90), [("beam", "lx_125")]),
        (Pose(395, AXIS + 40, 0), []),
    ],
)
def test_what_would_come_into_the_beam_is_told(lens: Pose, found: list[tuple[str, str]]) -> None:
    assert told(lens) == found


def test_a_laser_that_will_be_dark_lights_nothing() -> None:
    assert told(Pose(395, AXIS + 18, 0), shutter="closed") == told(Pose(395, AXIS + 18, 0), emission=False) == []


def test_what_an_opened_laser_would_light_is_told() -> None:
    """The lens stands in the way already, in the dark."""
    state = LabState(lab="shel", components=FOLDER.state.components | {"lx_125": ComponentState(pose=Pose(395, 438))})
    seen = {n: _seen(n, state.components[n]) for n in SETUP.lab.inventory}
    shut = {**seen["laser"].values, "shutter": ObservedValue(value="closed")}
    dark = Observation(backend="sim", components={**seen, "laser": replace(seen["laser"], values=shut)})
    found = beams_in_the_way(SETUP, dark, state, diff_observed(SETUP, dark, state))
    assert [(d.code, d.address) for d in found] == [("beam", "lx_125")]


def test_what_is_so_already_is_not_told_again() -> None:
    assert told(Pose(396, AXIS + 18, 0), now=Pose(395, AXIS + 18, 0)) == []

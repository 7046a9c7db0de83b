"""What an arm is to do with a tool is done in the twin first: where that fails, nothing is moved."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from emulated_lab import wired_lab

from pico.backends.attempt import Failed
from pico.backends.checks import standing
from pico.backends.hardware.rehearsing import rehearse
from pico.backends.sim.world import new_world, observe
from pico.model.operation import Operation, Reason
from pico.model.setup import Setup
from pico.motion.arms import ArmMotion
from pico.motion.types import Blocked, MovePath, Waypoint
from pico.planning.routines import carried

TOOL, UNDER = "lx_125", "p1"
ASKED = Operation(id="op1", primitive="turn_knob", component=UNDER, robot="arm1", reason=Reason(kind="asked"))


def ways(setup: Setup) -> tuple[tuple[MovePath, ...], Operation]:
    """The ways of the arm that turns over one part with another in its hand."""
    seen = observe(new_world(setup), "sim", "")
    start, under = seen.components[TOOL].pose, seen.components[UNDER].pose
    assert start is not None and under is not None
    found = ArmMotion(setup).use("arm1", TOOL, start, (Waypoint(under, 146.0, 60.0),), standing(setup, seen))
    assert not isinstance(found, Blocked), found
    return found, carried(ASKED, TOOL, start)


def rehearsed(setup: Setup, friction: float) -> None:
    slippery = replace(setup, lab=replace(setup.lab, sim=replace(setup.lab.sim, pad_friction=friction)))
    found, meant = ways(setup)
    rehearse(slippery, observe(new_world(setup), "sim", ""), meant, TOOL, found)


def test_what_goes_well_in_the_twin_may_be_done(tmp_path: Path) -> None:
    rehearsed(wired_lab(tmp_path), 1.0)


def test_a_tool_that_slips_from_the_fingers_of_the_twin_is_not_taken(tmp_path: Path) -> None:
    with pytest.raises(Failed) as refused:
        rehearsed(wired_lab(tmp_path), 0.01)
    assert refused.value.diagnostic.code == "rehearsal"
    assert f"turn_knob with {TOOL}, fails in the twin: " in refused.value.diagnostic.summary

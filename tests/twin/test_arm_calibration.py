"""Calibration finds how an arm is built, by boards in its hand and by encoders, and says how sure that is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_arm_errors import BAR, built, postures, wrong

from pico.cameras.calibrating import HELD, TAKES
from pico.cameras.postures import Rests, rests, seen_by
from pico.cameras.postures import postures as found_postures
from pico.diagnostics import PicoError
from pico.model.setup import Setup
from pico.motion.built.correction import told
from pico.motion.built.fitting import SLACK, fitted, grip
from pico.motion.built.poses import reached
from pico.twin.arms import TwinArm
from pico.vision.arm import FoundArm
from pico.vision.nominal import camera_models
from pico.vision.rigid import apart, moved

SETUP = wrong(replace(BAR, encoder_noise=0.01, backlash=0.01))
TAKEN = [i * TAKES // HELD for i in range(HELD)]


def held(setup: Setup, arm: TwinArm, seed: int) -> tuple[Rests, np.ndarray]:
    """An arm that holds the board, and where cameras see that: 0.02 mm and 0.01 deg off."""
    random = np.random.default_rng(seed)
    over = [camera for camera in camera_models(setup).values() if camera.robot is None]
    rest = rests(
        arm, found_postures(setup, "arm1", HELD, lambda tool: seen_by(over, tool @ grip()) == 2, random), random
    )
    askew = [moved(np.eye(4), random.normal(0, np.repeat((SLACK[0], np.radians(SLACK[1])), 3))) for _ in range(TAKES)]
    boards = [tool @ askew[take] @ grip() for tool, take in zip(rest.tools, TAKEN, strict=True)]
    return rest, np.array([moved(b, random.normal(0, np.repeat((0.02, np.radians(0.01)), 3))) for b in boards])


def found(seed: int) -> tuple[TwinArm, FoundArm]:
    arm = built(SETUP, seed)
    rest, boards = held(SETUP, arm, seed)
    return arm, fitted("arm1", arm.robot, rest.read, boards, TAKEN)


def missed(arm: TwinArm, known: FoundArm) -> np.ndarray:
    """How far the tool comes to be from where it should, in many postures [mm, deg]."""
    joints = postures(SETUP, 80)[:80]
    there = reached(arm.robot, told(arm.robot, known.offsets, joints), arm.built).tools
    return np.array([apart(a, b) for a, b in zip(reached(arm.robot, joints).tools, there, strict=True)])


def test_a_tool_is_within_a_fifth_of_a_millimetre_once_its_arm_was_found_and_that_is_said() -> None:
    seeds = [found(seed) for seed in range(6)]
    off = [missed(arm, known) for arm, known in seeds]
    assert np.quantile(np.concatenate(off), 0.95, axis=0) == pytest.approx((0.0, 0.0), abs=0.2)
    said = np.array([(known.position, known.turn) for _, known in seeds])
    root_mean_square = np.sqrt(np.mean(np.concatenate(off) ** 2 / 3, axis=0))  # along each axis
    assert np.all(root_mean_square < 1.3 * said.mean(axis=0)) and np.all(said.mean(axis=0) < 3 * root_mean_square)


def test_a_board_that_no_arm_could_hold_there_and_one_that_was_hardly_seen_are_refused() -> None:
    arm = built(SETUP, 1)
    rest, boards = held(SETUP, arm, 1)
    boards[::2, :3, 3] += np.random.default_rng(1).normal(0, 4, (HELD // 2, 3))
    with pytest.raises(PicoError, match=r"no mount, zeros and tool explain where arm1 held the board: .* mm are left"):
        fitted("arm1", arm.robot, rest.read, boards, TAKEN)
    with pytest.raises(PicoError, match="the cameras see the board in arm1's hand in 5 postures; 12 is the least"):
        fitted("arm1", arm.robot, rest.read[:5], boards[:5], TAKEN[:5])


def test_an_arm_that_cameras_do_not_see_says_so() -> None:
    with pytest.raises(PicoError, match="arm1 finds 0 postures for a calibration, not 24"):
        found_postures(SETUP, "arm1", 24, lambda _: False, np.random.default_rng(1))

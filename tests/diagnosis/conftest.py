"""The case study's bench as its manifests and its cameras say, for what is asked of its ray model."""

from __future__ import annotations

import pytest

from pico.diagnosis.nominal import Nominal
from pico.manifest.load import load_folder
from pico.model.pose import Pose
from pico.resources import labs_dir

POSES = {"laser": (120, 0), "hwp": (222, 0), "p1": (290, 0), "lx_125": (395, 0), "p2": (520, 30), "ly_150": (670, 0),
         "cam": (1060, 0)}  # fmt: skip
VALUES = {
    "laser": {"emission": True, "shutter": "open"}, "hwp": {"angle": 22.75}, "p1": {"angle": 1.0},
    "p2": {"angle": 90.0},
    "ly_150": {"stage_y": 0.0, "stage_z": 0.0}, "cam": {"exposure": 10.0},
}  # fmt: skip


@pytest.fixture(scope="module")
def nominal() -> Nominal:
    setup = load_folder(labs_dir() / "shel").require()[0]
    return Nominal(setup, {name: Pose(x, 420, yaw) for name, (x, yaw) in POSES.items()}, VALUES)

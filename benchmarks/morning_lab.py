"""The case study's bench as one would build it to know each morning what happened to it: a pick-off shows the laser to
a camera of its own, and an iris with a motor stands before the other camera."""

from __future__ import annotations

import re
from pathlib import Path

from pico.bench.bench import new_lab

_PARTS = """\
  laser:
    type: hene_laser_expanded
    pose: {x: 120, y: 420, yaw: 0}
  pick:
    type: pellicle_beam_splitter
    marker: 10
    pose: {x: 215, y: 420, yaw: -45}
  ref:
    type: beam_camera
    parameters: {filter_density: 3, pixels_across: 1224, pixels_up: 1024, pixel_size: 6.9 um}
    pose: {x: 215, y: 560, yaw: 90}
  hwp:
    type: half_wave_plate
    marker: 1
    pose: {x: 280, y: 420, yaw: 0}
  p1:
    type: linear_polarizer
    marker: 2
    pose: {x: 345, y: 420, yaw: 0}
  lx_125:
    type: plano_convex_125
    marker: 5
    pose: {x: 410, y: 420, yaw: 0}
  p2:
    type: linear_polarizer
    marker: 3
    pose: {x: 535, y: 420, yaw: 30}
  ly_150:
    type: plano_convex_150_stage
    marker: 6
    pose: {x: 685, y: 420, yaw: 0}
  iris:
    type: iris
    marker: 11
    pose: {x: 900, y: 420, yaw: 0}
  cam:
    type: beam_camera
    parameters: {pixels_across: 1224, pixels_up: 1024, pixel_size: 6.9 um}     # read two by two
    pose: {x: 1100, y: 420, yaw: 0}
"""
_STATE = """\
apiVersion: pico/v1
kind: LabState
metadata: {lab: shel}
components:
  cam: {exposure: 20}
  hwp: {angle: 22.75}
  iris: {opening: 11.5}
  laser: {emission: true, shutter: open}
  ly_150: {stage_y: 0, stage_z: 0}
  p1: {angle: 1}
  p2: {angle: 90}
  ref: {exposure: 1}
"""


def make(folder: Path, seed: int) -> None:
    """Make the lab in a folder, with what it wants to be set to in its state."""
    new_lab(folder, "shel")
    lab = folder / "lab.yaml"
    text = lab.read_text()
    kept = [
        section for section in re.split(r"(?m)^(?=[a-z])", text) if not section.startswith(("goals:", "inventory:"))
    ]
    lab.write_text("".join(kept).replace("  seed: 1\n", f"  seed: {seed}\n") + "inventory:\n" + _PARTS)
    (folder / "state" / "table.yaml").write_text(_STATE)

"""What is found in a picture and printed on paper, kept as text: see `kept`. Pixels to 0.01."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from painted import Painted, picture, plate_of, scattered, setup, stereo

sys.path.append(str(Path(__file__).resolve().parent.parent))

from kept import differs

from pico.model.pose import Pose
from pico.vision.markers import Markers, detect
from pico.vision.rigid import moved, upright
from pico.vision.sheets import marker_sheets

BENCH = setup(6)


def pictured() -> Markers:
    """Plates of one camera: six that stand, one that leans, one twice, one covered in part, one cut by the edge."""
    camera = stereo(distortion=(-0.12, 0.05, 0.0005, -0.0003, 0.0))["left"]
    rng = np.random.default_rng(3)
    plates = [plate_of(BENCH, name, pose) for name, pose in scattered(BENCH, rng).items()]
    leaning = moved(upright(Pose(250, 120, 15), 140), np.array([0, 0, 0, math.radians(25), math.radians(-10), 0]))
    plates += [Painted(700, leaning), Painted(701, upright(Pose(330, 120, 70), 140))]
    plates += [Painted(701, upright(Pose(410, 120, -20), 140)), Painted(702, upright(Pose(490, 120), 140), covered=2.0)]
    return detect(picture(camera, plates, rng))


def test_markers_are_found_where_they_were_found() -> None:
    lines = []
    found = pictured()
    for marker in sorted(found.markers, key=lambda m: (m.number, float(m.corners[0, 0]))):
        corners = " ".join(f"({u:.2f}, {v:.2f})" for u, v in marker.corners)
        spread = np.sqrt(np.diag(marker.covariance))
        lines.append(f"{marker.number} at {corners} within {' '.join(f'{s:.2g}' for s in spread)}: {marker.noise:.2g}")
    lines += [f"fragment at {', '.join(f'({u:.0f}, {v:.0f})' for u, v in f.corners)}" for f in found.fragments]
    lines += [f"twice: {sorted(found.duplicates)}"]
    assert not differs("markers.txt", "\n".join(lines) + "\n")


def test_sheets_are_printed_as_they_were() -> None:
    printed = marker_sheets(BENCH, "a4").decode("latin-1")
    assert not differs("sheets_a4.txt", printed)


def test_many_markers_are_laid_out_as_they_were() -> None:
    printed = marker_sheets(setup(40), "letter").decode("latin-1").splitlines()
    lines = [line for line in printed if not line.endswith(" f")]  # without the squares
    assert not differs("sheets_many.txt", "\n".join(lines) + "\n")

"""A laser that may emit more than its label says is told of."""

from __future__ import annotations

from pathlib import Path

import pytest

from pico.manifest.load import load_folder
from pico.optics.audit.labels import check_labels

LAB = """\
apiVersion: pico/v1
kind: Lab
metadata: {name: labels}
table: {size: [900, 600], beam_height: 70}
inventory:
  laser: {type: %s, pose: {x: 100, y: 100, yaw: 0}, parameters: {%s}}
"""


@pytest.mark.parametrize(
    ("kind", "own", "told"),
    [
        ("hene_laser", "", ""),
        ("diode_laser", "", ""),
        ("fiber_laser", "", ""),
        ("hene_laser", "power: 80", "laser is labelled class 3R, and its 80 mW are class 3B"),
        ("hene_laser", "power: 80, laser_class: 3B", ""),
        ("hene_laser_two_modes", "power: 4", "laser is labelled class 2, and its 4 mW are class 3R"),
    ],
)
def test_a_label_below_the_class_of_the_power_is_told(tmp_path: Path, kind: str, own: str, told: str) -> None:
    (tmp_path / "lab.yaml").write_text(LAB % (kind, own))
    (tmp_path / "table.yaml").write_text(
        "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: labels}\ncomponents: {}\n"
    )
    found = [one.summary for one in check_labels(load_folder(tmp_path))]
    assert found == ([told] if told else [])

"""A trim takes in three standard deviations of placement along its axis; what was written before is only warned of."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from pico.geometry.seat import placed_on, scatter
from pico.manifest.catalog import load_catalog
from pico.manifest.load import load_folder
from pico.resources import catalog_dir

CATALOG = load_catalog()
MIRROR = CATALOG["mirror_tip_tilt"]
LAB = """apiVersion: pico/v1
kind: Lab
metadata: {name: small}
table: {size: [600, 600]}
slots: {a: {x: 100, y: 100}}
robots: {}
inventory:
  m: {type: own_mirror, home: a%s}
"""


def lab(root: Path, trim: float, repeats: str, own: str = "") -> list[tuple[str, str, str]]:
    text = (catalog_dir() / "mirror_tip_tilt.yaml").read_text()
    text = text.replace("name: mirror_tip_tilt", "name: own_mirror").replace("trim: 12", f"trim: {trim}")
    old = next(line for line in text.splitlines() if line.startswith("repeatability"))
    (root / "own_mirror.yaml").write_text(text.replace(old, f"repeatability: {repeats}"))
    (root / "lab.yaml").write_text(LAB % own)
    found = [d for d in load_folder(root).diagnostics if d.code == "trim"]
    return [(d.severity, d.summary, d.hint) for d in found]


FULL = "{position: 0.1, yaw: 0.05, pitch: 0.02, roll: 0.02, height: 0.02}"


def test_a_trim_below_three_sigma_is_refused_for_the_axis_that_it_is_of(tmp_path: Path) -> None:
    (tip,) = lab(tmp_path, 2, FULL)
    assert tip[0] == "error" and "trim of `tip`, 2 mrad, is narrower than own_mirror is placed" in tip[1]
    assert "expected 2.62 mrad or more" in tip[2]
    assert [severity for severity, *_ in lab(tmp_path, 1, FULL)] == ["error", "error"]
    assert lab(tmp_path, 2.62, FULL) == []


def test_a_type_that_was_written_before_is_warned_of(tmp_path: Path) -> None:
    assert [severity for severity, *_ in lab(tmp_path, 2, "{position: 0.1, yaw: 0.05}")] == ["warning"]


def test_a_trim_of_a_parts_own_is_refused_too(tmp_path: Path) -> None:
    own = ", restore: {tip: {kind: align, trim: 1}}"
    (found,) = lab(tmp_path, 12, FULL, own)
    assert found[0] == "error" and "is narrower than m is placed" in found[1]
    assert lab(tmp_path, 12, FULL, ", restore: {tip: {kind: setpoint, trim: 1}}") == []


def test_the_trims_of_the_catalog_take_in_how_its_types_are_placed() -> None:
    for kind in CATALOG.values():
        one = scatter(kind.repeatability, kind.seating)
        for name, tunable in kind.tunables.items():
            sigma, trim = placed_on(kind, name, one), tunable.restore.trim
            assert tunable.restore.kind != "align" or trim is None or sigma is None or trim >= 3 * sigma, (
                kind.name,
                name,
            )


def test_the_trim_of_a_mirror_takes_in_a_yaw_within_its_tolerance() -> None:
    trim = MIRROR.tunables["tip"].restore.trim
    assert trim is not None and trim >= math.radians(MIRROR.pose.tolerance.yaw) * 1e3


@pytest.mark.parametrize(
    ("tunable", "sigma"),
    [("tip", math.radians(0.05) * 1e3), ("tilt", math.radians(0.02) * 1e3), ("nothing", None)],
)
def test_what_placing_scatters_is_in_the_unit_of_the_axis(tunable: str, sigma: float | None) -> None:
    found = placed_on(MIRROR, tunable, scatter(MIRROR.repeatability, MIRROR.seating))
    assert found == (None if sigma is None else pytest.approx(sigma))

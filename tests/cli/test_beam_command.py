"""`pico beam`: a row for each component that a beam comes to, and what is wrong with it."""

from __future__ import annotations

from pathlib import Path

import pytest
from commanding import Pico, edit


def test_the_case_study_has_a_row_for_each_part_in_its_beam(shel: Path, pico: Pico) -> None:
    found = pico("beam", "e1", "--json").data
    assert found["schema"] == "pico.beam/v1" and found["dark"] == []
    rows = {row["component"]: row for row in found["rows"]}
    assert [*rows] == ["hwp", "p1", "lx_125", "p2", "ly_150", "cam"]
    # a waist of 0.65 mm 225 mm after the exit, 10 mm behind the first lens: w0 sqrt(1 + (z / z_R)^2)
    assert rows["lx_125"]["radii"] == pytest.approx([0.65001, 0.65001], abs=1e-5)
    assert rows["p1"]["power"] == pytest.approx(2 * 0.99)
    assert rows["cam"]["event"] == "detected" and found["diagnostics"] == []
    said = pico("beam", "C3")  # with parallel polarizers
    assert "p2" in said.out and "cam is saturated 1900 times over at 10 ms" in said.err


def test_a_laser_that_is_off_is_followed_and_called_off(shel: Path, pico: Pico) -> None:
    answer = pico("beam")
    assert answer.code == 0 and "it is off or shut, and shown as if it shone" in answer.out
    assert pico("beam", "--json").data["dark"] == ["laser"]


def test_what_the_manifest_does_not_say_stays_as_the_bench_has_it(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "inventory:\n", "inventory:\n  iris_1: {type: iris, marker: 77, home: storage/b3}\n")
    edit(shel / "state" / "table.yaml", "components:\n",
         "components:\n  iris_1:\n    pose: {x: 340, y: 420, yaw: 0}\n")  # fmt: skip
    power = {row["component"]: row["power"] for row in pico("beam", "--manifest", "--json").data["rows"]}
    assert "iris_1" in power and power["cam"] > 0
    assert pico("set", "iris_1", "opening=1", "--yes").code == 0
    less = {row["component"]: row["power"] for row in pico("beam", "--manifest", "--json").data["rows"]}
    assert 0 < less["cam"] < 0.8 * power["cam"]


def test_what_is_clipped_missed_and_dark_is_told(shel: Path, pico: Pico) -> None:
    state = shel / "state" / "table.yaml"
    edit(state, "  p2:\n    pose:\n      x: 520\n      y: 420", "  p2:\n    pose:\n      x: 520\n      y: 430.9")
    clipped = pico("beam", "--manifest")
    assert "p2 stops" in clipped.err and "which comes 10.9 mm to the right of its middle" in " ".join(
        clipped.err.split()
    )
    assert "radius unknown" in clipped.out.lower() or "unknown" in clipped.out
    edit(state, "y: 430.9", "y: 445")
    missed = pico("beam", "--manifest")
    assert "ends on the housing of p2" in missed.err and "no light comes to cam" in missed.err


def test_after_a_power_failure_light_goes_as_parts_are_and_nobody_knows_how(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "  seed: 1\n", "  seed: 1\n  environment: none\n")
    assert pico("apply", "e1", "--yes").code == 0
    assert "unread" not in pico("beam").err
    before = pico("measure", "cam.power", "--json").data["value"]
    assert pico("sim", "power-cycle").code == 0
    assert "nobody knows p1.angle" in pico("beam").err
    assert pico("get", "p1", "--json").data["values"]["angle"]["status"] == "unknown"
    for setting in ("emission=true", "shutter=open"):
        assert pico("set", "laser", setting, "--yes").code == 0
    assert pico("set", "cam", "exposure=10").code == 0
    after = pico("measure", "cam.power", "--json").data["value"]
    assert after == pytest.approx(before, rel=0.01)


def test_a_picture_and_what_cannot_be(shel: Path, pico: Pico) -> None:
    assert pico("beam", "e1", "--picture", "e1.png").code == 0
    assert (shel / "e1.png").read_bytes().startswith(b"\x89PNG")
    assert "known: `laser`" in pico("beam", "--source", "lx_125").err
    assert pico("beam", "e1", "--manifest").code == 1
    assert pico("beam", "nosuch").code == 1

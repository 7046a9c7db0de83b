"""Set-points that light finds, as a user meets them: two mirrors that bring a beam through two irises."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
from commanding import Pico, edit

LAB = """\
apiVersion: pico/v1
kind: Lab
metadata: {name: irises}
table: {size: [1500, 900], beam_height: 70}
robots: {arm1: {model: xarm7, mount: {x: 750, y: 850, yaw: -90}}}
policy: {enclosed: true, arming: {waived: [kinematic]}}
sim: {fidelity: kinematic, seed: 3, environment: none}
inventory:
  laser: {type: hene_laser_expanded, pose: {x: 120, y: 260, yaw: 0}}
  weak: {type: neutral_density_filter, pose: {x: 260, y: 260, yaw: 0}}
  m1: {type: mirror_tip_tilt, serial: A1, pose: {x: 400, y: 260, yaw: -45}}
  m2: {type: mirror_tip_tilt, pose: {x: 400, y: 440, yaw: 135}}
  near: {type: iris, pose: {x: 560, y: 440, yaw: 0}}
  far: {type: iris, pose: {x: 1000, y: 440, yaw: 0}}
  meter: {type: power_meter, pose: {x: 1200, y: 440, yaw: 0}}
"""
STATE = """\
apiVersion: pico/v1
kind: LabState
metadata: {lab: irises}
components:
  laser: {emission: true, shutter: open}
  m1:
    tip: {through: [near, far]}
    tilt: {through: [near, far]}
  m2:
    tip: {through: [far, near]}
    tilt: {through: [near, far]}
  near: {opening: 11.5}
  far: {opening: 11.5}
  meter: {wavelength: 632.8}
"""
ALL = ["m1.tilt", "m1.tip", "m2.tilt", "m2.tip"]
GOAL = ("through", "near", "far")


@pytest.fixture
def irises(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico) -> Path:
    """A bench with two mirrors whose mounts slipped, committed and applied."""
    folder = tmp_path / "irises"
    folder.mkdir()
    (folder / "lab.yaml").write_text(LAB)
    (folder / "table.yaml").write_text(STATE)
    monkeypatch.chdir(folder)
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "A Physicist")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    monkeypatch.setenv("GIT_CONFIG_SYSTEM", os.devnull)
    subprocess.run(["git", "init", "-q", "-b", "main"], cwd=folder, check=True)
    assert pico("apply", "-y").code == 0
    for address, by in (("m1.tip", "1.1"), ("m2.tilt", "-0.8")):
        assert pico("sim", "slip", address, by).code == 0
    return folder


def stands(pico: Pico) -> tuple[str, str]:
    (one,) = pico("optimize", "--json").data["alignments"]
    assert one["goal"] == "through far near"
    return one["status"], one["why"]


def optimizations(plan: dict[str, list[dict[str, object]]]) -> list[str]:
    return [str(op["component"]) for op in plan["operations"] if op["primitive"] == "optimize"]


def test_two_mirrors_are_found_committed_and_found_again(irises: Path, pico: Pico) -> None:
    told = pico("plan")
    assert "m1.tilt, m1.tip, m2.tilt, m2.tip are to stand through near and far: never measured" in told.err
    assert "`pico optimize through far near` finds them" in told.err
    status = pico("status").out
    assert max(map(len, status.splitlines())) <= 100 and status.count("never measured") == 1
    assert "Committed as planned: not compared with the bench yet" in pico("commit", "-m", "not yet").out
    done = pico("apply", "--align", "-y")
    assert done.code == 0 and "1 of 1 goal" in done.out and stands(pico)[0] == "aligned"
    assert pico("verify").code == 0 and pico("drift").code == 0
    assert optimizations(pico("plan", "--align", "--json").data) == [], "what is aligned is not sought again"
    before = (irises / "table.yaml").read_bytes()
    assert pico("capture").code == 0 and (irises / "table.yaml").read_bytes() == before
    assert pico("commit", "-m", "through both").code == 0

    pico("set", "m2.tip", "3", "-y")
    assert stands(pico)[0] == "stale" and "m2.tip" in pico("drift").out
    assert (irises / "table.yaml").read_bytes() == before
    assert pico("optimize", "m2.tip", "-y").code == 0 and stands(pico)[0] == "aligned", "by any of the addresses"

    assert pico("swap", "m1", "--serial", "B7", "-y").code == 0
    assert stands(pico) == ("stale", "m1 was swapped (serial A1 → B7)")
    assert pico("optimize", *GOAL, "-y").code == 0 and stands(pico)[0] == "aligned", "in either order"


def test_after_the_power_was_off_a_plain_apply_homes_and_align_finds(irises: Path, pico: Pico) -> None:
    assert pico("apply", "--align", "-y").code == 0
    assert pico("sim", "power-cycle").code == 0
    plan = pico("plan", "--json").data
    homed = {
        f"{op['component']}.{op['arguments']['tunable']}" for op in plan["operations"] if op["primitive"] == "home"
    }
    assert {*ALL} <= homed
    done = pico("apply", "--align", "-y")
    assert done.code == 0 and stands(pico)[0] == "aligned"
    assert pico("commit", "-m", "homed").code == 0


def test_what_can_not_be_is_told_at_its_place(irises: Path, pico: Pico) -> None:
    for before, after, said, place in (
        ("m1:\n    tip: {through: [near, far]}", "m1:\n    tip: {through: [near, fat]}", "refers to `fat`", "7:27"),
        ("m1:\n    tip: {through: [near, far]}", "m1:\n    tip: {through: [near, m2]}", "is not an iris", "7:27"),
        ("m1:\n    tip: {through: [near, far]}", "m1:\n    tip: {thru: [near, far]}", "unknown key `thru`", "7:11"),
        ("near: {opening: 11.5}", "near: {opening: {through: [near, far]}}", "not near.opening", "12:19"),
    ):
        edit(irises / "table.yaml", before, after)
        for words in (("validate",), ("plan",), ("apply", "-y"), ("optimize", *GOAL)):
            answer = pico(*words)
            assert answer.code == 1 and said in answer.err and f"table.yaml:{place}" in answer.err, (words, answer.err)
        edit(irises / "table.yaml", after, before)


def test_a_beam_that_does_not_come_by_is_lost_and_nothing_else_breaks(irises: Path, pico: Pico) -> None:
    assert pico("sim", "nudge", "far", "--dy", "160").code == 0
    listed = pico("optimize")
    assert listed.code == 0 and "lost" in listed.out and "no beam comes through" in " ".join(listed.out.split())
    asked = pico("optimize", *GOAL, "-y")
    assert asked.code == 1 and "can't be found by light: no beam comes through near to far" in asked.err
    assert pico("plan").code == 0 and pico("status").code == 0

"""`pico commission`: a whole emulated bench walked through, as it is typed."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico, Typed, edit

from pico.manifest.load import load_folder
from pico.model.calibration.results import AxisZero, DarkLevel, Provenance
from pico.model.commissioning import STEPS
from pico.vision.arm import NOMINAL, FoundArm
from pico.vision.calibration import Calibration
from pico.vision.calibration_files import results_of, write_calibration
from pico.vision.nominal import nominal

DEVICES = Path(__file__).resolve().parents[2] / "examples" / "devices.yaml"
EMULATED = ("--backend", "hardware", "--emulate")
there = find_spec("xarm") and find_spec("ElliptecBus")
emulated = pytest.mark.skipif(not there, reason="the extras xarm and thorlabs")


def calibrated(root: Path) -> None:
    """Write a calibration down that found everything where the lab says."""
    setup = load_folder(root).require()[0]
    cameras = {name: nominal(name, camera) for name, camera in setup.lab.cameras.items()}
    arms = {name: FoundArm(offsets=NOMINAL, position=0.1, turn=0.05) for name in setup.lab.robots}
    axes = {f"{name}.angle": AxisZero(direction=1, zero=0.0, sigma=0.1) for name in ("hwp", "p1", "p2")}
    dark = {"cam.image": DarkLevel(level=64.0, sigma=1e-3, noise=2.0, unit="count")}
    found = Calibration(cameras=cameras, arms=arms, axes=axes, dark=dark, made_at="2026-11-20T12:00:00Z")
    how = Provenance(bench="emulated", evidence="emulated", at=found.made_at)
    write_calibration(root, "emulated", replace(found, provenance=dict.fromkeys(results_of(found), how)))


def report(root: Path) -> Any:
    return json.loads((root / "commissioning-emulated.json").read_text())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("commission",), "nothing of a simulated bench has to be commissioned"),
        (("commission", "--only", "driftt"), "there is no step `driftt`"),
        (("commission", "--valid-for", "1e9"), "--valid-for is 1e+09 days"),
        (("--json", "commission"), "with --json nobody is asked"),
        ((*EMULATED, "commission", "--list"), "no driver for the arm arm1"),
    ],
)
def test_what_makes_no_sense_is_told(shel: Path, pico: Pico, words: tuple[str, ...], said: str) -> None:
    answer = pico(*words)
    assert answer.code == 1 and said in answer.out + answer.err, answer.out + answer.err


@pytest.mark.slow
@emulated
def test_a_bench_is_walked_through_left_off_taken_up_and_then_a_laser_is_armed(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    subprocess.run(["git", "config", "user.name", "Ada Lovelace"], cwd=shel, check=True)
    line = next(one for one in (shel / "lab.yaml").read_text().splitlines() if one.startswith("  arming: {waived"))
    roles = "roles: {laser_user: {people: [Ada Lovelace], laser_class: 3R, hours: 8}}"
    edit(shel / "lab.yaml", line, f"  arming: {{{roles}}}\n  hard_wired_interlock: true")
    shutil.copy(DEVICES, shel)
    monkeypatch.setenv("PICO_EMULATED_PACE", "10")

    armed = pico(*EMULATED, "laser", "arm", "laser", "-y")
    assert armed.code == 7 and "is not commissioned: it was never commissioned" in armed.err, armed.out + armed.err
    assert "`pico --backend hardware --emulate commission`" in armed.err

    failed = pico(*EMULATED, "commission", "-y")
    assert failed.code == 1 and "the step `intrinsics` of the calibration is missing for left, right" in failed.err, (
        failed.out + failed.err
    )
    steps = report(shel)["steps"]
    assert {n: s["outcome"] for n, s in steps.items()} == {
        "devices": "passed", "identities": "passed", "calibration": "failed",
    }  # fmt: skip
    assert report(shel)["basis"]["identities"]["arm1"]["serial"] == "XI130500123456"

    early = pico(*EMULATED, "commission", "--only", "pick_and_place", "-y")
    assert early.code == 1 and "comes after calibration, first_move, stop_distance, safety_inputs" in early.err
    calibrated(shel)
    monkeypatch.setattr(sys, "stdin", Typed("y\nn\n"))
    no = pico(*EMULATED, "commission")
    assert no.code == 1 and "nothing is written down of this step" in no.err, no.out + no.err
    assert report(shel)["steps"]["reach"]["outcome"] == "passed" and "first_move" not in report(shel)["steps"]

    whole = pico(*EMULATED, "commission", "--repeats", "1", "--drift-hours", "0", "-y")
    assert whole.code == 2 and "drift goes on" in whole.out, whole.out + whole.err
    steps = report(shel)["steps"]
    assert steps["first_move"]["data"]["arms"]["arm1"]["speed_mm_s"] <= 250
    assert 0 < steps["stop_distance"]["data"]["arms"]["arm1"]["mm"] < 200
    assert "curtain (curtain) is not safe" in steps["safety_inputs"]["data"]["inputs"]["curtain"]["told"]
    types = steps["pick_and_place"]["data"]["types"]
    assert len(types) == 5 and all(one["times"] == 1 and one["most_mm"] < 1 for one in types.values())
    assert "shortened: 1 times a type instead of 30" in steps["pick_and_place"]["told"]

    last = pico(*EMULATED, "commission", "--drift-hours", "0", "-y")
    assert last.code == 0, last.out + last.err
    assert "The emulated bench is commissioned until" in last.out and "says nothing of a real one" in last.out
    assert {s["outcome"] for s in report(shel)["steps"].values()} == {"passed"} and len(report(shel)["steps"]) == len(
        STEPS
    )
    assert not (shel / "commissioning.json").exists()

    armed = pico(*EMULATED, "laser", "arm", "laser", "-y")
    assert armed.code == 0, armed.out + armed.err
    pico(*EMULATED, "laser", "disarm", "laser")
    edit(shel / "devices.yaml", 'serial: "11400001"', 'serial: "11400009"')
    stale = pico(*EMULATED, "--json", "commission", "--list").data
    assert stale["why"] == [
        "the devices or safety inputs of the lab's files were changed since",
        "the serial of hwp_mount is 11400009, and was 11400001",
    ]
    armed = pico(*EMULATED, "laser", "arm", "laser", "-y")
    assert armed.code == 7 and "devices or safety inputs of the lab's files were changed since" in armed.err

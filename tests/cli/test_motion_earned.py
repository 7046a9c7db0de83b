"""A real bench makes one motion a command until the driver's motion test passed on it; then plans run whole."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import pytest
from commanding import Pico, Typed

from pico.backends import hardware
from pico.backends.device import Device
from pico.backends.emulated.bench import PACE, brought_up
from pico.backends.hardware.opening import bench
from pico.drivers.registry import driver
from pico.drivers.xarm import arm
from pico.model.commissioning import Basis, Commissioning, StepResult, motion_tried
from pico.model.setup import Setup
from pico.places.bench import BenchPlace

DEVICES = Path(__file__).resolve().parents[2] / "examples" / "devices.yaml"
REAL = ("--backend", "hardware")
there = find_spec("xarm") and find_spec("ElliptecBus")
emulators = pytest.mark.skipif(not there, reason="the extras xarm and thorlabs")
WHO = {"vendor": "UFACTORY", "model": "xArm7", "serial": "XI1", "firmware": "2.7.1"}


@pytest.fixture
def real(shel: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example as a real bench whose addresses lead to emulators, as far as PICO knows to devices."""
    shutil.copy(DEVICES, shel)
    lab = shel / "lab.yaml"
    lab.write_text(lab.read_text().replace("pixels: [2448, 2048]", "pixels: [1224, 1024]"))
    subprocess.run(["git", "config", "user.name", "Ada Lovelace"], cwd=shel, check=True)
    monkeypatch.setenv(PACE, "10")

    def opened(setup: Setup, place: BenchPlace, fidelity: str, clock: Callable[[], str]) -> Device:
        return bench(setup, place, fidelity, clock, brought_up)

    monkeypatch.setattr(hardware, "opened", opened)
    return shel


@pytest.mark.slow
@emulators
def test_the_motion_test_lets_plans_run_whole_and_nothing_that_a_driver_says_of_itself(
    real: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    boast = replace(arm.DRIVER, maturity="on device", tried="2026-11-01, firmware 2.7.1")
    monkeypatch.setattr(arm, "DRIVER", boast)
    assert driver("xarm.arm").maturity == "on device"
    plan = pico(*REAL, "plan", "C2")
    assert "arm1 makes one motion a command: now move p1; then park arm1" in plan.err, plan.err
    first = pico(*REAL, "apply", "C2", "--yes")
    assert first.code == 2, first.out + first.err
    assert re.search(r"operations? left: continue with `pico --backend hardware apply C2`", first.out), first.out
    assert "Failed" not in first.out and "error[" not in first.err

    monkeypatch.setattr("sys.stdin", Typed("y\n" * 9))
    tested = pico(*REAL, "commission", "--only", "devices", "--only", "identities", "--only", "motion")
    assert "moved, stopped, limits read back: arm1 (XI130500123456, firmware 2.7.1)" in tested.out, (
        tested.out + tested.err
    )
    kept = json.loads((real / "commissioning.json").read_text())["steps"]["motion"]
    assert (kept["outcome"], kept["by"]) == ("passed", "Ada Lovelace") and kept["data"]["devices"]["arm1"]["passed"]
    measured = kept["data"]["devices"]["arm1"]["measured"]
    assert measured["off_deg"] < 0.2 and 0 < measured["stop_deg"] < 2

    whole = pico(*REAL, "apply", "C2", "--yes")
    assert whole.code == 0 and "The bench equals C2" in whole.out, whole.out + whole.err
    assert "one motion" not in whole.err


def test_the_report_counts_for_the_serial_number_and_firmware_that_answer() -> None:
    data = {"devices": {"arm1": {"passed": True, **WHO}}}
    step = StepResult(outcome="passed", at="2026-11-24T12:00:00Z", by="Ada Lovelace", told="", data=data)
    report = Commissioning(lab="shel", bench="hardware", basis=Basis(wired="", bench=""), steps={"motion": step})
    assert motion_tried(report, "arm1", WHO)
    assert not motion_tried(report, "arm2", WHO) and not motion_tried(None, "arm1", WHO)
    assert not motion_tried(report, "arm1", {**WHO, "firmware": "2.8.0"})
    assert not motion_tried(report, "arm1", {**WHO, "serial": "XI2"})
    assert not motion_tried(replace(report, bench="emulated"), "arm1", WHO), "an emulator proves nothing of a device"

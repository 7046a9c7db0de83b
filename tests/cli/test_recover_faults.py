"""Faults of devices: told with `pico recover` as the way on, and cleared by nobody but a person at a terminal."""

from __future__ import annotations

import shutil
from importlib.util import find_spec
from pathlib import Path

import pytest
from commanding import Pico, Typed, edit

from pico.backends.emulated.bench import PACE
from pico.backends.hardware.settings import Settings
from pico.base.state_files import DEVICES
from pico.places.bench import BenchPlace

DEVICES_FILE = Path(__file__).resolve().parents[2] / "examples" / "devices.yaml"
EMULATED = ("--bench", "emulated")
there = find_spec("xarm") and find_spec("ElliptecBus")
pytestmark = pytest.mark.skipif(not there, reason="the extras xarm and thorlabs")


@pytest.fixture
def wired(shel: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example with its instruments and small cameras; time goes ten times as fast."""
    shutil.copy(DEVICES_FILE, shel)
    for _ in range(2):
        edit(shel / "lab.yaml", "pixels: [2448, 2048]", "pixels: [612, 512]")
    monkeypatch.setenv(PACE, "10")
    return shel


def keeps(root: Path) -> Settings:
    return Settings(BenchPlace(root, "emulated"), DEVICES)


def test_a_collision_is_told_everywhere_and_cleared_by_a_person_alone(
    wired: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    keeps(wired).put("arm1.faults", "31 0 11")
    said = pico(*EMULATED, "doctor")
    assert said.code == 1 and "arm1 has fault C31" in said.err and "arm1_hand has fault G11" in said.err
    assert "`pico --bench emulated recover` clears it" in said.err
    for words in (("recover", "--yes"), ("--json", "recover", "--yes")):
        refused = pico(*EMULATED, *words)
        assert refused.code == 1 and "a terminal of the bench's own computer" in refused.out + refused.err
        assert keeps(wired).get("arm1.faults", "") == "31 0 11", "nothing but a person clears it"
    monkeypatch.setattr("sys.stdin", Typed("n\n"))
    no = pico(*EMULATED, "recover")
    assert no.code == 1 and "Nothing was cleared" in no.out and keeps(wired).get("arm1.faults", "") == "31 0 11"
    monkeypatch.setattr("sys.stdin", Typed("y\ny\n"))
    found = pico(*EMULATED, "recover")
    assert found.code == 0, found.out + found.err
    assert "Check at the table: look at the arm first" in found.out and "Cleared G11 of arm1_hand" in found.out
    assert keeps(wired).get("arm1.faults", "") == "0 0 0" and "Nothing to do" in found.out


def test_an_emergency_stop_that_is_still_pressed_says_what_to_do_and_the_command_again(
    wired: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    keeps(wired).put("arm1.faults", "1 1 0")
    monkeypatch.setattr("sys.stdin", Typed("y\n"))
    pressed = pico(*EMULATED, "recover")
    assert (
        pressed.code == 1 and "release it once the bench is safe; then `pico --bench emulated recover`" in pressed.err
    )
    told = pico(*EMULATED, "status")
    assert "fault C1" in told.err and "recover` clears it" in told.err


def test_a_simulated_bench_keeps_no_fault(shel: Path, pico: Pico) -> None:
    assert pico("recover", "--yes").code == 0

"""What the generator of commands over four benches knows by itself, and that it finds planted faults."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "benchmarks"))

from cross_bench_labs import Traffic, mutating  # noqa: E402
from cross_bench_oracle import BENCHES, BenchPrint, check_look, check_others, runs_of_others  # noqa: E402
from cross_bench_sequences import Commands, bench_of  # noqa: E402

A, B = "20261127T080000Z-aaaaaa", "20261127T080000Z-bbbbbb"


@pytest.mark.parametrize(
    ("line", "variable", "use", "bench"),
    [
        ("pico plan", "", "sim", "sim"),
        ("pico plan", "", "hardware", "hardware"),
        ("pico plan", "plates/bench1", "hardware", "remote"),
        ("pico plan", "emulated", "hardware", "emulated"),
        ("pico plan", "hardware", "sim", None),
        ("pico plan --bench local", "plates/bench1", "hardware", "sim"),
        ("pico --backend hardware plan", "plates/bench1", "sim", "hardware"),
        ("pico --backend hardware --emulate plan", "", "hardware", "emulated"),
        ("pico apply --bench=lab/plates/bench1", "local", "hardware", "remote"),
    ],
)
def test_flags_come_before_the_variable_and_that_before_the_choice(
    line: str, variable: str, use: str, bench: str | None
) -> None:
    assert bench_of(shlex.split(line), {"PICO_BENCH": variable} if variable else {}, use) == bench


@pytest.mark.parametrize(
    ("driver", "data", "count"),
    [
        ("zaber.stage", b"/1 1 20 get pos:2D\n/1 1 21 get limit.home.triggered\n", 0),
        ("zaber.stage", b"/1 1 20 home:33\n/2 1 24 move abs 4000:E1\n", 2),
        ("switches.shutter", b"1 read gate.sensor\n", 0),
        ("switches.shutter", b"1 read gate.sensor\n2 set gate 1\n", 1),
        ("scpi.meter", b"*IDN?\nMEAS:POW?\n", 0),
        ("frames.camera", b'{"do": "grab", "id": 1}\n', 0),
        ("xarm.arm", b"\x00\x01\x00\x02\x00\x01\x0d", 0),  # its state
        ("xarm.arm", b"\x00\x01\x00\x02\x00\x01\x1d", 1),  # a set-point of its joints
    ],
)
def test_commands_that_make_a_device_act_are_told_from_queries(driver: str, data: bytes, count: int) -> None:
    assert len(mutating(driver, data)) == count


def test_what_changes_on_another_bench_is_a_violation() -> None:
    before = {bench: BenchPrint() for bench in BENCHES}
    after = {bench: BenchPrint() for bench in BENCHES}
    after["sim"].files["main/.pico/benches/sim/world.json"] = "1"
    assert not list(check_others(before, after, ("sim",)))
    assert len(list(check_others(before, after, ("emulated",)))) == 1
    assert len(list(check_look(before["sim"], after["sim"], "sim"))) == 1
    after["hardware"].traffic = Traffic({"zaber.stage": 12}, {})
    assert any("12 bytes (queries only)" in one for one in check_others(before, after, ("sim",)))


def test_a_run_of_another_bench_is_found_in_a_text() -> None:
    assert runs_of_others("sim", f"the bench before {A}, and {B}", {A: "sim", B: "hardware"}) == [f"{B} (of hardware)"]


@pytest.mark.parametrize(("hint", "runs"), [("pico apply e1", True), ("pico runs show RUN", False),
                                            ("pico bench use sim", False), ("pico undo --help", False)])  # fmt: skip
def test_hints_that_mean_no_bench_are_not_run(hint: str, runs: bool) -> None:
    assert Commands.can_run(hint) is runs


@pytest.mark.slow
@pytest.mark.parametrize("plant", ["ignores-use", "shares-journal", "moves-hardware"])
def test_a_planted_fault_is_found(plant: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "benchmarks/cross_bench.py", "--sequences", "12", "--seed", "2", "--plant", plant],
        cwd=ROOT, env=os.environ | {"TMPDIR": str(tmp_path)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"{plant}: found" in done.stdout

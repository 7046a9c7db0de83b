"""What goes wrong with emulated devices by themselves: travel, lost steps, settling, noise, replies, restarts."""

from __future__ import annotations

import random
import shutil
import socket
import time
from contextlib import suppress
from pathlib import Path

import pytest

from pico.diagnostics import PicoError
from pico.emulators.behind import Alone
from pico.emulators.disturbance import Disturbed, Line
from pico.emulators.elliptec import Mount
from pico.emulators.registry import EmulatedBench
from pico.emulators.scpi import Meter, Spoken
from pico.emulators.xarm.server import XArmEmulator
from pico.emulators.zaber import Stage
from pico.manifest.emulation import emulation_of
from pico.manifest.load import load_folder
from pico.model.instruments.emulation import Disturbance
from pico.model.wiring import DeviceEntry

ENTRY = DeviceEntry(
    driver="zaber.stage", address={"host": "h", "port": 1, "device": 1}, emulator="zaber",
    settings={"counts_per_unit": 1000.0, "emulated_speed": 26.0},
)  # fmt: skip


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def disturbed(about: Disturbance, at_first: dict[str, object], clock: Clock) -> Disturbed:
    return Disturbed(Alone(at_first, clock=clock), about, random.Random(7))


def stage(about: Disturbance, clock: Clock) -> Stage:
    return Stage(ENTRY, disturbed(about, {"position": 0.0, "homed": True}, clock))


def moved(one: Stage, clock: Clock, counts: int) -> tuple[str, int]:
    flag = one.reply(["move", "abs", str(counts)]).split()[0]
    clock.now += 60
    one.reply(["get", "pos"])
    return flag, int(one.reply(["get", "pos"]).split()[3])


@pytest.mark.parametrize("counts", [-5000, 150_000])
def test_a_stage_refuses_what_is_beyond_its_travel(counts: int) -> None:
    clock = Clock()
    one = stage(Disturbance(), clock)
    said = one.reply(["move", "abs", str(counts)])
    assert said.startswith("RJ") and said.endswith("BADDATA") and one.reply(["get", "pos"]).endswith(" 0")
    assert one.reply(["get", "limit.max"]).endswith(" 101600")
    assert moved(stage(Disturbance(travel=(0.0, 200.0)), clock), clock, 150_000) == ("OK", 150_000)


def test_a_stage_that_loses_steps_counts_what_it_did_not_move_until_it_is_homed() -> None:
    clock = Clock()
    behind = disturbed(Disturbance(lost_steps=0.1), {"position": 0.0, "homed": True}, clock)
    one = Stage(ENTRY, behind)
    assert moved(one, clock, 10_000) == ("OK", 10_000) and behind.read("position") == pytest.approx(9.0)
    one.reply(["home"])
    clock.now += 60
    one.reply(["get", "pos"])
    assert behind.read("position") == pytest.approx(0.9), "it lost steps on its way home, too"


def test_a_stage_settles_beside_its_goal_and_knows_no_reference_after_a_restart() -> None:
    clock = Clock()
    one = stage(Disturbance(settle_error=0.05), clock)
    at = moved(one, clock, 10_000)[1]
    assert at != 10_000 and abs(at - 10_000) < 250
    one.reboot()
    assert "WR" in one.reply(["get", "pos"])


def test_a_mount_settles_beside_its_goal_and_reads_with_noise() -> None:
    clock = Clock()
    mount = Mount("1", disturbed(Disturbance(settle_error=0.1, noise=0.02), {"angle": 0.0}, clock))
    mount.answer("ma00008C00")
    clock.now += 10
    assert mount.ended() != "PO00008C00"
    assert len({mount.answer("gp") for _ in range(5)}) > 1


def test_readings_of_a_meter_differ_and_a_wavelength_beyond_its_range_is_an_error() -> None:
    spoken = Spoken(Meter(Alone({"power": 1e-3})), "x")
    readings = {spoken.heard(b"READ?\n") for _ in range(5)}
    assert len(readings) == 5 and all(float(r) == pytest.approx(1e-3, rel=1e-3) for r in readings)
    assert spoken.heard(b"SENS:CORR:WAV 1550\n") == b""
    assert spoken.heard(b"SYST:ERR?\n").startswith(b"-222") and spoken.heard(b"SENS:CORR:WAV?\n") == b"635.000\n"
    dark = Spoken(Meter(Alone({"power": -1e-9})), "x")
    assert float(dark.heard(b"READ?\n")) < 0, "a negative reading is no entry of the error queue"


def test_replies_come_late_or_never_and_a_device_that_restarts_is_silent_once() -> None:
    clock, restarts = Clock(), list[float]()
    late = Line(Disturbance(latency=0.2), random.Random(1), clock=clock)
    assert late.sent(b"a") == b""
    clock.now = 0.3
    assert late.sent(b"") == b"a"
    lossy = Line(Disturbance(dropped_replies=0.5), random.Random(1), clock=clock)
    assert 20 < sum(bool(lossy.sent(b"a")) for _ in range(100)) < 80
    one = Line(Disturbance(reboot_after_commands=2), random.Random(1), lambda: restarts.append(clock.now), clock=clock)
    assert [one.hears() for _ in range(4)] == [True, True, False, False] and len(restarts) == 1
    clock.now += 2
    assert one.hears() and one.sent(b"a") == b"a"


def test_a_scenario_reaches_the_wire() -> None:
    scenario = {"s": Disturbance(reboot_after_commands=1)}
    bench = EmulatedBench({"s": ENTRY}, lambda n, e: Alone({"position": 0.0, "homed": True}), scenario)
    try:
        address = bench.entries["s"].address
        with socket.create_connection((str(address["host"]), int(address["port"])), timeout=0.3) as link:
            link.sendall(b"/1 get pos\n")
            assert b"IDLE --" in link.recv(100)
            link.sendall(b"/1 get pos\n")
            with pytest.raises(TimeoutError):
                link.recv(100)
    finally:
        bench.close()


LAB = Path(__file__).resolve().parents[2] / "labs" / "shel"


def test_a_scenario_that_is_wrong_is_told_at_its_line_and_keeps_only_the_emulated_bench(tmp_path: Path) -> None:
    shutil.copytree(LAB, tmp_path, dirs_exist_ok=True)
    scenario = tmp_path / "emulation.yaml"
    head = "apiVersion: pico/v1\nkind: Emulation\nmetadata: {lab: shel}\n"
    scenario.write_text(head + "devices:\n  x: {settle_eror: 0.1}\n")
    found = load_folder(tmp_path)
    assert found.setup is not None, found.diagnostics
    (one,) = [d for d in found.diagnostics if d.source and d.source.path.endswith("emulation.yaml")]
    assert one.severity == "warning" and one.source and one.source.start.line == 5
    assert "settle_eror" in one.summary and "settle_error" in one.hint
    with pytest.raises(PicoError, match="settle_eror"):
        emulation_of(tmp_path, found.setup)
    scenario.write_text(head + "devices:\n  x: {settle_error: 0.1}\n")
    with pytest.raises(PicoError, match="no device `x`"):
        emulation_of(tmp_path, found.setup)
    for wrong, said in (
        ("{x: 1}", "`y`"),
        ("{x: 1, y: 2, radius: 0}", "above 0"),
        ("{x: 1, y: 2, arrives: 9, leaves: 9}", "before"),
    ):
        scenario.write_text(f"{head}people:\n  visitor: {wrong}\n")
        with pytest.raises(PicoError, match=said):
            emulation_of(tmp_path, found.setup)
    scenario.write_text(head + "people:\n  visitor: {x: 1, y: -20 cm, arrives: 2}\n")
    (visitor,) = emulation_of(tmp_path, found.setup).people.values()
    assert (visitor.y, visitor.is_there(1.9), visitor.is_there(1e9)) == (-200.0, False, True)
    scenario.write_text(head + "seed: 5\n")
    assert emulation_of(tmp_path, found.setup).seed == 5


def test_an_arm_loses_reports_and_restarts_without_what_was_not_saved() -> None:
    entry = DeviceEntry(driver="xarm.arm", address={"host": "h"}, emulator="xarm")
    scenario = {"arm": Disturbance(dropped_replies=0.5, reboot_after=0.6)}
    bench = EmulatedBench({"arm": entry}, lambda n, e: Alone(), scenario)
    (emulator,) = bench._running
    assert isinstance(emulator, XArmEmulator)
    first = emulator.box
    try:
        with socket.create_connection((str(emulator.address["host"]), 30003), timeout=2) as link:
            heard, until = 0, time.monotonic() + 0.4
            while time.monotonic() < until:
                heard += len(link.recv(4096)) // 135
            assert 5 < heard < 35, "of 40 reports"
            with suppress(OSError):
                while link.recv(4096):
                    pass
        until = time.monotonic() + 20  # on a busy machine
        while emulator.box is first and time.monotonic() < until:
            time.sleep(0.05)
        assert emulator.box is not first
    finally:
        bench.close()

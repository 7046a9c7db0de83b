"""Numbers and named positions of any instrument reach the lab by their kinds; a device that can't be had stops nothing
but what needs it."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from commanding import Pico, edit

from pico.backends import instruments
from pico.drivers.registry import driver
from pico.resources import labs_dir

PARTS = """inventory:
  wheel: {type: filter_wheel, pose: {x: 300, y: 600, yaw: 0}}
  pd: {type: photodiode, pose: {x: 900, y: 420, yaw: 0}}
  chop: {type: chopper, pose: {x: 300, y: 700, yaw: 0}}
  flip: {type: mirror_flip, pose: {x: 900, y: 700, yaw: 0}}
  flap: {type: mirror_flip_motorized, pose: {x: 1000, y: 700, yaw: 0}}
"""
DEVICES = """apiVersion: pico/v1
kind: Devices
metadata: {lab: minimal}
devices:
  wheel_motor:
    of: wheel
    driver: scpi.choice
    address: {visa: "TCPIP0::192.0.2.1::5025::SOCKET"}
    settings:
      read: "POS?"
      set: "POS {}"
      positions: {1: at_1, 2: at_2, 3: at_3}
      moving: "-1"
  pd_amplifier:
    of: pd
    driver: scpi.choice
    address: {visa: "TCPIP0::192.0.2.2::5025::SOCKET", part: gain}
    map: {gain: {property: position}}
    settings: {read: "GAIN?", set: "GAIN {}", positions: {0: 0 dB, 10: 10 dB}}
  pd_volts:
    of: pd
    driver: scpi.number
    address: {visa: "TCPIP0::192.0.2.2::5025::SOCKET", part: voltage}
    map: {voltage: {property: value}}
    settings: {read: "MEAS:VOLT?", unit: mV, sigma: 2}
  chop_slider:
    of: chop
    driver: elliptec.slider
    address: {port: /dev/none, bus: "0"}
    identity: {serial: "10900042", model: ELL9}
    map: {blades: {property: position}}
    settings: {positions: {1: open, 2: closed, 3: turning}}
  chop_drive:
    of: chop
    driver: scpi.number
    address: {visa: "TCPIP0::192.0.2.3::5025::SOCKET", part: rate}
    limits: {value: [10, 500]}
    map: {frequency: {property: value}}
    settings: {read: "FREQ?", set: "FREQ {}", unit: Hz}
  flap_mount:
    of: flap
    driver: scpi.choice
    address: {visa: "TCPIP0::192.0.2.3::5025::SOCKET", part: flap}
    map: {flipped: {property: position}}
    settings: {read: "FLIP?", set: "FLIP {}", positions: {0: up, 1: down}}
  flip_foreign:
    of: flip
    driver: newport.picomotor
    package: pico-newport
    address: {host: 192.0.2.4}
    map: {flipped: {property: position}}
"""
BENCH = """  arm1:
    driver: xarm.arm
    address: {host: 192.0.2.222}
    settings: {tool_z: 172}
  arm1_hand: {driver: xarm.gripper, of: arm1, address: {host: 192.0.2.222}}
  left: {driver: frames.camera, address: {host: 192.0.2.10, port: 5001}}
  right: {driver: frames.camera, address: {host: 192.0.2.10, port: 5002}}
  laser_shutter: {driver: switches.shutter, of: laser, address: {host: 192.0.2.20, port: 4000, name: shutter}}
  laser_head: {driver: switches.laser, of: laser, address: {host: 192.0.2.20, port: 4000, name: laser}}
"""
FOREIGN = "there is no driver `newport.picomotor`"


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    root = tmp_path / "lab"
    shutil.copytree(labs_dir() / "minimal", root)
    edit(root / "lab.yaml", "inventory:\n", PARTS)
    (root / "devices.yaml").write_text(DEVICES + BENCH)
    monkeypatch.chdir(root)
    monkeypatch.setenv("PICO_EMULATED_PACE", "20")
    return root


def test_a_lab_whose_driver_is_not_installed_validates_plans_and_lists_its_devices(lab: Path, pico: Pico) -> None:
    answer = pico("validate")
    assert answer.code == 0 and answer.err.count("warning[driver]") == 1 and "error" not in answer.err, answer.err
    assert "flip_foreign" in answer.err and "devices.yaml:48:13" in answer.err, answer.err
    assert "`pip install pico-newport`" in answer.err
    assert pico("status").code == 0
    assert "lens" in pico("plan").out
    row = next(one for one in json.loads(pico("devices", "--json").out)["devices"] if one["name"] == "flip_foreign")
    assert (row["kind"], row["maturity"], row["install"]) == ("unknown", "not installed", "pip install pico-newport")


def test_devices_answer_and_one_that_cannot_be_had_is_named(lab: Path, pico: Pico) -> None:
    answer = pico("devices", "check", "--emulate", "--json")
    rows = {row["name"]: row["answer"] for row in json.loads(answer.out)["devices"]}
    shown = pico("devices", "check", "--emulate")
    assert shown.code == answer.code == 1 and shown.err.count("error[") == 1 and FOREIGN in shown.err, shown.err
    assert rows["wheel_motor"]["reads"] == "at_1 (of at_1, at_2, at_3)"
    assert rows["chop_slider"]["identity"]["model"] == "ELL9"
    assert rows["pd_volts"]["reads"].startswith("unknown: the instrument reports that it has no number")
    assert all(row["identity"] for name, row in rows.items() if name != "flip_foreign")


def test_a_device_without_emulator_is_left_out_and_all_others_answer(lab: Path, pico: Pico) -> None:
    edit(lab / "devices.yaml", "    map: {voltage", "    emulator: acme\n    map: {voltage")
    answer = pico("devices", "check", "--emulate")
    assert answer.code == 1 and "there is no emulator `acme`" in answer.err and "at_1 (of" in answer.out, answer


def test_one_for_which_no_emulator_is_named_is_left_out_without_an_error(lab: Path, pico: Pico) -> None:
    text = (lab / "devices.yaml").read_text()
    (lab / "devices.yaml").write_text(text.replace(DEVICES[DEVICES.index("  flip_foreign") :], ""))
    found = replace(driver("scpi.number"), emulator="")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(instruments, "known_driver", lambda name: found if name == "scpi.number" else driver(name))
        answer = pico("devices", "check", "--emulate")
    assert answer.code == 0 and "warning[emulator]: pd_volts has no emulator: it is left out" in answer.err, answer
    assert "at_1 (of" in answer.out


@pytest.mark.slow
def test_numbers_and_positions_reach_the_lab_and_the_bench_works_without_what_it_lacks(lab: Path, pico: Pico) -> None:
    one = json.loads(pico("--emulate", "measure", "pd.voltage", "--json").out)
    assert one["unit"] == "V" and one["sigma"] == pytest.approx(0.002) and abs(one["value"]) < 0.01, one
    done = pico("--emulate", "set", "wheel", "position=at_3", "--yes")
    assert done.code == 0, done.err
    assert "at_3" in pico("--emulate", "get", "wheel.position").out
    assert pico("--emulate", "set", "chop", "blades=turning", "--yes").code == 0
    assert "turning" in pico("--emulate", "get", "chop.blades").out
    assert pico("--emulate", "set", "chop", "frequency=120", "--yes").code == 0
    assert "120 Hz" in pico("--emulate", "get", "chop.frequency").out
    beyond = pico("--emulate", "set", "chop", "frequency=900", "--yes")
    assert beyond.code != 0 and "500" in beyond.err, beyond
    assert pico("--emulate", "set", "flap", "flipped=down", "--yes").code == 0
    assert "down" in pico("--emulate", "get", "flap.flipped").out
    status = pico("--emulate", "status")
    assert status.code == 0 and f"flip_foreign can't be used: {FOREIGN}" in status.err, status.err
    assert pico("--emulate", "set", "laser", "shutter=closed", "--yes").code == 0
    assert pico("--emulate", "recover", "--yes").code == 0


def test_without_the_driver_of_the_arm_light_can_be_shut_and_nothing_else_is_dared(lab: Path, pico: Pico) -> None:
    edit(lab / "devices.yaml", "driver: xarm.arm", "driver: acme.arm")
    status = pico("--emulate", "status")
    assert status.code == 0 and "arm1 can't be used: there is no driver `acme.arm`" in status.err, status.err
    assert pico("--emulate", "laser", "disarm", "laser").code == 0
    assert pico("--emulate", "set", "laser", "shutter=closed", "--yes").code == 0
    for words in (("apply", "--yes"), ("set", "laser", "emission=true", "--yes")):
        refused = pico("--emulate", *words)
        assert refused.code != 0 and "internal" not in refused.err, refused
        assert "without arm1 no arm moves, and no light is let out" in refused.err, refused.err

"""`pico devices`: which instruments there are, what they answer over emulated wires, what is told where none does."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from commanding import Pico

from pico.backends.instruments import bench_of, listed, named
from pico.backends.properties import properties_of
from pico.drivers import registry
from pico.drivers.checking import Answer
from pico.drivers.protocols import Identity
from pico.drivers.registry import driver, known
from pico.model.calibration.results import AxisZero
from pico.model.instruments.readout import Readout
from pico.resources import labs_dir

DEVICES = """\
apiVersion: pico/v1
kind: Devices
metadata: {lab: shel}
devices:
  p1_mount:
    of: p1
    driver: elliptec.rotator
    address: {port: /dev/none, bus: "2"}
    identity: {serial: "11400517"}
    map:
      angle: {property: angle}
  p2_mount:
    of: p2
    driver: elliptec.rotator
    address: {port: /dev/none, bus: "3"}
    identity: {serial: "11400518"}
"""
METER = """\
apiVersion: pico/v1
kind: Devices
metadata: {lab: mach_zehnder}
devices:
  pm:
    of: meter
    driver: scpi.meter
    address: {visa: "TCPIP0::pm.invalid::5025::SOCKET"}
    map: {power: {property: power}, wavelength: {property: wavelength}}
"""
LIBRARIES = (
    "serial",
    "ElliptecBus",
    "pyvisa",
    "pyvisa_py",
    "pymeasure",
    "zaber_motion",
    "pypylon",
    "pyrealsense2",
    "xarm",
)


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    for name in ("lab.yaml", "state/table.yaml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text((labs_dir() / "shel" / name).read_text())
    (tmp_path / "devices.yaml").write_text(DEVICES)
    return tmp_path


def test_devices_are_listed_with_how_far_their_drivers_were_tried(lab: Path, pico: Pico) -> None:
    lines = pico("-C", str(lab), "devices").out.splitlines()
    assert [line.split()[:5] for line in lines[1:]] == [
        [f"p{n}_mount", f"p{n}", "axis", "elliptec.rotator", "emulated"] for n in (1, 2)
    ]
    assert "port=/dev/none bus=2" in lines[1]


def test_emulators_answer_over_one_serial_line(lab: Path, pico: Pico) -> None:
    answer = pico("-C", str(lab), "devices", "check", "--emulate", "--json")
    rows = json.loads(answer.out)["devices"]
    assert answer.code == 0
    assert [row["answer"]["identity"]["serial"] for row in rows] == ["11400517", "11400518"]
    assert len({row["address"].partition(" ")[0] for row in rows}) == 1
    shown = pico("-C", str(lab), "devices", "identify", "p2_mount", "--emulate")
    assert shown.out == 'p2_mount: identity: {vendor: "Thorlabs", model: "ELL14", serial: "11400518"}\n'


@pytest.mark.slow
def test_each_device_of_the_example_answers_emulated_and_its_vendors_library_says_nothing(lab: Path) -> None:
    example = Path(__file__).resolve().parents[2] / "examples" / "devices.yaml"
    (lab / "devices.yaml").write_text(example.read_text())
    words = [sys.executable, "-m", "pico_cli", "-C", str(lab), "devices", "check", "--emulate", "--json"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert all(row["answer"]["reads"] for row in json.loads(done.stdout)["devices"])


def test_a_property_is_shown_as_it_was_replied_in_its_unit_and_in_the_labs(lab: Path, pico: Pico) -> None:
    (lab / "lab.yaml").write_bytes((labs_dir() / "mach_zehnder" / "lab.yaml").read_bytes())
    shutil.rmtree(lab / "state")
    shutil.copytree(labs_dir() / "mach_zehnder" / "state", lab / "state")
    (lab / "devices.yaml").write_text(METER)
    found = json.loads(pico("-C", str(lab), "devices", "read", "pm", "--emulate", "--json").out)
    assert found["schema"] == "pico.device-properties/v1"
    assert found["properties"] == [
        {"device": "pm", "property": "power", "raw": "0.000000000E+00", "value": 0.0, "unit": "W", "why": "",
         "address": "meter.power", "lab_value": 0.0, "lab_unit": "mW"},
        {"device": "pm", "property": "wavelength", "raw": "635.000", "value": 635.0, "unit": "nm", "why": "",
         "address": "meter.wavelength", "lab_value": 635.0, "lab_unit": "nm"},
    ]  # fmt: skip
    shown = pico("-C", str(lab), "devices", "read", "--emulate").out
    assert "635.000" in shown and "meter.wavelength 635 nm" in shown


def test_a_property_that_is_unknown_says_why(lab: Path, pico: Pico) -> None:
    answer = pico("-C", str(lab), "devices", "read", "p1_mount", "--emulate")
    assert answer.code == 0 and "unknown: not-homed" in answer.out and "2GJ" in answer.out


def test_who_does_not_answer_is_named_with_exit_code_1(lab: Path, pico: Pico) -> None:
    answer = pico("-C", str(lab), "devices", "check", "p1_mount")
    assert answer.code == 1 and "p1_mount failed when it was asked to say who it is" in answer.err
    unknown = pico("-C", str(lab), "devices", "check", "p1")
    assert unknown.code == 1 and "known: `p1_mount`, `p2_mount`" in unknown.err


def test_a_lab_without_devices_says_what_to_add(lab: Path, pico: Pico) -> None:
    (lab / "devices.yaml").unlink()
    answer = pico("-C", str(lab), "devices")
    assert answer.code == 1 and "kind: Devices" in answer.err


def test_what_is_not_installed_names_its_extra(lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "find_spec", lambda name: None)
    answer = pico("-C", str(lab), "devices", "check", "p1_mount")
    assert answer.code == 1 and "pip install 'pico-lab[thorlabs]'" in answer.err
    assert {driver(name).needs[1] for name in known() if name.startswith("scpi.")} == {"scpi"}  # type: ignore[index]


def test_neither_the_core_nor_the_list_of_devices_imports_a_vendors_library(lab: Path) -> None:
    code = (
        "import sys; from pico_cli.main import main\n"
        "for words in (['validate'], ['devices'], ['plan']): main(['-C', sys.argv[1], *words])\n"
        "from pico.drivers.registry import driver, known\n"
        "assert len([driver(n) for n in known()]) > 5\n"
        "print('loaded:', [n for n in sys.argv[2].split(',') if n in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(lab), ",".join(LIBRARIES)], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[-1] == "loaded: []"


@pytest.mark.parametrize(("axes", "angle"), [
    ({}, 30.0), ({"p1.angle": AxisZero(direction=-1, zero=12.5, sigma=0.1)}, 342.5),
])  # fmt: skip
def test_a_mount_reads_the_angle_that_its_calibration_makes_of_it(
    lab: Path, axes: dict[str, AxisZero], angle: float
) -> None:
    setup = bench_of(lab)
    (row,) = listed(named(setup, ["p1_mount"]))
    read = Answer(
        identity=Identity(vendor="Thorlabs", model="ELL14", serial="1"),
        readouts={"angle": Readout(value=30.0, unit="deg", raw="30")},
    )
    (found,) = properties_of(setup, [replace(row, answer=read)], axes)
    assert (found.value, found.address, found.lab_value) == (30.0, "p1.angle", pytest.approx(angle))

"""`pico calibrate` on a bench with devices: what was injected into the emulated one is found, by devices and a person
alone, is left off and taken up, and is what the bench then goes by."""

from __future__ import annotations

import json
import shutil
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from commanding import Pico, edit

from pico.backends.emulated.bench import PACE
from pico.backends.emulated.hands import SimulatedHands
from pico.bench.calibrating.walk import without
from pico.cameras.errors import true_cameras
from pico.manifest.load import load_folder
from pico.model.calibration.results import Provenance
from pico.twin.arms import arms_of
from pico.vision.arm import FoundArm
from pico.vision.calibration import Calibration
from pico.vision.calibration_files import read_calibration, write_calibration
from pico.vision.lens import lens
from pico.vision.rigid import apart

DEVICES = Path(__file__).resolve().parents[2] / "examples" / "devices.yaml"
EMULATED = ("--backend", "hardware", "--emulate")
there = find_spec("xarm") and find_spec("ElliptecBus")
HAND = """  hand:
    driver: frames.camera
    address: {host: 192.0.2.10, port: 5004}
  cam:
"""
ARM = "    arm: {mount_position: 2 mm, mount_rotation: 0.3 deg, joint_zero: 0.1 deg, tool_position: 1 mm}\n"
ERRORS = """  seed: 1
  errors:
    camera_position: 3 mm
    camera_rotation: 1 deg
    focal_length: 0.005
    distortion: 0.01
    devices: {p1.angle: {zero: 12.5}, p2.angle: {reversed: true}}
"""


@pytest.fixture
def wired(shel: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example with its instruments, which are wrong; time goes ten times as fast."""
    shutil.copy(DEVICES, shel)
    edit(shel / "lab.yaml", "  seed: 1\n", ERRORS)
    for _ in range(2):
        edit(shel / "lab.yaml", "pixels: [2448, 2048]", "pixels: [1632, 1366]")
    monkeypatch.setenv(PACE, "20")
    return shel


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("calibrate", "--list"), "the simulator finds its cameras and arms at once"),
        (("calibrate", "axis"), "axis"),
        ((*EMULATED, "calibrate", "steps", "axess"), "there is no step `axess`"),
        ((*EMULATED, "calibrate", "--board", "7by5"), "--board is '7by5'"),
        ((*EMULATED, "calibrate", "--square", "20"), "no board has 7x5 squares of 20 mm with markers of 27 mm"),
    ],
)
def test_what_makes_no_sense_is_told(wired: Path, pico: Pico, words: tuple[str, ...], said: str) -> None:
    answer = pico(*words)
    assert answer.code == 1 and said in answer.out + answer.err, answer.out + answer.err


@pytest.mark.slow
@pytest.mark.skipif(not there, reason="the extras xarm and thorlabs")
def test_what_is_wrong_with_an_emulated_bench_is_found_and_then_gone_by(
    wired: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    listed = pico(*EMULATED, "calibrate", "--list")
    assert listed.code == 0 and listed.out.count("not done yet") == 9, listed.out + listed.err
    assert "`pico --bench emulated calibrate intrinsics extrinsics axes dark arms`" in listed.out
    early = pico(*EMULATED, "calibrate", "extrinsics", "--hands", "simulated")
    assert early.code == 1 and "extrinsics comes after intrinsics" in early.err

    shown, held = SimulatedHands.show, []
    monkeypatch.setattr(SimulatedHands, "show", lambda self, *a: held.append(1) or (len(held) < 6 and shown(self, *a)))
    left = pico(*EMULATED, "calibrate", "intrinsics", "--hands", "simulated", "--shots", "10")
    assert left.code == 1 and "was left off" in left.err and "5/10" in left.out
    monkeypatch.setattr(SimulatedHands, "show", shown)
    found = pico(*EMULATED, "calibrate", "intrinsics", "extrinsics", "--hands", "simulated", "--shots", "10")
    assert found.code == 2 and "6/10" in found.out and "5/10" not in found.out, found.out + found.err
    pictures = wired / ".pico/benches/emulated/calibrating"
    assert {p.name for p in pictures.iterdir()} == {
        f"{s}-{c}.png" for s in ("intrinsics", "extrinsics") for c in ("left", "right")
    }

    setup = load_folder(wired).require()[0]
    true = true_cameras(setup, setup.lab.sim.errors, setup.lab.sim.seed)
    known = read_calibration(wired, "emulated")
    assert known is not None
    for name in ("left", "right"):
        how = known.provenance[f"extrinsics/{name}"]
        assert (how.bench, how.evidence, how.procedure) == ("emulated", "emulated", "extrinsics/1") and how.by
        assert how.held_out is not None and how.held_out < 0.2
        camera, sigmas = known.cameras[name], known.provenance[f"intrinsics/{name}"].uncertainty
        off = camera.pose[:3, 3] - true[name].pose[:3, 3]
        assert np.all(np.abs(off) < 4 * np.array([how.uncertainty[f"{axis}_mm"] for axis in "xyz"]))
        assert apart(camera.pose, true[name].pose)[1] < 0.05
        assert abs(lens(camera)[0] - lens(true[name])[0]) < 4 * sigmas["fx_px"]
        assert abs(lens(camera)[4] - lens(true[name])[4]) < 4 * sigmas["k1"]

    lens_anew = pico(*EMULATED, "calibrate", "intrinsics", "--hands", "simulated", "--shots", "6")
    assert lens_anew.code == 2 and "the lens was found anew since" in lens_anew.out, lens_anew.out + lens_anew.err
    assert "`pico --bench emulated calibrate intrinsics extrinsics" in lens_anew.out
    assert pico(*EMULATED, "calibrate", "extrinsics").code == 2
    assert "found anew" not in pico(*EMULATED, "calibrate", "--list").out

    mounts = pico(*EMULATED, "calibrate", "axes", "dark", "--hands", "simulated", "-y")
    assert mounts.code == 2 and "turns the other way than the lab has it" in mounts.out, mounts.out + mounts.err
    axes = json.loads((wired / "calibration/emulated.json").read_text())["axes"]
    assert {name: axis["direction"] for name, axis in axes.items()} == {"hwp.angle": 1, "p1.angle": 1, "p2.angle": -1}
    assert abs(axes["p1.angle"]["zero"] - 12.5) < 4 * axes["p1.angle"]["sigma"]
    again = pico(*EMULATED, "calibrate", "axes", "--hands", "simulated")  # with the correction in effect
    axes = json.loads((wired / "calibration/emulated.json").read_text())["axes"]
    assert again.code == 2 and abs(axes["p1.angle"]["zero"] - 12.5) < 4 * axes["p1.angle"]["sigma"]
    assert axes["p2.angle"]["direction"] == -1
    told = pico(*EMULATED, "set", "p2", "angle=33", "-y")
    assert told.code == 0, told.out + told.err
    stands = json.loads((wired / ".pico/benches/emulated/world.json").read_text())["components"]["p2"]["values"]
    assert abs(stands["angle"]["value"] - 33) < 1

    edit(wired / "calibration/emulated.json", '"evidence": "emulated"', '"evidence": "simulated"')
    refused = pico(*EMULATED, "status")
    assert (
        refused.code == 1 and "holds simulated results" in refused.err and "accepts only emulated ones" in refused.err
    )
    missing = pico(*EMULATED, "commission", "--only", "calibration", "-y")
    assert missing.code == 1 and "`pico --bench emulated calibrate axes`" in missing.err, missing.err


@pytest.mark.slow
@pytest.mark.skipif(not there, reason="the extras xarm and thorlabs")
def test_a_lens_that_was_calibrated_elsewhere_needs_no_board(wired: Path, pico: Pico) -> None:
    setup = load_folder(wired).require()[0]
    true = true_cameras(setup, setup.lab.sim.errors, setup.lab.sim.seed)
    for name in ("left", "right"):
        camera = true[name]
        about = {"width": camera.pixels[0], "height": camera.pixels[1], "distortion_model": "plumb_bob"}
        lens_said = {"K": camera.matrix.ravel().tolist(), "D": camera.distortion.tolist()}
        (wired / f"{name}.json").write_text(json.dumps({**about, **lens_said}))
        answer = pico(*EMULATED, "calibrate", "lens", name, f"{name}.json")
        assert answer.code == 0 and "5 coefficients" in answer.out, answer.out + answer.err
    wrong = pico(*EMULATED, "calibrate", "lens", "lefft", "left.json")
    assert wrong.code == 1 and "no camera over the table is called `lefft`" in wrong.err and "left" in wrong.err
    found = pico(*EMULATED, "calibrate", "extrinsics")
    assert found.code == 2 and "placed by the datums alone" in found.out, found.out + found.err
    known = read_calibration(wired, "emulated")
    assert known is not None
    for name in ("left", "right"):
        how = known.provenance[f"extrinsics/{name}"]
        off = known.cameras[name].pose[:3, 3] - true[name].pose[:3, 3]
        assert np.all(np.abs(off) < 4 * np.array([how.uncertainty[f"{axis}_mm"] for axis in "xyz"])), (off, how)
        assert known.provenance[f"intrinsics/{name}"].procedure == f"imported/1: {name}.json"


@pytest.mark.slow
@pytest.mark.skipif(not there, reason="the extras xarm and thorlabs")
def test_where_a_camera_sits_in_a_hand_is_found_and_forgotten_with_its_arm(
    wired: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pico.bench.calibrating.arms.POSTURES", 12)
    edit(wired / "devices.yaml", "  cam:\n", HAND)
    edit(wired / "lab.yaml", "    distortion: 0.01\n", f"    distortion: 0.01\n{ARM}")
    setup = load_folder(wired).require()[0]
    true = true_cameras(setup, setup.lab.sim.errors, setup.lab.sim.seed)
    built = arms_of(setup, setup.lab.sim.seed)["arm1"].built
    how = Provenance(bench="emulated", evidence="emulated", at="2026-11-28T00:00:00Z")
    over = {name: camera for name, camera in true.items() if camera.robot is None}
    steps = [f"{step}/{name}" for name in over for step in ("intrinsics", "extrinsics")]
    known = Calibration(over, arms={"arm1": FoundArm(offsets=built, position=0.02, turn=0.01)},
                        provenance=dict.fromkeys((*steps, "arms/arm1"), how))  # fmt: skip
    write_calibration(wired, "emulated", known)
    asked = pico(*EMULATED, "calibrate", "--list")
    assert "hands: lens and place" in asked.out and "✗ hand " in asked.out, asked.out
    answer = pico(*EMULATED, "calibrate", "hands", "--hands", "simulated", "-y")
    assert answer.code == 2 and "in the hand of arm1 by " in answer.out, answer.out + answer.err
    found = read_calibration(wired, "emulated")
    assert found is not None
    said = found.provenance["hands/hand"].uncertainty
    off = found.cameras["hand"].pose[:3, 3] - true["hand"].pose[:3, 3]
    assert np.all(np.abs(off) < 4 * np.array([said[f"{axis}_mm"] for axis in "xyz"])), (off, said)
    assert pico(*EMULATED, "status").code == 0, "a camera in a hand is none over the table"
    left = without(found, {"hands/hand": ""})
    assert "hands/hand" not in left.provenance and left.cameras.keys() == over.keys()


METER = """  pm_meter:
    driver: scpi.meter
    of: pm
    address: {visa: "TCPIP0::pm.invalid::5025::SOCKET"}
  curtain_box:"""


@pytest.mark.slow
@pytest.mark.skipif(not (there and find_spec("pyvisa_py")), reason="the extras xarm, thorlabs and scpi")
def test_what_a_meter_reads_without_light_is_found_and_taken_off(wired: Path, pico: Pico) -> None:
    edit(
        wired / "lab.yaml", "    camera_position: 3 mm\n    camera_rotation: 1 deg\n", ""
    )  # by which it could not observe
    edit(wired / "lab.yaml", "devices: {p1.angle", "devices: {pm.power: {dark: 0.002}, p1.angle")
    edit(
        wired / "lab.yaml",
        "inventory:\n",
        "inventory:\n  pm:\n    type: power_meter\n    pose: {x: 900, y: 700, yaw: 0}\n",
    )
    edit(wired / "devices.yaml", "  curtain_box:", METER)
    found = pico(*EMULATED, "calibrate", "dark", "--hands", "simulated", "-y")
    assert found.code == 2 and "pm.power: 0.00" in found.out, found.out + found.err
    known = read_calibration(wired, "emulated")
    assert known is not None
    dark = known.dark["pm.power"]
    assert abs(dark.level - 0.002) < 4 * dark.sigma and dark.unit == "mW"
    read = pico(*EMULATED, "measure", "pm.power", "--json").data
    assert abs(read["value"]) < 5 * dark.noise and read["settings"]["calibration"] == known.digest

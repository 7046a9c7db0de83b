"""A gantry of stages with a vacuum cup, through the hardware path on emulators at the wire."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
import yaml

from pico.bench.bench import Bench
from pico.manifest.load import load_folder

pytestmark = pytest.mark.skipif(not find_spec("zaber_motion"), reason="the extra zaber")
ROOT = Path(__file__).resolve().parents[3]
ARM = {
    "driver": "zaber.gantry", "address": {"host": "192.0.2.30", "port": 55550}, "identity": {"serial": "52001"},
    "settings": {"counts_per_mm": 2000, "counts_per_deg": 1000},
}  # fmt: skip
CUP = {"driver": "switches.gripper", "of": "arm1", "address": {"host": "192.0.2.20", "port": 4000, "name": "cup"}}
LIGHT = {
    f"laser_{name}": {
        "driver": f"switches.{kind}", "of": "laser", "address": {"host": "192.0.2.20", "port": 4000, "name": name}
    }
    for name, kind in (("shutter", "shutter"), ("head", "laser"))
}  # fmt: skip
SIGHT = {
    name: {"driver": "frames.camera", "address": {"host": "192.0.2.10", "port": 5000 + n}}
    for n, name in enumerate(("left", "right", "camera"))
}


def made_lab(folder: Path, **devices: Any) -> Path:
    """Write the lab `minimal` with a gantry, and its devices."""
    lab = yaml.safe_load((ROOT / "labs" / "minimal" / "lab.yaml").read_text())
    cup = {"fingers": "none"}
    lab["robots"] = {"arm1": {"model": "gantry", "mount": {"x": 100, "y": 800}, "transit_height": 300, "gripper": cup}}
    lab["cameras"] = {name: {**lab["cameras"][name], "pixels": [1224, 1024]} for name in ("left", "right")}
    (folder / "state").mkdir(parents=True)
    (folder / "lab.yaml").write_text(yaml.safe_dump(lab))
    (folder / "state" / "table.yaml").write_bytes((ROOT / "labs/minimal/state/table.yaml").read_bytes())
    head = {"apiVersion": "pico/v1", "kind": "Devices", "metadata": {"lab": "minimal"}}
    whole = {"arm1": ARM, "arm1_hand": CUP, **SIGHT, **LIGHT} | devices
    (folder / "devices.yaml").write_text(yaml.safe_dump({**head, "devices": whole}))
    return folder


def test_a_part_is_moved_grasped_and_placed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PICO_EMULATED_PACE", "20")
    with Bench.open(made_lab(tmp_path / "lab"), backend="emulated") as bench:
        plan = bench.single("lens", "move", x=660, y=420, yaw=15)
        report = bench.apply(plan)
        assert report.outcome == "done", report
        seen = bench.observe()
        lens, arm = seen.components["lens"], seen.robots["arm1"]
        assert lens.pose is not None and lens.pose.distance(type(lens.pose)(660, 420, 15)) < 0.1
        assert lens.pose.yaw == pytest.approx(15, abs=0.2)
        assert arm.holding is None and bench.setup.lab.robots["arm1"].is_parked(arm.joints)


def test_a_cup_that_holds_nothing_has_missed_the_part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PICO_EMULATED_PACE", "20")
    monkeypatch.setattr("pico.backends.emulated.world.BETWEEN", -1.0)
    with Bench.open(made_lab(tmp_path / "lab"), backend="emulated") as bench:
        events = list(bench.run(bench.single("lens", "move", x=660, y=420)))
        assert "arm1 missed lens: its hand holds nothing" in str([event.data for event in events])
        assert bench.observe().robots["arm1"].holding is None


@pytest.mark.parametrize(
    ("name", "driver", "hint"),
    [("arm1", "xarm.arm", "zaber.gantry"), ("arm1_hand", "xarm.gripper", "switches.gripper")],
)
def test_a_driver_for_another_robot_is_told_with_those_that_fit(
    tmp_path: Path, name: str, driver: str, hint: str
) -> None:
    entry = {"driver": driver, "of": "arm1", "address": {"host": "192.0.2.222"}}
    found = load_folder(made_lab(tmp_path / "lab", **{name: entry}))
    (one,) = [d for d in found.diagnostics if "is for the model" in d.summary]
    assert one.summary == f"arm1 is of the model `gantry`, and `{driver}` is for the model `xarm7`"
    assert hint in one.hint and one.source is not None and one.source.snippet.strip() == f"driver: {driver}"

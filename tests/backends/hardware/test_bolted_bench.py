"""A bench whose parts are all bolted, with neither an arm nor a camera over its table, at emulators of its devices."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from pico.bench.bench import Bench
from pico.diagnostics import PicoError
from pico.resources import labs_dir

DEVICES: dict[str, Any] = {
    "camera": {"driver": "frames.camera", "address": {"host": "192.0.2.10", "port": 5000}},
    "laser_shutter": {
        "driver": "switches.shutter", "of": "laser", "address": {"host": "192.0.2.20", "port": 4000, "name": "shutter"}
    },
    "laser_head": {
        "driver": "switches.laser", "of": "laser", "address": {"host": "192.0.2.20", "port": 4000, "name": "head"}
    },
}  # fmt: skip
LOOSE = {"marker": 1, "home": "storage/a2"}


def lab_of(folder: Path, lens: dict[str, Any]) -> Path:
    lab = yaml.safe_load((labs_dir() / "minimal" / "lab.yaml").read_text())
    lab = {key: value for key, value in lab.items() if key not in ("robots", "cameras", "datums")}
    lab["inventory"]["lens"] = {"type": "plano_convex_100", **lens}
    head = {"apiVersion": "pico/v1", "metadata": {"lab": "minimal"}}
    state = {**head, "kind": "LabState", "components": {"camera": {"exposure": 2}}}
    (folder / "state").mkdir(parents=True)
    (folder / "lab.yaml").write_text(yaml.safe_dump(lab))
    (folder / "state" / "table.yaml").write_text(yaml.safe_dump(state))
    (folder / "devices.yaml").write_text(yaml.safe_dump({**head, "kind": "Devices", "devices": DEVICES}))
    return folder


def test_it_needs_no_camera_to_know_where_its_parts_stand(tmp_path: Path) -> None:
    lab = lab_of(tmp_path / "lab", {"pose": {"x": 480, "y": 420, "yaw": 180}})
    with Bench.open(lab, backend="emulated") as bench:
        plan = bench.plan()
        assert [op.address for op in plan.operations] == ["camera.exposure"] and not plan.errored
        assert bench.apply(plan).outcome == "done"
        assert not bench.plan().operations
        pose = bench.observe().components["lens"].pose
        assert pose is not None and (pose.x, pose.y, pose.yaw) == (480, 420, 180)


def test_a_part_that_can_be_moved_needs_a_camera_over_the_table(tmp_path: Path) -> None:
    lab = lab_of(tmp_path / "lab", LOOSE)
    with pytest.raises(PicoError) as caught, Bench.open(lab, backend="emulated") as bench:
        bench.plan()
    assert (
        "no driver for a camera over the table, so it is not seen where lens stand"
        in caught.value.diagnostics[0].detail
    )

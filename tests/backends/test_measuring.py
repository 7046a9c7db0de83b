"""Measuring on the simulated bench: what is read, what was assured while it was, and what a new file adds."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from bench_at import bench_at

from pico.backends.conditions import conditions
from pico.backends.sim.readings import FOLDER
from pico.backends.sim.store import load_world, save_world
from pico.content.store import store_of
from pico.diagnostics import PicoError
from pico.edge.local import embedded
from pico.manifest.load import load_folder
from pico.model.catalog import Measurable
from pico.model.lab import Part
from pico.model.measurement import PEEKED, Measurement, measurement_from_json
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, ObservedValue
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.resources import labs_dir

SETUP = load_folder(labs_dir() / "shel").require()[0]


def operation(component: str, name: str, id: str = "op1") -> Operation:
    return Operation(
        id=id, primitive="measure", component=component, arguments={"measurable": name}, reason=Reason(kind="asked")
    )


def results(root: Path, *operations: Operation, setup: Setup = SETUP) -> list[OperationResult]:
    async def run() -> list[OperationResult]:
        bench = embedded(setup, bench_at(root), "kinematic")
        lease = await bench.acquire("test")
        try:
            return await asyncio.gather(*(bench.execute(op, f"r1/{op.id}/1", lease) for op in operations))
        finally:
            await bench.release(lease)
            await bench.close()

    return asyncio.run(run())


def measured(root: Path, component: str, name: str, setup: Setup = SETUP) -> Measurement:
    (result,) = results(root, operation(component, name), setup=setup)
    assert result.outcome == "done", result.error
    return measurement_from_json(result.data["measurement"])


def peeked(root: Path, component: str, name: str) -> Measurement:
    return asyncio.run(embedded(SETUP, bench_at(root), "kinematic").peek(component, name))


def test_a_set_point_is_read_back(tmp_path: Path) -> None:
    found = measured(tmp_path, "p1", "angle")
    assert (found.value, found.unit, found.address) == (0.0, "deg", "p1.angle")
    assert found.assured == ("settled", "arm parked") and not found.doubt


def test_a_set_point_that_nobody_knows_is_not_measured(tmp_path: Path) -> None:
    world = load_world(SETUP, bench_at(tmp_path))[0]
    save_world(bench_at(tmp_path), world.with_value("p1", "angle", ObservedValue(value=None, status="unknown")))
    (result,) = results(tmp_path, operation("p1", "angle"))
    assert result.error is not None and "p1.angle can't be read back" in result.error.summary


def test_a_pose_is_what_the_cameras_see_not_what_is_known(tmp_path: Path) -> None:
    found = measured(tmp_path, "p1", "pose")
    assert isinstance(found.value, dict) and isinstance(found.sigma, dict)
    seen, true = Pose(**found.value), load_world(SETUP, bench_at(tmp_path))[0].components["p1"].pose
    assert true is not None and 0 < seen.distance(true) < 0.3
    assert found.sigma["x"] > 0 and (found.kernel, found.kernel_version) == ("markers", "1")
    assert found.settings["seen by"] == "stereo" and found.settings["angle"] == 0.0


def test_a_part_that_no_camera_sees_has_no_pose_to_be_measured(tmp_path: Path) -> None:
    save_world(
        bench_at(tmp_path), load_world(SETUP, bench_at(tmp_path))[0].with_body("p1", presence="missing", pose=None)
    )
    (result,) = results(tmp_path, operation("p1", "pose"))
    assert result.error is not None and "p1" in result.error.summary and result.outcome == "failed"


def test_a_frame_lies_in_the_store_by_its_hash(tmp_path: Path) -> None:
    found = measured(tmp_path, "left", "frame")
    assert found.array is not None and found.array.dtype == "uint8"
    picture = np.load(BytesIO(store_of(tmp_path).get(found.array.sha256)), allow_pickle=False)
    assert picture.shape == found.array.shape == tuple(reversed(SETUP.lab.cameras["left"].pixels))
    assert found.value == pytest.approx({"peak": picture.max(), "mean": picture.mean()})
    assert "not saturated" in found.assured
    assert measured(tmp_path, "left", "frame").array == found.array


def test_a_peek_opens_nothing_and_nothing_of_it_is_assured(tmp_path: Path) -> None:
    found = peeked(tmp_path, "p1", "angle")
    assert (found.value, found.assured) == (0.0, ())
    assert dict(found.not_assured) == {"settled": PEEKED, "arm parked": PEEKED}
    assert not embedded(SETUP, bench_at(tmp_path), "kinematic").journal.records()
    with pytest.raises(PicoError, match="voltage of cam is not simulated"):
        peeked(tmp_path, "cam", "voltage")


def test_an_arm_that_stands_out_is_told(tmp_path: Path) -> None:
    world = load_world(SETUP, bench_at(tmp_path))[0]
    out = tuple(q + 0.3 for q in world.robots["arm1"].joints)
    save_world(bench_at(tmp_path), replace(world, robots={"arm1": ObservedRobot(joints=out)}))
    found = measured(tmp_path, "p1", "angle")
    assert found.assured == ("settled",)
    assert dict(found.not_assured) == {"arm parked": "arm1 is not at its park pose"}


def test_what_goes_on_beside_a_measurement_is_told(tmp_path: Path) -> None:
    arguments = {"tunable": "angle", "from": 0.0, "to": 90.0}
    turning = Operation(
        id="op7", primitive="set", component="p2", arguments=arguments, reason=Reason(kind="asked")
    )  # fmt: skip
    _, result = results(tmp_path, turning, operation("p1", "angle"))
    assert result.data["measurement"]["not_assured"] == {"settled": "op7 was under way"}


def needing(needs: dict[str, str]) -> Setup:
    """The laboratory, where the camera's exposure wants something of the bench."""
    kind = SETUP.type_of("cam")
    exposure = Measurable(datatype="setpoint", unit="ms", needs=needs)
    kind = replace(kind, measurables={**kind.measurables, "exposure": exposure})
    return replace(SETUP, catalog={**SETUP.catalog, kind.name: kind})


@pytest.mark.parametrize(
    ("needs", "assured", "why"),
    [
        ({"shutter": "closed"}, True, {}),
        ({"shutter": "open"}, False, {"shutter": "laser.shutter is closed, not open"}),
        ({"illumination": False}, False, {}),  # nobody can switch what lights this room
        ({}, False, {}),
    ],
)
def test_what_a_measurable_needs_is_read_back(
    tmp_path: Path, needs: dict[str, str], assured: bool, why: dict[str, str]
) -> None:
    found = measured(tmp_path, "cam", "exposure", needing(needs))
    assert ("shutter" in found.assured, dict(found.not_assured)) == (assured, why)


@pytest.mark.parametrize(("emission", "why"), [(True, "spare has no shutter and is not known to be off"), (False, "")])
def test_darkness_is_not_assured_beside_a_laser_that_has_no_shutter(tmp_path: Path, emission: bool, why: str) -> None:
    setup = needing({"shutter": "closed"})
    bare = setup.type_of("laser")
    bare = replace(bare, name="bare", tunables={n: t for n, t in bare.tunables.items() if n != "shutter"})
    lab = replace(setup.lab, inventory={**setup.lab.inventory, "spare": Part(type="bare", home="none")})
    two = replace(setup, lab=lab, catalog={**setup.catalog, "bare": bare})
    laser = ObservedComponent(pose=Pose(100, 100), values={"shutter": ObservedValue(value="closed")})
    spare = ObservedComponent(pose=Pose(100, 800), values={"emission": ObservedValue(value=emission)})
    seen = Observation(backend="sim", components={"laser": laser, "spare": spare})
    assert conditions(two, seen, "cam", two.measurables_of("cam")["exposure"])["shutter"] == why


VOLTAGE = """
from pico.backends.measured import Reading

def measures(setup, component, measurable):
    return measurable == "voltage" and component == "cam"

def read(table, component, measurable):
    return Reading({"peak": 7.0 + table.world.clock, "mean": 1.0})
"""


def test_a_measurable_is_added_by_one_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import importlib
    import sys

    kind = SETUP.type_of("cam")
    kind = replace(kind, measurables={**kind.measurables, "voltage": Measurable(datatype="float", unit="V")})
    setup = replace(SETUP, catalog={**SETUP.catalog, kind.name: kind})
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "made_up.py").write_text(VOLTAGE)
    package = importlib.import_module(FOLDER)
    monkeypatch.setattr(package, "__path__", [*package.__path__, str(tmp_path / "more")])
    try:
        assert "cam.voltage" in asyncio.run(embedded(setup, bench_at(tmp_path), "kinematic").describe()).measurables
        assert measured(tmp_path, "cam", "voltage", setup).value == {"peak": 7.5, "mean": 1.0}
    finally:
        sys.modules.pop(f"{FOLDER}.made_up")

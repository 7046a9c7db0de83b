"""What a bench tells without pictures, and what is said of what it does not tell."""

from __future__ import annotations

import asyncio
import time
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from emulated_lab import wired_lab

from pico.backends.hardware import device, reading
from pico.backends.hardware.device import HardwareDevice
from pico.backends.hardware.instruments import Instruments, require_whole, unwired, wired
from pico.backends.hardware.links import Links
from pico.backends.hardware.reading import sensed, told
from pico.backends.hardware.settings import Settings
from pico.backends.last_seen import Taken
from pico.backends.sight import unlooked
from pico.diagnostics import PicoError, error, warning
from pico.drivers.driven import Emitting, Motorized
from pico.drivers.protocols import ArmState, Grip, SafetyState
from pico.drivers.registry import Buses, driver
from pico.model.comparing.drift import drift_of
from pico.model.comparing.status import compare
from pico.model.instruments.conversion import conversion
from pico.model.observation import NO_VIEW, Observation, ObservedComponent, ObservedValue
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState
from pico.model.wiring import SafetyEntry, Wired
from pico.twin.arms import TwinArm


class One:
    """An instrument that reads what it is told, or fails."""

    def __init__(self, reads: Any) -> None:
        self.reads = reads

    async def read(self) -> Any:
        if isinstance(self.reads, PicoError):
            raise self.reads
        return self.reads

    state = grip = position = read


def test_a_laser_that_answers_nothing_keeps_no_look_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    class Silent:
        async def emitting(self) -> bool:
            await asyncio.sleep(5.0)
            return True

    monkeypatch.setattr(reading, "LIGHT_ANSWERS", 0.05)
    bench = Instruments()
    bench.tunables["laser.emission"] = Emitting(Silent())  # type: ignore[arg-type]
    bench.tunables["p1.angle"] = One(ObservedValue(value=3.0))  # type: ignore[assignment]
    began = time.monotonic()
    found = asyncio.run(told(bench))
    assert time.monotonic() - began < 2.0
    assert found.values["laser.emission"].value is None and found.values["p1.angle"].value == 3.0
    (problem,) = found.problems
    assert problem.address == "laser.emission" and "it did not answer within 0.05 s" in problem.summary


LOST = PicoError(error("device-lost", "it did not answer within 2 s", address="p1_mount"))


@pytest.fixture
def setup(tmp_path: Path) -> Setup:
    return wired_lab(tmp_path)


def seen_of(
    setup: Setup, *, angle: Any = 12.5, width: float = 84.0, curtain: Any = True, arm: Any = None
) -> Observation:
    bench, park = Instruments(), setup.lab.robots["arm1"].park_joints
    bench.arms["arm1"] = One(arm or ArmState(joints=park, age=0.1, moving=False, enabled=True))  # type: ignore[assignment]
    bench.grippers["arm1"] = One(Grip(width=width, holds=None))  # type: ignore[assignment]
    bench.tunables["p1.angle"] = Motorized(One(angle), conversion(Wired(property="angle"), "deg", "deg"))  # type: ignore[arg-type]
    entry = SafetyEntry(kind="curtain", device="box")
    state = curtain if isinstance(curtain, PicoError) else SafetyState(safe=curtain, age=0.0)
    bench.inputs["curtain"] = entry, One(state)  # type: ignore[assignment]
    arms = {"arm1": TwinArm(setup.lab.robots["arm1"])}
    taken = {"arm1": Taken(component="lx_125", pose=Pose(0, 0))}
    found = asyncio.run(told(bench))
    return sensed(setup, arms, found, {"curtain": "curtain"}, taken, "hardware", 5.0, "2026-11-25T12:00:00Z")


def test_what_instruments_tell_is_known(setup: Setup) -> None:
    seen = seen_of(setup)
    assert seen.known_values["p1"] == {"angle": 12.5}
    assert seen.robots["arm1"].joints == setup.lab.robots["arm1"].park_joints
    assert (seen.robots["arm1"].holding, seen.robots["arm1"].opening, seen.person) == (None, 84.0, False)
    assert not seen.problems


def test_an_axis_that_does_not_answer_is_unknown_and_told(setup: Setup) -> None:
    seen = seen_of(setup, angle=LOST)
    assert seen.components["p1"].values["angle"].status == "unknown"
    assert [(p.code, p.address) for p in seen.problems] == [("unread", "p1.angle")]
    assert "it did not answer within 2 s" in seen.problems[0].summary


def test_an_axis_that_must_be_homed_is_unknown(setup: Setup) -> None:
    assert seen_of(setup, angle=None).components["p1"].values["angle"].status == "unknown"


def test_where_an_arm_can_not_tell_where_it_is_nothing_is_seen(setup: Setup) -> None:
    with pytest.raises(PicoError, match="did not answer"):
        seen_of(setup, arm=LOST)


def test_an_arm_that_was_lost_and_found_again_is_told(setup: Setup) -> None:
    park = setup.lab.robots["arm1"].park_joints
    state = ArmState(joints=park, age=0.1, moving=False, enabled=False, lost="the control box closed the connection")
    (problem,) = seen_of(setup, arm=state).problems
    assert (problem.code, problem.address, problem.severity) == ("arm-lost", "arm1", "warning")
    assert "arm1 was lost, for the control box closed the connection" in problem.summary


def test_a_hand_holds_what_it_took_where_its_pads_are_as_far_apart_as_that_is_wide(setup: Setup) -> None:
    grasp = setup.type_of("lx_125").geometry.grasp
    assert grasp is not None
    seen = seen_of(setup, width=grasp.width + 0.3)
    assert seen.robots["arm1"].holding == "lx_125" and seen.components["lx_125"].presence == "held"
    assert seen_of(setup, width=10.0).robots["arm1"].holding is None


@pytest.mark.parametrize(("curtain", "person"), [(True, False), (False, True), (None, None), (LOST, None)])
def test_somebody_is_at_the_table_unless_a_curtain_says_that_nobody_is(
    setup: Setup, curtain: Any, person: bool | None
) -> None:
    assert seen_of(setup, curtain=curtain).person is person


def test_what_has_no_device_is_left_out_but_for_light(setup: Setup) -> None:
    seen = seen_of(setup)
    assert set(seen.components["ly_150"].values) == set()
    assert seen.components["laser"].values["shutter"].status == "unknown", "it may be open"


@pytest.mark.skipif(not (find_spec("xarm") and find_spec("ElliptecBus")), reason="the extras xarm and thorlabs")
def test_the_instruments_of_a_lab_are_found_by_what_it_names(setup: Setup, tmp_path: Path) -> None:
    assert setup.wiring is not None
    found = wired(setup, setup.wiring.devices, Buses(), Settings(bench_at(tmp_path, "hardware")))
    assert set(found.arms) == set(found.grippers) == {"arm1"} and set(found.cameras) == {"left", "right"}
    assert {"p1.angle", "ly_150.stage_y", "laser.shutter", "laser.emission", "cam.exposure"} <= set(found.tunables)
    assert set(found.sensors) == {"cam"} and set(found.inputs) == {"curtain"}
    assert unwired(setup, found) == ()


@pytest.mark.parametrize(
    ("without", "said"),
    [("arm1", "no driver for the arm arm1"), ("arm1_hand", "no driver for the gripper of arm1"),
     ("right", "no driver for the camera right")],
)  # fmt: skip
def test_a_bench_that_lacks_what_nothing_works_without_says_so(setup: Setup, without: str, said: str) -> None:
    assert setup.wiring is not None
    entries = {name: entry for name, entry in setup.wiring.devices.items() if name != without}
    kinds = {name: driver(entry.driver).kind for name, entry in entries.items()}
    with pytest.raises(PicoError) as caught:
        require_whole(setup, entries, kinds)
    assert said in caught.value.diagnostics[0].detail


@pytest.mark.parametrize(("patience", "asked"), [(60.0, 6), (0.0, 1)])
def test_a_camera_that_fails_is_asked_again_but_not_for_long(
    setup: Setup, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, patience: float, asked: int
) -> None:
    grabs = list[str]()

    class Silent:
        async def grab(self) -> None:
            grabs.append("left")
            raise LOST

    bench = Instruments()
    bench.cameras["left"] = Silent()  # type: ignore[assignment]
    monkeypatch.setattr(device, "PATIENCE", patience)
    place = bench_at(tmp_path, "hardware")
    about = HardwareDevice(setup, place, Links(setup, place), "kinematic", clock=lambda: "")
    with pytest.raises(PicoError):
        asyncio.run(about._frame(bench, "left"))
    assert len(grabs) == asked


def test_parts_are_of_unknown_place_and_not_missing_if_no_camera_can_be_used(setup: Setup) -> None:
    text = "no camera sees its marker"
    seen = Observation(
        backend="emulated", problems=(warning("marker-hidden", text, address="p2"),),
        components={
            "p2": ObservedComponent(presence="missing"), "laser": ObservedComponent(pose=Pose(200, 420), how="fixed"),
        },
    )  # fmt: skip
    found = unlooked(seen)
    (told_once,) = found.problems
    assert told_once.code == NO_VIEW and "of unknown place: p2" in told_once.summary
    assert found.components["p2"].is_unlooked and not found.components["laser"].is_unlooked
    state = LabState(lab=setup.lab.name, components={"p2": ComponentState(pose=Pose(520, 420, 30))})
    row = next(r for r in compare(setup, None, state, found, "").rows if r.address == "p2")
    assert row.note == "unknown"
    (change,) = [c for c in drift_of(setup, found, state) if c.component == "p2"]
    assert change.text.startswith("unknown: no camera over the table can be used")
    assert unlooked(replace(seen, components={}, problems=())).problems == (), "nothing is told if nothing is lost"

"""What goes wrong while something is measured or an axis drives: each does what its name says, and no more."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path

import pytest
from bench_at import bench_at
from benches import shel, sim

from pico.backends.sim.device import SimDevice
from pico.backends.sim.faults import Faults, save_faults
from pico.backends.sim.store import load_world
from pico.backends.sim.world import World
from pico.model.measurement import measurement_from_json
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.setup import Setup

SETUP = shel("gantry")[0]
SETUP = replace(SETUP, lab=replace(SETUP.lab, sim=replace(SETUP.lab.sim, environment="none")))


def operations(root: Path, kind: str, *wanted: tuple[str, str, dict[str, object]]) -> list[OperationResult]:
    """Do operations one after the other on a bench on which every one that can goes wrong so."""

    async def do() -> list[OperationResult]:
        device = SimDevice(SETUP, bench_at(root), clock=lambda: "2026-11-01T12:00:00Z")
        await device.take(1, lambda _: None)
        found = []
        for number, (primitive, component, arguments) in enumerate(wanted):
            operation = Operation(
                id=f"op{number}", primitive=primitive, component=component, arguments=arguments,
                reason=Reason(kind="asked"),
            )  # fmt: skip
            found.append(await device.execute(operation, f"r1/op{number}/1", lambda _: None))
        await device.leave()
        return found

    save_faults(bench_at(root), Faults(rates={kind: 1.0} if kind else {}, seed=1))
    return asyncio.run(do())


def world(setup: Setup, root: Path) -> World:
    return load_world(setup, bench_at(root))[0]


OPEN = ("set", "laser", {"tunable": "shutter", "to": "open"})
ON = ("set", "laser", {"tunable": "emission", "to": True})
PEAK = ("measure", "cam", {"measurable": "image"})
DRIVE = ("set", "p1", {"tunable": "angle", "to": 40.0})


def test_a_frame_that_is_lost_is_a_failure_and_the_next_one_is_as_ever(tmp_path: Path) -> None:
    (_, lost) = operations(tmp_path, "frame", OPEN, PEAK)
    assert lost.outcome == "failed" and lost.error and lost.error.code == "frame"
    (again,) = operations(tmp_path, "", PEAK)
    assert again.outcome == "done"


@pytest.mark.parametrize("kind", ["beam", "flood"])
def test_the_light_of_a_laser_is_lost_or_far_too_much_and_its_tunables_read_as_ever(tmp_path: Path, kind: str) -> None:
    def mean(root: Path, kind: str) -> float:
        *_, taken = operations(root, kind, ON, OPEN, ("set", "cam", {"tunable": "exposure", "to": 0.02}), PEAK)
        found = measurement_from_json(taken.data["measurement"])
        assert taken.outcome == "done" and "shutter" not in found.not_assured and isinstance(found.value, dict)
        return float(found.value["mean"]) - 64  # counts of black

    usual, odd = mean(tmp_path / "usual", ""), mean(tmp_path / kind, kind)
    assert abs(odd) < 0.01 * usual if kind == "beam" else odd > 2 * usual
    laser = world(SETUP, tmp_path / kind).components["laser"].values
    assert laser.keys() == set(SETUP.type_of("laser").tunables) and laser["shutter"].value == "open"


def test_an_axis_that_sticks_stays_where_it_stopped_until_faults_are_off(tmp_path: Path) -> None:
    (stopped,) = operations(tmp_path, "stick", DRIVE)
    assert stopped.outcome == "failed" and stopped.error and stopped.error.code == "jammed"
    at = world(SETUP, tmp_path).components["p1"].values["angle"]
    assert at.status == "unknown" and isinstance(at.value, float) and 0 < at.value < 40
    (again, other) = operations(tmp_path, "", DRIVE, ("set", "p2", {"tunable": "angle", "to": 40.0}))
    assert again.outcome == "failed" and other.outcome == "done"
    assert world(SETUP, tmp_path).components["p1"].values["angle"] == at
    sim(SETUP, tmp_path).world.faults(["off"])
    (freed,) = operations(tmp_path, "", DRIVE)
    assert freed.outcome == "done" and world(SETUP, tmp_path).components["p1"].values["angle"].value == 40.0


def test_the_arm_of_a_shutter_does_not_stick(tmp_path: Path) -> None:
    (_,) = operations(tmp_path, "stick", OPEN)
    assert world(SETUP, tmp_path).stuck == ()

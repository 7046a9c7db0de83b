"""What a goal wants only while it is sought is set beside the work of arms, where that lets no other light to them."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path

import pytest
from bench_at import bench_at

from pico.backends.sim.device import SimDevice
from pico.manifest.load import load_folder
from pico.model.observation import Observation
from pico.model.operation import Operation, Reason
from pico.model.setup import Setup
from pico.planning.optimizing import Turn, optimizing
from pico.planning.sought import Sought

LAB = """apiVersion: pico/v1
kind: Lab
metadata: {name: crossed}
table: {size: [1200, 900], beam_height: 70}
robots:
  arm1: {model: gantry, mount: {x: 480, y: 820}}
policy: {enclosed: true}
sim: {environment: none}
goals:
  null:
    tunables: {p2.angle: [0, 170]}
    minimize: pd.voltage
    during: {p1.angle: 45, laser.shutter: open}
    budget: {measurements: 25, seconds: 900}
inventory:
  laser: {type: hene_laser, pose: {x: 120, y: 220, yaw: 0}}
  p1: {type: linear_polarizer, marker: 1, pose: {x: 320, y: 220, yaw: 0}}
  p2: {type: linear_polarizer, marker: 2, pose: {x: 450, y: 220, yaw: 0}}
  pd: {type: photodiode, marker: 3, pose: {x: 620, y: 220, yaw: 0}}
"""
MOVES = tuple(
    Operation(id=f"{name}_moves", primitive="move", component=name, robot="arm1", reason=Reason(kind="asked"))
    for name in ("p1", "p2")
)


@pytest.fixture
def crossed(tmp_path: Path) -> tuple[Setup, Observation]:
    (tmp_path / "lab.yaml").write_text(LAB)
    (tmp_path / "state.yaml").write_text("apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: crossed}\n")
    setup = load_folder(tmp_path).require()[0]

    async def seen() -> Observation:
        device = SimDevice(setup, bench_at(tmp_path), clock=lambda: "2026-11-01T12:00:00Z")
        await device.take(1, lambda _: None)
        found = await device.observe()
        await device.leave()
        return found

    return setup, asyncio.run(seen())


def waits(setup: Setup, seen: Observation) -> dict[str, set[str]]:
    """What each set-point before the search waits for, of the arm's moves."""
    null = Turn(Sought("null", (setup.lab.goals or {})["null"], "malus"))
    made = optimizing(setup, seen, [null], None, MOVES)
    at = next(n for n, op in enumerate(made) if op.primitive == "optimize")
    moves = {op.id for op in MOVES}
    return {op.component: moves & {*op.after} for op in made[:at] if op.primitive == "set"}


def test_what_a_goal_wants_meanwhile_waits_for_its_own_part_alone(crossed: tuple[Setup, Observation]) -> None:
    found = waits(*crossed)
    assert found["p1"] == {"p1_moves"}, "p1 is turned while p2 is carried"
    assert found["laser"] == {"p1_moves", "p2_moves"}, "light comes when all is in its place"


def test_where_beams_stay_open_it_waits_for_all_work(crossed: tuple[Setup, Observation]) -> None:
    setup, seen = crossed
    open_beam = replace(setup, lab=replace(setup.lab, policy=replace(setup.lab.policy, open_beam=True)))
    assert waits(open_beam, seen)["p1"] == {"p1_moves", "p2_moves"}

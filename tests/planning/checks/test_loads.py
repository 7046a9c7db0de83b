"""A part that no arm carries is refused before any plan; masses, payloads and grippers are the lab's to say."""

from __future__ import annotations

import math
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.manifest.load import load_folder
from pico.model.robot import Gripper, Mount, Robot
from pico.model.setup import Setup
from pico.planning.checks.loads import check_loads, overload
from pico.planning.parts.movers import mover
from pico.resources import labs_dir

SETUP, STATE = load_folder(labs_dir() / "minimal").require()
PART = next(name for name in SETUP.lab.inventory if SETUP.movable(name))
ARM = next(iter(SETUP.lab.robots))


def weighing(mass: float, **robot: object) -> Setup:
    inventory = {**SETUP.lab.inventory, PART: replace(SETUP.lab.inventory[PART], mass=mass)}
    robots = {ARM: replace(SETUP.lab.robots[ARM], **robot)}  # type: ignore[arg-type]
    return replace(SETUP, lab=replace(SETUP.lab, inventory=inventory, robots=robots))


@pytest.mark.parametrize(
    ("mass", "robot", "why"),
    [
        (2.6, {}, ""),
        (2.7, {}, "it carries 3.5 kg with its hand of 0.82 kg, so 2.68 kg"),
        (2.7, {"payload": 5.0}, ""),
        (3.1, {"payload": 5.0}, "its gripper holds 3.06 kg by friction"),
        (3.1, {"payload": 5.0, "gripper": Gripper(friction=0.8)}, ""),
        (1.0, {"gripper": Gripper(force=8.0)}, "its gripper holds 0.816 kg by friction"),
        (2.0, {"gripper": Gripper(mass=2.0)}, "it carries 3.5 kg with its hand of 2 kg, so 1.5 kg"),
        (3.4, {"gripper": Gripper(fingers="none")}, ""),
        (3.4, {"gripper": Gripper(fingers="none", force=20.0)}, "its gripper holds 2.04 kg"),
    ],
)
def test_an_arm_carries_its_payload_less_its_hand_and_what_its_gripper_holds(
    mass: float, robot: dict[str, object], why: str
) -> None:
    setup = weighing(mass, **robot)
    found = overload(setup, PART)
    assert (found is None) == (not why)
    assert found is None or why in found.detail


@given(st.floats(0.01, 50), st.floats(0.1, 100), st.floats(0, 200), st.floats(0, 2))
def test_what_is_carried_is_held_against_gravity(mass: float, payload: float, force: float, friction: float) -> None:
    arm = Robot(mount=Mount(x=0, y=0), payload=payload, gripper=Gripper(mass=0.5, force=force, friction=friction))
    fits = mass + 0.5 <= payload and mass * 9.80665 <= 2 * friction * force
    assert bool(arm.too_heavy(mass)) != fits or math.isclose(mass * 9.80665, 2 * friction * force, abs_tol=1e-6)


def test_no_plan_has_an_arm_pick_what_it_does_not_carry() -> None:
    from pico.backends.sim.world import new_world, observe

    for mass, picks in ((2.0, True), (9.0, False)):
        setup = weighing(mass)
        seen = observe(new_world(setup), "sim", "2026-01-01T00:00:00Z")
        assert bool(mover(setup, seen, STATE, PART, (ARM,), right=False).holds) == picks


def test_what_a_person_moves_and_a_bench_without_an_arm_have_no_limit() -> None:
    heavy = weighing(90.0)
    assert overload(replace(heavy, lab=replace(heavy.lab, robots={})), PART) is None
    bolted = {**heavy.lab.inventory, PART: replace(heavy.lab.inventory[PART], seating="bolted")}
    assert not replace(heavy, lab=replace(heavy.lab, inventory=bolted)).movable(PART)


def test_validate_names_the_part_at_its_line(tmp_path: Path) -> None:
    shutil.copytree(labs_dir() / "minimal", tmp_path / "lab")
    path = tmp_path / "lab" / "lab.yaml"
    path.write_text(path.read_text().replace(f"\n  {PART}:\n", f"\n  {PART}:\n    mass: 4 kg\n"))
    (found,) = check_loads(load_folder(tmp_path / "lab"))
    assert found.code == "payload" and f"{PART} weighs 4 kg" in found.summary
    assert found.source is not None and found.source.path.endswith("lab.yaml")


def test_what_is_not_said_leaves_the_digest_of_a_lab_as_it_was() -> None:
    assert Gripper() == Gripper(mass=None, force=None, friction=None)
    assert weighing(0.5).digest() != SETUP.digest()

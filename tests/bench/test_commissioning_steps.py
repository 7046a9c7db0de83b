"""The pure parts of a commissioning: which parts it takes, where they may go, which way an arm turns."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest
from pico_cli.commands.commission import Person
from pico_cli.session import Session

from pico.backends.hardware.walking import speed_of
from pico.backends.ways import backwards
from pico.bench.commissioning.placing import free_slots, one_of_each, pick_and_place
from pico.bench.commissioning.reaching import outside
from pico.bench.commissioning.standing import NO_ARM, AtBench, shortened
from pico.bench.commissioning.swinging import first_move, stop_distance
from pico.diagnostics import PicoError
from pico.manifest.load import load_folder
from pico.model.observation import Observation, ObservedComponent
from pico.model.setup import Setup
from pico.motion.types import MovePath, Segment

LAB = Path(__file__).resolve().parents[2] / "labs" / "shel"


@pytest.fixture(scope="module")
def setup() -> Setup:
    return load_folder(LAB).require()[0]


@pytest.fixture(scope="module")
def seen(setup: Setup) -> Observation:
    """Every part at its home."""
    at = {n: p.pose or setup.lab.slots[p.home].pose for n, p in setup.lab.inventory.items() if p.pose or p.home}
    return Observation(backend="hardware", components={name: ObservedComponent(pose=pose) for name, pose in at.items()})


def test_one_part_of_each_type_that_arms_move_is_taken_and_no_sample(setup: Setup, seen: Observation) -> None:
    assert sorted(one_of_each(setup, seen).values()) == ["lx_100", "lx_125", "ly_150", "ly_200", "p1"]
    gone = replace(seen, components={**seen.components, "p1": ObservedComponent(presence="missing")})
    assert "p2" in one_of_each(setup, gone).values()
    part = replace(setup.lab.inventory["lx_100"], sample="a slide of onion skin")
    holding = replace(setup, lab=replace(setup.lab, inventory={**setup.lab.inventory, "lx_100": part}))
    assert "lx_100" not in one_of_each(holding, seen).values()


def test_it_goes_where_nothing_stands(setup: Setup, seen: Observation) -> None:
    free = [*free_slots(setup, seen, "p1")]
    taken = {part.home for part in setup.lab.inventory.values() if part.home}
    assert free and not taken & set(free)


def test_a_path_backwards_begins_where_the_arm_stands_and_takes_as_long(setup: Setup) -> None:
    park = setup.lab.robots["arm1"].park_joints
    turned = tuple(q + (0.5 if joint == 0 else 0.0) for joint, q in enumerate(park))
    path = MovePath("arm1", None, (Segment("park", (0.0, 1.5, 2.0), (turned, park, park), 84.0),))
    back = backwards(path, park)
    assert back.segments[0].joints[0] == park and back.end == turned
    assert back.segments[0].times == (0.0, 0.5, 2.0) and back.seconds == path.seconds
    chord = 2 * 191.0 * math.sin(0.25)  # it parks with its tool so far from its base
    assert speed_of(setup, back) == pytest.approx(speed_of(setup, path)) == pytest.approx(chord / 1.5, rel=1e-3)


def test_an_arm_that_parks_outside_of_its_fence_is_named(setup: Setup) -> None:
    arm = setup.lab.robots["arm1"]
    assert [*outside("arm1", arm, {})] == [*outside("arm1", arm, {"x": (0, 400), "y": (-400, 400)})] == []
    (told,) = outside("arm1", arm, {"x": (250, 400)})
    assert told == "arm1 parks outside of its fence: x is 191 mm, of 250 to 400 mm"


def test_what_was_made_shorter_says_so() -> None:
    assert shortened(2, 30, "times") == " (shortened: 2 times instead of 30)"
    assert shortened(30, 30, "times") == shortened(40, 30, "times") == ""


def test_yes_says_of_no_real_bench_that_a_hand_is_on_its_stop() -> None:
    real = Person(Session(), auto_approve=True, name="hardware")
    assert real.confirm("Take p1?")
    with pytest.raises(PicoError, match="nobody can be asked here"):
        real.confirm("Is a hand on the stop?", by_person=True)
    assert Person(Session(), auto_approve=True, name="emulated").confirm("Is a hand on the stop?", by_person=True)


def test_a_bench_without_arms_has_nothing_to_be_tried_of_them(setup: Setup) -> None:
    bare = SimpleNamespace(edge=SimpleNamespace(setup=replace(setup, lab=replace(setup.lab, robots={}))))
    for step in (first_move, stop_distance, pick_and_place):
        assert step(cast(AtBench, bare)) == NO_ARM

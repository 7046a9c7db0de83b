"""Light that is not followed to its end: what it may come to is unknown, and only that."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from light_benches import kind, light, setup_of

from pico.model.observation import ObservedValue
from pico.model.pose import Pose
from pico.optics.beam_table import troubles
from pico.optics.ends import stray_beams
from pico.optics.nominal.bench import Nominal

PLATE = kind("plate_beam_splitter", reflectance=0.9, transmittance=0.1)
CAVITY: dict[str, Any] = {"laser": kind("hene_laser"), "c1": PLATE, "c2": PLATE, "meter": kind("power_meter")}
POSES = {"laser": Pose(120, 400), "c1": Pose(420, 400), "c2": Pose(620, 400, 180), "meter": Pose(760, 400)}
BESIDE: dict[str, Any] = {"second": kind("hene_laser"), "other": kind("power_meter")}
APART = {"second": Pose(120, 900), "other": Pose(760, 900)}


def test_a_detector_behind_a_cavity_is_unknown_and_one_beside_it_is_not() -> None:
    found = light(CAVITY | BESIDE, POSES | APART)
    assert found.endless == ("laser",)
    assert found.unfollowed("meter").startswith("the beam of laser was followed for 256 stretches")
    assert found.at("other") and not found.unfollowed("other")


def test_a_detector_before_a_cavity_is_known_if_nothing_comes_back_to_it() -> None:
    """An isolator keeps what comes back from the pick-off: the trace behind it is cut, and changes nothing there."""
    kinds: dict[str, Any] = {
        **CAVITY, "pick": kind("beam_splitter_50_50"), "side": kind("power_meter"), "iso": kind("faraday_isolator"),
    }  # fmt: skip
    poses = POSES | {"pick": Pose(220, 400), "side": Pose(220, 600, 90), "iso": Pose(300, 400)}
    found = light(kinds, poses)
    assert found.at("side") and found.unfollowed("meter")
    behind = light({**kinds, "c1": kind("power_meter")}, {n: p for n, p in poses.items() if n not in ("c2", "meter")})
    assert not behind.endless and not behind.unfollowed("side")


def test_light_that_is_followed_to_its_end_is_known() -> None:
    open_way = light({n: k for n, k in CAVITY.items() if n != "c2"}, {n: p for n, p in POSES.items() if n != "c2"})
    assert not open_way.cut and open_way.at("meter") and not open_way.unfollowed("meter")


def test_a_cut_trace_is_one_warning_with_its_count_and_the_detectors() -> None:
    setup = setup_of(CAVITY)
    found = troubles(setup, light(CAVITY, POSES))
    cut = [one for one in found if one.code == "endless"]
    assert [one.summary for one in cut] == [
        "the beam of laser goes round and round, and is not followed beyond 256 stretches: what meter would read is "
        "unknown"
    ]
    back = [one.summary for one in found if "comes back" in one.summary]
    assert len(back) == len({text.partition(" (")[0] for text in back}) and any("beams)" in text for text in back)


def test_a_state_with_a_cavity_has_one_warning_of_it() -> None:
    from pico.model.state import ComponentState, LabState

    parts = {n: ComponentState(pose=pose) for n, pose in POSES.items()}
    parts["laser"] = ComponentState(pose=POSES["laser"], values={"emission": True})
    found = stray_beams(setup_of(CAVITY), LabState(lab="light", components=parts))
    assert sum(one.code == "endless" for one in found) == 1
    assert len({one.summary for one in found}) == len(found) < 5


@pytest.mark.parametrize("number", ["spot.left", "way.up"])
def test_a_model_of_the_bench_has_no_number_behind_a_cavity(number: str) -> None:
    nominal = Nominal(setup_of(CAVITY | BESIDE), POSES | APART, {})
    assert nominal.numbers([f"meter.{number}"]) is None
    known = nominal.numbers([f"other.{number}"])
    assert known is not None and np.isfinite(known).all()


@pytest.mark.parametrize(
    ("detector", "measurable"),
    [("power_meter", "power"), ("beam_camera", "image"), ("beam_camera", "centroid"), ("fiber_coupler", "power")],
)
def test_the_simulator_reads_nothing_behind_a_cavity_and_says_why(detector: str, measurable: str) -> None:
    from pathlib import Path

    from pico.backends.sim.readings import Table, measurer_of
    from pico.backends.sim.world import new_world

    bench = setup_of(CAVITY | {"meter": kind(detector)})
    placed = {name: replace(part, home=None, pose=POSES[name]) for name, part in bench.lab.inventory.items()}
    setup = replace(bench, lab=replace(bench.lab, inventory=placed))
    world = new_world(setup)
    for tunable, value in (("emission", True), ("shutter", "open")):
        world = world.with_value("laser", tunable, ObservedValue(value=value))
    measurer = measurer_of(setup, "meter", measurable)
    assert measurer is not None
    found = measurer.read(Table(setup, Path(), world), "meter", measurable)
    assert found.value is None and found.reason == "cut-trace"
    assert found.unknown == "the beam of laser was followed for 256 stretches, and the rest of it may come to meter"

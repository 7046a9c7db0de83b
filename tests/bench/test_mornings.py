"""A fiber coupling bench with cameras over it: several things happen in one night, and each is named."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

import pico
from pico.bench.bench import Bench
from pico.bench.mornings import Morning

FIBER = Path(__file__).parents[1] / "labs" / "fiber"


@pytest.fixture(scope="module")
def evening(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The bench in the evening, with its reference."""
    root = tmp_path_factory.mktemp("evening") / "fiber"
    shutil.copytree(FIBER, root)
    for words in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "The bench"]):
        subprocess.run(["git", "-c", "user.name=A", "-c", "user.email=a@example.org", *words], cwd=root, check=True)
    with pico.open(root, fidelity="kinematic") as bench:
        bench.apply()
        assert bench.morning(accept=True).accepted
    return root


@pytest.fixture
def bench(evening: Path, tmp_path: Path) -> Iterator[Bench]:
    root = tmp_path / "fiber"
    shutil.copytree(evening, root)
    with pico.open(root, fidelity="kinematic") as opened:
        opened.sim.wait(9 * 3600)
        yield opened


def named(found: Morning) -> list[set[str]]:
    """Return of each cause the parts that may be it."""
    return [{part for one in group for part in (one.part, *one.like)} for group in found.causes]


def test_a_quiet_night_is_quiet_and_is_no_reference(bench: Bench) -> None:
    before = (bench.place.folder / "mornings.json").read_text()
    found = bench.morning()
    assert not found.unusual and not found.causes and not found.moved and not found.accepted
    assert (bench.place.folder / "mornings.json").read_text() == before


@pytest.mark.slow
def test_a_laser_a_plate_and_two_parts_that_were_bumped_are_named_in_one_morning(bench: Bench) -> None:
    before = (bench.place.folder / "mornings.json").read_text()
    bench.sim.nudge("pm", dx=1.5, dy=2.0)
    bench.sim.nudge("qwp", dy=4.0)
    bench.sim.upset("laser", power=0.7)
    bench.sim.slip("hwp", "angle", 12.0)
    found = bench.morning()
    assert [(m.address, m.by_hand) for m in found.moved] == [("pm", True), ("qwp", True)]
    assert "moved 2.5 mm" in found.moved[0].change.text
    first = {group[0].part: group[0] for group in found.causes}
    assert first.keys() == {"laser", "hwp"}
    assert (first["laser"].kind, first["hwp"].kind) == ("power", "zero of angle")
    assert abs(first["hwp"].size["zero:angle"]) == pytest.approx(12.0, abs=1.0)
    changed = {r.name: r for r in found.readings if r.change is not None and abs(r.change) > 3}
    assert {"laser.monitor", "pm.power", "fc.power"} <= changed.keys()
    assert changed["pm.power"].unit == "mW" and changed["pm.power"].expected is not None
    assert not found.accepted and (bench.place.folder / "mornings.json").read_text() == before


def test_a_part_that_is_gone_takes_only_what_depends_on_it(bench: Bench) -> None:
    bench.sim.remove("m2")
    bench.sim.upset("laser", power=0.7)
    found = bench.morning()
    assert [m.address for m in found.moved] == ["m2"] and "is not seen" in found.moved[0].change.text
    assert [group[0].part for group in found.causes] == ["laser"]
    why = {r.name: r.unknown for r in found.readings}
    assert "no light is expected there since m2 changed" in why["fc.power"] and not why["laser.monitor"]
    assert {"qwp", "fc"} <= set(found.blind), "what no light comes to is not judged, and that is said"


@pytest.mark.slow
def test_another_lens_in_a_mount_is_named(bench: Bench) -> None:
    bench.sim.upset("l2", optic="plano_convex_150")
    (parts,) = named(bench.morning())
    assert "l2" in parts
    assert bench.sim.clear() == ("l2",)
    assert not bench.morning().unusual


@pytest.mark.slow
def test_a_closed_iris_and_a_detector_of_another_gain_are_named(bench: Bench) -> None:
    bench.sim.slip("iris", "opening", -4.2)
    bench.sim.upset("pm", gain=1.3)
    found = bench.morning()
    assert len(found.causes) == 2
    assert any("iris" in parts for parts in named(found)) and any("pm" in parts for parts in named(found))


def test_what_was_set_by_a_run_is_told_and_is_no_accident(bench: Bench) -> None:
    bench["qwp"].angle = 30.0  # type: ignore[index]
    found = bench.morning()
    assert [(m.address, m.by_hand) for m in found.moved] == [("qwp.angle", False)]
    assert not found.unusual

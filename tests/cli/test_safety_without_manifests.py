"""Light is switched off, a hand is emptied and a run is stopped by the Lab that the bench keeps, whatever its manifests
say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from commanding import Brought, Pico, apply_manifest

from pico.backends.sim.store import load_world, save_world
from pico.bench.bench import Bench
from pico.places.bench import BenchPlace


def unreadable(lab: Path) -> None:
    (lab / "lab.yaml").write_text("apiVersion: pico/v1\nkind: Lab\n  table: [\n")


def of_a_newer_pico(lab: Path) -> None:
    text = (lab / "lab.yaml").read_text()
    (lab / "lab.yaml").write_text(text.replace("kind: Lab\n", 'kind: Lab\nrequires_pico: ">=99"\n', 1))


def no_text(lab: Path) -> None:
    (lab / "lab.yaml").write_bytes(bytes(range(256)))


def a_folder(lab: Path) -> None:
    (lab / "lab.yaml").unlink()
    (lab / "lab.yaml").mkdir()


def gone(lab: Path) -> None:
    for path in lab.glob("*.yaml"):
        path.unlink()


def emits(lab: Path) -> bool:
    with Bench.open(lab, safety="light") as bench:
        return any(row.emits for row in bench.lasers.rows())


@pytest.fixture
def lit(brought: Brought, shel: Path) -> Path:
    """A lab whose laser emits."""
    brought(apply_manifest)
    assert emits(shel)
    return shel


@pytest.mark.parametrize("spoil", [unreadable, of_a_newer_pico, no_text, a_folder, gone])
def test_a_laser_is_shut_by_the_lab_of_the_bench(lit: Path, pico: Pico, spoil: Callable[[Path], None]) -> None:
    spoil(lit)
    told = pico("status")
    assert told.code != 0 and "laser (class 3R) emits" in told.err and "`pico laser disarm laser`" in told.err
    assert "emits" in pico("laser").out
    done = pico("laser", "disarm", "laser")
    assert done.code == 0 and not emits(lit), done
    assert "the Lab that the bench keeps as its own" in done.err
    assert "emits" not in pico("status").err


@pytest.mark.parametrize("damage", ["{", '{"sha256": "0"}', None])
def test_a_laser_is_shut_by_the_manifests_if_the_lab_of_the_bench_is_damaged(
    lit: Path, pico: Pico, damage: str | None
) -> None:
    path = lit / ".pico/benches/sim/lab.json"
    path.unlink() if damage is None else path.write_text(damage)
    assert pico("apply", "--yes").code != 0
    done = pico("laser", "disarm", "laser")
    assert done.code == 0 and str(path) in done.err and not emits(lit), done


def test_a_laser_is_shut_by_head_if_both_are_damaged(lit: Path, pico: Pico) -> None:
    (lit / ".pico/benches/sim/lab.json").write_text("{")
    unreadable(lit)
    assert pico("recover", "--yes").code != 0, "no arm moves by a Lab that the bench did not adopt"
    assert pico("laser", "disarm", "laser").code == 0 and not emits(lit)


def held(lab: Path) -> str:
    """Let the arm hold p1 above its place, and return which part it holds."""
    with Bench.open(lab) as bench:
        world, _ = load_world(bench.setup, BenchPlace(lab, "sim"))
    robot = replace(world.robots["arm1"], holding="p1")
    save_world(BenchPlace(lab, "sim"), replace(world.with_body("p1", presence="held"), robots={"arm1": robot}))
    return "p1"


@pytest.mark.parametrize("spoil", [unreadable, of_a_newer_pico, gone])
def test_a_bench_is_stopped_and_a_hand_emptied_by_the_lab_of_the_bench(
    lit: Path, pico: Pico, spoil: Callable[[Path], None]
) -> None:
    part = held(lit)
    spoil(lit)
    assert pico("stop", "--now").code == 0
    cleared: Any = pico("recover", "--yes")
    assert cleared.code == 0 and "internal" not in cleared.err, cleared
    with Bench.open(lit, safety="light") as bench:
        seen = bench.observe()
    assert seen.robots["arm1"].holding is None and seen.components[part].presence == "seen"

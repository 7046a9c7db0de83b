"""Light is a request: a state asks for it, and equals the bench without it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from commanding import Pico, edit

from pico.manifest.catalog import load_catalog
from pico.model.catalog import ComponentType, Restore, as_first_written, lifted
from pico.model.record import digest
from pico.resources import catalog_dir


@pytest.fixture
def dark(shel: Path, pico: Pico) -> Path:
    """The bench of the case study as its manifest says, but for its laser, which somebody has shut."""
    assert pico("apply", "--auto-approve").code == 0
    assert pico("set", "laser.shutter", "closed", "-y").code == 0
    return shel


def test_what_lets_light_out_is_a_request_in_all_of_the_catalog() -> None:
    for kind in load_catalog().values():
        for name, tunable in kind.tunables.items():
            lets = (kind.optics.element == "source" and name in ("emission", "shutter", "power")) or (
                kind.optics.element == "shutter" and name == "shutter"
            )
            assert (tunable.restore.kind == "request") == lets, f"{kind.name}.{name}"


def written_before(kind: ComponentType) -> ComponentType:
    """A type as files had it when light was a set-point."""
    old = {n: replace(t, restore=Restore()) if t.restore.kind == "request" else t for n, t in kind.tunables.items()}
    return replace(kind, tunables=old)


@pytest.mark.parametrize("name", ["hene_laser", "fiber_laser", "shutter", "white_light_source", "beam_camera"])
def test_types_of_before_are_lifted_and_keep_their_digest(name: str) -> None:
    kind = load_catalog([name])[name]
    old = written_before(kind)
    assert lifted(old) == kind
    assert digest(as_first_written(kind)) == digest(as_first_written(old))


def test_a_type_of_a_lab_s_own_that_says_setpoint_is_lifted_too(shel: Path, pico: Pico) -> None:
    text = (catalog_dir() / "hene_laser_expanded.yaml").read_text().replace("{kind: request}", "{kind: setpoint}")
    (shel / "laser_of_ours.yaml").write_text(text.replace("name: hene_laser_expanded", "name: laser_of_ours"))
    edit(shel / "lab.yaml", "type: hene_laser_expanded", "type: laser_of_ours")
    told = pico("get", "laser", "--json")
    assert told.code == 0, told
    from pico.bench.bench import Bench

    with Bench.open(shel) as bench:
        assert bench.setup.requests("laser", "shutter") and bench.setup.requests("laser", "emission")


def test_a_request_on_what_lets_no_light_out_is_refused(shel: Path, pico: Pico) -> None:
    text = (catalog_dir() / "linear_polarizer.yaml").read_text().replace("{kind: setpoint}", "{kind: request}")
    (shel / "own.yaml").write_text(text.replace("name: linear_polarizer", "name: own_polarizer"))
    told = pico("validate")
    assert told.code == 1 and "can't be a request" in told.err and "own.yaml:" in told.err


def test_it_counts_neither_as_pending_nor_as_drift_nor_against_the_state(dark: Path, pico: Pico) -> None:
    assert pico("plan", "--detailed-exitcode").code == 0
    assert pico("drift").code == 0 and "laser" not in pico("drift").out
    assert pico("verify").code == 0 and "equals" in pico("verify").out
    assert pico("set", "p1.angle", "5", "-y").code == 0
    assert pico("plan", "--detailed-exitcode").code == 2


def test_it_is_shown_in_plan_status_and_diff(dark: Path, pico: Pico) -> None:
    change = next(c for c in pico("plan", "--json").data["changes"] if c["tunable"] == "shutter")
    assert change["requested"] and (change["before"], change["after"]) == ("closed", "open")
    row = next(r for r in pico("status", "--json").data["rows"] if r["tunable"] == "shutter")
    assert row["requested"] and not row["off"] and not row["drifted"]
    assert (
        "closed (requested: open)" in pico("status").out
        and "equal, but for light that is asked for" in pico("status").out
    )
    assert pico("set", "laser", "emission=false", "-y").code == 0
    assert "off (requested: on)" in pico("status").out
    edit(dark / "state" / "table.yaml", "shutter: open", "shutter: closed")
    told = pico("diff")
    assert "laser.shutter" in told.out and "a request" in told.out


def test_a_capture_leaves_what_is_asked_for_unless_it_is_named(dark: Path, pico: Pico) -> None:
    assert "laser" not in json.dumps(pico("capture", "--json").data["changes"])
    assert "shutter: open" in (dark / "state" / "table.yaml").read_text()
    assert pico("capture", "laser.shutter").code == 0
    assert "shutter: closed" in (dark / "state" / "table.yaml").read_text()


def test_a_commit_of_a_dark_bench_is_realized(dark: Path, pico: Pico) -> None:
    assert pico("set", "p1.angle", "5", "-y").code == 0
    made = pico("commit", "-m", "five degrees", "--json").data
    assert made["realized"] and [c["tunable"] for c in made["changes"]] == ["angle"]

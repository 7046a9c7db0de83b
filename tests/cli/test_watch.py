"""Drift is told with who did it; watching moves nothing; healing only where, and while, it is allowed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from bench_at import bench_at
from commanding import Brought, Pico, a_run_goes_on, apply_manifest, edit

from pico.bench.drifting.drift import Drift, calibration_drift, news, require_heal
from pico.diagnostics import PicoError
from pico.edge.lease import BenchLock
from pico.manifest.load import load_folder
from pico.model.diff import Change
from pico.model.setup import Setup
from pico.resources import labs_dir

HEAL = "policy:\n  heal: true\n"
IGNORE = "policy:\n  ignore: [p2]\n"


@pytest.fixture
def applied(shel: Path, brought: Brought) -> Path:
    brought(apply_manifest)
    return shel


def heal_allowed(folder: Path, pico: Pico) -> None:
    edit(folder / "lab.yaml", "policy:\n", HEAL)
    assert pico("bench", "update", "--auto-approve").code == 0


def test_drift_says_who_did_it(applied: Path, pico: Pico) -> None:
    pico("sim", "nudge", "p2", "--dx", "4")
    pico("set", "p1", "angle=60", "-y")
    found = {f"{c['component']}.{c['tunable']}": c for c in pico("drift", "--json").data["changes"]}
    assert found["p2.pose"]["by"] == "person"
    assert "last placed by run" in found["p2.pose"]["how"]
    assert found["p2.pose"]["tolerance"] == "0.5 mm, 0.5°"
    assert found["p1.angle"]["by"] == "operation"
    assert found["p1.angle"]["how"].startswith("run 2")
    said = pico("drift", "--detailed-exitcode")
    assert said.code == 2
    assert "moved by hand; last placed by run" in said.out


def test_drift_says_what_only_a_person_can_bring_back(applied: Path, pico: Pico) -> None:
    pico("sim", "nudge", "p1", "--dx", "4")
    assert "`pico apply C3` brings it back" in pico("drift").out
    pico("sim", "nudge", "p2", "--dx", "560", "--dy", "-330")
    pico("sim", "nudge", "cam", "--dx", "3")
    said = pico("drift").out
    assert "Only a person can bring back cam (no arm may move it), p2 (where it stands no arm reaches it)" in said
    assert "`pico apply C3` brings back the rest after that." in said
    reasons = {c["component"]: c["by_hand"] for c in pico("drift", "--json").data["changes"]}
    assert reasons["p1"] == "" and reasons["cam"]
    refused = pico("apply", "--auto-approve")
    assert refused.code == 3 and "can't be picked up at (1080, 90" in refused.err
    assert "table.yaml" not in refused.err  # the file is right: the place where it stands is the trouble


def test_drift_without_a_journal_is_told_too(shel: Path, pico: Pico) -> None:
    found = pico("drift", "--json").data["changes"]
    assert {c["by"] for c in found if not c["tolerated"]} == {"unknown"}  # a new bench starts so
    assert not (shel / ".pico/benches/sim" / "journal.sqlite").exists()
    assert pico("sim", "nudge", "p1", "--dx", "180", "--dy", "220").code == 0
    assert "by hand" in pico("drift").out


def test_what_the_policy_ignores_is_no_drift(applied: Path, pico: Pico) -> None:
    edit(applied / "lab.yaml", "policy:\n", IGNORE)
    assert pico("bench", "update", "--auto-approve").code == 0
    pico("sim", "nudge", "p2", "--dx", "4")
    found = pico("drift")
    assert "No drift" in found.out
    assert "Ignored by the policy of the lab: p2.pose." in found.out
    assert pico("drift", "--watch", "--looks", "1").out.startswith("No drift")


def test_watching_tells_each_change_once_while_somebody_else_has_the_bench(applied: Path, pico: Pico) -> None:
    pico("sim", "nudge", "p2", "--dx", "4")
    with BenchLock(bench_at(applied)).held("pico apply e2"):
        found = pico("drift", "--watch", "--looks", "3", "--interval", "0", "--json")
    assert found.code == 0
    (line,) = found.out.splitlines()
    assert [c["component"] for c in json.loads(line)["drifted"]] == ["p2"]


def test_news_are_what_drifted_drifted_on_or_came_back() -> None:
    def one(name: str, text: str) -> Drift:
        return Drift(change=Change(component=name, tunable="pose", text=text))

    before, now = [one("a", "1 mm"), one("b", "1 mm"), one("c", "1 mm")], [one("a", "1 mm"), one("b", "2 mm")]
    fresh, right = news(before, [*now, one("d", "1 mm")])
    assert [d.address for d in fresh] == ["b", "d"]
    assert right == ["c"]


def test_healing_needs_the_policy(applied: Path, pico: Pico) -> None:
    refused = pico("drift", "--watch", "--heal", "-y", "--looks", "1")
    assert refused.code == 7
    assert "does not allow to heal" in refused.err


def test_healing_brings_back_what_a_hand_moved_and_leaves_what_an_operation_did(applied: Path, pico: Pico) -> None:
    heal_allowed(applied, pico)
    pico("set", "p1", "angle=60", "-y")
    pico("sim", "nudge", "p2", "--dx", "4")
    healed = pico("drift", "--watch", "--heal", "-y", "--looks", "2", "--interval", "0")
    assert "healed: " in healed.out
    left = {c["component"] for c in pico("drift", "--json").data["changes"] if not c["tolerated"]}
    assert left == {"p1"}


def test_nothing_is_healed_while_somebody_is_at_the_table_or_a_run_goes_on(applied: Path, pico: Pico) -> None:
    heal_allowed(applied, pico)
    pico("sim", "nudge", "p2", "--dx", "4")
    pico("sim", "person", "here")
    found = pico("drift", "--watch", "--heal", "-y", "--looks", "2", "--interval", "0")
    assert found.out.count("not healed: somebody is at the table") == 1
    pico("sim", "person", "away")
    with a_run_goes_on(applied, "pico apply e2"):
        assert "not healed: a run goes on" in pico("drift", "--watch", "--heal", "-y", "--looks", "1").out
    assert pico("drift", "--detailed-exitcode").code == 2


@pytest.fixture(scope="module")
def bench() -> Setup:
    return load_folder(labs_dir() / "shel").require()[0]


def moved(name: str, dx: float, dy: float = 0.0) -> Drift:
    before, after = {"x": 100, "y": 100, "yaw": 0}, {"x": 100 + dx, "y": 100 + dy, "yaw": 0}
    return Drift(change=Change(component=name, tunable="pose", before=before, after=after))


def test_what_moves_alike_or_can_not_move_is_drift_of_the_calibration(bench: Setup) -> None:
    alike = [moved("p1", 1.0, 2.0), moved("p2", 1.1, 2.0), moved("lx_100", 0.9, 2.1)]
    assert "3 parts seem moved alike, by (1, 2) mm" in calibration_drift(bench, alike)
    assert calibration_drift(bench, alike[:2]) == ""
    assert calibration_drift(bench, [moved("p1", 5), moved("p2", -4), moved("lx_100", 0, 9)]) == ""
    assert "cam is fixed and seems moved" in calibration_drift(bench, [moved("cam", 1)])


def test_the_shipped_labs_do_not_heal(bench: Setup) -> None:
    with pytest.raises(PicoError):
        require_heal(bench)

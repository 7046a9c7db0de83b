"""What earlier versions left behind is read, told, planned and applied by this one.

The laboratories in the folders beside this file are as those versions made them: nothing in there is written again.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import keeping
import pytest
from bench_at import bench_at
from commanding import Pico

from pico.bench.bench import Bench
from pico.runs.journal import Journal
from pico.runs.storage.journal_tables import VERSION


def enclose(lab: Path) -> None:
    """Say of a laboratory that no beam leaves its enclosure. That of `crowded` comes back into its laser, and since
    beams are audited no plan opens it else: that rule is newer than what is kept here, but it is about light."""
    table = lab / "lab.yaml"
    table.write_text(table.read_text().replace("inventory:\n", "policy: {enclosed: true}\ninventory:\n"))


EACH = pytest.mark.parametrize("kept", keeping.LABS, ids=lambda path: f"{path.parent.name}-{path.name}")
SMALL = pytest.mark.parametrize(
    "kept",
    [path if path.name == "shel" else pytest.param(path, marks=pytest.mark.slow) for path in keeping.LABS],
    ids=lambda path: f"{path.parent.name}-{path.name}",
)
"""Each, the large ones where there is time."""


@pytest.fixture
def lab(kept: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "lab"
    keeping.restore(kept, folder)
    monkeypatch.chdir(folder)
    return folder


def known(kept: Path) -> Any:
    return json.loads((kept / "facts.json").read_text())


def test_there_is_something_to_find() -> None:
    assert {path.name for path in keeping.LABS} >= {"shel", "crowded"}


def requested(facts: dict[str, Any]) -> dict[str, Any]:
    """Return what was told of a status, with light that is asked for as the request that it is since: it never counts
    as off or drifted."""
    light = {address for address in facts if address.endswith((".shutter", ".emission"))}
    return {address: [*row[:-2], False, False] if address in light else row for address, row in facts.items()}


@EACH
def test_its_digest_is_the_same(lab: Path, kept: Path) -> None:
    with Bench.open(lab) as bench:
        digest = bench.setup.digest()
    assert {plan["lab"]["digest"] for plan in known(kept)["plans"].values()} == {digest}


@SMALL
def test_it_is_told_as_the_version_that_made_it_told_it(kept: Path, lab: Path, pico: Pico) -> None:
    now, then = json.loads(keeping.written(keeping.facts(pico, lab))), known(kept)
    then["status"] = requested(then["status"])
    for section, facts in then.items():
        assert now[section] == facts, section


@SMALL
def test_its_goals_are_reached(kept: Path, lab: Path, pico: Pico) -> None:
    if kept.name == "crowded":
        enclose(lab)
    told = pico("recover", "--auto-approve")
    assert told.code == 0 or "nothing to recover" in told.err, told
    for goal in ("main", *sorted(known(kept)["plans"])[-2:]):
        assert pico("apply", goal, "--auto-approve").code == 0
        assert pico("plan", goal, "--detailed-exitcode").code == 0


@EACH
def test_its_saved_plans_are_applied(kept: Path, lab: Path, pico: Pico) -> None:
    for name in known(kept)["saved"]:
        keeping.restore(kept, lab.parent / name)
        assert pico("-C", str(lab.parent / name), "apply", str(lab.parent / name / name), "--auto-approve").code == 0
        with Bench.open(lab.parent / name) as bench:
            assert bench.plan(name.removesuffix(".plan")).reached


def test_a_killed_run_is_taken_up_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico) -> None:
    killed = next(path for path in keeping.LABS if path.name == "crowded")
    keeping.restore(killed, tmp_path / "lab")
    monkeypatch.chdir(tmp_path / "lab")
    resumed = pico("resume", "--auto-approve")
    assert resumed.code == 0 and "laser (class 3R) stays dark: nobody has armed it" in resumed.err
    assert pico("plan", "exchange", "--detailed-exitcode").code == 0


@EACH
def test_its_journal_is_lifted_to_this_version(kept: Path, lab: Path) -> None:
    runs = Journal(bench_at(lab).folder / "journal.sqlite").runs()
    assert VERSION >= 3 and runs and all(run.plan.startswith("sha256:") for run in runs)

"""`pico undo` takes back the last run that left the bench otherwise, or a run that is named; `pico redo` takes that
back. A command that was killed before it moved anything is named."""

from __future__ import annotations

import json
import os
import signal
import subprocess
from pathlib import Path

import pytest
from commanding import Brought, Pico, apply_manifest

from pico.bench.plans import Plans


def angle(pico: Pico, address: str = "p1.angle") -> float:
    _, _, tunable = address.partition(".")
    value: float = pico("get", address, "--json").data["values"][tunable]["value"]
    return value


def last(pico: Pico) -> str:
    run: str = pico("runs", "list", "--json").data["runs"][0]["document"]["id"]
    return run


@pytest.fixture
def applied(shel: Path, brought: Brought) -> Path:
    brought(apply_manifest)
    return shel


def test_measurements_are_skipped_and_the_run_is_named(applied: Path, pico: Pico) -> None:
    before = angle(pico)
    assert pico("set", "p1", "angle=40", "--yes").code == 0
    run = last(pico)
    assert pico("measure", "cam.centroid").code in (0, 1)
    assert pico("set", "p1", "angle=40", "--yes").code == 0, "it is so already"
    answer = pico("undo", "--yes")
    assert answer.code == 0 and angle(pico) == pytest.approx(before)
    assert f"this takes back run {run} (set p1.angle; 20" in " ".join(answer.err.split())


def test_a_run_that_is_named_is_taken_back_while_its_changes_are_in_place(applied: Path, pico: Pico) -> None:
    p1, p2 = angle(pico), angle(pico, "p2.angle")
    assert pico("set", "p1", "angle=40", "--yes").code == 0
    first = last(pico)
    assert pico("set", "p2", "angle=50", "--yes").code == 0
    assert pico("undo", first[-6:], "--yes").code == 0
    assert angle(pico) == pytest.approx(p1) and angle(pico, "p2.angle") == pytest.approx(50)
    assert pico("set", "p1", "angle=41", "--yes").code == 0
    since = last(pico)
    refused = pico("undo", first, "--yes")
    said = " ".join(refused.err.split())
    assert refused.code == 1 and f"it left p1.angle at 40, and that is at 41 now, by run {since}" in said
    assert f"`pico undo {since}` first" in said and angle(pico) == pytest.approx(41)
    assert p2 != 50 and "no run `zzz`" in pico("undo", "zzz", "--yes").err


def test_redo_takes_an_undo_back_and_nothing_else(applied: Path, pico: Pico) -> None:
    before = angle(pico)
    assert pico("set", "p1", "angle=40", "--yes").code == 0
    run = last(pico)
    wrong = pico("redo", "--yes")
    assert wrong.code == 1 and f"no undo, but run {run} (set p1.angle" in " ".join(wrong.err.split())
    assert pico("undo", "--yes").code == 0 and angle(pico) == pytest.approx(before)
    assert pico("redo", "--yes").code == 0 and angle(pico) == pytest.approx(40)
    assert pico("undo", "--yes").code == 0, "a redo is a run like any other"
    assert pico("set", "p2", "angle=50", "--yes").code == 0
    assert pico("redo", run, "--yes").code == 0, "its undo, named by what it took back"
    assert angle(pico) == pytest.approx(40)


def test_what_an_undo_takes_back_is_told_in_words(applied: Path, pico: Pico) -> None:
    assert pico("set", "p1", "angle=40", "--yes").code == 0
    run = last(pico)
    undone = pico("undo", "--yes")
    assert f"→ the state before run {run} ·" in undone.out and f"equals the state before run {run}" in undone.out
    again = pico("redo", "--yes")
    assert f"takes back run {last(pico)[:4]}" in again.err and f"(undo of {run}; 20" in " ".join(again.err.split())


def test_a_run_of_somebody_else_is_taken_back_only_with_their_name(
    applied: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = angle(pico)
    monkeypatch.setenv("LOGNAME", "ada")
    assert pico("set", "p1", "angle=40", "--yes").code == 0
    run = last(pico)
    monkeypatch.setenv("LOGNAME", "grace")
    refused = pico("undo", "--yes")
    assert refused.code == 1 and "ada) is another person's" in " ".join(refused.err.split())
    assert f"`pico undo {run} --of ada`" in refused.err and angle(pico) == 40
    assert pico("set", "p2", "angle=50", "--yes").code == 0
    assert pico("undo", "--of", "ada", "--yes").code == 0 and angle(pico) == pytest.approx(before)


def test_parts_go_back_to_slots_by_name_and_light_that_stays_off_is_said(applied: Path, pico: Pico) -> None:
    assert pico("set", "laser", "emission=true", "--yes").code in (0, 1)
    pico("set", "laser", "shutter=open", "--yes")
    assert pico("apply", "e1", "--yes").code == 0
    parts = {op["component"] for op in json.loads(pico("plan", "--json").out)["operations"] if "slot" in str(op)}
    assert parts, "e1 has brought parts from storage"
    answer = pico("undo", "--yes")
    assert answer.code == 0 and "→ storage/" in answer.out and "→ (290" not in answer.out


def test_undo_says_that_the_shutter_stays_closed(applied: Path, pico: Pico) -> None:
    assert pico("apply", "e1", "--yes").code == 0
    assert pico("set", "laser", "shutter=closed", "--yes").code == 0
    answer = pico("undo", "--yes")
    assert answer.code == 0
    assert "except light: laser.shutter stays closed" in " ".join(answer.out.split())


def killed_in_planning(*words: str) -> None:
    """Call a command in a process of its own that is killed while it plans."""
    child = os.fork()
    if child == 0:
        from pico_cli.main import main

        Plans.plan = lambda *_, **__: os.kill(os.getpid(), signal.SIGKILL)  # type: ignore[method-assign,assignment]
        main(list(words))
        os._exit(0)
    _, status = os.waitpid(child, 0)
    assert os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGKILL


def test_a_command_that_was_killed_before_it_moved_anything_is_named(applied: Path, pico: Pico) -> None:
    before = angle(pico)
    assert pico("set", "p1", "angle=40", "--yes").code == 0
    run = last(pico)
    killed_in_planning("apply", "e1", "--yes")
    said = "what was called last (`pico apply e1`,"
    assert said in " ".join(pico("status").err.split())
    for command in ("undo", "resume"):
        refused = pico(command, "--yes")
        told = " ".join(refused.err.split())
        assert refused.code == 1 and said in told and f"`pico {command} {run}` says that this is meant" in told
    assert angle(pico) == 40
    assert pico("undo", run, "--yes").code == 0 and angle(pico) == pytest.approx(before)
    assert "killed before it moved" not in pico("status").err
    killed_in_planning("apply", "e1", "--yes")
    assert pico("apply", "e1", "--yes").code == 0
    assert pico("undo", "--yes").code == 0, "what was killed was called again"
    assert subprocess.run(["git", "status", "--short"], capture_output=True, check=True).stdout == b""

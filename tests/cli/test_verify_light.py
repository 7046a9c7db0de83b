"""`pico verify --measure`: goals measured where they stand, and the light that a commit recorded."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from attended import ended_when
from commanding import Brought, Pico, edit, succeed

import pico as library


@pytest.fixture
def built(shel: Path, brought: Brought) -> Path:
    brought(align_and_commit)
    return shel


def align_and_commit(folder: Path) -> None:
    """E2-2 of the case study in a world that stands still, aligned and measured, and committed."""
    edit(folder / "lab.yaml", "  seed: 1\n", "  seed: 1\n  environment: none\n  errors: {seat: 1}\n")
    state = subprocess.run(["git", "show", "E2-2:state/table.yaml"], check=True, capture_output=True).stdout
    subprocess.run(["git", "checkout", "-q", "-b", "one"], check=True)
    (folder / "state" / "table.yaml").write_bytes(state)
    succeed("apply", "--align", "--yes")
    succeed("set", "hwp.angle", "2", "-y")
    succeed("set", "cam.exposure", "0.02", "-y")
    for address in ("laser.monitor", "cam.centroid", "cam.light"):
        succeed("measure", address)
    succeed("commit", "-m", "E2-2, measured")


def verified(pico: Pico, *words: str) -> tuple[int, dict[str, object]]:
    import json

    answer = pico("verify", *words, "--measure", "--yes", "--json")
    return answer.code, json.loads(answer.out.splitlines()[-1])


def operations(pico: Pico) -> list[str]:
    document = pico("runs", "show", "--json").data
    return [f"{op['primitive']} {op['component']}.{op['arguments'].get('tunable')}" for op in document["operations"]]


def test_what_is_as_it_was_is_told_and_nothing_is_sought_or_left_changed(built: Path, pico: Pico) -> None:
    before = pico("get", "cam", "--json").data, pico("get", "ly_150", "--json").data
    code, found = verified(pico)
    assert code == 0
    (goal,) = found["goals"]
    assert goal["goal"] == "ly_150_centred" and goal["met"] is True, "the other lens is in storage"
    assert {n["address"] for n in goal["numbers"]} == {"cam.centroid.x", "cam.centroid.y"}
    assert all(abs(n["value"] - n["was"]) < 1 and n["target"] == 0 and n["tolerance"] == 5 for n in goal["numbers"])
    light = {n["address"]: n for n in found["light"]}
    assert {"cam.centroid.x", "cam.centroid.y", "cam.light", "laser.monitor"} == light.keys()
    assert light["cam.centroid.x"]["sigma"] < 6, "no part was put down since: none may stand otherwise of itself"
    assert (pico("get", "cam", "--json").data, pico("get", "ly_150", "--json").data) == before
    assert not [one for one in operations(pico) if "stage" in one or "optimize" in one]
    told = pico("verify", "--measure", "--yes").out
    assert "1 of 1 goal aligned." in told and "of the light compared: as" in told
    assert "`pico runs show" in told and "pico capture" not in told
    assert pico("commit", "-m", "and verified").code == 0
    code, found = verified(pico)
    assert code == 0 and found["light"], "what was measured of the same bench goes with it"


def test_a_goal_that_is_lost_is_told_with_what_it_was_and_counts_as_lost_from_then_on(built: Path, pico: Pico) -> None:
    pico("sim", "upset", "ly_150", "up=0.05")
    assert pico("verify").code in (0, 1) and "aligned" in pico("optimize").out, "nobody has measured yet"
    code, found = verified(pico)
    (goal,) = found["goals"]
    assert code == 6 and goal["met"] is False and "cam.centroid.y is +1" in goal["why"]
    light = {n["address"]: n for n in found["light"]}
    assert abs(light["cam.centroid.y"]["now"] - light["cam.centroid.y"]["before"]) > 100
    assert {s["part"] for s in found["suspects"][:3]} <= {"laser", "cam", "lx_100", "ly_150"}
    assert "ly_150" in {found["suspects"][0]["part"], *found["suspects"][0]["like"]}, "no reading tells them apart"
    told = pico("verify", "--measure", "--yes")
    assert told.code == 6 and "✗  ly_150_centred" in told.out and "✗  cam.centroid.y" in told.out
    standing = pico("optimize", "--json").data["alignments"]
    assert {one["goal"]: one["status"] for one in standing}["ly_150_centred"] == "lost"
    assert "Not met: ly_150_centred" in pico("runs", "show").out and "not met" in pico("runs", "list").out
    assert [op["arguments"]["goal"] for op in pico("plan", "--align", "--json").data["operations"]
            if op["primitive"] == "optimize"] == ["ly_150_centred"]  # fmt: skip
    assert pico("apply", "--align", "--yes").code == 0 and verified(pico)[1]["goals"][0]["met"] is True


def test_a_laser_that_lost_power_is_suspected_first(built: Path, pico: Pico) -> None:
    pico("sim", "upset", "laser", "power=-30%")
    code, found = verified(pico)
    assert code == 6 and found["goals"][0]["met"] is True
    first = found["suspects"][0]
    assert (first["part"], first["kind"]) == ("laser", "power") and first["probability"] > 0.9
    assert "%  laser: power, -3" in pico("verify", "--measure", "--yes").out


def test_drift_tells_light_lost_from_a_part_that_moved(built: Path, pico: Pico) -> None:
    assert pico("drift", "--json").data["light"] == []
    pico("sim", "nudge", "lx_100", "--dy", "3")
    (may,) = pico("drift", "--json").data["light"]
    assert may["lost"] is False and may["moved"] == ["lx_100"]
    assert "lx_100 has left it, where its light comes through" in " ".join(pico("drift").out.split())
    pico("verify", "--measure", "--yes")
    (lost,) = pico("drift", "--json").data["light"]
    assert lost["lost"] is True and lost["moved"] == ["lx_100"]
    pico("sim", "nudge", "lx_100", "--dy", "-3")
    pico("sim", "upset", "ly_150", "up=0.05")
    pico("verify", "--measure", "--yes")
    (lost,) = pico("drift", "--json").data["light"]
    assert lost["lost"] is True and lost["moved"] == [] and "cam.centroid.y is +1" in lost["why"]
    told = " ".join(pico("drift").out.split())
    assert "ly_150_centred is lost by light alone" in told and "`pico optimize ly_150_centred` seeks it" in told
    assert pico("optimize", "ly_150_centred", "-y").code == 0 and pico("drift", "--json").data["light"] == []


def of_commit(folder: Path, revision: str = "HEAD") -> dict[str, dict[str, object]]:
    """Return how goals stood as the runs of a commit have it."""
    import json

    words = ("git", "diff", "--name-only", f"{revision}~", revision, "--", "runs")
    names = subprocess.run(words, check=True, capture_output=True, text=True, cwd=folder).stdout.split()
    documents = [json.loads((folder / name).read_text()) for name in names if name.endswith("run.json")]
    return {goal: one for document in documents for goal, one in (document.get("goals") or {}).items()}


def test_a_commit_records_how_goals_stand_with_value_and_reason(built: Path, pico: Pico) -> None:
    ((goal, stood),) = of_commit(built).items()
    assert goal == "ly_150_centred" and stood["status"] == "aligned" and stood["at"]
    last = stood["last"]
    assert abs(last["cam.centroid.x"]) < 5 and 0 < last["cam.centroid.x_sigma"] < 1
    run = next(line.split()[0] for line in pico("runs", "list").out.splitlines() if "-fold" in line)
    told = pico("runs", "show", run).out
    assert "Goals when it was committed:" in told and "aligned  cam.centroid.x" in told
    assert pico("swap", "lx_100", "--serial", "B7", "-y").code == 0
    pico("measure", "laser.monitor")
    assert pico("commit", "-m", "swapped").code == 0
    stood = of_commit(built)["ly_150_centred"]
    assert stood["status"] == "stale" and "lx_100 was swapped" in stood["why"]


def test_what_was_stale_and_is_still_met_is_aligned_again(built: Path, pico: Pico) -> None:
    assert pico("swap", "lx_100", "--serial", "B7", "-y").code == 0
    status = {one["goal"]: one for one in pico("optimize", "--json").data["alignments"]}
    assert status["ly_150_centred"]["status"] == "stale"
    code, found = verified(pico)
    assert found["goals"][0]["met"] is True and code == 0
    status = {one["goal"]: one for one in pico("optimize", "--json").data["alignments"]}
    assert status["ly_150_centred"]["status"] == "aligned"


def test_a_beam_that_is_shut_is_not_assured_and_nothing_is_lost_by_it(built: Path, pico: Pico) -> None:
    pico("set", "laser.shutter", "closed", "-y")
    code, found = verified(pico)
    (goal,) = found["goals"]
    assert goal.get("met") is None
    assert goal["why"] == "laser.shutter is closed" and code == 0
    assert all(n["why"] for n in found["light"] if n["address"].startswith("cam.")), "what is dark is not compared"
    assert "? " in pico("verify", "--measure", "--yes").out
    status = {one["goal"]: one["status"] for one in pico("optimize", "--json").data["alignments"]}
    assert status["ly_150_centred"] == "aligned", "the journal knows of nothing else"


def test_light_that_does_not_come_any_more_is_a_goal_that_is_lost(built: Path, pico: Pico) -> None:
    pico("sim", "nudge", "ly_150", "--dy", "40")
    code, found = verified(pico)
    assert code == 6 and found["goals"][0]["met"] is False and "no light comes" in found["goals"][0]["why"]
    assert found["suspects"] == [], "what moved is reason enough"


@pytest.mark.parametrize("when", ["operation_started", "operation_done"])
def test_from_python_and_what_was_interrupted_is_not_taken_up(built: Path, pico: Pico, when: str) -> None:
    with library.open(built) as bench:
        found = bench.verify(measure=True)
        assert found.goals is not None and [one.word for one in found.goals] == ["aligned"] and found.light
        assert bench.verify().goals is None
        report = ended_when(bench, bench.measurements.to_verify().plan, lambda event: event.kind == when)
        assert report.outcome == "interrupted"
    told = pico("resume", "--yes")
    assert told.err.count("did not come to its end") == 1, told
    assert "`pico verify --measure` did not come to its end" in told.err
    assert pico("get", "cam.exposure", "--json").data["values"]["exposure"]["value"] == pytest.approx(0.02)

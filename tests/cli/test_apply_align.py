"""`pico apply --align`: goals sought at the end of a plan, and the light that a commit recorded measured again."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from attended import ended_when
from commanding import Pico, edit

import pico as library


@pytest.fixture
def bench(shel: Path) -> Path:
    """The case study, whose arm puts parts down as well as a real one does, in a world that stands still."""
    edit(shel / "lab.yaml", "  seed: 1\n", "  seed: 1\n  environment: none\n  errors: {seat: 1}\n")
    subprocess.run(["git", "commit", "-aqm", "seats that err"], cwd=shel, check=True)
    return shel


def optimizations(plan: dict[str, object]) -> list[str]:
    return [op["arguments"]["goal"] for op in plan["operations"] if op["primitive"] == "optimize"]  # type: ignore


def test_what_is_not_aligned_is_sought_at_the_end_and_what_that_needs_is_set_back(bench: Path, pico: Pico) -> None:
    plan = pico("plan", "E3-2", "--align", "--json").data
    assert optimizations(plan) == ["ly_200_centred"], "the other lens is not in the beam"
    by_id = {op["id"]: op for op in plan["operations"]}
    (sought,) = [op for op in plan["operations"] if op["primitive"] == "optimize"]
    before = {by_id[e]["component"] for e in sought["after"]}
    assert {"arm1", "laser", "p1", "hwp", "cam"} <= before, "arms are parked, the shutter is open, the beam is dimmed"
    ends = {op["component"]: op["start"] + op["seconds"] for op in plan["operations"] if op["id"] in sought["after"]}
    assert max(ends["hwp"], ends["cam"]) < ends["arm1"], "what the arm leaves alone is set while it works"
    assert ends["laser"] > ends["arm1"], "light comes when it is parked"
    (left, _), (_, up) = sought["arguments"]["nominal"]["slopes"]
    by_lens = pytest.approx(1000 * 340 / 200, rel=0.02)  # um per mm: from the lens to the camera, by its focal length
    assert abs(left) == by_lens and abs(up) == by_lens
    back = [op for op in plan["operations"] if op["start"] >= sought["start"] + sought["seconds"] - 1e-6]
    assert {op["component"]: op["arguments"]["to"] for op in back} == {"p1": 1.0, "hwp": 22.75, "cam": 10.0}
    answer = pico("apply", "E3-2", "--align", "--yes")
    assert (
        answer.code == 0
        and "1 of 1 goal met, alignment" in answer.out
        and "The bench equals E3-2, except ly_200" in answer.out
    )
    assert pico("get", "p1.angle", "--json").data["values"]["angle"]["value"] == pytest.approx(1)
    assert pico("get", "cam.exposure", "--json").data["values"]["exposure"]["value"] == pytest.approx(10)
    assert optimizations(pico("plan", "E3-2", "--align", "--json").data) == [], "it is aligned"
    assert pico("undo", "--yes").code == 0


def test_a_plan_without_it_says_what_it_spoils_where_there_still_is_light(bench: Path, pico: Pico) -> None:
    assert pico("apply", "E2-3", "--align", "--yes").code == 0
    told = " ".join(pico("plan", "E1-3").out.split())
    assert "align again: ly_150_centred (lx_100 changes; met" in told
    assert "`pico optimize ly_150_centred`; or `pico apply E1-3 --align`" in told
    (spoiled,) = pico("plan", "E1-3", "--json").data["spoils"]
    assert spoiled["goal"] == "ly_150_centred" and spoiled["seconds"] > 0
    assert "spoils" not in pico("plan", "E1-1", "--json").data, "there the lens is in storage"
    aligned = pico("plan", "E1-3", "--align", "--json").data
    assert optimizations(aligned) == ["ly_150_centred"] and "spoils" not in aligned


def test_the_policy_of_a_lab_makes_it_the_default(bench: Path, pico: Pico) -> None:
    edit(bench / "lab.yaml", "policy:\n", "policy:\n  align: always\n")
    assert optimizations(pico("plan", "E2-2", "--json").data) == ["ly_150_centred"]
    assert optimizations(pico("plan", "E2-2", "--no-align", "--json").data) == []


def test_a_goal_that_is_not_met_is_6_and_the_rest_is_done(bench: Path, pico: Pico) -> None:
    lab = (bench / "lab.yaml").read_text()
    (bench / "lab.yaml").write_text(lab.replace("measurements: 30", "measurements: 2"))
    answer = pico("apply", "E2-2", "--align", "--yes")
    assert answer.code == 6 and "✗ ly_150_centred: not met" in answer.out and "0 of 1 goal met" in answer.out
    assert pico("get", "p1.angle", "--json").data["values"]["angle"]["value"] == pytest.approx(90)


def test_what_light_found_beyond_a_trim_stays_and_is_warned_of(shel: Path, pico: Pico) -> None:
    assert pico("checkout", "e3", "--yes").code == 0
    assert pico("sim", "upset", "ly_200", "up=0.9").code == 0
    answer = pico("apply", "--align", "--yes")
    assert answer.code == 0 and "1 of 1 goal met" in answer.out
    assert "`pico capture ly_200.stage_z` writes what light found" in answer.err and "a trim of" in answer.err
    found = pico("get", "ly_200.stage_z", "--json").data["values"]["stage_z"]["value"]
    assert pico("apply", "--yes").code == 0
    assert pico("get", "ly_200.stage_z", "--json").data["values"]["stage_z"]["value"] == found
    assert pico("capture", "ly_200.stage_z").code == 0
    again = pico("apply", "--align", "--yes")
    assert again.code == 0, again.out


def test_a_saved_plan_is_applied_as_it_is_and_needs_no_word(bench: Path, pico: Pico) -> None:
    assert pico("plan", "E2-2", "--align", "--out", "my.plan").code == 0
    wrong = pico("apply", "./my.plan", "--align", "--yes")
    assert wrong.code == 1 and "is a saved plan" in wrong.err
    answer = pico("apply", "./my.plan", "--yes", "--json")
    report = json.loads(answer.out.splitlines()[-1])
    assert answer.code == 0 and [g["goal"] for g in report["goals"]] == ["ly_150_centred"]
    assert report["goals"][0]["met"] and report["aligning"] > report["goals"][0]["seconds"]


def test_a_run_that_was_stopped_before_its_goals_goes_on_to_them(bench: Path, pico: Pico) -> None:
    with library.open(bench) as opened:
        plan = opened.plan("E2-2", align=True)
        report = ended_when(opened, plan, lambda e: e.kind == "operation_done" and e.component == "lx_100")
        assert report.outcome == "interrupted" and report.goals is None
    answer = pico("resume", "--yes")
    assert answer.code == 0 and "1 of 1 goal met" in answer.out


def test_what_a_commit_recorded_of_its_light_is_measured_again_and_compared(bench: Path, pico: Pico) -> None:
    subprocess.run(["git", "checkout", "-q", "-b", "one", "main"], cwd=bench, check=True)
    (bench / "state" / "table.yaml").write_bytes(
        subprocess.run(["git", "show", "E2-2:state/table.yaml"], cwd=bench, check=True, capture_output=True).stdout
    )
    assert pico("apply", "--align", "--yes").code == 0
    pico("set", "cam.exposure", "0.02", "-y")
    pico("set", "hwp.angle", "2", "-y")
    for address in ("laser.monitor", "cam.centroid", "cam.light"):
        assert pico("measure", address).code == 0
    assert pico("commit", "-m", "E2-2, measured").code == 0
    assert pico("apply", "E3-2", "--align", "--yes").code == 0
    answer = pico("apply", "one", "--align", "--yes", "--json")
    found = json.loads(answer.out.splitlines()[-1])
    assert answer.code == 0 and found["schema"] == "pico.light-compared/v1"
    numbers = {n["address"]: n for n in found["numbers"]}
    assert set(numbers) == {"laser.monitor", "cam.centroid.x", "cam.centroid.y", "cam.light"}
    assert not any(n["differs"] for n in numbers.values())
    assert numbers["cam.light"]["reference"] == "laser.monitor"
    pico("sim", "nudge", "lx_100", "--dy", "0.4")
    again = pico("apply", "one", "--align", "--yes")
    assert "✗  cam.centroid.x" not in again.out, "the goal was sought again"
    pico("sim", "upset", "laser", "power=-30%")
    assert pico("apply", "E3-2", "--align", "--yes").code == 0
    answer = pico("apply", "one", "--align", "--yes", "--json")
    found = json.loads(answer.out.splitlines()[-1])
    assert {n["address"] for n in found["numbers"] if n["differs"]} >= {"laser.monitor"}
    assert (found["suspects"][0]["part"], found["suspects"][0]["kind"]) == ("laser", "power")
    assert "%  laser: power, -3" in pico("apply", "one", "--align", "--yes").out


def test_where_a_lens_without_a_stage_stands_tells_where_its_spot_is_to_be(bench: Path, pico: Pico) -> None:
    subprocess.run(["git", "checkout", "-q", "-b", "one", "E1-1"], cwd=bench, check=True)
    edit(bench / "lab.yaml", "  seed: 1\n", "  seed: 1\n  environment: none\n  errors: {seat: 1}\n")
    assert pico("apply", "--yes").code == 0
    for address, value in (("p1.angle", "90"), ("hwp.angle", "2"), ("cam.exposure", "0.02")):
        pico("set", address, value, "-y")
    assert pico("measure", "cam.fit").code == 0
    assert pico("commit", "-m", "bright", "--capture").code == 0
    then = pico("get", "lx_125", "--json").data["values"]["pose"]["value"]
    assert pico("apply", "E2-1", "--yes").code == 0
    answer = pico("apply", "one", "--align", "--yes", "--json")
    x = next(n for n in json.loads(answer.out.splitlines()[-1])["numbers"] if n["address"] == "cam.fit.x")
    now = pico("get", "lx_125", "--json").data["values"]["pose"]["value"]
    left = now["y"] - then["y"]
    (lens,) = [part for part in x["restood"] if part["component"] == "lx_125"]
    assert lens["left"] == pytest.approx(left, abs=1e-3) and abs(left) > 0.1
    assert x["expected"] == pytest.approx(x["before"] + 5318 * left, rel=0.02), "um per mm, by a lens of 125 mm"
    assert abs(x["expected"] - x["before"]) > 3 * x["sigma"] and not x["differs"]
    told = " ".join(pico("verify", "one", "--measure").out.split())
    side = "left" if left > 0 else "right"
    assert f"From where it stood, lx_125 stands {abs(left):.3f} mm to its {side}" in told
    assert f"that makes {lens['by']:+.4g} um of cam.fit.x" in told, told
    pico("sim", "upset", "laser", "pitch=0.2")
    told = pico("verify", "one", "--measure")
    assert told.code == 6 and "✗  cam.fit.y" in told.out and "✓  cam.fit.x" in told.out, "no part stands higher"


def test_a_null_and_the_lens_behind_it_are_both_aligned_afterwards(bench: Path, pico: Pico) -> None:
    subprocess.run(["git", "checkout", "-q", "E1-3"], cwd=bench, check=True)
    table = bench / "state" / "table.yaml"
    table.write_text(table.read_text()[::-1].replace("09 :elgna", "}]2p ,1p[ :fo_llun{ :elgna", 1)[::-1])
    told = pico("commit", "-m", "by light").err
    assert "never applied: p2.angle" in told and "`pico optimize p2.angle` first" in told
    plan = pico("plan", "--align", "--json").data
    assert optimizations(plan) == ["p2.angle", "ly_150_centred"]
    assert "this plan finds it" in pico("plan", "--align").err
    answer = pico("apply", "--align", "--yes")
    assert answer.code == 0 and "2 of 2 goals met" in answer.out
    assert "The bench equals the manifest, except ly_150.stage_y stays" in answer.out
    assert pico("verify").code == 0 and optimizations(pico("plan", "--align", "--json").data) == []
    assert pico("commit", "-m", "by light").code == 0 and pico("swap", "p2", "--serial", "B7", "-y").code == 0
    told = pico("drift").out
    assert "`pico optimize p2.angle` finds" in told
    wrong = pico("swap", "ly_150", "--serial", "L9", "--focal-length", "151.2 V", "-y")
    assert wrong.code == 1 and "151.2 V" in wrong.err and "what the bench keeps" not in wrong.err, "nothing was kept"

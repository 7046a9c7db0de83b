"""`pico morning`: recorded, quiet, what befell a part; interrupted, killed, in the dark, without a word to compare."""

from __future__ import annotations

import json
import signal
import subprocess
from pathlib import Path

import forking
import pytest
from commanding import Brought, Pico, apply_e1, edit

STANDING = {"p1.angle": 1.0, "p2.angle": 90.0, "hwp.angle": 22.75, "cam.exposure": 10.0}


@pytest.fixture
def lit(shel: Path, brought: Brought) -> Path:
    """The case study with its light on the camera."""
    brought(apply_e1)
    return shel


def stands(pico: Pico) -> dict[str, float]:
    """Return what a morning sets, as it reads now."""
    found = {}
    for address in STANDING:
        tunable = address.partition(".")[2]
        found[address] = pico("get", address, "--json").data["values"][tunable]["value"]
    assert pico("get", "laser.shutter", "--json").data["values"]["shutter"]["value"] == "open"
    return found


def last(out: str) -> dict[str, object]:
    found: dict[str, object] = json.loads(out.splitlines()[-1])
    return found


def test_nothing_is_read_and_nothing_set_by_a_dry_run(lit: Path, pico: Pico) -> None:
    dry = pico("morning", "--dry-run")
    assert dry.code == 0 and "p1 null" in dry.out and "sets p1.angle" in dry.out
    assert "No reference yet" in dry.out and "second camera" in " ".join(dry.out.split())
    found = pico("morning", "--dry-run", "--json").data
    assert found["schema"] == "pico.survey/v1" and found["seconds"] < 180 and not found.get("reference")
    assert stands(pico) == pytest.approx(STANDING)


def test_a_scan_on_whose_way_the_beam_would_damage_a_part_is_left_out_and_the_rest_is_read(
    shel: Path, pico: Pico
) -> None:
    assert pico("apply", "e3", "--yes").code == 0  # the 100 mm lens narrows the beam on p2, which p1 dims now
    answer = pico("morning", "--yes")
    assert answer.code == 0, answer.err
    assert "would be read, were the way there safe: the beam of laser (class 3R) is not safe" in " ".join(
        (answer.out + answer.err).split()
    )
    assert pico("get", "p1.angle").out.split()[1] == "1"


def test_a_bench_in_the_dark_is_no_reference(shel: Path, pico: Pico) -> None:
    answer = pico("morning", "--yes", "--accept")
    assert answer.code == 0 and "this morning can be none: no light comes to a detector" in answer.out
    assert not (shel / ".pico/benches/sim" / "mornings.json").exists()


def test_a_damaged_file_of_references_is_told_and_kept(lit: Path, pico: Pico) -> None:
    (lit / ".pico/benches/sim" / "mornings.json").write_text("{")
    answer = pico("morning", "--yes", "--accept")
    assert answer.code == 1 and "mornings.json cannot be read" in answer.err and "Traceback" not in answer.err
    assert (lit / ".pico/benches/sim" / "mornings.json").read_text() == "{"


@pytest.mark.slow
def test_what_befell_a_mount_overnight_is_told_with_the_part_and_a_repair(lit: Path, pico: Pico) -> None:
    first = pico("morning", "--yes")
    assert first.code == 0 and "`pico morning --accept`" in first.out and "p1 null" in first.out
    assert not (lit / ".pico/benches/sim" / "mornings.json").exists()
    assert "This morning is the reference from now on" in pico("morning", "--yes", "--accept").out
    assert stands(pico) == pytest.approx(STANDING)
    assert pico("sim", "wait", "9 h").code == 0
    quiet = pico("morning", "--yes", "--detailed-exitcode")
    assert quiet.code == 0 and "Nothing unusual since" in quiet.out
    pico("sim", "slip", "p1.angle", "0.6")
    found = pico("morning", "--yes", "--detailed-exitcode")
    assert found.code == 2 and "Something happened since" in found.out
    assert "p1: zero of angle, +0.6" in found.out and "`pico do p1 home angle`" in found.out
    answer = pico("morning", "--yes", "--json")
    told = last(answer.out)
    assert told["schema"] == "pico.morning/v1" and told["unusual"] and told["suspects"][0]["part"] == "p1"  # type: ignore[index]
    assert any('"operation_progress"' in line for line in answer.out.splitlines()[:-1])
    accepted = pico("morning", "--yes", "--accept")
    assert "This morning is the reference from now on" in accepted.out
    assert "Nothing unusual" in pico("morning", "--yes").out
    assert "survey" in pico("runs", "show", str(told["run"])).out
    pico("set", "p2.angle", "80", "--yes")
    other = pico("morning", "--dry-run")
    assert "p2 angle was set 90 → 80 deg" in other.out


def started(folder: Path) -> subprocess.Popen[str]:
    """Begin a morning in a process of its own, and come back in the midst of it."""
    process = forking.started(
        forking.PICO, "-C", str(folder), "morning", "--yes", "--json", cwd=Path(__file__).parents[2],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert process.stdout
    for line in process.stdout:
        if '"operation_progress"' in line and "p1.angle" in json.loads(line)["data"]["point"]:
            break
    return process


@pytest.mark.slow
def test_ctrl_c_sets_all_back_and_keeps_no_reference(lit: Path, pico: Pico) -> None:
    process = started(lit)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 130 and last(out)["cut_short"]
    assert stands(pico) == pytest.approx(STANDING)
    assert not (lit / ".pico/benches/sim" / "mornings.json").exists()


def test_an_axis_that_sticks_is_told_and_not_said_to_be_set_back(lit: Path, pico: Pico) -> None:
    pico("sim", "faults", "stick=1", "seed=1")
    answer = pico("morning", "--yes")
    assert answer.code not in (0, 130) and "does not go where it is sent" in answer.err
    assert "not all is set back" in answer.out and not (lit / ".pico/benches/sim" / "mornings.json").exists()
    pico("sim", "faults", "off")


@pytest.mark.slow
def test_a_killed_one_is_told_and_undone(lit: Path, pico: Pico) -> None:
    process = started(lit)
    process.kill()
    process.communicate(timeout=60)
    assert "was killed" in pico("status").err
    assert pico("undo", "--yes").code == 0
    assert stands(pico) == pytest.approx(STANDING)


@pytest.mark.slow
def test_a_dirty_optic_and_a_dead_laser_are_told(lit: Path, pico: Pico) -> None:
    assert pico("morning", "--yes", "--accept").code == 0
    pico("sim", "upset", "p2", "loss=0.3")
    found = " ".join(pico("morning", "--yes").out.split())
    for part in ("laser", "hwp", "p1", "lx_125", "p2", "ly_150", "cam"):
        assert part in found.partition("which nothing tells apart: dirt, -")[0].rpartition("one of")[2]
    assert "repair: clean " in found
    pico("sim", "upset", "laser", "power=1e-7")
    dead = pico("morning", "--yes", "--detailed-exitcode")
    assert dead.code == 2 and "Not read: cam.centroid.x" in dead.out and "no light above the background" in dead.out
    assert "100 %  laser: no light" in dead.out and "look at laser" in dead.out
    assert max(len(line) for line in dead.out.splitlines()) <= 120


def test_scans_that_would_take_longer_than_a_morning_are_left_out(
    lit: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = pico("morning", "--dry-run", "--json").data
    monkeypatch.setattr("pico.bench.mornings.LONGEST", whole["seconds"] - 1.0)
    less = pico("morning", "--dry-run", "--json").data
    names = [{q["name"] for q in found["quantities"]} for found in (whole, less)]
    assert less["seconds"] <= whole["seconds"] - 1.0 and names[1] < names[0]
    assert "cam.power" in names[1] and any("were a morning longer" in lack for lack in less["lacks"])


@pytest.mark.slow
def test_a_laser_that_shines_and_must_not_is_told_before_a_morning_reads_its_light(lit: Path, pico: Pico) -> None:
    edit(lit / "lab.yaml", "waived: [kinematic, physics, emulated]", "waived: []")
    assert pico("bench", "update", "--yes").code == 0
    answer = pico("morning", "--yes")
    assert answer.code == 7 and "laser shines, and must not: it is of class 3R, and nobody has armed it" in answer.err
    assert pico("laser", "disarm", "laser").code == 0
    assert pico("get", "laser.shutter", "--json").data["values"]["shutter"]["value"] == "closed"

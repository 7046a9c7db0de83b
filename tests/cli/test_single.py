"""One operation at a time."""

from __future__ import annotations

import io
import json
from pathlib import Path

import pytest
from commanding import Pico, Typed, edit


def test_a_tunable_is_set_and_read(shel: Path, pico: Pico) -> None:
    assert pico("set", "p1", "angle=3", "-y").code == 0
    assert "p1.angle  3 deg" in pico("get", "p1").out
    for words, angle in ((["p1.angle", "4", "deg"], 4), (["p1.angle=5"], 5), (["p1", "angle=6", "deg"], 6)):
        assert f"p1.angle  3 → {angle} deg" in pico("set", *words, "--dry-run").out
    assert pico("do", "p1", "set", "angle=0.5 rad", "-y").code == 0
    assert pico("get", "p1.angle", "--json").data["values"]["angle"]["value"] == pytest.approx(28.6479, abs=1e-3)


def test_steps_count_from_where_it_is_and_back_and_angles_repeat(shel: Path, pico: Pico) -> None:
    def angle(*words: str) -> float:
        assert pico("set", *words, "-y").code == 0
        return float(pico("get", "p1.angle", "--json").data["values"]["angle"]["value"])

    assert [angle("p1", "angle=3"), angle("p1", "angle+=0.1"), angle("p1.angle+=0.2"), angle("p1.angle", "-=0.3")] == [
        3, 3.1, 3.3, 3,
    ]  # fmt: skip
    assert [angle("p1.angle", "400"), angle("p1", "angle=-10"), angle("p1", "angle", "+=", "20 deg")] == [40, 350, 10]
    assert pico("move", "p1", "x+=20", "yaw-=5", "-y").code == 0
    assert "(130, 220, -5°)" in pico("get", "p1").out
    assert pico("move", "p1", "x-=20", "turn=5", "-y").code == 0
    assert "(110, 220, 0°)" in pico("get", "p1").out
    assert pico("do", "cam", "set", "exposure+=2", "-y").code == 0


def test_several_are_set_and_read_at_once(shel: Path, pico: Pico) -> None:
    ly = pico("set", "ly_150", "stage_y=0.2", "stage_z=-0.1", "-y")
    assert ly.code == 0 and "2 settings" in ly.out, ly
    read = pico("get", "ly_150.stage_y", "ly_150.stage_z", "--json").out.splitlines()
    assert [next(iter(json.loads(one)["values"].values()))["value"] for one in read] == [0.2, -0.1]
    assert "p2.angle" in pico("get", "p1", "p2.angle").out


def test_a_component_is_moved_turned_and_stowed(shel: Path, pico: Pico) -> None:
    assert pico("move", "p1", "x=350", "y=420", "-y").code == 0
    assert pico("move", "p1", "yaw=-30", "-y").code == 0
    assert "(350, 420, -30°)" in pico("get", "p1").out
    assert pico("move", "p1", "turn=-5", "-y").code == 0
    assert "(350, 420, -35°)" in pico("get", "p1").out
    assert pico("move", "p1", "home", "-y").code == 0
    assert "storage/b1" in next(line for line in pico("catalog", "parts").out.splitlines() if line.startswith("p1 "))


def test_a_lens_is_placed_after_another_component(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    assert pico("move", "ly_150", "after=p2", "distance=15 cm", "-y").code == 0
    assert "(670, 420, 0°)" in pico("get", "ly_150").out


def test_the_manifest_stays_and_capture_takes_it_over(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    answer = pico("set", "p1", "angle=3", "-y")
    assert "`pico capture` updates it" in answer.out
    assert pico("plan", "--detailed-exitcode").code == 2
    pico("capture")
    assert pico("plan", "--detailed-exitcode").code == 0


def test_what_is_wanted_is_written_into_the_manifest_as_the_least_change(shel: Path, pico: Pico) -> None:
    table = shel / "state/table.yaml"
    before = table.read_text()
    assert pico("set", "p1", "angle=5", "--manifest", "--dry-run").code == 0 and table.read_text() == before
    assert pico("set", "p1.angle", "5", "--manifest").code == 0
    assert table.read_text() == before.replace("angle: 90", "angle: 5", 1)
    said = pico("move", "p2", "x=540", "--manifest", "--json").data
    assert (said["schema"], [c["text"] for c in said["changes"]]) == ("pico.capture/v1", ["moved 20 mm (dx +20)"])
    after = table.read_text()
    assert after == before.replace("angle: 90", "angle: 5", 1).replace("x: 520", "x: 540")
    answer = pico("move", "p2", "x=2000", "--manifest")
    assert (answer.code, "stick out" in answer.err, table.read_text()) == (3, True, after)
    assert pico("set", "p1", "angle=1e9", "--manifest").code == 1 and table.read_text() == after
    assert pico("get", "p2.pose", "--json").data["values"]["pose"]["value"]["x"] != 540


def test_edits_of_a_manifest_count_from_the_manifest_wherever_the_bench_stands(shel: Path, pico: Pico) -> None:
    table = shel / "state/table.yaml"
    before = table.read_text()
    for words in (["move", "p2", "x=540"], ["move", "p2", "turn=5"], ["do", "p2", "move", "turn=5"],
                  ["set", "p1", "angle+=3"], ["do", "p1", "set", "angle-=1"]):  # fmt: skip
        assert pico(*words, "--manifest").code == 0
    said = before.replace("x: 520\n      y: 420\n      yaw: 0", "x: 540\n      y: 420\n      yaw: 10")
    assert table.read_text() == said.replace("angle: 90", "angle: 92", 1)
    for words in (["move", "p2", "x-=20", "turn=-10"], ["set", "p1", "angle-=2"]):
        assert pico(*words, "--manifest").code == 0
    assert table.read_text() == before
    assert "goes with move, stow and set" in pico("do", "p1", "home", "--manifest").err


def test_a_manifest_says_what_was_asked_for_however_near_and_in_that_form(shel: Path, pico: Pico) -> None:
    table = shel / "state/table.yaml"
    before = table.read_text()
    assert pico("move", "p2", "x=520.1", "--manifest").code == 0  # within its tolerance
    assert table.read_text() == before.replace("x: 520", "x: 520.1")
    assert "the manifest says so already" in pico("move", "p2", "x=520.1", "--manifest").out
    pico("move", "p2", "x=200", "y=220", "yaw=0", "--manifest")  # where p2 stands, in its slot
    assert "x: 200" in table.read_text() and "slot: storage/b2" not in table.read_text()
    dry = pico("move", "p2", "storage/b2", "--manifest", "--dry-run")
    assert "Nothing was written." in dry.out and "slot: storage/b2" not in table.read_text()
    assert "Wrote 1 tunable" in pico("move", "p2", "storage/b2", "--manifest").out
    assert "slot: storage/b2" in table.read_text()
    unnamed = before.replace("    angle: 22.75\n", "")
    table.write_text(unnamed)
    assert pico("set", "hwp", "angle=10", "--manifest").code == 0
    assert table.read_text() == before.replace("angle: 22.75", "angle: 10")
    table.write_text(before)
    assert pico("set", "p1", "angle=90.05", "--manifest").code == 0
    assert table.read_text() == before.replace("angle: 90", "angle: 90.05", 1)


def test_what_is_so_already_is_not_taken_for_the_manifest(shel: Path, pico: Pico) -> None:
    pico("set", "p1", "angle=5", "-y")
    answer = pico("set", "p1", "angle=5", "-y")
    assert (answer.code, "the bench is as asked already" in answer.out) == (0, True)
    assert "The manifest is not (p1.angle 90 → 5 deg)" in answer.out
    assert "equals" not in answer.out
    assert pico("plan", "--detailed-exitcode").code == 2
    pico("apply", "--auto-approve")
    assert ", too:" not in pico("set", "p1", "angle=5", "-y").out
    other = " ".join(pico("set", "p2.angle", "4", "-y").out.split())
    assert "p1 differs from the manifest, too: `pico apply -- p1` brings it there, `pico commit p2` leaves it" in other
    pico("capture")
    assert "bench and manifest are as asked already" in pico("set", "p1", "angle=5", "-y").out


def test_one_rule_says_what_is_asked_about(shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", Typed("n\nyes\n"))
    declined = pico("set", "p1", "angle=3")
    assert declined.code == 1 and "Run 1 setting on sim (kinematic)? [y/N]" in declined.out
    assert pico("set", "p1", "angle=3").code == 0
    monkeypatch.setattr("sys.stdin", io.StringIO("y\n"))
    for words in (["move", "p1", "yaw=5"], ["do", "p1", "home"], ["set", "laser", "shutter=open"], ["undo"]):
        refused = pico(*words)
        assert refused.code == 1 and "nobody can be asked here" in refused.err and "--auto-approve" in refused.err
    assert pico("get", "p1", "--json").data["values"]["angle"]["value"] == 3
    assert pico("set", "cam", "exposure=12").code == pico("set", "laser", "shutter=closed", "--json").code == 0
    assert pico("undo", "-y").code == 0  # of the exposure
    assert pico("move", "p1", "x=350", "y=420", "--yes").code == 0


def test_what_was_done_slowly_is_undone_as_slowly_where_that_is_said(shel: Path, pico: Pico) -> None:
    assert pico("move", "p1", "x=350", "y=420", "-y").code == 0
    said = (pico("undo", "-y", *words, "--json").out for words in (("--speed", "0.2"), ()))
    slow, fast = (json.loads(one.splitlines()[-1]) for one in said)
    assert slow["outcome"] == fast["outcome"] == "done" and slow["seconds"] > 2 * fast["seconds"]


def test_a_dry_run_moves_nothing(shel: Path, pico: Pico) -> None:
    assert "storage/b1 → (290, 420, 0°)" in pico("move", "p1", "290", "420", "--dry-run").out
    assert "(110, 220, 0°)" in pico("get", "p1").out


def test_home_drives_the_axis_to_its_home(shel: Path, pico: Pico) -> None:
    pico("set", "p1", "angle=3", "-y")
    assert pico("do", "p1", "home", "-y").code == 0
    assert "p1.angle  0 deg" in pico("get", "p1").out


def test_nothing_is_moved_out_of_the_way_for_one_operation(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    answer = pico("move", "p2", "300", "420", "-y")
    assert answer.code == 3
    assert "p1" in answer.err
    assert "(520, 420, 0°)" in pico("get", "p2").out
    taken = " ".join(pico("move", "p1", "storage/a1", "-y").err.split())
    assert "choose a free slot: storage/b1, storage/b2 or storage/b3;" in taken  # those of p1 and p2, which are out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["set", "p1", "angel=3"], "did you mean `angle`?"),
        (["set", "p1", "angle=2 kg"], "mass"),
        (["set", "p1", "angle=9000"], "from 0 to 360 deg"),
        (["set", "p1", "3"], "`pico set p1 angle=3`"),
        (["set", "laser", "open"], "`pico set laser shutter=open`"),
        (["set", "p1", "angle+=900"], "from 0 to 360 deg, not to 900"),
        (["set", "laser", "shutter+=1"], "is no number"),
        (["get", "left"], "`pico get left.frame`"),
        (["set", "laser", "shutter=ajar"], "no choice `ajar`"),
        (["set", "laser", "emission=3"], "true or false"),
        (["move", "p9", "1", "2"], "there is no component `p9`"),
        (["move", "p1", "storage/b9"], "there is no slot `storage/b9`"),
        (["move", "p1", "storage/z9"], "known: `storage/a1`, `storage/a2`"),
        (["move", "p1", "a4"], "did you mean `storage/a4`?"),
        (["move", "p1", "slot=a4"], "did you mean `storage/a4`?"),
        (["move", "p1", "dx=5"], "`pico move p1 x+=5`"),
        (["move", "p1", "dyaw=5"], "`pico move p1 turn=5`"),
        (["set", "cam", "exposure=5", "gain=3"], "set of cam takes no `gain`"),
        (["move", "p1"], "where to move p1?"),
        (["move", "p1", "x=1", "x=2"], "given twice"),
        (["do", "laser", "move", "x=1"], "no arm can move it: only a person can"),
        (["do", "cam", "measure", "pose"], "no camera over the bench sees it"),
        (["move", "p1", "by=2"], "takes no `by`"),
        (["do", "cam", "home"], "it knows no `home`"),
        (["do", "p1", "home", "tilt"], "`tilt` of p1 does not home"),
        (["do", "laser", "stow"], "no arm can move it"),
        (["move", "p1", "after=p9", "distance=3"], "there is no component `p9`"),
        (["move", "p1", "after=p2"], "after=OTHER distance=MM"),
        (["move", "p1", "after=p2", "distance=3 kg"], "mass"),
        (["move", "p1", "home", "x=3"], "takes no `x`"),
        (["move", "p1", "290", "420", "--speed", "7"], "share of the joint limits"),
        (["get", "p1.nothing"], "no tunable `nothing`"),
        (["sim", "nudge", "p9", "--dx", "1"], "there is no component `p9`"),
        (["sim", "nudge", "p1", "--yaw", "1"], "did you mean `--dyaw`?"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused_in_words(shel: Path, pico: Pico, words: list[str], said: str) -> None:
    answer = pico(*words)
    assert answer.code == 1, answer
    assert said in answer.err
    assert "Traceback" not in answer.err


def test_a_removed_component_is_missing_and_reset_brings_it_back(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    assert "`pico sim nudge p2` puts it home" in pico("sim", "remove", "p2").out
    assert "missing" in pico("status").out
    planned = pico("plan", "--detailed-exitcode")
    assert planned.code == 2
    assert "p2 can't be seen" in planned.out
    assert "warning[missing]" in planned.err
    assert pico("apply", "e1", "--auto-approve").code == 1
    assert pico("sim", "reset").code == 0
    assert "storage/b2" in pico("status").out
    assert pico("sim", "remove", "p2").code == pico("sim", "nudge", "p2").code == 0
    assert "storage/b2" in pico("status").out


def test_a_part_that_no_arm_may_move_is_moved_by_the_simulated_person(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "  p1:\n", "  p1:\n    seating: bolted\n")
    moved = pico("move", "p1", "x+=5", "--yes")
    assert moved.code == 0 and "by hand" in moved.out, moved


@pytest.mark.parametrize("fidelity", ["kinematic", "physics"])
def test_in_a_lab_without_an_arm_a_person_moves_the_parts(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch, fidelity: str
) -> None:
    assert pico("init", "bare").code == 0
    monkeypatch.chdir(shel / "bare")
    lab = Path("lab.yaml").read_text()
    head, _, rest = lab.partition("robots:\n")
    Path("lab.yaml").write_text(head + rest[rest.index("policy:") :])
    assert pico("validate").code == 0, pico("validate").err
    edit(Path("state/table.yaml"), "    slot: storage/a2 ", "    pose: {x: 480, y: 420, yaw: 0} ")
    done = pico("apply", "--yes", "--fidelity", fidelity)
    assert done.code == 0 and "lens by hand to (480, 420, 0°)" in done.out, done
    assert "The bench equals the manifest." in done.out and "no arm" not in done.out + done.err
    assert pico("commit", "-m", "placed").code == 0
    edit(Path("state/table.yaml"), "x: 480", "x: 520")
    assert pico("apply", "--yes", "--fidelity", fidelity).code == 0
    assert pico("undo", "--yes", "--fidelity", fidelity).code == 0
    assert "(480, 420, 0°)" in pico("status").out

"""`pico optimize`: goals ready made and of the lab, met and not met, interrupted, killed, undone, told."""

from __future__ import annotations

import json
import math
import signal
import subprocess
import time
from pathlib import Path

import cv2
import forking
import pytest
from commanding import Brought, Pico, edit, succeed, with_goals

GOALS = """goals:
  centred:
    tunables: {ly_150.stage_y: [-1.5, 1.5], ly_150.stage_z: [-1.5, 1.5]}
    reach: {cam.centroid.x: 0, cam.centroid.y: 0}
    tolerance: 5
    signal: cam.power
    least: 1000
    budget: {measurements: 20, seconds: 120}
    valid_for: 12 h
    description: the spot in the middle of the camera
inventory:
"""


@pytest.fixture
def placed(shel: Path, brought: Brought) -> Path:
    brought(light_on_camera)
    return shel


def light_on_camera(folder: Path) -> None:
    """The case study with its light on the camera, in a world that stands still."""
    edit(folder / "lab.yaml", "  seed: 1\n", "  seed: 1\n  environment: none\n")
    with_goals(folder / "lab.yaml", GOALS)
    succeed("apply", "e1", "--yes")


def test_the_spot_is_centred_by_the_stage_and_undone(placed: Path, pico: Pico) -> None:
    answer = pico("optimize", "center", "ly_150", "cam", "--yes", "--plot", "c.png")
    assert answer.code == 0 and "met in" in answer.out and "centroid_newton: 2 readings" in answer.out
    assert "to 0 within 5" in answer.out and "`pico undo` goes back" in answer.out
    found = pico("measure", "cam.centroid", "--json").data["value"]
    assert abs(found["x"]) < 5 and abs(found["y"]) < 5
    assert cv2.imread(str(placed / "c.png")).std() > 10
    drift = " ".join(pico("drift").out.split())
    assert "No drift: ly_150.stage_y and ly_150.stage_z stay where centred has the last word." in drift
    assert "optimize center ly_150 cam" in pico("runs", "list").out


def test_a_goal_that_the_bench_has_not_adopted_names_what_adopts_it(placed: Path, pico: Pico) -> None:
    edit(placed / "lab.yaml", "  centred:\n", "  middle:\n")
    refused = pico("optimize", "middle", "--yes")
    assert refused.code == 1 and "has no goal `middle`" in refused.err and "`pico bench update`" in refused.err
    assert "has not adopted that yet" in " ".join(refused.err.split())


def test_the_table_says_where_tunables_stood_though_it_was_dark(placed: Path, pico: Pico) -> None:
    assert pico("set", "laser", "shutter=closed", "--yes").code == 0
    answer = pico("optimize", "null", "p1", "cam", "--yes")
    assert answer.code == 6 and answer.err.startswith("shel · sim\n")
    assert next(line for line in answer.out.splitlines() if "p1.angle  " in line).split()[1:3] == ["1", "deg"]


def test_a_goal_of_the_lab_is_one_operation_with_its_points_beside_the_run(placed: Path, pico: Pico) -> None:
    lines = pico("optimize", "centred", "--yes", "--json").out.splitlines()
    found = json.loads(lines[-1])
    assert found["schema"] == "pico.optimization/v1" and found["met"] and found["measurements"] <= 12
    assert abs(found["last"]["cam.centroid.x"]) <= 5 and found["columns"][0] == "time"
    assert found["points"]["shape"] == [found["measurements"], len(found["columns"])]
    progress = [e for e in map(json.loads, lines[:-1]) if e["kind"] == "operation_progress"]
    assert len(progress) >= found["measurements"] and "ly_150.stage_y" in progress[0]["data"]["point"]
    told = [e["data"]["objective"] for e in progress]
    assert told[0]["value"] > 1 >= told[-1]["best"] and told[0]["name"] == "from the goal, in tolerances"
    assert [one["best"] for one in told] == [min(one["value"] for one in told[: n + 1]) for n in range(len(told))]
    run = pico("runs", "show", found["run"], "--json").data
    (operation,) = run["operations"]
    assert operation["primitive"] == "optimize" and operation["data"]["last"] == found["last"]
    assert pico("undo", "--yes").code == 0
    assert pico("get", "ly_150.stage_y", "--json").data["values"]["stage_y"]["value"] == pytest.approx(0, abs=1e-6)
    again = pico("optimize", "centred", "--dry-run")  # no part was put down anew: nothing is made up for
    assert again.code == 0 and "makes up for" not in again.out and "operation" not in again.out


def test_a_saturated_camera_is_not_called_dark_and_the_part_goes_back(
    placed: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def stays(*_: object) -> bool:
        return False

    monkeypatch.setattr("pico.edge.aligning._Run._ranged", stays)  # as a camera whose exposure cannot be set
    pico("set", "p2.angle", "70", "--yes")
    before = pico("get", "p1.angle", "--json").data["values"]["angle"]["value"]
    answer = pico("optimize", "peak", "p1", "cam", "--yes")
    said = " ".join(answer.out.split())
    assert answer.code == 6 and "cam.power is saturated" in said and "shorten the exposure" in said, said
    assert "dark" not in said and "lost" not in said
    assert pico("get", "p1.angle", "--json").data["values"]["angle"]["value"] == pytest.approx(before, abs=1e-6)


def test_a_crossed_polarizer_is_found_from_a_saturated_start(placed: Path, pico: Pico) -> None:
    pico("set", "p2.angle", "70", "--yes")
    answer = pico("optimize", "null", "p2", "cam", "--yes", "--json")
    found = json.loads(answer.out.splitlines()[-1])
    # p1 stands at 1 deg; p2 is turned by 30 deg, so that its axis projects to 1.155 deg
    assert answer.code == 0 and found["last"]["p2.angle"] == pytest.approx(91.15, abs=0.15)
    assert found["measurements"] <= 8
    assert pico("get", "cam.exposure", "--json").data["values"]["exposure"]["value"] == 10


def test_what_is_not_met_is_6_and_says_why(placed: Path, pico: Pico) -> None:
    edit(placed / "lab.yaml", "measurements: 20", "measurements: 2")
    assert pico("bench", "update", "--yes").code == 0
    answer = pico("optimize", "centred", "--yes")
    assert answer.code == 6 and "not met" in answer.out and "the budget of 2 measurements is spent" in answer.out
    pico("set", "laser.shutter", "closed", "--yes")
    answer = pico("optimize", "center", "ly_150", "cam", "--yes")
    assert answer.code == 6 and "no light" in " ".join(answer.out.split())
    assert "= help: laser.shutter is closed" in answer.out
    assert "not met in 0 measurements" in answer.out, "what is shut is asked before the first search"
    for goal in (("centred",), ("null", "p1", "cam"), ("peak", "p1", "cam")):
        lines = pico("optimize", *goal, "--yes", "--json").out.splitlines()
        found = json.loads(lines[-1])
        assert found["measurements"] == 0 and found["why"] == "no light reaches cam: laser.shutter is closed"
    pico("set", "laser.shutter", "open", "--yes")
    pico("set", "laser.emission", "false", "--yes")
    assert "no light reaches cam: laser is switched off" in " ".join(pico("optimize", "centred", "--yes").out.split())
    assert pico("get", "ly_150.stage_y", "--json").data["values"]["stage_y"]["value"] == pytest.approx(0, abs=1e-6)


def test_without_a_goal_they_are_listed_and_a_dry_run_moves_nothing(placed: Path, pico: Pico) -> None:
    listed = pico("optimize")
    assert "the spot in the middle of the camera" in listed.out and "pico optimize null" in listed.out
    assert set(pico("optimize", "--json").data["goals"]) == {"centred"}
    dry = pico("optimize", "centred", "--dry-run")
    assert dry.code == 0 and "-1.5 to 1.5 mm" in dry.out and "at most 20 measurements" in dry.out
    assert pico("get", "ly_150.stage_y", "--json").data["values"]["stage_y"]["value"] == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("center", "ly_15", "cam"), "did you mean `ly_150`"),
        (("centered",), "did you mean `centred`"),
        (("center", "ly_150"), "center PART... CAMERA"),
        (("focus", "ly_150", "cam"), "`focus`: ly_150 has nothing to tune"),
        (("center", "ly_200", "cam"), "ly_200 is in storage/a4, and no light of center ly_200 cam comes there"),
        (("center", "ly_150", "p1"), "p1 does not measure a centroid"),
        (("centred", "--algorithm", "malus"), "malus takes 1 tunables, not 2"),
        (("centred", "--algorithm", "newton"), "there is no algorithm `newton`"),
        (("centred", "--offline", "61"), "a bench goes on by itself for 60 s at most, not for 61 s"),
    ],
)
def test_what_makes_no_sense_is_refused_before_anything_is_asked(
    placed: Path, pico: Pico, words: tuple[str, ...], said: str
) -> None:
    answer = pico("optimize", *words, "--yes")
    assert answer.code == 1 and said in " ".join(answer.err.split())


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("ly_150.stage_y: [-1.5, 1.5]", "ly_150.stage_q: [-1.5, 1.5]", "ly_150 has no tunable `stage_q`"),
        ("ly_150.stage_y: [-1.5, 1.5]", "ly_150.stage_y: [-9, 1.5]", "within its range"),
        ("ly_150.stage_y: [-1.5, 1.5]", "ly_150.stage_y: [1.5, -1.5]", "the lower bound first"),
        ("cam.centroid.x: 0", "cam.centroidd.x: 0", "can't be measured"),
        ("    tolerance: 5\n", "", "how near is near enough"),
        ("    least: 1000\n", "", "`signal` and `least` go together"),
        ("reach: {", "maximize: cam.power\n    reach: {", "exactly one of"),
        ("valid_for: 12 h", "valid_for: 12 mm", "is a length"),
        ("measurements: 20", "measurements: 0", "the budget is for nothing"),
        ("measurements: 20", "offline: 90", "a bench goes on by itself for 60 s at most, not for 90 s"),
        (
            "reach: {cam.centroid.x: 0, cam.centroid.y: 0}",
            "minimize: cam.power / 0",
            "is infinite, whatever is measured",
        ),
        ("reach: {cam.centroid.x: 0, cam.centroid.y: 0}", "minimize: cam.power / (2 - 2) + 1", "must not be 0"),
        ("reach: {cam.centroid.x: 0, cam.centroid.y: 0}", "minimize: cam.power * (0 / 0)", "is no number"),
    ],
)
def test_a_goal_that_makes_no_sense_is_told_at_its_line(
    placed: Path, pico: Pico, old: str, new: str, said: str
) -> None:
    edit(placed / "lab.yaml", old, new)
    answer = pico("validate")
    told = " ".join(answer.err.split())
    assert answer.code == 1 and said in told and "lab.yaml:" in told


@pytest.mark.parametrize(
    ("tolerance", "at"),
    [
        ("0", ("tolerance: ", 0)),
        ("-5", ("tolerance: ", 0)),
        ("{cam.centroid.x: 5, cam.centroid.y: 0}", ("cam.centroid.y: ", 1)),
        ("{cam.centroid.x: 5}", ("tolerance: ", 0)),
    ],
)
def test_what_is_wrong_with_a_tolerance_is_told_where_it_stands(
    placed: Path, pico: Pico, tolerance: str, at: tuple[str, int]
) -> None:
    edit(placed / "lab.yaml", "    tolerance: 5\n", f"    tolerance: {tolerance}\n")
    lines = (placed / "lab.yaml").read_text().splitlines()
    number = next(n for n, line in enumerate(lines) if line == f"    tolerance: {tolerance}")
    column = lines[number].index(at[0]) + len(at[0]) + 1
    answer = pico("validate")
    assert answer.code == 1 and f"lab.yaml:{number + 1}:{column}" in answer.err, answer.err


def _started(folder: Path, *words: str) -> subprocess.Popen[str]:
    process = forking.started(
        forking.PICO, "-C", str(folder), "optimize", *words, "--yes", "--json", cwd=Path(__file__).parents[2],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert process.stdout
    for line in process.stdout:
        if '"operation_progress"' in line and json.loads(line)["data"]["measured"] >= 4:
            break
    return process


def test_ctrl_c_ends_at_the_best_point(placed: Path, pico: Pico) -> None:
    process = _started(placed, "center", "ly_150", "cam", "--algorithm", "nelder_mead")
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    found = json.loads(out.splitlines()[-1])
    assert process.returncode == 130 and not found["met"] and found["why"] == "it was stopped"
    first, last = ([of[f"cam.centroid.{a}"] for a in "xy"] for of in (found["first"], found["last"]))
    assert sum(v**2 for v in last) <= sum(v**2 for v in first) + 1
    assert "killed" not in pico("status").err
    again = pico("resume", "--yes")  # it goes on from there, and is not taken for done
    assert again.code == 0 and "begins at the best point" in " ".join((again.err + again.out).split())
    assert "did all that it was to do" in pico("resume", "--yes").err


DURING = "description: the spot in the middle of the camera"
WANTS = f"{DURING}\n    during: {{cam.exposure: 0.5, p2.angle: 80}}"


def _stands(pico: Pico) -> tuple[float, float]:
    values = (
        pico("get", name, "--json").data["values"][name.partition(".")[2]] for name in ("cam.exposure", "p2.angle")
    )
    first, second = (value["value"] for value in values)
    return first, second


def test_ctrl_c_sets_back_what_a_goal_wanted_while_it_was_sought(placed: Path, pico: Pico) -> None:
    edit(placed / "lab.yaml", DURING, WANTS)
    assert pico("bench", "update", "--yes").code == 0
    before = _stands(pico)
    process = _started(placed, "centred", "--algorithm", "nelder_mead")
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 130 and json.loads(out.splitlines()[-1])["why"] == "it was stopped"
    assert before == _stands(pico) != (0.5, 80)
    again = pico("resume", "--yes")
    assert again.code == 0 and "begins at the best point" in " ".join((again.err + again.out).split())
    assert before == _stands(pico)


def test_what_a_second_ctrl_c_leaves_set_is_told_with_what_sets_it_back(placed: Path, pico: Pico) -> None:
    edit(placed / "lab.yaml", DURING, WANTS)
    assert pico("bench", "update", "--yes").code == 0
    before = _stands(pico)
    process = _started(placed, "centred", "--algorithm", "nelder_mead")
    process.send_signal(signal.SIGINT)
    process.send_signal(signal.SIGQUIT)
    out, _ = process.communicate(timeout=60)
    (told,) = [d for d in json.loads(out.splitlines()[-1])["diagnostics"] if d["code"] == "left-set"]
    assert process.returncode == 130 and _stands(pico)[1] == 80
    assert "cam.exposure at" in told["summary"] and "(was 10 ms), p2.angle at 80 deg (was 90 deg)" in told["summary"]
    assert f"`pico -C {placed} undo`" in told["hint"]
    assert pico("undo", "--yes").code == 0 and before == _stands(pico)


def test_a_killed_one_is_told_and_undone(placed: Path, pico: Pico) -> None:
    process = _started(placed, "center", "ly_150", "cam", "--algorithm", "nelder_mead")
    process.kill()
    process.communicate(timeout=60)
    time.sleep(0.05)
    assert "was killed" in pico("status").err
    values = pico("get", "ly_150", "--json").data["values"]
    known = [values[n]["value"] for n in ("stage_y", "stage_z") if values[n]["value"] is not None]
    assert all(-2 <= value <= 2 for value in known)  # that which was on its way is not known
    again = pico("resume", "--yes")
    assert "`pico optimize center ly_150 cam` was cut short" in " ".join((again.err + again.out).split())
    assert again.code == 0
    (run, *_) = [r["document"] for r in pico("runs", "list", "--json").data["runs"] if r["document"]["resumed"]]
    ended = [op["data"] for op in pico("runs", "show", run["id"], "--json").data["operations"] if "met" in op["data"]]
    assert len(ended) == 1 and math.hypot(*(ended[0]["last"][f"cam.centroid.{a}"] for a in "xy")) < 8
    assert ended[0]["met"] and run["outcome"] == "done"
    assert any(a["name"].endswith("points.npy") for a in run["artifacts"])
    assert pico("undo", "--yes").code == 0
    assert pico("get", "ly_150.stage_y", "--json").data["values"]["stage_y"]["value"] == pytest.approx(0, abs=1e-6)


def test_what_a_killed_one_exposed_comes_back_and_drift_says_by_whom(placed: Path, pico: Pico) -> None:
    pico("set", "p2.angle", "70", "--yes")  # the start is saturated
    assert pico("commit", "-m", "open", "--capture").code == 0
    process = _started(placed, "null", "p2", "cam", "--algorithm", "nelder_mead")
    process.kill()
    process.communicate(timeout=60)
    drift = " ".join(pico("drift").out.split())
    assert "cam.exposure" in drift and "whose optimization was cut short" in drift.split("cam.exposure")[1]
    assert pico("undo", "--yes").code == 0
    assert pico("get", "cam.exposure", "--json").data["values"]["exposure"]["value"] == 10
    assert "cam.exposure" not in pico("drift").out


def test_a_goal_that_is_not_met_is_told_in_the_list_of_runs(placed: Path, pico: Pico) -> None:
    edit(placed / "lab.yaml", "measurements: 20", "measurements: 2")
    assert pico("bench", "update", "--yes").code == 0
    assert pico("optimize", "centred", "--yes").code == 6
    assert "not met" in pico("runs", "list").out
    document = next(r["document"] for r in pico("runs", "list", "--json").data["runs"] if "unmet" in r["document"])
    assert document["unmet"] == ["centred"] and document["outcome"] == "done"
    assert "Not met: centred" in pico("runs", "show", document["id"]).out


def test_a_known_key_of_an_optimization_gives_its_result_and_sets_nothing(placed: Path, pico: Pico) -> None:
    from pico.bench.bench import Bench
    from pico.model.operation import OperationResult, operation_from_json

    assert pico("optimize", "centred", "--yes").code == 0
    pico("set", "ly_150.stage_y", "0.5", "--yes")
    with Bench.open(placed) as bench:
        opened = bench.goals.opened
        edge, memory = opened.edge, opened.edge.memory
        assert memory is not None
        done = [r for r in memory.records() if r.kind == "done" and "columns" in r.data["data"]][-1]
        operation = operation_from_json(memory.records(key=done.key)[0].data)

        async def repeated() -> OperationResult:
            lease = await edge.acquire("test")
            try:
                return await edge.execute(operation, done.key, lease)
            finally:
                await edge.release(lease)

        result = opened.wait(repeated())
    assert result.data["measurements"] == done.data["data"]["measurements"]
    assert pico("get", "ly_150.stage_y", "--json").data["values"]["stage_y"]["value"] == 0.5


def test_a_script_optimizes_too(placed: Path) -> None:
    import pico
    from pico.diagnostics import PicoError

    with pico.open(placed) as bench:
        found = bench.optimize("center", "ly_150", "cam")
        assert found.met and found.last and abs(found.last["cam.centroid.x"]) <= 5
        with pytest.raises(PicoError, match="has no goal `centrd`"):
            bench.optimize("centrd")


def stands(pico: Pico) -> tuple[str, str]:
    (one,) = pico("optimize", "--json").data["alignments"]
    return one["status"], one["why"]


def test_how_a_goal_stands_follows_from_what_was_done_since(placed: Path, pico: Pico) -> None:
    assert stands(pico) == ("never measured", "")
    assert pico("optimize", "centred", "--yes").code == 0
    assert stands(pico)[0] == "aligned" and "aligned" in pico("optimize").out
    assert pico("measure", "cam.centroid").code == 0 and pico("set", "cam.exposure", "12", "-y").code == 0
    pico("set", "laser.shutter", "closed", "-y")
    pico("set", "laser.shutter", "open", "-y")
    assert stands(pico)[0] == "aligned", "neither exposure nor shutter move the spot"
    pico("set", "p1.angle", "2", "-y")
    assert stands(pico) == ("stale", "p1.angle was changed since")
    assert pico("optimize", "centred", "--yes").code == 0 and stands(pico)[0] == "aligned"
    pico("set", "ly_150.stage_y", "0.1", "-y")
    assert stands(pico) == ("stale", "ly_150.stage_y was changed since")
    assert pico("undo", "--yes").code == 0 and stands(pico)[0] == "stale"


def test_a_goal_that_is_not_met_is_lost_and_an_edited_one_stale(placed: Path, pico: Pico) -> None:
    assert pico("optimize", "centred", "--yes").code == 0
    edit(placed / "lab.yaml", "tolerance: 5", "tolerance: 4")
    assert pico("bench", "update", "--yes").code == 0
    assert stands(pico) == ("stale", "it was another goal then")
    pico("set", "laser.emission", "false", "-y")
    assert pico("optimize", "centred", "--yes").code == 6
    assert stands(pico)[0] == "lost"


def test_a_plan_says_which_goals_it_makes_stale(placed: Path, pico: Pico) -> None:
    assert pico("optimize", "centred", "--yes").code == 0
    told = " ".join(pico("move", "p2", "x=530", "--dry-run").out.split())
    assert "align again: centred (p2 changes; met just now;" in told
    assert told.endswith("to redo): `pico optimize centred`")
    assert "align again" not in pico("optimize", "centred", "--dry-run").out
    assert "align again" not in pico("set", "cam.exposure", "12", "--dry-run").out


def test_a_wave_plate_is_turned_to_the_most_light(placed: Path, pico: Pico) -> None:
    answer = pico("optimize", "peak", "hwp.angle", "cam", "--yes", "--json")
    found = json.loads(answer.out.splitlines()[-1])
    values = [pico("measure", "cam.power", "--json").data["value"]]
    for aside in (-2.0, 2.0):
        pico("set", "hwp.angle", str((found["last"]["hwp.angle"] + aside) % 360), "-y")
        values.append(pico("measure", "cam.power", "--json").data["value"])
    assert answer.code == 0 and values[0] > 1.001 * max(values[1:]) and found["measurements"] <= 10


def test_what_cannot_be_begun_is_refused_before_it_is_a_run(placed: Path, pico: Pico) -> None:
    before = len(pico("runs", "list", "--json").data["runs"])
    edit(placed / "lab.yaml", "stage_y: [-1.5, 1.5]", "stage_y: [0.5, 1.5]")
    assert pico("bench", "update", "--yes").code == 0
    answer = pico("optimize", "centred", "--yes")
    assert answer.code == 1 and "`pico set ly_150.stage_y 0.5` brings it there" in " ".join(answer.err.split())
    edit(placed / "lab.yaml", "    valid_for: 12 h\n", "    parameters: {foo: 2}\n")
    assert pico("bench", "update", "--yes").code == 0
    answer = pico("optimize", "centred", "--yes")
    assert answer.code == 1 and "centroid_newton has no parameter `foo`" in answer.err
    assert len(pico("runs", "list", "--json").data["runs"]) == before


def test_the_list_of_goals_and_the_line_of_a_teleoperation_fit_a_narrow_terminal(
    placed: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    from cli.views import goals, style, teleop
    from pico.bench.ready.registry import takes
    from pico.model.goal import Goal
    from pico.teleop.steps import Jogged

    for view in (goals, style, teleop):
        monkeypatch.setattr(view, "wide", lambda *_: 80, raising=False)
    one = Goal(tunables={"ly_150.stage_y": (-1, 1), "ly_150.stage_z": (-1, 1)}, minimize="cam.power",
               description="the spot in the middle of the camera, by the stages of ly_150 and no other")  # fmt: skip
    from pico.planning.alignment import Alignment

    text = goals.text({"ly_150_centred": one}, [Alignment("ly_150_centred", "never measured")], takes()[0])
    assert all(len(style.plain(line)) <= 80 for line in text.splitlines()) and "ly_150 and no other" in text
    shown = "cam.centroid x -0.706, y 57.64 um" + teleop.PEEKED
    jogged = {"angle": Jogged(unit="deg", longest=100.0, range=(0.0, 360.0))}
    line = teleop.line("p1", jogged, {"angle": 1.0}, "angle", {"angle": 0.2}, "", shown)
    assert "y 57.64 um" in line and "step 0.2 deg" in line and len(line) <= 80


def test_what_a_goal_can_not_tell_is_in_the_json_too(placed: Path, pico: Pico) -> None:
    for part in ("p1", "p2"):
        succeed("move", part, f"storage/{'b1' if part == 'p1' else 'b2'}", "--yes")
    words = ("optimize", "peak", "hwp", "cam", "--dry-run")
    assert "no polarizer stands" in " ".join(pico(*words).err.split())
    (one,) = pico(*words, "--json").data["diagnostics"]
    assert "no polarizer stands" in one["summary"]

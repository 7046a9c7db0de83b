"""`pico run`, `pico recipe`, `pico test`: a recipe of the lab checked, run, cut short, taken up and tried."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import forking
import pytest
from commanding import Pico, edit

TEXT = """apiVersion: pico/v1
kind: Recipe
metadata: {name: turning, title: The first polarizer turns}
parameters: {angles: {unit: deg, default: [10, 20]}}
steps:
  - foreach: {angle: angles}
    steps:
      - set: {p1.angle: angle}
      - {measure: p1.angle, as: seen}
      - assert: abs(seen - angle) < 0.5
returns: {last: p1.angle}
"""


@pytest.fixture
def turning(shel: Path) -> Path:
    shutil.rmtree(shel / "recipes")
    (shel / "recipes").mkdir()
    (shel / "recipes" / "turning.yaml").write_text(TEXT)
    return shel


def test_where_nobody_is_there_it_is_held_to_what_it_states(turning: Path, pico: Pico) -> None:
    refused = pico("run", "turning", "--unattended", "--yes")
    assert refused.code == 7 and "does not state how it runs unattended" in refused.err
    always = "unattended: {laser_class: 3R, hours: {from: 0:00, to: 23:59}, stop: [], end: [shut, parked]}\n"
    edit(turning / "recipes" / "turning.yaml", "steps:\n  - foreach", f"{always}steps:\n  - foreach")
    told = " ".join(pico("recipe", "check", "turning").out.split())
    assert (
        "Unattended: 00:00 to 23:59, lasers up to class 3R; stops for: nothing; leaves the bench shut, parked" in told
    )
    answer = pico("run", "turning", "--yes")  # no terminal is there
    assert answer.code == 0 and "The bench is left shut, parked." in answer.out
    assert pico("get", "laser.shutter").out.split()[1] == "closed"
    assert json.loads(pico("run", "turning", "--yes", "--json").out.splitlines()[-1])["left"] == ["shut", "parked"]
    edit(turning / "recipes" / "turning.yaml", "laser_class: 3R", "laser_class: 4R")
    wrong = pico("run", "turning", "--yes")
    assert wrong.code == 1 and "turning.yaml:5:27" in wrong.err and "4R" in wrong.err


def test_it_is_listed_checked_and_run(turning: Path, pico: Pico) -> None:
    assert "turning  The first polarizer turns  angles [deg]" in pico("recipe").out
    (listed,) = pico("recipe", "list", "--json").data["recipes"]
    (angles,) = listed["inputs"]
    assert (angles["kind"], angles["unit"], angles["default"], listed["asks"]) == ("numbers", "deg", [10, 20], [])
    answer = pico("recipe", "check", "turning", "-p", "angles=[5, 6, 7]")
    assert answer.code == 0 and "6 steps foreseen" in answer.out and "angle = 7  (3/3)" in answer.out
    answer = pico("run", "turning", "--dry-run")
    assert answer.code == 0 and pico("get", "p1.angle").out.split()[1] == "0"
    answer = pico("run", "turning", "-p", "angles=3 deg", "--yes", "--junit", "run.xml")
    assert ElementTree.parse("run.xml").getroot().get("tests") == "1"
    assert answer.code == 0 and "✓   1[1].1 set p1.angle: 3" in answer.out and "last = 3" in answer.out
    assert pico("runs", "show", "--json").data["document"]["cause"]["kind"] == "recipe"
    run = answer.out.partition("`pico runs show ")[2].partition("`")[0]
    assert pico("runs", "show", run).code == 0


def test_what_a_run_could_not_keep_to_is_refused_before_anything_moves(turning: Path, pico: Pico) -> None:
    for words, said in (
        (("--until", "2"), "has no step `2`"),
        (("--until", "1[3].1"), "has no step `1[3].1`"),
        (("--junit", "nowhere/run.xml"), "there is no such folder"),
        (("-p", "angles=[3]", "-p", "angles=[4]"), "gives angles twice"),
    ):
        refused = pico("run", "turning", "--yes", *words)
        assert refused.code == 1 and said in refused.err, words
    edit(turning / "recipes" / "turning.yaml", "returns", "  - prompt: Take it out.\nreturns")
    refused = pico("run", "turning", "--yes")
    assert refused.code == 1 and "turning.yaml:11:5" in refused.err and "nobody is there" in refused.err
    assert pico("get", "p1.angle").out.split()[1] == "0"


def test_what_is_left_of_one_that_was_cut_short_is_shown_and_nothing_moves(turning: Path, pico: Pico) -> None:
    assert pico("run", "turning", "--until", "1[2].1", "--yes").code == 0
    answer = pico("run", "--resume", "--dry-run", "--yes")
    assert answer.code == 0 and "2 steps foreseen" in answer.out
    assert "1[2].1 set p1.angle" in answer.out and "1[1].1" not in answer.out
    assert pico("get", "p1.angle").out.split()[1] == "10"
    assert pico("set", "p1", "angle=45", "--yes").code == 0
    refused = pico("run", "turning", "--resume", "--yes")  # it would measure another bench than it set up
    assert refused.code == 4 and "p1.angle: 10 → 45 deg" in refused.err
    assert pico("undo", "--yes").code == 0
    assert pico("run", "--resume", "--yes").code == 0 and pico("get", "p1.angle").out.split()[1] == "20"


def test_as_json_each_step_has_a_line_and_the_end_one(turning: Path, pico: Pico) -> None:
    answer = pico("run", "turning", "--json", "--yes")
    lines = [json.loads(line) for line in answer.out.splitlines()]
    assert lines[-1]["schema"] == "pico.recipe_run/v1" and lines[-1]["returns"] == {"last": 20}
    assert [d["path"] for d in lines if d.get("event") == "done"][:2] == ["1[1].1", "1[1].2"]
    assert pico("run", "turning", "--json").code == 1  # nobody is asked with --json


def test_a_recipe_that_is_no_yaml_keeps_nobody_from_the_bench(turning: Path, pico: Pico) -> None:
    edit(turning / "recipes" / "turning.yaml", "set: {p1.angle: angle}", "set: {p1.angle: angle")
    assert pico("plan").code in (0, 2) and pico("runs", "list").code == 0
    found = pico("validate")
    assert found.code == 0 and "recipes/turning.yaml:9" in found.out + found.err, found
    assert pico("run", "turning", "--yes").code == 1


def test_mistakes_are_told_with_their_lines_and_nothing_is_done(turning: Path, pico: Pico) -> None:
    edit(turning / "recipes" / "turning.yaml", "p1.angle: angle", "p1.angel: angle")
    for words in (("run", "turning", "--yes"), ("recipe", "check", "turning")):
        answer = pico(*words)
        assert answer.code == 1 and "turning.yaml:8:15" in answer.err and "did you mean `angle`" in answer.err
    assert "has mistakes" in pico("recipe").out
    assert "no recipe `turing`" in pico("run", "turing").err and "did you mean `turning`" in pico("run", "turing").err


def test_what_can_not_stand_is_told_before_anything_moves(turning: Path, pico: Pico) -> None:
    text = "metadata: {name: bad}\nsteps:\n- move: {p2: {x: 222, y: 420}}\n"
    (turning / "recipes" / "bad.yaml").write_text(f"apiVersion: pico/v1\nkind: Recipe\n{text}")
    answer = pico("run", "bad", "--yes")
    assert answer.code == 3 and "hwp" in answer.err and "bad.yaml:5" in answer.err


def test_an_assertion_that_fails_ends_it_with_six(turning: Path, pico: Pico) -> None:
    edit(turning / "recipes" / "turning.yaml", "< 0.5", "> 0.5")
    answer = pico("run", "turning", "--yes")
    assert answer.code == 6 and "failed at step 1[1].3" in answer.out
    assert pico("run", "--resume").code == 1  # it has ended


def test_a_failure_is_told_of_its_step_and_not_of_those_of_finally(turning: Path, pico: Pico) -> None:
    edit(turning / "recipes" / "turning.yaml", "< 0.5", "> 0.5")
    edit(turning / "recipes" / "turning.yaml", "returns:", "finally:\n  - set: {p1.angle: 3}\nreturns:")
    answer = pico("run", "turning", "--yes")
    assert answer.code == 6 and "failed at step 1[1].3" in answer.out
    assert float(pico("get", "p1.angle").out.split()[1]) == 3


def test_a_person_is_asked_only_where_one_is(turning: Path, pico: Pico) -> None:
    edit(turning / "recipes" / "turning.yaml", "steps:\n  - foreach", "steps:\n  - prompt: Put it in.\n  - foreach")
    answer = pico("run", "turning", "--yes")
    assert answer.code == 1 and "`prompt Put it in.` waits for a person, and nobody is there" in answer.err
    edit(turning / "recipes" / "turning.yaml", "prompt: Put it in.", "{prompt: Put it in., unattended: skip}")
    assert pico("run", "turning", "--yes").code == 0


@pytest.mark.slow
@pytest.mark.slow
def test_one_that_is_left_to_itself_is_followed_to_its_end(turning: Path, pico: Pico) -> None:
    left = pico("--json", "run", "turning", "--yes", "--detach")
    assert left.code == 0, left.err
    followed = pico("runs", "attach", left.data["run"])
    assert followed.code == 0 and "turning: done" in followed.out, followed.out + followed.err
    assert "20" in pico("get", "p1.angle").out and "no run goes on" in pico("runs", "attach").err
    refused = pico("run", "turning", "--yes", "--detach", "--dry-run")
    assert refused.code == 1 and "--detach goes with none" in refused.err


def test_a_killed_recipe_goes_on_where_it_was(turning: Path, pico: Pico) -> None:
    words = ["run", "turning", "-p", "angles={from: 1, to: 30, step: 1}", "--yes"]
    running = forking.started(forking.PICO, *words, stdout=subprocess.PIPE)
    assert running.stdout is not None
    for line in running.stdout:
        if "1[4].1" in line:
            break
    os.kill(running.pid, signal.SIGKILL)
    running.wait()
    assert "`pico run --resume` goes on" in pico("recipe").out
    answer = pico("run", "--resume", "--yes")
    assert answer.code == 0 and re.search(r"turning: done, 60 steps, \d+ of them before", answer.out)
    running = forking.started(forking.PICO, *words, stdout=subprocess.PIPE)
    assert running.stdout is not None
    for line in running.stdout:
        if "1[3].1" in line:
            break
    running.send_signal(signal.SIGINT)
    rest = running.stdout.read()
    assert running.wait(60) == 130 and "Go on with `pico run --resume`" in rest
    assert pico("run", "--resume", "--yes").code == 0


@pytest.mark.slow
def test_recipes_are_tried_in_clones_and_the_bench_stays(turning: Path, pico: Pico) -> None:
    bad = TEXT.replace("turning", "bad").replace("< 0.5", "> 0.5")
    (turning / "recipes" / "bad.yaml").write_text(bad)
    answer = pico("test", "--junit", "tests.xml")
    assert answer.code == 1 and "✗ bad  failed at step 1[1].3" in answer.out and "✓ turning" in answer.out
    suite = ElementTree.parse("tests.xml").getroot()
    assert (suite.get("tests"), suite.get("failures")) == ("2", "1")
    assert not (turning / ".pico/benches/sim" / "recipes").exists()


def test_what_was_done_by_hand_becomes_a_recipe_that_does_it_again(shel: Path, pico: Pico) -> None:
    assert pico("apply", "e1", "-y").code == 0
    assert pico("move", "p2", "yaw=10", "-y").code == 0
    assert pico("set", "p1", "angle=2", "-y").code == 0
    assert pico("optimize", "null", "p2", "cam", "-y").code == 0
    assert pico("measure", "p1.angle").code == 0
    listed = [r["document"] for r in pico("runs", "list", "--all", "--json").data["runs"]]
    runs = [r["id"] for r in sorted(listed, key=lambda r: r["number"])]
    answer = pico("recipe", "from", *runs, "-o", "recipes/again.yaml")
    assert answer.code == 0 and "pico recipe check recipes/again.yaml" in answer.out
    steps = [s for s in (shel / "recipes" / "again.yaml").read_text().split("\n") if s.startswith("  - ")]
    assert steps[-4:] == [
        "  - move: {p2: {x: 520.0, y: 420.0, yaw: 10.0}}", "  - set: {p1.angle: 2.0}",
        "  - optimize: null p2 cam", "  - measure: p1.angle",
    ]  # fmt: skip
    assert pico("recipe", "from", *runs, "-o", "recipes/again.yaml").code == 1  # nothing is written over
    assert pico("sim", "reset", "--seed", "7").code == 0
    answer = pico("run", "again", "--yes")
    assert answer.code == 0, answer.err
    assert pico("get", "p1.angle").out.split()[1] == "2"
    assert pico("recipe", "from", "2020").code == 1


def test_a_seed_makes_a_new_world_first(turning: Path, pico: Pico) -> None:
    assert pico("set", "hwp", "angle=40", "-y").code == 0
    answer = pico("run", "turning", "--seed", "5", "--yes")
    assert answer.code == 0 and "new simulated world of seed 5" in answer.out
    assert json.loads((turning / ".pico/benches/sim" / "world.json").read_text())["seed"] == 5
    assert pico("get", "hwp.angle").out.split()[1] != "40"
    assert pico("run", "--resume", "--seed", "5", "--yes").code == 1


def test_revisions_that_a_recipe_makes_are_planned_to_before_there_are_any(shel: Path, pico: Pico) -> None:
    shutil.rmtree(shel / "recipes")
    (shel / "recipes").mkdir()
    (shel / "recipes" / "there_and_back.yaml").write_text("""apiVersion: pico/v1
kind: Recipe
metadata: {name: there_and_back}
steps:
  - branch: new/e1
  - set: {p1.angle: 20}
  - commit: twenty
  - tag: new/twenty
  - set: {p1.angle: 30}
  - commit: thirty
  - checkout: new/twenty
  - {measure: p1.angle, as: there}
  - checkout: new/e1
  - {measure: p1.angle, as: back}
  - assert: there < 21 && back > 29
  - apply: e1
  - {optimize: null p1 cam, as: found}
  - assert: found.met && found.measurements > 2.0
""")
    answer = pico("recipe", "check", "there_and_back")
    assert answer.code == 0, answer.err
    assert re.search(r"7 checkout new/twenty  0\.\d s", answer.out) and re.search(
        r"9 checkout new/e1  0\.\d s", answer.out
    )
    answer = pico("run", "there_and_back", "--yes")
    assert answer.code == 0, answer.err + answer.out


def test_every_step_that_recipes_may_have_is_listed(turning: Path, pico: Pico) -> None:
    from pico.recipes.registry import CONTROL, known

    listed = [line.split()[0] for line in pico("recipe", "steps").out.splitlines() if line.strip()]
    assert set(listed) >= {*CONTROL, *known()}


def test_its_figures_are_plotted(turning: Path, pico: Pico) -> None:
    """As numbers, as JSON and as pictures; without a run, or with options of another plot, it says so."""
    file = turning / "recipes" / "turning.yaml"
    figure = (
        "figures: {turned: {x: angle, y: angle, series: {last: {x: last, y: last}}}}\nnotes: [all of it inferred]\n"
    )
    file.write_text(file.read_text() + figure)
    assert pico("runs", "plot", "--recipe").code == 1
    assert pico("run", "turning", "--yes").code == 0
    plotted = pico("runs", "plot", "--recipe", "turning", "--pictures", "figures")
    assert plotted.code == 0, plotted.err
    assert "20.00" in plotted.out and "all of it inferred" in plotted.out
    assert {p.name for p in (turning / "figures").iterdir()} == {"trace.png", "turned.png"}
    found = pico("runs", "plot", "--recipe", "--json").data
    assert found["schema"] == "pico.figures/v1" and found["figures"][0]["series"][0]["x"] == [20.0]
    assert pico("runs", "plot", "--recipe", "--x", "t").code == 1


NAMING = """apiVersion: pico/v1
kind: Recipe
metadata: {name: naming}
parameters: {label: a, turns: [1]}
steps:
  - set: {p1.angle: 5}
  - commit: at ${p1.angle} deg, ${label}
  - foreach: {turn: turns}
    steps:
      - tag: t-${label}
      - set: {p2.angle: turn + 1, hwp.angle: 3}
"""


def test_a_name_that_is_taken_is_told_before_anything_moves(turning: Path, pico: Pico) -> None:
    (turning / "recipes" / "naming.yaml").write_text(NAMING)
    ahead = pico("run", "naming", "--dry-run")
    assert ahead.code == 0 and "commit at 5 deg, a" in ahead.out and "tag t-a" in ahead.out
    done = pico("run", "naming", "--yes")
    assert "3[1].2 set p2.angle: 2, hwp.angle: 3" in ahead.out and "3[1].2 set p2.angle: 2, hwp.angle: 3" in done.out
    assert done.code == 0 and "commit at 5 deg, a" in done.out and "tag t-a" in done.out and "${" not in done.out
    assert pico("set", "p1", "angle=9", "-y").code == 0
    for words in (("recipe", "check", "naming"), ("run", "naming", "--yes")):
        again = pico(*words)
        assert again.code == 1 and "there is a tag `t-a` already" in again.err and "naming.yaml:10:9" in again.err
    assert pico("get", "p1.angle").out.split()[1] == "9"
    assert pico("recipe", "check", "naming", "-p", "label=b").code == 0
    twice = pico("recipe", "check", "naming", "-p", "label=b", "-p", "turns=[1, 2]")
    assert twice.code == 1 and "there is a tag `t-b` already" in twice.err
    wrong = pico("recipe", "check", "naming", "-p", "label=b c")
    assert wrong.code == 1 and "`t-b c` is no name of a tag" in wrong.err
    (turning / "recipes" / "naming.yaml").write_text(NAMING.replace("tag: t-${label}", "branch: main"))
    assert "there is a branch `main` already" not in pico("recipe", "check", "naming").err  # it is checked out
    (turning / "recipes" / "naming.yaml").write_text(NAMING.replace("tag: t-${label}", "branch: e1"))
    taken = pico("recipe", "check", "naming")
    assert taken.code == 1 and "there is a branch `e1` already" in taken.err


def test_the_functions_of_expressions_are_listed_with_the_steps(turning: Path, pico: Pico) -> None:
    said = " ".join(pico("recipe", "steps").out.split())
    assert "`linspace(number, number, number)`" in said and "`size(l)`" in said
    assert pico("recipe", "steps", "--json").data["functions"]["round"] == "`round(number)` or `round(number, number)`"
    edit(turning / "recipes" / "turning.yaml", "abs(seen - angle)", "abs(seen angle)")
    assert "`pico recipe steps` lists" in pico("recipe", "check", "turning").err


def test_what_a_condition_and_a_value_come_to_is_printed_and_what_depends_on_a_measurement_is_told(
    turning: Path, pico: Pico
) -> None:
    (turning / "recipes" / "telling.yaml").write_text(
        "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: telling}\nsteps:\n- set: {p1.angle: 10}\n- wait: 0.1\n"
        "- {measure: p1.angle, as: seen}\n- let: {third: seen / 3, both: '[seen / 3]'}\n- if: third > 3\n"
        "  then: [{set: {p1.angle: third}}]\n- wait: 0.1\n- set: {p1.angle: 5}\nreturns: {third: third, both: both}\n"
    )
    ahead = pico("recipe", "check", "telling").out
    assert "5.1 set p1.angle: third  depends on a measurement" in ahead
    assert "1 step more depends on a measurement" in ahead
    done = pico("run", "telling", "--yes")
    assert done.code == 0, done.err
    assert re.search(r"4 let third = 3\.3\d{0,4}, both = \[3\.3\d{0,4}\]\n", done.out)
    assert re.search(r"5 if third > 3  third = 3\.3\d{0,4}: yes\n", done.out)
    assert re.search(r"  both = \[3\.3\d{0,4}\]\n", done.out)
    named = done.out.partition("has what it did, in 3 runs one after another: ")[2].replace("\n", " ").split(", ")
    assert len(named) == 3
    assert all(pico("runs", "show", run.strip()).code == 0 for run in named)


def _git(*words: str) -> None:
    subprocess.run(["git", *words], check=True, capture_output=True)


def test_a_commit_that_moves_no_part_does_not_keep_a_recipe_from_being_taken_up(turning: Path, pico: Pico) -> None:
    _git("add", "-A")
    _git("commit", "-qm", "recipe")
    assert pico("run", "turning", "--until", "1[2].1", "--yes").code == 0
    _git("commit", "-q", "--allow-empty", "-m", "x")
    (turning / "NOTES.md").write_text("A note.\n")
    _git("add", "NOTES.md")
    _git("commit", "-qm", "a note")
    resumed = pico("run", "--resume", "--yes")
    assert resumed.code == 0, resumed.err


def test_the_way_back_to_what_was_checked_out_works_as_it_is_written(turning: Path, pico: Pico) -> None:
    _git("add", "-A")
    _git("commit", "-qm", "recipe")
    _git("checkout", "-q", "-B", "trial")
    assert pico("run", "turning", "--until", "1[2].1", "--yes").code == 0
    state = next(path for path in (turning / "state").glob("*.yaml") if "exposure:" in path.read_text())
    state.write_text(re.sub(r"exposure: [0-9.]+", "exposure: 3", state.read_text()))
    _git("commit", "-qam", "another exposure")
    _git("checkout", "-q", "HEAD~1")
    for _ in range(2):  # back to the branch, then to the commit
        refused = pico("run", "--resume", "--yes")
        assert refused.code == 4 and "the bench is not as" not in refused.err, refused.err
        hint = " ".join(refused.err.split()).partition("= help:")[2].partition("; or")[0]
        for command in re.findall(r"`git ([^`]*)`", hint):
            _git(*command.split())
    assert pico("run", "--resume", "--yes").code == 0


def test_a_step_whose_values_fail_is_the_one_that_is_named(turning: Path, pico: Pico) -> None:
    steps = (
        'steps:\n  - {measure: p1.angle, as: p}\n  - let: {l: "[p]"}\n  - set: {p1.angle: 8}\n  - assert: l[0] < l[1]\n'
    )
    head = "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: short, title: Too short}\n"
    (turning / "recipes/short.yaml").write_text(head + steps)
    failed = pico("run", "short", "--yes")
    assert failed.code == 1 and "failed at step 4," in failed.out, failed.out
    assert "`l` has 1 value, so `l[1]` does not exist" in failed.err and "${" not in failed.err, failed.err

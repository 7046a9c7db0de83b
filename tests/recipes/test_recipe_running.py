"""A recipe on the bench of the case study: cut short at any of its lines, it goes on, and ends the same."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at

from pico.bench.bench import Bench
from pico.diagnostics import ExitCode, PicoError
from pico.recipes.log import Log, logs
from pico.recipes.recipes import Recipes
from pico.recipes.running import Outcome, Watching
from pico.runs.table import rows

TEXT = """apiVersion: pico/v1
kind: Recipe
metadata: {name: scan, lab: shel}
parameters: {angles: {unit: deg, default: [10, 20]}}
steps:
  - set: {p1.angle: 5, hwp.angle: 20, p2.angle: +=20}
  - foreach: {angle: angles}
    steps:
      - set: {p1.angle: angle}
      - {measure: p1.angle, as: read}
      - note: {p1: "turned to ${angle}"}
  - commit: turned
  - branch: mine
  - tag: here
  - if: p1.angle > 15
    then: [{home: hwp.angle}]
returns: {left: p1.angle}
"""


class Killed(BaseException):
    """The process is gone."""


@pytest.fixture
def lab(case_study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "A Physicist")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", "/dev/null")
    shutil.copytree(case_study, tmp_path / "shel")
    (tmp_path / "scan.yaml").write_text(TEXT)
    return tmp_path / "shel"


def begin(root: Path) -> Outcome:
    with Bench.open(root) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(root.parent / "scan.yaml"))
        return recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, {})))


def resume(root: Path) -> Outcome:
    with Bench.open(root) as bench:
        recipes = Recipes(bench)
        log = recipes.unended()
        return recipes.run(recipes.taken_up(log), log)


def ending(root: Path) -> dict[str, Any]:
    """Return what is the same however often it was cut short."""
    with Bench.open(root) as bench:
        memory, history = bench.edge.memory, bench.folder.history()
        assert memory is not None
        records = memory.records()
        taken = [r for r in records if r.kind == "done" and (r.data.get("data") or {}).get("measurement")]
        return {
            "values": {n: dict(v) for n, v in bench.observe().known_values.items()},
            "measured": len(taken), "notes": [n.text for n in bench.history.notes("p1")],
            "branch": history.head().branch, "commits": len(list(history.log())),
            "tag": bench.history.is_revision("here"),
        }  # fmt: skip


def test_it_runs_to_its_end_and_the_commit_carries_its_runs(lab: Path) -> None:
    found = begin(lab)
    assert (found.outcome, found.returns) == ("done", {"left": 20.0}), found
    with Bench.open(lab) as bench:
        runs = [run for run, commit in bench.history.runs() if commit]
        assert {r.cause.kind for r in runs} == {"recipe"}
        assert all(str(r.cause.recipe).startswith("scan@") for r in runs)
        assert len(runs) == 1 and len(bench.history.runs()) == 2  # up to the commit, and after it
        trace = bench.history.recorded_run(runs[0].id)[0].trace
        assert {e.operation for e in trace} >= {"2.2[1].1:op1", "3.2[1].2:op1", "5.2[2].2:op1"}, trace
    with pytest.raises(PicoError, match="no run of a recipe was cut short"):
        resume(lab)


LINES = [11, 23, *(pytest.param(n, marks=pytest.mark.slow) for n in (2, 5, 7, 9, 15, 22, 25, 28, 31))]


@pytest.mark.parametrize("after", [False, True])
@pytest.mark.parametrize("line", LINES)
def test_killed_at_a_line_of_its_log_it_goes_on_and_ends_the_same(
    lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, line: int, after: bool
) -> None:
    other = tmp_path / "whole" / "shel"
    shutil.copytree(lab, other)
    (other.parent / "scan.yaml").write_text(TEXT)
    assert begin(other).outcome == "done"
    lines, write = 0, Log._write

    def cut(self: Log, data: Any) -> None:
        nonlocal lines
        lines += 1
        if lines == line and not after:
            raise Killed
        write(self, data)
        if lines == line and after:
            raise Killed

    with monkeypatch.context() as patched, pytest.raises(Killed):
        patched.setattr(Log, "_write", cut)
        begin(lab)
    assert resume(lab).outcome == "done"
    assert ending(lab) == ending(other)


def test_a_log_that_was_cut_in_a_line_is_read_up_to_it(lab: Path) -> None:
    def stop(*_: object) -> None:
        raise Killed

    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(lab.parent / "scan.yaml"))
        with pytest.raises(Killed):
            recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, {})), Watching(ended=stop))
    path = logs(bench_at(lab))[0]
    path.write_bytes(path.read_bytes()[:-9])
    with pytest.raises(PicoError, match="its last line is missing"):
        resume(lab)
    path.with_suffix(".lines").unlink()  # as after a power failure, which leaves no greater count than there are lines
    assert resume(lab).outcome == "done"


def test_a_recipe_that_was_edited_is_not_taken_up(lab: Path) -> None:
    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(lab.parent / "scan.yaml"))
        recipes.begin(recipe, recipes.arguments(recipe, {}))
    (lab.parent / "scan.yaml").write_text(TEXT.replace("20]", "25]"))
    with pytest.raises(PicoError, match="was edited since"):
        resume(lab)


def test_a_recipe_whose_file_a_checkout_took_away_goes_on_as_it_was(lab: Path) -> None:
    (lab.parent / "turn.yaml").write_text(TEXT.replace("name: scan", "name: turn").partition("  - commit")[0])
    (lab.parent / "scan.yaml").write_text(TEXT.replace("steps:", "steps:\n  - call: turn", 1))
    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(lab.parent / "scan.yaml"))
        recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, {})), Watching(until="3[2].1"))
    for name in ("scan", "turn"):
        (lab.parent / f"{name}.yaml").unlink()
    assert resume(lab).outcome == "done"


@pytest.mark.parametrize(
    "steps",
    [
        "- let: {at: 1e4}\n- if: light >= 0\n  then: [{let: {at: '520'}}]\n- move: {p2: {x: at, y: 420, yaw: 0}}\n",
        "- if: light >= 0\n  then: [{set: {p1.angle: 30}}]\n- assert: p1.angle == 30\n",
        "- set: {p1.angle: 'light >= 0 ? 30 : 20'}\n- assert: p1.angle == 30\n",
        "- if: light >= 0\n  then: [{move: {p1: home}}]\n- move: {p2: {x: 290, y: 420, yaw: 0}}\n",
    ],
)
def test_what_depends_on_a_measurement_is_not_refused_in_advance(lab: Path, steps: str) -> None:
    text = TEXT.partition("parameters")[0] + "steps:\n- {measure: laser.monitor, as: light}\n"
    first = "- move: {p1: {x: 290, y: 420, yaw: 0}}\n" if "home" in steps else ""
    (lab.parent / "scan.yaml").write_text(text + first + steps)
    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(lab.parent / "scan.yaml"))
        ahead = recipes.ahead(recipe, {})
        assert not ahead.diagnostics and not ahead.whole
    assert begin(lab).outcome == "done"


def test_it_stops_before_a_step_and_goes_on(lab: Path) -> None:
    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(lab.parent / "scan.yaml"))
        log = recipes.begin(recipe, recipes.arguments(recipe, {}))
        found = recipes.run(recipe, log, Watching(until="2[2].1"))
        assert (found.outcome, found.exit_code) == ("interrupted", ExitCode.DONE)
        assert bench.measurements.read("p1", "angle")["angle"]["value"] == 10
    assert resume(lab).before == 4


def test_parameters_are_read_with_units_and_refused_out_of_range(lab: Path) -> None:
    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(lab.parent / "scan.yaml"))
        assert recipes.arguments(recipe, {"angles": "[1 deg, 100 mrad]"})["angles"] == pytest.approx(
            [1, 5.7296], abs=1e-3
        )
        assert recipes.arguments(recipe, {"angles": "{from: 0, to: 10, step: 5}"})["angles"] == [0, 5, 10]
        for words, said in (
            ({"angles": "2 kg"}, "an angle"),
            ({"angle": "2"}, "no parameter"),
            ({"angles": "[]"}, "empty"),
        ):
            with pytest.raises(PicoError, match=said):
                recipes.arguments(recipe, words)


def test_what_a_person_steers_needs_a_person_and_is_recorded_as_of_the_recipe(lab: Path) -> None:
    (lab.parent / "scan.yaml").write_text("\n".join([*TEXT.splitlines()[:3], "steps:", "  - teleop: p1.angle\n"]))
    assert "nobody is there" in begin(lab).diagnostics[0].summary

    def steer(jog: Any) -> None:
        with jog:
            jog.step("angle", 0.5)

    with Bench.open(lab) as bench:
        recipes, before = Recipes(bench), bench.measurements.read("p1", "angle")["angle"]["value"]
        recipe = recipes.read(str(lab.parent / "scan.yaml"))
        with pytest.raises(PicoError, match="waits for a person"):
            recipes.require_alone(recipe, asked=True)  # nobody answers with keys
        log = recipes.begin(recipe, recipes.arguments(recipe, {}))
        found = recipes.run(recipe, log, attended=True, steer=steer)
        assert found.outcome == "done", found.diagnostics
        assert bench.measurements.read("p1", "angle")["angle"]["value"] == pytest.approx(before + 0.5, abs=0.02)
        assert bench.history.recorded_run(None)[0].document.cause.kind == "recipe"


def test_a_failure_names_its_step_and_what_the_bench_said(lab: Path) -> None:
    (lab.parent / "scan.yaml").write_text(TEXT.replace("p1.angle: angle}", "p1.angle: angle * 100}"))
    found = begin(lab)
    assert (found.outcome, found.at) == ("failed", "2[1].1")
    assert "goes from 0 to 360 deg, not to 1000" in found.diagnostics[0].summary
    source = found.diagnostics[0].source
    assert source is not None and source.path.endswith("scan.yaml") and source.start.line == 9


CHAIN = """apiVersion: pico/v1
kind: Recipe
metadata: {name: scan, lab: shel}
steps:
  - apply: C3
  - set: {laser.emission: true, laser.shutter: open, p1.angle: 12, p2.angle: 102}
  - do: cam auto_range
  - {measure: cam.image | background | d4sigma, as: spot}
  - set: {p2.angle: 100}
returns: {size: spot.major, off: spot.major_sigma}
"""


def test_what_kernels_make_of_a_picture_is_not_measured_again_when_it_goes_on(lab: Path) -> None:
    (lab.parent / "scan.yaml").write_text(CHAIN)

    def stop(path: str, *_: object) -> None:
        if path == "5":
            raise Killed

    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(lab.parent / "scan.yaml"))
        with pytest.raises(Killed):
            recipes.run(recipe, recipes.begin(recipe, {}), Watching(ended=stop))
    ended = resume(lab)
    assert ended.outcome == "done" and 0 < ended.returns["off"] < 0.1 * ended.returns["size"], ended
    with Bench.open(lab) as bench:
        found = [bench.history.recorded_run(run.id)[0] for run, _ in bench.history.runs()]
        assert [row.measurement.address for one in found for row in rows(one.trace)] == [
            "cam.image | background | d4sigma"
        ]


def stopped_before(root: Path, step: str) -> None:
    with Bench.open(root) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(root.parent / "scan.yaml"))
        recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, {})), Watching(until=step))


def test_what_others_did_since_it_was_cut_short_is_told_and_no_more_once_it_is_undone(lab: Path) -> None:
    stopped_before(lab, "2[2].1")
    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        log = recipes.unended()
        assert recipes.changed_since(log) == ()
        bench.apply(bench.single("p1", "set", angle=45))
        bench.apply(bench.single("p1", "measure", measurable="angle"))
        (found,) = recipes.changed_since(log)
        assert (found.code, found.summary) == ("bench-changed", "p1.angle: 10 → 45 deg"), found
        bench.apply(bench.single("p1", "set", angle=10))
        assert recipes.changed_since(log) == ()


def test_a_log_that_was_cut_in_its_first_line_is_of_a_run_that_did_nothing(lab: Path) -> None:
    stopped_before(lab, "2[2].1")
    whole = logs(bench_at(lab))[0]
    whole.with_name("99990101T000000Z-aaaaaa.jsonl").write_bytes(b"")
    whole.with_name("99990101T000000Z-bbbbbb.jsonl").write_bytes(whole.read_bytes()[:40])
    assert resume(lab).outcome == "done"


def test_a_log_of_another_version_is_told_and_keeps_no_other_from_going_on(lab: Path) -> None:
    stopped_before(lab, "2[2].1")
    text = logs(bench_at(lab))[0].read_text(encoding="utf-8")
    logs(bench_at(lab))[0].with_name("99990101T000000Z-aaaaaa.jsonl").write_text(text.replace("_run/v1", "_run/v9"))
    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        assert [about.name for about in recipes.cut_short()] == ["scan"]
        assert "it is pico.recipe_run/v9" in recipes.broken[0].summary
        with pytest.raises(PicoError, match="v9"):
            recipes.unended("nope")
    assert resume(lab).outcome == "done"


def test_a_step_before_which_it_is_to_stop_is_one_that_there_is(lab: Path) -> None:
    with Bench.open(lab) as bench:
        recipes = Recipes(bench)
        recipe = recipes.read(str(lab.parent / "scan.yaml"))
        ahead = recipes.ahead(recipe, recipes.arguments(recipe, {}))
        for path in ("1", "2", "2[1]", "2[2].1", "6.1"):
            recipes.require_step(recipe, path, ahead)
        for path in ("99", "2.9", "2[3].1", "finally.1", ""):
            with pytest.raises(PicoError, match="no step"):
                recipes.require_step(recipe, path, ahead)
        log = recipes.begin(recipe, recipes.arguments(recipe, {}))
        found = recipes.run(recipe, log, Watching(until="2"))  # a loop, which itself does nothing
        assert (found.outcome, found.acted) == ("interrupted", 1)


def test_what_is_checked_out_otherwise_is_told_and_what_git_has_of_it_is_the_recipes(lab: Path) -> None:
    """Also half a step: a branch that was made and not checked out; and a commit that a person made meanwhile."""
    stopped_before(lab, "5")
    with Bench.open(lab) as bench:
        recipes, history = Recipes(bench), bench.folder.history()
        log = recipes.unended()
        assert log.steps["3"].kind == "commit" and log.steps["4"].at == ("mine", history.head().commit)
        assert recipes.changed_since(log) == ()
        bench.history.checkout("e1")
        (said, *_) = recipes.changed_since(log)
        assert said.code == "checkout-changed" and "mine at" in said.summary and said.hint == "`git checkout mine`"


@pytest.mark.parametrize("step", ["3", "4"])
def test_half_a_step_in_git_is_done_once(lab: Path, monkeypatch: pytest.MonkeyPatch, step: str) -> None:
    def killed(*_: object, **__: object) -> None:
        raise Killed

    with monkeypatch.context() as patched, pytest.raises(Killed):
        if step == "3":  # before it commits, a person does
            patched.setattr("pico.bench.commits.Commits.commit", killed)
        else:  # the branch is there, and not checked out
            patched.setattr("pico.history.lab_history.LabHistory.checkout", killed)
        begin(lab)
    if step == "3":
        subprocess.run(["git", "commit", "-q", "--allow-empty", "-m", "by hand"], cwd=lab, check=True)
    assert resume(lab).outcome == "done"
    with Bench.open(lab) as bench:
        said = [one.message.partition("\n")[0] for one in bench.folder.history().log()][:3]
        assert said.count("turned") == 1 and bench.folder.history().head().branch == "mine", said


def test_where_its_log_can_not_be_written_it_stops_there_and_goes_on_once_it_can(
    lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A full disk: nothing is done of which nobody would know, what tidies up neither; a step that failed is over."""
    (lab.parent / "scan.yaml").write_text(TEXT + "finally:\n  - set: {p2.angle: 5}\n")
    lines, write = 0, Path.open

    def full(self: Path, *mode: Any, **how: Any) -> Any:
        nonlocal lines
        lines += self.suffix == ".jsonl" and mode == ("ab",)
        if lines >= 9 and self.suffix == ".jsonl" and mode == ("ab",):
            raise OSError(28, "No space left on device")
        return write(self, *mode, **how)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "open", full)
        found = begin(lab)
    assert found.outcome == "failed" and "no space left" in found.diagnostics[0].summary, found
    assert "--resume" in found.diagnostics[0].hint and len(found.diagnostics) == 1
    assert resume(lab).outcome == "done"
    assert ending(lab)["measured"] == 2

"""Recipes that run where nobody is there: what they state, when they begin, what stops them, how they end."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.bench.bench import Bench
from pico.bench.cut_short import told_first
from pico.diagnostics import ExitCode
from pico.edge.shutting import Shutting
from pico.model.arming import Licence
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.planning.checks.emission import emits_alone
from pico.recipes import guarding
from pico.recipes.recipe import Unattended
from pico.recipes.recipes import Recipes
from pico.recipes.running import Outcome, Watching

HEAD = "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: night, lab: shel}\n"
STATED = """unattended:
  laser_class: 3R
  hours: {from: 22:00, to: 6:00}
  stop: [{when: laser.monitor < 1.5, message: the reference is dark}]
  every: 10 min
  end: [shut, parked, lamps off]
"""
STEPS = """steps:
  - apply: e1
  - set: {p1.angle: 5}
  - wait: 1 h
  - set: {p1.angle: 6}
finally:
  - set: {hwp.angle: 20}
"""


@pytest.fixture
def bench(case_study: Path, tmp_path: Path) -> Iterator[Bench]:
    shutil.copytree(case_study, tmp_path / "shel")
    with Bench.open(tmp_path / "shel") as opened:
        yield opened


@pytest.fixture
def night(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> list[datetime]:
    """The clock on the wall, of the recipe and of the edge: the last one counts."""
    times = [datetime(2026, 11, 24, 23, 0)]
    monkeypatch.setattr(guarding, "local_now", lambda: times[-1])
    monkeypatch.setattr(bench.edge.apparatus, "now", lambda: f"{times[-1].astimezone(UTC):%Y-%m-%dT%H:%M:%SZ}")
    return times


def run(bench: Bench, text: str, watching: Watching = Watching(), **how: Any) -> Outcome:  # noqa: B008
    path = bench.root.parent / "night.yaml"
    path.write_text(HEAD + text)
    recipes = Recipes(bench)
    recipe = recipes.read(str(path))
    return recipes.run(
        recipe, recipes.begin(recipe, recipes.arguments(recipe, {})), watching, unattended=True, **how
    )  # fmt: skip


def value(bench: Bench, address: str) -> Any:
    component, _, tunable = address.partition(".")
    return bench.observe().known_values[component][tunable]


@given(st.times(), st.times(), st.times())
def test_hours_over_midnight_are_those_that_the_others_are_not(begins: Any, ends: Any, now: Any) -> None:
    if begins != ends:
        one = Unattended("3R", begins, ends)
        assert one.covers(now) != Unattended("3R", ends, begins).covers(now)
        assert one.covers(begins) and not one.covers(ends)


def test_it_ends_with_the_lasers_shut_and_says_so(bench: Bench, night: list[datetime]) -> None:
    found = run(bench, STATED + STEPS)
    assert (found.outcome, found.exit_code, found.left) == ("done", ExitCode.DONE, ("shut", "lamps off", "parked"))
    assert value(bench, "laser.shutter") == "closed" and value(bench, "p1.angle") == 6
    assert not any(row.emits for row in bench.lasers.rows())


def test_without_the_flag_nothing_is_held_and_nothing_shut(bench: Bench, night: list[datetime]) -> None:
    night.append(datetime(2026, 11, 24, 12, 0))
    (bench.root.parent / "night.yaml").write_text(HEAD + STATED + STEPS)
    recipes = Recipes(bench)
    recipe = recipes.read(str(bench.root.parent / "night.yaml"))
    found = recipes.run(recipe, recipes.begin(recipe, {}))
    assert found.outcome == "done" and not found.left and value(bench, "laser.shutter") == "open"


def test_outside_of_its_hours_nothing_begins(bench: Bench, night: list[datetime]) -> None:
    night.append(datetime(2026, 11, 24, 12, 0))
    before = bench.observe().known_values
    found = run(bench, STATED + STEPS)
    assert found.exit_code == ExitCode.DENIED and found.acted == 0 and bench.observe().known_values == before
    assert "it is 12:00" in found.diagnostics[0].summary and "22:00 to 06:00" in found.diagnostics[0].summary


def test_when_its_hours_are_over_it_tidies_up_and_leaves_the_bench_as_stated(
    bench: Bench, night: list[datetime], monkeypatch: pytest.MonkeyPatch
) -> None:
    ticks = iter(range(100))
    late = datetime(2026, 11, 25, 6, 1)
    monkeypatch.setattr(guarding, "local_now", lambda: night[0] if next(ticks) < 4 else late)
    found = run(bench, STATED + STEPS)
    assert (found.outcome, found.exit_code) == ("failed", ExitCode.EXPECTATION)
    assert found.at == "3" and "06:01" in found.diagnostics[0].summary  # in the midst of its long wait
    assert (
        value(bench, "p1.angle") == 5 and value(bench, "hwp.angle") == 20 and value(bench, "laser.shutter") == "closed"
    )


@pytest.mark.parametrize("first", ["apply: e1", "set: {laser.shutter: open}"])
def test_no_light_of_a_higher_class_than_stated_comes_out(bench: Bench, night: list[datetime], first: str) -> None:
    if "apply" not in first:
        bench.apply("C1")
        bench.apply(bench.single("laser", "set", shutter="closed"))
    found = run(bench, STATED.replace("3R", "2") + f"steps: [{{{first}}}]\n")
    assert found.exit_code == ExitCode.DENIED and "class 3R" in found.diagnostics[0].summary
    assert value(bench, "laser.shutter") == "closed"


def test_while_such_light_is_out_nothing_begins(bench: Bench, night: list[datetime]) -> None:
    bench.apply("C1")
    found = run(bench, STATED.replace("3R", "2") + STEPS)
    assert found.exit_code == ExitCode.DENIED and found.acted == 0
    assert value(bench, "laser.shutter") == "open"  # it was not begun, so it is not ended


def test_a_condition_that_comes_true_stops_it_before_the_next_step(bench: Bench, night: list[datetime]) -> None:
    stop = STATED.replace("laser.monitor < 1.5", "p1.angle > 4.5")
    found = run(bench, stop + STEPS)
    assert (found.outcome, found.at) == ("failed", "3")
    assert found.diagnostics[0].summary == "the reference is dark" and found.diagnostics[0].source.start.line == 7  # type: ignore[union-attr]
    assert value(bench, "hwp.angle") == 20 and found.left == ("shut", "lamps off", "parked")


def test_what_stops_it_is_measured_for_that_and_again_after_a_while(bench: Bench, night: list[datetime]) -> None:
    bench.apply("C1")
    found = run(bench, STATED.replace("laser.monitor < 1.5", "laser.monitor > 0.1") + STEPS)
    assert found.at == "1" and "laser.monitor = " in found.diagnostics[0].detail
    assert run(bench, STATED + STEPS).outcome == "done"
    assert bench.edge.memory is not None
    intents = [r for r in bench.edge.memory.records() if r.kind == "intent"]
    measured = [r for r in intents if r.data["primitive"] == "measure"]
    assert len(measured) >= 6  # an hour of waiting, each ten minutes


def test_who_sees_nothing_stops(bench: Bench, night: list[datetime]) -> None:
    found = run(bench, STATED.replace("laser.monitor < 1.5", "cam.width.major > 1e6") + STEPS)
    assert found.exit_code == ExitCode.EXPECTATION and "cam.width" in found.diagnostics[0].summary
    assert value(bench, "hwp.angle") == 20


def test_a_lost_goal_stops_it(bench: Bench, night: list[datetime], monkeypatch: pytest.MonkeyPatch) -> None:
    from pico.bench.goals import Goals
    from pico.planning.alignment import Alignment

    lost = Alignment("ly_150_centred", "lost", "somebody moved it")
    monkeypatch.setattr(Goals, "alignments", lambda self: (lost,))
    found = run(bench, STATED.replace("{when: laser.monitor < 1.5, message: the reference is dark}",
                                      "{lost: ly_150_centred}") + STEPS)  # fmt: skip
    assert found.diagnostics[0].summary == "ly_150_centred is lost" and "somebody" in found.diagnostics[0].detail


def test_an_end_that_is_not_reached_is_an_error(
    bench: Bench, night: list[datetime], monkeypatch: pytest.MonkeyPatch
) -> None:
    async def stuck(shutting: Shutting, operation: Operation) -> bool:
        return False

    monkeypatch.setattr(Shutting, "_done", stuck)
    found = run(bench, STATED + STEPS)
    assert found.outcome == "done" and found.exit_code == ExitCode.ERROR and found.left == ("lamps off", "parked")
    assert "laser may emit still" in found.diagnostics[0].summary and found.diagnostics[0].hint


def test_the_edge_ends_it_at_its_latest_end_whatever_its_client_does_and_it_can_go_on(
    bench: Bench, night: list[datetime], monkeypatch: pytest.MonkeyPatch
) -> None:
    judged = guarding.Guard.judge

    def busy(guard: guarding.Guard, doing: Any, step: str) -> None:
        if step == "2":  # the client is busy with this step beyond the hours, and sees nothing of the clock
            night.append(datetime(2026, 11, 25, 6, 0, 1))
            while (terms := bench.wait(bench.edge.unattended())) is None or terms.left is None:
                pass
            night.append(datetime(2026, 11, 25, 23, 0))
        judged(guard, doing, step)

    monkeypatch.setattr(guarding.Guard, "judge", busy)
    found = run(bench, STATED + STEPS)
    assert (found.outcome, found.exit_code) == ("interrupted", ExitCode.EXPECTATION)
    assert "2026-11-25T06:00:00Z" in found.diagnostics[0].summary and found.left == ("shut", "lamps off", "parked")
    assert value(bench, "laser.shutter") == "closed"
    assert "night ended: it was to end" in told_first(bench, bench.observe())[0].summary

    monkeypatch.setattr(guarding.Guard, "judge", judged)
    recipes = Recipes(bench)
    log = recipes.unended()
    again = recipes.run(recipes.taken_up(log), log, unattended=True)
    assert again.outcome == "done" and again.before == 1 and value(bench, "laser.shutter") == "closed"
    opened = [r for r in bench.edge.memory.records() if r.kind == "intent" and r.data["component"] == "laser"]  # type: ignore[union-attr]
    assert [r.data["arguments"].get("to") for r in opened if r.data["primitive"] == "set"][-2:] == ["open", "closed"]


def test_what_interrupts_it_shuts_it_too_and_moves_no_arm(bench: Bench, night: list[datetime]) -> None:
    def stop(path: str, *_: object) -> None:
        if path == "2":
            raise KeyboardInterrupt

    found = run(bench, STATED + STEPS, watching=Watching(ended=stop))
    assert (found.outcome, found.exit_code) == ("interrupted", ExitCode.INTERRUPTED)
    assert "shut" in found.left and value(bench, "laser.shutter") == "closed" and value(bench, "hwp.angle") != 20


@pytest.mark.parametrize(("was", "now", "line", "column", "said"), [
    ("laser_class: 3R", "laser_class: 5", 5, 16, "`5` is no class of lasers"),
    ("22:00", "26:00", 6, 17, "no time of day"), ("22:00", "6:00", 6, 10, "end when they begin"),
    ("laser.monitor < 1.5", "laser.monitr < 1.5", 7, 17, "laser.monitr"),
    ("laser.monitor < 1.5", "laser.monitor", 7, 17, "a number"),
    ("{when: laser.monitor < 1.5,", "{lost: nothing,", 7, 17, "no goal"),
    ("10 min", "10 mm", 8, 10, "`every`"), ("lamps off", "lamp", 9, 23, "no bench is left `lamp`"),
    ("  end: [shut, parked, lamps off]\n", "", 5, 3, "does not state `end`"),
    ("every:", "evry:", 8, 3, "unknown key `evry`"),
])  # fmt: skip
def test_what_is_wrong_in_it_is_said_where_it_stands(
    bench: Bench, was: str, now: str, line: int, column: int, said: str
) -> None:
    path = bench.root.parent / "night.yaml"
    path.write_text(HEAD + STATED.replace(was, now) + STEPS)
    _, found = Recipes(bench).check(str(path))
    assert len(found) == 1 and said in found[0].summary, found
    assert found[0].source and (found[0].source.start.line, found[0].source.start.column) == (line, column)


def test_a_step_that_waits_for_a_person_is_refused_in_it(bench: Bench) -> None:
    path = bench.root.parent / "night.yaml"
    path.write_text(HEAD + STATED + "steps:\n  - prompt: Put the sample in.\n  - {prompt: Look., unattended: skip}\n")
    (found,) = Recipes(bench).check(str(path))[1]
    assert "waits for a person" in found.summary and found.source and found.source.start.line == 11


def test_a_recipe_that_states_nothing_is_refused_where_nobody_is_there(bench: Bench) -> None:
    found = run(bench, STEPS)
    assert (
        found.exit_code == ExitCode.DENIED and "does not state how it runs unattended" in found.diagnostics[0].summary
    )


@pytest.mark.parametrize(("by", "unattended", "allowed"), [("", None, True), ("Ada", True, True), ("Ada", None, False)])
def test_a_laser_that_a_person_armed_to_be_there_does_not_emit_for_nobody(
    by: str, unattended: bool | None, allowed: bool
) -> None:
    licence = Licence(laser_class="3R", by=by, unattended=unattended)
    seen = Observation(backend="sim", observed_at="", time=0.0, components={}, licences={"laser": licence})
    assert (not emits_alone(seen, "laser", "3R", "3R")) == allowed

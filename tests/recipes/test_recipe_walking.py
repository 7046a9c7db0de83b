"""What a recipe asks for, step by step, decided by what it is told alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from asking import asked, read, right
from hypothesis import given
from hypothesis import strategies as st

from pico.diagnostics import ExitCode, PicoError, error
from pico.recipes.walking import Ask, Entered, walk


def measured(value: float) -> Mapping[str, Any]:
    return {"measured": {"cam.power": {"value": value}}, "": value, "sigma": 1.0}


def test_a_product_goes_round_with_the_last_name_fastest() -> None:
    recipe = right(
        "steps:\n- foreach: {a: [1, 2], b: {from: 0, to: 10, step: 5}}\n  steps:\n  - set: {p1.angle: a + b}\n"
    )
    asks, _ = asked(recipe)
    assert [given["p1.angle"] for _, given in asks] == [1, 6, 11, 2, 7, 12]
    assert [path for path, _ in asks][:2] == ["1[1].1", "1[2].1"]


def test_what_is_measured_is_known_by_its_address_and_by_name() -> None:
    recipe = right(
        "steps:\n- {measure: cam.power, as: p}\n- assert: cam.power == p && p.sigma > 0.5\n- let: {q: p * 2}\n"
        "returns: {q: q}\n"
    )
    assert asked(recipe, lambda _: measured(21.0))[1] == {"q": 42.0}


@pytest.mark.parametrize("grows", ["l + l", "l.map(v, v) + l"])
def test_a_list_that_grows_without_end_is_stopped(grows: str) -> None:
    recipe = right(f'steps:\n- let: {{l: "[1]"}}\n- while: "true"\n  most: 200\n  steps:\n  - let: {{l: "{grows}"}}\n')
    _, failed = asked(recipe)
    assert isinstance(failed, PicoError) and failed.diagnostics[0].code in ("bound", "expression")


SCAN = (
    "steps:\n- {scan: {p1.angle: {from: 1, to: 3, step: 1}}, read: cam.power, as: s}\n"
    "returns: {at: s.p1_angle, power: s.cam_power, off: s.cam_power_sigma, part: s.part}\n"
)


@pytest.mark.parametrize(("again", "parts"), [(1.5, [0, 0, 0]), (9.0, [0, 0, 1])])
def test_a_scan_that_was_cut_short_measures_its_last_point_again_and_is_split_where_that_is_another(
    again: float, parts: list[float]
) -> None:
    def answer(ask: Ask) -> Mapping[str, Any]:
        if ask.step is None or ask.step.kind == "set":
            return {}
        value = again if ".again" in ask.path else {"1[1]": 0.0, "1[2]": 1.0, "1[3]": 2.0}[ask.path.partition(".")[0]]
        late = {"taken_up": 1} if ask.path.startswith("1[3]") else {}
        return {"measured": {"cam.power": {"value": value, "sigma": 0.5}}, **late}

    asks, found = asked(right(SCAN), answer)
    assert found == {"at": [1, 2, 3], "power": [0, 1, 2], "off": [0.5] * 3, "part": parts}
    assert asks[-2:] == [("1[3].again.set", {"p1.angle": 2.0}), ("1[3].again.measure", {"of": ("cam.power",)})]
    asks, found = asked(right(SCAN), lambda ask: {k: v for k, v in answer(ask).items() if k != "taken_up"})
    assert found["part"] == [0, 0, 0] and len(asks) == 6


@pytest.mark.parametrize("late", [False, True])
def test_a_scan_that_is_not_required_leaves_out_points_without_a_value(late: bool) -> None:
    def answer(ask: Ask) -> Mapping[str, Any]:
        if ask.step is None or ask.step.kind == "set":
            return {}
        assert ask.given["required"] is False
        point = ask.path.partition(".")[0]
        value = {"1[1]": 0.0, "1[2]": None, "1[3]": 2.0}[point]
        taken = {"taken_up": 1} if late and point == "1[3]" else {}
        return {"measured": {"cam.power": {"value": value, "sigma": None if value is None else 0.5}}, **taken}

    _, found = asked(right(SCAN.replace("as: s", "as: s, required: false")), answer)
    assert found == {"at": [1, 3], "power": [0, 2], "off": [0.5] * 2, "part": [0, 0]}


def test_whether_a_scan_is_required_is_written_out() -> None:
    _, wrong = read(SCAN.replace("as: s", "as: s, required: 1 > 2"))
    assert [one.partition(": ")[2] for one in wrong] == ["type: `required` of a scan is true or false, written out"]


def test_names_of_the_bench_are_asked_for_as_they_are_then() -> None:
    recipe = right("steps:\n- if: p1.angle > 45\n  then: [{set: {p1.angle: 0}}]\n  else: [{set: {p1.angle: 90}}]\n")
    asks, _ = asked(recipe, lambda ask: {"p1.angle": 50.0} if ask.names else {})
    assert asks == [("1?", ("p1.angle",)), ("1.1", {"p1.angle": 0.0})]


def test_a_loop_ends_when_its_condition_does_or_fails_at_its_bound() -> None:
    recipe = right("steps:\n- measure: cam.power\n- while: cam.power < 3\n  most: 5\n  steps: [{measure: cam.power}]\n")
    readings = iter([0.0, 1.0, 2.0, 3.0])
    asks, _ = asked(recipe, lambda _: measured(next(readings)))
    assert len(asks) == 4
    asks, failed = asked(recipe, lambda _: measured(0.0))
    assert len(asks) == 6 and isinstance(failed, PicoError) and failed.exit_code == ExitCode.EXPECTATION


def test_a_failed_step_brings_the_last_steps_and_its_error_comes_out() -> None:
    recipe = right("steps:\n- apply: e1\n- apply: main\nfinally:\n- set: {laser.shutter: closed}\n")

    def fail(ask: Ask) -> Mapping[str, Any]:
        if ask.path == "1":
            raise PicoError(error("jammed", "it jams"))
        return {}

    asks, failed = asked(recipe, fail)
    assert [path for path, _ in asks] == ["1", "finally.1"]
    assert isinstance(failed, PicoError) and failed.diagnostics[0].code == "jammed"


def test_an_assertion_ends_it_with_its_message() -> None:
    recipe = right("steps:\n- measure: cam.power\n- assert: cam.power > 3\n  message: only ${cam.power}\n")
    _, failed = asked(recipe, lambda _: measured(2.0))
    assert isinstance(failed, PicoError) and failed.diagnostics[0].summary == "only 2"
    assert failed.exit_code == ExitCode.EXPECTATION


def test_a_called_recipe_knows_only_what_it_is_told() -> None:
    other = "parameters: {t: 1}\nsteps: [{let: {mine: t}}]\nreturns: {t: mine}\n"
    recipe = right(
        "steps:\n- let: {mine: 7}\n- {call: b, with: {t: mine + 1}, as: c}\nreturns: {a: mine, b: c.t}\n", {"b": other}
    )
    assert asked(recipe)[1] == {"a": 7.0, "b": 8.0}


def test_loops_that_run_away_stop() -> None:
    inner = "  steps:\n  - foreach: {b: {from: 1, to: 200, step: 1}}\n    steps: [{let: {x: b}}]\n"
    recipe = right("steps:\n- foreach: {a: {from: 1, to: 200, step: 1}}\n" + inner)
    _, failed = asked(recipe)
    assert isinstance(failed, PicoError) and failed.diagnostics[0].code == "bound"


def test_a_product_that_runs_away_is_refused_before_it_is_made() -> None:
    lists = "a: {from: 1, to: 9000, step: 1}, b: {from: 1, to: 9000, step: 1}, c: {from: 1, to: 9000, step: 1}"
    _, failed = asked(right(f"steps:\n- foreach: {{{lists}}}\n  steps: [{{let: {{x: a}}}}]\n"))
    assert isinstance(failed, PicoError) and "729000000000 times" in failed.diagnostics[0].summary


def test_an_expression_that_runs_away_stops() -> None:
    text = "l.map(a, l.map(b, l.map(c, l.map(d, a + b + c + d)[0])[0])[0])[0]"
    recipe = right(f"steps:\n- let: {{l: 'range(1, 60, 1)'}}\n- let: {{x: '{text}'}}\n")
    _, failed = asked(recipe)
    assert isinstance(failed, PicoError) and "10,000 steps" in failed.diagnostics[0].summary


def test_ahead_of_time_steps_that_depend_on_a_measurement_are_entered_as_such() -> None:
    recipe = right(
        "steps:\n- {measure: cam.power, as: now}\n- let: {half: now / 2}\n- if: now > 1\n  then:\n"
        "  - foreach: {t: [1, 2]}\n    steps: [{set: {p1.angle: t}}]\n  else: [{wait: 1}]\n- set: {p1.angle: half}\n"
        "- while: now > 2\n  most: 3\n  steps: [{measure: cam.power, as: now}]\n- assert: now > 1\n- wait: 1\n"
    )
    entered: list[Entered] = []
    steps = walk(recipe, {}, entered.append, ahead=lambda _: None)
    next(steps)
    with pytest.raises(StopIteration):
        while True:
            steps.send({})
    assert [e.path for e in entered if e.known] == ["1", "7"]
    assert [(e.path, e.depth) for e in entered if not e.known] == [
        ("2", 0), ("3", 0), ("3.1", 1), ("3.1[1].1", 2), ("3.else.1", 1), ("4", 0), ("5", 0), ("5[1].1", 1), ("6", 0),
    ]  # fmt: skip


def test_who_watches_hears_of_the_numbers_of_a_condition() -> None:
    entered: list[Entered] = []
    recipe = right(
        "steps:\n- let: {a: 2, l: '[1, 2]'}\n- if: a > sum(l)\n  then: [{wait: 1}]\n- while: a < 3\n  most: 2\n"
        "  steps: [{let: {a: a + 1}}]\n- assert: a == 3\n"
    )
    with pytest.raises(StopIteration):
        next(walk(recipe, {}, entered.append))
    assert [dict(e.values) for e in entered] == [
        {"a": 2, "l": [1, 2]}, {"a": 2, "holds": False}, {"a": 2}, {"a": 3}, {"a": 3, "holds": True},
    ]  # fmt: skip


def test_ahead_of_time_what_depends_on_measurements_is_left_out() -> None:
    recipe = right(
        "steps:\n- measure: cam.power\n- let: {p: cam.power}\n- if: p > 3\n  then: [{set: {p1.angle: 1}}]\n"
        "- set: {p1.angle: p}\n- set: {p1.angle: 2}\n"
    )
    steps, paths = walk(recipe, {}, ahead=lambda _: None), []
    try:
        ask = next(steps)
        while True:
            paths.append(ask.path)
            ask = steps.send({})
    except StopIteration:
        pass
    assert paths == ["1", "5"]


@pytest.mark.parametrize(
    "block",
    [
        "- if: p > 3\n  then: [{let: {l: 'l + [p]'}}]\n",
        "- foreach: {t: [1, 2]}\n  steps: [{if: p > 3, then: [{let: {l: 'l + [p]'}}]}]\n",
        "- foreach: {t: 'range(0, p, 1)'}\n  steps: [{let: {l: 'l + [t]'}}]\n",
        "- while: p > 3 && size(l) < 1\n  most: 9\n  steps: [{let: {l: 'l + [p]'}}]\n",
    ],
)
def test_ahead_of_time_nobody_knows_what_a_block_gives_that_depends_on_a_measurement(block: str) -> None:
    text = f"steps:\n- let: {{l: '[]'}}\n- measure: cam.power\n- let: {{p: cam.power}}\n{block}- assert: size(l) == 1\n"
    steps = walk(right(text), {}, ahead=lambda _: None)
    with pytest.raises(StopIteration):
        next(steps)
        while True:
            steps.send({})


@given(st.lists(st.floats(-50, 50), max_size=12), st.data())
def test_told_again_what_came_of_each_step_it_goes_the_same_way(readings: list[float], data: st.DataObject) -> None:
    """A log of any length, told again, leads to the step that was under way."""
    recipe = right(
        "steps:\n- measure: cam.power\n- let: {n: 0}\n- while: cam.power < 10 && n < 5\n  most: 9\n  steps:\n"
        "  - if: cam.power < 0\n    then: [{set: {p1.angle: 'n * 2'}}]\n  - let: {n: n + 1}\n  - measure: cam.power\n"
        "- foreach: {t: [1, 2]}\n  steps: [{set: {p1.angle: t + n}}]\n"
    )
    values = [*readings, *[100.0] * 20]

    def answers() -> Any:
        left = iter(values)
        return lambda ask: measured(next(left)) if ask.step and ask.step.kind == "measure" else {}

    first, _ = asked(recipe, answers())
    log: dict[str, Any] = {}
    answer = answers()
    asked(recipe, lambda ask: log.setdefault(ask.path, answer(ask)))
    cut = data.draw(st.integers(0, len(first)))
    known = {path: log[path] for path, _ in first[:cut]}
    left = iter([log[path] for path, _ in first[cut:]])
    again, _ = asked(recipe, lambda ask: known[ask.path] if ask.path in known else next(left))
    assert again == first


# recipes at random: what passes the check runs without a mistake of kind, name or capability

NUMBERS = st.integers(0, 90).map(str)


@st.composite
def steps(draw: st.DrawFn, names: tuple[str, ...] = (), depth: int = 0, measured: bool = False) -> str:
    """Return some steps as YAML in flow style; `names` are numbers."""
    found, known = [], list(names)
    for _ in range(draw(st.integers(1, 4))):
        terms = st.one_of(NUMBERS, st.sampled_from([*known, "p2.angle"]))
        if measured:
            terms = st.one_of(terms, st.just("cam.power"))
        number = st.one_of(terms, st.builds("{} {} {}".format, terms, st.sampled_from("+-*"), terms))
        kind = draw(st.integers(0, 6 if depth < 3 else 3))
        if kind == 0:
            found.append(f'{{set: {{p1.angle: "{draw(number)}"}}}}')
        elif kind == 1:
            found.append("{measure: cam.power}")
            measured = True
        elif kind == 2:
            name = draw(st.sampled_from(["a", "b", "c"]))
            found.append(f'{{let: {{{name}: "{draw(number)}"}}}}')
            known.append(name)
        elif kind == 3:
            found.append(draw(st.sampled_from(["{apply: e1}", "{wait: 1 s}", "{move: {p2: home}}"])))
        elif kind == 4:
            name = draw(st.sampled_from(["t", "u"]))
            inner = draw(steps((*known, name), depth + 1, measured))
            found.append(f"{{foreach: {{{name}: [1, 2]}}, steps: [{inner}]}}")
        elif kind == 5:
            condition = f"{draw(number)} < {draw(number)}"
            then, other = (draw(steps(tuple(known), depth + 1, measured)) for _ in range(2))
            found.append(f'{{if: "{condition}", then: [{then}], else: [{other}]}}')
        else:
            inner = draw(steps(tuple(known), depth + 1, measured))
            found.append(f'{{while: "{draw(number)} < 5", most: 3, steps: [{inner}]}}')
    return ", ".join(found)


@given(steps(), st.data())
def test_what_passes_the_check_runs_without_a_mistake(text: str, data: st.DataObject) -> None:
    recipe, found = read(f"steps: [{text}]\n")
    assert not found and recipe is not None, found

    def answer(ask: Ask) -> Mapping[str, Any]:
        if ask.names:
            return dict.fromkeys(ask.names, 12.0)
        return measured(data.draw(st.floats(-100, 100))) if ask.step and ask.step.kind == "measure" else {}

    _, ended = asked(recipe, answer)
    if isinstance(ended, PicoError):
        assert {d.code for d in ended.diagnostics} == {"bound"}


BREAKING = (
    ("cam.power", "cam.pwoer"), ("p1.angle", "p1.angel"), ("p2.angle", "p9.angle"), ("measure", "mesure"),
    ("most: 3", "most: x"), ("steps: [{", "steps: [{zzz: 1, "), ("[1, 2]", "nowhere"), ("e1}", "e77}"), ("home", "hme"),
    ("1 s", "1 kg"), ("let: {", "let: {cam: "),
)  # fmt: skip


@given(steps(), st.data())
def test_what_was_broken_is_told_with_its_line(text: str, data: st.DataObject) -> None:
    whole = f"steps: [{text}]\n"
    able = [pair for pair in BREAKING if pair[0] in whole]
    if not able:
        return
    old, new = data.draw(st.sampled_from(able))
    _, found = read(whole.replace(old, new, 1))
    assert found and not any(said.startswith("-:") for said in found)


@pytest.mark.parametrize("text", ["[", "- a", "steps: *x\n", "steps: [" * 40, "\x00"])
def test_what_is_no_yaml_is_told(text: str) -> None:
    assert read(text)[1]


def test_steps_count_from_where_a_part_is_by_then() -> None:
    text = "parameters: {tilt: 4}\nsteps:\n- set: {p1.angle: +=5, hwp.angle: '-= tilt / 2', p2.angle: -=90 mrad}\n"
    recipe = right(text + "- move: {p2: {x: +=10, yaw: -= tilt}}\n")
    here = {"p1.angle": 3.0, "hwp.angle": 7.0, "p2.angle": 90.0, "p2.pose.x": 500.0, "p2.pose.yaw": 30.0}
    asks, _ = asked(recipe, lambda ask: {name: here[name] for name in ask.names})
    done = {path: one for path, one in asks if isinstance(one, dict)}
    assert done["1"]["p1.angle"] == 8 and done["1"]["hwp.angle"] == 5
    assert abs(done["1"]["p2.angle"] - (90 - 5.1566)) < 1e-3
    assert done["2"] == {"p2": {"x": 510.0, "yaw": 26.0}}


def test_a_step_that_makes_no_sense_is_told_at_its_place() -> None:
    for step, said in (("+=5 kg", "mass"), ("+= tlit", "tlit"), ("-=", "is empty")):
        _, found = read(f"steps:\n- set: {{p1.angle: '{step}'}}\n")
        assert found and found[0].startswith("2: ") and said in found[0], (step, found)

"""Single sentences that said what a person could not use, or what was not so."""

from __future__ import annotations

from pathlib import Path

from commanding import Pico, edit


def test_a_second_setting_after_the_first_is_called_so(shel: Path, pico: Pico) -> None:
    said = pico("set", "p2.angle=90", "p1.angle+=5", "--yes").err
    assert "a second setting; set one component at a time" in said and "not a unit" not in said, said


def test_an_index_in_braces_is_to_be_quoted(shel: Path, pico: Pico) -> None:
    head = "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: one, title: One}\nsteps:\n"
    (shel / "recipes/one.yaml").write_text(f"{head}  - {{measure: p1.angle, as: p}}\n  - let: {{first: p[0]}}\n")
    said = " ".join(pico("recipe", "check", "one").err.split())
    assert 'quote a value with `[` or `{` in it: `{a: "l[0]"}`' in said, said


def test_a_plan_that_puts_nothing_aside_says_so(shel: Path, pico: Pico) -> None:
    edit(shel / "state/table.yaml", "components:\n", "components:\n")
    said = pico("plan", "e1").out
    assert "no part is put aside on the way" in said and "0 staged" not in said, said


def test_a_part_within_its_tolerance_is_off_by_so_much(shel: Path, pico: Pico) -> None:
    assert pico("apply", "--yes").code == 0
    assert pico("sim", "nudge", "p1", "--dx", "0.15", "--dyaw", "-0.08").code == 0
    row = next(line for line in pico("status", "--all").out.splitlines() if line.startswith("p1 "))
    assert "(0.15 mm, 0.08° off)" in row and "±" not in row, row


def test_a_measured_number_has_no_fields_and_is_called_the_value_itself(shel: Path, pico: Pico) -> None:
    head = "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: one, title: One}\nsteps:\n"
    (shel / "recipes/one.yaml").write_text(f"{head}  - {{measure: p1.angle, as: p}}\n  - assert: p.value < 3\n")
    said = pico("recipe", "check", "one").err
    assert "`p` is the value itself and has no `.value`" in said and "did you mean" not in said, said

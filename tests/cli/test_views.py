"""Text as it is read: carets, counts, numbers, columns."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import pytest
from commanding import Typed
from hypothesis import given
from hypothesis import strategies as st
from pico_cli.views import diagnostics as view
from pico_cli.views import log
from pico_cli.views.measured import line
from pico_cli.views.style import columns, count, folded, listed, number, paint, plain, seconds, shorten, width

from pico.diagnostics import PicoError, Position, SourceRange, error, warning
from pico.history.git.commit import Commit
from pico.history.lab.folder import CommitEntry
from pico.model.plan import LabRef
from pico.model.trace.run import Run


def at(line: int, start: int, end: int, snippet: str) -> SourceRange:
    return SourceRange("state/table.yaml", Position(line, start), Position(line, end), snippet)


def test_a_diagnostic_shows_the_line_with_a_caret_and_what_would_be_right() -> None:
    found = error(
        "unit", "exposure of cam is a time, not a mass", hint="for example `2` or `2 ms`",
        label="expected milliseconds", source=at(31, 15, 19, "    exposure: 2 kg"),
    )  # fmt: skip
    assert plain(view.text([found])) == (
        "error[unit]: exposure of cam is a time, not a mass\n"
        "  --> state/table.yaml:31:15\n"
        "   |\n"
        "31 |     exposure: 2 kg\n"
        "   |               ^^^^ expected milliseconds\n"
        "   |\n"
        "   = help: for example `2` or `2 ms`"
    )


def test_an_error_that_nobody_catches_says_what_would_be_right() -> None:
    found = PicoError([error("usage", "set of p1 takes no `angel`", hint="did you mean `angle`?"), error("x", "no")])
    assert str(found) == "set of p1 takes no `angel` (did you mean `angle`?); no"


def test_numbers_of_a_kernel_have_their_own_units_whatever_order_a_document_has_them_in() -> None:
    numbers = {"angle": 2.0, "major": 9.0, "minor": 8.0, "peak": 5.0, "x": 1.0, "y": 3.0}
    found = {"value": numbers, "unit": "um, um, um, um, deg, count", "kernel": "image | gaussian_fit"}
    assert line(found) == "x 1 um, y 3 um, major 9 um, minor 8 um, angle 2 deg, peak 5 count"
    assert line({**found, "kernel": "image | nobody knows it"}).startswith("angle 2 um"), "as it came"


@pytest.mark.parametrize(("value", "sigma", "unit", "shown"), [
    (0.00123, None, "V", "1.23 mV"), (-0.00123, 0.00002, "V", "-1.230 mV ± 0.020 mV"), (2.5, None, "V", "2.5 V"),
    (0.0, None, "V", "0 V"), (4.5e-8, None, "A", "45 nA"), (0.0, 0.002, "V", "0.0 mV ± 2.0 mV"),
    (1.5, 0.01, "V", "1.500 ± 0.010 V"),
])  # fmt: skip
def test_small_volts_keep_their_digits(value: float, sigma: float | None, unit: str, shown: str) -> None:
    assert line({"value": value, "sigma": sigma, "unit": unit}) == shown


def test_errors_stand_last_and_are_counted() -> None:
    text = plain(view.text([error("a", "one"), warning("b", "two"), error("c", "three")]))
    assert text.splitlines()[0] == "warning[b]: two"
    assert text.splitlines()[-1] == "2 errors, 1 warning"


def test_a_long_line_is_cut_around_its_caret() -> None:
    snippet = "x" * 300 + "HERE" + "y" * 300
    lines = plain(view.text([error("a", "far out", source=at(1, 301, 305, snippet))])).splitlines()
    line, caret = lines[3], lines[4]
    assert max(map(len, lines)) <= 100
    assert line[caret.index("^") : caret.rindex("^") + 1] == "HERE"


@given(st.text(max_size=200), st.integers(1, 250), st.integers(0, 50))
def test_no_source_line_breaks_the_view(snippet: str, start: int, length: int) -> None:
    text = view.text([error("a", "odd", label="here", source=at(3, start, start + length, snippet))])
    assert "error[a]: odd" in plain(text)
    assert all(c.isprintable() or c == "\n" for c in plain(text))


@pytest.mark.parametrize(
    ("value", "text"), [(420.0, "420"), (12.5, "12.5"), (0.004, "0"), (-0.001, "0"), (-30.0, "-30"), (100.0, "100")]
)
def test_numbers_have_no_needless_zeros(value: float, text: str) -> None:
    assert number(value) == text


def test_many_runs_of_a_commit_are_summed_up_in_a_log() -> None:
    known: dict[str, Any] = {"lab": LabRef(name="shel", digest=""), "state_before": "", "state_after": "", "plan": ""}
    one = Run(id="r1", evidence="kinematic", started_at="", outcome="done", seconds=4.0, tally={"done": 2}, **known)
    cut = replace(one, outcome="interrupted", tally={"done": 1, "skipped": 3})
    commit = Commit(
        id="f" * 40, parents=(), summary="s", message="s", author="A", time=datetime(2026, 1, 1, tzinfo=UTC)
    )
    assert log.proofs(CommitEntry(commit=commit, runs=(one, cut))) == [
        "2 operations done, 4.0 s", "interrupted, 1 operation done, 3 skipped, 4.0 s",
    ]  # fmt: skip
    many = CommitEntry(commit=commit, runs=(*[one] * 94, cut))
    summed = "95 runs, 1 interrupted, 189 operations done, 3 skipped, 6 min 20 s"
    assert log.proofs(many) == [summed] and log.evidence_lines(many, 8) == [f"  {summed}: `pico show fffffff`"]
    assert len(log.evidence_lines(many)) == 95


def test_words_agree_with_their_number() -> None:
    assert (count(1, "move"), count(2, "move"), count(0, "move")) == ("1 move", "2 moves", "0 moves")
    assert count(2, "step by hand", "steps by hand") == "2 steps by hand"
    assert listed(["a"]) == "a"
    assert listed(["a", "b", "c"]) == "a, b and c"
    assert listed([str(i) for i in range(9)], 3) == "0, 1, 2 and 6 more"
    assert (seconds(0.4), seconds(41.26), seconds(125)) == ("0.4 s", "41.3 s", "2 min 05 s")


def test_columns_align_whatever_their_color() -> None:
    lines = columns([[paint("red", "a"), "x"], ["bbb", "y"]])
    assert [plain(line) for line in lines] == ["a    x", "bbb  y"]


@given(st.text(alphabet=st.characters(blacklist_categories=["Cs", "Cc"]), max_size=40), st.integers(1, 30))
def test_a_shortened_text_fits(text: str, room: int) -> None:
    assert width(shorten(text, room)) <= room


def test_what_is_cut_is_cut_after_a_word() -> None:
    assert shorten("p2 moved 5 mm, lx_125 and ly_150", 26) == "p2 moved 5 mm, lx_125…"
    assert shorten("p2 moved 5 mm, lx_125 and ly_150", 20) == "p2 moved 5 mm…"
    assert shorten("a" * 30, 10) == "a" * 9 + "…"


@given(st.text("ab ✓\n", max_size=300), st.integers(10, 100))
def test_a_terminal_breaks_lines_between_words_and_loses_none(text: str, columns: int) -> None:
    lines = folded(text, columns).split("\n")
    assert " ".join(lines).split() == text.split()
    assert all(len(line) <= columns or " " not in line.strip() for line in lines)
    assert plain(folded(paint("red", "a b") + " c", 3)) == "a b\nc"


def test_messages_are_wrapped_for_a_terminal_and_left_whole_for_a_pipe(monkeypatch: pytest.MonkeyPatch) -> None:
    long = [error("a", "what is wrong " * 12, detail="where " * 40, hint="what would be right " * 12)]
    assert len(view.text(long).splitlines()) == 3
    monkeypatch.setattr("sys.stderr", Typed())
    monkeypatch.setattr("sys.stdout", Typed())
    monkeypatch.setenv("COLUMNS", "80")
    assert max(len(plain(line)) for line in view.text(long).splitlines()) <= 80
    assert plain(view.text(long)).startswith("error[a]: what is wrong what")

"""Plans for some of the components, and for less time: what the screens say, and what the bench then is."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import pytest
from commanding import Pico
from pico_cli.views.plan import header
from pico_cli.views.style import ago

from pico.model.plan import plan_from_json


def components(answer: object) -> set[str]:
    return {o["component"] for o in answer["operations"] if o["reason"]["kind"] not in ("parked", "interlock")}  # type: ignore[index]


def test_a_plan_for_one_component_says_that_the_bench_will_not_be_whole(shel: Path, pico: Pico) -> None:
    answer = pico("plan", "e1", "--", "p2")
    assert answer.code == 0
    assert " · only p2 · " in answer.out
    assert "only p2: the bench will not equal e1" in answer.out
    assert "pico apply e1 -- p2" in answer.out
    assert "lx_125" in answer.err and "warning[left]" in answer.err
    assert components(pico("plan", "e1", "--json", "--", "p2").data) == {"p2"}


def test_what_is_excluded_stays_and_is_named(shel: Path, pico: Pico) -> None:
    answer = pico("plan", "e1", "--exclude", "p2", "--exclude", "hwp", "--json").data
    assert components(answer) == {"cam", "laser", "p1", "lx_125", "ly_150"}
    assert answer["target"]["exclude"] == ["hwp", "p2"]
    assert "without hwp and p2: the bench will not equal" in pico("plan", "--exclude", "p2", "--exclude", "hwp").out


def test_a_partial_apply_is_done_and_says_what_still_differs(shel: Path, pico: Pico) -> None:
    answer = pico("apply", "e1", "--auto-approve", "--", "p2")
    assert answer.code == 0, answer
    assert "As asked, only p2. The bench does not equal e1: cam, hwp, lx_125, ly_150 and p1 still differ" in answer.out
    again = pico("plan", "e1", "--detailed-exitcode", "--", "p2")
    assert again.code == 0
    assert "Nothing to do (only p2)" in again.out
    assert pico("plan", "e1", "--detailed-exitcode").code == 2


def test_the_last_missing_component_makes_the_bench_whole(shel: Path, pico: Pico) -> None:
    pico("apply", "e1", "--exclude", "p2", "--auto-approve")
    assert "only p2: the bench will equal e1" in pico("plan", "e1", "--", "p2").out
    assert "nothing else differs from e1" in pico("apply", "e1", "--auto-approve", "--", "p2").out
    assert pico("plan", "e1", "--detailed-exitcode").code == 0


def test_a_saved_plan_keeps_its_scope_and_takes_no_other(shel: Path, pico: Pico) -> None:
    pico("plan", "e1", "--out", "p2.plan", "--", "p2")
    assert " · only p2 · " in pico("show", "p2.plan").out
    refused = pico("apply", "p2.plan", "--auto-approve", "--", "p1")
    assert refused.code == 1 and "is a saved plan" in refused.err
    assert pico("apply", "p2.plan", "--auto-approve").code == 0


def test_less_time_may_be_preferred(shel: Path, pico: Pico) -> None:
    fewest, shortest = (pico("plan", "e1", "--prefer", p, "--json").data for p in ("fewest-moves", "shortest-time"))
    assert shortest["makespan"] <= fewest["makespan"] + 1e-6


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--prefer", "fastest"], "--prefer can't be `fastest`"),
        (["--", "p3"], "no component `p3`"),
        (["--exclude", "p2", "--", "p2"], "both asked for and excluded"),
    ],
)
def test_mistakes_are_named(shel: Path, pico: Pico, options: list[str], said: str) -> None:
    for command in (["plan", "e1"], ["apply", "e1", "--auto-approve"]):
        answer = pico(*command, *options)
        assert answer.code == 1
        assert said in answer.err


def test_the_header_says_when_the_bench_was_seen(shel: Path, pico: Pico) -> None:
    pico("plan", "e1", "--out", "e1.plan")
    plan = plan_from_json((shel / "e1.plan").read_text())
    seen = datetime.fromisoformat(plan.base.observed_at)
    assert header(plan, now=seen).endswith(" · seen just now")
    assert header(plan, now=seen.replace(year=seen.year + 1)).endswith("d ago")


@pytest.mark.parametrize(
    ("now", "words"),
    [("12:00:09", "just now"), ("12:00:40", "40 s ago"), ("12:03:59", "3 min ago"), ("14:59:00", "2 h ago")],
)
def test_how_long_ago(now: str, words: str) -> None:
    then = datetime.fromisoformat(f"2026-01-01T{now}").replace(tzinfo=UTC)
    assert ago("2026-01-01T12:00:00+00:00", then) == words
    assert ago("2026-01-01T12:00:00Z", then) == words


def test_names_after_two_dashes_are_what_a_plan_is_for(shel: Path, pico: Pico) -> None:
    answer = pico("plan", "e1", "--", "p2", "p1.angle")
    assert answer.code == 0 and " · only p1.angle and p2 · " in answer.out
    assert "`pico apply e1 -- p2 p1.angle`" in answer.out
    assert "`pico plan e1 --out e1.plan -- p2 p1.angle`" in answer.out
    assert "lx_125, ly_150, p1.pose" in answer.err
    assert pico("plan", "--json", "--", "p2").data["target"]["only"] == ["p2"]
    assert "revision" not in pico("plan", "--json", "--", "p2").data["target"]


def test_the_rest_of_a_component_stays_as_it_stands(shel: Path, pico: Pico) -> None:
    manifest = (shel / "state" / "table.yaml").read_text()
    pico("apply", "main", "--auto-approve")
    answer = pico("apply", "e1", "--auto-approve", "--", "p2.pose")
    assert answer.code == 0
    assert "The bench does not equal e1: lx_125, ly_150 and p1 still" in answer.out
    assert "keep it: `pico checkout e1 -- p2.pose`" in answer.out and "`pico undo`" in answer.out
    assert pico("get", "p2", "--json").data["values"]["pose"]["value"]["yaw"] == pytest.approx(30)
    assert (shel / "state" / "table.yaml").read_text() == manifest
    assert pico("undo", "--auto-approve").code == 0
    assert pico("plan", "main", "--detailed-exitcode").code == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["plan", "e1", "--", "p3"], "no component `p3`"),
        (["plan", "e1", "--", "p2.angel"], "did you mean `angle`?"),
        (["plan", "e1", "--", "p2.slot"], "name it as `pose`"),
        (["plan", "e1", "--", "--exact"], "options go before `--`"),
        (["plan", "e1", "p2"], "components go after `--`"),
        (["plan", "p2"], "p2 is a component, and goes after `--`"),
        (["apply", "e1.plan", "--", "p2"], "is a saved plan"),
    ],
)
def test_mistakes_after_two_dashes_are_named(shel: Path, pico: Pico, words: list[str], said: str) -> None:
    pico("plan", "e1", "--out", "e1.plan")
    answer = pico(*words)
    assert answer.code == 1 and said in answer.err

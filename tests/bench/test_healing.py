"""What a watch heals, how often, and what it says of what it leaves."""

from __future__ import annotations

from collections.abc import Collection

import pytest

from pico.bench.drifting.drift import Drift, Drifted
from pico.bench.drifting.healing import Healing
from pico.diagnostics import PicoError, error
from pico.model.diff import Change
from pico.model.lab import HealLimit
from pico.model.trace.report import RunReport


def drifted(*names: str, held: str = "", by: str = "person", text: str = "moved 5 mm") -> Drifted:
    found = [Drift(change=Change(component=n, tunable="pose", text=text), by=by) for n in names]  # type: ignore[arg-type]
    return Drifted(head="main", observed_at="", beyond=tuple(found), held=held)


class Bench:
    """A bench whose clock stands still until it is set on, and which heals as it is told to."""

    def __init__(self, limit: HealLimit = HealLimit()) -> None:  # noqa: B008
        self.now, self.runs, self.fails, self.left = 0.0, 0, False, list[Collection[str]]()
        self.healing = Healing(self.heal, limit, lambda: self.now)

    def heal(self, found: Drifted, leave: Collection[str]) -> RunReport | None:
        self.left.append(set(leave))
        if self.fails:
            raise PicoError(error("held", "p2 cannot be reached"))
        self.runs += 1
        return RunReport(run="r", goal="HEAD", outcome="done", done=1)

    def look(self, found: Drifted, minutes: float = 0.0) -> str:
        self.now += 60 * minutes
        return self.healing.after(found)


def test_the_same_drift_after_a_success_is_healed_again() -> None:
    bench = Bench()
    assert bench.look(drifted("p2")) == "healed: p2, 1 operation"
    assert bench.look(drifted()) == ""
    assert bench.look(drifted("p2")) == "healed: p2, 1 operation"


def test_a_part_that_drifts_too_often_is_left_and_that_is_said_once() -> None:
    bench = Bench(HealLimit(times=2, minutes=5))
    for _ in range(2):
        assert bench.look(drifted("p2"), 1) == "healed: p2, 1 operation"
    said = bench.look(drifted("p2"), 1)
    assert said.startswith("healed p2 2 times in 5 min; stopped healing it") and bench.runs == 2
    assert bench.look(drifted("p2"), 1) == ""
    assert bench.look(drifted("p1", "p2"), 1) == "healed: p1, 1 operation" and bench.left[-1] == {"p2"}
    assert bench.look(drifted("p2"), 60) == "" and bench.runs == 3, "it stays stopped"


def test_what_drifts_rarely_is_healed_for_ever() -> None:
    bench = Bench(HealLimit(times=2, minutes=5))
    assert {bench.look(drifted("p2"), 4) for _ in range(6)} == {"healed: p2, 1 operation"}


def test_what_could_not_be_healed_is_tried_again_only_when_it_drifts_on_or_once_more() -> None:
    bench = Bench()
    bench.fails = True
    assert bench.look(drifted("p2")) == "not healed: p2 cannot be reached"
    bench.fails = False
    assert bench.look(drifted("p2")) == "" and bench.runs == 0
    assert bench.look(drifted("p2", text="moved 9 mm")) == "healed: p2, 1 operation"
    bench.fails = True
    bench.look(drifted("p2"))
    bench.fails = False
    bench.look(drifted())
    assert bench.look(drifted("p2")) == "healed: p2, 1 operation"


def test_what_is_not_healed_is_said_each_time_that_it_begins() -> None:
    bench = Bench()
    held = drifted("p2", held="somebody is at the table")
    assert bench.look(held) == "not healed: somebody is at the table"
    assert bench.look(held) == ""
    assert bench.look(drifted("p2")) == "healed: p2, 1 operation"
    assert bench.look(held) == "not healed: somebody is at the table"
    assert bench.look(drifted("p1", by="operation")) == "left as it is: p1, set by an operation"


def test_a_limit_allows_something() -> None:
    with pytest.raises(ValueError, match="heal_limit"):
        HealLimit(times=0)

"""Which run an undo takes back: the rule, case by case, over a journal that is made up.

The rule: the last run that left the bench otherwise than it found it, or that was cut short; runs that only emptied
hands are none of them, and belong to the one that they tidied up after. A run of another person takes a word more.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import pytest
from laser_lab import bench, set_to

from pico.bench.undo.choice import begun_by, chosen, document_of
from pico.diagnostics import PicoError
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.record import as_json
from pico.runs.journal import JournalRecord, RunRecord, Success, Unsettled

SETUP = bench()


@dataclass(frozen=True)
class Made:
    """A run that sets the exposure of `cam` from one value to another. `kinds`: what the journal has of that; `looked`:
    whether the bench was observed afterwards."""

    run: str
    before: float = 1.0
    after: float = 2.0
    cause: str | None = None
    of: str | None = None
    outcome: Any = "done"
    operator: str = "ada"
    kinds: tuple[Any, ...] = ("intent", "started", "done")
    looked: bool = True

    def records(self) -> Iterator[JournalRecord]:
        operation = as_json(set_to("cam", "exposure", self.after))
        for kind in self.kinds:
            yield JournalRecord(
                seq=1, key=f"{self.run}/op1/1", kind=kind, component="cam", digest="", token=1, at="",
                data=operation if kind == "intent" else {},
            )  # fmt: skip

    def document(self) -> str:
        target = Target(cause=self.cause, of=self.of)  # type: ignore[arg-type]
        base = Base(state={"cam": {"exposure": self.before}})
        lab = LabRef(name="minimal", digest="")
        return Plan(lab=lab, backend="sim", fidelity="kinematic", base=base, target=target).sealed().to_json()

    def seen(self) -> Mapping[str, Any] | None:
        values = {"exposure": {"value": self.after}}
        return {"components": {"cam": {"values": values}}} if self.looked else None


@dataclass(frozen=True)
class Remembered:
    """The memory of a bench that has had some runs, the first one first."""

    made: tuple[Made, ...]
    by_id: dict[str, Made] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.by_id.update({one.run: one for one in self.made})

    def runs(self) -> tuple[RunRecord, ...]:
        return tuple(
            RunRecord(run=one.run, plan="", holder="pico apply", started_at=f"2026-11-24T12:0{n}:00Z",
                      outcome=one.outcome, number=n)
            for n, one in enumerate(self.made, 1)
        )  # fmt: skip

    def last(self) -> RunRecord | None:
        return self.runs()[-1]

    def moving(self) -> frozenset[str]:
        return frozenset(one.run for one in self.made if "started" in one.kinds)

    def document(self, run: str) -> str | None:
        return self.by_id[run].document()

    def about(self, run: str) -> tuple[tuple[Mapping[str, Any], ...], Mapping[str, Any] | None]:
        return ({"operator": self.by_id[run].operator},), self.by_id[run].seen()

    def records(self, *, run: str | None = None, key: str | None = None) -> tuple[JournalRecord, ...]:
        return tuple(record for one in self.made if run in (None, one.run) for record in one.records())

    def successes(self, components: Collection[str]) -> Iterator[Success]:
        return iter(())

    def unsettled(self) -> tuple[Unsettled, ...]:
        return ()


def pick(*made: Made, word: str | None = None, of: str | None = None, undone: bool = False) -> tuple[str, list[str]]:
    """The run that is taken back, and the runs that are with it and before it, the newest first."""
    found = chosen(SETUP, Remembered(made), word, of, "ada", undone=undone)
    assert found.run == found.runs[found.at] and found.plan == document_of(Remembered(made), found.run)
    assert found.explicit is (word is not None or of is not None)
    return found.run.run, [one.run for one in found.runs]


FIRST, SECOND = Made("first"), Made("second", 2.0, 3.0)
EMPTIED = Made("emptied", 3.0, 4.0, cause="recover")
NOTHING = Made("nothing", 3.0, 3.0)


@pytest.mark.parametrize(("made", "run", "together"), [
    ((FIRST,), "first", ["first"]),
    ((FIRST, SECOND), "second", ["second", "first"]),
    ((FIRST, SECOND, NOTHING), "second", ["second", "first"]),
    ((FIRST, SECOND, EMPTIED), "second", ["emptied", "second", "first"]),
    ((FIRST, SECOND, EMPTIED, replace(EMPTIED, run="again")), "second", ["again", "emptied", "second", "first"]),
    ((FIRST, EMPTIED, SECOND), "second", ["second", "emptied", "first"]),
    ((FIRST, EMPTIED, NOTHING), "first", ["emptied", "first"]),
    ((FIRST, replace(NOTHING, outcome="interrupted")), "nothing", ["nothing", "first"]),
    ((FIRST, replace(NOTHING, outcome=None)), "nothing", ["nothing", "first"]),
    ((FIRST, replace(NOTHING, looked=False)), "nothing", ["nothing", "first"]),
    ((FIRST, replace(SECOND, outcome="failed")), "second", ["second", "first"]),
    ((FIRST, replace(SECOND, kinds=("intent",))), "first", ["first"]),
    ((FIRST, replace(SECOND, kinds=("intent", "started"))), "second", ["second", "first"]),
    ((FIRST, replace(SECOND, outcome=None, kinds=("intent",), looked=False)), "first", ["first"]),
])  # fmt: skip
def test_the_last_run_that_changed_the_bench_or_was_cut_short_is_taken_back(
    made: tuple[Made, ...], run: str, together: list[str]
) -> None:
    assert pick(*made) == (run, together)


@pytest.mark.parametrize("made", [(EMPTIED,), (NOTHING,), (EMPTIED, NOTHING), (replace(FIRST, kinds=("intent",)),)])
def test_there_is_nothing_to_take_back_where_no_run_changed_anything(made: tuple[Made, ...]) -> None:
    with pytest.raises(PicoError, match="knows no run that left it otherwise"):
        pick(*made)


def test_a_run_that_only_emptied_hands_is_not_taken_back_by_name_either() -> None:
    assert pick(FIRST, SECOND, EMPTIED, word="first") == ("first", ["first"])
    assert pick(FIRST, EMPTIED, SECOND, word="first") == ("first", ["emptied", "first"])
    with pytest.raises(PicoError, match="run emptied moved and set nothing"):
        pick(FIRST, EMPTIED, word="emptied")


def test_a_run_of_another_person_is_taken_back_only_by_their_name() -> None:
    hers = replace(SECOND, operator="ben")
    with pytest.raises(PicoError, match="is another person's") as refused:
        pick(FIRST, hers)
    assert refused.value.diagnostics[0].hint == "`pico undo second --of ben` takes it back anyway"
    assert pick(FIRST, hers, of="ben") == ("second", ["second", "first"])
    assert pick(FIRST, hers, of="ada") == ("first", ["first"])
    assert pick(FIRST, replace(SECOND, operator="")) == ("second", ["second", "first"])


def test_a_redo_takes_back_an_undo_alone() -> None:
    undo = Made("undoing", 3.0, 2.0, cause="undo", of="second")
    assert pick(FIRST, SECOND, undo, undone=True)[0] == "undoing"
    assert pick(FIRST, SECOND, undo, word="second", undone=True)[0] == "undoing"
    assert pick(FIRST, SECOND, undo, EMPTIED, undone=True) == ("undoing", ["emptied", "undoing", "second", "first"])
    with pytest.raises(PicoError, match="nothing to redo"):
        pick(FIRST, SECOND, undone=True)
    with pytest.raises(PicoError, match="was not undone"):
        pick(FIRST, SECOND, undo, word="first", undone=True)


@pytest.mark.parametrize(("kinds", "begun", "open_"), [
    (("intent",), False, False), (("intent", "started"), True, True), (("intent", "started", "done"), True, False),
    (("intent", "done"), False, False),
])  # fmt: skip
def test_what_began_counts_whether_it_ended_or_not(kinds: tuple[Any, ...], begun: bool, open_: bool) -> None:
    memory = Remembered((replace(FIRST, kinds=kinds),))
    (run,) = memory.runs()
    assert list(begun_by(memory, run)) == ([("cam", "exposure")] if begun else [])
    assert list(begun_by(memory, run, ended=False)) == ([("cam", "exposure")] if open_ else [])

"""Leases in SQL do what the pure ones do, whatever comes, and each deed is in the audit once."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import pytest
from coordinators import Hand
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule
from sqlalchemy import insert

from pico.control import leases as control
from pico.control.leases import Asker, Lease, Turn
from pico.diagnostics import PicoError
from pico.server.store.books import books_in
from pico.server.store.ordered import broken, read_audit, read_events
from pico.server.store.tables import benches

ASKERS = tuple(Asker(f"{who}/s{n}", who) for who in ("anna", "ben") for n in (1, 2))
BENCH = "shel/bench1"
askers, tokens = st.sampled_from(ASKERS), st.integers(0, 6)


class Book(RuleBasedStateMachine):
    """The book in SQL beside the pure row; now and then it is opened anew, as after the coordinator was killed."""

    def __init__(self) -> None:
        super().__init__()
        self._folder = tempfile.TemporaryDirectory()
        self._clock, self._row, self._met = Hand(), Lease(BENCH), False
        self._audit: list[Any] = []
        self._books = books_in(Path(self._folder.name), self._clock)
        with self._books.database.writing() as connection:
            connection.execute(insert(benches).values(bench=BENCH, enrolled_at=0.0))

    def teardown(self) -> None:
        self._books.close()
        self._folder.cleanup()

    def same(self, turn: Turn, expected: Turn) -> None:
        assert turn == expected
        self._row = expected.row
        self._audit += expected.audit

    @rule(asker=askers)
    def ask(self, asker: Asker) -> None:
        self.same(self._books.leases.asked(BENCH, asker), control.asked(self._row, asker, self._clock(), self._met))

    @rule(asker=askers, token=tokens)
    def renew(self, asker: Asker, token: int) -> None:
        expected = control.renewed(self._row, asker.session, token, self._clock(), self._met)
        self.same(self._books.leases.renewed(BENCH, asker.session, token), expected)

    @rule(asker=askers, token=tokens, job=st.sampled_from(("run1", "run2")))
    def leave(self, asker: Asker, token: int, job: str) -> None:
        expected = control.detached(self._row, asker.session, token, job)
        self.same(self._books.leases.detached(BENCH, asker.session, token, job), expected)

    @rule(job=st.sampled_from(("run1", "run2")))
    def keep(self, job: str) -> None:
        self.same(self._books.leases.kept(BENCH, job), control.kept(self._row, job, self._clock()))

    @rule(asker=askers, token=tokens)
    def release(self, asker: Asker, token: int) -> None:
        expected = control.released(self._row, asker.session, token, self._clock(), self._met)
        self.same(self._books.leases.released(BENCH, asker.session, token), expected)

    @rule(asker=askers)
    def steal(self, asker: Asker) -> None:
        expected = control.stolen(self._row, asker, "it burns", self._clock(), self._met)
        self.same(self._books.leases.stolen(BENCH, asker, "it burns"), expected)

    @rule(fenced=tokens, current=st.booleans())
    def hear(self, fenced: int, current: bool) -> None:
        fenced = self._row.token if current else fenced
        now, self._met = self._clock(), True
        heard = control.heard(self._row, fenced, now)
        self.same(self._books.leases.heard(BENCH, fenced), heard.then(lambda row: control.promoted(row, now, True)))

    @rule(seconds=st.sampled_from((0.5, 4.0, 11.0, -2.0)))
    def wait(self, seconds: float) -> None:
        self._clock.seconds += seconds

    @rule()
    def look_for_what_is_over(self) -> None:
        over = control.promoted(self._row, self._clock(), self._met).row != self._row
        assert self._books.leases.due() == ((BENCH,) if over else ())
        for bench in self._books.leases.due():
            self.same(self._books.leases.promoted(bench), control.promoted(self._row, self._clock(), self._met))

    @rule()
    def begin_anew(self) -> None:
        self._books.close()
        self._books = books_in(Path(self._folder.name), self._clock)
        self._books.leases.forget()
        self._met = False

    @invariant()
    def what_is_kept_is_what_was_told(self) -> None:
        assert self._books.leases.shown(BENCH)[0] == self._row
        with self._books.database.reading() as connection:
            written = read_audit(connection)
            assert [(e["deed"], e["token"], e["session"], e["of"], e["why"]) for e in written] == [
                (a.deed, a.token, a.session, a.of, a.why) for a in self._audit
            ]
            assert broken(connection) is None
            told = [e["data"]["deed"] for e in read_events(connection, 0) if e["kind"] == "lease"]
            assert told == [a.deed for a in self._audit]


TestBook = Book.TestCase
TestBook.settings = settings(max_examples=12, stateful_step_count=25, deadline=None)


@pytest.mark.parametrize("spoiled", [b"no database, but some other file of a hundred bytes or so " * 4, None])
def test_books_that_are_damaged_are_refused_with_what_to_do(tmp_path: Path, spoiled: bytes | None) -> None:
    file = tmp_path / "coordinator.sqlite"
    made = books_in(tmp_path)
    made.people.settled("ann", [], by="test")
    made.close()
    if spoiled is None:
        whole = bytearray(file.read_bytes())
        whole[4096 : len(whole) // 2] = bytes(len(whole) // 2 - 4096)  # pages that are none
        spoiled = bytes(whole)
    for one in tmp_path.glob("coordinator.sqlite*"):
        one.unlink()
    file.write_bytes(spoiled)
    with pytest.raises(PicoError, match="are damaged") as told:
        books_in(tmp_path)
    assert "restore a copy" in str(told.value.diagnostics[0].hint) and file.read_bytes() == spoiled

"""Who gets, keeps, renews, gives back and takes over a lease: against a model that is written from the rules alone.

The rules: one holder at a time, in the order of asking; a lease ends TTL after it was granted, renewed or fenced for;
only its own session with its own token renews or gives it back, and for a run only the run that it was detached for;
whoever takes it over gives a reason; each token is higher than any that was ever given or heard of.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from examples import examples
from pico.control import leases
from pico.control.leases import TTL, Asker, Grant, Lease, Turn

ANNA, BEN, CLEO = Asker("s1", "anna"), Asker("s2", "ben"), Asker("s3", "cleo")
ALSO_ANNA = Asker("s4", "anna")
NOW = 100.0


def row(holder: Asker | None = ANNA, left: float = 5.0, queue: tuple[Asker, ...] = (), **grant: Any) -> Lease:
    """A bench whose holder has it for `left` seconds more, by token 7."""
    held = Grant(7, holder, NOW + left, **{"fenced": True, **grant}) if holder else None
    return Lease("b", token=7, grant=held, queue=queue)


def said(turn: Turn) -> list[tuple[Any, ...]]:
    return [(s.session, s.what, s.token) for s in turn.said]


def deeds(turn: Turn) -> list[tuple[Any, ...]]:
    return [(a.deed, a.bench, a.token, a.session, a.who) for a in turn.audit]


def test_a_lease_lives_for_some_heartbeats() -> None:
    assert TTL == 10.0 and leases.HEARTBEAT == 2.0


# who renews


@pytest.mark.parametrize("session", ["s1", "s2", ""])
@pytest.mark.parametrize("token", [0, 6, 7, 8])
@pytest.mark.parametrize("left", [-0.1, 0.0, 3.0])
@pytest.mark.parametrize("fenced", [True, False])
def test_only_the_session_that_has_it_renews_it_by_its_token_in_time(
    session: str, token: int, left: float, fenced: bool
) -> None:
    turn = leases.renewed(row(left=left, fenced=fenced), session, token, NOW, met=True)
    own = session == "s1" and token == 7 and left >= 0
    assert (turn.row.grant is not None and turn.row.grant.expires == NOW + TTL) is own
    if own:
        assert turn.row == row(left=TTL, fenced=fenced) and turn.audit == ()
        assert said(turn) == ([("s1", "granted", 7)] if fenced else [])
    elif left < 0:
        assert turn.row.grant is None and deeds(turn) == [("lapsed", "b", 7, "s1", "anna")]
        assert said(turn) == [("s1", "lost", 7), (session, "lost", token)]
    else:
        assert turn.row == row(left=left, fenced=fenced) and said(turn) == [(session, "lost", token)]


@pytest.mark.parametrize("own", ["", "run1"])
@pytest.mark.parametrize("job", ["", "run1", "run2"])
@pytest.mark.parametrize("left", [-3.0, 0.0, 3.0])
def test_a_run_renews_only_the_lease_that_was_detached_for_it(own: str, job: str, left: float) -> None:
    before = row(left=left, job=own)
    turn = leases.kept(before, job, NOW)
    assert turn == Turn(
        replace(before, grant=replace(before.grant, expires=NOW + TTL)) if job and job == own else before
    )
    assert leases.kept(row(None), job, NOW) == Turn(row(None))


@pytest.mark.parametrize(("session", "token"), list(itertools.product(["s1", "s2"], [6, 7, 8])))
def test_only_the_session_that_has_it_leaves_it_to_a_run(session: str, token: int) -> None:
    turn = leases.detached(row(), session, token, "run1")
    if (session, token) == ("s1", 7):
        assert turn == Turn(row(job="run1"))
    else:
        assert turn.row == row() and said(turn) == [(session, "lost", token)]
    assert said(leases.detached(row(None), session, token, "run1")) == [(session, "lost", token)]


# who gives it back


@pytest.mark.parametrize(("session", "token"), list(itertools.product(["s1", "s2", "s3"], [6, 7, 8])))
def test_only_the_session_that_has_it_gives_it_back_and_the_first_who_waits_gets_it(session: str, token: int) -> None:
    turn = leases.released(row(queue=(BEN, CLEO)), session, token, NOW, met=True)
    left = tuple(a for a in (BEN, CLEO) if a.session != session)
    if (session, token) == ("s1", 7):
        assert deeds(turn) == [("released", "b", 7, "s1", "anna"), ("granted", "b", 8, "s2", "ben")]
        assert turn.row == Lease("b", 8, Grant(8, BEN, NOW + TTL), (CLEO,)) and turn.said == ()
    else:
        assert turn == Turn(row(queue=left)), "it waits no more"


def test_a_lease_that_is_given_back_is_given_to_nobody_before_the_edge_was_met() -> None:
    turn = leases.released(row(queue=(BEN,)), "s1", 7, NOW, met=False)
    assert turn.row == Lease("b", 7, None, (BEN,)) and [d[0] for d in deeds(turn)] == ["released"]
    assert leases.released(row(None, queue=(BEN,)), "s2", 0, NOW, met=True) == Turn(row(None))


# who takes it over


@pytest.mark.parametrize("why", ["", " ", "\n\t"])
def test_nobody_takes_it_over_without_a_reason(why: str) -> None:
    for asker in (ANNA, BEN):
        with pytest.raises(ValueError, match="with a reason"):
            leases.stolen(row(), asker, why, NOW, met=True)


@pytest.mark.parametrize("holder", [None, ANNA, BEN])
@pytest.mark.parametrize("queue", [(), (CLEO,), (CLEO, BEN), (BEN, CLEO)])
@pytest.mark.parametrize("met", [True, False])
@pytest.mark.parametrize("left", [-1.0, 5.0])
def test_who_takes_it_over_has_it_by_a_higher_token_and_the_other_hears_why(
    holder: Asker | None, queue: tuple[Asker, ...], met: bool, left: float
) -> None:
    before = row(holder, left=left, queue=queue)
    turn = leases.stolen(before, BEN, "it smokes", NOW, met)
    if holder == BEN:
        assert turn == leases.asked(before, BEN, NOW, met)
    elif not met:
        assert turn.row == before and [(s.session, s.what, s.ahead, s.why) for s in turn.said] == [
            ("s2", "waiting", len(queue), "the edge is away")
        ]  # fmt: skip
    else:
        assert turn.row == Lease("b", 8, Grant(8, BEN, NOW + TTL), tuple(a for a in queue if a != BEN))
        assert deeds(turn) == [("stolen", "b", 8, "s2", "ben")]
        assert (turn.audit[0].of, turn.audit[0].why) == ("anna" if holder else "", "it smokes")
        assert [(s.session, s.what, s.token, s.why) for s in turn.said] == (
            [("s1", "lost", 7, "ben: it smokes")] if holder else []
        )


# who asks


@pytest.mark.parametrize("asker", [ANNA, BEN, CLEO, ALSO_ANNA])
@pytest.mark.parametrize("holder", [None, ANNA])
@pytest.mark.parametrize("left", [-0.1, 0.0, 5.0])
@pytest.mark.parametrize("fenced", [True, False])
@pytest.mark.parametrize("queue", [(), (BEN,), (CLEO, BEN)])
@pytest.mark.parametrize("met", [True, False])
def test_who_asks_gets_it_where_it_is_free_and_nobody_waits_before(
    asker: Asker, holder: Asker | None, left: float, fenced: bool, queue: tuple[Asker, ...], met: bool
) -> None:
    before = row(holder, left=left, fenced=fenced, queue=queue)
    turn = leases.asked(before, asker, NOW, met)
    held = holder is not None and left >= 0
    if held and asker == holder:
        assert turn.audit == () and turn.row == (before if fenced else row(holder, TTL, queue, fenced=False))
        assert said(turn) == ([("s1", "granted", 7)] if fenced else [("s1", "waiting", 0)])
        return
    line = queue if asker in queue else (*queue, asker)
    lapsed = [("lapsed", "b", 7, "s1", "anna")] if holder and left < 0 else []
    if held or not met:
        assert turn.row == replace(before, grant=before.grant if held else None, queue=line) and deeds(turn) == lapsed
    else:
        first = line[0]
        assert turn.row == Lease("b", 8, Grant(8, first, NOW + TTL), line[1:])
        assert deeds(turn) == [*lapsed, ("granted", "b", 8, first.session, first.who)]
    waits = asker in turn.row.queue
    mine = [(s.what, s.ahead) for s in turn.said if s.what != "lost"]
    assert mine == ([("waiting", turn.row.queue.index(asker))] if waits else [])
    assert [s for s in turn.said if s.what == "lost"] == ([turn.said[0]] if lapsed else [])


# when it ends


@pytest.mark.parametrize(("left", "over"), [(5.0, False), (0.0, False), (-0.001, True), (-50.0, True)])
@pytest.mark.parametrize("queue", [(), (BEN, CLEO)])
@pytest.mark.parametrize("met", [True, False])
def test_a_lease_that_was_not_renewed_in_time_is_over_and_the_next_gets_it(
    left: float, over: bool, queue: tuple[Asker, ...], met: bool
) -> None:
    before = row(left=left, queue=queue)
    ended = leases.lapsed(before, NOW)
    assert ended.row == (replace(before, grant=None) if over else before)
    assert said(ended) == ([("s1", "lost", 7)] if over else []) and bool(deeds(ended)) is over
    next_ = leases.promoted(before, NOW, met)
    if over and queue and met:
        assert next_.row == Lease("b", 8, Grant(8, BEN, NOW + TTL), (CLEO,))
    else:
        assert next_.row == ended.row
    assert leases.lapsed(row(None), NOW) == Turn(row(None))


@pytest.mark.parametrize("fenced", [0, 6, 7, 8, 99])
@pytest.mark.parametrize("active", [True, False])
@pytest.mark.parametrize("holder", [None, ANNA])
def test_a_lease_is_told_of_once_the_edge_has_fenced_and_lost_to_a_higher_token(
    fenced: int, active: bool, holder: Asker | None
) -> None:
    before = row(holder, fenced=active)
    turn = leases.heard(before, fenced, NOW)
    assert turn.row.token == max(7, fenced)
    if holder is None:
        assert turn == Turn(replace(before, token=max(7, fenced)))
    elif fenced > 7:
        assert turn.row.grant is None and said(turn) == [("s1", "lost", 7)]
        assert deeds(turn) == [("lapsed", "b", 7, "s1", "anna")] and "later lease" in turn.audit[0].why
    elif fenced == 7 and not active:
        assert turn.row.grant == Grant(7, ANNA, NOW + TTL, fenced=True) and said(turn) == [("s1", "granted", 7)]
    else:
        assert turn == Turn(before)


@pytest.mark.parametrize(("holder", "left", "told"), [
    (ANNA, 5.0, (7, 5.0)), (ANNA, 0.0, (7, 0.0)), (ANNA, -5.0, (7, 0.0)), (None, 0.0, (7, 0.0))
])  # fmt: skip
def test_the_edge_is_told_for_how_long_a_lease_holds_still(holder: Any, left: float, told: Any) -> None:
    assert leases.left(row(holder, left), NOW) == told


# all of it together, against a model


@dataclass
class Model:
    """What is so by the rules, in the plainest words. `holder` has the bench until `ends`; `job` may renew for it."""

    token: int = 0
    holder: Asker | None = None
    ends: float = 0.0
    fenced: bool = False
    job: str = ""
    line: list[Asker] = field(default_factory=list)
    log: list[tuple[str, int, str]] = field(default_factory=list)

    def grant(self, who: Asker, now: float, deed: str = "granted") -> None:
        self.token += 1
        self.holder, self.ends, self.fenced, self.job = who, now + 10.0, False, ""
        self.log.append((deed, self.token, who.session))

    def end(self, deed: str) -> None:
        assert self.holder
        self.log.append((deed, self.token, self.holder.session))
        self.holder = None

    def settle(self, now: float, met: bool) -> None:
        if self.holder and now > self.ends:
            self.end("lapsed")
        if not self.holder and self.line and met:
            self.grant(self.line.pop(0), now)

    def has(self, session: str, token: int) -> bool:
        return self.holder is not None and self.holder.session == session and token == self.token

    def ask(self, who: Asker, now: float, met: bool) -> None:
        if self.holder == who and now <= self.ends:
            self.ends = self.ends if self.fenced else now + 10.0
            return
        if who not in self.line:
            self.line.append(who)
        self.settle(now, met)

    def renew(self, who: Asker, token: int, now: float, met: bool) -> None:
        self.settle(now, met)
        if self.has(who.session, token):
            self.ends = now + 10.0

    def keep(self, job: str, now: float) -> None:
        if self.holder and job and job == self.job:
            self.ends = now + 10.0

    def release(self, who: Asker, token: int, now: float, met: bool) -> None:
        self.line = [a for a in self.line if a.session != who.session]
        if self.has(who.session, token):
            self.end("released")
            if self.line and met:
                self.grant(self.line.pop(0), now)

    def steal(self, who: Asker, now: float, met: bool) -> None:
        if self.holder == who:
            self.ask(who, now, met)
        elif met:
            self.line = [a for a in self.line if a != who]
            self.grant(who, now, "stolen")

    def hear(self, fenced: int, now: float) -> None:
        if self.holder and fenced > self.token:
            self.end("lapsed")
        elif self.holder and fenced == self.token and not self.fenced:
            self.fenced, self.ends = True, now + 10.0
        self.token = max(self.token, fenced)


DEED = st.tuples(
    st.sampled_from(("ask", "renew", "keep", "release", "steal", "hear", "settle", "leave")),
    st.sampled_from((ANNA, BEN, CLEO, ALSO_ANNA)), st.integers(-1, 2), st.sampled_from(("", "run1", "run2")),
    st.sampled_from((0.0, 1.0, 5.0, 10.0, 11.0)), st.sampled_from((True, True, False)),
)  # fmt: skip


def done(row: Lease, deed: str, who: Asker, token: int, job: str, now: float, met: bool) -> Turn:
    """Do a deed in truth."""
    deeds_: dict[str, Callable[[], Turn]] = {
        "ask": lambda: leases.asked(row, who, now, met),
        "renew": lambda: leases.renewed(row, who.session, token, now, met),
        "keep": lambda: leases.kept(row, job, now),
        "release": lambda: leases.released(row, who.session, token, now, met),
        "steal": lambda: leases.stolen(row, who, "because", now, met),
        "hear": lambda: leases.heard(row, token, now),
        "leave": lambda: leases.detached(row, who.session, token, job),
        "settle": lambda: leases.promoted(row, now, met),
    }
    return deeds_[deed]()


def follow(model: Model, deed: str, who: Asker, token: int, job: str, now: float, met: bool) -> None:
    """Do the same by the rules."""
    match deed:
        case "ask":
            model.ask(who, now, met)
        case "renew":
            model.renew(who, token, now, met)
        case "keep":
            model.keep(job, now)
        case "release":
            model.release(who, token, now, met)
        case "steal":
            model.steal(who, now, met)
        case "hear":
            model.hear(token, now)
        case "leave" if model.has(who.session, token):
            model.job = job
        case "settle":
            model.settle(now, met)


@given(st.lists(DEED, max_size=30))
@settings(max_examples=examples(200))
def test_whatever_comes_a_bench_is_had_as_the_rules_say(history: list[Any]) -> None:
    now, real, model = 0.0, Lease("b"), Model()
    audit: list[tuple[str, int, str]] = []
    for deed, who, off, job, wait, met in history:
        now += wait
        token = real.token - off
        turn = done(real, deed, who, token, job, now, met)
        follow(model, deed, who, token, job, now, met)
        real = turn.row
        audit += [(a.deed, a.token, a.session) for a in turn.audit]
        assert (real.token, list(real.queue), audit) == (model.token, model.line, model.log)
        grant = real.grant
        assert (grant and grant.holder) == model.holder
        if grant:
            assert (grant.expires, grant.fenced, grant.job) == (model.ends, model.fenced, model.job)

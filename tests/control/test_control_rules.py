"""What leases, gate and commands do one by one; what they do together is for the simulated network."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.control import commands as commanding
from pico.control import gate as gating
from pico.control import leases as leasing
from pico.control.commands import Commands, Row, State
from pico.control.gate import Command, Gate, Memory, Record
from pico.control.leases import TTL, Asker, Lease

ANNA, BEN = Asker("s1", "anna"), Asker("s2", "ben")
FIRST = Command(1, 1, "run/0/1", "p1=90")


def held(left: float = 10.0) -> Gate:
    """A gate that is fenced for lease 1, which holds."""
    return gating.heard(gating.fenced(gating.heard(Gate(), 1, left, 0.0)), 1, left, 0.0)


def test_a_lease_is_told_of_once_the_edge_has_fenced_and_the_next_waits() -> None:
    row = leasing.asked(Lease("b"), ANNA, 0.0, met=True)
    assert row.said[-1:] == () and row.row.grant and not row.row.grant.fenced
    waits = leasing.asked(row.row, BEN, 1.0, met=True)
    assert [(s.session, s.what, s.ahead) for s in waits.said] == [("s2", "waiting", 0)]
    active = leasing.heard(waits.row, 1, 2.0)
    assert [(s.session, s.what, s.token) for s in active.said] == [("s1", "granted", 1)]
    over = leasing.renewed(active.row, "s2", 9, 2.0 + TTL + 0.1, met=True)
    assert over.row.grant and (over.row.grant.token, over.row.grant.holder) == (2, BEN)
    assert [(a.deed, a.token) for a in over.audit] == [("lapsed", 1), ("granted", 2)]


def test_nobody_is_granted_anything_before_the_edge_has_said_its_number() -> None:
    row = leasing.asked(Lease("b", token=3), ANNA, 0.0, met=False).row
    assert row.grant is None and row.queue == (ANNA,)
    row = leasing.heard(row, 7, 1.0).row
    assert leasing.left(leasing.promoted(row, 1.0, met=True).row, 1.0) == (8, TTL)


def test_who_is_robbed_hears_by_whom_and_why() -> None:
    row = leasing.heard(leasing.asked(Lease("b"), ANNA, 0.0, met=True).row, 1, 0.0).row
    turn = leasing.stolen(row, BEN, "it smokes", 1.0, met=True)
    assert [(s.session, s.what, s.why) for s in turn.said] == [("s1", "lost", "ben: it smokes")]
    assert [(a.deed, a.token, a.who, a.of, a.why) for a in turn.audit] == [("stolen", 2, "ben", "anna", "it smokes")]
    with pytest.raises(ValueError, match="with a reason"):
        leasing.stolen(row, BEN, " ", 1.0, met=True)


DEEDS = st.lists(
    st.tuples(st.sampled_from(("ask", "renew", "release", "steal", "hear", "wait")), st.sampled_from((ANNA, BEN))),
    max_size=40,
)


@given(DEEDS, st.booleans())
def test_numbers_only_go_up_and_each_grant_has_one_row(deeds: list[tuple[str, Asker]], met: bool) -> None:
    row, now, audit = Lease("b"), 0.0, list[leasing.Audit]()
    for deed, who in deeds:
        now += 11.0 if deed == "wait" else 0.5
        token = row.grant.token if row.grant else row.token
        turn = {
            "ask": lambda: leasing.asked(row, who, now, met),  # noqa: B023
            "renew": lambda: leasing.renewed(row, who.session, token, now, met),  # noqa: B023
            "release": lambda: leasing.released(row, who.session, token, now, met),  # noqa: B023
            "steal": lambda: leasing.stolen(row, who, "why not", now, met),  # noqa: B023
            "hear": lambda: leasing.heard(row, token, now),  # noqa: B023
            "wait": lambda: leasing.promoted(row, now, met),  # noqa: B023
        }[deed]()
        assert turn.row.token >= row.token
        row, audit = turn.row, [*audit, *turn.audit]
    given_out = [a.token for a in audit if a.deed in ("granted", "stolen")]
    assert given_out == sorted(set(given_out)) and (met or not given_out)


def test_a_command_is_done_once_and_answered_as_it_ended() -> None:
    gate = held()
    assert gating.judged(gate, FIRST, 1.0).take
    gate = gating.started(gate, FIRST)
    assert gating.judged(gate, FIRST, 1.0).refused == "busy" and gating.begins(gate, 1.0)
    gate = gating.ended(gate, FIRST.key, "done", "90")
    known = gating.judged(gate, FIRST, 999.0).known
    assert known and (known.phase, known.result) == ("done", "90")
    assert gating.judged(gate, replace(FIRST, digest="p1=0"), 1.0).refused == "conflict"
    assert gating.judged(gate, Command(1, 3, "run/2/1", "p2=0"), 1.0).refused == "gap"


def test_a_lease_holds_from_when_the_edge_asked_and_a_little_shorter() -> None:
    gate = held(10.0)
    assert gating.begins(gating.started(gate, FIRST), 9.7) and not gating.begins(gating.started(gate, FIRST), 9.8)
    assert gating.judged(gate, FIRST, 9.97).refused == "nolease"
    assert gating.heard(gate, 1, 0.0, 5.0).deadline == -math.inf
    assert gating.to_park(gate, 9.97) and not gating.to_park(gate, 9.0)


def test_the_next_lease_waits_until_what_moves_has_ended() -> None:
    moving = gating.heard(gating.started(held(), FIRST), 2, 10.0, 1.0)
    assert gating.fenced(moving) is moving and not moving.may_move(1, 1.0)
    after = gating.fenced(gating.ended(moving, FIRST.key, "done"))
    assert after.memory.fenced == 2 and not after.may_move(2, 1.0), "the coordinator has to say for how long"
    assert gating.judged(after, replace(FIRST, key="run/1/1"), 1.0).refused == "stale"


def test_a_job_that_is_cut_off_goes_on_for_what_it_declared_and_a_minute_at_most() -> None:
    gate = gating.declared(gating.started(held(), FIRST), 20.0)
    assert gating.begins(gate, 29.0, offline=True) and not gating.begins(gate, 29.0)
    assert not gating.begins(gate, 31.0, offline=True)
    assert gating.declared(gate, 1e9).budget == gating.OFFLINE and gating.declared(gate, -1.0).budget == 0.0
    assert not gating.begins(gating.heard(gate, 2, 10.0, 12.0), 13.0, offline=True), "somebody else was granted it"


def test_after_a_failure_nothing_more_of_its_run_is_done() -> None:
    gate = gating.ended(gating.started(held(), FIRST), FIRST.key, "failed")
    assert gating.judged(gate, Command(1, 2, "run/1/1", "p2=0"), 1.0).refused == "stopped"
    assert gating.judged(gate, Command(1, 2, "other/0/1", "p2=0"), 1.0).take


def test_what_was_cut_short_lets_nothing_else_begin_until_it_is_settled() -> None:
    gate = gating.heard(gating.restarted(gating.started(held(), FIRST).memory), 1, 10.0, 0.0)
    following = Command(1, 2, "run/1/1", "p2=0")
    assert gate.memory.unsettled == (FIRST.key,)
    assert gating.judged(gate, following, 1.0).refused == "unknown" == gating.judged(gate, FIRST, 1.0).refused
    assert gating.judged(gating.ended(gate, FIRST.key, "done", "seen"), following, 1.0).take


def test_commands_keep_their_first_content_and_number() -> None:
    commands = commanding.submitted(Commands(), FIRST)
    assert commanding.submitted(commands, FIRST) is commands
    with pytest.raises(ValueError, match="other content"):
        commanding.submitted(commands, replace(FIRST, digest="p1=0"))
    with pytest.raises(ValueError, match="another command 1"):
        commanding.submitted(commands, replace(FIRST, key="run/9/1"))
    assert not commands.whole(1, 2) and commands.whole(1, 1)


@pytest.mark.parametrize("state", ["waiting", "unknown", "done", "failed", "withdrawn"])
def test_only_what_waits_is_sent_to_the_edge(state: State) -> None:
    """What began, and whose end is unknown, is looked at first, and never asked for a second time by itself."""
    commands = Commands({FIRST.key: Row(FIRST, state)})
    assert commands.due(1) == ((FIRST,) if state == "waiting" else ()) and commands.due(2) == ()
    many = [Command(1, n, f"run/{n}/1", "p1=90") for n in (3, 1, 6, 2, 5, 4)]
    all_of = Commands({c.key: Row(c, state if c.seq == 1 else "waiting") for c in many})
    sent = [c.seq for c in all_of.due(1)]
    assert sent == ([1, 2, 3, 4] if state == "waiting" else [2, 3, 4, 5])


def test_an_end_stays_and_an_unknown_one_takes_a_name() -> None:
    commands = commanding.submitted(Commands(), FIRST)
    done = commanding.answered(commands, Record(FIRST, "done"))
    assert commanding.answered(done, Record(FIRST, "failed")) is done and done.due(1) == ()
    unknown = commanding.answered(commands, Record(FIRST, "unknown"))
    with pytest.raises(ValueError, match="who they are"):
        commanding.resolved(unknown, FIRST.key, "done", " ")
    assert commanding.resolved(unknown, FIRST.key, "done", "ann").rows[FIRST.key].by == "ann"


def test_what_an_earlier_lease_left_is_as_the_edge_says_or_never_done() -> None:
    commands = commanding.submitted(commanding.submitted(Commands(), FIRST), Command(1, 2, "run/1/1", "p2=0"))
    memory = Memory().with_record(Record(FIRST, "done")).fence(2)
    after = commanding.reconciled(commands, memory)
    assert [row.state for row in after.of(1)] == ["done", "withdrawn"]

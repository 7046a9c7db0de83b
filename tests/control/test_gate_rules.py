"""What an edge lets through: commands of the lease that it fenced for, in order, each once, in time; case by case."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import pytest

from pico.control import gate as gating
from pico.control.gate import OFFLINE, RATE, REACHES, STEERING, Command, Gate, Memory, Record
from pico.teleop.frames import SILENCE, STEP_SECONDS, Frame

LEASE, ENDS = 5, 50.0
NEXT = Command(LEASE, 3, "run/3/1", "p1=90")


def gate(taken: int = 2, **changes: Any) -> Gate:
    """A gate that is fenced for lease 5 until 50 s, which took two commands of it."""
    memory = Memory(fenced=LEASE, taken=taken, **changes.pop("memory", {}))
    return Gate(**{"memory": memory, "deadline": ENDS, **changes})


def record(phase: Any, seq: int = 1, key: str = "other/1/1", token: int = LEASE, **more: Any) -> dict[str, Record]:
    return {key: Record(Command(token, seq, key, "x"), phase, **more)}


def test_the_margins_of_a_lease_are_kept() -> None:
    assert (RATE, REACHES, OFFLINE) == (0.996, 0.2, 60.0)
    assert Memory() == Memory(fenced=0, taken=0, stopped=frozenset(), records={})
    assert Gate() == Gate(Memory(), pending=0, deadline=-math.inf, running="", budget=0.0)


@pytest.mark.parametrize("token", [4, 5, 6])
@pytest.mark.parametrize("pending", [0, 6])
@pytest.mark.parametrize("now", [0.0, ENDS, ENDS + 0.001])
def test_only_the_lease_that_was_fenced_for_moves_while_it_holds_and_none_drains(
    token: int, pending: int, now: float
) -> None:
    it = gate(pending=pending)
    may = token == LEASE and not pending and now <= ENDS
    assert it.may_move(token, now) is may
    verdict = gating.judged(it, replace(NEXT, token=token), now)
    assert verdict.take is may and verdict.known is None
    assert verdict.refused == (None if may else "stale" if token < LEASE else "nolease")


@pytest.mark.parametrize("seq", [1, 2, 3, 4])
@pytest.mark.parametrize("stopped", [(), ("run",), ("other",)])
@pytest.mark.parametrize("running", ["", "run/2/1"])
@pytest.mark.parametrize("begun", [None, "started", "unknown", "done", "failed"])
def test_a_command_is_taken_on_in_its_turn_where_nothing_is_open(
    seq: int, stopped: tuple[str, ...], running: str, begun: str | None
) -> None:
    records = record(begun) if begun else {}
    it = gate(memory={"stopped": frozenset(stopped), "records": records}, running=running)
    verdict = gating.judged(it, replace(NEXT, seq=seq), 1.0)
    why = ("gap" if seq != 3 else "stopped" if "run" in stopped else "busy" if running
           else "unknown" if begun in ("started", "unknown") else None)  # fmt: skip
    assert (verdict.take, verdict.refused, verdict.known) == (why is None, why, None)


@pytest.mark.parametrize("phase", ["started", "done", "failed", "unknown"])
@pytest.mark.parametrize("digest", ["p1=90", "p1=0"])
@pytest.mark.parametrize("running", ["", "run/3/1", "run/4/1"])
@pytest.mark.parametrize("token", [4, 5, 6])
@pytest.mark.parametrize("now", [1.0, 99.0])
def test_a_known_command_is_never_done_again_and_answered_as_it_ended(
    phase: Any, digest: str, running: str, token: int, now: float
) -> None:
    kept = Record(NEXT, phase, "90")
    it = gate(memory={"records": {NEXT.key: kept}}, running=running)
    verdict = gating.judged(it, replace(NEXT, digest=digest, token=token), now)
    assert not verdict.take
    if digest != NEXT.digest:
        assert (verdict.refused, verdict.known) == ("conflict", None)
    elif running == NEXT.key:
        assert (verdict.refused, verdict.known) == ("busy", kept)
    else:
        assert verdict.refused == ("unknown" if phase in ("started", "unknown") else None) and verdict.known is kept


# what is remembered


@pytest.mark.parametrize("token", [4, 5, 6])
@pytest.mark.parametrize("phase", ["started", "done", "failed", "unknown"])
@pytest.mark.parametrize("seq", [1, 2, 3])
def test_a_record_counts_for_the_lease_that_it_is_of(token: int, phase: Any, seq: int) -> None:
    memory = Memory(fenced=LEASE, taken=2, stopped=frozenset({"old"}), records=record("done", key="a/1/1"))
    new = Record(Command(token, seq, "run/9/1", "x"), phase)
    after = memory.with_record(new)
    current = token == LEASE
    assert after.taken == (max(2, seq) if current else 2) and after.fenced == LEASE
    assert after.stopped == ({"old", "run"} if current and phase == "failed" else {"old"})
    assert after.records == {**memory.records, "run/9/1": new}
    assert after.unsettled == (("run/9/1",) if phase in ("started", "unknown") else ())


def test_a_later_lease_begins_with_nothing_taken_or_stopped_and_all_that_is_known() -> None:
    memory = Memory(fenced=LEASE, taken=2, stopped=frozenset({"old"}), records=record("done"))
    assert memory.fence(9) == Memory(fenced=9, records=memory.records)
    assert gating.restarted(memory) == Gate(memory) and not gating.restarted(memory).may_move(LEASE, 0.0)


def test_a_command_that_is_taken_on_runs_until_it_ends() -> None:
    it = gating.started(gate(), NEXT)
    assert it.running == NEXT.key and it.memory.records[NEXT.key] == Record(NEXT, "started") and it.memory.taken == 3
    for phase in ("done", "failed", "unknown"):
        over = gating.ended(it, NEXT.key, phase, "r")  # type: ignore[arg-type]
        assert over.running == "" and over.memory.records[NEXT.key] == Record(NEXT, phase, "r")  # type: ignore[arg-type]
    other = gating.ended(replace(it, memory=it.memory.with_record(record("unknown")["other/1/1"])), "other/1/1", "done")
    assert other.running == NEXT.key and other.memory.records["other/1/1"].phase == "done"


# until when


@pytest.mark.parametrize("token", [4, 5, 6, 7, 8])
@pytest.mark.parametrize("pending", [0, 7])
@pytest.mark.parametrize("left", [0.0, -1.0, 0.5, 10.0, 100.0])
def test_what_the_coordinator_says_drains_for_a_later_lease_or_extends_this_one(
    token: int, pending: int, left: float
) -> None:
    it = gate(pending=pending)
    heard = gating.heard(it, token, left, 30.0)
    if token > max(LEASE, pending):
        assert (heard.pending, heard.deadline, heard.memory) == (token, ENDS, it.memory)
    elif token == LEASE and not pending:
        until = 30.0 + left * 0.996 - 0.2
        assert heard == replace(it, deadline=max(ENDS, until) if left > 0 else -math.inf)
    else:
        assert heard == it


def test_draining_for_a_later_lease_ends_what_is_steered() -> None:
    it = gate()
    it = replace(it, steering=it.steering.hear(Frame(seq=1, seen=1.0, press=1), 1.0)[0])
    assert it.steering.pressed and not gating.heard(it, 9, 10.0, 1.0).steering.pressed
    assert gating.heard(it, LEASE, 10.0, 1.0).steering.pressed


@pytest.mark.parametrize("running", ["", "run/3/1"])
@pytest.mark.parametrize("pending", [0, 9])
def test_a_gate_fences_once_nothing_moves_and_holds_nothing_until_it_hears(running: str, pending: int) -> None:
    it = gate(running=running, pending=pending, budget=20.0)
    fenced = gating.fenced(it)
    if running or not pending:
        assert fenced is it
    else:
        assert fenced == Gate(it.memory.fence(9)) and (fenced.budget, fenced.deadline) == (0.0, -math.inf)
        assert not fenced.may_move(9, -1e9)


@pytest.mark.parametrize(("seconds", "budget"), [(-5.0, 0.0), (0.0, 0.0), (20.0, 20.0), (60.0, 60.0), (61.0, 60.0)])
@pytest.mark.parametrize("late", [-1.0, 0.0, 0.5, 20.0, 20.5, 60.0, 60.5])
@pytest.mark.parametrize("offline", [True, False])
@pytest.mark.parametrize("pending", [0, 9])
def test_a_declared_job_goes_on_alone_for_its_budget_where_nobody_else_was_granted(
    seconds: float, budget: float, late: float, offline: bool, pending: int
) -> None:
    it = replace(gating.declared(gating.started(gate(), NEXT), seconds), pending=pending)
    now = ENDS + late
    assert it.budget == budget
    within = not pending and late <= budget
    assert gating.alone(it, LEASE, now) is within and not gating.alone(it, LEASE + 1, now)
    assert gating.begins(it, now, offline=offline) is (not pending and (late <= 0 or (offline and within)))
    idle = replace(it, running="")
    assert not gating.to_park(it, now), "what runs is not parked"
    assert gating.to_park(idle, now) is (late > 0 and not within)


def test_a_job_of_an_earlier_lease_goes_on_neither_alone_nor_else() -> None:
    it = gating.declared(gating.started(gate(), replace(NEXT, token=4)), 20.0)
    assert not gating.begins(it, 1.0) and not gating.begins(it, 1.0, offline=True)


# what is steered


@pytest.mark.parametrize(("token", "now"), list(itertools.product([4, 5, 6], [1.0, ENDS + 1])))
def test_a_frame_is_heard_from_who_has_the_lease_and_ends_the_press_of_another(token: int, now: float) -> None:
    pressed = replace(gate(), steering=gate().steering.hear(Frame(seq=1, seen=now, press=1), now)[0])
    after, why = gating.steered(pressed, token, Frame(seq=2, seen=now, press=1), now + 0.01)
    if token == LEASE and now <= ENDS:
        assert why == "" and after.steering.seq == 2 and after.steering.pressed
    else:
        assert why == "nolease" and after.steering.seq == 1 and not after.steering.pressed
        assert after.steering.pending is None
    late, why = gating.steered(gate(), LEASE, Frame(seq=1, seen=0.0, press=1), 10.0)
    assert why == "late" and late.steering.seq == 1


@pytest.mark.parametrize("running", ["", "run/3/1", STEERING])
@pytest.mark.parametrize("frame", [True, False])
@pytest.mark.parametrize("late", [0.0, 0.04, 0.06, SILENCE])
@pytest.mark.parametrize("holds", [True, False])
def test_a_step_takes_one_frame_in_time_while_nothing_moves(
    running: str, frame: bool, late: float, holds: bool
) -> None:
    steering = gate().steering.hear(Frame(seq=1, seen=10.0, press=1), 10.0)[0] if frame else gate().steering
    it = gate(running=running, steering=steering, deadline=ENDS if holds else 5.0)
    after, found = gating.stepping(it, 10.0 + late, STEP_SECONDS)
    fits = frame and not running and holds and late + STEP_SECONDS <= SILENCE + 1e-12
    if fits:
        assert found is not None and found.seq == 1
        assert after.running == STEERING and after.steering.pending is None
        assert gating.stepping(after, 10.0, STEP_SECONDS) == (after, None)
    else:
        assert found is None and after is it
    assert gating.stepped(after).running == ("" if after.running == STEERING else after.running)

"""The dead-man, case by case: which frame authorizes a step, until when, and which press is over."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from pico.teleop.deadman import Gate
from pico.teleop.frames import SILENCE, STEP_SECONDS, Frame

NOW = 10.0


def frame(seq: int = 5, press: int = 3, age: float = 0.0, now: float = NOW, **more: Any) -> Frame:
    return Frame(seq=seq, seen=now - age, press=press, tunable="x", by=0.1, **more)


def gate(press: int = 3, since: float = 0.05, over: int = 2, pending: bool = True) -> Gate:
    """A gate that heard frame 4 of a press some time ago."""
    held = NOW - since
    return Gate(4, held, press, held, over, frame(4, press, now=held) if pending else None)


def test_the_times_of_a_press_are_kept() -> None:
    assert (SILENCE, STEP_SECONDS) == (0.2, 0.15)


@pytest.mark.parametrize("seq", [3, 4, 5, 50])
@pytest.mark.parametrize("kind", ["press", "there", "release"])
def test_a_frame_that_was_overtaken_changes_nothing(seq: int, kind: str) -> None:
    it = gate()
    heard = frame(seq, press=0 if kind == "there" else 3, release=kind == "release")
    after, why = it.hear(heard, NOW)
    if seq <= 4:
        assert (after, why) == (it, "stale")
    else:
        assert (after.seq, after.heard, why) == (seq, NOW, "")
        if kind == "there":
            assert after == replace(it, seq=seq, heard=NOW)
        elif kind == "release":
            assert after == replace(it, seq=seq, heard=NOW, pending=None, over=3) and not after.pressed


@pytest.mark.parametrize("age", [0.0, 0.19, 0.21, 5.0, -0.19, -0.21, math.nan, math.inf])
@pytest.mark.parametrize("press", [1, 2, 3, 4])
@pytest.mark.parametrize("since", [0.0, 0.19, 0.21])
@pytest.mark.parametrize("over", [0, 2, 3, 4])
def test_a_frame_counts_in_time_of_a_press_that_goes_on_or_is_fresh(
    age: float, press: int, since: float, over: int
) -> None:
    it = gate(since=since, over=over)
    heard = frame(press=press, age=age)
    after, why = it.hear(heard, NOW)
    late = not abs(age) <= SILENCE
    ended = press <= over or press < 3 or (press == 3 and since > SILENCE)
    assert why == ("late" if late else "lapsed" if ended else "")
    assert (after.seq, after.heard) == (5, NOW)
    if why:
        assert after.pending is None and after.over == max(over, press)
        assert (after.press, after.held) == (it.press, it.held)
    else:
        assert (after.pending, after.press, after.held, after.over) == (heard, press, NOW, over)
        assert after.pressed


def test_a_frame_counts_until_silence_is_over_to_the_last() -> None:
    it, why = Gate().hear(Frame(seq=1, seen=0.0, press=1), SILENCE)
    assert why == "" and it.pending is not None
    it = Gate(1, 0.0, 1, 0.0)
    assert it.hear(Frame(seq=2, seen=SILENCE, press=1), SILENCE)[1] == "" and not it.lapsed(SILENCE)
    late = math.nextafter(SILENCE, 1.0)
    assert it.hear(Frame(seq=2, seen=late, press=1), late)[1] == "lapsed" and it.lapsed(late)
    assert Gate().hear(Frame(seq=1, seen=0.0, press=1), late)[1] == "late"


@pytest.mark.parametrize("since", [0.0, 0.04, 0.06, 0.19, 0.21])
@pytest.mark.parametrize("seconds", [0.001, STEP_SECONDS, SILENCE, 1.0])
@pytest.mark.parametrize("pending", [True, False])
def test_a_step_is_authorized_by_one_frame_and_over_within_silence(since: float, seconds: float, pending: bool) -> None:
    it = gate(since=since, pending=pending)
    fits = pending and since + seconds <= SILENCE
    assert it.authorized(NOW, seconds) == (it.pending if fits else None)
    assert it.taken().pending is None and it.taken() == replace(it, pending=None)
    assert it.taken().authorized(NOW, seconds) is None


@pytest.mark.parametrize("press", [1, 2, 3])
@pytest.mark.parametrize("over", [1, 2, 3])
@pytest.mark.parametrize("since", [0.0, 0.19, 0.21])
def test_a_press_lapses_by_silence_and_stays_over(press: int, over: int, since: float) -> None:
    it = gate(press=press, over=over, since=since)
    assert it.pressed is (press > over) and it.lapsed(NOW) is (press > over and since > SILENCE)
    assert it.silent(NOW) == pytest.approx(since)
    closed = it.closed()
    assert closed == replace(it, pending=None, over=max(over, press)) and not closed.pressed


def test_at_first_nothing_is_pressed_or_authorized() -> None:
    it = Gate()
    assert (it.seq, it.heard, it.press, it.held, it.over, it.pending) == (0, -math.inf, 0, -math.inf, 0, None)
    assert not it.pressed and not it.lapsed(NOW) and it.authorized(NOW, 0.01) is None and it.silent(NOW) == math.inf
    assert it.hear(frame(seq=0), NOW) == (it, "stale") and it.hear(frame(seq=1, press=1), NOW)[1] == ""
    assert it.hear(frame(seq=1, press=-1), NOW)[1] == "lapsed"

"""The dead-man: a frame authorizes one step at most, which is over 0.2 s after it was heard; silence ends a press."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from pico.teleop.deadman import Gate
from pico.teleop.frames import SILENCE, STEP_SECONDS, Frame


def pressed(seq: int, press: int = 1, seen: float = 0.0) -> Frame:
    return Frame(seq=seq, seen=seen, press=press, tunable="x", by=0.1)


def test_a_frame_authorizes_one_step() -> None:
    gate, refused = Gate().hear(pressed(1), 0.0)
    assert not refused and gate.authorized(0.0, STEP_SECONDS)
    assert gate.taken().authorized(0.0, STEP_SECONDS) is None


def test_a_step_begins_only_where_it_is_over_in_time() -> None:
    gate, _ = Gate().hear(pressed(1), 0.0)
    assert gate.authorized(SILENCE - STEP_SECONDS, STEP_SECONDS)
    assert gate.authorized(SILENCE - STEP_SECONDS + 0.001, STEP_SECONDS) is None


def test_the_latest_frame_counts_and_none_is_queued() -> None:
    gate, _ = Gate().hear(pressed(1, press=1), 0.0)
    gate, _ = gate.hear(replace(pressed(2, press=2), by=-0.1), 0.01)
    found = gate.authorized(0.02, STEP_SECONDS)
    assert found is not None and found.by == -0.1
    assert gate.taken().authorized(0.02, STEP_SECONDS) is None


def test_a_frame_that_was_overtaken_or_long_on_its_way_authorizes_nothing() -> None:
    gate, _ = Gate().hear(pressed(2), 0.0)
    assert gate.taken().hear(pressed(1), 0.01) == (gate.taken(), "stale")
    late, refused = gate.hear(pressed(3, seen=0.0), SILENCE + 0.01)
    assert refused == "late" and late.authorized(SILENCE + 0.01, STEP_SECONDS) is None
    again, refused = late.hear(pressed(4, seen=SILENCE), SILENCE + 0.02)
    assert refused == "lapsed" and again.pending is None  # the press of a late frame is over, too


def test_going_on_after_silence_takes_a_fresh_press() -> None:
    gate, _ = Gate().hear(pressed(1), 0.0)
    now = SILENCE + 0.01
    gate, refused = gate.taken().hear(pressed(2, seen=now), now)
    assert refused == "lapsed"
    assert gate.hear(pressed(3, seen=now), now)[1] == "lapsed"
    assert gate.hear(pressed(3, press=2, seen=now), now)[1] == ""


def test_that_somebody_is_there_moves_nothing_and_a_release_ends_the_press() -> None:
    gate, _ = Gate().hear(pressed(1), 0.0)
    there, refused = gate.hear(Frame(seq=2), 0.01)
    assert not refused and there.pending == gate.pending
    released, refused = there.hear(Frame(seq=3, release=True), 0.02)
    assert not refused and released.authorized(0.02, STEP_SECONDS) is None
    assert released.hear(pressed(4), 0.03)[1] == "lapsed"


def histories() -> st.SearchStrategy[list[tuple[float, Frame]]]:
    """Frames as a client, a bad link or an attacker may send them: any order, any number, any age."""
    gaps, ages = st.sampled_from([0.0, 0.01, 0.03, 0.05, 0.15, 0.21, 1.0]), st.sampled_from([0.0, 0.1, 0.3, -5.0])
    heard = st.tuples(gaps, ages, st.integers(-1, 40), st.integers(-1, 5), st.booleans())
    return st.lists(heard, min_size=1, max_size=25).map(_frames)


def _frames(heard: list[tuple[float, float, int, int, bool]]) -> list[tuple[float, Frame]]:
    now, found = 0.0, []
    for gap, age, seq, press, release in heard:
        now += gap
        found.append((now, Frame(seq=seq, seen=now - age, press=press, tunable="x", by=0.1, release=release)))
    return found


@given(histories(), st.floats(0.001, STEP_SECONDS))
def test_motion_is_over_in_time_whatever_is_heard(history: list[tuple[float, Frame]], takes: float) -> None:
    """I9 of the edge: each step belongs to one frame that was accepted, and is over SILENCE after it was heard."""
    gate, moving_until, accepted, steps = Gate(), 0.0, list[float](), 0
    for at, (now, frame) in enumerate(history):
        gate, refused = gate.hear(frame, now)
        wanted = not refused and frame.press and not frame.release
        accepted += [now] if wanted else []
        until = history[at + 1][0] if at + 1 < len(history) else now + 1.0
        when = max(now, moving_until)
        while when <= until:  # the edge looks whenever nothing moves
            if gate.authorized(when, takes):
                gate, steps = gate.taken(), steps + 1
                moving_until = when + takes
                assert moving_until <= accepted[-1] + SILENCE + 1e-9
            when = max(when + 0.02, moving_until)
    assert steps <= len(accepted)


@given(histories())
def test_a_press_that_is_over_never_moves_again(history: list[tuple[float, Frame]]) -> None:
    gate, over = Gate(), 0
    for now, frame in history:
        gate, refused = gate.hear(frame, now)
        assert gate.over >= over
        if gate.pending is not None:
            assert gate.pending.press > gate.over and not (refused and frame is gate.pending)
        over = gate.over

"""What ended each press of a key, as the edge heard it."""

from __future__ import annotations

from pico.teleop.frames import SILENCE, Frame
from pico.teleop.presses import Presses


def held(seq: int, press: int, seen: float = 0.0) -> Frame:
    return Frame(seq=seq, seen=seen, press=press, tunable="x", by=0.1)


def test_each_press_ends_once_and_it_is_said_why() -> None:
    presses = Presses(0.0)
    presses.hear(held(1, 1), 0.0)
    presses.hear(held(2, 1), 0.05)
    assert (presses.stopped, presses.told()["presses"]) == ("", {})
    presses.hear(Frame(seq=3, release=True), 0.1)
    presses.hear(Frame(seq=4, release=True), 0.15)
    assert presses.stopped == "released"
    presses.hear(held(5, 2, seen=0.2), 0.2)
    assert presses.stopped == ""
    presses.listen(0.2 + SILENCE)
    assert presses.stopped == ""
    presses.listen(0.21 + SILENCE)
    assert presses.stopped == "silent"
    presses.hear(held(6, 3, seen=0.5), 0.5)
    presses.hear(held(7, 3, seen=0.2), 0.5)
    assert presses.stopped == "late"
    presses.hear(held(8, 4, seen=0.6), 0.6)
    presses.end("refused")
    assert presses.told()["presses"] == {"released": 1, "silent": 1, "late": 1, "refused": 1}


def test_for_how_long_something_moved_after_the_last_frame_of_its_press() -> None:
    presses = Presses(0.0)
    presses.hear(held(1, 1, seen=1.0), 1.0)
    presses.hear(Frame(seq=2), 1.1)  # only says that somebody is there
    presses.moved(1.15)
    presses.hear(held(3, 1, seen=1.1), 1.18)
    presses.moved(1.2)
    assert presses.told()["after"] == 0.15

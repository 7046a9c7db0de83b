"""What the guard has to say goes to who watches a bench, once each time that it changes."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from bench_at import bench_at

from pico.backends.hardware.guard.ending import Closing, LightEnd
from pico.backends.hardware.guard.note import Ended, Note, write
from pico.edge.live.following import IDLE, _Following

METHODS = ("listen", "guarded", "guards", "may_emit", "dark_by_itself", "end_light")


def test_a_page_hears_of_light_that_could_not_be_ended_within_the_time_of_a_look(tmp_path: Path) -> None:
    place = bench_at(tmp_path, "hardware")
    edge: Any = SimpleNamespace(place=place, device=SimpleNamespace(**dict.fromkeys(METHODS, print)))
    page = _Following(edge)
    assert page._guard() == [] and IDLE <= 2.0
    lit = LightEnd(laser="bare", closings=(Closing(address="bare.emission", dark=False, wrong="it does not answer"),))
    write(place, Note(ended=Ended(at="2026-11-24T12:00:00Z", why="door_box (door) is not safe", ends=(lit,))))
    (told,) = page._guard()
    (said,) = told["data"]["notices"]
    assert told["told"] == "guard" and "bare MAY STILL EMIT" in said["summary"] and "door_box" in said["summary"]
    assert page._guard() == [], "it is told once"
    write(place, Note())
    assert page._guard() == [{"told": "guard", "rev": 0, "data": {"notices": []}}]


def test_a_bench_without_light_to_guard_tells_nothing(tmp_path: Path) -> None:
    edge: Any = SimpleNamespace(place=bench_at(tmp_path), device=SimpleNamespace())
    assert _Following(edge)._guard() == []

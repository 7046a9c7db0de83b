"""The guard against boxes of switches at the wire: emission is measured at the emulated lasers."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from boxes import INPUTS, LIGHTS, guarded, until

from pico.backends.hardware.guard.ending import Closing, Light, LightEnd
from pico.backends.hardware.guard.hearing import HELD, SILENT, Hearing
from pico.backends.hardware.guard.note import Ended, Note, notices, read, watching, with_ended, write
from pico.backends.hardware.guard.verdict import Cause, Trip
from pico.backends.hardware.guard.watch import Guard, Told, Watched
from pico.base import clock
from pico.base.awake import Awake
from pico.diagnostics import PicoError
from pico.drivers.protocols import SafetyState
from pico.model.wiring import SafetyEntry

BAR, LOST = 0.5, 1.0
"""Within which light ends [s]: of an unsafe input, and of one whose link was lost."""
TOLD = 1.5
"""Within which a bench says what it could not close [s]: its coordinator, within 2 s."""


@pytest.mark.parametrize("name", [name for name, kind in INPUTS.items() if kind != "curtain"])
def test_an_unsafe_input_ends_the_light_of_every_laser_while_nothing_runs(tmp_path: Path, name: str) -> None:
    with guarded(tmp_path) as rig:
        rig.inputs.put(name, False)
        rig.ends_within(BAR)
        until(lambda: read(rig.place).ended is not None)
        assert not rig.lasers.is_("laser_shutter") and not rig.lasers.is_("laser_head"), "both are switched"
        said = notices(read(rig.place))
        assert len(said) == 1 and f"because {name}" in said[0].summary
        assert "light of bare, laser was ended at" in said[0].summary


def test_a_link_that_falls_silent_ends_light(tmp_path: Path) -> None:
    with guarded(tmp_path) as rig:
        rig.inputs.frozen = True
        rig.ends_within(LOST)
        until(lambda: read(rig.place).ended is not None)
        assert "has not answered" in notices(read(rig.place))[0].summary


def test_a_box_that_hangs_up_ends_light(tmp_path: Path) -> None:
    with guarded(tmp_path) as rig:
        rig.inputs.served.close()
        rig.ends_within(LOST)


def test_what_could_not_be_closed_is_told_and_closed_once_it_can(tmp_path: Path) -> None:
    with guarded(tmp_path) as rig:
        began = time.monotonic()
        rig.lasers.frozen = True
        rig.inputs.put("door_box", False)
        until(lambda: read(rig.place).ended is not None, 6.0)
        assert time.monotonic() - began < TOLD, "no device that is silent may keep it from being told"
        said = " ".join(one.summary for one in notices(read(rig.place)))
        assert "laser MAY STILL EMIT" in said and "bare MAY STILL EMIT" in said
        assert "door_box (door) is not safe" in said and "it has not answered for 0.6 s" in said
        assert rig.lit() == {"laser": True, "bare": True}
        until(lambda: "it did not answer within" in str(notices(read(rig.place))), 6.0)
        rig.lasers.frozen = False
        rig.ends_within(5.0)


def test_the_same_failure_is_told_again_of_light_that_was_let_out_anew(tmp_path: Path) -> None:
    silent = LightEnd(laser="bare", closings=(Closing(address="bare.emission", dark=False, wrong="it is silent"),))
    trip = Trip(causes=(Cause(name="door_box", kind="door", why="is not safe"),), lasers=("bare",), stops_arms=False)
    with guarded(tmp_path, watch=False) as rig:
        for _ in range(2):
            rig.lights.lit(())
            rig.lights.lit(("bare",))
            assert read(rig.place).ended is None
            rig.lights.ended(trip, (silent,))
            assert any("MAY STILL EMIT" in one.summary for one in notices(read(rig.place)))
            told = read(rig.place)
            rig.lights.slow(trip, (silent,))
            rig.lights.ended(trip, (silent,))
            assert read(rig.place) == told, "a try in vain is told once"


@pytest.mark.parametrize(
    ("policy", "ends"), [(None, set()), ("3R", {"laser", "bare"}), ("3B", {"laser"}), ("4", set())]
)
def test_a_curtain_ends_light_only_of_the_classes_that_the_policy_names(
    tmp_path: Path, policy: str | None, ends: set[str]
) -> None:
    with guarded(tmp_path, presence_ends=policy) as rig:  # laser may be set to class 3B, bare is of class 3R
        rig.inputs.put("veil", False)
        if ends:
            rig.ends_within(BAR, *ends)
        time.sleep(0.3)
        assert {name for name, lit in rig.lit().items() if not lit} == ends


def test_light_that_nothing_ends_stays_and_nothing_is_written_twice(tmp_path: Path) -> None:
    with guarded(tmp_path) as rig:
        assert rig.stays_lit()
        watch = read(rig.place).watch
        assert watch is not None and watch.lasers == ("bare", "laser") and notices(read(rig.place)) == ()
        assert rig.stays_lit(0.2) and read(rig.place).watch == watch


def test_light_let_out_anew_forgets_what_was_told_and_is_ended_again(tmp_path: Path) -> None:
    with guarded(tmp_path) as rig:
        rig.inputs.put("lock", False)
        rig.ends_within(BAR)
        until(lambda: bool(notices(read(rig.place))) and read(rig.place).watch is None)
        rig.inputs.put("lock", True)
        time.sleep(2.2)  # inputs are not asked meanwhile, which is not their fault
        rig.lasers.put("bare_head", True)
        assert rig.stays_lit(0.3, "bare")
        until(lambda: read(rig.place).watch is not None)
        assert notices(read(rig.place)) == ()
        rig.inputs.put("lock", False)
        rig.ends_within(BAR)


def test_inputs_are_not_asked_while_all_lasers_are_dark(tmp_path: Path) -> None:
    with guarded(tmp_path) as rig:
        rig.lasers.put("bare_head", False)
        rig.lasers.put("laser_shutter", False)
        until(lambda: rig.lights.guard is not None and rig.lights.guard.lit == ())
        rig.inputs.put("door_box", False)
        time.sleep(0.3)
        assert rig.lasers.is_("laser_head") and read(rig.place).ended is None, "behind its closed shutter it may be on"
        rig.lasers.put("laser_shutter", True)
        rig.ends_within(BAR)


def test_a_stop_ends_light_without_any_device_but_lasers_and_shutters(tmp_path: Path) -> None:
    with guarded(tmp_path, watch=False) as rig:
        rig.inputs.frozen = True
        ended = asyncio.run(rig.lights.end("a person stopped the bench", "a stop"))
        assert rig.lit() == {"laser": False, "bare": False}
        assert {end.laser: end.is_dark for end in ended.ends} == {"laser": True, "bare": True, "second": False}
        assert any("second MAY STILL EMIT" in one.summary for one in notices(read(rig.place)))


def test_a_stop_names_a_laser_that_a_killed_guard_watched_and_the_files_have_no_more(tmp_path: Path) -> None:
    with guarded(tmp_path, watch=False) as rig:
        write(rig.place, Note(watch=replace(watching(("removed", "bare"), ()), pid=2**22 - 1)))
        ended = asyncio.run(rig.lights.end("a person stopped the bench", "a stop"))
        assert {end.laser: end.is_dark for end in ended.ends}["removed"] is False
        assert any("removed MAY STILL EMIT" in one.summary for one in notices(read(rig.place)))


def test_a_guard_that_was_killed_is_told_by_who_comes_next(tmp_path: Path) -> None:
    with guarded(tmp_path, watch=False) as rig:
        gone = replace(watching(("bare", "laser"), ("laser",)), pid=2**22 - 1)
        write(rig.place, Note(watch=gone))
        (said,) = notices(read(rig.place))
        assert "has ended" in said.summary and "bare may have emitted unwatched" in said.summary
        asyncio.run(rig.lights._bench.connect())
        rig.lights.watch()
        until(lambda: read(rig.place).watch is not None)
        assert "has ended" in notices(read(rig.place))[0].summary, "it is told until light is let out anew"
        rig.lasers.put("bare_head", False)
        rig.lasers.put("laser_head", False)
        until(lambda: read(rig.place).watch is None)
        assert notices(read(rig.place)) != ()
        rig.lasers.put("bare_head", True)
        until(lambda: read(rig.place).watch is not None)
        assert notices(read(rig.place)) == ()


def test_a_dead_man_stays_open_while_it_is_guarded_and_closes_once_the_guard_is_gone(tmp_path: Path) -> None:
    with guarded(tmp_path, watchdog=0.5) as rig:
        assert asyncio.run(rig.lights.shutters["laser.shutter"].open(True))
        assert rig.stays_lit(1.2)
        watch = read(rig.place).watch
        assert watch is not None and watch.closes_itself == ("laser",)
        assert rig.lights.guard is not None
        rig.lights.guard.close()
        assert rig.ends_within(1.0, "laser") > 0.2, "by the box alone"
        assert rig.lasers.is_("laser_head") and rig.lasers.is_("bare_head"), "what has no dead-man stays on"


def test_a_box_without_a_dead_man_lets_no_light_out_that_was_to_have_one(tmp_path: Path) -> None:
    with guarded(tmp_path, watch=False, watchdog=0.5) as rig:
        rig.lasers.put("laser_shutter", False)
        rig.lasers.forgets_dead_men = True
        with pytest.raises(PicoError, match="has no dead-man"):
            asyncio.run(rig.lights.shutters["laser.shutter"].open(True))
        assert not rig.lasers.is_("laser_shutter")


class Stepped:
    """A clock that a test sets."""

    at = 100.0

    def __call__(self) -> float:
        return self.at


def test_a_guard_that_stood_still_blames_no_device_and_one_that_is_starved_notices_a_lost_link() -> None:
    clock = Stepped()
    awake = Awake(clock, HELD)
    hearing = Hearing(since=awake.now())
    hearing.answered("a.shutter", True, awake.now())
    clock.at += 3600.0
    assert hearing.silence("a.shutter", awake.now(), SILENT) == ""
    for _ in range(3):  # each look half a second after the one before
        clock.at += 0.5
        silent = hearing.silence("a.shutter", awake.now(), SILENT)
    assert "has not answered" in silent


class Head:
    """A laser that answers at once; one that is `silent` answers nothing."""

    def __init__(self) -> None:
        self.on, self.silent = True, False

    async def emit(self, on: bool) -> bool:
        if self.silent:
            await asyncio.sleep(30.0)
        self.on = on
        return on

    async def emitting(self) -> bool:
        if self.silent:
            await asyncio.sleep(30.0)
        return self.on


class Door:
    """A safety input that a test opens."""

    safe = True

    async def read(self) -> SafetyState:
        return SafetyState(safe=self.safe, age=0.0)


class Stuck:
    """An arm whose stop never ends."""

    asked = 0

    async def stop(self) -> None:
        self.asked += 1
        await asyncio.sleep(30.0)


class Slow(Told):
    """Who writes to a disk that hangs."""

    def __init__(self) -> None:
        self.released = threading.Event()

    def trips(self, trip: Trip) -> None:
        raise ValueError("a fault of who hears it")

    def ended(self, trip: Trip, ends: tuple[LightEnd, ...]) -> None:
        self.released.wait(10.0)


@contextmanager
def watched(heads: dict[str, Head], door: Door, told: Told, arm: Stuck | None = None) -> Iterator[Guard]:
    entry = SafetyEntry(kind="door", device="door_box", heartbeat=0.5)
    own: Any = Watched(
        lights=lambda: tuple(Light(n, (f"{n}.emission", one), {}) for n, one in heads.items()),  # type: ignore[arg-type]
        shutters={}, emissions={f"{n}.emission": one for n, one in heads.items()},  # type: ignore[misc]
        inputs={"door": (entry, door)}, classes=dict.fromkeys(heads, "3B"),  # type: ignore[dict-item]
        arms=lambda: (arm,) if arm else (),  # type: ignore[return-value,arg-type]
    )  # fmt: skip
    guard = Guard(own, told)
    guard.start()
    try:
        until(lambda: len(guard.lit) == len(heads))
        yield guard
    finally:
        for one in heads.values():
            one.silent = False
        guard.close()


def off_within(head: Head, seconds: float = BAR) -> None:
    until(lambda: not head.on, seconds)


def test_a_silent_box_keeps_the_light_of_no_other_laser_on(tmp_path: Path) -> None:
    heads, door = {"bare": Head(), "second": Head()}, Door()
    with watched(heads, door, Told()) as guard:
        heads["second"].silent = True
        until(lambda: "second.emission" in guard._closings)
        assert heads["bare"].on
        door.safe = False
        off_within(heads["bare"])
        assert "second.emission" in guard._closings, "while the silent one is still waited for"


def test_neither_a_journal_that_hangs_nor_an_arm_that_does_not_stop_delays_the_next_closing() -> None:
    heads, door, arm, told = {"bare": Head()}, Door(), Stuck(), Slow()
    with watched(heads, door, told, arm):
        try:
            for _ in range(3):
                door.safe = False
                off_within(heads["bare"])
                door.safe = True
                time.sleep(0.25)
                heads["bare"].on = True  # at its own key
                time.sleep(0.25)
            assert heads["bare"].on and arm.asked == 1, "an arm that is being stopped is not asked again"
        finally:
            told.released.set()


def test_a_locked_journal_keeps_no_note_and_no_light_waiting(tmp_path: Path) -> None:
    released = threading.Event()
    with guarded(tmp_path) as rig:
        rig.lights.listening = lambda ended, trip: released.wait(10.0)  # type: ignore[assignment]
        try:
            for name in ("lock", "door_box"):
                rig.inputs.put(name, False)
                rig.ends_within(BAR)
                until(lambda name=name: f"because {name}" in str(notices(read(rig.place))), 1.0)
                rig.inputs.put(name, True)
                time.sleep(0.3)
                for lit in LIGHTS:
                    rig.lasers.put(lit, True)
                until(lambda: rig.lights.guard is not None and len(rig.lights.guard.lit) == 2)
        finally:
            released.set()


def test_what_was_told_of_one_laser_stays_when_another_one_is_ended_later(tmp_path: Path) -> None:
    place = bench_at(tmp_path, "hardware")
    silent = LightEnd(laser="bare", closings=(Closing(address="bare.emission", dark=False, wrong="it is silent"),))
    dark = LightEnd(laser="laser", closings=(Closing(address="laser.shutter", dark=True),))
    first = Ended(at=clock.now(), why="bare.emission is silent", ends=(silent,))
    note = with_ended(Note(ended=first), replace(first, why="the door is open", ends=(dark,)))
    place.folder.mkdir(parents=True, exist_ok=True)
    write(place, note)
    said = " ".join(one.summary for one in notices(read(place)))
    assert "bare MAY STILL EMIT" in said and "light of laser was ended" in said and "the door is open" in said
    again = with_ended(note, replace(first, why="stop", ends=(dark, silent)))
    assert again.earlier == (), "the newest word on a laser counts"


def test_the_dead_man_of_a_head_is_kept_while_it_warms_up_behind_its_closed_shutter(tmp_path: Path) -> None:
    with guarded(tmp_path, head_watchdog=1.0) as rig:
        rig.lasers.put("laser_shutter", False)
        rig.lasers.put("laser_head", False)
        until(lambda: rig.lights.guard is not None and rig.lights.guard.lit == ("bare",))
        rig.lasers.put("bare_head", False)
        until(lambda: rig.lights.guard is not None and rig.lights.guard.lit == ())
        assert asyncio.run(rig.lights.emissions["laser.emission"].emit(True))
        time.sleep(2.2)
        assert rig.lasers.is_("laser_head"), "light may be let out of it"
        assert rig.lights.guard is not None
        rig.lights.guard.close()
        until(lambda: not rig.lasers.is_("laser_head"), 2.0)

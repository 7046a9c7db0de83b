"""What is kept of the guard: a damaged file is one clear message, and a full disk hides nothing."""

from __future__ import annotations

import asyncio
import errno
import json
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from boxes import guarded, until

from cli.views.stopped import text
from pico.backends.hardware.guard.note import EDGE_END, Note, notices, read, watching, write
from pico.base.state_files import GUARD
from pico.places.bench import BenchPlace

WATCH = {"pid": 2**22 - 1, "since": "2026-11-24T12:00:00Z", "lasers": ["bare"], "boot": ""}
ENDED = {"at": "2026-11-24T12:00:00Z", "why": "x", "by": "the guard", "ends": [{"laser": "bare", "closings": []}]}
FROZEN = {"until": "2026-11-24T12:00:00Z", "seconds": 2.0, "lasers": ["bare"]}


def put(place: BenchPlace, **document: Any) -> Path:
    path = GUARD.path(place.folder)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"schema": GUARD.schema, **document}), encoding="utf-8")
    return path


def test_a_file_that_is_right_is_read(tmp_path: Path) -> None:
    place = bench_at(tmp_path, "hardware")
    put(place, watch=WATCH, ended=ENDED, frozen=FROZEN)
    note = read(place)
    assert note.wrong is None and note.killed is not None and note.ended is not None and note.frozen is not None
    assert len(notices(note)) == 3


@pytest.mark.parametrize(
    ("document", "what"),
    [
        ({"watch": {**WATCH, "pid": 10**25}}, "pid"),
        ({"watch": {**WATCH, "pid": "abc"}}, "pid"),
        ({"watch": {**WATCH, "pid": -1}}, "pid"),
        ({"watch": {**WATCH, "lasers": "bare"}}, "lasers"),
        ({"killed": {**WATCH, "since": "yesterday"}}, "since"),
        ({"ended": {**ENDED, "at": "yesterday"}}, "at"),
        ({"ended": {**ENDED, "at": "0001-01-01T00:00:00+14:00"}}, "at"),
        ({"ended": {**ENDED, "why": 7}}, "why"),
        ({"ended": {**ENDED, "ends": [{"laser": "bare", "closings": [{"address": "a.b", "dark": "no"}]}]}}, "dark"),
        ({"earlier": [{**ENDED, "at": 5}]}, "at"),
        ({"frozen": {**FROZEN, "until": "never"}}, "until"),
        ({"frozen": {**FROZEN, "seconds": "long"}}, "seconds"),
    ],
)
def test_a_wrong_type_or_time_is_told_as_damage_of_the_file(tmp_path: Path, document: Any, what: str) -> None:
    place = bench_at(tmp_path, "hardware")
    path = put(place, **document)
    (said,) = notices(read(place))
    assert f"{path} cannot be read: {what} is" in said.summary and f"rm {path}" in said.hint
    write(place, Note())
    assert notices(read(place)) == (), "who guards the bench writes it anew"


def test_a_guard_begins_and_works_whatever_its_file_says(tmp_path: Path) -> None:
    put(bench_at(tmp_path, "hardware"), watch={**WATCH, "pid": 10**25}, ended={**ENDED, "at": "yesterday"})
    with guarded(tmp_path) as rig:
        rig.inputs.put("door_box", False)
        rig.ends_within(0.5)
        until(lambda: "because door_box" in str(notices(read(rig.place))))


def test_what_a_full_disk_does_not_take_is_told_by_who_guards(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with guarded(tmp_path) as rig:
        with monkeypatch.context() as disk:
            disk.setattr("pico.disk.replace_whole", full)
            rig.inputs.put("door_box", False)
            rig.ends_within(0.5)
            until(lambda: read(rig.place).ended is not None)
            said = " ".join(one.summary for one in notices(read(rig.place)))
            assert "light of bare, laser was ended at" in said and "what the guard did can't be kept" in said
        rig.lights._kept(lambda note: note)
        said = " ".join(one.summary for one in notices(read(rig.place)))
        assert "light of bare, laser was ended at" in said and "can't be kept" not in said
        assert "door_box" in GUARD.path(rig.place.folder).read_text(encoding="utf-8")


def test_a_process_that_lives_still_watches(tmp_path: Path) -> None:
    place = bench_at(tmp_path, "hardware")
    place.folder.mkdir(parents=True)
    write(place, Note(watch=watching(("bare",), ())))
    assert read(place).watch is not None and notices(read(place)) == ()


@pytest.mark.parametrize(("name", "ends"), [("door_box", True), ("estop", True), ("lock", True), ("veil", False)])
def test_a_trip_by_a_door_a_stop_or_an_interlock_ends_armings_and_one_by_a_curtain_does_not(
    tmp_path: Path, name: str, ends: bool
) -> None:
    with guarded(tmp_path, presence_ends="3R") as rig:
        asked: list[str] = []
        rig.lights.disarming = lambda by: (asked.append(by), ("laser",))[1]  # type: ignore[func-returns-value]
        rig.inputs.put(name, False)
        rig.ends_within(0.5)
        until(lambda: read(rig.place).ended is not None)
        (said,) = notices(read(rig.place))
        assert bool(asked) == ends and ("`pico laser arm laser`" in said.hint) == ends


def test_a_stop_ends_armings_and_says_it_again_when_it_is_given_again(tmp_path: Path) -> None:
    with guarded(tmp_path, watch=False) as rig:
        left = ["laser"]
        rig.lights.disarming = lambda by: tuple(left.pop() for _ in list(left))
        for _ in range(2):
            ended = asyncio.run(rig.lights.end("a person stopped the bench", "a stop"))
            assert ended.disarmed == ("laser",)
        assert "The arming of laser has ended: `pico laser arm laser`" in text(None, None, bench="b", light=ended)


def test_the_end_of_the_edge_is_told_as_that_and_ends_no_arming(tmp_path: Path) -> None:
    with guarded(tmp_path, watchdog=0.5) as rig:
        rig.lights.disarming = lambda by: ("laser",)
        write(rig.place, replace(read(rig.place), ended=None))
        rig.lights.emissions["second.emission"] = rig.lights.emissions["bare.emission"]  # each laser has a device
        ended = asyncio.run(rig.lights.end("the edge of this bench was stopped", EDGE_END, disarms=False))
        rig.lights.close()
        note = read(rig.place)
        assert note.watch is None and note.killed is None and ended.disarmed == ()
        (said,) = notices(note)
        assert said.severity == "note" and "the edge of this bench was stopped at" in said.summary
        assert "light of bare, laser, second is off" in said.summary

"""What the guard of a bench last did, as its state file has it: who guards which lasers, what ended their light and
why, and where a guard was killed or frozen while a laser emitted. Whoever opens the bench next reads it."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from pico.backends.hardware.guard.ending import Closing, LightEnd
from pico.base import clock
from pico.base.state_files import GUARD as FILE
from pico.diagnostics import Diagnostic, PicoError, warning
from pico.model.observation import GUARD
from pico.model.record import as_json, record
from pico.places.bench import BenchPlace

T = TypeVar("T")
CODE = GUARD
"""The code of all that is said of the guard."""
GUARDED, STOPPED, EDGE_END = "the guard", "a stop", "the end of the edge"
"""By whom light was ended."""


@record
class Watch:
    """Who guards lasers that may emit: the process, since when (ISO 8601, UTC), which lasers. `closes_itself`: those
    whose shutter closes by itself once the guard is gone."""

    pid: int
    since: str
    lasers: tuple[str, ...]
    closes_itself: tuple[str, ...] = ()
    boot: str = ""


@record
class Ended:
    """That light was ended: when (ISO 8601, UTC), why, and what became of each laser. `by`: the guard, a person's
    stop, or the end of the process that served the bench. `disarmed`: the lasers whose arming has ended with it."""

    at: str
    why: str
    ends: tuple[LightEnd, ...]
    by: str = GUARDED
    disarmed: tuple[str, ...] = ()


@record
class Frozen:
    """That the guard's process stood still while lasers might emit: until when, and for how long [s]."""

    until: str
    seconds: float
    lasers: tuple[str, ...]


@record
class Note:
    """All that is kept of the guard of one bench. `killed`: who guarded lasers and died before they were dark.
    `earlier`: what was ended before, since light was let out, of lasers that `ended` does not name. `wrong`: why its
    file does not say this; never written."""

    schema: str = FILE.schema
    watch: Watch | None = None
    ended: Ended | None = None
    killed: Watch | None = None
    frozen: Frozen | None = None
    earlier: tuple[Ended, ...] = ()
    wrong: Diagnostic | None = None


def with_ended(note: Note, ended: Ended) -> Note:
    """Return a note with light that was ended now; what it says of other lasers stays."""
    names = {one.laser for one in ended.ends}
    before = (*((note.ended,) if note.ended is not None else ()), *note.earlier)
    if note.ended is not None and note.ended.disarmed:
        ended = replace(ended, disarmed=tuple(sorted({*ended.disarmed, *note.ended.disarmed})))
    left = (replace(one, ends=tuple(end for end in one.ends if end.laser not in names)) for one in before)
    return replace(note, ended=ended, earlier=tuple(one for one in left if one.ends))


_unwritten: dict[Path, Note] = {}
"""What this process could not write, by file: it says it nevertheless, as long as it lives."""


def read(place: BenchPlace) -> Note:
    """Return what is kept of the guard of a bench, by this process alone if its file can't be written; a watch whose
    process is gone counts as killed, but on an emulated bench, where light ended with that process. Of a file that is
    damaged only that is returned."""
    path = FILE.path(place.folder)
    if path in _unwritten:
        return _unwritten[path]
    if (note := FILE.read(path, _note)) is None:
        return Note(wrong=FILE.wrong(path, _note))
    if note.watch is not None and not _alive(note.watch):
        note = replace(note, killed=None if place.name == "emulated" else note.watch, watch=None)
    return note


def write(place: BenchPlace, note: Note) -> None:
    """Keep it; raises PicoError if it can't be written, and then this process alone knows it."""
    path, whole = FILE.path(place.folder), replace(note, wrong=None)
    document = {key: value for key, value in as_json(whole).items() if key != "wrong"}
    try:
        FILE.write(path, document, what="what the guard did can't be kept", durable=False)
    except PicoError as exc:
        _unwritten[path] = replace(note, wrong=exc.diagnostics[0])
        raise
    _unwritten.pop(path, None)


def is_unwritten(place: BenchPlace) -> bool:
    """Return whether this process knows what its file does not say."""
    return FILE.path(place.folder) in _unwritten


def watching(lasers: tuple[str, ...], closes_itself: tuple[str, ...]) -> Watch:
    """Return that this process guards lasers from now on."""
    return Watch(pid=os.getpid(), since=clock.now(), lasers=lasers, closes_itself=closes_itself, boot=_boot())


def notices(note: Note) -> tuple[Diagnostic, ...]:
    """Return what a person must know of the guard, the most urgent first; nothing while all is as it should be."""
    found = list[Diagnostic]()
    every = (*((note.ended,) if note.ended is not None else ()), *note.earlier)
    found += [_left_lit(ended, one) for ended in every for one in ended.ends if not one.is_dark]
    for ended in every:
        dark = [one for one in ended.ends if one.is_dark]
        if dark and ended.by == GUARDED:
            found.append(_dark(ended, dark))
        elif dark and ended.by == EDGE_END:
            names = ", ".join(one.laser for one in dark)
            text = f"guard: the edge of this bench was stopped at {_local(ended.at)}, and light of {names} is off"
            found.append(Diagnostic("note", CODE, text, hint="let light out anew when it is needed"))
    if note.killed is not None:
        found.append(_killed(note.killed))
    if note.frozen is not None:
        text = (
            f"guard: its process stood still for {note.frozen.seconds:.1f} s until {_local(note.frozen.until)}, while "
        )
        text += f"{', '.join(note.frozen.lasers)} could emit unwatched"
        found.append(warning(CODE, text, hint="find out what froze this computer; `pico laser` shows the lasers"))
    if note.wrong is not None:
        text = f"guard: {note.wrong.summary}"
        found.append(warning(CODE, text, detail=note.wrong.detail, hint=note.wrong.hint))
    return tuple(found)


def _dark(ended: Ended, ends: Sequence[LightEnd]) -> Diagnostic:
    names = ", ".join(one.laser for one in ends)
    closed = ", ".join(c.address for one in ends for c in one.closings if c.dark)
    wrong = "; ".join(one.wrong for one in ends if one.wrong)
    text = f"guard: light of {names} was ended at {_local(ended.at)} because {ended.why}"
    detail = f"dark now: {closed}" + (f"; not reached: {wrong}" if wrong else "")
    hint = "make the table safe, then let light out anew"
    if ended.disarmed:
        again = ", ".join(f"`pico laser arm {name}`" for name in ended.disarmed)
        hint = f"make the table safe, then arm again what was armed: {again}"
    return warning(CODE, text, detail=detail, hint=hint)


def _left_lit(ended: Ended, one: LightEnd) -> Diagnostic:
    who = "guard" if ended.by == GUARDED else "stop"
    why = one.wrong or "no device of this bench closes a shutter of it or switches it off"
    text = (
        f"{who}: {one.laser} MAY STILL EMIT: at {_local(ended.at)} its light was to end because {ended.why}, and could "
    )
    hint = f"switch {one.laser} off at its own key; `pico stop --now` then tries again"
    return warning(CODE, f"{text}not be ended: {why}", hint=hint)


def _killed(watch: Watch) -> Diagnostic:
    names = ", ".join(watch.lasers)
    text = f"guard: the process that guarded {names} since {_local(watch.since)} (pid {watch.pid}) has ended"
    left = [name for name in watch.lasers if name not in watch.closes_itself]
    if left:
        hint = "`pico stop --now` ends light; `pico laser` shows what each laser reads now"
        return warning(CODE, f"{text}; {', '.join(left)} may have emitted unwatched since", hint=hint)
    return warning(CODE, f"{text}; their shutters close by themselves", hint="`pico laser` shows the lasers")


def _local(text: str) -> str:
    return f"{clock.parse(text).astimezone():%H:%M:%S}"


def _alive(watch: Watch) -> bool:
    if watch.boot != _boot():
        return False
    try:
        os.kill(watch.pid, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def _boot() -> str:
    try:
        return Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
    except OSError:
        return ""


def _note(document: Mapping[str, Any]) -> Note:
    def each(key: str, make: Callable[[Any], T]) -> T | None:
        return make(document[key]) if document.get(key) is not None else None

    return Note(
        watch=each("watch", _watch), ended=each("ended", _ended), killed=each("killed", _watch),
        frozen=each("frozen", _frozen), earlier=tuple(_ended(one) for one in document.get("earlier", ())),
    )  # fmt: skip


def _watch(document: Mapping[str, Any]) -> Watch:
    pid = document["pid"]
    if type(pid) is not int or not 0 < pid < 2**31:
        raise ValueError(f"pid is {str(pid)[:20]}, which is no process")
    return Watch(
        pid=pid, since=_time(document, "since"), lasers=_names(document, "lasers"),
        closes_itself=_names(document, "closes_itself") if "closes_itself" in document else (),
        boot=_text(document, "boot") if "boot" in document else "",
    )  # fmt: skip


def _ended(document: Mapping[str, Any]) -> Ended:
    ends = tuple(
        LightEnd(laser=_text(one, "laser"), closings=tuple(_closing(closing) for closing in one["closings"]))
        for one in document["ends"]
    )
    return Ended(
        at=_time(document, "at"),
        why=_text(document, "why"),
        by=_text(document, "by"),
        ends=ends,
        disarmed=_names(document, "disarmed") if "disarmed" in document else (),
    )


def _closing(document: Mapping[str, Any]) -> Closing:
    if type(document["dark"]) is not bool:
        raise ValueError("dark is neither true nor false")
    return Closing(address=_text(document, "address"), dark=document["dark"], wrong=str(document.get("wrong", "")))


def _frozen(document: Mapping[str, Any]) -> Frozen:
    seconds = document["seconds"]
    if type(seconds) not in (int, float) or not math.isfinite(seconds):
        raise ValueError(f"seconds is {str(seconds)[:20]}, which is no time")
    return Frozen(until=_time(document, "until"), seconds=seconds, lasers=_names(document, "lasers"))


def _text(document: Mapping[str, Any], key: str) -> str:
    if not isinstance(text := document[key], str):
        raise ValueError(f"{key} is {str(text)[:20]}, which is no text")
    return text


def _time(document: Mapping[str, Any], key: str) -> str:
    text = _text(document, key)
    try:
        _local(text)
    except (ValueError, OverflowError) as exc:
        raise ValueError(f"{key} is {text[:20]!r}, which is no time") from exc
    return text


def _names(document: Mapping[str, Any], key: str) -> tuple[str, ...]:
    names = document[key]
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise ValueError(f"{key} is {str(names)[:20]}, which are no names")
    return tuple(names)

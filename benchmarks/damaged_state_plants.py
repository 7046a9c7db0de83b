"""Faults that `damaged_state.py` plants in PICO, and must find. Each is planted in the process of a command."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Plant:
    """A fault in PICO."""

    plant: Callable[[], None]
    """Patches PICO in this process."""
    kinds: str
    """What the kinds of file match whose damage may show it."""
    pattern: str
    """What a violation by it matches."""
    commands: str = ""
    """What the commands match that may show it."""


def _skip_checksums() -> None:
    """No checksum of a file is compared."""
    from pico.base.state_file import StateFile

    StateFile.parse = lambda self, data: self.lifted(json.loads(data))  # type: ignore[method-assign]


def _ignore_damaged_stop() -> None:
    """A damaged request to stop counts as none."""
    from pico.base.state_files import STOP
    from pico.edge import stopping
    from pico.places.bench import BenchPlace

    asked = stopping.asked_to_stop

    def asking(place: BenchPlace, token: int) -> Any:
        return None if STOP.wrong(STOP.path(place.folder)) else asked(place, token)

    _replace_everywhere("asked_to_stop", asked, asking)


def _hide_paths() -> None:
    """Messages about a damaged file do not say which it is."""
    from pico.base.state_file import StateFile
    from pico.diagnostics import Diagnostic

    damaged = StateFile.damaged

    def vague(self: StateFile, path: Path, cause: str) -> Diagnostic:
        return replace(damaged(self, path, cause), summary="a file cannot be read", hint="`pico status`")

    StateFile.damaged = vague  # type: ignore[method-assign]


def _swallow_records() -> None:
    """Rows of a journal are taken for sound whatever they hold."""
    from pico.runs import damage

    for name in ("is_sound_record", "is_sound_head", "is_sound_part"):
        _replace_everywhere(name, getattr(damage, name), lambda *_: True)


def _replace_world() -> None:
    """A damaged simulated table counts as a new one."""
    from pico.base.state_files import WORLD

    _read_as_nothing(WORLD)


def _read_as_nothing(file: Any) -> None:
    from pico.base.state_file import StateFile
    from pico.diagnostics import PicoError

    read = StateFile.read

    def reading(self: StateFile, path: Path, make: Callable[[dict[str, Any]], Any]) -> Any:
        try:
            return read(self, path, make)
        except PicoError:
            if self is file:
                return None
            raise

    StateFile.read = reading  # type: ignore[method-assign]


def _refuse_for_caches() -> None:
    """A damaged cache stops the command that would make it anew."""
    from pico.base.state_file import StateFile

    read = StateFile.read

    def reading(self: StateFile, path: Path, make: Callable[[dict[str, Any]], Any]) -> Any:
        if self.kind == "cache" and path.exists():
            return self.made(path, path.read_bytes(), make)
        return read(self, path, make)

    StateFile.read = reading  # type: ignore[method-assign]


def _point_nowhere() -> None:
    """The way on that a message names leaves the damaged file where it is."""
    from pico.base.state_file import StateFile

    StateFile.way_on = lambda self, path: f"`pico status` shows {path}"  # type: ignore[method-assign]


def _fail_inside() -> None:
    """A damaged file ends in a mistake of PICO."""
    from pico.base.state_file import StateFile

    def made(self: StateFile, path: Path, data: bytes, make: Callable[[Mapping[str, Any]], Any]) -> Any:
        return make(self.parse(data))

    StateFile.made = made  # type: ignore[method-assign]


def _open_light() -> None:
    """A night whose terms are damaged is left as it is: its laser stays open."""
    from pico.base.state_files import UNATTENDED
    from pico.edge import terms_store
    from pico.places.bench import BenchPlace

    read = terms_store.read

    def reading(place: BenchPlace) -> Any:
        return None if UNATTENDED.wrong(UNATTENDED.path(place.folder)) else read(place)

    _replace_everywhere("read", read, reading)


def _replace_everywhere(name: str, old: object, new: object) -> None:
    import sys

    for module in list(sys.modules.values()):
        if getattr(module, "__name__", "").startswith(("pico", "cli")) and vars(module).get(name) is old:
            setattr(module, name, new)


PLANTS: dict[str, Plant] = {
    "checksum-off": Plant(
        _skip_checksums, r"world|dose|mornings", "does not name|silent|wrong motion|not named|committed"
    ),
    "stop-ignored": Plant(_ignore_damaged_stop, r"stop\.json", "request to stop"),
    "path-hidden": Plant(_hide_paths, r"world|chosen|labs\.json|dose", "not named"),
    "record-swallowed": Plant(_swallow_records, r"journal\.sqlite(-wal)?$", "silent|wrong motion|internal|Traceback"),
    "world-new": Plant(_replace_world, r"world\.json", "silent|wrong motion|another state"),
    "cache-refuses": Plant(_refuse_for_caches, r"audit\.json", "damage of a cache", r"plan|apply"),
    "way-nowhere": Plant(_point_nowhere, r"chosen|world|labs\.json", "does not lead on"),
    "failure-inside": Plant(_fail_inside, r"chosen|world|faults|lab\.json", "internal|PICO itself|Traceback"),
    "night-open": Plant(_open_light, r"unattended\.json", "wrong motion|silent|light"),
}

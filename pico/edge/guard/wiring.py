"""The wiring of a real bench: read from the files of its folder each time its edge starts, and not kept with the Lab
that the bench adopts, so that a new safety input counts at once. An edge that started before the files changed lets no
more light out."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from pico.backends.devices import EMULATED, HARDWARE
from pico.diagnostics import Diagnostic, error
from pico.manifest.files import read_folder
from pico.model.setup import Setup
from pico.model.wiring import Wiring
from pico.places.bench import BenchPlace

CODE = "wiring"
_DEVICES = re.compile(rb"^[\"']?kind[\"']?\s*:\s*[\"']?Devices\b", re.MULTILINE)


class BenchWiring:
    """The wiring of the bench at `place`, read by `wired`, and whether the files say another one since."""

    def __init__(self, place: BenchPlace) -> None:
        self._place, self._has = place, place.name in (HARDWARE, EMULATED)
        self._files: tuple[bytes, ...] = ()
        self._wiring: Wiring | None = None
        self._told: Diagnostic | None = None

    def wired(self, setup: Setup, kept: Mapping[str, bytes] | None) -> Setup:
        """Return a bench as the files wire it now; as it is, if these say nothing of instruments or are wrong, for its
        light must be ended even then. `kept`: the files that it was read from, None if the folder's own."""
        if not self._has:
            return setup
        self._files, self._told = _files(self._place.root), None
        known = setup.wiring is not None and (kept is None or _of(kept) == self._files)
        found = setup.wiring if known else _wiring(self._place.root)
        self._wiring = found
        if found is None and (self._files or setup.wiring is not None):
            self._told = _changed()
        return setup if found is None else replace(setup, wiring=found)

    def refusal(self) -> Diagnostic | None:
        """Return why no light is let out here: the instruments are wrong, or others than those at work; else None."""
        if not self._has:
            return None
        if (now := _files(self._place.root)) != self._files:
            self._files, found = now, _wiring(self._place.root)
            self._told = _changed() if found is None or found != self._wiring else None
        return self._told


def _changed() -> Diagnostic:
    text = "no light is let out: the devices file was changed after the guard of this bench started, or can't be read"
    hint = "check the file with `pico validate`, then end all light with `pico stop --now`: a guard that PICO started "
    hint += "exits within seconds; restart your own `pico edge`. Then repeat this command"
    return error(CODE, text, hint=hint)


def _files(root: Path) -> tuple[bytes, ...]:
    return _of(read_folder(root)[0])


def _of(files: Mapping[str, bytes]) -> tuple[bytes, ...]:
    return tuple(sorted(data for data in files.values() if _DEVICES.search(data)))


def _wiring(root: Path) -> Wiring | None:
    """Return the wiring that the files describe, None if they describe none, or it is wrong."""
    from pico.manifest.load import load_folder

    found = load_folder(root).setup
    return found.wiring if found is not None else None

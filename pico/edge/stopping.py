"""Stopping a run from another terminal: a note beside the lock, for the holder of one lease. It needs no lock."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from pico.base.plain_files import read_file
from pico.base.state_files import STOP
from pico.diagnostics import PicoError
from pico.edge.protocol import Asking
from pico.places.bench import BenchPlace


def ask_to_stop(place: BenchPlace, token: int, how: Asking) -> None:
    """Ask the holder of the lease `token` of the bench at `place` to stop; raises PicoError where it can't be asked."""
    path = _note(place)
    what = f"the request to stop cannot be written to {path}; press Ctrl-C in the terminal of the run"
    STOP.write(path, {"token": token, "how": how}, what=what, durable=False)


def asked_to_stop(place: BenchPlace, token: int) -> Asking | None:
    """Return how the holder of the lease `token` was asked to stop, or None if it was not. A note that is damaged asks
    to stop now: what lay there before the lease began, `forget` has cleared."""
    path = _note(place)
    try:
        return STOP.made(path, read_file(path), lambda note: _how(note, token))
    except OSError:
        return None
    except PicoError:
        return "now"


def forget(place: BenchPlace) -> None:
    """Clear the note for an earlier lease, before another one begins."""
    with suppress(OSError):
        _note(place).unlink(missing_ok=True)


def _how(note: Mapping[str, Any], token: int) -> Asking | None:
    if int(note["token"]) != token:
        return None
    return "now" if note["how"] == "now" else "safely"


def _note(place: BenchPlace) -> Path:
    return STOP.path(place.folder)

"""Stopping a run from another terminal: a note beside the lock, for the holder of one lease. It needs no lock."""

from __future__ import annotations

import json
from pathlib import Path

from pico.disk import write_whole
from pico.edge.protocol import Asking
from pico.places.bench import BenchPlace


def ask_to_stop(place: BenchPlace, token: int, how: Asking) -> None:
    """Ask the holder of the lease `token` of the bench at `place` to stop; raises PicoError where it can't be asked."""
    path = _note(place)
    note = json.dumps({"token": token, "how": how}).encode()
    what = f"the request to stop cannot be written to {path}; press Ctrl-C in the terminal of the run"
    write_whole(path, note, what=what, code="stop", durable=False)


def asked_to_stop(place: BenchPlace, token: int) -> Asking | None:
    """Return how the holder of the lease `token` was asked to stop, or None where it was not."""
    try:
        note = json.loads(_note(place).read_text(encoding="utf-8"))
        if note["token"] != token:
            return None
        return "now" if note["how"] == "now" else "safely"
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _note(place: BenchPlace) -> Path:
    return place.folder / "stop.json"

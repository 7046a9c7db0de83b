"""Stopping a run from another terminal: a note beside the lock, for the holder of one lease. It needs no lock."""

from __future__ import annotations

import json
from pathlib import Path

from pico.attachment import bench_folder
from pico.disk import write_whole
from pico.edge.protocol import Asking


def ask_to_stop(root: Path, token: int, how: Asking) -> None:
    """Ask the holder of the lease `token` of the lab in `root` to stop; raises PicoError where it can't be asked."""
    path = _note(root)
    note = json.dumps({"token": token, "how": how}).encode()
    what = f"the request to stop cannot be written to {path}; press Ctrl-C in the terminal of the run"
    write_whole(path, note, what=what, code="stop", durable=False)


def asked_to_stop(root: Path, token: int) -> Asking | None:
    """Return how the holder of the lease `token` was asked to stop, or None where it was not."""
    try:
        note = json.loads(_note(root).read_text(encoding="utf-8"))
        if note["token"] != token:
            return None
        return "now" if note["how"] == "now" else "safely"
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _note(root: Path) -> Path:
    return bench_folder(root) / "stop.json"

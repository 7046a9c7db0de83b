"""The process that guards a real bench beside any command: an edge that serves it like `pico edge`, started before a
command lets light out and by one that leaves light on. It ends by itself once every laser is proven dark, nothing moves
and no client asks anything.

`python -m pico.edge.link.resident LAB BENCH` is that process. It says one line of JSON, `{"ready": PID}` or the
diagnostics of what keeps it from serving.
"""

from __future__ import annotations

import asyncio
import json
import os
import select
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

from pico.backends.device import LightGuarded
from pico.diagnostics import Diagnostic, PicoError, error
from pico.edge.link import place as sockets
from pico.edge.link.server import edge_of, serve
from pico.edge.local import LocalEdge
from pico.model.record import as_json
from pico.places.bench import BenchPlace

MODULE = "pico.edge.link.resident"
READY = 60.0
"""How long it may take until all devices are connected [s]."""
IDLE = 20.0
"""How long it stays once all is dark and nobody asks anything [s]: the next command finds the links open."""


def ensure(place: BenchPlace) -> None:
    """Have a process serve and guard a bench, if none does; returns once it is at work. Raises PicoError if it can't
    begin, with what keeps it."""
    if sockets.find(place) is not None:
        return
    words = [sys.executable, "-m", MODULE, str(place.root.resolve()), place.name]
    quiet = subprocess.DEVNULL
    process = subprocess.Popen(
        words, stdin=quiet, stdout=subprocess.PIPE, stderr=quiet, cwd=place.root, start_new_session=True
    )
    said = _first_line(process)
    if "ready" in said:
        # whoever started it may outlive it, and must not keep it among the living
        threading.Thread(target=process.wait, daemon=True, name="pico resident").start()
        return
    if process.poll() is None:
        process.terminate()
    found = [Diagnostic(**one) for one in said.get("wrong", ())]
    text = "the process that guards this bench can't begin, so no light is let out"
    hint = "`pico --backend hardware edge` in a terminal of its own shows why"
    raise PicoError([error("guard", text, hint="" if found else hint), *found])


def _first_line(process: subprocess.Popen[bytes]) -> dict[str, Any]:
    assert process.stdout is not None
    until, data = time.monotonic() + READY, b""
    with process.stdout:
        while not data.endswith(b"\n"):
            ready, _, _ = select.select([process.stdout], [], [], max(0.0, until - time.monotonic()))
            piece = os.read(process.stdout.fileno(), 65536) if ready else b""
            if not piece:
                return {}
            data += piece
    found: dict[str, Any] = json.loads(data)
    return found


def _main(root: str, name: str) -> int:
    place = BenchPlace(Path(root), name)
    try:
        asyncio.run(_served(edge_of(place)))
    except PicoError as exc:
        _say({"wrong": [{"severity": d.severity, "code": d.code, "summary": d.summary, "hint": d.hint}
                        for d in exc.diagnostics]})  # fmt: skip
        return int(exc.exit_code)
    return 0


async def _served(edge: LocalEdge) -> None:
    try:
        assert isinstance(edge.device, LightGuarded)  # the bench of another device has no light to guard
        await edge.device.guarded()
        await serve(edge, lambda: _say({"ready": os.getpid()}), idle=_Idle(edge).is_over)
    finally:
        await edge.close()


class _Idle:
    """For how long nothing has needed this process."""

    def __init__(self, edge: LocalEdge) -> None:
        self._edge, self._since = edge, time.monotonic()

    def is_over(self, attached: bool) -> bool:
        """Return whether the process is needed no more; `attached`: whether a client is connected."""
        device = self._edge.device
        lit = isinstance(device, LightGuarded) and device.may_emit()
        if attached or lit or self._edge.moving() or self._edge.lease is not None:
            self._since = time.monotonic()
        elif self._edge.apparatus.wiring.refusal() is not None:
            return True  # the next command starts one with the instruments that there are now
        return time.monotonic() - self._since > IDLE


def _say(document: dict[str, Any]) -> None:
    """Say the one line, and nothing after it: who started this process may be gone."""
    os.write(1, json.dumps(as_json(document)).encode() + b"\n")
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 1)
    os.dup2(quiet, 2)


if __name__ == "__main__":
    sys.exit(_main(*sys.argv[1:]))

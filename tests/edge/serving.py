"""A process that serves the edge of a lab, forked from this one."""

from __future__ import annotations

import asyncio
import gc
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pico.edge.link.server import edge_of, serve
from pico.places.bench import BenchPlace


def _serve(root: Path, fidelity: str, ready: int) -> None:
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    asyncio.run(serve(edge_of(BenchPlace(root, "sim"), fidelity), lambda: os.write(ready, b"1") and None))


@contextmanager
def served(root: Path, fidelity: str = "kinematic") -> Iterator[int]:
    """Serve the simulated bench of the lab in `root` meanwhile; yields the process."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            os.close(reading)
            gc.freeze()  # nothing that was there before is looked through for garbage
            os.setsid()
            _serve(root, fidelity, writing)
            code = 0
        except BaseException as exc:
            print(f"the edge ended: {exc!r}", file=sys.stderr, flush=True)
        finally:
            os._exit(code)
    os.close(writing)
    try:
        assert os.read(reading, 1) == b"1"
        yield child
    finally:
        os.close(reading)
        os.kill(child, signal.SIGTERM)
        os.waitpid(child, 0)

"""How often functions of the library are called: what counts is work, never seconds."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

ROOT = Path(__file__).resolve().parent.parent


@contextmanager
def counting(names: Mapping[str, tuple[str, ...]]) -> Iterator[Counter[str]]:
    """Count the calls of functions, by file below `pico/` and qualified name."""
    calls: Counter[str] = Counter()
    wanted = {(str(ROOT / "pico" / file), name) for file, each in names.items() for name in each}

    def note(frame: FrameType, event: str, _: object) -> None:
        code = frame.f_code
        if event == "call" and (code.co_filename, code.co_qualname) in wanted:
            calls[code.co_qualname] += 1

    sys.setprofile(note)
    try:
        yield calls
    finally:
        sys.setprofile(None)


def line(name: object, calls: Counter[str]) -> str:
    """Return counts as they are kept."""
    return f"{name}: " + ", ".join(f"{what} {count}" for what, count in sorted(calls.items()))

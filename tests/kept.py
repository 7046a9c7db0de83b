"""Results that are kept in tests/golden. Where a change is meant to change them, write them again and look:

PICO_UPDATE_GOLDEN=1 python -m pytest TESTS && git diff tests/golden
"""

from __future__ import annotations

import os
from pathlib import Path

GOLDEN = Path(__file__).resolve().parent / "golden"


def kept(name: str, text: str) -> str:
    """Return what is kept under a name; where results are to be written again, `text`, which is kept from now on."""
    path = GOLDEN / name
    if os.environ.get("PICO_UPDATE_GOLDEN"):
        path.write_text(text)
    return path.read_text()


def differs(name: str, text: str) -> str:
    """Return the first line that is not as it is kept, with the one that is kept; "" where all are."""
    was, now = kept(name, text).splitlines(), text.splitlines()
    both = ((a, b) for a, b in zip([*was, *[""] * len(now)], [*now, *[""] * len(was)], strict=False) if a != b)
    why = "where that is meant: PICO_UPDATE_GOLDEN=1, then look at git diff tests/golden"
    return next((f"{name} has\n  {a}\nand not\n  {b}\n{why}" for a, b in both), "")

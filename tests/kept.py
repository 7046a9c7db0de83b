"""Results that are kept in tests/golden. Where a change is meant to change them, write them again and look:

PICO_UPDATE_GOLDEN=1 python -m pytest TESTS && git diff tests/golden
"""

from __future__ import annotations

import math
import os
import re
from pathlib import Path

GOLDEN = Path(__file__).resolve().parent / "golden"


def kept(name: str, text: str) -> str:
    """Return what is kept under a name; where results are to be written again, `text`, which is kept from now on."""
    path = GOLDEN / name
    if os.environ.get("PICO_UPDATE_GOLDEN"):
        path.write_text(text)
    return path.read_text()


def differs(name: str, text: str, within: float = 0.0) -> str:
    """Return the first line that is not as it is kept, with the one that is kept; "" where all are.

    Numbers count as the same `within` this share or a millionth: the last digits of a fit are the processor's.
    """
    was, now = kept(name, text).splitlines(), text.splitlines()
    both = zip([*was, *[""] * len(now)], [*now, *[""] * len(was)], strict=False)
    wrong = ((a, b) for a, b in both if a != b and not (within and _alike(a, b, within)))
    why = "where that is meant: PICO_UPDATE_GOLDEN=1, then look at git diff tests/golden"
    return next((f"{name} has\n  {a}\nand not\n  {b}\n{why}" for a, b in wrong), "")


_NUMBER = re.compile(r"(-?\d+\.?\d*(?:e[-+]?\d+)?)")


def _alike(a: str, b: str, within: float) -> bool:
    """Whether two lines differ in numbers alone, and in none of them by much."""
    (*first,), (*second,) = _NUMBER.split(a), _NUMBER.split(b)
    return first[::2] == second[::2] and all(
        math.isclose(float(x), float(y), rel_tol=within, abs_tol=1e-6)
        for x, y in zip(first[1::2], second[1::2], strict=True)
    )

"""Names in a sentence."""

from __future__ import annotations

from collections.abc import Sequence

MOST = 6
"""More names than this are not read."""


def listed(names: Sequence[str], word: str = "and") -> str:
    """Return names as in a sentence: `a`, `a and b`, `a, b and c`; of many only the first four, and how many more."""
    if len(names) > MOST:
        return f"{', '.join(names[:4])} {word} {len(names) - 4} more"
    return f" {word} ".join(part for part in (", ".join(names[:-1]), *names[-1:]) if part)

"""Values that no device of a bench reads, so that no comparison says anything of them."""

from __future__ import annotations

from collections.abc import Sequence

from .style import count

MOST = 6


def in_known(addresses: Sequence[str]) -> str:
    """Return ` in all known values`, which limits what is said to be equal; empty if all values are known."""
    return " in all known values" if addresses else ""


def unread(addresses: Sequence[str]) -> str:
    """Return `1 value is unknown, because no device of this bench reads it: cam.gain.`; empty for none."""
    if not addresses:
        return ""
    verb, them = ("is", "it") if len(addresses) == 1 else ("are", "them")
    shown = ", ".join(addresses[:MOST]) + (f" and {len(addresses) - MOST} more" if len(addresses) > MOST else "")
    values = count(len(addresses), "value")
    return f"{values} {verb} unknown, because no device of this bench reads {them}: {shown}."

"""What a comparison of a bench with a state says nothing of: values that no device reads, and settings that no state
names."""

from __future__ import annotations

from collections.abc import Sequence

from pico.model.comparing.unstated import Unstated
from pico.model.diff import show_value

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


def in_no_state(found: Sequence[Unstated]) -> str:
    """Return `Set on the bench, but in no state: camera.exposure 7 ms; ...`, and what writes it; empty for none."""
    if not found:
        return ""
    shown = ", ".join(f"{one.address} {show_value(one.value)} {one.unit}".rstrip() for one in found[:MOST])
    more = f" and {len(found) - MOST} more" if len(found) > MOST else ""
    them = "it" if len(found) == 1 else "them"
    names = " ".join(one.address for one in found)
    return f"Set on the bench, but in no state: {shown}{more}; `pico capture {names}` writes {them} into the manifest."

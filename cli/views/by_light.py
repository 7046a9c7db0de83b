"""What light has yet to find, in a line."""

from __future__ import annotations

from collections.abc import Sequence

from .style import listed


def unfound(goal: str, addresses: Sequence[str]) -> str:
    """Return that a bench is as wanted but for what light has yet to find, and what finds it; empty for nothing."""
    if not addresses:
        return ""
    finds = f"`pico optimize {addresses[0]}` finds it" if len(addresses) == 1 else "`pico apply --align` finds them"
    return f"The bench equals {goal}, but for {listed(addresses)}, which light has yet to find: {finds}."


def stays(addresses: Sequence[str]) -> str:
    """Return that set-points which light finds stay as the manifest has them; empty for none."""
    if not addresses:
        return ""
    verb, them = ("is", "it") if len(addresses) == 1 else ("are", "them")
    back = f"`pico optimize {addresses[0]}`" if len(addresses) == 1 else "`pico apply --align`"
    return (
        f"In the manifest {listed(addresses)} {verb} where light says, which no capture changes: {back} finds {them}."
    )

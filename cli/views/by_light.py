"""What light has yet to find, in a line."""

from __future__ import annotations

from collections.abc import Sequence

from pico.model.diff import Change

from .style import listed, place


def unfound(goal: str, addresses: Sequence[str]) -> str:
    """Return that a bench is as wanted but for what light has yet to find, and what finds it; empty for nothing."""
    if not addresses:
        return ""
    finds = f"`pico optimize {addresses[0]}` finds it" if len(addresses) == 1 else "`pico apply --align` finds them"
    return f"The bench equals {goal}, but for {listed(addresses)}, which light has yet to find: {finds}."


def excepted(changes: Sequence[Change]) -> str:
    """Return `, except light: laser.shutter stays closed; m1.tip stays where coupling has the last word`: what differs
    from a state and does not count; empty for nothing."""
    light = [f"{c.component}.{c.tunable} stays {place(c.before)}" for c in changes if c.requested and not c.tolerated]
    said = [f"light: {listed(light)}"] if light else []
    for goal in dict.fromkeys(c.aligned.goal for c in changes if c.aligned):
        own = [f"{c.component}.{c.tunable}" for c in changes if c.aligned and c.aligned.goal == goal]
        verb = "stays" if len(own) == 1 else "stay"
        said.append(f"{listed(own)} {verb} where {goal} has the last word")
    return f", except {'; '.join(said)}" if said else ""


def stays(addresses: Sequence[str]) -> str:
    """Return that set-points which light finds stay as the manifest has them; empty for none."""
    if not addresses:
        return ""
    verb, them = ("is", "it") if len(addresses) == 1 else ("are", "them")
    back = f"`pico optimize {addresses[0]}`" if len(addresses) == 1 else "`pico apply --align`"
    return (
        f"In the manifest {listed(addresses)} {verb} where light says, which no capture changes: {back} finds {them}."
    )

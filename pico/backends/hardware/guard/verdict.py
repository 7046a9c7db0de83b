"""Whether light must end now: a pure function of what safety inputs and lasers last said."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from pico.model.arming import CLASSES, LaserClass
from pico.model.record import record
from pico.model.wiring import SafetyKind

MOTION: frozenset[SafetyKind] = frozenset({"door", "curtain", "emergency_stop"})
"""Kinds of safety inputs that keep arms from moving while they are not safe."""
LIGHT: frozenset[SafetyKind] = frozenset({"door", "emergency_stop", "key", "interlock"})
"""Kinds of safety inputs that keep light from being let out while they are not safe."""
PRESENCE: frozenset[SafetyKind] = frozenset({"curtain"})
"""Kinds that end light only from the laser class on that the policy names (`presence_ends`)."""


@record
class InputState:
    """A safety input as it last reported itself: its kind, and `why` it does not count as safe, '' while it does."""

    kind: SafetyKind
    why: str = ""


@record
class LaserState:
    """A laser as its devices last reported themselves.

    `emission`: None if unknown. `shutters`: whether each shutter that closes its beam is open, None if unknown.
    `of`: its class as it is set. `silent`: its devices that do not answer, each with why.
    """

    emission: bool | None
    shutters: tuple[bool | None, ...] = ()
    of: LaserClass = "4"
    silent: Mapping[str, str] = field(default_factory=dict)

    @property
    def is_dark(self) -> bool:
        """Whether it is proven that no light leaves it."""
        return self.emission is False or False in self.shutters


@record
class Cause:
    """Why light must end: the safety input, or the device that does not answer, its kind, and what is wrong with it."""

    name: str
    kind: SafetyKind | Literal["link"]
    why: str

    @property
    def said(self) -> str:
        """The cause in words."""
        kind = "" if self.kind == "link" else f" ({self.kind.replace('_', ' ')})"
        return f"{self.name}{kind} {self.why}"


@record
class Trip:
    """The lasers whose light must end, and why. `stops_arms`: arms must stop for the same cause."""

    causes: tuple[Cause, ...]
    lasers: tuple[str, ...]
    stops_arms: bool

    @property
    def said(self) -> str:
        """The causes in words."""
        return "; ".join(cause.said for cause in self.causes)


def verdict(
    inputs: Mapping[str, InputState], lasers: Mapping[str, LaserState], presence_ends: LaserClass | None = None
) -> Trip | None:
    """Return which lasers must end their light now, and why; None while no light can be out, or all is as it should be.

    `presence_ends`: the lowest class whose light a curtain ends; None for none. A laser counts as shining unless its
    emission is proven off or one of its shutters is proven closed.
    """
    lit = {name: state for name, state in lasers.items() if not state.is_dark}
    causes, ended = list[Cause](), set[str]()
    for name, state in sorted(inputs.items()):
        concerned = {laser for laser, own in lit.items() if state.why and _ends(state.kind, own.of, presence_ends)}
        if concerned:
            causes.append(Cause(name=name, kind=state.kind, why=state.why))
            ended |= concerned
    for laser, own in sorted(lit.items()):
        for device, why in sorted(own.silent.items()):
            causes.append(Cause(name=device, kind="link", why=why))
            ended.add(laser)
    if not causes:
        return None
    unique = tuple(dict.fromkeys(causes))
    stops = any(cause.kind in MOTION for cause in unique)
    return Trip(causes=unique, lasers=tuple(sorted(ended)), stops_arms=stops)


def _ends(kind: SafetyKind, of: LaserClass, presence_ends: LaserClass | None) -> bool:
    if kind in PRESENCE:
        return presence_ends is not None and CLASSES.index(of) >= CLASSES.index(presence_ends)
    return kind in LIGHT

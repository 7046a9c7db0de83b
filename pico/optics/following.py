"""A source's beam followed through all that it meets, breadth first, down to a share of its power or up to a count."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import cast

import numpy as np
from numpy.typing import NDArray

from pico.manifest.checks.elements import GROUP
from pico.optics.axis import Optic, Ray, beside_the_edge, first_met
from pico.optics.beam import Beam, forward, scaled
from pico.optics.emission import emit
from pico.optics.geometry import Event
from pico.optics.part import Element, Met, Part, Straying
from pico.plug_ins.calling import Interface, function, instance
from pico.registered import module

FAINT = 1e-10
"""The share of a source's power below which a beam is followed no more; ghosts of ghosts are below it."""
LEAST = 1e-4
"""The share of a beam that must pass an aperture beside its chief ray for it not to end on the housing."""
_WINGS = 2.5
"""Radii of a beam from its chief ray within which light is looked for: beyond are 4e-6 of it."""
MOST = 256
"""Stretches after which a beam that goes round and round is followed no more."""
MOST_ASTRAY = 1024
"""The same where reflections of coated faces are followed, too."""
Least = Callable[[Beam], float]
"""The power [mW] below which what comes of a source's beam is followed no more."""


@dataclass(frozen=True, eq=False)
class Crossing:
    """A beam that comes to a component: as it arrives (`beam`), what becomes of it, its `power` before and after [mW],
    and which share an edge stopped. `component` is empty where it leaves the table; `before`: the number of the
    crossing that it comes from, None for the first."""

    component: str
    event: Event
    beam: Beam
    power: float
    onward: float
    clipped: float
    before: int | None


Made = tuple[tuple[str, Event, float], Crossing, tuple[Beam, ...]]
"""What a beam met, how far ahead [mm], and what became of it."""


INTERFACE = Interface(GROUP, {"meet": function}, {"meet": instance(Met), "strays": instance(tuple)})


@cache
def element(name: str) -> Element:
    """Return what an element does; raises KeyError where no file bears its name, and PicoError for
    a plug-in that is broken."""
    return cast(Element, module(INTERFACE, name))


@dataclass(frozen=True)
class Before:
    """What is known of a light that is the same but for what is `changed`."""

    begun: Mapping[str, Beam]
    made: Mapping[tuple[int, str], Made]
    changed: Collection[str]

    def first(self, source: Part) -> Beam:
        """Return the beam of a source."""
        known = None if source.name in self.changed else self.begun.get(source.name)
        return known or emit(source)

    def became(self, beam: Beam, leaves: str, meets: tuple[str, Event, float]) -> Made | None:
        """Return what became of this very beam at what it meets; None where that may be another now."""
        made = None if meets[0] in self.changed else self.made.get((id(beam), leaves))
        return made if made is not None and made[0] == meets else None


@dataclass
class Followed:
    """A source's beam as it is followed, breadth first. What becomes of beams goes to `made`; `left`: what was not
    followed, each beam with the component that it leaves."""

    table: tuple[float, float]
    parts: Mapping[str, Part]
    optics: Sequence[Optic]
    astray: Least | None
    known: Before
    made: dict[tuple[int, str], Made]
    left: list[tuple[Beam, str]] = field(default_factory=list)

    def crossings(self, first: Beam, source: str, number: int) -> Iterator[Crossing]:
        """Yield the crossings of a source's beam, from a number on."""
        least = self.astray(first) if self.astray else FAINT * first.power
        rays: list[tuple[Beam, str, int | None]] = [(first, source, None)]
        most = MOST_ASTRAY if self.astray else MOST
        for count, (beam, leaves, before) in enumerate(rays):
            if count == most:
                self.left = [(b, name) for b, name, _ in rays[count:]]
                return
            meets, optic, ray = self._next(beam, leaves)
            found = self.known.became(beam, leaves, meets) or (
                meets, *_crossing(self.parts, beam, ray, optic, meets[1], meets[2], bool(self.astray)),
            )  # fmt: skip
            self.made[id(beam), leaves] = found
            yield replace(found[1], before=before)
            rays += [(b, found[1].component, number + count) for b in found[2] if b.power > least]

    def _next(self, beam: Beam, leaves: str) -> tuple[tuple[str, Event, float], Optic | None, Ray]:
        """What a beam meets next."""
        ray = Ray(_point(beam.at), _point(beam.along), beam.length, leaves)
        optic, event, far = first_met(self.table, self.optics, ray)
        return (optic.name if optic else "", event, far), optic, ray

    def reached(self, source: str, followed: Sequence[Crossing], first: int) -> frozenset[str]:
        """Return the components that what was left may come to: the next ones, and all that light went on to from
        these; all components, if it comes to one that nothing was seen to leave."""
        onward: dict[str, set[str]] = {}
        for crossing in followed:
            came = source if crossing.before is None else followed[crossing.before - first].component
            onward.setdefault(came, set()).add(crossing.component)
        found, todo = set[str](), [self._next(beam, leaves)[0] for beam, leaves in self.left]
        names = {name for name, event, _ in todo if name}
        if any(name not in onward and event in ("passed", "reflected", "divided") for name, event, _ in todo):
            return frozenset(self.parts)
        while names:
            name = names.pop()
            if name not in found:
                found.add(name)
                names |= onward.get(name, set()) - {""}
        return frozenset(found)


def _crossing(
    parts: Mapping[str, Part], beam: Beam, ray: Ray, optic: Optic | None, event: Event, far: float, astray: bool
) -> tuple[Crossing, tuple[Beam, ...]]:  # fmt: skip
    """Return what becomes of a beam at what it comes to next, and the beams that go on from there, with those that go
    `astray`."""
    met = Met(forward(beam, far))
    if optic is not None and event != "blocked":
        met = element(optic.element).meet(parts[optic.name], beam)
    elif optic is not None and (beside := beside_the_edge(optic, ray, _WINGS * met.came.widths[0])):
        # the chief ray is stopped, not all that is around it
        partly = element(optic.element).meet(parts[optic.name], beam)
        if partly.clipped < 1.0 - LEAST:
            met, event = partly, beside
    if optic is not None and parts[optic.name].unseen.loss:
        met = replace(met, onward=tuple(cleared(b, parts[optic.name]) for b in met.onward))
    onward = sum(b.power for b in met.onward)
    name = optic.name if optic else ""
    crossing = Crossing(name, met.event or event, met.came, beam.power, onward, met.clipped, None)
    return crossing, (*met.onward, *_strays(parts[name], beam, met)) if astray and met.onward else met.onward


def _strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what a part sends astray, none of an element that does not say."""
    found = element(part.optic.element)
    return cast(Straying, found).strays(part, beam, met) if hasattr(found, "strays") and met.clipped < 1.0 else ()


def cleared(beam: Beam, part: Part) -> Beam:
    """Return what dirt on a component lets through of a beam."""
    return scaled(beam, math.sqrt(1.0 - part.unseen.loss)) if part.unseen.loss else beam


def _point(vector: NDArray[np.float64]) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z

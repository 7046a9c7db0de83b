"""Light on the table: each source's beam through all that it meets, with radius, power and polarization.

It meets what `pico.optics.axis` says that a ray meets next, and what an element makes of it is for the file of
`pico.optics.elements` that bears its name. So decentred lenses bend a beam, plates walk it, splitters divide it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import cast

import numpy as np
from numpy.typing import DTypeLike, NDArray

from pico.manifest.checks.elements import GROUP
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.axis import Optic, Ray, Values, beside_the_edge, first_met, optic_of
from pico.optics.beam import Beam, forward, moments, scaled
from pico.optics.coherence import dispersed
from pico.optics.emission import emit
from pico.optics.geometry import Event
from pico.optics.irradiance import Screen
from pico.optics.irradiance import irradiance as projected
from pico.optics.part import Element, Met, Part, Straying
from pico.optics.unseen import SEEN, Unseen, as_it_is
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


@dataclass(frozen=True, eq=False)
class Light:
    """The light of all sources: crossings in the order in which they were followed. `endless`: sources whose beam goes
    round and round, and was not followed to its end. `begun`: the beams of the sources; `made`: what became of each
    beam, by its identity and the component that it leaves."""

    crossings: tuple[Crossing, ...]
    parts: Mapping[str, Part]
    endless: tuple[str, ...] = ()
    begun: Mapping[str, Beam] = field(default_factory=dict)
    made: Mapping[tuple[int, str], Made] = field(default_factory=dict)

    def at(self, component: str) -> tuple[Arrival, ...]:
        """Return what of the light a detector takes."""
        mine = (c for c in self.crossings if c.component == component and c.event == "detected")
        return tuple(Arrival(_cleared(c.beam, self.parts[component]), self.parts[component], c.clipped) for c in mine)

    def way(self, number: int) -> tuple[Crossing, ...]:
        """Return the crossings from the source to one of them, that the last."""
        crossing = self.crossings[number]
        return (*(() if crossing.before is None else self.way(crossing.before)), crossing)


@dataclass(frozen=True, eq=False)
class Arrival:
    """A beam on a detector, of which the aperture before it has stopped the share `clipped`. Its plane has the axes y,
    to the left of who looks along the component's x, and z, up, from where the optical axis meets it [mm]."""

    beam: Beam
    part: Part
    clipped: float = 0.0

    @property
    def wavelength(self) -> float:
        """In vacuum [nm]."""
        return self.beam.wavelength * 1e6

    @property
    def power(self) -> float:
        """The power [mW]."""
        return self.beam.power * (1.0 - self.clipped)

    @property
    def center(self) -> tuple[float, float]:
        """The centroid (y, z) on the detector [mm]."""
        _, left, up = self.part.axes
        ahead = self.beam.at - self.part.origin + moments(self.beam)[1] @ self.beam.frame
        return float(ahead @ left), float(ahead @ up)

    def irradiance(self, y: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray[np.floating]:
        """Return the irradiance (len(z), len(y)) [mW/mm2] of this beam alone."""
        return irradiance((self,), y, z)


def irradiance(
    arrivals: tuple[Arrival, ...], y: NDArray[np.float64], z: NDArray[np.float64], dtype: DTypeLike = np.float64
) -> NDArray[np.floating]:
    """Return the irradiance (len(z), len(y)) [mW/mm2] of beams on one detector; those of one source interfere."""
    if not arrivals:
        return np.zeros((len(z), len(y)), dtype=dtype)
    part = arrivals[0].part
    return projected([a.beam for a in arrivals], Screen(part.origin, *part.axes), y, z, dtype)


def out_of_step(arrivals: tuple[Arrival, ...]) -> str:
    """Return why nobody can say how beams of one source interfere on a detector: those of a wide spectrum that came
    through different lengths of glass, of which dispersion is not modelled. Empty where one can."""
    for source in sorted({a.beam.source for a in arrivals}):
        mine = [a.beam for a in arrivals if a.beam.source == source]
        if dispersed((b.path - b.length for b in mine), mine[0].spectra):
            return f"its beams came through different lengths of glass, and the dispersion of {source} is not modelled"
    return ""


INTERFACE = Interface(GROUP, {"meet": function}, {"meet": instance(Met), "strays": instance(tuple)})


@cache
def element(name: str) -> Element:
    """Return what an element does; raises KeyError where no file bears its name, and PicoError for
    a plug-in that is broken."""
    return cast(Element, module(INTERFACE, name))


def light_of(
    setup: Setup, poses: Mapping[str, Pose], values: Values | None = None, *, lit: Callable[[str], bool] | None = None,
    astray: Least | None = None, unseen: Mapping[str, Unseen] | None = None,
    like: Light | None = None, changed: Collection[str] = (),
) -> Light:  # fmt: skip
    """Return the light of the sources among what stands at `poses`.

    `values`: tunables by component, in the units of the catalog; those of shutters, stages, mirrors, irises, polarizers
    and wave plates count. `lit`: which sources shine; without, all that `values` do not say are off or shut.
    `astray`: follow what faces of glass send astray, too, and all down to so many mW; without, down to `FAINT`.
    `unseen`: how components are otherwise than they are seen. `like`: the light of the same components, all as
    they are now but those `changed`; what became of beams before these is not worked out again.
    """
    known, hidden = values or {}, unseen or {}
    parts = {
        name: like.parts[name]
        if like and name not in changed
        else _part(setup, name, pose, known, hidden.get(name, SEEN))
        for name, pose in poses.items()
    }
    shines = lit or (lambda name: not is_dark(known.get(name, {})))
    before = _Before({} if like is None else like.begun, {} if like is None else like.made, changed)
    crossings: list[Crossing] = []
    endless: list[str] = []
    begun: dict[str, Beam] = {}
    made: dict[tuple[int, str], Made] = {}
    for name in sorted(parts):
        if parts[name].kind.optics.element == "source" and shines(name):
            first = len(crossings)
            begun[name] = before.first(parts[name])
            follow = _followed(setup.lab.table.size, parts, begun[name], name, first, astray, before, made)
            for crossing in follow:
                if len(crossings) - first == (MOST_ASTRAY if astray else MOST):
                    endless.append(name)
                    break
                crossings.append(crossing)
    return Light(tuple(crossings), parts, tuple(endless), begun, made)


@dataclass(frozen=True)
class _Before:
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


def is_dark(laser: Mapping[str, object]) -> bool:
    """Return whether a laser with these tunables lets no light out."""
    return laser.get("emission") is False or laser.get("shutter") == "closed"


def _part(setup: Setup, name: str, pose: Pose, values: Values, unseen: Unseen) -> Part:
    own, kind = values.get(name, {}), as_it_is(setup, name, unseen)
    # an iris stops what is beside its opening itself: its leaves are no housing
    seen = {key: value for key, value in own.items() if key != "opening"}
    return Part(name, kind, own, pose, optic_of(kind, name, pose, seen, unseen), unseen)


def _followed(
    table: tuple[float, float], parts: Mapping[str, Part], first: Beam, source: str, number: int, astray: Least | None,
    known: _Before, made: dict[tuple[int, str], Made],
) -> Iterator[Crossing]:  # fmt: skip
    """Yield the crossings of a source's beam, breadth first, from a number on; what is made of beams goes to `made`."""
    optics = [part.optic for part in parts.values()]
    least = astray(first) if astray else FAINT * first.power
    rays: list[tuple[Beam, str, int | None]] = [(first, source, None)]
    for beam, leaves, before in rays:
        ray = Ray(_point(beam.at), _point(beam.along), beam.length, leaves)
        optic, event, far = first_met(table, optics, ray)
        meets = (optic.name if optic else "", event, far)
        found = known.became(beam, leaves, meets) or (
            meets,
            *_crossing(parts, beam, ray, optic, event, far, bool(astray)),
        )
        made[id(beam), leaves] = found
        yield replace(found[1], before=before)
        rays += [(b, found[1].component, number) for b in found[2] if b.power > least]
        number += 1


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
        met = replace(met, onward=tuple(_cleared(b, parts[optic.name]) for b in met.onward))
    onward = sum(b.power for b in met.onward)
    name = optic.name if optic else ""
    crossing = Crossing(name, met.event or event, met.came, beam.power, onward, met.clipped, None)
    return crossing, (*met.onward, *_strays(parts[name], beam, met)) if astray and met.onward else met.onward


def _strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what a part sends astray, none of an element that does not say."""
    found = element(part.optic.element)
    return cast(Straying, found).strays(part, beam, met) if hasattr(found, "strays") and met.clipped < 1.0 else ()


def _cleared(beam: Beam, part: Part) -> Beam:
    """Return what dirt on a component lets through of a beam."""
    return scaled(beam, math.sqrt(1.0 - part.unseen.loss)) if part.unseen.loss else beam


def _point(vector: NDArray[np.float64]) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z

"""Light on the table: each source's beam through all that it meets, with radius, power and polarization.

It meets what `pico.optics.axis` says that a ray meets next, and what an element makes of it is for the file of
`pico.optics.elements` that bears its name. So decentred lenses bend a beam, plates walk it, splitters divide it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import DTypeLike, NDArray

from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.axis import Values, optic_of
from pico.optics.beam import Beam, moments
from pico.optics.coherence import dispersed
from pico.optics.ends import closures
from pico.optics.following import Before, Crossing, Followed, Least, Made, cleared
from pico.optics.irradiance import Screen
from pico.optics.irradiance import irradiance as projected
from pico.optics.part import Part
from pico.optics.unseen import SEEN, Unseen, as_it_is


@dataclass(frozen=True, eq=False)
class Light:
    """The light of all sources: crossings in the order in which they were followed. `cut`: sources whose beam was not
    followed to its end, as one that goes round and round, each with the components that the rest may come to. `begun`:
    the beams of the sources; `made`: what became of each beam, by its identity and the component that it leaves."""

    crossings: tuple[Crossing, ...]
    parts: Mapping[str, Part]
    cut: Mapping[str, frozenset[str]] = field(default_factory=dict)
    begun: Mapping[str, Beam] = field(default_factory=dict)
    made: Mapping[tuple[int, str], Made] = field(default_factory=dict)

    def at(self, component: str) -> tuple[Arrival, ...]:
        """Return what of the light a detector takes."""
        mine = (c for c in self.crossings if c.component == component and c.event == "detected")
        return tuple(Arrival(cleared(c.beam, self.parts[component]), self.parts[component], c.clipped) for c in mine)

    @property
    def endless(self) -> tuple[str, ...]:
        """The sources whose beam was not followed to its end."""
        return tuple(self.cut)

    def unfollowed(self, component: str) -> str:
        """Return why nobody can say what light a component takes: a beam was not followed to its end, and the rest of
        it may come there. Empty if that is known."""
        found = [source for source, reached in self.cut.items() if component in reached]
        if not found:
            return ""
        count = sum(c.beam.source == found[0] for c in self.crossings)
        return f"the beam of {found[0]} was followed for {count} stretches, and the rest of it may come to {component}"

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
    before = Before({} if like is None else like.begun, {} if like is None else like.made, changed)
    crossings: list[Crossing] = []
    cut: dict[str, frozenset[str]] = {}
    optics = [part.optic for part in parts.values()]
    begun: dict[str, Beam] = {}
    made: dict[tuple[int, str], Made] = {}
    for name in sorted(parts):
        if parts[name].kind.optics.element == "source" and shines(name):
            first = len(crossings)
            begun[name] = before.first(parts[name])
            followed = Followed(setup.lab.table.size, parts, optics, astray, before, made)
            crossings += followed.crossings(begun[name], name, first)
            if followed.left:
                cut[name] = followed.reached(name, crossings[first:], first)
    return Light(tuple(crossings), parts, cut, begun, made)


def is_dark(laser: Mapping[str, object]) -> bool:
    """Return whether a laser with these tunables lets no light out."""
    return any(closures(laser))


def _part(setup: Setup, name: str, pose: Pose, values: Values, unseen: Unseen) -> Part:
    own, kind = values.get(name, {}), as_it_is(setup, name, unseen)
    # an iris stops what is beside its opening itself: its leaves are no housing
    seen = {key: value for key, value in own.items() if key != "opening"}
    return Part(name, kind, own, pose, optic_of(kind, name, pose, seen, unseen), unseen)

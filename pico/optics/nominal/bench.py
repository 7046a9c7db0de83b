"""What a nominal bench says that a spot does when tunables are set, or parts are put down otherwise: the Jacobian.

Nominal: geometry and glass as the catalog and the lab have them, poses as they are wanted or seen. Numbers that it can
tell are where light arrives on a detector (`cam.centroid.x`, in um); of others it says nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pico.geometry.seat import Seat
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.light import Arrival, Light, light_of
from pico.optics.unseen import SEEN, Unseen

Array = NDArray[np.float64]
PLACED = ("x", "y", "yaw", "pitch", "roll", "height")
"""The ways in which a placement errs, as `pico.geometry.seat.PlacementError` names them."""
_STEPS = {"x": 1e-2, "y": 1e-2, "height": 1e-2, "yaw": 1e-3, "pitch": 1e-3, "roll": 1e-3}  # mm, deg
_OPEN = ("shutter", "emission")
TOLD: Mapping[str, Callable[[Arrival], float]] = {
    "centroid.x": lambda arrival: 1e3 * arrival.center[0],
    "centroid.y": lambda arrival: 1e3 * arrival.center[1],
    "spot.left": lambda arrival: 1e3 * arrival.center[0],
    "spot.up": lambda arrival: 1e3 * arrival.center[1],
    "way.left": lambda arrival: 1e3 * float(arrival.beam.along @ arrival.part.axes[1]),
    "way.up": lambda arrival: 1e3 * float(arrival.beam.along @ arrival.part.axes[2]),
}
"""Numbers of light on a detector, by name: its centroid, which cameras measure; where it comes to any detector [um],
and how it comes there, from the detector's axis [mrad]."""


@dataclass(frozen=True)
class Nominal:
    """A bench as it is thought of: where parts stand, the values of their tunables, and how they sit; all light on."""

    setup: Setup
    poses: Mapping[str, Pose]
    values: Mapping[str, Mapping[str, Any]]
    unseen: Mapping[str, Unseen] = field(default_factory=dict)
    near: tuple[Light, frozenset[str]] | None = field(default=None, repr=False, compare=False)
    """The light of the same bench but for some components, and these; what does not reach them is not followed anew."""

    def light(self) -> Light:
        """Return its light, with every laser on and no shutter shut."""
        return self._light

    @cached_property
    def _light(self) -> Light:
        shining = {n: {k: v for k, v in own.items() if k not in _OPEN} for n, own in self.values.items()}
        like, changed = self.near or (None, frozenset[str]())
        return light_of(
            self.setup, self.poses, shining, lit=lambda _: True, unseen=self.unseen, like=like, changed=changed
        )

    def _near(self, component: str) -> tuple[Light, frozenset[str]]:
        """Return what a bench like this one but for a component is `near` to."""
        if self.near is None or "_light" in self.__dict__:
            return self._light, frozenset({component})
        light, changed = self.near
        return light, changed | {component}

    def numbers(self, wanted: Sequence[str]) -> Array | None:
        """Return numbers (n,) by address; None where no light comes there, or the model cannot tell one of them."""
        found, light = [], None
        for address in wanted:
            detector, _, number = address.partition(".")
            if number not in TOLD:
                return None
            light = light or self.light()
            arrivals = light.at(detector)
            if not arrivals or light.unfollowed(detector):
                return None
            found.append(TOLD[number](max(arrivals, key=lambda a: a.power)))
        return np.array(found) if found else None

    def on_the_way(self, wanted: Sequence[str]) -> tuple[str, ...]:
        """Return the parts that light meets on its way to where numbers are measured, in order."""
        light = self.light()
        detectors = {address.partition(".")[0] for address in wanted}
        ways = [light.way(n) for n, c in enumerate(light.crossings) if c.component in detectors]
        return tuple(dict.fromkeys(name for way in ways for c in way for name in (way[0].beam.source, c.component)))

    def set_to(self, address: str, by: float) -> Nominal:
        """Return the same with a tunable changed by so much, in its unit; one of which nobody knows starts at 0."""
        component, _, tunable = address.partition(".")
        own = self.values.get(component, {})
        values = {**self.values, component: {**own, tunable: own.get(tunable, 0.0) + by}}
        return replace(self, values=values, near=self._near(component))

    def put(self, component: str, way: str, by: float) -> Nominal:
        """Return the same with a part put down otherwise, by so much [mm or deg] in one of the ways of `PLACED`."""
        if way in ("x", "y", "yaw"):
            pose = self.poses[component]
            moved = replace(pose, **{way: getattr(pose, way) + by})
            return replace(self, poses={**self.poses, component: moved}, near=self._near(component))
        about = self.setup.type_of(component).frames.optical
        seat = replace(Seat(), **{way: by})  # type: ignore[arg-type]
        own = self.unseen.get(component, SEEN).sitting(seat, about)
        return replace(self, unseen={**self.unseen, component: own}, near=self._near(component))

    def by_tunable(self, wanted: Sequence[str], address: str) -> Array | None:
        """Return what numbers change (n,) per unit of a tunable; None where light is lost."""
        kind = self.setup.type_of(address.partition(".")[0]).tunables[address.partition(".")[2]]
        step = 1e-3 * (kind.range[1] - kind.range[0]) if kind.range else 1e-2
        return _slope(wanted, lambda by: self.set_to(address, by), step)

    def by_placing(self, wanted: Sequence[str], component: str, way: str) -> Array | None:
        """Return what numbers change (n,) per mm or deg of how a part is put down; None where light is lost."""
        return _slope(wanted, lambda by: self.put(component, way, by), _STEPS[way])


def _slope(wanted: Sequence[str], at: Callable[[float], Nominal], step: float) -> Array | None:
    high, low = at(step).numbers(wanted), at(-step).numbers(wanted)
    return None if high is None or low is None else (high - low) / (2 * step)

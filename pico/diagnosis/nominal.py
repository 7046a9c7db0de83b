"""What instruments of a bench would read, were it as its manifests and its cameras say, and changed as somebody
supposes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar, cast

import numpy as np

from pico.diagnosis.quantities import Got, Quantity, Shot, quantity
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.light import Arrival, Light, light_of
from pico.optics.unseen import SEEN, Unseen

SPECK = 1e-6
"""The share of the light on a camera below which a beam does not count."""
ZERO = "zero:"
"""What a change of the zero of an axis is called, before its tunable."""
_FACTORS = ("power", "focal")
"""Fields of `Unseen` that are factors."""
QUIET = ("exposure", "gain")
"""Tunables that no light depends on."""
Numbers = Mapping[str, float]
Made = TypeVar("Made")


@dataclass(frozen=True)
class Step:
    """A supposed change of a part by `size`: of a field of `Unseen` in its unit, but for `loss`, `gain`, `power`,
    `focal`, `leak` (the logarithm by which light, readings, power, focal length, and what should be stopped change), or
    of the zero of an axis (`zero:angle`)."""

    part: str
    what: str
    size: float


@dataclass(eq=False)
class Nominal:
    """A bench as it is known: where parts stand, and their tunables. What was traced once is kept."""

    setup: Setup
    poses: Mapping[str, Pose]
    values: Mapping[str, Mapping[str, Any]]
    _last: dict[Any, Light] = field(default_factory=dict)
    _kept: dict[Any, Any] = field(default_factory=dict)

    def light(self, at: Mapping[str, Any] | None = None, steps: Sequence[Step] = ()) -> Light:
        """Return the light with tunables set `at` other values, by address, and supposed changes."""
        set_to = {k: v for k, v in (at or {}).items() if k.partition(".")[2] not in QUIET}
        light_steps = tuple(s for s in steps if s.what not in ("gain", "dark"))
        key = (tuple(sorted(set_to.items())), light_steps)
        if key in self._last:
            return self._last[key]
        if key not in self._kept:
            values, unseen = self._changed(set_to, light_steps)
            like = self.light(at) if light_steps else self.light() if set_to else None
            changed = {s.part for s in light_steps} if light_steps else {k.partition(".")[0] for k in set_to}
            found = light_of(self.setup, self.poses, values, unseen=unseen, like=like, changed=changed)
            if light_steps:  # each is asked for a few times in a row
                self._last = {**(self._last if len(self._last) < _MOST else {}), key: found}
                return found
            self._kept[key] = found
        return cast(Light, self._kept[key])

    def kept(self, what: str, key: Any, make: Callable[[], Made]) -> Made:
        """Return what was made before for a key, else what is made now."""
        whole = (what, key)
        if whole not in self._kept:
            self._kept[whole] = make()
        return cast(Made, self._kept[whole])

    def _changed(
        self, at: Mapping[str, Any], steps: Sequence[Step]
    ) -> tuple[Mapping[str, Mapping[str, Any]], Mapping[str, Unseen]]:
        values = {name: dict(own) for name, own in self.values.items()}
        unseen: dict[str, Unseen] = {}
        for address, value in at.items():
            component, _, tunable = address.partition(".")
            values.setdefault(component, {})[tunable] = value
        for step in steps:
            if step.what.startswith(ZERO):
                own, tunable = values.setdefault(step.part, {}), step.what.removeprefix(ZERO)
                own[tunable] = float(own.get(tunable, 0.0)) + step.size
                continue
            was = unseen.get(step.part, SEEN)
            now, by = float(getattr(was, step.what)), self._field(step)
            unseen[step.part] = replace(was, **{step.what: now * by if step.what in _FACTORS else now + by})  # type: ignore[arg-type]
        return values, unseen

    def _field(self, step: Step) -> float:
        """Return by how much a field of `Unseen` changes, or the factor by which it does."""
        if step.what in _FACTORS:
            return math.exp(max(-20.0, min(20.0, step.size)))
        if step.what == "loss":
            return 1.0 - math.exp(-max(-2.0, min(20.0, step.size)))
        if step.what == "leak":  # of what should be stopped, exp(size) times as much passes as its type says
            stops = self.setup.type_of(step.part).number("extinction", "") or 1e5
            return min(0.5, max(0.0, math.exp(min(step.size, 20.0)) - 1) / stops)
        return step.size

    def numbers(self, shot: Shot, steps: Sequence[Step] = ()) -> Numbers | None:
        """Return what a measurement gives, its numbers by name; None where nobody can say, or no light comes there."""
        component, _, measurable = shot.address.partition(".")
        gain = math.exp(sum(s.size for s in steps if s.part == component and s.what == "gain"))
        dark = sum(s.size for s in steps if s.part == component and s.what == "dark")
        if measurable == "dark":
            return self._dark(component, shot.at, gain, dark)
        if measurable == "monitor":
            return {measurable: math.exp(sum(s.size for s in steps if s.part == component and s.what == "power"))}
        factor, steps = self._told(component, steps)
        light = self.light(shot.at, steps)
        arrivals = () if light.unfollowed(component) else light.at(component)
        total = sum(a.power for a in arrivals)
        strong = [a for a in arrivals if a.power > SPECK * total]
        if not strong:
            return None
        if measurable in ("centroid", "width"):
            found = _spot(strong) if all(not a.beam.unknown for a in strong) else None
            return None if found is None else {k: v - factor.get(k, 0.0) for k, v in found.items()}
        if "mode_radius" in self.setup.type_of(component).parameters:
            from pico.optics.offsets import coupled

            total = sum(coupled(a.part, a.beam) * a.power for a in strong)
        return {measurable: total * gain * math.exp(-factor["loss"])}

    def matters(self, shot: Shot, part: str) -> bool:
        """Return whether a reading may depend on a part."""
        return part in self.way(shot.address.partition(".")[0])

    def way(self, component: str) -> tuple[str, ...]:
        """Return what a reading of a component may depend on: the source of its light, what that has met, itself."""

        def met() -> tuple[str, ...]:
            light = self.light()
            ends = [n for n, c in enumerate(light.crossings) if c.component == component]
            parts = (c.component for n in ends for c in light.way(n))
            return tuple(dict.fromkeys([*(light.crossings[n].beam.source for n in ends), *parts, component]))

        return self.kept("way", component, met)

    def _told(self, component: str, steps: Sequence[Step]) -> tuple[dict[str, float], tuple[Step, ...]]:
        """Return what of supposed changes can be told without tracing anew, and the others: dirt on what all light of a
        reading passes, and a camera that was displaced across its beam (`x`, `y` [um])."""
        found, rest = {"loss": 0.0, "x": 0.0, "y": 0.0}, []
        camera = "pixel_size" in self.setup.type_of(component).parameters
        for step in steps:
            if step.what in ("loss", "power") and self.all_pass(step.part, component):
                found["loss"] += step.size if step.what == "loss" else -step.size
            elif camera and step.part == component and step.what in ("left", "up"):
                found["x" if step.what == "left" else "y"] += 1e3 * step.size
            else:
                rest.append(step)
        return found, tuple(rest)

    def all_pass(self, part: str, component: str) -> bool:
        """Return whether all light that a component detects passes a part, once."""
        light = self.light()
        ends = [n for n, c in enumerate(light.crossings) if c.component == component and c.event == "detected"]
        ways = [[c.component for c in light.way(n)] + [light.crossings[n].beam.source] for n in ends]
        return bool(ways) and all(way.count(part) == 1 for way in ways)

    def _dark(self, component: str, at: Mapping[str, Any], gain: float, dark: float) -> Numbers:
        """Return the mean and the spread of the counts of a frame without light."""
        from pico.optics.beam_table import decibel
        from pico.optics.instruments import sensor_of

        part = self.light().parts[component]
        sensor, known = sensor_of(part), {**part.values, **{k.partition(".")[2]: v for k, v in at.items()}}
        exposure = float(known.get("exposure", 1.0))
        electrons = max(0.0, sensor.dark_current + dark) * exposure * 1e-3
        per_count = sensor.electrons_per_count(decibel(part.values)) / gain
        spread = math.hypot(math.sqrt(sensor.read_noise**2 + electrons) / per_count, math.sqrt(1 / 12))
        return {"mean": sensor.black + electrons / per_count, "spread": spread}

    def quantity(self, wanted: Quantity, steps: Sequence[Step] = ()) -> Got | None:
        """Return what a quantity would be."""
        readings = []
        for shot in wanted.shots:
            found = self.numbers(shot, tuple(step for step in steps if self.matters(shot, step.part)))
            if found is None or wanted.number not in found:
                return None
            readings.append((found[wanted.number], 0.0))
        return quantity(wanted, readings)


_MOST = 100
"""Traces that are kept."""


def _spot(arrivals: Sequence[Arrival]) -> Numbers:
    """Return the centroid [um] and the size [um] of what falls on a camera, as its kernels give them; of one beam its
    greater and lesser width, too."""
    if len(arrivals) == 1:
        (one,) = arrivals
        (y, z), (wide, narrow, _) = one.center, one.beam.widths
        size = 2e3 * math.sqrt(wide * narrow)
        return {"x": 1e3 * y, "y": 1e3 * z, "size": size, "major": 2e3 * wide, "minor": 2e3 * narrow}
    from pico.optics.light import irradiance

    reach = 3 * max(a.beam.widths[0] for a in arrivals)
    ends = [(min(a.center[n] for a in arrivals) - reach, max(a.center[n] for a in arrivals) + reach) for n in (0, 1)]
    left, up = (np.linspace(low, high, 200) for low, high in ends)
    light = irradiance(tuple(arrivals), left, up)
    total = float(light.sum())
    across, high = light.sum(axis=0) / total, light.sum(axis=1) / total
    my, mz = float(across @ left), float(high @ up)
    size = math.sqrt(math.sqrt(float(across @ (left - my) ** 2) * float(high @ (up - mz) ** 2)))
    return {"x": 1e3 * my, "y": 1e3 * mz, "size": 4e3 * size}

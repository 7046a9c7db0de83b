"""What of a bench is read of a morning: what its detectors see as it stands, and short scans around known nulls."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pico.diagnosis.nominal import Nominal, Step
from pico.diagnosis.quantities import Quantity, Shot
from pico.model.catalog import ComponentType
from pico.model.quantities import Value
from pico.optics.beam_table import exposed

NULL_POINTS = (-2.0, 0.0, 2.0)
"""Set-points of a polarizer around its null [deg]; those of a wave plate are half as far."""
PEAK_POINTS = (-1.0, 0.0, 1.0)
BESIDE = 0.6
"""How far a beam is moved across an iris [of its radius]: what passes is still Gaussian."""
OPEN, CLOSED = 3.2, 2.4
"""How far an iris is opened for that, and for what it lets through to tell of its opening [radii of the beam]."""
FULL = 0.12
"""The share of what a camera can tell that is aimed at."""
DEEP = 3.0
"""How much brighter it must be beside a null."""
_POWERS = ("power", "voltage")
_ACROSS = ("stage_y", "stage_z", "tip", "tilt")


@dataclass(frozen=True)
class Chosen:
    """What is to be read, the parts that light meets on its way there, and what the bench lacks to tell more."""

    quantities: tuple[Quantity, ...]
    parts: tuple[str, ...]
    lacks: tuple[str, ...] = ()


def chosen(nominal: Nominal, before: tuple[Quantity, ...] = ()) -> Chosen:
    """Return what can be read of a bench as it stands, or what was `before`; nothing where no light comes to a
    detector."""
    light = nominal.light()
    lit = [n for n in sorted(light.parts) if not light.unfollowed(n) and sum(a.power for a in light.at(n)) > 0]
    sources = sorted({a.beam.source for n in lit for a in light.at(n)})
    way = _on_the_way(nominal, lit)
    found = list(before or _found(nominal, sources, way, lit))
    parts = tuple(dict.fromkeys([*sources, *way, *lit]))
    return Chosen(tuple(found), parts, tuple(_lacks(nominal, found, sources, lit)))


def _found(nominal: Nominal, sources: list[str], way: list[str], lit: list[str]) -> Iterator[Quantity]:
    for name in lit:
        yield from _as_it_stands(nominal, name)
    for name in sources:
        if "monitor" in _measurables(nominal, name):
            yield Quantity(f"{name}.monitor", (Shot(f"{name}.monitor"),), "monitor", "share")
    for name in way:
        yield from _null(nominal, name, way, lit)
    for name in way:
        yield from _iris(nominal, name, way, lit)


def darks(nominal: Nominal, names: Iterator[str] | tuple[str, ...]) -> tuple[Quantity, ...]:
    """Return the dark level and noise of cameras."""
    return tuple(
        quantity
        for name in names
        if "dark" in _measurables(nominal, name) and "dark_current" in nominal.setup.type_of(name).parameters
        for quantity in (
            Quantity(f"{name} dark level", (Shot(f"{name}.dark"),), "mean", "as it is", "count"),
            Quantity(f"{name} dark noise", (Shot(f"{name}.dark"),), "spread", "share"),
        )
    )


def _measurables(nominal: Nominal, name: str) -> Mapping[str, Any]:
    return nominal.setup.measurables_of(name)


def _one(nominal: Nominal, name: str, address: str, number: str, law: Any, unit: str = "") -> Quantity:
    return Quantity(name, (_shot(nominal, address.partition(".")[0], address, {}),), number, law, unit)


def _as_it_stands(nominal: Nominal, name: str) -> Iterator[Quantity]:
    known = _measurables(nominal, name)
    power = next((p for p in _POWERS if p in known), None)
    if power:
        yield _one(nominal, f"{name}.{power}", f"{name}.{power}", power, "share")
    strong = [a for a in nominal.light().at(name) if a.power > 1e-3 * max(b.power for b in nominal.light().at(name))]
    if len({a.beam.source for a in strong}) < len(strong):
        return  # they interfere: where the light falls is a matter of the phase
    if "centroid" in known:
        for axis in ("x", "y"):
            yield _one(nominal, f"{name}.centroid.{axis}", f"{name}.centroid", axis, "as it is", "um")
    if "width" in known:
        yield _one(nominal, f"{name}.width", f"{name}.width", "size", "share")


def _on_the_way(nominal: Nominal, lit: list[str]) -> list[str]:
    """Return the parts that light meets before it comes to a detector, in the order along the beam."""
    light = nominal.light()
    ends = (n for n, c in enumerate(light.crossings) if c.component in lit and c.event == "detected")
    met = {c.component: c.beam.length for n in ends for c in light.way(n) if c.component not in lit}
    return sorted(met, key=lambda name: met[name])


def _behind(nominal: Nominal, name: str, lit: list[str]) -> list[str]:
    """Return the detectors that read a power of light that has met a part."""
    light = nominal.light()
    found = []
    for n, crossing in enumerate(light.crossings):
        detector = crossing.component
        if detector not in lit or crossing.event != "detected" or not _power(nominal, detector):
            continue
        if any(c.component == name for c in light.way(n)):
            found.append(detector)
    return list(dict.fromkeys(found))


def _power(nominal: Nominal, name: str) -> str:
    return next((p for p in _POWERS if p in _measurables(nominal, name)), "")


def _motor(kind: ComponentType, tunable: str) -> bool:
    known = kind.tunables.get(tunable)
    return known is not None and known.mover == "motor" and known.datatype == "float"


def _null(nominal: Nominal, name: str, way: list[str], lit: list[str]) -> Iterator[Quantity]:
    """Yield where a polarizer or wave plate lets least light through, and how little."""
    kind = nominal.setup.type_of(name)
    element, address = kind.optics.element, f"{name}.angle"
    if element not in ("polarizer", "waveplate") or not _motor(kind, "angle"):
        return
    live = nominal.values.get(name, {}).get("angle")
    harmonic = 2 if element == "polarizer" else 4
    cycle = 360.0 / harmonic
    for detector in _behind(nominal, name, lit):
        reads = f"{detector}.{_power(nominal, detector)}"
        open_to: Mapping[str, Value] = {} if element == "polarizer" else _opened(nominal, name, way, reads)
        turns = [cycle * n / 24 for n in range(24)]
        seen = [_seen(nominal, reads, {**open_to, address: turn}) for turn in turns]
        if not isinstance(live, int | float) or min(seen) <= 0 or max(seen) < DEEP * min(seen):
            continue
        null = _refined(nominal, reads, open_to, address, turns[seen.index(min(seen))], cycle / 24, harmonic)
        points = [p / (harmonic / 2) for p in NULL_POINTS]
        place = _within(kind.tunables["angle"].range, null, cycle, points, float(live))
        if place is None:
            continue
        shots = tuple(_shot(nominal, detector, reads, {**open_to, address: round(place + p, 3)}) for p in points)
        yield Quantity(f"{name} null", shots, reads.partition(".")[2], "null", kind.tunables["angle"].unit, address,
                       harmonic)  # fmt: skip
        yield Quantity(f"{name} null depth", shots, reads.partition(".")[2], "depth", "", address, harmonic)
        yield from _shares(f"{name} null", shots, address, kind.tunables["angle"].unit)
        return


def _shares(name: str, shots: Sequence[Shot], tunable: str, unit: str) -> Iterator[Quantity]:
    """Yield what is read at each set-point of a scan: far off, the scan's law tells little of what that tells."""
    for shot in shots:
        number = shot.address.partition(".")[2]
        yield Quantity(f"{name} at {shot.at[tunable]:g} {unit}", (shot,), number, "share", "", tunable)


def _opened(nominal: Nominal, plate: str, way: list[str], reads: str) -> dict[str, Value]:
    """Return set-points at which polarizers behind the first one after a wave plate let most through: its null is then
    a matter of that first one alone, and not of what leaks past it."""
    behind = [n for n in way[way.index(plate) + 1 :] if nominal.setup.type_of(n).optics.element == "polarizer"]
    found: dict[str, Value] = {}
    for name in behind[1:]:
        kind = nominal.setup.type_of(name)
        low, high = (kind.tunables["angle"].range if _motor(kind, "angle") else None) or (0.0, 0.0)
        turns = [low + min(180.0, high - low) * n / 18 for n in range(18)]
        if high > low:
            seen = [_seen(nominal, reads, {**found, f"{name}.angle": turn}) for turn in turns]
            found[f"{name}.angle"] = turns[seen.index(max(seen))]
    return found


def _refined(
    nominal: Nominal, reads: str, at: Mapping[str, Value], address: str, near: float, step: float, harmonic: int
) -> float:  # fmt: skip
    """Return where a reading is least, by the law of Malus around the least of a few."""
    for reach in (step, step / 8):
        shots = tuple(Shot(reads, {**at, address: near + n * reach}) for n in (-1.0, -0.5, 0.0, 0.5, 1.0))
        found = nominal.quantity(Quantity("", shots, reads.partition(".")[2], "null", "", address, harmonic))
        near = near if found is None else found.value
    return near


def _within(
    span: tuple[float, float] | None, null: float, cycle: float, points: list[float], live: float
) -> float | None:
    """Return the null nearest to where an axis stands around which all points are within its range."""
    places = [null + cycle * n for n in range(-8, 9)]
    low, high = span or (-math.inf, math.inf)
    fits = [p for p in places if low <= p + points[0] and p + points[-1] <= high]
    return min(fits, key=lambda p: abs(p - live), default=None)


def _seen(nominal: Nominal, reads: str, at: Mapping[str, Value]) -> float:
    found = nominal.numbers(Shot(reads, at))
    return 0.0 if found is None else found.get(reads.partition(".")[2], 0.0)


def _shot(nominal: Nominal, detector: str, reads: str, at: Mapping[str, Value]) -> Shot:
    """Return a shot with an exposure that suits the light that should be there."""
    kind = nominal.setup.type_of(detector)
    exposure = kind.tunables.get("exposure")
    light = nominal.light(at)
    told = exposed(light, light.parts[detector]) if exposure is not None else None
    if exposure is None or told is None or not told.times or exposure.range is None:
        return Shot(reads, at)
    now = float(nominal.values.get(detector, {}).get("exposure") or 1.0)
    low, high = exposure.range
    found = max(low, min(high, float(f"{now * FULL / told.times:.2g}")))
    return Shot(reads, {**at, f"{detector}.exposure": found})


def _iris(nominal: Nominal, name: str, way: list[str], lit: list[str]) -> Iterator[Quantity]:
    """Yield what an iris lets through when it is nearly closed, and where optics before it must stand for that to be
    most: that tells where the beam is at another place than a camera."""
    kind = nominal.setup.type_of(name)
    detectors = _behind(nominal, name, lit)
    if kind.optics.element != "iris" or not _motor(kind, "opening") or not detectors:
        return
    light = nominal.light()
    beam = next(c.beam for c in light.crossings if c.component == name)
    low, high = kind.tunables["opening"].range or (0.0, math.inf)
    opening, least = (round(max(low, min(high, share * beam.widths[0])), 2) for share in (OPEN, CLOSED))
    closed: Mapping[str, Value] = {f"{name}.opening": opening}
    reads = f"{detectors[0]}.{_power(nominal, detectors[0])}"
    number = reads.partition(".")[2]
    for to, said in ((opening, "half closed"), (least, "nearly closed")):
        shot = _shot(nominal, detectors[0], reads, {f"{name}.opening": to})
        yield Quantity(f"{name} {said}", (shot,), number, "share")
    for before in reversed(way[: way.index(name)]):
        known = nominal.setup.type_of(before)
        axes = [t for t in _ACROSS if _motor(known, t)]
        for tunable in axes:
            points = _across(nominal, before, tunable, name)
            if points:
                shots = tuple(_shot(nominal, detectors[0], reads, {**closed, f"{before}.{tunable}": p}) for p in points)
                unit = known.tunables[tunable].unit
                yield Quantity(f"{before}.{tunable} through {name}", shots, number, "peak", unit, f"{before}.{tunable}")
                yield from _shares(f"{before}.{tunable} through {name}", shots, f"{before}.{tunable}", unit)
        if axes:
            return


def _across(nominal: Nominal, part: str, tunable: str, iris: str) -> tuple[float, ...]:
    """Return set-points of a tunable that move the beam across an iris; none where its range does not."""
    kind = nominal.setup.type_of(part).tunables[tunable]
    live = nominal.values.get(part, {}).get(tunable)
    if not isinstance(live, int | float) or kind.range is None:
        return ()
    reach = (kind.range[1] - kind.range[0]) / 100
    places = []
    for by in (-reach, reach):
        light = nominal.light({f"{part}.{tunable}": float(live) + by})
        places.append(next((c.beam.at for c in light.crossings if c.component == iris), None))
    if places[0] is None or places[1] is None:
        return ()
    moved = (places[1] - places[0]) / (2 * reach)
    slope, light = float(np.linalg.norm(moved)), nominal.light()
    beam = next(c.beam for c in light.crossings if c.component == iris)
    if slope <= 0:
        return ()
    step = BESIDE * beam.widths[0] / slope
    if 2 * step > kind.range[1] - kind.range[0]:
        return ()
    aside = float((beam.at - light.parts[iris].center) @ moved) / slope**2  # the beam should come to its middle
    middle = max(kind.range[0] + step, min(kind.range[1] - step, float(live) - aside))
    return tuple(round(middle + p * step, 4) for p in PEAK_POINTS)


def _lacks(nominal: Nominal, found: list[Quantity], sources: list[str], lit: list[str]) -> Iterator[str]:
    """Yield what a bench would need to tell more."""
    names = {q.name for q in found}
    if not lit:
        yield "no light comes to a detector: with its shutters open a bench tells of its light"
        return
    split = [n for n in lit if not _before_anything(nominal, n)]
    for source in sources:
        pick_off = [n for n in lit if n not in split]
        if f"{source}.monitor" not in names and not pick_off:
            yield f"nothing reads the power of {source} before all else: a pick-off with a photodiode or a camera would"
        if not any(f"{n}.centroid.x" in names for n in pick_off):
            yield f"nothing sees where {source} points before all else: a camera behind a pick-off would"
    if not any(q.law == "peak" for q in found):
        seeing = [n for n in lit if f"{n}.centroid.x" in names and n in split]
        if len(seeing) < 2:
            yield "only one place tells where the beam runs: a second camera, or an iris with a motor, would be another"


def _before_anything(nominal: Nominal, detector: str) -> bool:
    """Return whether a detector sees its source by no more than a splitter."""
    light = nominal.light()
    number = next(n for n, c in enumerate(light.crossings) if c.component == detector and c.event == "detected")
    elements = [light.parts[c.component].kind.optics.element for c in light.way(number) if c.component != detector]
    return all(e in ("plate_splitter", "beam_splitter", "filter") for e in elements)


__all__ = ["Chosen", "Step", "chosen", "darks"]

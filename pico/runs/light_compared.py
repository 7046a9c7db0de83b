"""The light that was recorded against the light now: like with like, powers by the laser's own monitor, and places by
what the goals hold, how parts are seen to stand now against then, and what that leaves open."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

from pico.model.goal import Goal
from pico.model.measurement import Compared, Measurement, incomparable
from pico.model.setup import Setup
from pico.model.vocabulary import numbers_of
from pico.optics.nominal.spread import Spread

POWERS = ("power", "light", "voltage")
"""Numbers that follow the power of the laser."""
MONITOR = "monitor"
"""The measurable of a laser that tells its power before anything on the table does something to it."""
_PLACES = {"x": ("left", 1), "y": ("up", 2)}
"""Coordinates of a middle: their standard deviation in a `Spread`, and which of its three numbers they are."""
_SHARE = {"power": 0.01, "other": 0.05, "reference": 0.05}
"""What two measurements of the same light may differ by, of themselves: of kernels, sensors, dust. One standard
deviation, as a share of the number: of a power, of other numbers, of a power without a reference."""
_ROUND = 5.0
"""The standard deviation from which an angle is no number any more [deg]."""
_LEAST = 1.0
"""The same of a place [um]."""


def light_compared(
    setup: Setup, before: Mapping[str, Measurement], now: Mapping[str, Measurement], spreads: Mapping[str, Spread],
    met: Mapping[str, Goal], sources: Mapping[str, str], dark: Mapping[str, str],
) -> tuple[Compared, ...]:  # fmt: skip
    """Return the numbers of measurements, by address, before and now, in order. `spreads`: by detector, as parts
    stand that were put down again; `met`: goals that are met both times; `sources`: the laser whose light a detector
    takes; `dark`: what keeps it back now."""
    found = list[Compared]()
    for address in sorted(before):
        one, other = before[address], now.get(address)
        if other is None:
            found.append(Compared(address=address, why="it was not measured now"))
        elif one.component in dark:
            found.append(Compared(address=address, why=dark[one.component]))
        elif reasons := incomparable(one, other, _tolerances(setup, one.component)):
            found.append(Compared(address=address, why="; ".join(reasons)))
        else:
            monitor = f"{sources.get(one.component, '')}.{MONITOR}"
            pair = (before[monitor], now[monitor]) if monitor in before and monitor in now else None
            found += _numbers(setup, one, other, spreads.get(one.component, Spread()), met, pair)
    return tuple(found)


def _tolerances(setup: Setup, component: str) -> dict[str, float]:
    """Return within what the settings of a component are the same, as its tunables say."""
    kinds = setup.type_of(component).tunables if component in setup.lab.inventory else {}
    return {name: kind.tolerance for name, kind in kinds.items() if kind.datatype == "float"}


def _numbers(
    setup: Setup, one: Measurement, other: Measurement, spread: Spread, met: Mapping[str, Goal],
    monitor: tuple[Measurement, Measurement] | None,
) -> Iterator[Compared]:  # fmt: skip
    units = {f"{one.measurable}.{number}": unit for number, (_, _, unit) in one.numbers.items()}
    for name, before in _values(one).items():
        address, unit = f"{one.component}.{name}", units.get(name, one.unit)
        now = _values(other).get(name)
        if now is None:
            continue
        noise = math.hypot(_sigma(one, name), _sigma(other, name))
        kind = name.rpartition(".")[2]
        made = Compared(address=address, before=before, now=now, unit=unit, sigma=noise)
        if kind in POWERS or one.measurable == MONITOR:
            yield _power(made, spread, monitor if one.measurable != MONITOR else None)
        elif kind in _PLACES and unit == "um":
            held = [goal.near(address) for goal in met.values() if address in (goal.reach or {})]
            yield _place(made, spread, min(held) if held else None)
        elif unit == "deg":
            yield _angle(made)
        elif f"{one.measurable}.{kind}" in numbers_of(setup, one.component):
            yield replace(made, sigma=math.hypot(noise, _SHARE["other"] * abs(before)))


def _place(made: Compared, spread: Spread, held: float | None) -> Compared:
    """Return a place that a goal holds so exactly, or that stands as parts do."""
    if held is not None:
        return replace(made, sigma=math.hypot(made.sigma, _LEAST, held))
    way, k = _PLACES[made.address.rpartition(".")[2]]
    open_to = 1e3 * getattr(spread, way)
    return _as_seen(replace(made, sigma=math.hypot(made.sigma, _LEAST, open_to)), spread, k, 1e3)


def _as_seen(made: Compared, spread: Spread, k: int, scale: float) -> Compared:
    """Return a number with what it is to be as parts are seen to stand; it follows the `k`-th number of a spread's
    light, `scale` times as much."""
    if not spread.restood:
        return made
    restood = tuple(replace(part, by=scale * moved[k]) for part, moved in spread.restood)
    return replace(made, expected=(made.before or 0.0) + scale * spread.moved[k], restood=restood)


def _angle(made: Compared) -> Compared:
    """Return the angle of an ellipse, which is the same after half a turn; of one that is nearly round it is chance."""
    if made.sigma > _ROUND:
        return replace(made, why="the spot is too round to have one")
    turned = ((made.now or 0.0) - (made.before or 0.0) + 90.0) % 180.0 - 90.0
    return replace(made, now=(made.before or 0.0) + turned)


def _power(made: Compared, spread: Spread, monitor: tuple[Measurement, Measurement] | None) -> Compared:
    before, now = made.before or 0.0, made.now or 0.0
    open_to = math.hypot(_SHARE["power"], spread.power)
    made = _as_seen(made, spread, 0, before)
    if monitor is None:
        return replace(made, sigma=math.hypot(made.sigma, before * math.hypot(open_to, _SHARE["reference"])))
    first, last = (float(m.value) if isinstance(m.value, int | float) else 0.0 for m in monitor)
    if first <= 0 or last <= 0:
        return replace(made, why=f"{monitor[0].address} told no light")
    noise = sum((_sigma(m, MONITOR) / v) ** 2 for m, v in zip(monitor, (first, last), strict=True))
    scale = first / last
    return replace(
        made, now=now * scale, reference=monitor[0].address,
        sigma=math.hypot(made.sigma, before * math.hypot(open_to, math.sqrt(noise))),
    )  # fmt: skip


def _values(found: Measurement) -> dict[str, float]:
    """Return the numbers of a measurement, `fit.x` or the measurable itself."""
    if isinstance(found.value, Mapping):
        return {f"{found.measurable}.{k}": float(v) for k, v in found.value.items() if _number(v)}
    return {found.measurable: float(found.value)} if _number(found.value) else {}  # type: ignore[arg-type]


def _number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _sigma(found: Measurement, name: str) -> float:
    if isinstance(found.sigma, Mapping):
        return float(found.sigma.get(name.rpartition(".")[2], 0.0))
    return float(found.sigma or 0.0)

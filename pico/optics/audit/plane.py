"""Whether beams stay near the plane of the table wherever mirrors may be turned, and parts misplaced.

What is bounded exactly: how far a beam can rise or fall. Along each branch the elevation may differ from that traced
by e, its height by v. Over a stretch of length L v grows by L e. A mirror whose tilt may differ by t adds 2 t cos i to
e, with the least incidence i that tips and misplacement allow: the elevation of what a mirror with normal n sends back
of a beam d is d_z - 2 (d.n) n_z, and a tip, a misplaced yaw or position changes d.n only. A lens adds v / f (v no more
than its aperture), a face that reflects 4 v / R; splitters, plates and cubes stand upright and add nothing. First
order in e and t: at 100 mrad it is right to 1 %.

What is sampled: where a branch may leave `MOST_RISE`, each mirror on its way is turned to the corners, edges and middle
of its range, alone and all together, and the light is traced: there it must end on a block each time. Between samples
it is taken to do so, too: an opening is convex, and the spot moves with the angle. A raster search stays within the
range. Up to class 3R the range is what mirrors may be driven to (`pico.optics.audit.turns`), and a beam may leave the
plane if it ends on a block or a housing.

Heights of lenses on stages, and whatever else steers, count as they are set.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

from pico.model.catalog import ComponentType
from pico.model.quantities import QuantityError, convert
from pico.optics.audit.branches import Branches
from pico.optics.audit.ends import ending
from pico.optics.audit.findings import Finding
from pico.optics.audit.turns import turns
from pico.optics.axis import Values
from pico.optics.following import Crossing
from pico.optics.light import Light
from pico.optics.part import Part

MOST_RISE = 0.015
"""How far from the plane of the table a beam may run [rad]."""


@dataclass(frozen=True)
class Spread:
    """How far a beam may be from where it was traced: elevation [rad], height [mm], and azimuth [rad]."""

    rise: float = 0.0
    height: float = 0.0
    turn: float = 0.0


def out_of_plane(branches: Branches, traced: Callable[[Values], Light], values: Values) -> Iterator[Finding]:
    """Yield a finding for each way on which a branch above the limit may leave the plane, and then ends on no block."""
    done = set[tuple[str, ...]]()
    tried: dict[tuple[str, ...], list[tuple[Mapping[str, Any], Branches]]] = {}
    for number, rise in _steep(branches):
        way = branches.light.way(number)
        names = tuple(c.component for c in way[:-1])
        if names in done or any(names[: len(known)] == known for known in done):
            continue
        steering = tuple(dict.fromkeys(c.component for c in way[:-1] if _tilts(branches.part(c))))
        if steering not in tried:
            settings = _settings(branches, steering, values)
            tried[steering] = [(s, branches.of(traced({**values, **s}))) for s in settings]
        found = _worst(branches, tried[steering], number, rise)
        if found is not None:
            done.add(names)
            yield found


def _steep(branches: Branches) -> Iterator[tuple[int, float]]:
    """Yield the numbers of crossings to which a beam above the limit may come too steeply, and how steeply [rad]."""
    spreads: list[Spread] = []
    for number, crossing in enumerate(branches.light.crossings):
        before = None if crossing.before is None else branches.light.crossings[crossing.before]
        start = Spread() if crossing.before is None else spreads[crossing.before]
        spread = _along(branches, start, before, crossing)
        spreads.append(spread)
        rise = abs(elevation(crossing)) + spread.rise
        if rise > MOST_RISE and crossing.power > branches.harmless:
            yield number, rise


def elevation(crossing: Crossing) -> float:
    """Return how steeply a beam rises as it comes to a crossing [rad]."""
    return math.asin(max(-1.0, min(1.0, float(crossing.beam.along[2]))))


def _along(branches: Branches, start: Spread, before: Crossing | None, crossing: Crossing) -> Spread:
    """Return the spread of a beam at a crossing, from that at the crossing before it."""
    part = branches.part(before) if before is not None else None
    spread = start if part is None or before is None else _behind(branches, start, part, before, crossing)
    length = crossing.beam.length - (before.beam.length if before else 0.0)
    return Spread(spread.rise, spread.height + length * spread.rise, spread.turn)


def _behind(branches: Branches, start: Spread, part: Part, before: Crossing, onward: Crossing) -> Spread:
    """Return the spread of a beam behind a part."""
    yaw = math.radians(part.kind.pose.tolerance.yaw + 3 * part.kind.repeatability.yaw)
    rise = turn = 0.0
    element = part.kind.optics.element
    if before.event == "reflected":
        (low, high), now = reach(branches, part, "tilt"), turned(part, "tilt")
        tip = max(abs(end - turned(part, "tip")) for end in reach(branches, part, "tip"))
        square = abs(float(before.beam.along @ part.optic.normal))
        aside = start.turn + tip + yaw
        least = max(0.0, math.acos(min(1.0, square)) - aside)
        rise = 2 * math.cos(least) * max(abs(low - now), abs(high - now)) + 2 * abs(now) * aside
        turn = 2 * tip
    if element == "expander":
        by = part.number("magnification", "", 1.0)
        by = by if before.beam.along @ part.axes[0] > 0 else 1 / by
        height = start.height * abs(by) + part.number("length", "mm", 0.0) * start.rise
        return Spread(start.rise / abs(by), height, start.turn / abs(by) + 2 * yaw)
    if element == "grating":  # orders leave at other angles than they come: no bound on how far about the upright
        return Spread(start.rise, start.height, math.pi)
    bend = _bends(part, onward)
    rise += min(start.height, 2 * part.optic.radius) * bend
    return Spread(start.rise + rise, start.height, start.turn + turn + 2 * yaw + 2 * part.optic.radius * bend)


def _bends(part: Part, onward: Crossing) -> float:
    """Return by how much more a part bends a beam for each mm that it comes off its axis [1/mm], at most: 1 / f, and of
    a face that reflects twice its curvature, through glass and back out of it no more than four times."""
    bend = 1 / abs(part.number("focal_length", "mm", math.inf) or math.inf)
    curved = part.kind.optics.element != "lens" or onward.beam.ghost
    radii = [part.kind.number(name, "mm") for name in ("radius_of_curvature", "radius_of_curvature_back")]
    return bend + (max((4 / abs(r) for r in radii if r), default=0.0) if curved else 0.0)


def reach(branches: Branches, part: Part, tunable: str) -> tuple[float, float]:
    """Return between which angles a mirror may be turned [rad]: 0 if it can't be, all round if it has no range."""
    if tunable not in part.kind.tunables:
        return 0.0, 0.0
    ends = turns(branches, part, tunable)
    if ends is None:
        return -math.pi / 2, math.pi / 2
    low, high = (_radians(part.kind, tunable, end) for end in ends)
    return low, high


def turned(part: Part, tunable: str) -> float:
    """Return what an angle of a mirror is set to [rad], 0 where nobody knows."""
    value = part.values.get(tunable)
    known = tunable in part.kind.tunables and isinstance(value, int | float) and not isinstance(value, bool)
    return _radians(part.kind, tunable, float(value)) if known and value is not None else 0.0


def _radians(kind: ComponentType, tunable: str, value: float) -> float:
    unit = kind.tunables[tunable].unit or "rad"
    try:
        return float(convert(f"{value!r} {unit}", "rad"))
    except QuantityError:
        return 0.0


def _tilts(part: Part | None) -> bool:
    return part is not None and "tilt" in part.kind.tunables


def _settings(branches: Branches, mirrors: tuple[str, ...], values: Values) -> list[Mapping[str, Any]]:
    """Return tunables by mirror: as they are; each at nine places of what it may be turned to, the others as
    they are; and all in corners of theirs, in each corner with each of the other of two, else in the same."""
    found: list[Mapping[str, Any]] = [{}]
    corners: list[list[Mapping[str, Any]]] = []
    for name in mirrors:
        part, own = branches.light.parts[name], values.get(name, {})
        keys = [key for key in ("tip", "tilt") if key in part.kind.tunables]
        ends = [_ends(branches, part, key, own) for key in keys]
        grid = [{name: {**own, **dict(zip(keys, at, strict=True))}} for at in product(*ends)]
        found += grid
        corners.append([grid[n] for n in _corners(ends)])
    together: Iterable[tuple[Mapping[str, Any], ...]] = ()
    if len(mirrors) > 1:
        together = product(*corners) if len(mirrors) == 2 else zip(*corners, strict=False)
    return [*found, *({k: v for one in row for k, v in one.items()} for row in together)]


def _ends(branches: Branches, part: Part, key: str, own: Mapping[str, Any]) -> tuple[float, ...]:
    low, high = turns(branches, part, key) or (float(own.get(key, 0.0)),) * 2
    return (low, (low + high) / 2, high)


def _corners(ends: list[tuple[float, ...]]) -> list[int]:
    """Return the places in a grid that are corners."""
    return [n for n, at in enumerate(product(*ends)) if all(v in (e[0], e[-1]) for v, e in zip(at, ends, strict=True))]


def _smaller(branches: Branches, number: int) -> str:
    """Return how the mirrors on a way get a smaller range of tilt, or what else there is to do."""
    tilting = dict.fromkeys(c.component for c in branches.light.way(number)[:-1] if _tilts(branches.part(c)))
    if not tilting:
        return "put blocks around what it may hit"
    if branches.ordinary:
        return f"put a beam block where it goes, or keep {', '.join(tilting)} closer to where they are set"
    types = dict.fromkeys(branches.light.parts[name].kind.name for name in tilting)
    made = next(iter(types))
    return (
        f"put blocks around what it may hit, or give {', '.join(tilting)} a smaller range of tilt: "
        f"`pico catalog new NAME --from {made}` makes a type of your own, of which types/NAME.yaml has the `range`"
    )


def _worst(
    branches: Branches, tried: list[tuple[Mapping[str, Any], Branches]], number: int, rise: float
) -> Finding | None:
    """Return the finding about a branch that may rise so far, None where it ends on a block wherever it was tried."""
    steepest, seen = None, branches.ordinary
    for setting, sampled in tried:
        for at, crossing in enumerate(sampled.light.crossings):
            steep = abs(elevation(crossing))
            if crossing.power <= branches.harmless or not _counts(branches, sampled, at, setting):
                continue
            seen = True
            goes_on = crossing.event not in ("blocked", "detected") and not branches.ordinary
            if (goes_on or ending(sampled, crossing)) and (steepest is None or steep > steepest[0]):
                steepest = steep, sampled, at, setting
    hint = _smaller(branches, number)
    if steepest is not None:
        steep, sampled, at, setting = steepest
        crossing = sampled.light.crossings[at]
        set_to = ", ".join(f"{n}.{k} = {v[k]:g}" for n, v in setting.items() for k in ("tip", "tilt") if k in v)
        end = ending(sampled, crossing) or f"comes to {crossing.component}"
        turned_so = f" ({set_to})" if set_to else ""
        where = f"may leave the plane of the table by {1000 * steep:.3g} mrad{turned_so} and {end}"
        return sampled.finding("plane", at, where, crossing.power, hint=hint)
    if seen:
        return None
    crossing = branches.light.crossings[number]
    before = crossing.component or "the edge of the table"
    where = f"may leave the plane of the table by up to {1000 * rise:.3g} mrad before {before}"
    return branches.finding("plane", number, where, crossing.power, hint=hint)


def _counts(branches: Branches, sampled: Branches, at: int, setting: Mapping[str, Any]) -> bool:
    """Return whether it counts where a beam comes to: up to class 3R behind any mirror that was turned, as there no
    bound on how far it rises is kept; else wherever it left the plane."""
    if not branches.ordinary:
        return abs(elevation(sampled.light.crossings[at])) > MOST_RISE
    return any(crossing.component in setting for crossing in sampled.light.way(at)[:-1])

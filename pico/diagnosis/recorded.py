"""Which part explains that light is not as it was recorded: numbers of measurements then and now as quantities, and the
ray model of the bench fitted to what changed."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence

from pico.diagnosis.causes import causes
from pico.diagnosis.nominal import Nominal
from pico.diagnosis.quantities import FLICKER, Got, Quantity, Shot
from pico.diagnosis.suspects import Compared, Verdict, suspects
from pico.model.measurement import Compared as Numbers
from pico.model.observation import Observation
from pico.model.setup import Setup

POWERS = ("power", "light", "voltage", "monitor")
_PLACES = ("x", "y")
_AXES = ("major", "minor")
"""The two widths of a spot, of which the mean is one quantity."""


def nominal_of(setup: Setup, seen: Observation) -> Nominal:
    """Return the ray model of a bench as it was seen."""
    parts = {n: p for n, p in seen.components.items() if n in setup.lab.inventory and p.presence == "seen"}
    poses = {n: p.pose for n, p in parts.items() if p.pose is not None}
    return Nominal(setup, poses, {n: dict(seen.known_values.get(n, {})) for n in poses})


def suspected(nominal: Nominal, numbers: Sequence[Numbers], parts: Collection[str]) -> Verdict | None:
    """Return which of some parts explain that numbers of the light are others than before; None where none is, by more
    than can be chance, or no model tells. What a number's `sigma` allows for, as the placement of parts, explains it
    first."""
    known = [*compared(numbers)]
    if not known or not any(one.differs for one in numbers):
        return None
    found = suspects(nominal, known, causes(nominal.setup, tuple(sorted(parts))))
    return found if any(math.isfinite(change) for change in found.changes) else None


def compared(numbers: Sequence[Numbers]) -> Iterator[Compared]:
    """Yield the quantities that numbers of measurements are, each once, the surest of those that tell the same: powers
    and widths by their logarithm, places as they are."""
    best: dict[tuple[str, str], Compared] = {}
    for one in numbers:
        if (made := _quantity(one, numbers)) is not None:
            key = (made.quantity.shots[0].address.partition(".")[0], made.quantity.number)
            if key not in best or made.now.sigma < best[key].now.sigma:
                best[key] = made
    yield from best.values()


def _quantity(one: Numbers, numbers: Sequence[Numbers]) -> Compared | None:
    component, _, name = one.address.partition(".")
    kind = name.rpartition(".")[2]
    if one.why or one.wanted is None or one.now is None:
        return None
    if kind in _PLACES and one.unit == "um":
        wanted = Quantity(one.address, (Shot(f"{component}.centroid"),), kind, "as it is", "um")
        return Compared(wanted, Got(one.wanted, 0.0), Got(one.now, one.sigma))
    if kind in POWERS:
        now = one.now / _against(one, numbers)
        return _share(one.address, Shot(f"{component}.{kind}"), kind, one.wanted, now, one.sigma)
    if kind == _AXES[0] and (other := _minor(one, numbers)) is not None:
        before, now = (math.sqrt(max(0.0, a * b)) for a, b in (other[0], other[1]))
        return _share(one.address, Shot(f"{component}.width"), "size", before, now, one.sigma)
    return None


def _against(one: Numbers, numbers: Sequence[Numbers]) -> float:
    """Return by which factor a power is told as more than it was read now, for its laser has less of it."""
    laser = next((n for n in numbers if n.address == one.reference and n.before and n.now), None)
    return laser.before / laser.now if laser and laser.before and laser.now else 1.0


def _minor(one: Numbers, numbers: Sequence[Numbers]) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return both widths of a spot as they were, and as they are."""
    address = one.address.removesuffix(_AXES[0]) + _AXES[1]
    other = next((n for n in numbers if n.address == address and not n.why), None)
    if other is None or None in (one.before, one.now, other.before, other.now):
        return None
    return (one.before or 0.0, other.before or 0.0), (one.now or 0.0, other.now or 0.0)


def _share(name: str, shot: Shot, number: str, before: float, now: float, sigma: float) -> Compared | None:
    if before <= 0 or now <= 0:
        return None
    sure = math.hypot(FLICKER, sigma / before)
    return Compared(
        Quantity(name, (shot,), number, "share"), Got(math.log(before), 0.0), Got(math.log(now), sure)
    )  # fmt: skip

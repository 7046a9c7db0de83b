"""What happens in a night of `nights.py`: causes of many kinds, each a command that a user could type, drawn so large
that the readings of the bench tell of it."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from nights_table import SEEN, Evening, Reading, most, off

if TYPE_CHECKING:
    from pico.backends.sim.world import World
    from pico.model.catalog import ComponentType

CLEAR, LEFT = 10.0, 8.0
"""By how many sigma some reading must change by a cause beside the others of its night, and how much of that must be
left with the sizes of those others free."""
TRIES = 60


@dataclass(frozen=True)
class Happening:
    """One cause: its `kind`, the `part`, and by how much, by the names that `pico sim` takes. `command`: which of its
    commands does it. A camera over the table `seen` it happen, or light alone tells."""

    kind: str
    part: str
    command: str
    by: Mapping[str, float | str]

    @property
    def seen(self) -> bool:
        """Whether a camera over the table sees it."""
        return self.command in ("nudge", "remove")

    @property
    def words(self) -> tuple[str, ...]:
        """The command line after `pico`."""
        if self.command == "remove":
            return "sim", "remove", self.part
        if self.command == "nudge":
            return "sim", "nudge", self.part, *(w for k, v in self.by.items() for w in (f"--{k}", str(v)))
        if self.command == "slip":
            ((tunable, by),) = self.by.items()
            return "sim", "slip", f"{self.part}.{tunable}", str(by)
        return "sim", "upset", self.part, *(f"{k}={v}" for k, v in self.by.items())

    def scaled(self, what: str, share: float) -> Happening | None:
        """Return the same with one size greater by a share; None for what has no size."""
        by = self.by[what]
        if isinstance(by, str):
            return None
        neutral = 1.0 if what in ("power", "gain") else 0.0
        return replace(self, by={**self.by, what: neutral + (by - neutral) * (1 + share)})


def happen(bench: Evening, world: World, causes: Sequence[Happening]) -> World:
    """Return a table after some causes; raises PicoError where one can't happen."""
    from pico.backends.sim import hand

    for one in causes:
        if one.command == "nudge":
            by = {k: float(v) for k, v in one.by.items()}
            world = hand.nudge(bench.setup, world, one.part, **by)
        elif one.command == "remove":
            world = hand.remove(bench.setup, world, one.part)
        elif one.command == "slip":
            ((tunable, by_),) = one.by.items()
            world = hand.slip(bench.setup, world, one.part, tunable, float(by_))
        else:
            world = hand.upset(bench.setup, world, one.part, one.by)
    return world


Draw = random.Random
Sizes = Callable[[Draw, "ComponentType"], Mapping[str, float | str]]


def _size(draw: Draw, low: float, high: float) -> float:
    """Return a size between two, evenly in its logarithm."""
    return float(f"{math.exp(draw.uniform(math.log(low), math.log(high))):.3g}")


def _signed(draw: Draw, low: float, high: float) -> float:
    return draw.choice((-1, 1)) * _size(draw, low, high)


def _way(one: str, other: str, low: float, high: float) -> Sizes:
    def sizes(draw: Draw, _: ComponentType) -> Mapping[str, float | str]:
        by, at = _size(draw, low, high), draw.uniform(0, 2 * math.pi)
        return {one: float(f"{by * math.cos(at):.3g}"), other: float(f"{by * math.sin(at):.3g}")}

    return sizes


def _one(what: str, low: float, high: float, signed: bool = False) -> Sizes:
    return lambda draw, _: {what: (_signed if signed else _size)(draw, low, high)}


def _slip(names: Sequence[str], low: float, high: float, sign: int = 0) -> Sizes:
    def sizes(draw: Draw, kind: ComponentType) -> Mapping[str, float | str]:
        by = sign * _size(draw, low, high) if sign else _signed(draw, low, high)
        return {draw.choice([n for n in names if n in kind.tunables]): by}

    return sizes


def _factor(what: str, sides: Sequence[int]) -> Sizes:
    return lambda draw, _: {what: float(f"{1 + draw.choice(sides) * _size(draw, 0.08, 0.5):.3g}")}


def _other_lens(draw: Draw, kind: ComponentType) -> Mapping[str, float | str]:
    focal = kind.number("focal_length", "mm")
    return {"optic": draw.choice([f"plano_convex_{f}" for f in (75, 100, 125, 150, 200) if f != focal])}


def _bump(draw: Draw, _: ComponentType) -> Mapping[str, float | str]:
    by, at = _size(draw, 1.5, 5.0), draw.uniform(0, 2 * math.pi)
    turned = {"dyaw": round(draw.uniform(-3, 3), 2)} if draw.random() < 0.3 else {}
    return {"dx": round(by * math.cos(at), 2), "dy": round(by * math.sin(at), 2), **turned}


@dataclass(frozen=True)
class Kind:
    """A kind of cause: which parts it may befall, which command does it, its sizes, and how PICO calls it."""

    may: Callable[[ComponentType], bool]
    command: str
    sizes: Sizes
    names: tuple[str, ...] = ()


def _is(*elements: str) -> Callable[[ComponentType], bool]:
    return lambda kind: kind.optics.element in elements


def _has(*tunables: str) -> Callable[[ComponentType], bool]:
    return lambda kind: any(t in kind.tunables and kind.tunables[t].datatype == "float" for t in tunables)


def _with(*parameters: str) -> Callable[[ComponentType], bool]:
    return lambda kind: kind.optics.element == "detector" and any(p in kind.parameters for p in parameters)


def _loss_of_power(draw: Draw, _: ComponentType) -> Mapping[str, float | str]:
    return {"power": round(1 - _size(draw, 0.08, 0.6), 3)}


def _surface(kind: ComponentType) -> bool:
    return kind.optics.element not in ("source", "iris", "slit", "block", "none")


_ACROSS, _TURNED, _PLATE = ("moved across",), ("zero of tip", "zero of tilt", "turned"), ("retardance",)
KINDS: dict[str, Kind] = {
    "laser lost power": Kind(_is("source"), "upset", _loss_of_power, ("power",)),
    "laser points elsewhere": Kind(_is("source"), "upset", _way("yaw", "pitch", 0.005, 0.05), ("pointing",)),
    "dirt on an optic": Kind(_surface, "upset", _one("loss", 0.06, 0.6), ("dirt",)),
    "part bumped": Kind(lambda k: k.optics.element != "source", "nudge", _bump),
    "part missing": Kind(lambda k: k.optics.element != "source", "remove", lambda *_: {}),
    "rotation mount slipped": Kind(_has("angle"), "slip", _slip(("angle",), 1.0, 15.0), ("zero of angle",)),
    "mirror mount slipped": Kind(_has("tip", "tilt"), "slip", _slip(("tip", "tilt"), 0.1, 2.0), _TURNED),
    "stage slipped": Kind(_has("stage_y", "stage_z"), "slip", _slip(("stage_y", "stage_z"), 0.05, 0.4), _ACROSS),
    "iris closed": Kind(_has("opening"), "slip", _slip(("opening",), 0.8, 6.5, -1), ("zero of opening",)),
    "lens swapped": Kind(_is("lens"), "upset", _other_lens, ("focal length",)),
    "lens settled": Kind(_is("lens"), "upset", _way("left", "up", 0.05, 0.4), _ACROSS),
    "detector gain": Kind(_is("detector"), "upset", _factor("gain", (-1, 1)), ("gain",)),
    "detector warm": Kind(_with("dark_current"), "upset", _one("dark", 20.0, 500.0), ("dark level",)),
    "detector displaced": Kind(_with("pixel_size", "mode_radius"), "upset", _way("left", "up", 0.02, 0.3), _ACROSS),
    "fiber coupler turned": Kind(_with("mode_radius"), "upset", _way("yaw", "pitch", 0.01, 0.15), ("turned",)),
    "wave plate of other retardance": Kind(_is("waveplate"), "upset", _one("retardance", 0.02, 0.15, True), _PLATE),
    "polarizer leaks": Kind(_is("polarizer"), "upset", _one("leak", 3e-4, 5e-3), ("extinction",)),
    "isolator turned": Kind(_is("isolator"), "upset", _one("roll", 3.0, 20.0, True), ("turned about the beam",)),
}  # fmt: skip


@dataclass(frozen=True)
class Night:
    """What happens in a night; `clear`: of each cause in the dark of the cameras by how many sigma it shows."""

    causes: tuple[Happening, ...]
    clear: tuple[float, ...]

    @property
    def moved(self) -> tuple[Happening, ...]:
        """Those that a camera over the table sees."""
        return tuple(c for c in self.causes if c.seen)

    @property
    def hidden(self) -> tuple[Happening, ...]:
        """Those of which light alone tells."""
        return tuple(c for c in self.causes if not c.seen)


def drawn(bench: Evening, draw: Draw, many: int) -> Night:
    """Draw a night with so many causes, all on different parts, each of which the readings tell of."""
    from pico.diagnostics import PicoError

    causes: list[Happening] = []
    night = Night((), ())
    for _ in range(TRIES * many):
        if len(causes) == many:
            return night
        one = _any(bench, draw, {c.part for c in causes}, {c.kind for c in causes})
        try:
            found = _clear(bench, [*causes, one])
        except PicoError:  # it would stand in another part
            continue
        if found is not None:
            causes.append(one)
            night = found
    return night


def _any(bench: Evening, draw: Draw, taken: set[str], kinds: set[str]) -> Happening:
    """Draw a cause of a kind that is not there yet, if any is left, on a part that is not taken."""
    able: dict[str, list[str]] = {}
    for name, kind in KINDS.items():
        parts = [p for p in bench.parts if p not in taken and kind.may(bench.setup.type_of(p))]
        if kind.command in ("nudge", "remove"):
            parts = [p for p in parts if bench.setup.lab.inventory[p].marker is not None]
        if parts and (name not in kinds or name == "part bumped"):
            able[name] = parts
    name = draw.choice(sorted(able))
    part, kind = draw.choice(able[name]), KINDS[name]
    return Happening(name, part, kind.command, kind.sizes(draw, bench.setup.type_of(part)))


def _clear(bench: Evening, causes: Sequence[Happening]) -> Night | None:
    """Return the night if the readings tell of each cause beside the others; None if not."""
    whole = happen(bench, bench.world, causes)
    now, sure = bench.readings(whole), unsure(bench, whole, causes)
    if not now:
        return None
    shown = []
    for one in causes:
        rest = [c for c in causes if c is not one]
        if one.seen:
            shown.append(math.inf)
            continue
        change = off(now, bench.readings(happen(bench, bench.world, rest)), sure)
        if most(change) < CLEAR or _left(bench, causes, one, now, change, sure) < LEFT:
            return None
        shown.append(most(change))
    return Night(tuple(causes), tuple(shown))


def unsure(bench: Evening, whole: World, causes: Sequence[Happening]) -> dict[str, float]:
    """Return how uncertain each reading is as the places of bumped parts are known as well as a camera sees them."""
    from pico.diagnostics import PicoError

    now, sums = bench.readings(whole), dict[str, float]()
    for one in (c for c in causes if c.command == "nudge"):
        for way, size in SEEN.items():
            try:
                there = happen(bench, whole, [Happening("", one.part, "nudge", {way: size})])
            except PicoError:
                continue
            other = bench.readings(there)
            for key in now.keys() & other.keys():
                sums[key] = sums.get(key, 0.0) + (now[key][0] - other[key][0]) ** 2
    return {key: math.sqrt(value) for key, value in sums.items()}


def _left(
    bench: Evening, causes: Sequence[Happening], but: Happening, now: Mapping[str, Reading],
    change: Mapping[str, float], sure: Mapping[str, float],
) -> float:  # fmt: skip
    """Return how much of what a cause changes [sigma] is left where the sizes of the other hidden ones are free."""
    import numpy as np

    columns = []
    for one, what in ((c, w) for c in causes if not c.seen and c is not but for w in c.by):
        other = one.scaled(what, 0.03)
        if other is None:
            continue
        there = happen(bench, bench.world, [other if c is one else c for c in causes])
        moved = off(now, bench.readings(there), sure)
        columns.append([moved.get(key, 0.0) for key in change])
    d = np.array(list(change.values()))
    if not columns:
        return float(np.linalg.norm(d))
    slopes = np.array(columns).T
    best, *_ = np.linalg.lstsq(slopes, d, rcond=1e-6)
    return float(np.linalg.norm(d - slopes @ best))

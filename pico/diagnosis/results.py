"""A result as the ray model tells it: an expression over measured numbers, each in a setting; and the errors that a
bench may have about it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from pico.diagnosis.nominal import QUIET, ZERO, Nominal, Step
from pico.diagnosis.quantities import Shot
from pico.diagnostics import PicoError, error
from pico.expressions import Expression, ExpressionError
from pico.geometry.seat import Seat, scatter_of
from pico.manifest.checks.claims import spoken, unit_in
from pico.model.goal import Looks
from pico.model.quantities import Value
from pico.optics.nominal.spread import WALK
from pico.optics.unseen import SEEN

ALIKE = math.sqrt(3.0)
"""By how much a limit within which all is alike likely is more than one standard deviation."""
STEPPED = math.sqrt(12.0)
"""By how much a resolution is more than one standard deviation of what it leaves open."""
_TOLD = {
    "centroid.x": ("centroid", "x"), "centroid.y": ("centroid", "y"), "fit.x": ("centroid", "x"),
    "fit.y": ("centroid", "y"), "width.major": ("width", "major"), "width.minor": ("width", "minor"),
    "fit.major": ("width", "major"), "fit.minor": ("width", "minor"), "power": ("power", "power"),
    "light": ("light", "light"), "voltage": ("voltage", "voltage"),
}  # fmt: skip
"""Numbers that the ray model tells, with its own names of them; a fit as if the spot were a Gaussian."""
_LIGHT = ("power", "light", "voltage")
"""Those that are the light on a detector [mW], whatever that makes of it."""
Set = Mapping[str, Value]


@dataclass(frozen=True)
class Error:
    """An error that a bench may have: of a `part` in a `way` (a tunable, or `pose.x`, `pitch`, `walk.yaw`), in one look
    alone where that sets it. `tolerance`: the limit within which it counts as right, None for what has none; `repeats`:
    one standard deviation as the bench is; in `unit`."""

    part: str
    way: str
    unit: str
    tolerance: float | None
    repeats: float
    look: str = ""

    @property
    def address(self) -> str:
        """What it is called."""
        return f"{self.part}.{self.way}"

    @property
    def tolerated(self) -> float:
        """One standard deviation of it within its tolerance."""
        return self.repeats if self.tolerance is None else self.tolerance / ALIKE


@dataclass(frozen=True, eq=False)
class Result:
    """A result of a bench as it should be: an `expression` over numbers, `used` by name, each with its look (empty: as
    all stands) and its address."""

    nominal: Nominal
    expression: Expression
    used: Mapping[str, tuple[str, str]]
    looks: Looks

    def value(
        self, steps: Sequence[Step] = (), *, times: float = 1.0, off: Mapping[str, Set] | None = None
    ) -> float | None:
        """Return the value with something changed, looks `off` from what they should set, all numbers as many `times`;
        None where there is none: the light is lost."""
        numbers = {}
        for name, (look, address) in self.used.items():
            at = (off or {}).get(look) or self.looks.get(look, {})
            found = self._number(address, at, steps)
            if found is None:
                return None
            numbers[name] = times * found
        try:
            return float(self.expression.evaluate(numbers))
        except ExpressionError:
            return None

    def erring(self, one: Error, by: float) -> float | None:
        """Return the value with an error so large."""
        if not one.look:
            return self.value(_steps(self.nominal, one, by))
        own = self.looks[one.look]
        return self.value(off={one.look: {**own, one.address: float(own[one.address]) + by}})

    def unit(self, value: float) -> str:
        """Return the unit of the value: that of its numbers where it grows as they do, else none."""
        grown = self.value(times=2.0)
        if grown is None or not math.isclose(grown, 2 * value, rel_tol=1e-9, abs_tol=1e-12):
            return ""
        if all(address.partition(".")[2] in _LIGHT for _, address in self.used.values()):
            return "mW"
        return unit_in(self.nominal.setup, self.used.values())

    def untold(self) -> str:
        """Return the number that nobody can tell as all should be, in words; empty where there is none."""
        for look, address in dict.fromkeys(self.used.values()):
            if self._number(address, self.looks.get(look, {}), ()) is None:
                return f"{address} as `{look}` sets it" if look else address
        return ""

    def errors(self) -> Iterator[Error]:
        """Yield what may be wrong with each part on the way of its light."""
        setup, met = self.nominal.setup, dict[str, None]()
        for look, address in self.used.values():
            light, detector = self.nominal.light(self.looks.get(look, {})), address.partition(".")[0]
            for n, crossing in enumerate(light.crossings):
                if crossing.component == detector:
                    met |= dict.fromkeys((crossing.beam.source, *(c.component for c in light.way(n))))
        for part in (name for name in met if name in setup.lab.inventory):
            yield from self._of_part(part)

    def _of_part(self, part: str) -> Iterator[Error]:
        setup = self.nominal.setup
        kind = setup.type_of(part)
        if setup.movable(part):
            one, near = scatter_of(setup, part), kind.pose.tolerance
            yield Error(part, "pose.x", "mm", near.position, one.x)
            yield Error(part, "pose.y", "mm", near.position, one.y)
            yield Error(part, "pose.yaw", "deg", near.yaw, one.yaw)
            yield from (Error(part, w, "deg", None, s) for w, s in (("pitch", one.pitch), ("roll", one.roll)))
            yield Error(part, "height", "mm", None, one.height)
        if kind.optics.element == "source":
            yield from (Error(part, way, "deg", None, WALK) for way in ("walk.yaw", "walk.pitch"))
        for name, tunable in kind.tunables.items():
            if tunable.datatype == "float" and name not in QUIET and (tunable.tolerance or tunable.resolution):
                setting = [look for look, own in self.looks.items() if f"{part}.{name}" in own]
                every = {look for look, _ in self.used.values()} <= set(setting)
                for look in (*setting, *([] if every else [""])):
                    repeats = (tunable.resolution or tunable.tolerance) / STEPPED
                    yield Error(part, name, tunable.unit, tunable.tolerance or None, repeats, look)

    def _number(self, address: str, at: Set, steps: Sequence[Step]) -> float | None:
        component, _, number = address.partition(".")
        measurable, own = _TOLD[number]
        found = self.nominal.numbers(Shot(f"{component}.{measurable}", at), steps)
        return None if found is None else found.get(own)


def result_of(nominal: Nominal, of: str, looks: Looks) -> Result:
    """Return the result that an expression is, in the names of looks; raises PicoError for what is none, and for
    numbers that the model does not tell."""
    try:
        expression, used = spoken(nominal.setup, of, looks)
    except ExpressionError as exc:
        hint = "an expression over measured numbers: `cam.centroid.y`; after a look's name with --set LOOK.PART.TUNABLE"
        raise PicoError(error("expression", f"`{of[:60]}` can't be told: {exc}", hint=hint)) from exc
    strange = [a for _, a in used.values() if a.partition(".")[2] not in _TOLD]
    if strange:
        text = f"the model of the light does not tell {strange[0]}"
        raise PicoError(error("budget", text, hint=f"it tells, of a detector: {', '.join(_TOLD)}"))
    found = Result(nominal, expression, used, looks)
    if untold := found.untold():
        text = f"nobody can tell {untold}: no light comes there, or beams of which no one size is known"
        raise PicoError(error("dark", text, hint="`pico beam --manifest` shows where the light goes"))
    return found


def _steps(nominal: Nominal, one: Error, by: float) -> tuple[Step, ...]:
    """Return an error as changes of what the model knows: a place in the table's frame as one along the part's axes,
    what leans about its foot."""
    kind = nominal.setup.type_of(one.part)
    about, turn = kind.frames.optical, math.radians(nominal.poses[one.part].yaw)
    found: dict[str, float]
    if one.way in kind.tunables:
        found = {ZERO + one.way: by}
    elif one.way == "pose.x":
        found = {"ahead": by * math.cos(turn), "left": -by * math.sin(turn)}
    elif one.way == "pose.y":
        found = {"ahead": by * math.sin(turn), "left": by * math.cos(turn)}
    elif one.way == "pose.yaw":
        (x, y, _), c, s = about, math.cos(math.radians(by)), math.sin(math.radians(by))
        found = {"yaw": by, "ahead": c * x - s * y - x, "left": s * x + c * y - y}
    elif one.way.startswith("walk."):
        found = {one.way.removeprefix("walk."): by}
    else:
        sits = SEEN.sitting(Seat(**{one.way: by}), about)  # type: ignore[arg-type]
        found = {way: getattr(sits, way) for way in ("ahead", "left", "up", "roll", "pitch")}
    return tuple(Step(one.part, way, size) for way, size in found.items() if size)

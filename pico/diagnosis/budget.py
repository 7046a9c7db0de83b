"""Which tolerance limits a result: what every error of placement and of a set-point does to it, by the ray model of a
bench as it should be.

Differences are of the whole model, so that lenses are thick and polarizers treat each plane wave by itself. Errors are
independent. What goals align away is not taken off, and the noise of measurements is not in it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from pico.diagnosis.nominal import Nominal
from pico.diagnosis.results import ALIKE, Error, Result, result_of
from pico.diagnostics import PicoError, error
from pico.model.goal import Looks

BENT = 0.1
"""From which share on an effect counts as not in proportion to its error."""
_ROUNDING = 1e-6
"""The share of its error below which a result is 0."""
_FINE = 0.05
"""The share of the smaller standard deviation by which is stepped for a derivative."""


@dataclass(frozen=True)
class Contribution:
    """What one error does to a result: of a tunable (`p2.pose.yaw`, `p1.angle`), of how a part sits (`p2.roll`,
    `p2.height`), of where a laser points (`laser.walk.yaw`); in one `look` alone where that sets it.

    `derivative`: of the result, per `unit` of the error. `tolerance`: the limit within which it counts as right, None
    for what has none. `repeats`: one standard deviation of it as the bench is. `tolerated`, `repeated`: what one
    standard deviation within the tolerance, and as the bench repeats, does to the result; None where the light is lost.
    `bent`: the former is not in proportion to the error."""

    address: str
    look: str
    unit: str
    derivative: float
    tolerance: float | None
    repeats: float
    tolerated: float | None
    repeated: float | None
    bent: bool


@dataclass(frozen=True)
class ErrorBudget:
    """The error budget of a result: its value and unit, and what contributes, the largest within tolerance first."""

    of: str
    looks: Looks
    value: float
    unit: str
    rows: tuple[Contribution, ...]

    @property
    def tolerated(self) -> float:
        """The root of the sum of squares within the tolerances: one standard deviation of the result."""
        return math.hypot(*(row.tolerated or 0.0 for row in self.rows))

    @property
    def repeated(self) -> float:
        """The same as the bench repeats."""
        return math.hypot(*(row.repeated or 0.0 for row in self.rows))

    @property
    def nothing(self) -> bool:
        """Whether the result is 0, but for how well numbers are computed."""
        return abs(self.value) <= _ROUNDING * self.tolerated

    @property
    def lost(self) -> tuple[str, ...]:
        """Errors within whose tolerance no light is left to tell the result."""
        return tuple(dict.fromkeys(row.address for row in self.rows if row.tolerated is None))


@dataclass(frozen=True)
class Tighter:
    """To what an error must be held: `was` and `to` are its tolerance, or where it has none (`limit` false) one
    standard deviation of how it repeats. `reached`: the bench repeats so well."""

    address: str
    unit: str
    limit: bool
    was: float
    to: float
    reached: bool

    @property
    def said(self) -> str:
        """`p1.angle to ± 0.022 deg`."""
        sign, note = ("± ", "") if self.limit else ("", " (1 sigma)")
        return f"{self.address} to {sign}{_down(self.to)} {self.unit}{note}"


def error_budget(nominal: Nominal, of: str, looks: Looks | None = None) -> ErrorBudget:
    """Return the error budget of an expression over measured numbers; raises PicoError for what is none, and for what
    the model cannot tell."""
    result = result_of(nominal, of, looks or {})
    value = result.value()
    if value is None or not math.isfinite(value):
        raise PicoError(error("budget", f"`{of[:60]}` has no value as all should be"))
    rows = [_contribution(result, value, one) for one in result.errors()]
    rows.sort(key=lambda row: -math.inf if row.tolerated is None else -row.tolerated)
    return ErrorBudget(of, result.looks, value, result.unit(value), tuple(rows))


def tighter(budget: ErrorBudget, wanted: float) -> tuple[Tighter, ...]:
    """Return to what errors must be held for a result to be known to `wanted`, one standard deviation within the
    tolerances: those that contribute most, each then as much as the others; none where all can stay as it is."""
    if wanted >= budget.tolerated:  # else the roundings below may take a last digit off a tolerance
        return ()
    by: dict[str, list[Contribution]] = {}
    for row in budget.rows:
        by.setdefault(row.address, []).append(row)
    each = sorted((math.hypot(*(row.tolerated or 0.0 for row in rows)), name) for name, rows in by.items())
    left = wanted * wanted
    for n, (effect, _) in enumerate(each):
        most = math.sqrt(left / (len(each) - n))
        if effect > most:
            return tuple(_held(by[name][0], most / size) for size, name in reversed(each[n:]))
        left -= effect * effect
    return ()


def _contribution(result: Result, value: float, one: Error) -> Contribution:
    step = _FINE * min(size for size in (one.tolerated, one.repeats) if size)
    up, down = result.erring(one, step), result.erring(one, -step)
    slope = math.nan if up is None or down is None else (up - down) / (2 * step)
    tolerated = _effect(result, value, one, one.tolerated)
    bent = tolerated is None or not abs(tolerated - abs(slope) * one.tolerated) <= BENT * tolerated
    repeated: float | None = abs(slope) * one.repeats  # what is straight to there is straight before
    if bent or one.repeats > one.tolerated:
        repeated = tolerated if one.repeats == one.tolerated else _effect(result, value, one, one.repeats)
    return Contribution(
        one.address, one.look, one.unit, slope, one.tolerance, one.repeats, tolerated, repeated, bent
    )  # fmt: skip


def _effect(result: Result, value: float, one: Error, size: float) -> float | None:
    """Return the root mean square of what an error so large does, either way; None where the light is lost."""
    up, down = result.erring(one, size), result.erring(one, -size)
    return None if up is None or down is None else math.hypot(up - value, down - value) / math.sqrt(2.0)


def _down(value: float) -> str:
    """Return a limit with two digits, rounded down: one that is rounded up is none."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1) if value > 0 else 1.0
    return f"{math.floor(value / step + 1e-9) * step:.2g}"


def _held(row: Contribution, share: float) -> Tighter:
    limit = row.tolerance is not None
    was = row.tolerance if row.tolerance is not None else row.repeats
    to = was * share
    return Tighter(row.address, row.unit, limit, was, to, row.repeats <= (to / ALIKE if limit else to))

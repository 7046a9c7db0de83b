"""A goal of the lab: what light is to be brought to, by which tunables, and what that may cost. A claim of it: how well
a result must be known."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Literal

from pico.model.quantities import Value
from pico.model.record import record

Looks = Mapping[str, Mapping[str, Value]]
"""Settings by name, each the values of tunables by address."""


@record
class Budget:
    """What an optimization may spend: measurements, and seconds on the bench's clock. `offline`: how long it may go on
    by itself where its bench is cut off from the coordinator and the lease is over [s]; it ends then, without it."""

    measurements: int = 60
    seconds: float = 600.0
    offline: float | None = None


@record
class Goal:
    """What light is to be brought to, and by which tunables: exactly one of `reach`, `minimize` and `maximize`.

    `tunables`: addresses (`ly_150.stage_y`) with the bounds within which they may be set, in their unit. `reach`:
    numbers that are measured (`cam.centroid.x`) with their targets, in their unit, each met within its `tolerance` (one
    number for all, or by name). `minimize`, `maximize`: an expression over such numbers. `signal`: a number that is
    measured too, below whose `least` nothing is believed. `algorithm`: one by name, with its `parameters`; without, one
    is chosen. `valid_for`: how long it counts as aligned once it was met (`12 h`). `offset`: how far from the best, in
    its unit, its one tunable is left, as from a null; counted from where the model of the algorithm has the best.
    `during`: tunables that are set to values while it is sought, and set back (`p1.angle: 90`).

    `looks`: what is set while it is measured, and set back at the end: settings by name, each with its tunables. What
    is measured is then spoken of with the name of its look: `near.meter.power`. `after`: goals of the Lab that are
    sought first, in this order, where this one is dark to begin with; each is begun when the one before has light.
    """

    tunables: Mapping[str, tuple[float, float]]
    reach: Mapping[str, float] | None = None
    minimize: str | None = None
    maximize: str | None = None
    tolerance: float | Mapping[str, float] | None = None
    signal: str | None = None
    least: float | None = None
    algorithm: str | None = None
    parameters: Mapping[str, float] | None = None
    budget: Budget = Budget()
    valid_for: str | None = None
    offset: float | None = None
    during: Mapping[str, Value] | None = None
    description: str = ""
    looks: Looks | None = None
    after: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        if self.offset is not None and (self.reach is not None or len(self.tunables) != 1):
            raise ValueError("`offset` goes with `minimize` or `maximize` and one tunable")
        if sum(one is not None for one in (self.reach, self.minimize, self.maximize)) != 1:
            raise ValueError("a goal has exactly one of `reach`, `minimize` and `maximize`")
        if not self.tunables:
            raise ValueError("a goal has `tunables`, each with its bounds: {ly_150.stage_y: [-1, 1]}")
        if (self.signal is None) != (self.least is None):
            raise ValueError("`signal` and `least` go together")

    @property
    def aim(self) -> Literal["reach", "minimize", "maximize"]:
        """Which of the three it is."""
        return "reach" if self.reach is not None else "minimize" if self.minimize is not None else "maximize"

    @property
    def expressions(self) -> tuple[str, ...]:
        """The expressions over what is measured, those of `reach` numbers by name, that of `signal` last."""
        own = tuple(self.reach or ()) or (self.minimize or self.maximize or "",)
        return (*own, *((self.signal,) if self.signal else ()))

    @property
    def texts(self) -> tuple[str, ...]:
        """The expressions without the names of looks: what is measured, whatever is set for it."""
        return tuple(self.plain(text) for text in self.expressions)

    def plain(self, text: str) -> str:
        """Return an expression without the names of looks."""
        return self._looked.sub("", text)

    def seen_in(self, look: str) -> tuple[str, ...]:
        """Return the numbers that expressions speak of in a look, without its name; in none where it is empty."""
        words = (w for text in self.expressions for w in re.findall(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+", text))
        if not look:
            return tuple(dict.fromkeys(w for w in words if not self._looked.match(w)))
        return tuple(dict.fromkeys(w.removeprefix(f"{look}.") for w in words if w.startswith(f"{look}.")))

    @property
    def _looked(self) -> re.Pattern[str]:
        names = "|".join(map(re.escape, self.looks or ())) or r"(?!)"
        return re.compile(rf"(?<![\w.])(?:{names})\.(?=[A-Za-z_]\w*\.)")

    def near(self, output: str) -> float:
        """Return the tolerance of a number that is to be reached, 0 where none is said."""
        if isinstance(self.tolerance, Mapping):
            return self.tolerance.get(output, 0.0)
        return self.tolerance or 0.0


def goal_from_json(data: Mapping[str, object]) -> Goal:
    """Return the goal whose `as_json` gave `data`, as the plan of an optimization has it."""
    from pydantic import TypeAdapter

    goal: Goal = TypeAdapter(Goal).validate_python(dict(data))
    return goal


@record
class Claim:
    """How well a result must be known, whatever is within its tolerance: `to`, one standard deviation, as a share of
    the result (`2 %`) or in its unit (`1 um`).

    `of`: an expression over measured numbers (`cam.centroid.y`); with `looks` those are spoken of by the name of a
    setting, as in a goal: `(plus.cam.centroid.y - minus.cam.centroid.y) / 2`.
    """

    of: str
    to: Value
    looks: Looks | None = None
    description: str = ""

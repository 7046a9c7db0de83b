"""What the ray model says that changes of parts do to the quantities of a bench, and what instruments show of it: in
the dark a meter reads no less than its noise."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause, Way
from pico.diagnosis.curves import Curve, bends
from pico.diagnosis.darkness import stopped
from pico.diagnosis.nominal import Nominal, Step
from pico.diagnosis.quantities import Quantity
from pico.diagnosis.responses import Response, between, constant, linear, shown, smooth

SHARES = (0.1, 0.35, 0.8)
"""Logarithms of a factor of a focal length that are traced."""
OPENINGS = (0.04, 0.12, 0.25, 0.45, 0.65, 0.85, 0.97)
"""Shares of its opening by which an iris may have closed that are traced."""


@dataclass(frozen=True, eq=False)
class Modelled:
    """Quantities (n) of a bench as the model has them. `lowest`: the least change of each that its instrument can show,
    -inf where there is no such limit."""

    nominal: Nominal
    wanted: tuple[Quantity, ...]
    lowest: Any

    def read(self, steps: Sequence[Step] = (), *, scans: bool = True) -> Any:
        """Return the quantities (n,) after some changes, nan where the model does not tell, or of `scans` that are left
        out."""
        found = [self.nominal.quantity(one, steps) if scans or len(one.shots) == 1 else None for one in self.wanted]
        return np.array([math.nan if one is None else one.value for one in found])

    @cached_property
    def base(self) -> Any:
        """The quantities (n,) without any change."""
        return self.read()

    def changes(self, steps: Sequence[Step]) -> Any:
        """Return by how much quantities (n,) change, nan where the model does not tell; where no light comes any more,
        by as much as can be shown."""
        return self.shown(self.read(steps) - self.base)

    def shown(self, changes: Any) -> Any:
        """Return changes (..., n) as instruments show them."""
        return shown(changes, self.lowest)

    def slopes(self, ways: Sequence[tuple[str, Way]]) -> dict[tuple[str, str], Any]:
        """Return the derivatives (n,) of the quantities by ways of parts, 0 where the model does not tell."""
        return {(part, way.what): self._slope(part, way) for part, way in ways}

    def _slope(self, part: str, way: Way) -> Any:
        slope = (self.read((Step(part, way.what, way.step),)) - self.base) / way.step
        return np.where(np.isfinite(slope) & (np.abs(slope) * way.fault > 1e-9), slope, 0.0)

    def proportional(self, possible: Sequence[Cause]) -> tuple[Response, ...]:
        """Return what each cause does, taken to be in proportion to its size: with one trace for each way."""
        slopes = self.nominal.kept("slopes", (repr(self.wanted), tuple(possible)), partial(self._slopes, possible))
        return tuple(linear(c, [slopes[c.part, w.what] for w in c.ways]) for c in possible if c.ways)

    def _slopes(self, possible: Sequence[Cause]) -> dict[tuple[str, str], Any]:
        return self.slopes([(cause.part, way) for cause in possible for way in cause.ways])

    def responses(self, possible: Sequence[Cause]) -> tuple[Response, ...]:
        """Return what each cause does to the quantities, by its size; what was traced once is kept."""
        key = repr(self.wanted)
        return tuple(self.nominal.kept("response", (key, c), partial(self._response, c)) for c in possible)

    def _response(self, cause: Cause) -> Response:
        if not cause.ways:
            return constant(cause, stopped(self.nominal, self.wanted, cause))
        if len(cause.ways) == 1 and (sizes := self._traced(cause.part, cause.ways[0])):
            return self._tabled(cause, sizes)
        steps = [w.step for w in cause.ways]
        return smooth(cause, steps, lambda at, scans: self.read(self._steps(cause, at), scans=scans) - self.base)

    def _traced(self, part: str, way: Way) -> tuple[float, ...]:
        """Return the sizes of a way that are traced, where no parabola tells what it does; none where one does."""
        if way.what == "focal":
            return (*(-s for s in reversed(SHARES)), *SHARES)
        if way.what.endswith(":opening"):
            live = float(self.nominal.values.get(part, {}).get("opening") or 0.0)
            return (*(-s * live for s in reversed(OPENINGS)), 0.1 * live, 0.4 * live) if live else ()
        return (math.inf,) if bends(way) else ()

    def _tabled(self, cause: Cause, sizes: tuple[float, ...]) -> Response:
        (way,) = cause.ways
        if sizes[0] < math.inf:
            rows = {s: self.read(self._steps(cause, (s,))) - self.base for s in sizes}
            return between(cause, {0.0: np.zeros(len(self.wanted)), **rows})
        curve = Curve(self.nominal, cause.part, way)
        rows = {float(s): curve.quantities(self.wanted, float(s)) - self.base for s in curve.sizes}
        if way.what.endswith(":angle"):
            far = Curve(self.nominal, cause.part, way, whole=True)
            rows |= {float(s): far.quantities(self.wanted, float(s)) - self.base for s in far.sizes}
        return between(cause, rows)

    def _steps(self, cause: Cause, size: Sequence[float]) -> tuple[Step, ...]:
        return tuple(Step(cause.part, w.what, float(s)) for w, s in zip(cause.ways, size, strict=True) if s)

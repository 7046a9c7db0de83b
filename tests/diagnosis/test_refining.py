"""Sizes of causes are found from far away, though a detector was dark there, and a dark reading is only a bound."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import pytest

from pico.diagnosis.causes import Cause, Way
from pico.diagnosis.explanations import Changed, Explanation, evaluate
from pico.diagnosis.modelled import Modelled
from pico.diagnosis.nominal import Nominal, Step
from pico.diagnosis.quantities import Quantity
from pico.diagnosis.refining import FAR, refine, residuals, squeezed
from pico.diagnosis.responses import smooth
from pico.diagnosis.weighing import at_size

LOWEST = np.array([-6.0, -6.0])
NOISE = 0.01


class Coupled(Modelled):
    """Two fibers whose light falls as a Gaussian with a mirror's angle, beside different maxima."""

    def read(self, steps: Sequence[Step] = (), *, scans: bool = True) -> Any:
        """Return the logarithms of both powers."""
        by = sum(step.size for step in steps)
        return -(np.array([by + 2.0, by + 3.0]) ** 2) / 2


def problem(true: float, lowest: Any = LOWEST) -> tuple[Changed, Modelled]:
    model = Coupled(cast(Nominal, None), (cast(Quantity, None),) * 2, lowest)
    cause = Cause("mirror", "zero of tip", (Way("zero:tip", "mrad", 1e-3, 3.0, 0.1),))
    response = smooth(cause, [0.1], lambda at, _: model.read([Step("mirror", "zero:tip", at[0])]) - model.base)
    d = model.changes([Step("mirror", "zero:tip", true)])
    return Changed(d, np.eye(2) * NOISE**2, (response.shown(lowest),), (-5.0,), math.log(0.9), 0.005, 0.05), model


def at(what: Changed, model: Modelled, size: float) -> Explanation:
    """Return the mirror at a size as the explanation to begin with."""
    (response,), there = what.responses, np.array([size])
    found = at_size(response.cause, there, response.at(there), response.slope_at(there), what.usual, what.d)
    return evaluate(what, model, Explanation((0,), (found,)), [there])


@pytest.mark.parametrize("start", [2.4, 4.5])
def test_the_way_back_from_the_dark_is_found(start: float) -> None:
    what, model = problem(1.3)
    one = at(what, model, start)
    assert one.whole == pytest.approx(LOWEST), "all is dark there"
    assert refine(what, model, one).found[0].size == pytest.approx([1.3], abs=0.02)


def test_a_dark_reading_is_a_bound() -> None:
    what, _ = problem(1.8)
    assert what.d[1] == LOWEST[1] < what.d[0]
    noise = np.full(2, NOISE)
    darker, brighter = (residuals(what, LOWEST, np.array([what.d[0], LOWEST[1] + by]), noise) for by in (-20.0, 0.1))
    assert darker == pytest.approx([0.0, 0.0])
    assert brighter == pytest.approx([0.0, 10.0])
    assert not np.isnan(residuals(what, np.array([-np.inf, -6.0]), what.d, noise)).any()


def test_residuals_are_squeezed_beyond_far() -> None:
    off = np.array([-FAR, 0.0, 1.0, FAR, FAR * math.e, -FAR * math.e**2])
    assert squeezed(off) == pytest.approx([-FAR, 0.0, 1.0, FAR, 2 * FAR, -3 * FAR])

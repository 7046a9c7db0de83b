"""A tunable that is left by an offset from the null: counted from the fitted null, not from the darkest reading."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from pico.diagnostics import PicoError
from pico.optimize.loop import Limits, Outcome, Reading, loop
from pico.optimize.problem import Problem, Variable
from pico.optimize.registry import made

ANGLE = Variable("angle", 0.0, 360.0, 88.0, resolution=0.01, period=180.0)


def run(read: Callable[[float], float | None], offset: float, start: float = 88.0, within: float = 0.02) -> Outcome:
    """Return how the law of Malus is fitted to what is read at an angle, None where nothing can be."""
    variable = Variable(ANGLE.name, ANGLE.low, ANGLE.high, start, ANGLE.resolution, ANGLE.period)
    problem = Problem((variable,), ("power",), "minimize", offset={"angle": offset})
    steps = loop(problem, lambda p: made("malus", p, {"within": within}), Limits(60))
    ask, time = next(steps), 0.0
    while True:
        time += 1
        value = read(ask.point["angle"]) if ask.measure else None
        values = {} if value is None else {"power": value, "power_sigma": max(1e-3 * abs(value), 1e-7)}
        try:
            ask = steps.send(Reading(values, time))
        except StopIteration as stop:
            found: Outcome = stop.value
            return found


def law(null: float, angle: float) -> float:
    """Return the power behind two polarizers with an extinction of 1e-5."""
    return math.sin(math.radians(angle - null)) ** 2 + 1e-5


@pytest.mark.parametrize("offset", [0.0, 1.0, -2.5])
@pytest.mark.parametrize("null", [0.3, 91.0, 179.8])
@pytest.mark.parametrize("brightest", [2.0, 0.3, 0.02])
def test_it_is_left_there_though_a_detector_saturates_and_readings_are_noisy(
    null: float, offset: float, brightest: float
) -> None:
    rng = np.random.default_rng([round(100 * null), round(10 * offset) + 100, round(100 * brightest)])

    def read(angle: float) -> float | None:
        power = law(null, angle)
        return None if power > brightest else power * (1 + 1e-3 * rng.normal())

    found = run(read, offset)
    assert found.met and found.solution is not None and found.last is not None
    assert found.tried[-1].why == "offset"
    apart = (found.last["angle"] - null - offset + 90) % 180 - 90
    assert abs(apart) < 0.02
    assert found.last["angle"] == pytest.approx(round(found.last["angle"], 2), abs=1e-9)
    assert found.solution.sigma["angle"] < 0.01


def test_what_does_not_follow_the_law_is_not_met_and_goes_back() -> None:
    found = run(lambda angle: 1 + 0.3 * math.sin(math.radians(7 * angle)), 1.0)
    assert not found.met and found.solution is None


def test_where_nothing_is_read_it_is_not_met_and_goes_back_to_its_start() -> None:
    found = run(lambda _: None, 1.0, start=12.0)
    assert not found.met and found.last is None


def test_an_algorithm_without_a_model_is_refused() -> None:
    problem = Problem((ANGLE,), ("power",), "minimize", offset={"angle": 1.0})
    with pytest.raises(PicoError, match="does not tell where the best is") as refused:
        made("nelder_mead", problem)
    assert "malus" in refused.value.diagnostics[0].hint


@pytest.mark.parametrize("null", [0.0, 0.4, 179.8])
@pytest.mark.parametrize("start", [1.0, 3.0, 175.0])
def test_a_polarizer_between_polarizers_is_crossed_too_though_its_law_is_another(null: float, start: float) -> None:
    """The first of two polarizers behind a plate that turns the light to 45.5 deg: a product of two laws."""
    rng = np.random.default_rng([round(100 * null), round(100 * start)])

    def read(angle: float) -> float | None:
        power = law(null, angle) * math.cos(math.radians(angle - 45.5)) ** 2
        return None if power > 0.2 else power * (1 + 1e-3 * rng.normal())

    found = run(read, 0.0, start=start)
    assert found.met and found.last is not None
    assert abs((found.last["angle"] - null + 90) % 180 - 90) < 0.02
    assert len(found.tried) <= 12

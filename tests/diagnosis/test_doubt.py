"""Causes of an explanation that leaves readings unexplained are told as candidates, unless they are proven."""

from __future__ import annotations

import math

import numpy as np
import pytest

from pico.diagnosis.causes import Cause, Way
from pico.diagnosis.doubt import POSSIBLE, doubted
from pico.diagnosis.explanations import Changed, Explanation
from pico.diagnosis.grouping import Suspect, grouped
from pico.diagnosis.responses import linear
from pico.diagnosis.weighing import at_size

NOISE = 0.01
REACH = {"laser": [1.0, 1.0, 1.0, 0.0], "mirror": [0.0, 1.0, 0.5, 0.0], "iris": [0.0, 0.0, 1.0, 0.0],
         "cam": [0.0, 0.0, 0.0, 1.0]}  # fmt: skip
"""How a change of each part shows in a monitor, two detectors, and a reading that did not change."""


def explained(changes: list[float], sizes: dict[str, float]) -> tuple[Changed, Explanation]:
    """Return changes of the readings, and an explanation of them by some parts."""
    responses = [linear(Cause(p, "gain", (Way("gain", "", 1e-4, 0.3, 0.01),)), [np.array(r)]) for p, r in REACH.items()]
    usual = np.eye(len(changes)) * NOISE**2
    what = Changed(np.array(changes), usual, tuple(responses), (-5.0,) * len(responses), math.log(0.9), 0.0, 0.05)
    one = Explanation(exact=True)
    for n, response in enumerate(responses):
        if (by := sizes.get(response.cause.part)) is not None:
            size, moved = np.array([by]), response.slope[:, 0] * by
            found = at_size(response.cause, size, moved, response.slope, usual, moved)
            one = Explanation((*one.numbers, n), (*one.found, found), exact=True)
    return what, one


def told(what: Changed, one: Explanation, *others: Explanation) -> tuple[tuple[Suspect, ...], ...]:
    return doubted(what, one, [one, *others], grouped(what, [one]))


def test_causes_that_leave_readings_unexplained_are_candidates_of_one_group() -> None:
    what, one = explained([0.0, -0.3, -0.9, 0.0], {"mirror": -0.3})
    assert np.abs(what.unexplained(one)).max() > 50
    (group,) = told(what, one)
    assert {s.part for s in group} == {"laser", "mirror", "iris"}, "no reading that differs tells of cam"
    assert {s.kind for s in group} == {POSSIBLE}
    assert max(s.probability for s in group) < 0.5


def test_what_a_monitor_proves_stays_named() -> None:
    what, one = explained([-0.2, -0.5, -1.3, 0.0], {"laser": -0.2, "mirror": -0.3})
    (laser,), rest = told(what, one)
    assert laser.part == "laser" and laser.probability == pytest.approx(1.0)
    assert {s.part for s in rest} == {"mirror", "iris"}


def test_what_all_near_explanations_have_stays_named() -> None:
    what, one = explained([0.0, -0.3, -0.9, 0.0], {"mirror": -0.3})
    near = [explained([0.0, -0.3, -0.9, 0.0], {"mirror": -0.3, "cam": by})[1] for by in (1e-4, 2e-4)]
    (mirror,), rest = told(what, one, *near)
    assert mirror.part == "mirror" and {s.part for s in rest} == {"laser", "iris"}
    (group,) = told(what, one, *near, explained([0.0, -0.3, -0.9, 0.0], {"iris": -0.7})[1])
    assert "mirror" in {s.part for s in group}, "one explanation that is near does without it"


def test_causes_that_explain_all_stay_as_they_are() -> None:
    what, one = explained([0.0, -0.3, -0.85, 0.0], {"mirror": -0.3, "iris": -0.7})
    groups = grouped(what, [one])
    assert doubted(what, one, [one], groups) == groups

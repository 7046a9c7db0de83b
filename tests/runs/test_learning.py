"""A twin learns how its bench errs from placements and times; of what there are few it keeps what is declared."""

from __future__ import annotations

import math
import statistics
from dataclasses import replace

import pytest

from pico.geometry.seat import PlacementError, drawn, injected, scatter_of
from pico.manifest.load import load_folder
from pico.model.simulated import SimErrors
from pico.model.trace.learned import Estimate, Learned, Scatter
from pico.resources import labs_dir
from pico.runs.learning import ENOUGH, learn
from pico.runs.lessons import Lessons, Off

SETUP, _ = load_folder(labs_dir() / "shel").require()
SETUP = replace(SETUP, lab=replace(SETUP.lab, sim=replace(SETUP.lab.sim, errors=SimErrors(seat=1.0))))
PART, OTHER = "lx_100", "lx_125"
TYPE = SETUP.lab.inventory[PART].type
TRUE = PlacementError(x=0.31, y=0.31, yaw=0.02)
"""The type declares 0.1 mm and 0.05 deg."""


def placed(seed: int, count: int, part: str = PART, one: PlacementError = TRUE) -> list[Off]:
    errors = [drawn(SETUP, part, seed, n, one=one) for n in range(count)]
    return [Off(part, e.x, e.y, e.yaw) for e in errors]


def surprise(setup_errs: PlacementError, offs: list[Off]) -> float:
    """Minus the mean logarithm of the likelihood of placements where a twin errs so: less is a better prediction."""
    terms = [
        math.log(sigma) + (value / sigma) ** 2 / 2
        for off in offs
        for value, sigma in ((off.x, setup_errs.x), (off.y, setup_errs.y), (off.yaw, setup_errs.yaw))
    ]
    return statistics.fmean(terms)


def test_what_is_placed_otherwise_than_declared_is_learned_within_the_standard_error_and_predicts_better() -> None:
    pulls, better = [], []
    for seed in range(50):
        found = learn(SETUP, Lessons(placed=placed(seed, 20)), None, 0.0).learned.types[TYPE]
        assert found.position is not None and found.yaw is not None
        pulls.append((found.position.value - TRUE.x) / found.position.sigma)
        pulls.append((found.yaw.value - TRUE.yaw) / found.yaw.sigma)
        errs = injected(SETUP, PART, Learned(types={TYPE: found}), 0.0)
        held_out = placed(10_000 + seed, 20)
        better.append(surprise(errs, held_out) < surprise(scatter_of(SETUP, PART), held_out))
    assert 0.5 < sum(abs(one) < 1 for one in pulls) / len(pulls) < 0.8
    assert sum(abs(one) < 3 for one in pulls) / len(pulls) > 0.95
    assert all(better)


def test_a_bench_that_errs_as_declared_teaches_the_twin_nothing_else() -> None:
    one = scatter_of(SETUP, PART)
    found = learn(SETUP, Lessons(placed=placed(4, 200, one=one)), None, 0.0).learned.types[TYPE]
    assert found.position is not None and found.yaw is not None
    assert found.position.value == pytest.approx(one.x, rel=0.15)
    assert found.yaw.value == pytest.approx(one.yaw, rel=0.2)


def test_of_few_placements_what_is_declared_stays_and_is_told() -> None:
    found = learn(SETUP, Lessons(placed=placed(1, ENOUGH - 1)), None, 0.0)
    assert found.learned.types == {} and injected(SETUP, PART, found.learned, 0.0) == scatter_of(SETUP, PART)
    assert {(row.count, row.measured, row.because) for row in found.rows} == {(7, None, "too few, as declared")}
    assert [row.after for row in found.rows] == [row.before for row in found.rows] == [0.1, 0.05]


def test_a_type_of_which_there_are_few_errs_as_others_that_are_seated_so() -> None:
    assert SETUP.seating_of(OTHER) == SETUP.seating_of(PART) and SETUP.lab.inventory[OTHER].type != TYPE
    found = learn(SETUP, Lessons(placed=[*placed(2, 40), *placed(2, 2, OTHER)]), None, 0.0).learned
    assert SETUP.lab.inventory[OTHER].type not in found.types
    assert injected(SETUP, OTHER, found, 0.0).x == pytest.approx(0.31, rel=0.25)


def test_what_somebody_knocked_over_does_not_count_and_what_looking_adds_is_taken_off() -> None:
    seen = placed(5, 60, one=PlacementError(x=0.37, y=0.37, yaw=0.02))
    offs = [replace(off, position=0.2, turn=0.01) for off in seen]
    found = learn(SETUP, Lessons(placed=[*offs, Off(PART, 40.0, -25.0, 90.0)]), None, 0.0).learned.types[TYPE]
    assert found.position is not None and abs(found.position.value - TRUE.x) < 3 * found.position.sigma < 0.15


def test_what_stands_off_the_same_way_is_no_scatter_and_said() -> None:
    aside = [replace(off, x=off.x + 1.0) for off in placed(6, 30)]
    found = learn(SETUP, Lessons(placed=aside), None, 0.0)
    position = found.learned.types[TYPE].position
    assert position is not None and position.value == pytest.approx(0.31, rel=0.3)
    assert [d.code for d in found.diagnostics] == ["placed-aside"] and "in x" in found.diagnostics[0].summary


def test_a_lab_that_asks_for_exact_placements_has_them() -> None:
    exact = replace(SETUP, lab=replace(SETUP.lab, sim=replace(SETUP.lab.sim, errors=SimErrors(seat=0.0))))
    learned = Learned(types={TYPE: Scatter(position=Estimate(value=0.3, sigma=0.1, count=9, before=0.1))})
    assert injected(exact, PART, learned, 1.0) == PlacementError()


def test_times_are_learned_by_kind_and_what_the_twin_said_in_all_is_told() -> None:
    told = Lessons(times={"move arm1": [(1.4 * t, t) for t in range(3, 13)], "park arm1": [(9.0, 1.0)]})
    found = learn(SETUP, told, Learned(times={"move arm1": Estimate(value=1.1, sigma=0.1, count=9, before=1)}), 0.0)
    assert found.learned.time("move arm1") == pytest.approx(1.4)
    assert found.learned.times["move arm1"].before == 1.1 and "park arm1" not in found.learned.times
    assert found.seconds == pytest.approx({"measured": 114.0, "planned": 76.0, "before": 83.5, "after": 106.0})

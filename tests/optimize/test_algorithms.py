"""Algorithms: they stay within bounds whatever is measured, are the same again, and solve what they are made for."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.diagnostics import PicoError
from pico.optimize.choosing import Tuned, choose
from pico.optimize.problem import Algorithm, Nominal, Point, Problem, Variable
from pico.optimize.registry import algorithm_file, known, made

VARIABLES = tuple(Variable(f"m{n}.tip", -2.0, 3.0, 0.5) for n in range(4))
OUTPUTS = ("cam.x", "cam.y")
QUICK = [name for name in known() if name != "cobyqa"]


def problem_for(name: str, aim: str | None = None) -> Problem:
    declared = algorithm_file(name).DECLARATION
    count, wanted = max(declared.variables[0], min(2, declared.variables[1])), aim or declared.aims[0]
    outputs = OUTPUTS[: max(1, min(2, declared.outputs[1])) if wanted == "reach" else 1]
    tolerance = dict.fromkeys(outputs, 0.01)
    told = nominal(count) if name in ("likely", "beam_walk") else None
    return Problem(VARIABLES[:count], outputs, wanted, dict.fromkeys(outputs, 0.0), tolerance, told)  # type: ignore[arg-type]


def nominal(count: int, width: float = 0.2, far: float = 0.6, depth: float = 6.0) -> Nominal:
    """Round, around where it is: the power falls over `width`, the best is `far` away."""
    one = np.eye(count)
    return Nominal(*(tuple(map(tuple, (x * one).tolist())) for x in (width**-2, far**2)), depth)


def driven(algorithm: Algorithm, read: Callable[[Point], Mapping[str, float]], most: int = 400) -> list[Point]:
    tried = []
    for _ in range(most):
        points = algorithm.suggest()
        if not points:
            break
        tried += points
        algorithm.ingest([{**p, **read(p)} for p in points])
    return tried


readings = st.one_of(
    st.just({}), st.fixed_dictionaries({n: st.floats(allow_infinity=True) for n in OUTPUTS}),
    st.fixed_dictionaries({n: st.sampled_from([0.0, 1.0, -1e300, 1e300, 1e-300]) for n in OUTPUTS}),
    st.fixed_dictionaries({n: st.floats(0, 10) for n in (*OUTPUTS, *(f"{n}_sigma" for n in OUTPUTS))}),
)  # fmt: skip


@pytest.mark.parametrize("name", known())
@settings(deadline=None, max_examples=25)
@given(data=st.data())
def test_what_is_suggested_lies_within_the_bounds_whatever_is_read(name: str, data: st.DataObject) -> None:
    aims = algorithm_file(name).DECLARATION.aims
    problem = problem_for(name, data.draw(st.sampled_from(aims)))
    algorithm = made(name, problem)
    with np.errstate(all="ignore"):
        for number in range(12 if name == "cobyqa" else 40):
            points = algorithm.suggest(3)
            if not points:
                break
            for point in points:
                assert point.keys() == {v.name for v in problem.variables}
                assert all(v.low <= point[v.name] <= v.high for v in problem.variables), (number, point)
            algorithm.ingest([{**p, **data.draw(readings)} for p in points])


@pytest.mark.parametrize("name", known())
def test_the_same_readings_make_the_same_suggestions(name: str) -> None:
    problem = problem_for(name)
    sign = -1 if problem.aim == "maximize" else 1

    def read(point: Point) -> dict[str, float]:
        value = sign * sum((x - 0.3) ** 2 for x in point.values())
        return {n: math.exp(value) if sign < 0 else value - 0.1 * k for k, n in enumerate(problem.outputs)}

    one, two = (driven(made(name, problem, seed=3), read, 40) for _ in range(2))
    assert one == two and one


def test_points_of_others_pass_an_algorithm_by() -> None:
    algorithm = made("nelder_mead", problem_for("nelder_mead", "minimize"))
    first = algorithm.suggest()
    algorithm.ingest([{"m0.tip": 1.0, "m1.tip": 2.0, "cam.x": 5.0}])
    assert algorithm.suggest() == first and not algorithm.finished


@pytest.mark.parametrize("name", ["nelder_mead", "rcds", "cobyqa", "cma_es"])
@pytest.mark.parametrize("aim", ["minimize", "maximize"])
def test_searches_find_the_extremum_of_a_skew_bowl(name: str, aim: str) -> None:
    problem = Problem(VARIABLES[:2], ("cam.x",), aim)  # type: ignore[arg-type]
    sign = 1 if aim == "minimize" else -1

    def read(point: Point) -> dict[str, float]:
        x, y = point["m0.tip"] - 1.1, point["m1.tip"] + 0.4
        return {"cam.x": sign * (x**2 + 1.2 * x * y + 2 * y**2), "cam.x_sigma": 1e-5}

    tried = driven(made(name, problem), read)
    best = min(tried, key=lambda p: sign * read(p)["cam.x"])
    assert best["m0.tip"] == pytest.approx(1.1, abs=0.03) and best["m1.tip"] == pytest.approx(-0.4, abs=0.03)
    assert len(tried) < 300


@given(
    st.floats(-1.5, 2.5), st.floats(-1.5, 2.5), st.floats(-2, 2).filter(lambda g: abs(g) > 0.2), st.floats(-0.5, 0.5)
)
def test_newton_needs_five_readings_of_what_is_linear(x: float, y: float, gain: float, skew: float) -> None:
    problem = Problem(VARIABLES[:2], OUTPUTS, "reach", {"cam.x": 3.0}, dict.fromkeys(OUTPUTS, 1e-6))

    def read(p: Point) -> dict[str, float]:
        return {"cam.x": 3 + gain * (p["m0.tip"] - x) + skew * (p["m1.tip"] - y), "cam.y": p["m1.tip"] - y}

    tried = driven(made("centroid_newton", problem), read)
    assert problem.met({**tried[-1], **read(tried[-1])}) and len(tried) <= 5


def told(problem: Problem, slopes: np.ndarray) -> Problem:
    """The same, with a model that says how the readings follow the tunables."""
    return replace(problem, nominal=replace(nominal(2), slopes=tuple(map(tuple, slopes.tolist()))))


@given(st.floats(-1.5, 2.5), st.floats(-1.5, 2.5), st.floats(0.9, 1.1))
def test_newton_needs_few_readings_where_a_model_tells_the_slopes(x: float, y: float, like: float) -> None:
    slopes = np.array([[800.0, 30.0], [-20.0, 700.0]])
    problem = Problem(VARIABLES[:2], OUTPUTS, "reach", {"cam.x": 3.0}, dict.fromkeys(OUTPUTS, 5.0))

    def read(p: Point) -> dict[str, float]:
        left, up = slopes @ [p["m0.tip"] - x, p["m1.tip"] - y]
        return {"cam.x": 3 + left, "cam.y": up}

    exactly = driven(made("centroid_newton", told(problem, slopes)), read)
    nearly = driven(made("centroid_newton", told(problem, like * slopes)), read)
    for tried, most in ((exactly, 2), (nearly, 4)):
        assert problem.met({**tried[-1], **read(tried[-1])}) and len(tried) <= most


@pytest.mark.parametrize("wrong", [-1.0, 0.2, [[0.0, 1.0], [1.0, 0.0]]], ids=["mirrored", "weak", "swapped"])
def test_newton_measures_the_slopes_where_a_model_is_wrong(wrong: float | list[list[float]]) -> None:
    slopes = np.array([[800.0, 30.0], [-20.0, 700.0]])
    problem = Problem(VARIABLES[:2], OUTPUTS, "reach", {}, dict.fromkeys(OUTPUTS, 5.0))
    believed = slopes @ np.array(wrong) if isinstance(wrong, list) else wrong * slopes

    def read(p: Point) -> dict[str, float]:
        x, y = p["m0.tip"], p["m1.tip"]
        if max(abs(x), abs(y)) > 1.5:
            return {}  # beyond the sensor
        left, up = slopes @ [x - 0.45, y - 0.6]
        return {"cam.x": left, "cam.y": up}

    tried = driven(made("centroid_newton", told(problem, believed)), read)
    assert problem.met({**tried[-1], **read(tried[-1])}) and len(tried) <= 8


@settings(deadline=None)
@given(st.floats(-80, 80), st.floats(0.1, 10), st.floats(1e-6, 1e-2), st.sampled_from(["minimize", "maximize"]))
def test_malus_is_solved_by_few_readings(null: float, size: float, floor: float, aim: str) -> None:
    problem = Problem((Variable("p1.angle", -90.0, 90.0, 0.0, period=180.0),), ("cam.x",), aim)  # type: ignore[arg-type]

    def read(p: Point) -> dict[str, float]:
        value = size * (math.sin(math.radians(p["p1.angle"] - null)) ** 2 + floor)
        return {"cam.x": value, "cam.x_sigma": 1e-4 * value}

    tried = driven(made("malus", problem), read)
    goal = null if aim == "minimize" else null + 90
    assert abs((tried[-1]["p1.angle"] - goal + 90) % 180 - 90) < 0.1 and len(tried) <= (8 if aim == "minimize" else 14)


@given(st.floats(-15, 15), st.floats(50, 80))
def test_a_radius_is_found_on_a_hyperbola(waist: float, small: float) -> None:
    problem = Problem((Variable("l.x", -25.0, 25.0, 0.0),), ("cam.x",), "reach", {"cam.x": 90.0}, {"cam.x": 0.9})

    def read(p: Point) -> dict[str, float]:
        return {"cam.x": small * math.hypot(1, (p["l.x"] - waist) / 12), "cam.x_sigma": 0.1}

    tried = driven(made("waist_parabola", problem), read)
    assert problem.met({**tried[-1], **read(tried[-1])}) and len(tried) <= 6


@pytest.mark.parametrize("lost", [(4,), (4, 5), (5,), (2, 5, 6)])
def test_a_waist_is_found_where_something_was_read_and_not_where_a_reading_was_lost(lost: tuple[int, ...]) -> None:
    problem = Problem((Variable("l.x", -6.0, 6.0, -4.0),), ("cam.x",), "minimize")
    count = 0

    def read(p: Point) -> dict[str, float]:
        nonlocal count
        count += 1
        return {} if count in lost else {"cam.x": 50 * math.hypot(1, (p["l.x"] - 2) / 3), "cam.x_sigma": 0.05}

    algorithm, seen = made("waist_parabola", problem), []
    driven(algorithm, lambda p: seen.append({**p, **read(p)}) or seen[-1])  # type: ignore[func-returns-value]
    assert algorithm.finished == "the waist is found"
    assert min(r.get("cam.x", math.inf) for r in seen) < 50.2


@given(st.floats(-1.9, 2.5), st.floats(-1.9, 2.5))
def test_a_spiral_finds_a_spot_anywhere_near(x: float, y: float) -> None:
    problem = Problem(VARIABLES[:2], ("cam.x",), "maximize")

    def read(p: Point) -> dict[str, float]:
        near = math.hypot(p["m0.tip"] - x, p["m1.tip"] - y) < 0.6
        return {"cam.x": 1.0 if near else 0.0, "cam.x_sigma": 0.01}

    for name in ("spiral", "raster"):
        algorithm = made(name, problem, {"pitch": 0.3})
        tried = driven(algorithm, read)
        assert read(tried[-1])["cam.x"] == 1.0 and algorithm.finished == "there is light", name


def test_what_an_algorithm_cannot_is_said_with_those_that_can() -> None:
    with pytest.raises(PicoError, match="malus takes 1 tunables, not 2") as caught:
        made("malus", Problem(VARIABLES[:2], ("cam.x",), "minimize"))
    assert "nelder_mead" in caught.value.diagnostics[0].hint and "malus" not in caught.value.diagnostics[0].hint
    with pytest.raises(PicoError, match="there is no algorithm `nelder_meat`") as caught:
        made("nelder_meat", problem_for("nelder_mead"))
    assert "nelder_mead" in caught.value.diagnostics[0].hint
    with pytest.raises(PicoError, match="has no parameter `stepp`"):
        made("nelder_mead", problem_for("nelder_mead"), {"stepp": 1.0})


@pytest.mark.parametrize(
    ("tuned", "outputs", "aim", "name"),
    [
        ((Tuned("lens", "stage_y"), Tuned("lens", "stage_z")), ("centroid", "centroid"), "reach", "centroid_newton"),
        ((Tuned("polarizer", "angle", 180.0),), ("",), "minimize", "malus"),
        ((Tuned("waveplate", "angle", 180.0),), ("",), "maximize", "malus"),
        ((Tuned("lens", "stage_x"),), ("d4sigma",), "reach", "waist_parabola"),
        ((Tuned("mirror", "tip"), Tuned("mirror", "tilt")), ("",), "maximize", "peak"),
        ((Tuned("mirror", "tip"), Tuned("mirror", "tilt")), ("",), "minimize", "nelder_mead"),
    ],
)  # fmt: skip
def test_the_default_follows_from_what_is_asked(
    tuned: tuple[Tuned, ...], outputs: tuple[str, ...], aim: str, name: str
) -> None:
    found, why = choose(tuned, outputs, aim)  # type: ignore[arg-type]
    assert found == name and why


def test_a_simplex_over_a_whole_period_does_not_fold_onto_itself() -> None:
    problem = Problem((Variable("p2.angle", 0.0, 360.0, 90.0, period=180.0),), ("cam.x",), "maximize")

    def read(p: Point) -> dict[str, float]:
        return {"cam.x": math.sin(math.radians(p["p2.angle"] - 91)) ** 2 + 1e-6, "cam.x_sigma": 1e-6}

    tried = driven(made("nelder_mead", problem, {"step": 2.0}), read)
    assert max(read(p)["cam.x"] for p in tried) > 0.99


def test_readings_that_do_not_follow_the_law_of_malus_are_not_taken_for_it() -> None:
    """Behind a half-wave plate it is as bright again after 90 deg: in a fit of 180 deg that shows."""
    problem = Problem((Variable("hwp.angle", 0.0, 180.0, 22.0),), ("cam.x",), "maximize")

    def read(p: Point) -> dict[str, float]:
        value = math.cos(2 * math.radians(p["hwp.angle"] - 10)) ** 2 + 1e-4
        return {"cam.x": value, "cam.x_sigma": 1e-4 * value}

    right, wrong = made("malus", problem, {"cycle": 90.0}), made("malus", problem)
    tried = driven(right, read)
    assert read(tried[-1])["cam.x"] > 0.9995 and right.finished == "the place of the extremum is known"
    driven(wrong, read)
    assert wrong.finished == "the readings do not follow the law of Malus well enough"


@settings(deadline=None, max_examples=40)
@given(st.integers(1, 3), st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3), st.floats(2.0, 9.0))
def test_a_best_within_two_standard_deviations_is_seen_on_the_likely_places(
    count: int, away: list[float], depth: float
) -> None:
    told, best = nominal(count, 0.2, 0.3, depth), np.array(away[:count]) * 0.3
    if np.linalg.norm(best) > 0.6:
        best *= 0.6 / np.linalg.norm(best)
    variables = tuple(Variable(f"m{n}.tip", -3.0, 3.0, 0.0) for n in range(count))
    problem = Problem(variables, ("power",), "maximize", nominal=told)

    def read(point: Point) -> dict[str, float]:
        off = np.array([point[v.name] for v in variables]) - best
        return {"power": math.exp(-float(off @ off) / 0.2**2), "power_sigma": math.exp(-depth) / 5}

    algorithm = made("likely", problem)
    tried = driven(algorithm, read)
    assert algorithm.finished == "there is light" and 5 * read(tried[-1])["power_sigma"] < read(tried[-1])["power"]


def test_likely_places_come_in_the_order_of_their_likelihood_and_without_knowledge_there_are_none() -> None:
    spread = ((0.04, 0.0), (0.0, 1.0))
    told = Nominal(((25.0, 0.0), (0.0, 25.0)), spread, 4.0)
    variables = tuple(Variable(f"m{n}.tip", -5.0, 5.0, 0.0) for n in range(2))
    tried = driven(made("likely", Problem(variables, ("power",), "maximize", nominal=told)), lambda p: {"power": 0.0})
    far = [math.hypot(p["m0.tip"] / 0.2, p["m1.tip"]) for p in tried]
    assert far[0] == 0 and far == sorted(far) and len(tried) > 8
    with pytest.raises(PicoError, match="nobody can say where light is likely"):
        made("likely", Problem(variables, ("power",), "maximize"))
    with pytest.raises(PicoError, match="how the tunables move the beam"):
        made("beam_walk", Problem(variables, ("power",), "maximize"))


STEERED = tuple(Variable(f"m{1 + n // 2}.{('tip', 'tilt')[n % 2]}", -3.0, 3.0, 0.0) for n in range(4))
ARMS = np.array([[2.4, 1.2], [4.97, 4.97]])
"""What a mrad of each mirror moves at the fiber: of the offset and of the angle, in widths over which light falls."""


def coupled(best: np.ndarray, noise: float, seed: int) -> Callable[[Point], Mapping[str, float]]:
    """A fiber behind two mirrors whose arms are otherwise than nominal by 2 %, with the noise of a meter."""
    rng = np.random.default_rng(seed)
    true = ARMS * np.array([[1 + 0.02 * rng.normal()], [1.0]])

    def read(point: Point) -> dict[str, float]:
        away = np.array([point[v.name] for v in STEERED]) - best
        power = math.exp(-sum(float(((true @ away[n::2]) ** 2).sum()) for n in (0, 1)))
        sigma = math.hypot(noise, 0.005 * power)
        return {"power": power + sigma * rng.normal(), "power_sigma": sigma}

    return read


def walked(problem: Problem, read: Callable[[Point], Mapping[str, float]]) -> tuple[Algorithm, dict[str, float]]:
    """Return the algorithm once it is done, and the brightest that it read."""
    algorithm, seen = made("beam_walk", problem), []
    driven(algorithm, lambda p: seen.append({**p, **read(p)}) or seen[-1], 60)  # type: ignore[func-returns-value]
    return algorithm, max(seen, key=lambda r: r["power"])


def test_a_beam_walk_that_begins_in_noise_ends_at_the_top_and_not_where_it_first_is_bright() -> None:
    """Two rows of noisy readings tell a middle badly: what is read there is bright, and up to a tenth too low."""
    found = []
    for seed in range(60):
        way = np.random.default_rng([seed, 7]).normal(0, 1, 4)
        best = np.linalg.inv(np.kron(ARMS, np.eye(2))) @ (way / np.linalg.norm(way) * 2.5)
        read = coupled(best, 1e-4, seed)
        _, bright = walked(Problem(STEERED, ("power",), "maximize", nominal=known_arms()), read)
        off = np.kron(ARMS, np.eye(2)) @ (np.array([bright[v.name] for v in STEERED]) - best)
        found.append(math.exp(-float(off @ off)))
    assert sum(power > 0.95 for power in found) >= 57


def known_arms() -> Nominal:
    whole = np.kron(ARMS.T @ ARMS, np.eye(2))
    return Nominal(*(tuple(map(tuple, m.tolist())) for m in (whole, np.eye(4))), 7.0)


def test_a_beam_walk_whose_best_is_out_of_bounds_ends_at_the_best_within() -> None:
    best, start = np.array([3.15, 0.1, -3.3, -0.1]), (2.8, 0.0, -2.9, 0.0)
    problem = Problem(tuple(replace(v, start=s) for v, s in zip(STEERED, start, strict=True)), ("power",), "maximize",
                      nominal=known_arms())  # fmt: skip
    algorithm, bright = walked(problem, coupled(best, 1e-9, 1))
    assert algorithm.finished == "there is no more power to be gained"
    assert bright["m2.tip"] == pytest.approx(-3.0, abs=1e-6) and abs(bright["m1.tip"]) < 3.0
    within = [dict(zip((v.name for v in STEERED), (a, 0.1, b, -0.1), strict=True))
              for a in np.linspace(2.5, 3, 41) for b in np.linspace(-3, -2.5, 41)]  # fmt: skip
    assert bright["power"] > 0.93 * max(coupled(best, 1e-9, 1)(p)["power"] for p in within)

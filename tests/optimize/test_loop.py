"""The safe loop: within bounds and budget, back to the light, and never worse at its end than at its start."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping
from dataclasses import replace

import pytest

from pico.optimize.loop import Ask, Limits, Outcome, Reading, loop
from pico.optimize.problem import Nominal, Point, Problem, Variable
from pico.optimize.registry import made

BOX = tuple(Variable(f"m.{n}", -1.0, 1.0, 0.0) for n in ("tip", "tilt"))
CENTRE = Problem(BOX, ("cam.x", "cam.y"), "reach", {}, {"cam.x": 0.01, "cam.y": 0.01})
PEAK = Problem(BOX, ("pd.power",), "maximize")


def spot(point: Point) -> dict[str, float]:
    return {"cam.x": 2 * (point["m.tip"] - 0.4), "cam.y": point["m.tilt"] + 0.3 * point["m.tip"] + 0.1}


def bump(point: Point) -> dict[str, float]:
    square = (point["m.tip"] - 0.5) ** 2 + (point["m.tilt"] + 0.2) ** 2
    return {"pd.power": math.exp(-square / 0.09), "pd.power_sigma": 1e-3}


def driven(
    problem: Problem, algorithm: str, read: Callable[[Point, int], Reading | Mapping[str, float]],
    limits: Limits | None = None, stopping: Callable[[], bool] = lambda: False, acquire: str = "",
) -> tuple[Outcome, list[Ask]]:  # fmt: skip
    """Run a loop on a world; return how it ended, and all that was asked."""
    steps = loop(
        problem, lambda p: made(algorithm, p), limits or Limits(), stopping=stopping,
        acquire=(lambda p: made(acquire, p, {"pitch": 0.25})) if acquire else None,
    )  # fmt: skip
    asks, clock = [next(steps)], 0.0
    while True:
        ask, clock = asks[-1], clock + 1.0
        assert all(v.low <= ask.point[v.name] <= v.high for v in problem.variables)
        found = read(ask.point, len(asks)) if ask.measure else {}
        reading = found if isinstance(found, Reading) else Reading(found, clock)
        try:
            asks.append(steps.send(reading))
        except StopIteration as stop:
            return stop.value, asks


def test_a_goal_is_reached_and_what_is_measured_last_is_where_it_stands() -> None:
    found, asks = driven(CENTRE, "centroid_newton", lambda p, n: spot(p))
    assert found.met and found.last and CENTRE.met(found.last) and not found.fault
    assert asks[0].point == CENTRE.start and {n: found.last[n] for n in asks[-1].point} == asks[-1].point
    assert len(found.tried) == len(asks) <= 6


def test_the_best_point_is_measured_again_and_restored() -> None:
    found, asks = driven(PEAK, "nelder_mead", lambda p, n: bump(p))
    assert found.met and found.last and found.last["pd.power"] > 0.99
    assert asks[-1].why in ("try", "best")


@pytest.mark.parametrize("most", [1, 2, 3, 5, 9])
def test_a_budget_of_measurements_is_kept_with_that_at_the_end(most: int) -> None:
    found, asks = driven(PEAK, "nelder_mead", lambda p, n: bump(p), Limits(measurements=most))
    assert sum(a.measure for a in asks) <= most and not found.met and "budget" in found.why
    assert found.last and found.last["pd.power"] >= bump(PEAK.start)["pd.power"] - 2e-3


def test_a_budget_of_seconds_is_kept() -> None:
    found, asks = driven(PEAK, "nelder_mead", lambda p, n: bump(p), Limits(seconds=8.0))
    assert "8 s" in found.why and found.seconds <= 10 and len(asks) <= 10


def test_it_goes_back_to_where_light_was_when_it_is_lost() -> None:
    dark = {5, 6}
    found, asks = driven(PEAK, "nelder_mead", lambda p, n: {} if n in dark else bump(p))
    after = asks[5]
    good = max((t for t in found.tried[:4]), key=lambda t: t.result.get("pd.power", 0.0))
    assert after.why == "back" and not after.measure and after.point == {n: good.result[n] for n in after.point}


def test_where_it_stays_dark_it_gives_up_and_goes_back_to_where_it_began() -> None:
    found, asks = driven(PEAK, "nelder_mead", lambda p, n: {}, Limits(measurements=300), acquire="spiral")
    assert not found.met and "dark" in found.why and found.last is None and found.first is None
    assert asks[-1].point == PEAK.start and asks[-1].why == "start"


@pytest.mark.parametrize("lost", [1, 2])
def test_where_there_are_few_places_to_look_at_lost_readings_are_taken_again(lost: int) -> None:
    """Light is where it began, and the beam was lost for a moment; the camera sees all that is likely."""
    told = Nominal(((1.0, 0.0), (0.0, 1.0)), ((0.01, 0.0), (0.0, 0.01)), 1.0)
    problem = replace(CENTRE, nominal=told)
    steps = loop(problem, lambda p: made("centroid_newton", p), acquire=lambda p: made("likely", p))
    ask, number, ended = next(steps), 0, None
    while ended is None:
        number += 1
        try:
            ask = steps.send(Reading({} if number <= lost else spot(ask.point), float(number)))
        except StopIteration as stop:
            ended = stop.value
    assert ended.met is (lost < 2) and number <= 8
    assert ended.met or ended.why == "it is dark at 1 place"


def test_light_is_looked_for_first_where_there_is_none() -> None:
    found, _ = driven(PEAK, "peak", lambda p, n: b if (b := bump(p))["pd.power"] > 0.4 else {}, acquire="spiral")
    assert found.met and found.first is None and found.last and found.last["pd.power"] > 0.99


def test_a_signal_that_is_too_low_is_not_believed() -> None:
    def read(point: Point, number: int) -> dict[str, float]:
        return {**spot(point), "cam.power": 0.0 if point["m.tip"] > 0.45 else 5.0}

    found, _ = driven(CENTRE, "centroid_newton", read, Limits(signal="cam.power", least=1.0))
    assert found.met and all(t.result.get("cam.power", 0) > 1 for t in found.tried if "cam.x" in t.result)


def test_stopped_it_ends_at_its_best() -> None:
    count = 0

    def stopping() -> bool:
        nonlocal count
        count += 1
        return count > 6

    found, asks = driven(PEAK, "nelder_mead", lambda p, n: bump(p), stopping=stopping)
    best = max(t.result.get("pd.power", 0.0) for t in found.tried)
    assert found.why == "it was stopped" and not found.met
    assert bump(asks[-1].point)["pd.power"] >= best - 3e-3


def test_an_axis_that_does_not_answer_ends_it_by_name() -> None:
    def read(point: Point, number: int) -> Reading | dict[str, float]:
        return Reading(fault="m.tip does not answer; it last read 0.2", time=9.0) if number >= 4 else bump(point)

    found, _ = driven(PEAK, "nelder_mead", read)
    assert found.fault == found.why == "m.tip does not answer; it last read 0.2" and not found.met


ALGORITHMS = {"peak": PEAK, "nelder_mead": PEAK, "rcds": PEAK, "centroid_newton": CENTRE}


@pytest.mark.parametrize("name", ALGORITHMS)
@pytest.mark.parametrize("block", range(5))
def test_no_fault_leaves_it_worse_than_it_began(name: str, block: int) -> None:
    """Frames lost, light lost, saturation, an interruption: where axes answer, none ends worse by two sigma."""
    problem = ALGORITHMS[name]
    for seed in range(50 * block, 50 * block + 50):
        rng = random.Random(seed)
        at, kind = rng.randint(2, 12), rng.choice(["frame", "beam", "saturated", "stop", "stuck"])
        stopped = False
        noise = 0.002

        def read(point: Point, number: int) -> Reading | dict[str, float]:
            nonlocal stopped
            true = spot(point) if problem is CENTRE else {"pd.power": bump(point)["pd.power"]}
            stopped = stopped or (kind == "stop" and number >= at)  # noqa: B023
            if kind == "stuck" and number >= at:  # noqa: B023
                return Reading(fault="m.tip is stuck; it last read 0.1", time=float(number))
            if (kind == "frame" and number == at) or (kind == "beam" and at <= number < at + 8):  # noqa: B023
                return {}
            if kind == "saturated" and number % 3 == 0:  # noqa: B023
                return {}
            sigmas = {f"{n}_sigma": noise for n in true}  # noqa: B023
            return {n: v + noise * rng.gauss(0, 1) for n, v in true.items()} | sigmas  # noqa: B023

        found, asks = driven(problem, name, read, Limits(measurements=60), stopping=lambda: stopped)  # noqa: B023
        if kind == "stuck" and len(asks) >= at:
            assert "m.tip is stuck; it last read 0.1" in found.why and not found.met
            continue
        truth = spot if problem is CENTRE else bump
        first, last = problem.cost(truth(problem.start)), problem.cost(truth(asks[-1].point))
        spread = problem.noise({**truth(asks[-1].point), **{f"{n}_sigma": noise for n in problem.outputs}})
        assert last <= first + 6 * spread, (seed, kind, found.why)


def test_a_beam_that_is_lost_is_no_null() -> None:
    """The voltage of a photodiode behind crossed polarizers, whose laser fails for good after the fifth reading."""
    problem = Problem((Variable("p.angle", 0.0, 180.0, 40.0),), ("pd.voltage",), "minimize")

    def read(point: Point, number: int) -> dict[str, float]:
        light = 0.0 if number > 5 else math.cos(math.radians(point["p.angle"])) ** 2
        return {"pd.voltage": light, "pd.voltage_sigma": 1e-4}

    found, asks = driven(problem, "nelder_mead", read)
    assert not found.met and "the light was lost on the way" in found.why
    assert asks[-1].point == problem.start


@pytest.mark.parametrize(("tip", "tilt"), [(0.6, -0.2), (0.5, 0.1)])
@pytest.mark.parametrize("came", range(2, 14))
def test_other_light_is_no_peak(came: int, tip: float, tilt: float) -> None:
    """From a reading on, a lamp or a reflection makes a thousand times the light of it all."""
    problem = replace(PEAK, variables=tuple(replace(v, start=s) for v, s in zip(BOX, (tip, tilt), strict=True)))

    def read(point: Point, number: int) -> dict[str, float]:
        return {n: (1000.0 if number >= came else 1.0) * value for n, value in bump(point).items()}

    _, asks = driven(problem, "nelder_mead", read)
    assert bump(asks[-1].point)["pd.power"] > 0.99 * bump(problem.start)["pd.power"]


def test_too_much_light_is_not_looked_for_on_a_spiral() -> None:
    def read(point: Point, number: int) -> Reading:
        return Reading(unknown="cam.image is saturated", glaring=True, time=float(number))

    found, asks = driven(CENTRE, "centroid_newton", read, acquire="spiral")
    assert "too much light to begin with (cam.image is saturated)" in found.why
    assert all(ask.point == CENTRE.start for ask in asks)


@pytest.mark.parametrize("algorithm", ["nelder_mead", "rcds", "peak"])
def test_a_peak_that_saturates_is_left_where_it_began_and_named(algorithm: str) -> None:
    """Only places with less light than where it began can be measured."""
    one = replace(PEAK, variables=BOX[:1])

    def read(point: Point, number: int) -> Reading | dict[str, float]:
        if abs(point["m.tip"]) < 0.6:
            return Reading(unknown="cam is saturated", glaring=True, time=float(number))
        return {"pd.power": math.exp(-(point["m.tip"] ** 2)), "pd.power_sigma": 1e-3}

    found, asks = driven(one, algorithm, read)
    assert "too much light to begin with (cam is saturated)" in found.why and found.saturated and not found.met
    assert asks[-1].point == one.start and found.last is None


def test_light_that_becomes_too_much_is_not_called_lost() -> None:
    def read(point: Point, number: int) -> Reading | dict[str, float]:
        return Reading(unknown="cam is saturated", glaring=True, time=float(number)) if number > 4 else bump(point)

    found, _ = driven(PEAK, "nelder_mead", read)
    assert "there was too much light to measure 6 times in a row (cam is saturated)" in found.why


def test_an_axis_that_fails_on_the_way_to_the_best_is_told_too() -> None:
    """The third reading is the best, and nobody comes back to it."""

    def read(point: Point, number: int) -> Reading | dict[str, float]:
        if number > 8:
            return Reading(fault="m.tip does not answer; it last read 0.2", time=float(number))
        return bump(point)

    found, asks = driven(PEAK, "nelder_mead", read, Limits(measurements=9))
    assert found.fault == found.why == "m.tip does not answer; it last read 0.2" and not found.met
    assert asks[-1].point == PEAK.start and not asks[-1].measure


def test_one_reading_that_is_lost_at_the_end_does_not_send_it_back() -> None:
    """Of the first place near the top too much is read, so that it counts as the best though others come later."""
    steps = loop(PEAK, lambda p: made("nelder_mead", p), Limits(measurements=200))
    ask, number, asks, ended = next(steps), 0, list[str](), None
    high = {"pd.power": 2.0, "pd.power_sigma": 1e-3}
    while ended is None:
        number, asks, there = number + 1, [*asks, ask.why], bump(ask.point)
        if there["pd.power"] > 0.9 and high:
            there, high = high, {}
        lost = ask.why == "best" and asks.count("best") == 1
        try:
            ask = steps.send(Reading({} if lost else there, float(number)))
        except StopIteration as stop:
            ended = stop.value
    assert asks[-2:] == ["best", "best"] and ended.met
    assert ended.last["pd.power"] > bump(PEAK.start)["pd.power"]


def test_a_best_that_is_gone_when_it_is_measured_again_is_not_met() -> None:
    steps = loop(PEAK, lambda p: made("nelder_mead", p))
    ask, number, ended = next(steps), 0, None
    while ended is None:
        number += 1
        # the best is read too high, and never is there again
        high = {"pd.power": 2.0, "pd.power_sigma": 1e-3} if number == 5 else bump(ask.point)
        try:
            ask = steps.send(Reading({} if ask.why == "best" else high, float(number)))
        except StopIteration as stop:
            ended = stop.value
    assert [t.why for t in ended.tried].count("best") == 2
    assert not ended.met and ended.why.endswith("but there was no light any more at the best")


@pytest.mark.parametrize("last", [15, 99])
def test_what_began_while_the_beam_was_lost_does_not_end_worse_than_there(last: int) -> None:
    """Light is found elsewhere, dim, and is lost again: where it began it was bright all the time."""
    problem = replace(PEAK, variables=tuple(replace(v, start=s) for v, s in zip(BOX, (0.4, -0.2), strict=True)))

    count = 0

    def read(point: Point, number: int) -> dict[str, float]:
        nonlocal count
        count += 1
        return {} if count < 9 or 9 < count <= last else bump(point)

    found, asks = driven(problem, "peak", read, Limits(measurements=60), acquire="spiral")
    assert asks[-1].point == problem.start and not found.met
    assert last == 99 or (found.last and found.last["pd.power"] > 0.8)


HIGH_ONES = ["peak", "nelder_mead", "rcds", "cobyqa", "cma_es"]


@pytest.mark.parametrize("algorithm", HIGH_ONES)
@pytest.mark.parametrize("sigma", [0.0, 1e-3, 0.02])
def test_what_changes_by_no_more_than_its_noise_is_no_maximum(algorithm: str, sigma: float) -> None:
    rng = random.Random(5)

    def read(point: Point, number: int) -> dict[str, float]:
        return {"pd.power": 1 + sigma * rng.gauss(0, 1), "pd.power_sigma": sigma}

    found, asks = driven(PEAK, algorithm, read, Limits(measurements=400))
    assert not found.met and found.why == "nothing that was tried changed it by more than its noise"
    assert asks[-1].point == PEAK.start  # the best of noise is none: it is left where it began


@pytest.mark.parametrize("algorithm", ["malus", *HIGH_ONES])
def test_an_error_of_scale_that_all_readings_have_in_common_is_no_noise(algorithm: str) -> None:
    """Each search does the same, and is met as well, with a meter of unknown scale as with one that is calibrated."""
    count = 1 if algorithm == "malus" else 2
    problem = Problem((Variable("m.tip", -90, 90, 20, period=180), Variable("m.tilt", -30, 30, 4))[:count],
                      ("pd.power",), "maximize")  # fmt: skip
    rng = random.Random(3)
    flicker = [1 + 1e-4 * rng.gauss(0, 1) for _ in range(400)]

    def read(scale: float) -> Callable[[Point, int], dict[str, float]]:
        def at(point: Point, number: int) -> dict[str, float]:
            power = math.cos(math.radians(point["m.tip"] + 7)) ** 2 * math.exp(-((point.get("m.tilt", 0) / 20) ** 2))
            power *= flicker[number % 400]
            return {"pd.power": power, "pd.power_sigma": math.hypot(scale, 1e-4) * power,
                    "pd.power_noise_sigma": 1e-4 * power}  # fmt: skip

        return at

    known, unknown = (driven(problem, algorithm, read(scale), Limits(measurements=400)) for scale in (0.0, 0.3))
    assert known[0].met and unknown[0].met, unknown[0].why
    assert unknown[1] == known[1]


@pytest.mark.parametrize("aim", ["maximize", "minimize"])
def test_where_a_tunable_can_go_no_further_there_may_be_more(aim: str) -> None:
    sign = 1 if aim == "maximize" else -1
    problem = Problem(BOX, ("pd.power",), aim)  # type: ignore[arg-type]

    def read(point: Point, number: int) -> dict[str, float]:
        return {"pd.power": math.exp(sign * (point["m.tip"] - (point["m.tilt"] - 0.3) ** 2)), "pd.power_sigma": 1e-4}

    found, _ = driven(problem, "peak" if sign > 0 else "nelder_mead", read, Limits(measurements=200))
    more = "more" if sign > 0 else "less"
    assert found.last and found.last["m.tip"] == pytest.approx(1.0, abs=2e-3)
    assert not found.met and found.why == f"m.tip is at its bound of 1: beyond it there may be {more}"


def test_an_angle_that_comes_round_has_no_end() -> None:
    problem = Problem((Variable("p.angle", 0.0, 180.0, 40.0, period=180.0),), ("pd.power",), "maximize")

    def read(point: Point, number: int) -> dict[str, float]:
        return {"pd.power": 0.01 + math.cos(math.radians(point["p.angle"])) ** 2, "pd.power_sigma": 1e-5}

    found, _ = driven(problem, "malus", read)
    assert found.met and found.last and found.last["pd.power"] > 1.009


@pytest.mark.parametrize("start", [0.5, 0.5 + 1e-3, 0.2])
def test_a_peak_whose_first_steps_drown_in_noise_is_sought_with_longer_ones(start: float) -> None:
    rng = random.Random(3)
    tip = Variable("m.tip", -1.0, 1.0, start, reach=0.02)
    problem = Problem((tip, Variable("m.tilt", -1.0, 1.0, -0.2)), ("pd.power",), "maximize")

    def read(point: Point, number: int) -> dict[str, float]:
        return {"pd.power": bump(point)["pd.power"] + 1e-3 * rng.gauss(0, 1), "pd.power_sigma": 1e-3}

    found, asks = driven(problem, "peak", read)
    assert found.met and bump(asks[-1].point)["pd.power"] > 0.99


def test_a_tunable_that_does_nothing_is_told() -> None:
    def read(point: Point, number: int) -> dict[str, float]:
        return bump({**point, "m.tilt": -0.2})

    found, _ = driven(PEAK, "peak", read)
    assert found.met and found.why.endswith("; by m.tilt it changes by no more than its noise")


FOCUS = Problem((Variable("lens.x", -6.0, 6.0, -3.1),), ("cam.width",), "minimize")


@pytest.mark.parametrize("algorithm", ["nelder_mead", "waist_parabola"])
def test_where_readings_are_missed_it_never_ends_worse_than_it_began(algorithm: str) -> None:
    """A third of all readings is missed, often the first: nothing is moved before the start is known."""
    for seed in range(60):
        rng = random.Random(seed)

        def read(point: Point, number: int) -> Reading:
            if rng.random() < 0.34:  # noqa: B023
                return Reading({}, float(number), "what was measured got lost on the way", missed=True)
            width = math.hypot(300.0, 20 * (point["lens.x"] + 1.5))
            return Reading({"cam.width": width + 0.2 * rng.gauss(0, 1), "cam.width_sigma": 0.2}, float(number))  # noqa: B023

        found, asks = driven(FOCUS, algorithm, read, Limits(measurements=20), acquire="spiral")
        ended, began = (math.hypot(300.0, 20 * (x + 1.5)) for x in (asks[-1].point["lens.x"], -3.1))
        assert ended <= began + 0.8, (seed, found.why)
        assert sum(a.measure for a in asks) <= 20
        assert found.first or all(a.point == FOCUS.start for a in asks)


def test_where_no_reading_comes_at_all_nothing_is_moved() -> None:
    missed = Reading(unknown="what was measured got lost on the way", missed=True)
    found, asks = driven(FOCUS, "nelder_mead", lambda p, n: missed, acquire="spiral")
    assert found.why == "nothing was measured where it began (what was measured got lost on the way)"
    assert not found.met and len(found.tried) == 6 and all(a.point == FOCUS.start for a in asks)


def test_where_it_ends_early_what_is_no_better_than_the_start_is_left_at_the_start() -> None:
    """The second place reads best by its noise. Measured again it is less than the start, within two sigma: in truth it
    may be worse by more."""

    def read(point: Point, number: int) -> dict[str, float]:
        power = {1: 1.0, 2: 1.1}.get(number, 0.5)
        if number > 2 and point["m.tip"] != 0.0 and point["m.tilt"] == 0.0:
            power = 0.9
        return {"pd.power": power, "pd.power_sigma": 0.07}

    count = iter(range(99))
    found, asks = driven(PEAK, "nelder_mead", read, stopping=lambda: next(count) > 3)
    assert [a.why for a in asks][-2:] == ["best", "start"] and asks[-1].point == PEAK.start and not found.met
    assert found.why == "it was stopped, but nothing better was found than where it began"

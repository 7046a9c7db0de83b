"""How many measurements alignment takes: PICO's own algorithms beside Nelder-Mead and CMA-ES.

The first four problems are those of the literature's table (centre a spot by a lens, two mirrors into a fibre, a
crossed polarizer, a focus), the last two begin in the dark or go through two irises, from placement errors as the
catalog has them. Every loop ends by its own stopping rule, within its budget, and counts every measurement, that which
confirms the best point too. `success`: the true state is within tolerance at the end; `simulated s`: axes at 1.2 mm/s
(10 deg/s), settling 0.2 s, 0.5 s a measurement. None of it reads the truth, a seed or the noise but the judge.

    python benchmarks/alignment.py [--seeds 40]
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from pico.optimize.loop import Limits, Reading, loop
from pico.optimize.problem import Nominal, Point, Problem, Variable
from pico.optimize.registry import made

LOST = 0.02
"""Of the readings that are lost, whatever the light."""
SPEED, SETTLE, TAKE = {"mm": 1.2, "mrad": 8.0, "deg": 10.0}, 0.2, 0.5


@dataclass
class Bench:
    """A simulated problem: `read` gives the outputs without noise and their noise at a true point, `good` judges it."""

    name: str
    problem: Problem
    unit: str
    read: Callable[[np.ndarray], Mapping[str, tuple[float, float]]]
    good: Callable[[np.ndarray], bool]
    algorithm: str
    parameters: Mapping[str, float] = field(default_factory=dict)
    acquire: str = ""
    limits: Limits = field(default_factory=lambda: Limits(measurements=400, seconds=1e9))
    jitter: float = 0.0
    backlash: float = 0.0


def centre(rng: np.random.Generator) -> Bench:
    """A lens of 100 mm, 150 mm before a camera, up to 1.2 mm off; its stages turned by 5 degrees, its gain unknown to
    5 %. 0.25 um noise of the centroid, 2 um of the stages; to within 5 um."""
    gain, turn = 1.5 * (1 + rng.normal(0, 0.05)), math.radians(rng.uniform(-5, 5))
    off = rng.uniform(-1.2, 1.2, 2)
    matrix = gain * np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])

    def spot(at: np.ndarray) -> np.ndarray:
        return np.asarray(1000 * matrix @ (at - off))

    def read(at: np.ndarray) -> Mapping[str, tuple[float, float]]:
        if np.abs(at - off).max() > 2.5:
            return {}
        x, y = spot(at)
        return {"x": (x, 0.25), "y": (y, 0.25)}

    variables = tuple(Variable(n, -2.0, 2.0, 0.0, reach=1.2) for n in ("stage_y", "stage_z"))
    problem = Problem(variables, ("x", "y"), "reach", {}, {"x": 5.0, "y": 5.0})
    return Bench("centre", problem, "mm", read, lambda at: float(np.linalg.norm(spot(at))) < 7.1, "centroid_newton",
                 jitter=0.002, backlash=0.002)  # fmt: skip


def beam_walk(rng: np.random.Generator) -> Bench:
    """Two mirrors, 300 mm apart and from a fibre, arms to 2 %; w = 0.5 mm; 0.5 % noise; begun at 2 to 40 %, to 95 %."""
    arms = 300 * (1 + rng.normal(0, 0.02, 2))
    waist, spread = 0.5, 632.8e-6 / (math.pi * 0.5)
    best = rng.normal(0, 1.0, 4)
    move = np.array([2 * (arms[0] + arms[1]), 2 * arms[1]]) * 1e-3
    turn = np.array([2.0, 2.0]) * 1e-3

    def power(at: np.ndarray) -> float:
        away = at - best
        x, a = np.array([move @ away[n::2] for n in (0, 1)]), np.array([turn @ away[n::2] for n in (0, 1)])
        return math.exp(-float(x @ x) / waist**2 - float(a @ a) / spread**2)

    while True:
        best = rng.normal(0, 0.35, 4)
        if 0.02 <= power(np.zeros(4)) <= 0.4:
            break
    variables = tuple(Variable(n, -5.0, 5.0, 0.0, reach=0.5) for n in ("tip_1", "tilt_1", "tip_2", "tilt_2"))
    nominal = {"near_1": 1.2, "near_2": 0.6, "far_1": 0.002, "far_2": 0.002, "near_width": 0.5, "far_width": spread}
    problem = Problem(variables, ("power",), "maximize")
    return Bench("beam walk", problem, "mrad",
                 lambda at: {"power": (power(at), 0.005 * power(at))} if power(at) > 1e-4 else {},
                 lambda at: power(at) > 0.95, "beam_walk", nominal, jitter=0.001)  # fmt: skip


def malus(rng: np.random.Generator) -> Bench:
    """A polarizer, crossed somewhere within 35 degrees, an extinction of 1e-4, 0.5 % noise; to within 0.1 degrees."""
    null = rng.uniform(-35, 35)

    def power(at: np.ndarray) -> float:
        return math.sin(math.radians(float(at[0]) - null)) ** 2 + 1e-4

    problem = Problem((Variable("angle", -90.0, 90.0, 0.0, reach=35.0, period=180.0),), ("power",), "minimize")
    return Bench("Malus", problem, "deg", lambda at: {"power": (power(at), 0.005 * power(at))},
                 lambda at: abs((float(at[0]) - null + 90) % 180 - 90) < 0.1, "malus")  # fmt: skip


def waist(rng: np.random.Generator) -> Bench:
    """A lens within 25 mm along a focus of 50 um: where the beam has 90 um, to 1 %; 0.3 % noise."""
    focus, middle = 0.05 * (1 + rng.normal(0, 0.05)), rng.uniform(-10, 10)
    length = math.pi * focus**2 / 632.8e-6

    def radius(at: np.ndarray) -> float:
        return focus * 1e3 * math.hypot(1, (float(at[0]) - middle) / length)

    problem = Problem((Variable("z", -25.0, 25.0, 0.0, reach=20.0),), ("w",), "reach", {"w": 90.0}, {"w": 0.9})
    return Bench("waist", problem, "mm", lambda at: {"w": (radius(at), 0.003 * radius(at))},
                 lambda at: abs(radius(at) - 90) <= 1.0, "waist_parabola", jitter=0.005)  # fmt: skip


def dark(rng: np.random.Generator) -> Bench:
    """Two mirrors 300 mm apart and from a fibre, all three put down with the errors of their seats (0.05 deg of yaw,
    0.02 of pitch, 0.1 mm; one standard deviation), arms to 2 %; w = 0.5 mm; noise 0.5 %, and 1e-4 of all the light. To
    95 %. What is known is nominal: arms, widths, and how well parts are put down."""
    spread, nominal = 632.8e-6 / (math.pi * 0.5), np.array([[1.2, 0.6], [2e-3, 2e-3]])
    arms = 300 * (1 + rng.normal(0, 0.02, 2))
    true = np.array([[2 * (arms[0] + arms[1]) * 1e-3, 2 * arms[1] * 1e-3], [2e-3, 2e-3]])
    widths = np.array([0.5, spread])
    seats = [math.radians(angle) for angle in (0.05, 0.02)]  # of yaw, which tip makes up for, and of pitch
    off = [true @ (rng.normal(0, one, 2) * 1e3) + rng.normal(0, [0.1, one]) for one in seats]

    def power(at: np.ndarray) -> float:
        return math.exp(-sum(float((((true @ at[n::2] + off[n]) / widths) ** 2).sum()) for n in (0, 1)))

    shape, where = np.zeros((4, 4)), np.zeros((4, 4))
    back = np.linalg.inv(nominal)
    for n, one in enumerate(seats):
        at = np.ix_([n, n + 2], [n, n + 2])
        shape[at] = nominal.T @ np.diag(1 / widths**2) @ nominal
        where[at] = np.eye(2) * (one * 1e3) ** 2 + back @ np.diag([0.1**2, one**2]) @ back.T
    told = Nominal(tuple(map(tuple, shape.tolist())), tuple(map(tuple, where.tolist())), math.log(1 / 5e-4))
    names = ("tip_1", "tilt_1", "tip_2", "tilt_2")
    variables = tuple(Variable(v, -15.0, 15.0, 0.0, reach=told.reach(n)) for n, v in enumerate(names))
    return Bench("dark start", Problem(variables, ("power",), "maximize", nominal=told), "mrad",
                 lambda at: {"power": (power(at), math.hypot(1e-4, 0.005 * power(at)))},
                 lambda at: power(at) > 0.95, "beam_walk", acquire="likely", limits=Limits(150, 1e9),
                 jitter=0.001)  # fmt: skip


def irises(rng: np.random.Generator) -> Bench:
    """Two mirrors put down by hand and eye before two irises with cameras' centroids, 300 and 900 mm behind the second
    mirror; arms to 3 %, light clipped beyond 3 mm; to 50 um at both."""
    arms = np.array([300.0, 300.0, 900.0]) * (1 + rng.normal(0, 0.03, 3))
    off = np.array([math.radians(rng.normal(0, 0.05)) * 1e3 for _ in range(4)])
    near = np.array([2 * (arms[0] + arms[1]), 2 * arms[1]]) * 1e-3
    far = np.array([2 * (arms[0] + arms[2]), 2 * arms[2]]) * 1e-3

    def spots(at: np.ndarray) -> np.ndarray:
        away = at + off
        return np.array([near @ away[0::2], near @ away[1::2], far @ away[0::2], far @ away[1::2]]) * 1e3

    def read(at: np.ndarray) -> Mapping[str, tuple[float, float]]:
        found = spots(at)
        if np.abs(found).max() > 8000:
            return {}
        return {n: (float(v), 2.0) for n, v in zip(("x1", "y1", "x2", "y2"), found, strict=True)}

    variables = tuple(Variable(n, -10.0, 10.0, 0.0, reach=2.0) for n in ("tip_1", "tilt_1", "tip_2", "tilt_2"))
    names = ("x1", "y1", "x2", "y2")
    problem = Problem(variables, names, "reach", {}, dict.fromkeys(names, 50.0))
    return Bench("two irises", problem, "mrad", read, lambda at: float(np.abs(spots(at)).max()) < 60,
                 "centroid_newton", jitter=0.002, backlash=0.003)  # fmt: skip


PROBLEMS = (centre, beam_walk, malus, waist, dark, irises)
BARS = {"centre": (6, 9), "beam walk": (9, 16), "Malus": (5, 7), "waist": (5, 7), "dark start": (150, 150),
        "two irises": (60, 60)}  # fmt: skip


def run(bench: Bench, algorithm: str, parameters: Mapping[str, float], seed: int) -> tuple[int, bool, float]:
    """Return how many measurements a loop took, whether the true state is good at its end, and simulated seconds."""
    rng = np.random.default_rng([seed, 77])
    names = [v.name for v in bench.problem.variables]
    true = np.array([v.start for v in bench.problem.variables])
    clock, commanded = 0.0, bench.problem.start
    acquire = None
    if bench.acquire:
        acquire = lambda p: made(bench.acquire, p)  # noqa: E731
    steps = loop(bench.problem, lambda p: made(algorithm, p, parameters, seed), bench.limits, acquire=acquire)
    ask = next(steps)
    count = 0
    while True:
        point: Point = ask.point
        away = max(abs(point[n] - commanded[n]) for n in names)
        if away:
            clock += away / SPEED[bench.unit] + SETTLE
            rest = rng.normal(0, 1, len(names)) * (bench.jitter + bench.backlash / 4)
            true = np.array([point[n] for n in names]) + rest
        commanded, values = point, {}
        if ask.measure:
            clock, count = clock + TAKE, count + 1
            if rng.random() > LOST:
                for name, (value, sigma) in bench.read(true).items():
                    values |= {name: value + sigma * rng.normal(), f"{name}_sigma": sigma}
        try:
            ask = steps.send(Reading(values, clock))
        except StopIteration:
            return count, bench.good(true), clock


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--only", default="")
    args = parser.parse_args()
    print(f"{args.seeds} seeds each: median / 90th percentile of measurements, success, median simulated seconds\n")
    print("| problem | bar | PICO's own | nelder_mead | cma_es |\n|---|---|---|---|---|")
    for make in PROBLEMS:
        if args.only and args.only not in make.__name__:
            continue
        bar = BARS[make(np.random.default_rng(0)).name]
        cells = [f"{bar[0]} / {bar[1]}"]
        for which in ("", "nelder_mead", "cma_es"):
            found = []
            for seed in range(args.seeds):
                bench = make(np.random.default_rng([seed, 1]))
                algorithm = which or bench.algorithm
                few = len(bench.problem.variables) < 2 and which == "cma_es"
                if few:
                    break
                found.append(run(bench, algorithm, {} if which else bench.parameters, seed))
            if not found:
                cells.append("-")
                continue
            counts = sorted(f[0] for f in found)
            p90 = counts[min(len(counts) - 1, math.ceil(0.9 * len(counts)) - 1)]
            good, spent = sum(f[1] for f in found) / len(found), float(np.median([f[2] for f in found]))
            cells.append(f"{np.median(counts):g} / {p90}, {100 * good:.0f} %, {spent:.0f} s")
        print(f"| {bench.name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()

"""How many measurements alignment takes: PICO's own algorithms beside Nelder-Mead and CMA-ES.

The first four problems are those of the literature's table (center a spot by a lens, two mirrors into a fiber, a
crossed polarizer, a focus), the last two begin in the dark and go through two irises. All begin where parts come to
stand that the arm puts down, drawn in all six ways from what the catalog says of their seats, never by how much light
there is; the laser walks and drifts as the twin's does. The beam walk begins as `pico optimize` does, after mirrors
made up for what cameras saw of parts (x, y, yaw); the dark start is the same bench without cameras.

Every loop ends by its own stopping rule, within its budget, looks for light first where it is dark, as the edge has it,
and counts every measurement, those in the dark and that which confirms the best point, too. `dark`: how many begin
without light; `success`: the true state is within tolerance at the end; `simulated s`: axes at 1.2 mm/s (10 deg/s),
settling 0.2 s, 0.5 s a measurement. None of it reads the truth, a seed or the noise but the judge.

    python benchmarks/alignment.py [--seeds 40]
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from alignment_starts import Array, World, folded, put_down, rolled, sigmas

from pico.edge.aligning import acquiring
from pico.optics.environment import Disturbed
from pico.optimize.loop import Limits, Reading, believed, loop
from pico.optimize.problem import Nominal, Point, Problem, Variable
from pico.optimize.registry import made

MIRROR = "mirror_tip_tilt"
LOST = 0.02
"""Of the readings that are lost, whatever the light."""
SPEED, SETTLE, TAKE = {"mm": 1.2, "mrad": 8.0, "deg": 10.0}, 0.2, 0.5


@dataclass
class Bench:
    """A simulated problem: `read` gives the outputs without noise and their noise at a true point, in a world, nothing
    in the dark; `good` judges it."""

    name: str
    problem: Problem
    unit: str
    read: Callable[[Array, Disturbed], Mapping[str, tuple[float, float]]]
    good: Callable[[Array, Disturbed], bool]
    algorithm: str
    limits: Limits = field(default_factory=lambda: Limits(measurements=400, seconds=1e9))
    jitter: float = 0.0
    backlash: float = 0.0


def _turned(world: Disturbed) -> Array:
    """Return how the laser's beam is turned, to the left and up [mrad]."""
    return np.array([world.left, world.up])


def _told(shape: Array, spread: Array, depth: float) -> Nominal:
    return Nominal(tuple(map(tuple, shape.tolist())), tuple(map(tuple, spread.tolist())), depth)


def center(rng: np.random.Generator) -> Bench:
    """A lens of 100 mm, 150 mm before a camera, behind two mirrors 900 and 300 mm before it and a laser 500 mm before
    those; its stages turned by 5 degrees, its gain unknown to 5 %. 0.25 um noise of the centroid, 2 um of the stages,
    clipped 2.5 mm off; to within 5 um."""
    gain, turn = 1.5 * (1 + rng.normal(0, 0.05)), math.radians(rng.uniform(-5, 5))
    matrix = gain * np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    moved, bent = folded([put_down(rng, MIRROR) for _ in range(2)], (900, 300))
    lens, sensor = put_down(rng, "plano_convex_150_stage"), put_down(rng, "beam_camera")

    def spot(at: Array, world: Disturbed) -> Array:
        x, angle = moved + 1.4 * _turned(world), bent + _turned(world)
        return np.asarray(1000 * (matrix @ (at + lens.off) + (1 - gain) * x + 0.15 * angle - sensor.off))

    def read(at: Array, world: Disturbed) -> Mapping[str, tuple[float, float]]:
        x, y = spot(at, world)
        off = np.linalg.solve(matrix, [x, y]) / 1000
        return {"x": (x, 0.25), "y": (y, 0.25)} if np.abs(off).max() <= 2.5 else {}

    one, own, seen = sigmas(MIRROR), sigmas("plano_convex_150_stage"), sigmas("beam_camera")
    by = [2 * one.turned * abs(0.15 - 0.5 * arm) for arm in (0.9, 0.3)]
    square = own.off**2 + (by[0] ** 2 + by[1] ** 2 + seen.off**2 + [2 * 2 * (0.5 * one.along) ** 2, 0.0]) / 1.5**2
    told = _told(np.eye(2) / 2.5**2, np.diag(square), 1.0)
    variables = tuple(Variable(n, -2.0, 2.0, 0.0, reach=told.reach(k)) for k, n in enumerate(("stage_y", "stage_z")))
    problem = Problem(variables, ("x", "y"), "reach", {}, {"x": 5.0, "y": 5.0}, told)
    return Bench("center", problem, "mm", read, lambda at, world: float(np.linalg.norm(spot(at, world))) < 7.1,
                 "centroid_newton", jitter=0.002, backlash=0.002)  # fmt: skip


def fiber(rng: np.random.Generator, name: str, most: int, *, seen: bool) -> Bench:
    """Two mirrors 300 mm apart and from a fiber, a laser 500 mm before them, arms to 2 %; w = 0.5 mm; noise 0.5 %, and
    1e-4 of all the light. To 95 %. What is known is nominal: arms, widths, and how well the catalog says that parts are
    put down."""
    spread, nominal = 632.8e-6 / (math.pi * 0.5), np.array([[1.2, 0.6], [2e-3, 2e-3]])
    arms = 300 * (1 + rng.normal(0, 0.02, 2))
    true = np.array([[2 * (arms[0] + arms[1]) * 1e-3, 2 * arms[1] * 1e-3], [2e-3, 2e-3]])
    widths = np.array([0.5, spread])
    mirrors = [put_down(rng, MIRROR, seen=seen) for _ in range(2)]
    moved, bent = folded(mirrors, (arms[0] + arms[1], arms[1]))
    coupler = put_down(rng, "fiber_coupler", seen=seen)

    def power(at: Array, world: Disturbed) -> float:
        off = np.stack([moved + 1.1 * _turned(world) - coupler.off, (bent + _turned(world) - coupler.turned) * 1e-3])
        lost = sum(float((((true @ at[n::2] + off[:, n]) / widths) ** 2).sum()) for n in (0, 1))
        return (1 + world.power) * math.exp(-lost)

    shape, where, back = np.zeros((4, 4)), np.zeros((4, 4)), np.linalg.inv(nominal)
    one, own = sigmas(MIRROR), sigmas("fiber_coupler")
    for n in (0, 1):
        at = np.ix_([n, n + 2], [n, n + 2])
        shape[at] = nominal.T @ np.diag(1 / widths**2) @ nominal
        rest = [float(own.off[n]) ** 2 + (4 * one.along**2 if n == 0 else 0.0), (float(own.turned[n]) * 1e-3) ** 2]
        where[at] = np.eye(2) * float(one.turned[n]) ** 2 + back @ np.diag(rest) @ back.T
    told = _told(shape, where, math.log(1 / 5e-4))
    names = ("tip_1", "tilt_1", "tip_2", "tilt_2")
    variables = tuple(Variable(v, -15.0, 15.0, 0.0, reach=told.reach(n)) for n, v in enumerate(names))

    def read(at: Array, world: Disturbed) -> Mapping[str, tuple[float, float]]:
        return {"power": (power(at, world), math.hypot(1e-4, 0.005 * power(at, world)))}

    return Bench(name, Problem(variables, ("power",), "maximize", nominal=told), "mrad", read,
                 lambda at, world: power(at, world) > 0.95 * (1 + world.power), "beam_walk",
                 limits=Limits(most, 1e9), jitter=0.001)  # fmt: skip


def beam_walk(rng: np.random.Generator) -> Bench:
    """Two mirrors before a fiber, which made up for what cameras saw of how parts stand."""
    return fiber(rng, "beam walk", 400, seen=True)


def dark(rng: np.random.Generator) -> Bench:
    """The same, from as parts were put down."""
    return fiber(rng, "dark start", 150, seen=False)


def malus(rng: np.random.Generator) -> Bench:
    """A polarizer that is crossed with another one, both put down anew, in a mount whose zero is off by up to 3
    degrees: it begins near its null. An extinction of 1e-4, 0.5 % noise, and 1e-5 of all the light; to within 0.1
    degrees."""
    null = rng.uniform(-3, 3) + rolled(rng, "linear_polarizer") - rolled(rng, "linear_polarizer")

    def read(at: Array, world: Disturbed) -> Mapping[str, tuple[float, float]]:
        power = (1 + world.power) * (math.sin(math.radians(float(at[0]) - null)) ** 2 + 1e-4)
        return {"power": (power, math.hypot(1e-5, 0.005 * power))}

    problem = Problem((Variable("angle", -90.0, 90.0, 0.0, period=180.0),), ("power",), "minimize")
    return Bench("Malus", problem, "deg", read,
                 lambda at, world: abs((float(at[0]) - null + 90) % 180 - 90) < 0.1, "malus")  # fmt: skip


def waist(rng: np.random.Generator) -> Bench:
    """A lens by whose stage a focus of 50 um, known to 5 %, stands within 10 mm of where it is thought to be, and what
    lens and camera are put down by; to where the beam has 90 um, to 1 %; 0.3 % noise."""
    focus, middle = 0.05 * (1 + rng.normal(0, 0.05)), rng.uniform(-10, 10)
    middle += put_down(rng, "plano_convex_100").along - put_down(rng, "beam_camera").along
    length = math.pi * focus**2 / 632.8e-6

    def radius(at: Array) -> float:
        return focus * 1e3 * math.hypot(1, (float(at[0]) - middle) / length)

    problem = Problem((Variable("z", -25.0, 25.0, 0.0, reach=20.0),), ("w",), "reach", {"w": 90.0}, {"w": 0.9})
    return Bench("waist", problem, "mm", lambda at, world: {"w": (radius(at), 0.003 * radius(at))},
                 lambda at, world: abs(radius(at) - 90) <= 1.0, "waist_parabola", jitter=0.005)  # fmt: skip


def irises(rng: np.random.Generator) -> Bench:
    """Two mirrors 300 mm apart before two irises with cameras' centroids, 300 and 900 mm behind the second mirror, a
    laser 500 mm before; arms to 3 %, no light beyond 3 mm; to 50 um at both."""
    arms = np.array([300.0, 300.0, 900.0]) * (1 + rng.normal(0, 0.03, 3))
    mirrors, stops = [put_down(rng, MIRROR) for _ in range(2)], [put_down(rng, "iris") for _ in range(2)]
    ways = [np.array([arms[0] + arms[k], arms[k]]) for k in (1, 2)]
    off = [folded(mirrors, way.tolist())[0] - stop.off for way, stop in zip(ways, stops, strict=True)]

    def spots(at: Array, world: Disturbed) -> Array:
        found = []
        for way, there in zip(ways, off, strict=True):
            by = (0.5 + 1e-3 * float(way[0])) * _turned(world)
            found += [2 * way @ at[n::2] * 1e-3 + there[n] + by[n] for n in (0, 1)]
        return np.array(found) * 1e3

    def read(at: Array, world: Disturbed) -> Mapping[str, tuple[float, float]]:
        found = spots(at, world)
        if np.abs(found).max() > 3000:
            return {}
        return {n: (float(v), 2.0) for n, v in zip(names, found, strict=True)}

    names, told = ("x1", "y1", "x2", "y2"), _told_of_irises()
    axes = ("tip_1", "tilt_1", "tip_2", "tilt_2")
    variables = tuple(Variable(n, -10.0, 10.0, 0.0, reach=told.reach(k)) for k, n in enumerate(axes))
    problem = Problem(variables, names, "reach", {}, dict.fromkeys(names, 50.0), told)
    return Bench("two irises", problem, "mrad", read, lambda at, world: float(np.abs(spots(at, world)).max()) < 60,
                 "centroid_newton", jitter=0.002, backlash=0.003)  # fmt: skip


def _told_of_irises() -> Nominal:
    """Return what is nominally known of the two irises: light is seen within 3 mm of both."""
    moves, one, own = np.array([[1.2, 0.6], [2.4, 1.8]]), sigmas(MIRROR), sigmas("iris")
    shape, where, back = np.zeros((4, 4)), np.zeros((4, 4)), np.linalg.inv(moves)
    for n in (0, 1):
        at = np.ix_([n, n + 2], [n, n + 2])
        shape[at] = moves.T @ moves / 3.0**2
        rest = float(own.off[n]) ** 2 + (4 * one.along**2 if n == 0 else 0.0)
        where[at] = np.eye(2) * float(one.turned[n]) ** 2 + back @ (np.eye(2) * rest) @ back.T
    return _told(shape, where, 1.0)


PROBLEMS = (center, beam_walk, malus, waist, dark, irises)
BARS = {"center": (6, 9), "beam walk": (9, 16), "Malus": (5, 7), "waist": (5, 7), "dark start": (150, 150),
        "two irises": (60, 60)}  # fmt: skip


def run(bench: Bench, algorithm: str, seed: int) -> tuple[int, bool, float, bool]:
    """Return how many measurements a loop took, whether the true state is good at its end, simulated seconds, and
    whether it began in the dark."""
    rng, world = np.random.default_rng([seed, 77]), World(seed)
    names = [v.name for v in bench.problem.variables]
    true = np.array([v.start for v in bench.problem.variables])
    clock, commanded, count = 0.0, bench.problem.start, 0
    steps = loop(bench.problem, lambda p: made(algorithm, p, None, seed), bench.limits,
                 acquire=acquiring(bench.problem, algorithm))  # fmt: skip
    dark = not believed(bench.problem, bench.limits, dict(_values(bench, true, world.at(0.0))))
    ask = next(steps)
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
                values = dict(_values(bench, true, world.at(clock), rng))
        try:
            ask = steps.send(Reading(values, clock))
        except StopIteration:
            return count, bench.good(true, world.at(clock)), clock, dark


def _values(
    bench: Bench, true: Array, world: Disturbed, rng: np.random.Generator | None = None
) -> Iterator[tuple[str, float]]:
    """Yield what is read, and its standard deviations; exact without a generator."""
    for name, (value, sigma) in bench.read(true, world).items():
        yield name, value + (sigma * rng.normal() if rng is not None else 0.0)
        yield f"{name}_sigma", sigma


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--only", default="")
    args = parser.parse_args()
    print(f"{args.seeds} seeds each: median / 90th percentile of measurements, success, median simulated seconds\n")
    print("| problem | dark | bar | PICO's own | nelder_mead | cma_es |\n|---|---|---|---|---|---|")
    for make in PROBLEMS:
        if args.only and args.only not in make.__name__:
            continue
        name, told = "", list[str]()
        for which in ("", "nelder_mead", "cma_es"):
            benches = [make(np.random.default_rng([seed, 1])) for seed in range(args.seeds)]
            name = benches[0].name
            if len(benches[0].problem.variables) < 2 and which == "cma_es":
                told.append("-")
                continue
            found = [run(bench, which or bench.algorithm, seed) for seed, bench in enumerate(benches)]
            told += [f"{100 * sum(f[3] for f in found) / len(found):.0f} %"] if not which else []
            told.append(cell(found))
        bar = BARS[name]
        print(f"| {name} | {told[0]} | {bar[0]} / {bar[1]} | " + " | ".join(told[1:]) + " |", flush=True)


def cell(found: Sequence[tuple[int, bool, float, bool]]) -> str:
    """Return what a table has of runs."""
    counts = sorted(f[0] for f in found)
    p90 = counts[math.ceil(0.9 * len(counts)) - 1]
    good, spent = sum(f[1] for f in found) / len(found), float(np.median([f[2] for f in found]))
    return f"{np.median(counts):g} / {p90}, {100 * good:.1f} %, {spent:.0f} s"


if __name__ == "__main__":
    main()

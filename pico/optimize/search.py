"""Looking for light where there is none: places in a growing order around where it should be, until one is bright."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from pico.optimize.problem import Problem, noise_of
from pico.optimize.stepwise import Result, Steps

PARAMETERS: Mapping[str, float] = {"pitch": 0.25, "least": 0.0, "most": 400.0}
"""`pitch`: between neighbouring places, as a share of how far the best value is likely to be; `least`: the output above
which it is bright, with 0 five standard deviations; `most`: places."""


def bright(problem: Problem, result: Result, least: float) -> bool:
    """Return whether light is seen: every output was measured, and of a power it is out of the noise."""
    if not problem.measured(result):
        return False
    if problem.aim == "reach":
        return True
    output = problem.outputs[0]
    return result[output] > (least or 5 * noise_of(result, output))


def searched(problem: Problem, places: Iterator[tuple[float, float]], parameters: Mapping[str, float]) -> Steps:
    """Try places (in units of the pitch from where it began) until it is bright there, then climb: the sixteen places
    around it at half the pitch are not tried, that is for who refines."""
    names = [v.name for v in problem.variables]
    pitch = [parameters["pitch"] * v.likely for v in problem.variables]
    tried = 0
    for place in places:
        if tried >= parameters["most"]:
            break
        at = {n: v.start + s * p for n, v, s, p in zip(names, problem.variables, place, pitch, strict=False)}
        if any(not v.low <= at[v.name] <= v.high for v in problem.variables):
            if all(abs(s) * p > v.span for s, p, v in zip(place, pitch, problem.variables, strict=False)):
                break
            continue
        tried += 1
        result = yield at
        if bright(problem, result, parameters["least"]):
            return "there is light"
    return f"it is dark at {tried} place{'s' if tried != 1 else ''}"


def spiral() -> Iterator[tuple[float, float]]:
    """Yield places on rings around the middle, one apart: about 2 pi n on the nth."""
    yield 0.0, 0.0
    ring = 1
    while ring < 200:
        count = max(6, round(2 * math.pi * ring))
        for n in range(count):
            angle = 2 * math.pi * n / count
            yield ring * math.cos(angle), ring * math.sin(angle)
        ring += 1


def raster(across: int, up: int) -> Iterator[tuple[float, float]]:
    """Yield places row by row, to and fro, so that no axis goes far at once."""
    for row in range(-up, up + 1):
        line = range(-across, across + 1)
        for column in line if row % 2 else reversed(line):
            yield float(column), float(row)

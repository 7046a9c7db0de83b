"""COBYQA, as scipy has it: quadratic models in a trust region, without derivatives (Ragonneau and Zhang).

It is asked and told without a thread: as the same readings make it ask for the same points, it is run from the start
until it wants one that was not measured yet. That costs milliseconds a point.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.optimize.problem import Declaration, Point, Problem, Short, missing
from pico.optimize.stepwise import Result, Steps, Stepwise

DECLARATION = Declaration(
    what="quadratic models in a trust region (scipy's COBYQA; the extra `optimize`)",
    aims=("reach", "minimize", "maximize"), variables=(1, 8), outputs=(1, 8),
    parameters={"step": 0.5, "within": 0.002, "most": 300}, usual=40,
)  # fmt: skip
"""`step`: the first trust region, as a share of how far the best point is likely to be; `within`: the last, as a share
of the range."""
_DARK = 1e6


class _Asks(Exception):
    """A point that was not measured yet."""

    def __init__(self, point: tuple[float, ...]) -> None:
        super().__init__(point)
        self.point = point


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem; raises PicoError where scipy is not installed."""
    try:
        import scipy.optimize  # noqa: F401
    except ImportError as exc:
        raise missing("cobyqa", "scipy") from exc
    return Stepwise(problem, _steps(problem, parameters))


def _steps(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    known: dict[tuple[float, ...], float] = {}
    while len(known) < parameters["most"]:
        asked = _next(problem, parameters, known)
        if asked is None:
            return "the trust region is small"
        result: Result = yield _point(problem, asked)
        known[asked] = min(problem.cost(result), _DARK)
        if problem.met(result):
            return "the goal is reached"
    return Short(f"{len(known)} points were tried")


def _point(problem: Problem, scaled: tuple[float, ...]) -> Point:
    return problem.within({v.name: v.low + u * v.span for v, u in zip(problem.variables, scaled, strict=True)})


def _next(
    problem: Problem, parameters: Mapping[str, float], known: Mapping[tuple[float, ...], float]
) -> tuple[float, ...] | None:
    """Return the first point that it wants and that nobody measured; None where it ends without."""
    from scipy.optimize import minimize

    def cost(at: Any) -> float:
        key = tuple(round(float(u), 9) for u in at)
        if key not in known:
            raise _Asks(key)
        return known[key]

    start = [(v.start - v.low) / v.span for v in problem.variables]
    first = max(parameters["step"] * max(v.likely / v.span for v in problem.variables), 2 * parameters["within"])
    options = {"initial_tr_radius": min(first, 0.5), "final_tr_radius": parameters["within"], "maxfev": 100_000}
    try:
        minimize(cost, start, method="COBYQA", bounds=[(0.0, 1.0)] * len(start), options=options)
    except _Asks as asks:
        return asks.point
    return None

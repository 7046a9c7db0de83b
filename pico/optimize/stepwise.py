"""Algorithms written as one thing after the other: a generator that yields a point, and is sent what was measured."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence

from pico.optimize.problem import Point, Problem, Solution

Result = Mapping[str, float]
Steps = Generator[Point, Result, "str | tuple[str, Solution]"]
"""Yields points, is sent what was measured at each, and returns why it is done; with where the best is by its model,
where it has one."""


class Stepwise:
    """The algorithm that `steps` are. One point at a time: each depends on what was measured at the one before.

    The start of the problem is tried first; `steps` begin with what was measured there, as the first that they are
    sent, and yield it first. Points are brought within the bounds before they are tried.
    """

    def __init__(self, problem: Problem, steps: Steps) -> None:
        self._problem, self._steps = problem, steps
        self._finished = ""
        self._solution: Solution | None = None
        self._pending: Point | None = None
        self._advance(None)

    @property
    def finished(self) -> str:
        """Why nothing more is to be tried, empty while something is."""
        return self._finished

    @property
    def solution(self) -> Solution | None:
        """Where the model of the steps has the best, once they are done; None where they do not tell."""
        return self._solution

    def suggest(self, num_points: int | None = None) -> list[Point]:
        """Return the next point to try; none where it is done."""
        if self._pending is None or num_points == 0:
            return []
        return [dict(self._pending)]

    def ingest(self, results: Sequence[Result]) -> None:
        """Hear what was measured at the point that was suggested; other points pass it by."""
        for result in results:
            if self._pending is not None and all(result.get(n) == v for n, v in self._pending.items()):
                self._advance(result)

    def _advance(self, result: Result | None) -> None:
        try:
            point = next(self._steps) if result is None else self._steps.send(result)
        except StopIteration as stop:
            said, self._solution = stop.value if isinstance(stop.value, tuple) else (stop.value, None)
            self._pending, self._finished = None, said or "done"
        else:
            self._pending = self._problem.within(point)

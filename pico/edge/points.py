"""What an optimization has tried so far, beside the journal, a line each: one that was killed is taken up by it."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Mapping
from contextlib import suppress

from pico.base.plain_files import open_file, read_text
from pico.optimize.loop import Limits, believed
from pico.optimize.problem import Point, Problem
from pico.places.bench import BenchPlace


class Points:
    """The points of the optimization under `key` on the bench at `place`. A line is there when `add` returns, whatever
    becomes of the process; a disk that takes none costs only the way back to the best of them."""

    def __init__(self, place: BenchPlace, key: str) -> None:
        self._path = place.folder / "points" / f"{key.replace('/', '-')}.jsonl"

    def add(self, result: Mapping[str, float]) -> None:
        """Keep a point with what was measured there."""
        with suppress(OSError):
            self._path.parent.mkdir(parents=True, exist_ok=True)
            file = open_file(self._path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
            with os.fdopen(file, "a", encoding="utf-8") as lines:
                lines.write(json.dumps({k: v for k, v in result.items() if math.isfinite(v)}) + "\n")

    def drop(self) -> None:
        """Forget them: the run has them."""
        with suppress(OSError):
            self._path.unlink(missing_ok=True)

    def results(self) -> Iterator[Mapping[str, float]]:
        """Yield them in order; a line that was cut is passed over."""
        with suppress(OSError, UnicodeError):
            for line in read_text(self._path).splitlines():
                with suppress(ValueError, TypeError, AttributeError):
                    yield {str(k): float(v) for k, v in json.loads(line).items()}

    def best(self, problem: Problem, limits: Limits) -> Point | None:
        """Return the best of them at which there was light, None for none."""
        seen = [r for r in self.results() if believed(problem, limits, r) and all(n in r for n in problem.start)]
        best = min(seen, key=problem.cost, default=None)
        return None if best is None else problem.within({n: best[n] for n in problem.start})

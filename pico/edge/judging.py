"""Whether a goal is met where its tunables stand, by one reading of it: nothing is sought.

What is to be reached is met within its tolerance and three standard deviations of the reading. What is to be as low or
as high as can be is met where it is as it was when it was met: within its tolerance, three standard deviations of both
readings, and the share by which the same light may read otherwise. Left by an offset from the best, it may not read
better than that, either.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from pico.optimize.loop import Limits, Reading, believed
from pico.optimize.problem import Problem

SURE = 3.0
"""Standard deviations from which two readings differ."""
SHARE = 0.05
"""What two readings of the same light may differ by, as a share, one standard deviation: lasers drift."""


def judged(
    problem: Problem, limits: Limits, reading: Reading, doubt: str, was: Mapping[str, float] | None
) -> dict[str, Any]:
    """Return `met` and `why` not, with what was measured (`last`); without `met` where that can't be told: `doubt` says
    why. `was`: what was measured when it was met."""
    last = {n: v for n, v in {**problem.start, **reading.values}.items() if math.isfinite(v)}
    if doubt:
        return {"doubt": doubt, "last": problem.start}
    if not believed(problem, limits, reading.values):
        return {"met": False, "why": f"no light: {reading.unknown}" if reading.unknown else "no light", "last": last}
    found = _reached(problem, reading.values) if problem.aim == "reach" else _as_it_was(problem, reading.values, was)
    return {**found, "last": last}


def _reached(problem: Problem, now: Mapping[str, float]) -> dict[str, Any]:
    near = {n: problem.tolerance.get(n, 0.0) + SURE * now.get(f"{n}_sigma", 0.0) for n in problem.outputs}
    wrong = [f"{name} is {off:+.3g} off" for name, off in problem.off(now).items() if abs(off) > near[name]]
    return {"met": not wrong, "why": ", ".join(wrong)}


def _as_it_was(problem: Problem, now: Mapping[str, float], was: Mapping[str, float] | None) -> dict[str, Any]:
    (output,) = problem.outputs
    if was is None or not problem.measured(was):
        return {"doubt": "nothing tells how it was when it was met"}
    before, value = was[output], now[output]
    near = max(problem.tolerance.get(output, 0.0),
               SURE * math.hypot(problem.noise(now), problem.noise(was), SHARE * before))  # fmt: skip
    worse = problem.cost(now) - problem.cost(was)
    off = abs(worse) if problem.offset is not None else worse
    return {"met": off <= near, "why": "" if off <= near else f"it is {value:.4g}, and was {before:.4g}"}

"""The safe loop: what is set and measured next, by an algorithm, within bounds and budget, and back to a good point.

Pure: it yields what it asks for and is sent what came of it. Whoever asks sets tunables (from one side, and waits until
they have settled) and measures.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

from pico.optimize.extremum import ends, same, unsaid
from pico.optimize.problem import Algorithm, Point, Problem, Short, Solution, Solver, noise_of

STOPPED = "it was stopped"
"""Why it ended where somebody asked for that."""
LIGHT_LOST = "the light was lost"
TOO_MUCH = "there was too much light to measure"
LOST = 6
"""Readings without light, one after the other, after light was seen, at which it gives up."""
_FEW = 8
"""Readings in the dark up to which all places are tried once more."""
_SURE = 5.0
"""Standard deviations of a power from which it counts as light."""
_LEAP = 100.0
"""How many times more light from one reading to the next may be other light: steps of a search seldom bring that."""
Making = Callable[[Problem], Algorithm]


@dataclass(frozen=True)
class Limits:
    """How much may be spent: `measurements`, and `seconds` on the bench's clock. `signal`: an output of every reading
    below whose `least` nothing is believed (empty: none)."""

    measurements: int = 60
    seconds: float = 600.0
    signal: str = ""
    least: float = 0.0


@dataclass(frozen=True)
class Ask:
    """Tunables to be set, and whether to measure then. `why`: `try`, `back` to where light was, `best` to be restored
    and measured again, `start` because nothing better was found, `offset` from the best, where they are to be left."""

    point: Point
    measure: bool = True
    why: str = "try"


@dataclass(frozen=True)
class Reading:
    """What came of an ask: outputs with their `<output>_sigma` (see `pico.optimize.problem`), none where it is dark
    or a frame was lost (`unknown` says why; `glaring`: there is too much light; `missed`: no reading came, so that
    nobody knows whether there is light); `time` on the bench's clock [s]; `fault`: what does not answer, with its
    last reading."""

    values: Mapping[str, float] = field(default_factory=dict)
    time: float = 0.0
    unknown: str = ""
    glaring: bool = False
    missed: bool = False
    fault: str = ""


@dataclass(frozen=True)
class Tried:
    """A point with what was measured there: tunables and outputs by name."""

    result: Mapping[str, float]
    time: float
    why: str


@dataclass(frozen=True)
class Outcome:
    """How a loop ended. `first`, `last`: the results with which it began and ended (None: not measured); `tried`: all
    that was measured, in order; `met`: the goal is met; `why` it ended; `fault`: what failed; `solution`: where the
    algorithm's model has the best, where the tunables were left by an offset from there; `saturated`: there was
    too much light to measure where it began."""

    first: Mapping[str, float] | None
    last: Mapping[str, float] | None
    tried: tuple[Tried, ...]
    met: bool
    why: str
    fault: str = ""
    seconds: float = 0.0
    solution: Solution | None = None
    saturated: bool = False


Loop = Generator[Ask, Reading, Outcome]


def loop(
    problem: Problem, refine: Making, limits: Limits = Limits(), *, acquire: Making | None = None,
    stopping: Callable[[], bool] = lambda: False,
) -> Loop:  # fmt: skip
    """Return the loop that brings a problem to its goal by the algorithm that `refine` makes, begun where the tunables
    stand; where it is dark there, that of `acquire` looks for light first. `stopping`: it is to end, at its best."""
    return (yield from _Walk(problem, limits, stopping).run(refine, acquire))


class _Walk:
    """The loop in progress."""

    def __init__(self, problem: Problem, limits: Limits, stopping: Callable[[], bool]) -> None:
        self.problem, self.limits, self.stopping = problem, limits, stopping
        self.tried: list[Tried] = []
        self.first: Tried | None = None
        self.here: Point = problem.start
        self.good: Tried | None = None
        self.began: float | None = None
        self.now = self.longest = 0.0
        self.lost, self.fault, self.unknown, self.glaring, self.missed = 0, "", "", False, False
        self.solution: Solution | None = None
        self.glared = False  # whether there was too much light to measure where it began

    def run(self, refine: Making, acquire: Making | None) -> Loop:
        self.first = yield from self._ask(self.problem.start)
        whole = acquire is not None or self.problem.aim == "maximize"  # a peak is at least as bright as where it began
        while not (why := self._over()) and (self.missed or (self.glaring and whole)):
            if self.lost >= LOST:
                self.glared = self.glaring
                told = "nothing was measured where it began" if self.missed else "there is too much light to begin with"
                return (yield from self._end(Short(told)))
            self.first = yield from self._ask(self.problem.start)
        self.glared = self.glaring
        if not why and self.good is None and acquire is not None:
            plain = replace(self.problem, offset=None)
            why = yield from self._stage(acquire(plain), until_light=True)
            if self.good is None and len(self.tried) <= _FEW:  # readings may have been lost
                why = yield from self._stage(acquire(plain), until_light=True, anew=True)
            if self.good is None:
                return (yield from self._end(why or Short("no light was found")))
            why = self._over()
        if not why:
            begun = {v.name: self.here[v.name] for v in self.problem.variables}
            why = yield from self._stage(refine(started(self.problem, begun)))
        return (yield from self._end(why))

    def _stage(
        self, algorithm: Algorithm, *, until_light: bool = False, anew: bool = False
    ) -> Generator[Ask, Reading, str]:
        """Do what an algorithm suggests until it is finished, or something ends it; return why. `anew`: what was
        measured where it stands is measured again."""
        known = self.tried[-1] if self.tried and not anew else None
        while not (why := self._over()):
            points = algorithm.suggest(1)
            if not points:
                self.solution = algorithm.solution if isinstance(algorithm, Solver) else None
                return algorithm.finished or "there is nothing more to try"
            point = self.problem.within(points[0])
            if known is not None and all(known.result.get(n) == v for n, v in point.items()):
                tried, known = known, None  # where it stands it was measured already
            else:
                tried = yield from self._ask(point)
            algorithm.ingest([{**tried.result, **points[0]} if tried else points[0]])
            if until_light and self.good is not None:
                return ""
            if self.lost and self.good is not None and not self.fault:
                back = {v.name: self.good.result[v.name] for v in self.problem.variables}
                yield from self._ask(back, measure=False, why="back")
        return why

    def _over(self) -> str:
        """Return why nothing more may be tried, empty while something may: one measurement is kept for the end."""
        limits, spent = self.limits, len(self.tried)
        spends = spent + 2 if spent else 1  # the next, and one at the end
        if self.first and self.good is not None and self._doubtful(self.first, self.good):
            spends += 2  # the start and the best again
        if self.first and not self._believed(self.first.result):
            spends += 1  # the start again
        slow = self.now - (self.began or 0.0) + 2 * self.longest > limits.seconds
        ends = {
            self.fault: bool(self.fault),
            STOPPED: self.stopping(),
            f"the budget of {limits.measurements} measurements is spent": spends > limits.measurements,
            f"the budget of {limits.seconds:g} s is spent": slow and spent > 0,
            f"{TOO_MUCH if self.glaring else LIGHT_LOST} {self.lost} times in a row": self.good is not None
            and self.lost >= LOST,
        }
        return Short(next((why for why, so in ends.items() if so), ""))

    def _ask(self, point: Point, *, measure: bool = True, why: str = "try") -> Generator[Ask, Reading, Tried]:
        before = self.now
        reading = yield Ask(dict(point), measure, why)
        self.here = point
        if self.began is None:
            self.began = before = reading.time
        self.now = reading.time
        self.longest = max(self.longest, self.now - before)
        if measure:  # the way back reads nothing, and says nothing of the light
            self.unknown, self.glaring, self.missed = reading.unknown, reading.glaring, reading.missed
        if reading.fault:
            self.fault = self.fault or reading.fault
        tried = Tried({**point, **reading.values}, reading.time, why)
        if measure and not reading.fault:
            if self._believed(tried.result):
                self.lost = 0
                self.good = tried if self.good is None or self._better(tried, self.good) else self.good
            else:
                self.lost += 1
                kept = {n: v for n, v in tried.result.items() if n in point or n.startswith(self.limits.signal or "\0")}
                tried = Tried(kept, reading.time, why)
            self.tried.append(tried)
        return tried

    def _believed(self, result: Mapping[str, float]) -> bool:
        return believed(self.problem, self.limits, result)

    def _better(self, one: Tried, other: Tried) -> bool:
        return self.problem.cost(one.result) < self.problem.cost(other.result)

    def _at_best(self) -> bool:
        """Whether what was measured last is as good as the best, as far as its noise tells."""
        if self.good is None or not self.tried:
            return True
        last = self.tried[-1].result
        if self.here != {n: last[n] for n in self.here}:
            return False
        noise = math.hypot(self.problem.noise(last), self.problem.noise(self.good.result))
        return self.problem.cost(last) <= self.problem.cost(self.good.result) + 2 * noise

    def _end(self, why: str) -> Loop:
        """Bring the tunables to the best point, measured again; or to where they began, where nothing better is."""
        first = self.first
        if self.problem.offset is not None and self.solution is not None and not self.fault:
            return (yield from self._leave(why, self.solution, self.problem.offset))
        if self.unknown and not self.fault and (self.good is None or self.lost):
            why = type(why)(f"{why} ({self.unknown})")
        if not self.fault:
            why = yield from self._brought(first, why)
        if first is not None and not self.fault:
            why = yield from self._weighed(first, why)
        if self.fault:  # what it set besides goes back to where it began
            why = self.fault
            yield from self._ask(self.problem.start, measure=False, why="start")
        last = self.tried[-1] if self.tried else None
        at = last is not None and all(last.result[n] == v for n, v in self.here.items())
        believed = last is not None and at and self._believed(last.result) and not self.fault
        met = believed and last is not None and (
            self.problem.met(last.result) if self.problem.aim == "reach" else not isinstance(why, Short)
        )  # fmt: skip
        begun = first.result if first and self._believed(first.result) else None
        return Outcome(
            begun, last.result if believed and last else None, tuple(self.tried), met, str(why), self.fault,
            self.now - (self.began or 0.0), saturated=self.glared,
        )  # fmt: skip

    def _weighed(self, first: Tried, why: str) -> Generator[Ask, Reading, str]:
        """Return why it ends, by whether readings say that it is as good as it gets; where they are all the same, it is
        left where it began: the best of them is the best of noise, or of a beam that was lost."""
        last, begun = self.tried[-1], _point(self.problem, first)
        known = self.here == _point(self.problem, last) and self._believed(last.result)
        if self.problem.aim == "reach" or not known:
            return why
        seen = [t.result for t in self.tried if self._believed(t.result)]
        said = why if isinstance(why, Short) else unsaid(self.problem, seen, last.result)
        if said and same(self.problem, seen) and self.here != begun:
            yield from self._ask(begun, measure=len(self.tried) < self.limits.measurements, why="start")
        return said or why

    def _brought(self, first: Tried | None, why: str) -> Generator[Ask, Reading, str]:
        """Bring the tunables to the best point, or to where they began; return why it ends then."""
        if first is None:
            return why
        begun = _point(self.problem, first)
        if self.good is None:
            yield from self._ask(begun, measure=False, why="start")
            return why
        lost = isinstance(why, Short) and not self._believed(first.result) and self.here != begun
        if lost and len(self.tried) + 2 <= self.limits.measurements:  # where it began light may only have been lost
            yield from self._ask(begun, why="check")
            if self.missed and len(self.tried) + 2 <= self.limits.measurements:
                yield from self._ask(begun, why="check")
        if not self._at_best():
            best = _point(self.problem, self.good)
            yield from self._ask(best, why="best")
            if not self._believed(self.tried[-1].result) and len(self.tried) < self.limits.measurements:
                yield from self._ask(best, why="best")  # one reading may be lost
        if self.here != begun and self._doubtful(first, self.tried[-1]):
            if len(self.tried) + 2 > self.limits.measurements:  # nobody can tell: as it was
                yield from self._ask(begun, measure=False, why="start")
                return Short(f"{why}, and whether that is light that came or went would take two more measurements")
            best = dict(self.here)
            again = yield from self._ask(begun, why="check")
            if changed := self._changed(first.result, again.result):
                return Short(changed)
            yield from self._ask(best, why="best")
        if self._worse(first, 0.0 if isinstance(why, Short) else 2.0):
            gone = "nothing better was found than where it began"
            if not self._believed(self.tried[-1].result):
                gone = "there was no light any more at the best"
                gone = "there was too much light at the best" if self.glaring else gone
            elif self._worse(first, 2.0):
                gone = "the best is worse now than where it began"
            yield from self._ask(begun, measure=len(self.tried) < self.limits.measurements, why="start")
            return Short(f"{why}, but {gone}")
        return why

    def _doubtful(self, first: Tried, last: Tried) -> bool:
        """Whether light may have changed meanwhile: what looks like a null may be a beam that was lost, where it reads
        as without light though it did not where it began; what looks like a peak may be other light, where a power
        leapt from one reading to the next or is most at a bound; and nothing else is measured that would tell."""
        if self.problem.aim == "reach" or self.fault or not self._believed(first.result):
            return False
        output = self.problem.outputs[0]
        if self.problem.aim == "maximize":
            powers = [t.result[output] for t in self.tried if self._believed(t.result)]
            return bool(ends(self.problem, last.result)) or any(_LEAP * a < b for a, b in pairwise(powers))
        if self.limits.signal:
            return False
        least = {n: _SURE * noise_of(t.result, output) for n, t in (("first", first), ("last", last))}
        return abs(last.result.get(output, math.nan)) < least["last"] and first.result[output] > 2 * least["first"]

    def _changed(self, first: Mapping[str, float], again: Mapping[str, float]) -> str:
        """Return what is told of light that is another now where it began, empty where it is as it was."""
        output = self.problem.outputs[0]
        if self.problem.aim == "minimize" and again.get(output, math.nan) < first[output] / 2:
            return f"{LIGHT_LOST} on the way: less comes now to where it began"
        if self.problem.aim == "maximize" and again.get(output, math.nan) > 2 * first[output]:
            return "other light came on the way: there is more of it now where it began"
        return ""

    def _leave(self, why: str, solution: Solution, offset: Mapping[str, float]) -> Loop:
        """Leave the tunables by an offset from where the best is, not the best that was read, as finely as they can
        be set, and measure there; again where that reading is lost."""
        goal = self.problem.within({name: at + offset.get(name, 0.0) for name, at in solution.point.items()})
        goal = {v.name: v.settable(goal[v.name]) for v in self.problem.variables}
        last = yield from self._ask(goal, why="offset")
        if not self.problem.measured(last.result) and len(self.tried) < self.limits.measurements and not self.fault:
            last = yield from self._ask(goal, why="offset")
        there = self.problem.measured(last.result) and not self.fault
        if not there and not self.fault:
            why = f"{why}, but nothing was measured where it is to stand" + (
                f" ({self.unknown})" if self.unknown else ""
            )
        return Outcome(
            (self.first or last).result, last.result if there else None, tuple(self.tried), there, why, self.fault,
            self.now - (self.began or 0.0), solution,
        )  # fmt: skip

    def _worse(self, first: Tried, sigmas: float) -> bool:
        """Whether it is worse now than it began, by more than so many standard deviations."""
        last = self.tried[-1]
        if last is first or self.here == _point(self.problem, first) or self.fault:
            return False
        if not self._believed(last.result):  # wherever it began: nothing says that it is better here
            return True
        if not self._believed(first.result):
            return False
        noise = math.hypot(self.problem.noise(last.result), self.problem.noise(first.result))
        return self.problem.cost(last.result) > self.problem.cost(first.result) + sigmas * noise


def believed(problem: Problem, limits: Limits, result: Mapping[str, float]) -> bool:
    """Return whether there is light in a result: all was measured, its signal is strong enough, and a power stands out
    of its noise."""
    if not problem.measured(result):
        return False
    if limits.signal:
        return result.get(limits.signal, math.nan) >= limits.least
    output = problem.outputs[0]  # of a power what stands out of its noise
    return problem.aim != "maximize" or result[output] > _SURE * noise_of(result, output)


def started(problem: Problem, at: Mapping[str, float]) -> Problem:
    """Return a problem whose tunables stand at a point."""
    return replace(problem, variables=tuple(replace(v, start=at.get(v.name, v.start)) for v in problem.variables))


def _point(problem: Problem, tried: Tried) -> Point:
    return {v.name: tried.result[v.name] for v in problem.variables}

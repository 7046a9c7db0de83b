"""Optimizations at the edge: one operation to everybody else, many settings and measurements of the device.

The journal holds it as one operation with its first and last values; what was tried is kept beside the run, as an array
in the content store.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

from pico.backends.device import Began, Device
from pico.diagnostics import Diagnostic, PicoError, error
from pico.edge.judging import judged
from pico.edge.points import Points
from pico.expressions import ExpressionError, Language
from pico.model.catalog import Tunable
from pico.model.goal import Goal, goal_from_json
from pico.model.measurement import Measurement, measurement_from_json, number_of
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult
from pico.model.quantities import Value
from pico.model.record import as_json
from pico.model.setup import EXPOSURE, Setup
from pico.model.trace.event import Event
from pico.model.vocabulary import measured_in
from pico.optimize.loop import Ask, Limits, Outcome, Reading, Tried, believed, loop, started
from pico.optimize.problem import Aim, Nominal, Problem, Variable, nominal_from_json
from pico.optimize.registry import made
from pico.places.bench import BenchPlace
from pico.planning.darkness import unlit
from pico.planning.unknown_values import unknown_start

if TYPE_CHECKING:
    from pico.optimize.problem import Algorithm

Stopping = Literal["", "safely", "now"]
OBJECTIVE = "objective"
"""What the value of an expression is called that is to be as low or as high as can be."""
ACQUIRING = ("likely", "spiral", "raster", "malus")
"""Algorithms that look for light themselves."""
ATTEMPTS = 3
"""How often an axis that does not answer or stops is driven, and how often a measurement that gets lost is taken, at
most; as often as an operation of a plan is tried."""
AGAIN = ("timeout", "jammed")
"""Failures of an axis after which it may be driven again: its target is absolute."""
FRAME = "frame"
"""The failure of a measurement that got lost: nothing is known of the light."""
_UNSAID = error("failed", "the device does not say why")
_WEAK = 0.02
"""The share of noise from which another exposure is looked for, of a camera that was given another one already."""
_OVER = 2.0
"""How far an axis goes beyond, to come to its place from the side on which it is to be, in backlashes."""


class Aligning:
    """A device that knows optimizations. `stopping`: whether somebody asked to stop, and how; `tell` hears of each
    measurement as progress."""

    def __init__(
        self,
        setup: Setup,
        place: BenchPlace,
        device: Device,
        stopping: Callable[[], Stopping],
        tell: Callable[[Event], None],
    ) -> None:
        self._setup, self._place, self._device = setup, place, device
        self._stopping, self._tell = stopping, tell

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute an operation; one that the device knows by the device."""
        if operation.primitive == "verify":
            return await self._verify(operation, key, began)
        if operation.primitive != "optimize":
            return await self._device.execute(operation, key, began)
        seen = await self._device.observe()
        begun = seen.time
        before = seen.components.get(operation.component)
        began(before)
        try:
            run, outcome, former = await self._sought(operation, key, seen)
        except PicoError as exc:
            seen = await self._device.observe()
            return OperationResult(key=key, outcome="failed", error=exc.diagnostics[0], before=before, ended=seen.time)
        seen = await self._device.observe()
        result = OperationResult(
            key=key, outcome="done", before=before, after=seen.components.get(operation.component),
            seconds=seen.time - begun, ended=seen.time, data=self._data(run, outcome, former),
        )  # fmt: skip
        if outcome.fault:
            return replace(result, outcome="failed", error=error("axis", outcome.fault, address=operation.component))
        return result

    async def _verify(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Measure a goal where its tunables stand, and say whether it is met; what that needed is set back."""
        seen = await self._device.observe()
        before = seen.components.get(operation.component)
        began(before)
        try:
            run = self._run(operation, key, seen)
        except PicoError as exc:
            return OperationResult(key=key, outcome="failed", error=exc.diagnostics[0], before=before, ended=seen.time)
        reading = await run.answer(Ask(run.problem.start))
        await run.restore()
        ended = await self._device.observe()
        doubt = reading.unknown if reading.glaring else reading.fault or run.doubt
        told = judged(run.problem, run.limits, reading, doubt, operation.arguments.get("was"))
        stands = {n: v for n, v in operation.arguments["from"].items() if isinstance(v, int | float)}
        return OperationResult(
            key=key, outcome="done", before=before, after=ended.components.get(operation.component),
            seconds=ended.time - seen.time, ended=ended.time,
            data={"goal": run.name, "measurements": run.measured, **told, "last": {**stands, **told["last"]}},
        )  # fmt: skip

    async def _sought(
        self, operation: Operation, key: str, seen: Observation
    ) -> tuple[_Run, Outcome, list[dict[str, Any]]]:
        """Seek a goal, and where it is dark to begin with those that come before it first, each as far as it comes;
        return the run, its outcome, and what the journal holds of those before."""
        run, former = self._run(operation, key, seen), list[dict[str, Any]]()
        if why := unlit(self._setup, seen, run.goal):
            return run, Outcome(None, None, (), met=False, why=why), former
        stages = operation.arguments.get("first") or ()
        if not stages or self._taken_up(run) != run.problem or await run.bright():
            return run, await self._walk(run), former
        for number, arguments in enumerate(stages):
            whole = {**arguments, "from": operation.arguments["from"]}
            one = self._run(replace(operation, arguments=whole), f"{key}+{number}", await self._device.observe(), run)
            run, outcome = one, await self._walk(one)
            former.append(self._data(one, outcome))
            if outcome.fault or outcome.last is None or self._stopping():
                why = f"{one.name} was not found: {outcome.why}" if outcome.last is None else outcome.why
                last = self._run(operation, key, await self._device.observe(), run)
                return last, replace(outcome, first=None, last=None, tried=(), met=False, why=why), former
        run = self._run(operation, key, await self._device.observe(), run)
        outcome = await self._walk(run)
        return run, replace(outcome, first=None, seconds=run.now - seen.time), former

    def _run(self, operation: Operation, key: str, seen: Observation, before: _Run | None = None) -> _Run:
        goal, problem = goal_from_json(operation.arguments["what"]), problem_of(self._setup, seen, operation)
        return _Run(self._setup, self._device, operation, key, goal, problem, before)

    def _taken_up(self, run: _Run) -> Problem:
        """Return the problem of a run, from the best point of the one that it takes up."""
        again = run.operation.arguments.get("again")
        best = Points(self._place, str(again)).best(run.problem, run.limits) if again else None
        return started(run.problem, best or {})

    async def _walk(self, run: _Run) -> Outcome:
        """Drive the loop to its end, or leave all as it is where somebody asked to stop now."""
        given = dict(run.operation.arguments.get("parameters") or {})

        def making(name: str) -> Callable[[Problem], Algorithm]:
            return lambda problem: made(name, problem, given)

        points, problem = Points(self._place, run.key), self._taken_up(run)
        steps = loop(
            problem, making(run.algorithm), run.limits, acquire=acquiring(problem, run.algorithm),
            stopping=lambda: bool(self._stopping()),
        )  # fmt: skip
        ask = next(steps)
        while True:
            if self._stopping() == "now":
                raise PicoError(error("stopped", "stopped by a person: its tunables stand where they were"))
            reading = await run.answer(ask)
            self._progress(run, ask, reading)
            if ask.measure:
                points.add({**ask.point, **reading.values})
            try:
                ask = steps.send(reading)
            except StopIteration as stop:
                await run.restore()
                outcome: Outcome = stop.value
                if not outcome.fault:
                    points.drop()
                return outcome

    def _progress(self, run: _Run, ask: Ask, reading: Reading) -> None:
        data: dict[str, Any] = {
            "phase": ask.why, "fraction": min(1.0, run.measured / run.most),
            "goal": run.name, "measured": run.measured, "point": dict(ask.point),
            "values": {n: v for n, v in reading.values.items() if math.isfinite(v)},
        }  # fmt: skip
        data |= {"unknown": reading.unknown} if reading.unknown else {}
        data |= run.judged(reading.values)
        self._tell(Event(
            run=run.key.split("/", maxsplit=1)[0], seq=0, kind="operation_progress", time=reading.time,
            operation=run.operation.id, component=run.operation.component, data=data,
        ))  # fmt: skip

    def _data(self, run: _Run, outcome: Outcome, former: Sequence[dict[str, Any]] = ()) -> dict[str, Any]:
        """Return what the journal holds of an optimization; `former`: of the goals that came before it."""
        names = [v.name for v in run.problem.variables]
        columns = ["time", *names, *(n for o in run.problem.outputs for n in (o, f"{o}_sigma"))]
        found: dict[str, Any] = {
            "goal": run.name, "algorithm": run.algorithm, "met": outcome.met, "why": outcome.why,
            "measurements": run.measured, "first": _numbers(outcome.first), "last": _numbers(outcome.last),
            "columns": columns, "tolerance": {n: t for n, t in run.problem.tolerance.items() if t},
        }  # fmt: skip
        if outcome.saturated:
            found["saturated"] = True
        if former:
            found["stages"] = list(former)
        if outcome.solution is not None:
            sigmas = {f"{name}_sigma": sigma for name, sigma in outcome.solution.sigma.items()}
            found["solution"] = {**outcome.solution.point, **sigmas}
        if outcome.tried:
            found["points"] = as_json(self._kept(columns, outcome.tried))
        return {k: v for k, v in found.items() if v is not None}

    def _kept(self, columns: list[str], tried: tuple[Tried, ...]) -> Any:
        import numpy as np

        from pico.content.arrays import keep_array
        from pico.content.store import store_of

        rows = [[t.time, *(t.result.get(name, math.nan) for name in columns[1:])] for t in tried]
        return keep_array(store_of(self._place.root), np.array(rows, dtype=np.float64))


class _Run:
    """One optimization under way on a device."""

    def __init__(
        self, setup: Setup, device: Device, operation: Operation, key: str, goal: Goal, problem: Problem,
        before: _Run | None = None,
    ) -> None:  # fmt: skip
        self.setup, self.device, self.operation, self.key = setup, device, operation, key
        self.goal, self.problem, self.bounds = goal, problem, goal.tunables
        self.name, self.algorithm = str(operation.arguments["goal"]), str(operation.arguments.get("algorithm", ""))
        self.measured = self.steps = 0
        self.now = 0.0
        if before is not None:
            self.measured, self.steps, self.now = before.measured, before.steps, before.now
        self.most = self.measured + goal.budget.measurements
        self.stands = dict(problem.start)
        self.looked: dict[str, Value] = {}
        self.failed: set[str] = set()
        self.doubt = ""
        """What was not assured of the last reading, and why."""
        self.exposed: set[str] = set()
        self.best: float | None = None
        self._language = Language(dict.fromkeys(sorted(numbers_in(setup, goal)), "number"))

    def judged(self, values: Mapping[str, float]) -> dict[str, Any]:
        """Return the `objective` of a reading with the `best` by now; nothing where it was not measured."""
        found = self.problem.objective(values)
        if found is None:
            return {}
        better = max if self.problem.aim == "maximize" else min
        self.best = found["value"] if self.best is None else better(self.best, found["value"])
        return {"objective": {**found, "best": self.best}}

    async def bright(self) -> bool:
        """Whether the goal has light where its tunables stand."""
        reading = await self.answer(Ask(self.problem.start))
        await self.restore()
        return believed(self.problem, self.limits, reading.values)

    @property
    def limits(self) -> Limits:
        """What may be spent, a reading in all looks as one."""
        goal, each = self.goal, max(1, len(self.goal.looks or ()))
        return Limits(goal.budget.measurements // each, goal.budget.seconds, goal.signal or "", goal.least or 0.0)

    async def answer(self, ask: Ask) -> Reading:
        """Set what is asked, one tunable after the other, and measure. One that failed once is left alone from then on,
        and the others are set all the same."""
        faults = [await self._brought(name, value) for name, value in ask.point.items() if name not in self.failed]
        if fault := next(filter(None, faults), ""):
            return Reading(time=self.now, fault=fault)
        return await self._read() if ask.measure and not self.failed else Reading(time=self.now)

    async def _brought(self, name: str, value: float) -> str:
        """Bring a tunable to a value from the side of its axis; return why it does not come there, empty where it
        does."""
        component, _, tunable = name.partition(".")
        kind, here = self.setup.type_of(component).tunables[tunable], self.stands[name]
        wrong: Diagnostic | None = None
        for _ in range(ATTEMPTS):
            for goal in ways(kind, here, value, self.bounds[name]):
                arguments = {"tunable": tunable, "from": here, "to": goal}
                result = await self._do("set", component, arguments)
                wrong = None if result.outcome == "done" else result.error or _UNSAID
                if wrong:
                    break
                self.stands[name] = here = goal
            if wrong is None:
                return ""
            if wrong.code not in AGAIN:
                break
            here = math.nan  # nobody knows where it stands
        self.failed.add(name)
        return _fault(name, kind.unit, self.stands[name], wrong)

    async def _read(self) -> Reading:
        """Measure what the goal speaks of, in each of its looks."""
        taken: dict[str, Measurement] = {}
        for look in self.goal.looks or ("",):
            self.measured += 1
            if fault := await self._look(look):
                return Reading(time=self.now, fault=fault)
            for component, measurable in measured_in(self.setup, self.goal.seen_in(look)):
                found = await self._measured(component, measurable)
                if isinstance(found, str):
                    self.doubt = found
                    return Reading(time=self.now, unknown=found, missed=True)
                if unsure := [f"{one}: {why}" for one, why in found.not_assured.items() if one != "not saturated"]:
                    self.doubt = f"of {found.address} not all was assured: {'; '.join(unsure)}"
                taken[f"{look}.{found.address}" if look else found.address] = found
        return replace(self._evaluated(taken), time=self.now)

    async def _look(self, look: str) -> str:
        """Set what a look wants; return what is wrong with that, empty for nothing."""
        for address, value in (self.goal.looks or {}).get(look, {}).items():
            here = self.looked.setdefault(address, self.operation.arguments["from"][address])
            if here != value and (wrong := await self._set_to(address, value, here)):
                return f"{address} does not go to {value}: {wrong.summary}"
            self.looked[address] = value
        return ""

    async def _set_to(self, address: str, value: Value, here: Value | None = None) -> Diagnostic | None:
        """Set a tunable only to measure by it; return why it does not go there."""
        component, _, tunable = address.partition(".")
        for _ in range(ATTEMPTS):
            result = await self._do("set", component, {"tunable": tunable, "from": here, "to": value})
            if result.error is None or result.error.code not in AGAIN:
                break
        return None if result.outcome == "done" else result.error or _UNSAID

    async def _measured(self, component: str, measurable: str) -> Measurement | str:
        """Measure, with another exposure where there is too much light for that, or was and now is too little; return
        why it cannot be in words."""
        found = await self._taken(component, measurable)
        if isinstance(found, str):
            return found
        full = "not saturated" in found.not_assured
        dim = component in self.exposed and (found.unknown or _weak(found))
        if (full or dim) and await self._ranged(component):
            found = await self._taken(component, measurable)
        return found

    async def _taken(self, component: str, measurable: str) -> Measurement | str:
        for _ in range(ATTEMPTS):
            result = await self._do("measure", component, {"measurable": measurable})
            if result.error is None or result.error.code != FRAME:
                break
        if result.outcome != "done" or "measurement" not in result.data:
            return result.error.summary if result.error else f"{component}.{measurable} was not measured"
        return measurement_from_json(result.data["measurement"])

    async def _ranged(self, component: str) -> bool:
        """Find an exposure that suits, where a detector can."""
        if f"{component}.{EXPOSURE}" not in self.operation.arguments["from"]:
            return False
        self.exposed.add(component)
        result = await self._do("auto_range", component, {"tunable": EXPOSURE})
        return result.outcome == "done"

    async def restore(self) -> None:
        """Set back what was changed on the way only to be measured by: looks and exposures."""
        before = self.operation.arguments["from"]
        for address in (*self.looked, *(f"{component}.{EXPOSURE}" for component in sorted(self.exposed))):
            if self.looked.get(address) != before[address]:
                await self._set_to(address, before[address])

    def _evaluated(self, taken: Mapping[str, Measurement]) -> Reading:
        """Return the outputs of a goal, with their standard deviations to first order, and its signal."""
        if full := next((m for m in taken.values() if "not saturated" in m.not_assured), None):
            return Reading(unknown=f"{full.address} is saturated: {full.not_assured['not saturated']}", glaring=True)
        values, sigmas, noises, unknown = {}, {}, dict[str, float](), ""
        for name in self._language.names:
            address = next(
                (name.removeprefix(f"{x}.") for x in self.goal.looks or () if name.startswith(f"{x}.")), name
            )
            component, _, number = address.partition(".")
            mine = (m for a, m in taken.items() if f"{a}.".startswith(name.removesuffix(number)))
            found = next((m for m in mine if m.component == component and number_of(m, number) is not None), None)
            known = number_of(found, number) if found else None
            if found is None or known is None:
                unknown = unknown or next((m.unknown for m in taken.values() if m.unknown), f"{name} was not measured")
                continue
            values[name], sigmas[name] = known, _of_number(found.sigma, number)
            noises[name] = sigmas[name] if found.noise is None else _of_number(found.noise, number)
        result: dict[str, float] = {}
        outputs = dict(zip(self.problem.outputs, self.goal.expressions, strict=False))
        for output, text in (*outputs.items(), *(((self.goal.signal, self.goal.signal),) if self.goal.signal else ())):
            try:
                value, sigma = self._told(text, values, sigmas)
            except ExpressionError as exc:
                return Reading(values=result, unknown=unknown or str(exc))
            result[output], result[f"{output}_sigma"] = value, sigma
            if noises != sigmas:
                result[f"{output}_noise_sigma"] = self._told(text, values, noises)[1]
        return Reading(values=result)

    def _told(self, text: str, values: Mapping[str, float], sigmas: Mapping[str, float]) -> tuple[float, float]:
        expression = self._language.compile(text, "number")
        value, square = float(expression.evaluate(values)), 0.0
        for name, sigma in sigmas.items():
            if sigma and name in text:
                there = float(expression.evaluate({**values, name: values[name] + sigma}))
                square += (there - value) ** 2
        return value, math.sqrt(square)

    async def _do(self, primitive: str, component: str, arguments: Mapping[str, Any]) -> OperationResult:
        """Have the device do one step, of which nobody else hears."""
        self.steps += 1
        operation = Operation(
            id=f"{self.operation.id}.{self.steps}", primitive=primitive, component=component, arguments=arguments,
            reason=self.operation.reason,
        )  # fmt: skip
        run, _, rest = self.key.partition("/")
        result = await self.device.execute(operation, f"{run}~/{rest}.{self.steps}", lambda _: None)
        self.now = max(self.now, result.ended)
        return result


def acquiring(problem: Problem, algorithm: str) -> Callable[[Problem], Algorithm] | None:
    """Return what looks for light before an algorithm where it is dark: in the order in which it is likely to be where
    that is known, else on a spiral over one or two tunables; None where nothing can, or the algorithm does itself."""
    if algorithm in ACQUIRING:
        return None
    if problem.nominal is not None:
        return lambda one: made("likely", one)
    return (lambda one: made("spiral", one)) if len(problem.variables) <= 2 else None


def problem_of(setup: Setup, seen: Observation, operation: Operation) -> Problem:
    """Return a goal as an algorithm sees it, from where its tunables stand; raises PicoError where they cannot be."""
    goal = goal_from_json(operation.arguments["what"])
    known = nominal_from_json(operation.arguments.get("nominal"))
    variables = tuple(_variables(setup, seen, goal, known))
    outputs = tuple(goal.reach) if goal.reach is not None else (OBJECTIVE,)
    aim: Aim = goal.aim
    tolerance = {name: goal.near(name) for name in outputs}
    offset = None if goal.offset is None else {variables[0].name: goal.offset}
    return Problem(variables, outputs, aim, dict(goal.reach or {}), tolerance, known, offset)


def _variables(setup: Setup, seen: Observation, goal: Goal, known: Nominal | None) -> Iterator[Variable]:
    for n, (address, (low, high)) in enumerate(goal.tunables.items()):
        component, _, tunable = address.partition(".")
        kind = setup.type_of(component).tunables[tunable]
        part = seen.components.get(component)
        live = part.values.get(tunable) if part else None
        if live is None or live.status == "unknown" or not isinstance(live.value, int | float):
            raise PicoError(unknown_start(setup, address, "goal"))
        start = float(live.value)
        reach = known.reach(n) if known else None
        low, high = searched(kind, (low, high), start)
        yield Variable(address, low, high, start, kind.resolution, kind.period, reach)


def numbers_in(setup: Setup, goal: Goal) -> set[str]:
    """Return the numbers that a goal's expressions speak of, by address, with their looks."""
    from pico.model.vocabulary import numbers_of

    known = set()
    for look in goal.looks or ("",):
        words = (w.partition(".") for w in goal.seen_in(look))
        before = f"{look}." if look else ""
        known |= {f"{before}{name}.{of}" for name, _, of in words if of in numbers_of(setup, name)}
    return known


def ways(kind: Tunable, here: float, goal: float, bounds: tuple[float, float]) -> tuple[float, ...]:
    """Return the values that a tunable is set to on its way to a goal: where its axis would come from the wrong side,
    or nobody knows where it is (`here` is NaN), one beyond the backlash first, within bounds."""
    side, over = side_of(kind)
    if here == goal:
        return ()
    beyond = min(bounds[1], max(bounds[0], goal - side * over))
    return (goal,) if (goal - here) * side > 0 or beyond == goal else (beyond, goal)


def side_of(kind: Tunable) -> tuple[float, float]:
    """Return from which side the axis of a tunable comes to a value (1 from below, -1 from above), and how far it goes
    beyond to come from there; 0, 0 where that makes no difference."""
    axis = kind.axis
    if axis is None or axis.backlash <= 0 or axis.approach == "either":
        return 0.0, 0.0
    return 1.0 if axis.approach == "positive" else -1.0, _OVER * axis.backlash


def searched(kind: Tunable, bounds: tuple[float, float], start: float) -> tuple[float, float]:
    """Return within which bounds a tunable is searched, so that each value can be come to from the side of its axis;
    where it stands is always within."""
    (low, high), (side, over) = bounds, side_of(kind)
    if not low <= start <= high or high - low < 4 * over:
        return bounds
    return (min(start, low + over), high) if side > 0 else (low, max(start, high - over)) if side < 0 else bounds


def _weak(found: Measurement) -> bool:
    """Whether the noise of a number is so large a share of it that a longer exposure would tell more."""
    value, sigma = found.value, found.sigma
    pairs = (
        [(value[n], sigma.get(n)) for n in value] if isinstance(value, Mapping) and isinstance(sigma, Mapping) else []
    )
    return any(isinstance(v, int | float) and isinstance(s, int | float) and s > _WEAK * abs(v) for v, s in pairs)


def _of_number(sigma: float | Mapping[str, float] | None, number: str) -> float:
    """Return the standard deviation of one number of a measurement; 0 if unknown."""
    if isinstance(sigma, Mapping):
        return float(sigma.get(number.rpartition(".")[2], 0.0))
    return float(sigma or 0.0)


def _fault(name: str, unit: str, last: float, wrong: Diagnostic | None) -> str:
    said = f": {wrong.summary}" if wrong else ""
    return f"{name} does not go where it is sent; it last stood at {last:g} {unit}".rstrip() + said


def _numbers(result: Mapping[str, float] | None) -> dict[str, float] | None:
    return None if result is None else {n: v for n, v in result.items() if math.isfinite(v)}

"""A recipe that runs where nobody is there, held to what it states: before it begins, between its steps, at its end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Any

from pico.base import clock
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.expressions import ExpressionError
from pico.model.measurement import number_of
from pico.model.trace.unattended import Left, Terms
from pico.model.vocabulary import numbers_of, values_of
from pico.planning.checks.emission import above, emits_alone
from pico.recipes.recipe import Recipe, Stop, Unattended

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.plan import Plan
    from pico.recipes.doing import Doing


def local_now() -> datetime:
    """Return the time by the clock on the wall."""
    return clock.here()


@dataclass
class Guard:
    """What holds a run to what its recipe states. `arguments`: those of the recipe."""

    bench: Bench
    stated: Unattended
    arguments: Mapping[str, Any]
    stopped: bool = False
    measured: dict[str, float] = field(default_factory=dict)
    at: float | None = None

    def require_start(self) -> None:
        """Raise PicoError (exit code DENIED) where the run must not begin: outside of its hours, or while a laser emits
        that must not."""
        found = [*self._late(), *self._lasers()]
        if found:
            raise PicoError(found, ExitCode.DENIED)

    def allow(self, plan: Plan) -> None:
        """Raise PicoError (exit code DENIED) for a plan that lets light out which must not be; nothing of it is run."""
        if found := above(self.bench.setup, self.bench.observe(), plan.operations, self.stated.laser_class):
            raise PicoError(found, ExitCode.DENIED)

    def judge(self, doing: Doing, step: str) -> None:
        """Raise PicoError where the run is to stop before a step: once, for what tidies up goes on."""
        if self.stopped or "finally." in step:
            return
        self.bench.wait(self.bench.edge.goes_on(doing.recipe))
        try:
            found = [*self._late(), *self._lasers(), *self._goals(), *self._conditions(doing, step)]
        except PicoError as exc:
            self.stopped = exc.exit_code != ExitCode.INTERRUPTED
            raise
        if found:
            self.stopped = True
            raise PicoError(found, ExitCode.EXPECTATION)

    def _late(self) -> list[Diagnostic]:
        now, stated = local_now(), self.stated
        if stated.covers(now.time()):
            return []
        hours = f"{stated.begins:%H:%M} to {stated.ends:%H:%M}"
        found = _stop(f"it is {now:%H:%M}, and the recipe states that it runs unattended from {hours}")
        return [replace(found, hint="with somebody there, at a terminal and without --unattended, it runs at any time")]

    def _lasers(self) -> list[Diagnostic]:
        seen, rows, most = self.bench.observe(), self.bench.lasers.rows(), self.stated.laser_class
        return [d for row in rows if row.emits for d in emits_alone(seen, row.laser, row.laser_class, most)]

    def _goals(self) -> list[Diagnostic]:
        wanted = {stop.lost: stop for stop in self.stated.stops if stop.lost}
        standing = self.bench.goals.alignments() if wanted else ()
        return [
            replace(_stop(wanted[one.goal].text), detail=one.why, source=wanted[one.goal].source)
            for one in standing if one.goal in wanted and one.status == "lost"
        ]  # fmt: skip

    def _conditions(self, doing: Doing, step: str) -> list[Diagnostic]:
        stops = [stop for stop in self.stated.stops if stop.when is not None]
        if not stops:
            return []
        seen = self.bench.observe()
        if self.at is None or seen.time - self.at >= self.stated.every:
            self._measure(doing, step)
            seen = self.bench.observe()
            self.at = seen.time
        return [found for stop in stops for found in self._holds(stop, self._values(stop))]

    def _measure(self, doing: Doing, step: str) -> None:
        """Measure what conditions speak of; raises PicoError where that has no value: who sees nothing, stops."""
        of = sorted({address for stop in self.stated.stops for address in stop.of})
        plan = self.bench.plans.measuring([(c, m) for c, _, m in (a.partition(".") for a in of)])
        found = replace(doing, step=f"{step}.unattended", begun=()).run(plan)
        blind = [_stop(f"{m.address} has no value: {m.unknown}", m.address) for m in found.values() if m.unknown]
        if blind:
            raise PicoError(blind, ExitCode.EXPECTATION)
        for address, measurement in found.items():
            component, _, measurable = address.partition(".")
            for number, own in numbers_of(self.bench.setup, component).items():
                if own == measurable and (value := number_of(measurement, number)) is not None:
                    self.measured[f"{component}.{number}"] = value

    def _values(self, stop: Stop) -> dict[str, Any]:
        assert stop.when is not None
        parts = {word.partition(".")[0] for word in stop.when.words()} & self.bench.setup.lab.inventory.keys()
        values, _ = values_of(self.bench.setup, self.bench.observe(), sorted(parts))
        return {**values, **self.measured, **self.arguments}

    def _holds(self, stop: Stop, values: Mapping[str, Any]) -> list[Diagnostic]:
        assert stop.when is not None
        try:
            if not stop.when.value(values):
                return []
        except ExpressionError as exc:
            return [replace(_stop(f"nobody can tell whether to stop: {exc}"), source=stop.source)]
        known = ", ".join(f"{w} = {values[w]:.4g}" for w in sorted(stop.when.words())
                          if isinstance(values.get(w), float))  # fmt: skip
        return [replace(_stop(stop.text), detail=known, source=stop.source)]

    # held to it by the edge

    def hold(self, recipe: str, doing: Doing) -> None:
        """Have the edge hold a run of a recipe (`NAME@ID`) to what it states, whatever becomes of this process; where
        it is taken up again what its end had shut is opened as it was. Raises PicoError."""
        stated = self.stated
        terms = Terms(
            recipe=recipe, laser_class=stated.laser_class, until=self._until(), every=stated.every, end=stated.end
        )  # fmt: skip
        left = self.bench.wait(self.bench.edge.hold(terms))
        for address, value in sorted((left.was if left else {}).items()):
            doing.run(self.bench.plans.setting({address: value}))

    def _until(self) -> str:
        now = local_now()
        ends = now.replace(hour=self.stated.ends.hour, minute=self.stated.ends.minute, second=0, microsecond=0)
        ends += timedelta(days=ends <= now)
        return f"{ends.astimezone(UTC):%Y-%m-%dT%H:%M:%SZ}"

    def leave(self, recipe: str, *, moves: bool) -> Left:
        """Have the edge bring about the end state; see `pico.edge.contract.EdgeLicensing.leave`."""
        self.stopped = True
        try:
            return self.bench.wait(self.bench.edge.leave(recipe, moves))
        except PicoError as exc:
            return Left(wrong=tuple(exc.diagnostics))


def guard_of(bench: Bench, recipe: Recipe, arguments: Mapping[str, Any]) -> Guard:
    """Return what holds a run of a recipe to what it states; raises PicoError where it states nothing."""
    if recipe.unattended is None:
        hint = "a section `unattended:` with `laser_class`, `hours`, `stop` and `end`: docs/how-to/recipes.md"
        raise PicoError(
            error("unattended", f"{recipe.name} does not state how it runs unattended", hint=hint), ExitCode.DENIED
        )
    return Guard(bench, recipe.unattended, arguments)


def _stop(text: str, address: str = "") -> Diagnostic:
    return error("unattended", text, address=address)

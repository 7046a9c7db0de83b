"""A recipe that runs where nobody is there, held to what it states: before it begins, between its steps, at its end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.expressions import ExpressionError
from pico.model.arming import LaserClass, within
from pico.model.measurement import number_of
from pico.model.vocabulary import numbers_of, values_of
from pico.recipes.recipe import LAMPS_OFF, PARKED, SHUT, Recipe, Stop, Unattended

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.plan import Plan
    from pico.recipes.doing import Doing

LAMP = "illumination"
"""The tunable of what lights the table."""


def local_now() -> datetime:
    """Return the time by the clock on the wall."""
    return datetime.now().astimezone()


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
        from pico.planning.checks.emission import let_out

        out = let_out(self.bench.setup, self.bench.observe(), plan.operations)
        if found := [one for name, of in out.items() for one in self._emits(name, of)]:
            raise PicoError(found, ExitCode.DENIED)

    def judge(self, doing: Doing, step: str) -> None:
        """Raise PicoError where the run is to stop before a step: once, for what tidies up goes on."""
        if self.stopped or "finally." in step:
            return
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
        rows = self.bench.lasers.rows()
        return [found for row in rows if row.emits for found in self._emits(row.laser, row.laser_class)]

    def _emits(self, laser: str, of: LaserClass) -> list[Diagnostic]:
        """Return why a laser must not emit as of a class where nobody is there."""
        if not within(of, self.stated.laser_class):
            return [
                _stop(f"{laser} emits as class {of}; the recipe states {self.stated.laser_class} at the most", laser)
            ]
        licence = (self.bench.observe().licences or {}).get(laser)
        if licence is not None and licence.by and not licence.unattended:
            hint = f"`pico laser arm {laser} --unattended`"
            return [replace(_stop(f"{licence.by} armed {laser} as one who is there", laser), hint=hint)]
        return []

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

    # how the bench is left

    def leave(self, doing: Doing) -> tuple[tuple[str, ...], tuple[Diagnostic, ...]]:
        """Bring the bench to the end state that is stated; return what holds now, in words, and what does not."""
        self.stopped = True
        reached, wrong = list[str](), list[Diagnostic]()
        ways = {SHUT: self._shut, LAMPS_OFF: self._dark, PARKED: self._park}
        for name, way in ways.items():
            if name not in self.stated.end:
                continue
            try:
                way(doing)
                reached.append(name)
            except PicoError as exc:
                text = f"the bench is not left `{name}`: {exc.diagnostics[0].summary}"
                wrong.append(error("unattended", text, hint=exc.diagnostics[0].hint))
        return tuple(reached), tuple(wrong)

    def _shut(self, doing: Doing) -> None:
        for row in self.bench.lasers.rows():
            if row.emits:
                address, dark = (f"{row.gate}.shutter", "closed") if row.gate else (f"{row.laser}.emission", False)
                doing.run(self.bench.plans.setting({address: dark}))
        if left := [row.laser for row in self.bench.lasers.rows() if row.emits]:
            raise PicoError(
                error("unattended", f"{', '.join(left)} may emit still", hint=f"`pico laser disarm {left[0]}`")
            )

    def _dark(self, doing: Doing) -> None:
        seen = self.bench.observe().known_values
        for name in sorted(self.bench.setup.lab.inventory):
            if LAMP in self.bench.setup.type_of(name).tunables and seen.get(name, {}).get(LAMP) is not False:
                doing.run(self.bench.plans.setting({f"{name}.{LAMP}": False}))

    def _park(self, doing: Doing) -> None:
        doing.run(self.bench.plans.parking())
        robots = self.bench.setup.lab.robots
        for name, robot in sorted(self.bench.observe().robots.items()):
            if robot.holding or not robots[name].is_parked(robot.joints):
                held = f" and holds {robot.holding}" if robot.holding else ""
                raise PicoError(error("unattended", f"{name} stands where it stopped{held}", hint="`pico recover`"))


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
